"""Tables in CSV: values in SI, and the row and column of every fault."""

from __future__ import annotations

import math

import pytest

from torsional.errors import ModelError
from torsional.tables import parse_table

COLUMNS = {"speed": "speed", "torque": "torque"}
GOOD = "# full load\nspeed [rpm], torque [kNm]\n600, 1.3\n\n800,1.9  # rising\n900,2.5\n"


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_values_arrive_in_si(separator: str) -> None:
    table = parse_table("\ufeff" + GOOD.replace("\n", "\r\n").replace(",", separator), COLUMNS, increasing="speed")
    assert table["speed"] == pytest.approx([600 * math.pi / 30, 800 * math.pi / 30, 30 * math.pi], rel=1e-15)
    assert table["torque"] == pytest.approx([1300.0, 1900.0, 2500.0], rel=1e-15)


def test_separators_are_counted_in_front_of_comments() -> None:
    table = parse_table("speed [rpm]; torque [Nm]  # rig 2, cold, upwards\n600; 1\n700; 2\n", COLUMNS)
    assert table["torque"] == [1.0, 2.0]


def test_columns_come_in_the_order_asked_for() -> None:
    table = parse_table("torque [Nm],speed [rad/s]\n1,2\n3,4\n", COLUMNS)
    assert list(table.items()) == [("speed", [2.0, 4.0]), ("torque", [1.0, 3.0])]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "speed [rpm],torque [Nm]\n600,1\n",
            "a table has a header and at least two rows; found 1 row below 'speed [rpm]",
        ),
        ("# nothing\n", "found no line"),
        ("speed [rpm] torque [Nm]\n600 1\n700 2\n", "header: the column is unknown; found 'speed [rpm] torque [Nm]'"),
        ("speed [rpm];torque [Nm]\n600;1,5\n700;2\n", "found '1,5'; write decimals with a point"),
        ("speed [rpm],torqe [Nm]\n1,1\n2,2\n", "found 'torqe [Nm]'; did you mean 'torque'?"),
        ("speed [rpm],torque [Nm],x\n1,1,1\n2,2,2\n", "header: the column is unknown; found 'x'"),
        ("speed [rpm],speed [rpm]\n1,1\n2,2\n", "column 'speed': the column stands twice"),
        ("speed [rpm],\n1,1\n2,2\n", "header: the column is unknown; found ''"),
        ("speed,torque [Nm]\n1,1\n2,2\n", "column 'speed': the header names no unit; write 'speed [rpm]'"),
        ("speed [],torque [Nm]\n1,1\n2,2\n", "column 'speed': the header names no unit"),
        ("speed [Nm],torque [Nm]\n1,1\n2,2\n", "header, column 'speed': Nm is a torque, and an angular velocity is"),
        ("speed [rpm],torque [Nm]\n1,1\n2,2,2\n", "row 2 (line 3): 2 cells are wanted; found 3 cells in '2,2,2'"),
        ("speed [rpm],torque [Nm]\n1,1\n2\n", "row 2 (line 3): 2 cells are wanted; found 1 cells"),
        (
            "speed [rpm],torque [Nm]\n1,1\n\n2,\n",
            "row 2 (line 4), column 'torque': a plain number is wanted; found nothing",
        ),
        (
            "speed [rpm],torque [Nm]\n1,=1+1\n2,2\n",
            "row 1 (line 2), column 'torque': a plain number is wanted; found '=1+1'",
        ),
        ("speed [rpm],torque [Nm]\n1,@SUM(A1)\n2,2\n", "found '@SUM(A1)'"),
        ("speed [rpm],torque [Nm]\n1,nan\n2,2\n", "found 'nan'"),
        ("speed [rpm],torque [Nm]\n1,-Infinity\n2,2\n", "found '-Infinity'"),
        ("speed [rpm],torque [Nm]\n1,1_0\n2,2\n", "found '1_0'"),
        ("speed [rpm],torque [Nm]\n1,٣\n2,2\n", "column 'torque': a plain number is wanted"),
        ("speed [rpm],torque [Nm]\n1,1e\n2,2\n", "found '1e'"),
        ("speed [rpm],torque [Nm]\n1,1 Nm\n2,2\n", "found '1 Nm'"),
        ('speed [rpm],torque [Nm]\n1,"1\n2,2\n', "row 1 (line 2), column 'torque': a plain number is wanted"),
        ("speed [rpm],torque [Nm]\n1,1\n2,1e999\n", "row 2 (line 3), column 'torque': a finite number is wanted"),
        ("speed [rpm],torque [Nm]\n1,1\n1,2\n", "row 2 (line 3), column 'speed': the column must increase"),
        ("\n" * 500_001, "the table is too long; allowed: at most 500000 rows"),
    ],
)
def test_faults_are_named(text: str, sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        parse_table(text, COLUMNS, increasing="speed")
    assert sentence in str(caught.value)


def test_a_missing_column_is_named() -> None:
    with pytest.raises(ModelError, match="header: the column 'torque' is missing"):
        parse_table("speed [rpm],time [s]\n1,1\n2,2\n", COLUMNS | {"time": "time"})
