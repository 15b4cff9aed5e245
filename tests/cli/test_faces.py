"""Tables, CSV and JSON as texts; terminals with and without colours and letters."""

from __future__ import annotations

import csv
import io
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from torsional.cli.documents import escaped, json_text
from torsional.cli.tables import Column, Table, plain
from torsional.results import labelled
from torsional.spreadsheet import csv_text, neutral

Run = Callable[..., Any]


def test_plain_tables_show_units_and_align_numbers() -> None:
    columns = [Column("name"), Column("speed", "speed"), Column("stiffness", "stiffness")]
    text = plain(Table("Two", columns, [["a", 100 * np.pi, 25e3], ["βeta", float("nan"), None]]))
    assert text.splitlines() == [
        "Two",
        "name  speed [rpm]  stiffness [kNm/rad]",
        "----  -----------  -------------------",
        "a            3000                   25",
        "βeta            -                    -",
    ]


def test_cells_cannot_steer_the_terminal() -> None:
    assert "\x1b" not in plain(Table("t\x1b[2J", [Column("name")], [["\x1b]0;title\x07"]]))


@pytest.mark.parametrize("cell", ["=1+1", "+1", "-x", "@SUM(A1)", "\t=1", " =1", "\r=1"])
def test_formulas_are_neutralised(cell: str) -> None:
    assert neutral(cell) == "'" + cell


def test_numbers_stay_numbers() -> None:
    assert [neutral(value) for value in (-1.5, "x-1", float("nan"), 3)] == [-1.5, "x-1", "", 3]


def test_a_component_named_like_a_formula(torsional: Run) -> None:
    document = {
        "torsional": 1,
        "name": "pair",
        "components": {
            "a": {"type": "inertia", "inertia": 1.0},
            "b": {"type": "inertia", "inertia": 2.0},
            "@SUM(1)": {"type": "shaft", "a": "a", "b": "b", "stiffness": 1e4},
        },
    }
    Path("pair.json").write_text(json.dumps(document), encoding="utf-8")
    told = torsional("modes", "pair.json", "-o", "m.csv")
    assert told.code == 0, told.err
    with Path("m.csv").open(encoding="utf-8-sig", newline="") as file:
        header, *rows = csv.reader(file)
    assert rows[1][header.index("name")] == "'@SUM(1) mode"
    # two discs on a shaft: f = sqrt(k (1/a + 1/b)) / 2π
    assert float(rows[1][header.index("frequency [Hz]")]) == pytest.approx(np.sqrt(1.5e4) / (2 * np.pi), rel=1e-12)


def example() -> xr.Dataset:
    values = np.array([[[1 + 2j, 3 - 4j]], [[0.1, complex("nan+nanj")]]])
    return labelled(
        {
            "angle": (("speed", "order", "node"), values, "angle"),
            "mean": (("speed",), [5.0, 6.0], "torque"),
            "other": (("mode",), [7.0], "frequency"),
        },
        {
            "speed": ([10.0, 20.0], "speed"),
            "order": ([3.0], "engine_order"),
            "node": (["a", "b"], ""),
            "mode": ([0], ""),
        },
        analysis="example",
    )


def test_csv_has_a_row_for_each_place_and_two_columns_for_complex_values() -> None:
    header, *rows = csv.reader(io.StringIO(csv_text(example())))
    assert header == [
        "speed [rad/s]",
        "speed [rpm]",
        "order",
        "angle a real [rad]",
        "angle a imaginary [rad]",
        "angle b real [rad]",
        "angle b imaginary [rad]",
        "mean [Nm]",
    ]
    assert rows[0] == ["10.0", repr(10 * (30 / np.pi)), "3.0", "1.0", "2.0", "3.0", "-4.0", "5.0"]
    assert rows[1][3:] == ["0.1", "0.0", "", "", "6.0"]


def test_json_has_null_for_what_is_no_number_and_can_be_ascii() -> None:
    text = json_text({"value": float("nan"), "unit": "rad/s²", "list": (np.float64(0.1), np.inf, np.bool_(True))})
    assert json.loads(text) == {"value": None, "unit": "rad/s²", "list": [0.1, None, True]}
    assert escaped(text).isascii()
    assert json.loads(escaped(text)) == json.loads(text)


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "latin-1"])
def test_terminals_without_all_letters(process: Run, truck: str, encoding: str) -> None:
    command = ["map", truck, "--order", "3"]
    code = (
        "import sys; sys.stdout.reconfigure(encoding=sys.argv.pop(1)); from torsional.cli import main; code = main();"
        "sys.stdout.flush(); sys.stdout.reconfigure(encoding='utf-8'); sys.exit(code)"
    )
    told = process(encoding, *command, "--json", code=code)
    assert told.err == ""
    assert json.loads(told.out)["result"]["variables"]["acceleration_swing"]["units"] == "rad/s²"
    table = process(*command, PYTHONIOENCODING="ascii")
    assert table.err == ""
    assert "[rad/s?]" in table.out


@pytest.mark.skipif(os.name == "nt", reason="pseudo-terminals of POSIX")
@pytest.mark.parametrize(("variable", "coloured"), [("NOTHING", True), ("NO_COLOR", False)])
def test_colours_are_for_terminals_that_want_them(truck: str, variable: str, coloured: bool) -> None:
    import pty

    seen: list[bytes] = []

    def read(handle: int) -> bytes:
        seen.append(os.read(handle, 4096))
        return seen[-1]

    own = {"NO_COLOR": None, "TERM": "xterm", variable: "1"}
    line = " ".join(f"{key}={value}" for key, value in own.items() if value)
    code = "import sys; from torsional.cli import main; sys.exit(main())"
    status = pty.spawn(
        ["/bin/sh", "-c", f"unset NO_COLOR; {line} {sys.executable} -c '{code}' modes {truck} < /dev/null"], read
    )
    text = b"".join(seen).decode("utf-8")
    assert os.waitstatus_to_exitcode(status) == 0
    assert "DMF mode" in text
    assert ("\x1b[" in text) is coloured
