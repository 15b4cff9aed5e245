"""A5, B1, B5 and B6 by time steps, beside harmonic balance and motions exact between hinges."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.solvers.transient import engine_drive, steady_sweep
from torsional.studies.answers import mean_torque
from torsional.studies.base import Outcome
from torsional.studies.claims.friction import FAR, stepped
from torsional.studies.claims.idle import Idle, pulsed
from torsional.studies.friction import WASHER, curve, washed
from torsional.studies.motions import at_value, doubled, in_time, over_speed, over_torque, rest_of
from torsional.studies.settling import STEP, Stepped, order_of, reach_of
from torsional.studies.trucks import Trucks, hinged, replaced
from torsional.units import RPM


def test_a_period_is_whole_steps(trucks: Trucks) -> None:
    line = Stepped.of(trucks.two_stage, 910 * RPM, 1249.0)
    assert line.period == pytest.approx(60 / (3 * 910))
    assert line.period / line.step == pytest.approx(round(line.period / line.step))
    assert 0.99 * STEP < line.step <= STEP


def test_steps_follow_the_exact_motion(trucks: Trucks) -> None:
    """Ten periods from rest, through both stages: the DMF's twist at every quarter of a period."""
    speed, torque = 910 * RPM, 1249.0
    explorer = over_torque(trucks.two_stage, speed, (900.0, 1500.0), depth=0)
    timed = in_time(explorer, torque)
    rest = rest_of(explorer.branches[0].problem, at_value(explorer.branches[0], torque)[0], timed)
    line = Stepped.of(trucks.two_stage, speed, torque)
    run = line.run(line.begun(timed, rest), 10)
    exact = timed.run(rest, 10)
    weights = line.system.connections.weights[line.system.connections.names.index("dmf")]
    expected = exact.angles @ weights
    found = np.interp(exact.times, run.time, run.twist.sel(element="dmf"))
    assert expected.min() < 0.125 < expected.max()  # 1000 Nm over 8 kNm/rad
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-3 * np.ptp(expected))


@pytest.mark.parametrize(("rpm", "vibrates"), [(825, False), (855, True), (945, True), (980, False)])
def test_b1_order_grows_from_equilibrium(trucks: Trucks, rpm: float, vibrates: bool) -> None:
    """At 1200 Nm within 840–963 rpm alone; there as large as harmonic balance has it."""
    speed = rpm * RPM
    found = Stepped.of(trucks.two_stage, speed, 1200.0).settled()
    assert found.attrs["periods"] == (2 if vibrates else 1)
    assert order_of(found, "dmf", 3.0) > 0.01
    if vibrates:
        (branch,) = doubled(over_torque(trucks.two_stage, speed, (800.0, 1500.0)))
        (z,) = at_value(branch, 1200.0)
        half = order_of(found, "dmf", 1.5)
        assert half == pytest.approx(abs(branch.problem.harmonics_of(z)[0, 1]), rel=2e-3)
        assert half > 0.005


def test_b1_figures_by_time_steps(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B1"].finding.figures
    told = [figures[f"DMF twist there, by time steps from {name} [rad]"] for name in ("rest", "the doubled motion")]
    assert told == pytest.approx([figures["DMF twist there, balance [rad]"]] * 2, rel=1e-3)
    assert told[0] != told[1]  # two runs


def test_b5_figures_by_time_steps(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B5"].finding.figures
    assert max(figures["difference to the run by time steps [%]"]) < 0.1
    half, main = figures["orders 1.5 and 3 by time steps from equilibrium [rad]"]
    assert half < 1e-4 * main
    assert main == pytest.approx(figures["DMF twist of order 3 [rad]"][0], rel=1e-3)


def test_b5_a_sweep_up_and_down(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    """Slowly up in mean torque the doubled motion is kept to where others exist, and ends before 1625 Nm; down from
    above another one is met, which swings into the stop."""
    model = replaced(trucks.two_stage, "dmf", damping=10.0)
    line = Stepped.of(model, 940 * RPM, 1500.0)
    torques = np.array([1450.0, 1500.0, 1550.0, 1600.0, 1650.0])
    found = steady_sweep(
        line.system,
        lambda torque: engine_drive(model, 940 * RPM, float(torque)),
        torques,
        hold=line.hold,
        thorough=False,
        tolerance=1e-6,
    )
    up, down = np.abs(found.twist.sel(element="dmf", order=1.5).values)
    figures = outcomes["B5"].finding.figures
    assert (figures["shown at [rpm]"], figures["shown at [Nm]"]) == (pytest.approx(940.0), 1600.0)
    assert up[3] == pytest.approx(figures["DMF twist of order 1.5 [rad]"][1], rel=2e-3)
    assert up[[0, 1, 4]] == pytest.approx(down[[0, 1, 4]], rel=1e-3)
    assert (down[[2, 3]] > 1.2 * up[[2, 3]]).all()
    at = Stepped.of(model, 940 * RPM, 1600.0)
    reached = [reach_of(at.run(found.isel(direction=way, value=3), 2), "dmf")[1] for way in (0, 1)]
    stop = max(hinged(model, "dmf").stops)
    assert reached[0] < stop < reached[1]


def test_a5_at_1500_rpm_with_more_orders(trucks: Trucks) -> None:
    """What is left between the two at 1500 rpm are the orders above 9 that the balance leaves out."""
    model = washed(trucks.smf, 150.0)
    explorer = over_speed(model, (1490 * RPM, 1510 * RPM), mean_torque(model), depth=0, highest_order=18.0)
    amplitude, power = stepped(model, FAR)
    found = curve(model, explorer.branches[0])
    assert amplitude == pytest.approx(found.at(FAR, found.amplitude), rel=2e-3)
    assert power == pytest.approx(found.at(FAR, found.power), rel=2e-3)


def test_a5_power_is_the_area_of_the_loop(trucks: Trucks) -> None:
    """The ledger's friction beside torque over twist of the same run."""
    model = washed(trucks.smf, 90.0)
    line = Stepped.of(model, 654 * RPM, mean_torque(model), 9.0)
    settled = line.settled()
    run = line.run(settled, 4).sel(element=WASHER)
    area = np.trapezoid(run.torque, run.twist)
    assert line.friction_power(settled, 4) == pytest.approx(area / (4 * line.period), rel=1e-3)
    assert abs(run.torque).max() == pytest.approx(90.0)


def test_a5_figures_by_time_steps(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["A5"].finding.figures
    assert figures["by time steps: friction torque [Nm]"] == (30.0, 90.0, 150.0)
    peak = figures["largest amplitude [rad/s²]"]
    assert figures["by time steps: largest amplitude [rad/s²]"] == pytest.approx([peak[i] for i in (1, 3, 5)], rel=5e-3)
    assert figures["by time steps: largest difference [%]"] < 1.5


@pytest.mark.parametrize(
    ("lash", "damping", "quiet", "loud"), [(2.0, 20.0, 0.0, 250.0), (3.0, 20.0, 1000.0, 0.0), (1.5, 10.0, 250.0, 500.0)]
)
def test_b6_the_pulse_that_is_needed(trucks: Trucks, lash: float, damping: float, quiet: float, loud: float) -> None:
    """The same pulses as with the exact motion leave lasting vibration, and leave none."""
    idle = Idle.of(trucks.dmf, np.deg2rad(lash), damping)
    assert idle.sustained() == (loud or np.inf)
    for torque, kept in ((quiet, False), (loud, True)):
        if torque:
            before, after, _ = pulsed(idle, torque)
            free, width = np.ptp(reach_of(before, "dmf")), np.ptp(reach_of(after, "dmf"))
            assert (width > idle.lash) if kept else width == pytest.approx(free, rel=1e-3)


def test_b6_figures_by_time_steps(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B6"].finding.figures
    told = [name for name in figures if name.startswith(("before", "after"))]
    assert len(told) == 5
    for name in told:
        assert figures[f"by time steps, {name}"] == pytest.approx(figures[name], rel=1e-3)
