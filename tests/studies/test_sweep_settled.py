"""What time stepping settles on as a sweep's analysis: beside linear response, and beside the map of its points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.files.edit import changed
from torsional.quantities import acceleration, swing
from torsional.solvers.run_up import run_up_response
from torsional.solvers.transient import steady_map
from torsional.studies.sweeps import sweep
from torsional.studies.sweeps.plan import load_plan
from torsional.studies.sweeps.settled import SettledRun

TRUCK = tv.load_model("examples/truck_dmf.yaml")
TWO_STAGE = tv.load_model("examples/truck_dmf_two_stage.yaml")
DETAILED = tv.load_model("examples/truck_dmf_straight_spring.yaml")
TOP = TRUCK.top_gear


def asked(**settings: object) -> SettledRun:
    """The analysis with some settings."""
    return SettledRun.model_validate({"analysis": "settled", "highest_order": 9, **settings})


def test_a_line_that_stays_off_its_stops_is_the_linear_response() -> None:
    """Three orders of the engine over three speeds at full load, by a second method."""
    found = asked(speed="1000:1400:200 rpm", step="0.02 ms")(TRUCK)
    speeds = np.arange(1000.0, 1401.0, 200.0) * tv.RPM
    linear = run_up_response(TRUCK, speeds, TRUCK.full_load(speeds), None, np.array([3.0, 6.0, 9.0]))
    half = swing(acceleration(linear.angle.sel(node=TRUCK.landmarks.input)))
    np.testing.assert_allclose(found.acceleration_swing, half, rtol=1e-3)
    np.testing.assert_allclose(found.twist_swing.sel(element="dmf"), swing(linear.twist.sel(element="dmf")), rtol=1e-3)
    assert found.acceleration_swing.dims == ("speed",) and (found.periods == 1).all()
    assert (abs(found.method_share) < 1e-4).all()


def test_points_are_those_of_the_map_in_time() -> None:
    """Mean torques that are named are a dimension; motions that repeat themselves after two periods are told."""
    speeds = np.array([800.0, 900.0, 1000.0]) * tv.RPM
    found = asked(speed="800:1000:100 rpm", torques=["1000 Nm", "1200 Nm"])(TWO_STAGE)
    points = steady_map(TWO_STAGE, speeds, [1000.0, 1200.0], [TOP], highest_order=9.0).isel(gear=0)
    assert found.acceleration_swing.dims == ("mean_torque", "speed")
    assert found.periods.values.tolist() == points.periods.values.tolist() and 2 in found.periods
    half = swing(acceleration(points.angle.sel(node=TWO_STAGE.landmarks.input)))
    np.testing.assert_allclose(found.acceleration_swing, half.transpose("mean_torque", "speed"), rtol=1e-9)
    for name in ("twist", "torque"):
        half = swing(points[name].sel(element=["dmf", "clutch"])).transpose("mean_torque", "speed", "element")
        np.testing.assert_allclose(found[f"{name}_swing"], half, rtol=1e-9)


def test_the_torque_of_springs_in_detail_is_what_their_tabs_carry() -> None:
    """J ω̇ of the secondary flywheel is what comes from the springs less what the clutch takes, order by order."""
    found = asked(speed="900:1100:200 rpm", torques=["1000 Nm"])(DETAILED)
    points = steady_map(DETAILED, np.array([900.0, 1100.0]) * tv.RPM, [1000.0], [TOP], highest_order=9.0)
    inertia = sum(mass.inertia for mass in DETAILED.powertrain(TOP)["secondary"].stamps("secondary"))
    turning = acceleration(points.angle.sel(node="secondary"))
    carried = swing((inertia * turning + points.torque.sel(element="clutch")).where(points.order > 0, 0.0))
    np.testing.assert_allclose(found.torque_swing.sel(element="dmf"), carried.isel(gear=0), rtol=1e-2)


def test_designs_have_what_each_has_by_itself() -> None:
    """Whatever the chunk, and with engines that differ."""
    run, over = asked(speed="1000:1200:200 rpm"), {"engine.bore": [0.128, 0.131], "clutch.stiffness": [2e4, 3e4]}
    found = sweep(TRUCK, over, run, chunk=4)
    xr.testing.assert_identical(found, sweep(TRUCK, over, run, chunk=1))
    one = {"engine.bore": 0.128, "clutch.stiffness": 3e4}
    np.testing.assert_array_equal(found.acceleration_swing.sel(one), run(changed(TRUCK, one)).acceleration_swing)
    assert np.unique(found.acceleration_swing).size == 8


def test_a_plan_asks_criteria_of_it(tmp_path: Path) -> None:
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        f"""torsional_sweep: 1
model: {Path("examples/truck_dmf_two_stage.yaml").resolve()}
over: [{{parameter: clutch.damping, values: [20, 40]}}]
run:
  analysis: criteria
  ask: {{time: {{analysis: settled, speed: "900:1000:100 rpm", torques: [1200 Nm], highest_order: 6}}}}
  criteria:
    periods: {{of: time, figure: periods}}
    travel: {{of: time, figure: twist_swing, select: {{element: dmf, speed: 900 rpm}}}}
""",
        encoding="utf-8",
    )
    work = load_plan(plan).work
    found = sweep(work.build, work.designs, work.run)
    assert found.periods.values.tolist() == [2, 2] and found.travel.attrs["units"] == "rad"
    assert (found.travel > 0.01).all()


@pytest.mark.parametrize("settings", [{"torques": ["-5 Nm"]}, {"step": "0 s"}, {"speed": "0:100 rpm"}])
def test_settings_that_cannot_be_are_refused(settings: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"positive|negative"):
        asked(**settings)
