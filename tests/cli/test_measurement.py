"""`torsional measurement`: what is shown, converted, mapped; what ends with exit code 2 and one message."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.measurements.recordings import rig

from torsional import load_results
from torsional.measurements import read_measurement, write_measurement

Run = Callable[..., Any]
PLAN = """\
torsional_mapping: 1
channels:
  n_mot: {quantity: angular_velocity, node: primary}
"""


@pytest.fixture
def file() -> str:
    return str(write_measurement(rig(), "rig.mf4"))


def test_show_tells_channels_units_rates_and_ranges(torsional: Run, file: str) -> None:
    told = torsional("measurement", "show", file)
    assert (told.code, told.err) == (0, "")
    title, heading, _, first, *_ = told.out.splitlines()
    assert title == "rig.mf4: MDF 4.10, 4 channels, begun 2026-11-23T05:42:11.250000"
    assert heading.split() == ["channel", "unit", "samples", "rate", "[Hz]", "over", "[s]", "range"]
    assert first.split() == ["n_mot", "1/min", "400", "2000", "0", "to", "0.2", "1497", "to", "1503"]
    assert "399/400" in told.out and "pulses" in told.out and "uneven" in told.out


def test_show_as_json(torsional: Run, file: str) -> None:
    told = json.loads(torsional("measurement", "show", file, "--json").out)
    speed, torque, _, tacho = told["channels"]
    assert (speed["channel"], speed["units"], speed["rate"], speed["samples"]) == ("n_mot", "1/min", 2000.0, 400)
    assert torque["missing"] == 1 and tacho["kind"] == "pulses" and tacho["rate"] is None
    assert speed["most"] == pytest.approx(float(rig().n_mot.max()), rel=1e-15)


def test_show_with_a_mapping_tells_nodes_in_si(torsional: Run, file: str, truck: str) -> None:
    Path("rig.yaml").write_text(PLAN)
    told = torsional("measurement", "show", file, "--mapping", "rig.yaml", "--model", truck, "--json")
    (speed,) = json.loads(told.out)["channels"]
    assert (speed["channel"], speed["units"]) == ("angular_velocity primary", "rad/s")
    assert speed["most"] == pytest.approx(float(rig().n_mot.max()) * np.pi / 30, rel=1e-12)


def test_convert_writes_what_other_programs_open(torsional: Run, file: str) -> None:
    told = torsional("measurement", "convert", file, "rig.uff")
    assert (told.code, told.out, told.err) == (0, "", "written: rig.uff\n")
    np.testing.assert_array_equal(read_measurement("rig.uff").n_mot, rig().n_mot)
    Path("rig.yaml").write_text(PLAN)
    assert torsional("measurement", "convert", file, "rig.nc", "-m", "rig.yaml", "-q").code == 0
    assert load_results("rig.nc").angular_velocity.dims == ("time", "node")
    assert torsional("measurement", "convert", "rig.nc", "rig.csv").code == 0
    assert Path("rig.csv").read_text(encoding="utf-8-sig").startswith("time [s],angular_velocity primary [rad/s]")


def test_convert_replaces_nothing_unasked(torsional: Run, file: str) -> None:
    Path("mine.csv").write_text("mine")
    told = torsional("measurement", "convert", file, "mine.csv")
    assert (told.code, Path("mine.csv").read_text()) == (2, "mine")
    assert told.err == "error: mine.csv: the file is there already; choose another name, or say --force\n"
    assert torsional("measurement", "convert", file, "mine.csv", "--force").code == 0
    told = torsional("measurement", "convert", file, file, "--force")
    assert told.code == 2 and "OUTPUT: this would overwrite an input file" in told.err


def test_mapping_begins_one(torsional: Run, file: str) -> None:
    assert torsional("measurement", "mapping", file, "-o", "new.yaml").code == 0
    Path("new.yaml").write_text(Path("new.yaml").read_text().replace("NAME", "primary"))
    told = torsional("measurement", "show", file, "-m", "new.yaml")
    assert told.code == 2 and "channels.channel_2: values are missing; found 1 of 400 samples" in told.err
    assert torsional("measurement", "mapping", file).out.startswith("# Which channel is which quantity")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["show", "gone.mf4"], "gone.mf4: there is no such file; did you mean 'rig.mf4'?"),
        (["show", "."], ".: this is a folder, not a file; name the file in it"),
        (["show", "empty.mf4"], "empty.mf4: the file is empty"),
        (["show", "cut.mf4"], "cut.mf4: the file is cut: a block lies beyond its end"),
        (["show", "text.mf4"], "text.mf4: this is no MDF 4 file; found it begins with b'hello'"),
        (["show", "locked.csv"], "locked.csv: the file may not be read; ask for permission to read it"),
        (["show", "rig.mf4", "--model", "m.yaml"], "--model: a model is asked for with a mapping; say which channels"),
        (["convert", "rig.mf4", "rig.xls"], "OUTPUT: the ending of the file says what is written"),
        (["convert", "rig.mf4", "rig.nc"], "OUTPUT: the ending of the file says what is written"),
        (["convert", "rig.mf4", "gone/rig.csv"], "OUTPUT: there is no such folder; found 'gone'"),
        (["convert", "rig.mf4"], "Missing argument 'OUTPUT'"),
        (["shwo"], "No such command 'shwo'. Did you mean 'show'?"),
    ],
)
def test_what_is_wrong_ends_with_one_message(torsional: Run, file: str, arguments: list[str], told: str) -> None:
    data = Path(file).read_bytes()
    Path("empty.mf4").write_bytes(b"")
    Path("cut.mf4").write_bytes(data[:3000])
    Path("text.mf4").write_text("hello")
    Path("locked.csv").write_text("time [s],a\n0,1\n1,2\n")
    Path("locked.csv").chmod(0)
    if "locked.csv" in arguments and os.access("locked.csv", os.R_OK):
        pytest.skip("this user reads everything")
    before = sorted(Path().iterdir())
    answer = torsional("measurement", *arguments)
    assert (answer.code, answer.out, sorted(Path().iterdir())) == (2, "", before)
    assert answer.err.startswith(f"error: {told}") and answer.err.count("\n") == 1


def test_alone_it_lists_its_commands(torsional: Run) -> None:
    told = torsional("measurement")
    assert told.code == 0 and all(name in told.out for name in ("show", "convert", "mapping"))
