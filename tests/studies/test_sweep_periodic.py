"""Branches of periodic motion as a sweep's analysis: beside linear response, and beside the branch itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import torsional as tv
from torsional.files.edit import changed
from torsional.quantities import acceleration, swing
from torsional.solvers.periodic import model_response
from torsional.solvers.run_up import run_up_response
from torsional.studies.sweeps import sweep
from torsional.studies.sweeps.periodic import PeriodicRun
from torsional.studies.sweeps.plan import load_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TWO_STAGE = tv.load_model(EXAMPLES / "truck_dmf_two_stage.yaml")
SPEED = "500:1200:25 rpm"


def asked(**settings: object) -> PeriodicRun:
    """The analysis with some settings."""
    return PeriodicRun.model_validate({"analysis": "periodic", "speed": SPEED, **settings})


def test_equal_stages_are_the_linear_response() -> None:
    """Both stages of one stiffness: the largest swing of four orders of the linear model over the same speeds."""
    alike = changed(TWO_STAGE, {"absorber.stages.0.stiffness": 16e3, "absorber.stages.1.stiffness": 16e3})
    found = asked(torque="1200 Nm", highest_order=12)(alike)
    speeds = np.arange(500.0, 1201.0, 25.0) * tv.RPM
    linear = run_up_response(alike, speeds, np.full(speeds.size, 1200.0), None, np.array([3.0, 6.0, 9.0, 12.0]))
    half = swing(acceleration(linear.angle.sel(node=alike.landmarks.input)))
    assert float(found.acceleration_swing) == pytest.approx(float(half.max()), rel=1e-6)
    assert float(found.worst_speed) == pytest.approx(float(speeds[half.values.argmax()]))
    twist = swing(linear.twist.sel(element="dmf"))
    assert float(found.twist_swing.sel(element="dmf")) == pytest.approx(float(twist.max()), rel=1e-6)
    assert (int(found.folds), int(found.doublings)) == (0, 0)
    assert float(found.unstable_share) == pytest.approx(0.0, abs=1e-12)


def test_doublings_bound_the_unstable_speeds() -> None:
    """They are where multipliers of the branch pass −1, and between them nothing is stable."""
    found = asked(torque="1200 Nm", count=3)(TWO_STAGE)
    low, high, none = found.doubling_speed.values
    assert int(found.doublings) == 2 and np.isnan(none) and np.isnan(found.fold_speed.values).all()
    assert float(found.unstable_share) == pytest.approx((high - low) / (700.0 * tv.RPM), rel=1e-6)
    at = np.array([low - 0.5, low + 0.5, high - 0.5, high + 0.5])
    branch = model_response(TWO_STAGE, (500 * tv.RPM, 1200 * tv.RPM), 1200.0, at=at, depth=0)
    least = [float(branch.multiplier.values[branch.speed.values == v].real.min()) for v in at]
    assert [value < -1 for value in least] == [False, True, True, False]


def test_folds_of_full_load_are_told_and_leave_no_gap() -> None:
    found = PeriodicRun.model_validate({"analysis": "periodic", "count": 3})(TWO_STAGE)
    assert int(found.folds) == 4 and np.isfinite(found.fold_speed.values).all() and found.fold_speed.size == 3
    assert (np.diff(found.fold_speed.values) > 0).all() and float(found.unstable_share) == pytest.approx(0.0, abs=1e-12)


def test_models_without_stages_are_refused_with_a_reason() -> None:
    found = sweep(tv.load_model(EXAMPLES / "truck_dmf.yaml"), {"clutch.stiffness": [2e4]}, asked())
    assert found.status.values.tolist() == [1] and found.reason.values[0]


def test_the_plan_of_the_examples() -> None:
    """Its corners: the stiffer the first stage and the softer the second, the less is lost."""
    plan = load_plan(EXAMPLES / "plans" / "two_stage_flywheel.yaml")
    assert len(plan.work.designs) == 20
    stages = {"absorber.stages.0.stiffness": [6e3, 12e3], "absorber.stages.1.stiffness": [16e3, 32e3]}
    found = sweep(plan.work.build, stages, plan.work.run)
    assert not found.status.values.any()
    share = found.unstable_share.values
    assert share[1, 0] == share.min() and share[0, 1] == share.max() > 0.1
