"""Raw channels of a rig straight into an identification: places, operating points, whole periods, refusals."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.studies.identification.plan import load_identification
from torsional.studies.raw_loops import Cut, Places, loops_of_run, places_of
from torsional.studies.rig_model import held_inertia, mounted_on_rig
from torsional.studies.rig_run import Encoder, RigSensors, measured_run

RIG = tv.load_model("examples/rig_dmf.yaml")
LINEAR = mounted_on_rig(RIG, tv.load_model("examples/truck_dmf.yaml"))
PLACES = Places("drive_fixture", "held_fixture", "torque_sensor")
MAPPING = """
torsional_mapping: 1
channels:
  phi_1: {quantity: angle, node: drive_fixture}
  phi_2: {quantity: angle, node: held_fixture}
  M: {quantity: torque, element: torque_sensor}
"""
PLAN = """
torsional_identify: 1
model: rig.json
over:
  - {parameter: absorber.stiffness, start: 10 kNm/rad, low: 5 kNm/rad, high: 30 kNm/rad}
  - {parameter: absorber.damping, start: 10, low: 1, high: 100}
measured:
  - kind: loops
    file: run.uff
    mapping: map.yaml
    points: [{name: 10 Hz, begin: 3 s, end: 4 s}, {begin: 6 s, end: 7.9 s}]
    zeros: false
"""


def written(folder: Path) -> Path:
    """A plan with the channels of a run at 450 rpm, swung at 10 and at 5 Hz, whose encoders count on."""
    time = np.arange(0.0, 8.0, 1e-3)
    push = 300.0 * np.clip(time, 0, 1) * np.sin(2 * np.pi * np.where(time < 4.0, 10.0, 5.0) * time)
    encoders = Encoder(noise=2e-5), Encoder(noise=2e-5)
    run = measured_run(LINEAR, time, push, 450 * tv.RPM, RigSensors(*encoders, torque_noise=1.0), mean=100.0, step=5e-4)
    turned = 450 * tv.RPM * time
    values = {
        "phi_1": (np.degrees(run.drive_angle.values + turned), "deg"),
        "phi_2": (np.degrees(run.held_angle.values + turned), "deg"),
        "M": (run.sensor_torque.values / 1e3, "kNm"),
    }
    channels = {name: ("time", told, {"units": unit}) for name, (told, unit) in values.items()}
    tv.write_measurement(xr.Dataset(channels, {"time": time}), folder / "run.uff")
    (folder / "rig.json").write_text(json.dumps(dict(LINEAR.document)), encoding="utf-8")
    (folder / "map.yaml").write_text(MAPPING, encoding="utf-8")
    (folder / "plan.yaml").write_text(PLAN, encoding="utf-8")
    return folder / "plan.yaml"


def test_a_flywheel_out_of_a_measurement_file(tmp_path: Path) -> None:
    """13 kNm/rad and 20 Nms/rad between the fixtures' clamps, the inertia before the sensor corrected for."""
    task = load_identification(written(tmp_path))
    (source,) = task.sources
    assert task.names == ("10 Hz", "loop 2") and source.ends == ("drive_fixture", "held_fixture")  # type: ignore[attr-defined]
    for loop, pace in zip(source.records, (10.0, 5.0), strict=True):  # type: ignore[attr-defined]
        assert loop.speed == pytest.approx(450 * tv.RPM, rel=0.02)
        assert loop.swing.period == pytest.approx(1.0 / pace, rel=1e-3)
        cycles = loop.time.size * 1e-3 * pace
        assert cycles == pytest.approx(round(cycles), abs=0.02)
    found = tv.identify(task)
    assert found.estimate.values == pytest.approx([13e3, 20.0], rel=0.02)
    assert found.misfit.values[0] < 1.2
    plan = (tmp_path / "plan.yaml").read_text(encoding="utf-8")
    (tmp_path / "plan.yaml").write_text(plan.replace("zeros: false", "zeros: false\n    inertia: 0"), encoding="utf-8")
    raw = tv.identify(load_identification(tmp_path / "plan.yaml"))
    assert raw.estimate.values[0] < 0.9 * 13e3  # as the free brake lets the sensor feel it


def channels(swing: float = 0.02, later: float = 0.02, turns: float = 50.0) -> xr.Dataset:
    """Angles of both sides at ``turns`` [rad/s] and a torque of 1000 Nm/rad, 20 cycles in 2 s."""
    time = np.arange(0.0, 2.0, 1e-3)
    angle = np.where(time < 1.0, swing, later) * np.sin(2 * np.pi * 10.0 * time)
    angles = np.column_stack([angle + turns * time, turns * time])
    return xr.Dataset(
        {"angle": (("time", "node"), angles), "torque": (("time", "element"), 1e3 * angle[:, None])},
        {"time": time, "node": ["drive_fixture", "held_fixture"], "element": ["torque_sensor"]},
    )


def test_loops_of_operating_points_by_hand() -> None:
    cuts = [Cut("slow", 0.0, 0.55), Cut("later", 1.2, 1.999)]
    for loop, cycles in zip(loops_of_run(channels(), PLACES, cuts), (5, 8), strict=True):
        assert loop.time.size == pytest.approx(100 * cycles, abs=1) and loop.speed == pytest.approx(50.0)
        np.testing.assert_allclose(loop.torque, 1e3 * loop.angle, atol=1e-9)
        assert np.hypot(*loop.swing.terms[1:3]) == pytest.approx(0.02, rel=1e-3)
    (whole,) = loops_of_run(channels(), PLACES)
    assert whole.name == "loop 1" and whole.time.size == pytest.approx(2000, abs=1)


def test_places_are_those_of_the_rig() -> None:
    data = channels()
    found = places_of(data, RIG, ("primary", "secondary"), "", None)
    assert found == ("drive_fixture", "held_fixture", "torque_sensor", held_inertia(RIG))
    assert places_of(data, RIG, ("primary", "secondary"), "", 0.3).inertia == 0.3
    named = data.assign_coords(node=["primary", "secondary"])
    assert places_of(named, RIG, ("primary", "secondary"), "", None) == ("primary", "secondary", "torque_sensor", 0.0)


@pytest.mark.parametrize(
    ("cut", "speed", "data", "told"),
    [
        (Cut("p", 1.0, 3.0), None, channels(), r"p: the operating point is not in the run; found 1 to 3 s"),
        (Cut("p", 0.5, 1.5), None, channels(later=0.03), r"p: the swing is not steady.*cut where it has settled"),
        (Cut("p", 0.0, 1.0), None, channels(turns=0.0), r"p: the channels tell no rotational speed.*give speed"),
        (Cut("p", 0.0, 0.05), None, channels(), r"less than one cycle"),
    ],
)
def test_runs_that_make_no_loop(cut: Cut, speed: float | None, data: xr.Dataset, told: str) -> None:
    with pytest.raises(ModelError, match=told):
        loops_of_run(data, PLACES, [cut], speed)
    assert loops_of_run(channels(turns=0.0), PLACES, speed=0.0)[0].speed == 0.0


def test_channels_that_are_missing() -> None:
    data, ends = channels(), ("primary", "secondary")
    with pytest.raises(ModelError, match="no torque of the sensor; found 'none'; map the torque"):
        places_of(data.drop_vars("torque"), RIG, ends, "", None)
    with pytest.raises(ModelError, match="did you mean 'torque_sensor'"):
        places_of(data, RIG, ends, "torque_senser", None)
    with pytest.raises(ModelError, match="no angles of both sides; found drive_fixture; allowed: primary"):
        places_of(data.assign(angle=data.angle.where(data.node == "drive_fixture")), RIG, ends, "", None)
