"""`torsional hysteresis`: what it tells people, scripts and files, and what it refuses."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from tests.shipped import EXAMPLES

from torsional.cli.hysteresis import listed
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.results import load_results
from torsional.solvers.hysteresis import model_hysteresis
from torsional.units import RPM

Run = Callable[..., Any]
SHOES = str(EXAMPLES / "truck_dmf_straight_spring.yaml")
ASKED = ["--speed", "0,2000rpm", "--sweep", "5,12deg"]


def test_table_for_people(torsional: Run) -> None:
    told = torsional("hysteresis", SHOES, *ASKED)
    assert told.code == 0 and told.err.startswith("warning: 1 of 4 loops do not repeat")
    rows = [line.split() for line in told.out.splitlines() if line.split()[:1] in (["5"], ["12"])]
    assert [row[:2] for row in rows] == [["5", "0"], ["5", "2000"], ["12", "0"], ["12", "2000"]]
    data = model_hysteresis(load_model(SHOES), np.array([0, 2000]) * RPM, np.radians([5.0, 12.0]))
    assert (data.attrs["turned"], data.attrs["held"]) == ("primary", "secondary")
    assert not data.angle.sel(node="secondary").values.any() and data.angle.sel(node="primary").values.any()
    loss = data.loss.values.T.ravel()
    assert [float(row[4]) for row in rows] == pytest.approx(loss, rel=1e-3)
    assert float(data.loss[1, 1]) > float(data.loss[0, 1]) > 0
    assert "sliding, of 15" in told.out and "primary against secondary in gear 12, 3°/s" in told.out


def test_files_of_every_kind(torsional: Run) -> None:
    more = [part for suffix in (".nc", ".csv", ".json", ".png", ".svg") for part in ("-o", f"out{suffix}")]
    told = torsional("hysteresis", SHOES, *ASKED, "--json", *more)
    assert told.code == 0, told.err
    assert Path("out.json").read_text(encoding="utf-8") == told.out
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse("out.svg").getroot().tag.endswith("svg")
    saved = load_results("out.nc")
    assert saved.attrs["held"] == "secondary" and saved.sizes["element"] > 30
    rows = list(csv.DictReader(io.StringIO(Path("out.csv").read_text(encoding="utf-8-sig"))))
    assert len(rows) == saved.drive_torque.size
    assert [float(row["drive_torque [Nm]"]) for row in rows[:5]] == pytest.approx(saved.drive_torque.values.ravel()[:5])
    settings = json.loads(told.out)["settings"]
    assert settings["rate"] == {"value": pytest.approx(np.radians(3.0)), "units": "rad/s"}


def test_beyond_the_stop_is_said(torsional: Run) -> None:
    told = torsional("hysteresis", SHOES, "--speed", "0rpm", "--sweep", "10,18deg")
    assert told.code == 0
    assert "±18 deg goes beyond the stop of dmf" in told.err and "±10 deg" not in told.err


def test_without_a_sweep_it_goes_to_just_before_the_stop(torsional: Run) -> None:
    told = torsional("hysteresis", SHOES, "--speed", "0rpm", "--json")
    assert told.code == 0 and "beyond" not in told.err
    sweep = json.loads(told.out)["result"]["coordinates"]["sweep"]["values"]
    assert sweep == [pytest.approx(0.95 * np.radians(15.98), rel=1e-3)]


def test_a_plain_spring_has_no_loss(torsional: Run, truck: str) -> None:
    told = torsional("hysteresis", truck, "--speed", "0rpm", "--sweep", "5deg", "--rate", "1e-6deg/s", "--json")
    assert told.code == 0, told.err
    found = json.loads(told.out)["result"]["variables"]
    assert found["stiffness"]["values"] == [[pytest.approx(13e3)]]
    assert found["loss"]["values"] == [[pytest.approx(0.0, abs=1e-6)]]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--rate", "-3deg/s"], "--rate"),
        (["--sweep", "0deg"], "--sweep"),
        (["--sweep", "5Nm"], "--sweep"),
        (["--speed", "0:4000rpm"], "how many values are meant?"),
        (["--speed", "-100rpm"], "does not turn backwards"),
        (["--turned", "primry"], "did you mean 'primary'"),
        (["--held", "primary"], "turn as one"),
        (["--held", "vehicle"], "different mean speeds"),
    ],
)
def test_refusals(torsional: Run, arguments: list[str], told: str) -> None:
    answer = torsional("hysteresis", SHOES, *arguments)
    assert answer.code == 2 and answer.out == ""
    assert told in answer.err


@pytest.mark.parametrize("name", ["truck_smf", "marine_line"])
def test_absorbers_without_springs_are_refused(torsional: Run, name: str) -> None:
    answer = torsional("hysteresis", EXAMPLES / f"{name}.yaml")
    assert answer.code == 2 and ("no absorber spring" in answer.err or "where its absorber begins" in answer.err)


def test_lists_of_values() -> None:
    assert listed("0,2000,4000rpm", "speed", "--speed") == pytest.approx(np.array([0, 2000, 4000]) * RPM)
    assert listed("60, 5 deg", "relative_angle", "--sweep") == pytest.approx(np.radians([5, 60]))
    assert listed("0.1rad,10deg", "relative_angle", "--sweep") == pytest.approx([0.1, np.radians(10)])
    assert listed("0:4000:1000rpm", "speed", "--speed") == pytest.approx(np.arange(5) * 1000 * RPM)
    with pytest.raises(ModelError):
        listed("5,,deg", "relative_angle", "--sweep")


def test_a_pendulum_beside_the_springs_changes_no_loop(torsional: Run, truck: str) -> None:
    asked = ["--speed", "0,2000rpm", "--sweep", "5deg"]
    plain, with_pendulum = (
        torsional("hysteresis", model, *asked) for model in (truck, str(EXAMPLES / "truck_dmf_pendulum.yaml"))
    )
    assert (with_pendulum.code, with_pendulum.err) == (0, "")
    assert with_pendulum.out == plain.out
