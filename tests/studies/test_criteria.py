"""Criteria: single figures of a design, by one definition, each against figures found another way."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.laws import Hinges
from torsional.model import Model
from torsional.studies.down_speeding import worst
from torsional.studies.friction import WASHER, answered, washed
from torsional.studies.sweeps.absorbers import EnvelopeRun, FrictionRun, InertiaRun
from torsional.studies.sweeps.criteria import CriteriaRun, selected
from torsional.studies.sweeps.plan import load_plan
from torsional.studies.swinging import share_of_way
from torsional.studies.trucks import Trucks, replaced

ROOT = Path(__file__).parents[2]
TRUCKS = Trucks.shipped()
RUN = {
    "analysis": "criteria",
    "ask": {"worst": {"analysis": "envelope", "step": "100 rpm"}, "whole": {"analysis": "inertia"}},
    "criteria": {
        "low": {"of": "worst", "figure": "acceleration_swing", "select": {"speed": "600:1000 rpm"}},
        "top": {"of": "worst", "figure": "acceleration_swing", "worst": "mean", "select": {"gear": ["11", "12"]}},
        "space": {"of": "whole", "figure": "inertia"},
        "flywheels": {"sum": ["absorber.primary_inertia", "absorber.secondary_inertia"]},
    },
}


def asked(**blocks: Any) -> CriteriaRun:
    return CriteriaRun.model_validate(RUN | blocks)


def test_criteria_are_single_figures_with_units() -> None:
    found = asked()(TRUCKS.dmf)
    envelope = EnvelopeRun(analysis="envelope", step=100 * tv.RPM)(TRUCKS.dmf).acceleration_swing
    low = envelope.where(envelope.speed < 1001 * tv.RPM).max()
    assert {name: float(value) for name, value in found.data_vars.items()} == {
        "low": float(low),
        "top": pytest.approx(float(envelope.sel(gear=["11", "12"]).mean()), rel=1e-14),
        "space": pytest.approx(2.2),
        "flywheels": pytest.approx(2.2),
    }
    assert {name: found[name].attrs["units"] for name in found} == {
        "low": "rad/s²",
        "top": "rad/s²",
        "space": "kgm²",
        "flywheels": "kgm²",
    }


def test_the_envelope_is_the_worst_of_the_map_and_of_the_run_up() -> None:
    """Against response_map at the worst speed, and the full-load run-up, which know nothing of reciprocity."""
    found = EnvelopeRun(analysis="envelope", gears=["12"], loads=[1.0])(TRUCKS.dmf)
    run_up = tv.run_up_response(TRUCKS.dmf, found.speed.values, gear="12", orders=[3.0])
    size = abs(run_up.angle.sel(node="gearbox_input", order=3.0)) * (3 * run_up.speed) ** 2
    np.testing.assert_allclose(found.acceleration_swing.sel(gear="12"), size, rtol=1e-8)
    spring = run_up.sel(element="dmf").isel(order=0)
    twist = (abs(spring.mean_twist) + abs(spring.twist)).max()
    assert float(found.twist.sel(element="dmf")) == pytest.approx(float(twist), rel=1e-8)
    assert float(found.reach.sel(element="dmf")) == pytest.approx(float(twist) / (3500 / 13e3), rel=1e-8)
    omega = 3 * found.speed.values
    loss = 0.5 * 20.0 * abs(omega * spring.twist.values) ** 2
    assert float(found.loss.sel(element="dmf")) == pytest.approx(loss.max(), rel=1e-8)


def test_the_envelope_is_that_of_down_speeding() -> None:
    found = EnvelopeRun(analysis="envelope", step=10 * tv.RPM)(TRUCKS.tva)
    known = worst(TRUCKS.tva)
    assert float(found.acceleration_swing.max()) == known.acceleration
    assert float(found.reach.max()) == known.reach
    assert found.element.values.tolist() == list(TRUCKS.tva.landmarks.springs)


def test_a_pendulum_has_its_way_too() -> None:
    found = EnvelopeRun(analysis="envelope", gears=["12"], loads=[1.0])(TRUCKS.pendulum)
    speeds = found.speed.values
    full = TRUCKS.pendulum.full_load(speeds)
    shares = []
    for speed, torque in zip(speeds, full, strict=True):  # linear: the share goes with the excitation of the load
        ratio = _drive(TRUCKS.pendulum, speed, torque) / _drive(TRUCKS.pendulum, speed, 0.6 * 2500.0)
        shares.append(float(share_of_way(TRUCKS.pendulum, np.array([speed]))[0]) * ratio)
    assert float(found.reach.sel(element="pendulum.suspension")) == pytest.approx(max(shares), rel=1e-6)


def _drive(model: Model, speed: float, torque: float) -> float:
    """Size of the firing order of one cylinder's torque."""
    found = model.running_engine.harmonics(np.array([speed]), np.array([torque]), np.array([3.0]))
    return float(np.abs(found.sum(axis=-2)).ravel()[0])


@pytest.mark.parametrize(
    ("concept", "inertia"),
    [("smf", 1.9), ("dmf", 2.2), ("psva", 2.41), ("tva", 2.5), ("pendulum", 2.2 + 4 * 0.15**2)],
)
def test_the_inertia_is_that_of_all_bodies(concept: str, inertia: float) -> None:
    found = InertiaRun(analysis="inertia")(TRUCKS.models[concept])
    assert float(found.inertia) == pytest.approx(inertia)


def test_bodies_count_as_they_are_not_as_the_file_said() -> None:
    heavier = replaced(TRUCKS.dmf, "primary", inertia=2.0)
    assert float(InertiaRun(analysis="inertia")(heavier).inertia) == pytest.approx(3.0)


def test_friction_is_that_of_the_study() -> None:
    model, ends = washed(TRUCKS.smf, 60.0), (600 * tv.RPM, 1500 * tv.RPM)
    found, known = FrictionRun(analysis="friction")(model), answered(model, ends)
    assert float(found.peak) == pytest.approx(known.peak[0], rel=1e-9)
    assert float(found.far_power) == pytest.approx(known.power[-1], rel=1e-9)
    with pytest.raises(ModelError, match="no such friction"):
        FrictionRun(analysis="friction", element=f"{WASHER}s")(model)


def test_values_are_selected_by_labels_and_by_numbers_with_units() -> None:
    values = xr.DataArray(
        np.arange(6.0).reshape(2, 3),
        dims=("gear", "speed"),
        coords={"gear": ["1", "2"], "speed": ("speed", np.array([600, 700, 800]) * tv.RPM, {"quantity": "speed"})},
    )
    assert selected(values, "gear", 2).values.tolist() == [[3.0, 4.0, 5.0]]
    assert selected(values, "speed", "700 rpm").values.tolist() == [[1.0], [4.0]]
    assert selected(values, "speed", "650:800 rpm").values.tolist() == [[1.0, 2.0], [4.0, 5.0]]
    for dimension, label, told in (
        ("speed", "650 rpm", "no such value"),
        ("speed", "610:650 rpm", "no value lies"),
        ("gear", "3", "no such label"),
        ("order", 3, "no such dimension"),
    ):
        with pytest.raises(ModelError, match=told):
            selected(values, dimension, label)


BAD = [
    ({"x": {"of": "wort", "figure": "twist"}}, ["run.criteria.x.of", "'wort'", "did you mean 'worst'?"]),
    ({"x": {"of": "worst", "figure": "twst"}}, ["run.criteria.x.figure", "'twst'", "did you mean 'twist'?"]),
    ({"x": {"of": "worst"}}, ["run.criteria.x", "a figure of an analysis, or a sum"]),
    ({"x": {"sum": ["clutch.stifness"]}}, ["run.criteria.x.sum", "'clutch.stifness'"]),
    ({"x": {"sum": ["clutch.stiffness", "clutch.inertia"]}}, ["no sum", "inertia, stiffness"]),
]


@pytest.mark.parametrize(("criteria", "told"), BAD)
def test_criteria_that_cannot_be_are_told_before_any_work(criteria: dict[str, Any], told: list[str]) -> None:
    with pytest.raises(ModelError) as caught:
        asked(criteria=criteria).refuse_unknown(TRUCKS.dmf)
    assert [part for part in told if part not in str(caught.value)] == []


PLAN = """
torsional_sweep: 1
model: {model}
over: [{{parameter: clutch.stiffness, values: [2e4, 3e4]}}]
run:
  analysis: criteria
  ask: {{worst: {{analysis: {analysis}, step: 200 rpm}}}}
  criteria: {{low: {{of: worst, figure: acceleration_swing}}}}
"""


def test_a_plan_asks_criteria(tmp_path: Path) -> None:
    plan = tmp_path / "plan.yaml"
    plan.write_text(PLAN.format(model=ROOT / "examples" / "truck_dmf.yaml", analysis="envelope"), encoding="utf-8")
    work = load_plan(plan).work
    found = work.run(changed(TRUCKS.dmf, {"clutch.stiffness": 2e4}))
    assert float(found["low"]) == pytest.approx(  # type: ignore[arg-type]
        float(EnvelopeRun(analysis="envelope", step=200 * tv.RPM)(replaced_clutch(2e4)).acceleration_swing.max())
    )
    plan.write_text(PLAN.format(model=ROOT / "examples" / "truck_dmf.yaml", analysis="envelop"), encoding="utf-8")
    with pytest.raises(ModelError, match=r"run\.ask\.worst\.analysis.*no such analysis.*did you mean 'envelope'"):
        load_plan(plan)


def replaced_clutch(stiffness: float) -> Model:
    return replaced(TRUCKS.dmf, "clutch", law=Hinges(stiffness))
