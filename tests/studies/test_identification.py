"""Identifications by a plan: order curves, loops and histories; other models, points held back, refusals."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.solvers.hysteresis import Course, followed
from torsional.studies.identification.plan import load_identification
from torsional.studies.identification.result import identify
from torsional.studies.records import write_loops
from torsional.studies.rig import Point, Sensors, _record
from torsional.system import assemble

EXAMPLES = Path(__file__).parents[2] / "examples"
PLAN = EXAMPLES / "plans" / "clutch_from_orders.yaml"


@pytest.fixture(scope="module")
def clutch() -> xr.Dataset:
    return identify(load_identification(PLAN))


def test_the_clutch_that_the_orders_were_made_with(clutch: xr.Dataset) -> None:
    """27 kNm/rad and 38 Nms/rad, noise of 2 % of the RMS in real and imaginary part."""
    for place, true in enumerate((27e3, 38.0)):
        low, high = clutch.interval_low.values[place], clutch.interval_high.values[place]
        assert low <= true <= high and (high - low) / true < 0.03
    assert clutch.misfit.values[0] == pytest.approx(1.0, abs=0.15)
    assert clutch.held_misfit.values[0] == pytest.approx(1.0, abs=0.2)  # order 6, which the fit has not seen
    assert list(clutch.held.values) == [0, 1]


def test_the_model_without_damping_is_rejected(clutch: xr.Dataset) -> None:
    assert clutch.model.values.tolist() == ["clutch with its damping", "without damping"]
    assert clutch.parameters.values.tolist() == [2, 1]
    assert clutch.aicc.values[1] - clutch.aicc.values[0] > 100 and clutch.bic.values[1] - clutch.bic.values[0] > 100
    assert "without damping is rejected" in clutch.attrs["findings"]
    assert set(json.loads(clutch.attrs["estimates"])["without damping"]) == {"clutch.stiffness"}


def test_profiles_rise_as_the_deviations_say(clutch: xr.Dataset) -> None:
    """Of an all but linear problem the root of the rise is the way in standard deviations."""
    off = (clutch.profile_value - clutch.estimate) / clutch.deviation
    assert np.abs(clutch.profile_rise.values - off.values**2).max() < 0.05 * 9


def test_it_goes_into_a_file_and_back(clutch: xr.Dataset, tmp_path: Path) -> None:
    again = tv.load_results(tv.save_results(clutch, tmp_path / "found.nc"))
    assert again.estimate.values.tolist() == clutch.estimate.values.tolist()


SPRING = """
torsional: 1
name: a spring with a washer
components:
  a: {type: inertia, inertia: 1}
  b: {type: inertia, inertia: 1}
  spring: {type: shaft, a: b, b: a, stiffness: 1000}
  washer: {type: friction_washer, a: b, b: a, friction_torque: 5, friction_stiffness: 10000}
"""
LOOPS = """
torsional_identify: 1
model: spring.yaml
over:
  - {parameter: components.spring.stiffness, start: 700, low: 200, high: 3000}
  - {parameter: components.washer.friction_torque, start: 9, low: 0.5, high: 50}
measured:
  - {kind: loops, file: loops.csv, turned: a, held: b, weights: {loop 2: 0.5}}
models:
  no friction: {set: [components.washer.friction_torque=1e-9]}
"""


def test_loops_of_a_washer(tmp_path: Path) -> None:
    (tmp_path / "spring.yaml").write_text(SPRING, encoding="utf-8")
    system = assemble(tv.load_model(tmp_path / "spring.yaml").powertrain())
    draw, sensors, records = np.random.default_rng(2), Sensors(0.02, torque_offset=3.0), []
    for sweep in (0.02, 0.05):
        point = Point(0.0, sweep, 0.0, 5.0)
        drive = sweep * np.sin(2 * np.pi * np.arange(1, 641) / 640)
        (met,) = followed(system, "a", "b", [Course.through(0.0, drive, 0.2)])
        records.append(_record(point, drive, met.torque, sensors, draw))
    write_loops(records, tmp_path / "loops.csv")
    (tmp_path / "plan.yaml").write_text(LOOPS, encoding="utf-8")
    found = identify(load_identification(tmp_path / "plan.yaml"))
    told = dict(zip(found.parameter.values.tolist(), range(4), strict=True))
    for name, true in (("components.spring.stiffness", 1000.0), ("components.washer.friction_torque", 5.0)):
        estimate, deviation = found.estimate.values[told[name]], found.deviation.values[told[name]]
        assert abs(estimate - true) < 4 * deviation and deviation < 0.02 * true
    assert found.misfit.values[0] == pytest.approx(1.0, abs=0.03) and found.misfit.values[1] > 1.5
    # a straight spring cannot part the two zeros: T₀ − k φ₀ is told, what goes along with it is not
    assert not np.isfinite(found.deviation.values[told["torque_offset"]])
    stiffness = found.estimate.values[told["components.spring.stiffness"]]
    zero = found.estimate.values[told["torque_offset"]] - stiffness * found.estimate.values[told["angle_offset"]]
    assert zero == pytest.approx(3.0, abs=0.1)
    assert "of which the data tell nothing" in found.attrs["findings"]


HISTORY = """
torsional_identify: 1
model: MODEL
over:
  - {parameter: clutch.damping, start: 80, low: 5, high: 300}
measured:
  - {kind: history, file: run.csv, place: gearbox_input, scenario: tip.yaml, noise: 0.02}
"""
TIP = """
torsional_scenario: 1
scenario: tip_in
"""


@pytest.mark.full
def test_a_signal_in_time(tmp_path: Path) -> None:
    truck = tv.load_model(EXAMPLES / "truck_smf.yaml")
    (tmp_path / "tip.yaml").write_text(TIP, encoding="utf-8")
    run = tv.run_scenario(tv.changed(truck, "clutch.damping=30"), str(tmp_path / "tip.yaml"))
    signal = run.angular_velocity.sel(node="gearbox_input")
    rows = np.column_stack([run.time.values, signal.values])[10::40].tolist()
    text = "time [s],angular_velocity [rad/s]\n" + "".join(f"{time!r},{value!r}\n" for time, value in rows)
    (tmp_path / "run.csv").write_text(text, encoding="utf-8")
    (tmp_path / "plan.yaml").write_text(HISTORY.replace("MODEL", str(EXAMPLES / "truck_smf.yaml")), encoding="utf-8")
    found = identify(load_identification(tmp_path / "plan.yaml"))
    assert found.estimate.values[0] == pytest.approx(30.0, rel=1e-3)


def test_a_channel_of_a_measurement_is_a_signal(tmp_path: Path) -> None:
    """A speed in rpm that comes 0.1 s late, of a file that a logger writes."""
    time = np.arange(0.0, 1.0, 1e-3)
    speed = 1000.0 + 20.0 * np.sin(30.0 * time)
    data = xr.Dataset({"n_in": ("time", speed, {"units": "1/min"})}, {"time": time})
    tv.write_measurement(data, tmp_path / "run.uff")
    mapping = "torsional_mapping: 1\nchannels: {n_in: {quantity: angular_velocity, node: gearbox_input, delay: 0.1 s}}"
    (tmp_path / "map.yaml").write_text(mapping, encoding="utf-8")
    (tmp_path / "tip.yaml").write_text(TIP, encoding="utf-8")
    plan = HISTORY.replace("MODEL", str(EXAMPLES / "truck_smf.yaml")).replace("run.csv", "run.uff, mapping: map.yaml")
    (tmp_path / "plan.yaml").write_text(plan, encoding="utf-8")
    (source,) = load_identification(tmp_path / "plan.yaml").sources
    point, shown = source.points[0], source.shown(0, source.points[0].values)
    assert shown.axis[0] == 0.0 and shown.quantity == "angular_velocity"
    assert point.values == pytest.approx(speed[100:] * tv.RPM)
    (tmp_path / "plan.yaml").write_text(plan.replace("place: gearbox_input", "place: flywheel"), encoding="utf-8")
    with pytest.raises(ModelError, match="the mapping brings no signal to this place"):
        load_identification(tmp_path / "plan.yaml")


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("torsional_identify: 1", "torsional_sweep: 1"), "torsional sweep takes this plan"),
        (("clutch.stiffness, low", "clutch.stifness, low"), "did you mean 'stiffness'"),
        (("low: 15 kNm/rad", "low: 15 rpm"), "over.0.low"),
        (("low: 15 kNm/rad", "low: 50 kNm/rad"), "the bounds do not hold the start"),
        (("place: gearbox_input", "place: gearbox"), "the model has no such node"),
        (("gearbox_orders, order 6", "order 6"), "there is no such point"),
        (
            ('gearbox_orders, order 6"', 'gearbox_orders, order 6", "gearbox_orders, order 3"'),
            "all points are held back",
        ),
        (("clutch.damping=0", "clutch.dampin=0"), "models.without damping.set"),
        (("confidence: 95 %", "confidence: 120 %"), "must be below 1"),
        (("gearbox_orders.csv", "nothing.csv"), "nothing.csv"),
        (("kind: orders", "kind: order"), "measured.0"),
        (("parameter: clutch.damping", "parameter: clutch.stiffness"), "named twice"),
    ],
)
def test_plans_that_are_none(change: tuple[str, str], told: str, tmp_path: Path) -> None:
    text = PLAN.read_text(encoding="utf-8")
    assert change[0] in text
    text = text.replace(*change).replace("../truck_smf.yaml", str(EXAMPLES / "truck_smf.yaml"))
    (tmp_path / "plan.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "gearbox_orders.csv").write_bytes((PLAN.parent / "gearbox_orders.csv").read_bytes())
    with pytest.raises(ModelError, match=told) as caught:
        load_identification(tmp_path / "plan.yaml")
    assert "plan.yaml" in str(caught.value) or "nothing.csv" in str(caught.value)


def test_values_that_go_together_keep_their_ratio() -> None:
    task = load_identification(EXAMPLES / "plans" / "rig_friction.yaml")
    own = task.candidates[0]
    made = own.made()({"absorber.friction.sliding_coefficient": 0.2, "torque_offset": 5.0})
    friction = made.document["absorber"]["friction"]
    assert friction["static_coefficient"] == pytest.approx(0.25)
    assert [unknown.name for unknown in task.candidates[1].unknowns][-3:] == [
        "absorber.friction.sliding_coefficient",
        "torque_offset",
        "angle_offset",
    ]
    assert task.names == tuple(f"loop {n}" for n in range(1, 7)) and len(task.parts(held=False)[0].points) == 5
