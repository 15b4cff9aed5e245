"""`torsional identify` and `torsional correlate`: what they print and write, and what they refuse."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import torsional as tv

EXAMPLES = Path(__file__).parents[2] / "examples"
TABLE, TRUCK = EXAMPLES / "plans" / "gearbox_orders.csv", EXAMPLES / "truck_smf.yaml"
Run = Callable[..., Any]
PLAN = f"""
torsional_identify: 1
name: one parameter
model: {TRUCK}
over:
  - {{parameter: clutch.stiffness, low: 15 kNm/rad, high: 60 kNm/rad}}
measured:
  - {{kind: orders, file: orders.csv, place: gearbox_input, torque: 1500 Nm}}
"""


def test_identify_prints_and_writes(torsional: Run) -> None:
    shutil.copy(TABLE, "orders.csv")
    Path("plan.yaml").write_text(PLAN, encoding="utf-8")
    told = torsional(
        "identify", "plan.yaml", "-o", "a.html", "-o", "a.nc", "-o", "a.csv", "-o", "a.json", "-o", "a.png"
    )
    assert told.code == 0, told.err
    assert "clutch.stiffness" in told.out and "25 kNm/rad" in told.out
    found = tv.load_results("a.nc")
    document = json.loads(Path("a.json").read_text(encoding="utf-8"))
    assert document["result"]["variables"]["estimate"]["values"] == found.estimate.values.tolist()
    assert document["settings"]["confidence"] == 0.95
    page = Path("a.html").read_text(encoding="utf-8")
    assert "one parameter" in page and "What the data tell" in page
    assert Path("a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nothing.yaml"], "nothing.yaml: there is no such file"),
        ([EXAMPLES / "plans" / "tolerances.yaml"], "torsional sweep takes this plan"),
        ([EXAMPLES / "plans" / "clutch_from_orders.yaml", "-o", "a.pdf"], "'.pdf'"),
    ],
)
def test_what_cannot_be_identified_is_told(torsional: Run, arguments: list[str], told: str) -> None:
    found = torsional("identify", *arguments)
    assert found.code == 2 and told in found.err and not list(Path.cwd().iterdir())


def test_correlate_with_a_model_and_with_its_result(torsional: Run) -> None:
    """The table was made with 27 kNm/rad and 38 Nms/rad, not with the file's own values."""
    own = ["--node", "gearbox_input", "--torque", "1500"]
    right = ["--set", "clutch.stiffness=27kNm/rad", "--set", "clutch.damping=38"]
    told = torsional("correlate", TABLE, TRUCK, *own, *right, "-o", "c.html", "-o", "c.nc", "-o", "c.svg")
    assert told.code == 0, told.err
    found = tv.load_results("c.nc")
    assert found.frac.values.min() > 0.995 and np.abs(found.amplitude_error.values).max() < 0.02
    assert np.abs(found.phase_difference.values).max() < np.radians(1.0)
    assert "FRAC" in Path("c.html").read_text(encoding="utf-8")
    off = json.loads(torsional("correlate", TABLE, TRUCK, *own, "--json").out)
    assert off["result"]["variables"]["relative_deviation"]["values"][0] > 0.1
    speeds = tv.load_results("c.nc").speed.values
    truck = tv.changed(tv.load_model(TRUCK), *right[1::2])
    tv.save_results(tv.run_up_response(truck, speeds, np.full(speeds.size, 1500.0), orders=[3.0, 6.0]), "r.nc")
    again = json.loads(torsional("correlate", TABLE, "r.nc", "--node", "gearbox_input", "--json").out)
    assert again["result"]["variables"]["frac"]["values"] == pytest.approx(found.frac.values.tolist(), rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([TABLE, TRUCK], "one place is compared"),
        ([TABLE, TRUCK, "--node", "gearbx"], "no such place"),
        ([TABLE, TRUCK, "--node", "gearbox_input", "--amplitude", "rms"], "allowed: 0-peak, RMS, peak-to-peak"),
        ([TABLE, "r.nc", "--node", "gearbox_input", "--set", "clutch.damping=1"], "a result was computed as it is"),
        ([TABLE, "r.nc", "--node", "gearbox_input"], "r.nc"),
        ([TRUCK, TABLE, "--node", "gearbox_input"], "truck_smf.yaml"),
    ],
)
def test_what_cannot_be_compared_is_told(torsional: Run, arguments: list[str], told: str) -> None:
    found = torsional("correlate", *arguments, "-o", "c.html")
    assert found.code == 2 and told in found.err and not list(Path.cwd().iterdir())
