"""Scenarios in time against what mechanics says beforehand."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr
from tests.shipped import ROOT, shipped

from torsional import ModelError, load_scenario, run_scenario, run_up
from torsional.model import Model
from torsional.solvers.transient import SpeedProfile
from torsional.units import RPM


@pytest.fixture(scope="module")
def truck() -> Model:
    return shipped("truck_dmf")


def test_a_pulse_at_idle_leaves_a_sub_harmonic_in_springs_with_lash(truck: Model) -> None:
    """Before it the springs are not met; after it the twist repeats itself after several firings, not after one."""
    run = run_scenario(truck, load_scenario(ROOT / "examples" / "scenarios" / "idle_pulse.yaml"))
    twist = run.twist.sel(element="dmf")
    before, after = twist.sel(time=slice(0.5, 0.95)), twist.sel(time=slice(2.5, None)).values
    assert float(before.max() - before.min()) < np.deg2rad(2.0)
    assert np.ptp(after) > np.deg2rad(3.0)
    firing = 2 * np.pi / (3 * float(run.angular_velocity.sel(node="primary", time=slice(2.5, None)).mean()))
    step = float(run.time[1] - run.time[0])

    def gap(count: int) -> float:
        """How far the twist is from itself after some firings, over its swing."""
        shift = round(count * firing / step)
        return float(np.abs(after[shift:] - after[:-shift]).max() / np.ptp(after))

    repeats = [count for count in range(1, 7) if gap(count) < 0.1]
    assert repeats and repeats[0] > 1


def test_sliding_linings_carry_their_capacity(truck: Model) -> None:
    settings = ["clutch.within=1 s", "clutch.engages=0 s", "duration=0.6 s", "speed=1400 rpm", "gear=6"]
    run = run_scenario(truck, load_scenario("clutch_engagement", settings))
    assert json.loads(run.attrs["looked_at"]) == ["gearbox_input", "vehicle"]
    slip = run.angular_velocity.sel(node="secondary") - run.angular_velocity.sel(node="clutch_lining")
    sliding = (slip.values > 5.0) & (run.time.values > 0.05)
    assert sliding.sum() > 100
    torque = run.torque.sel(element="clutch_linings").values[sliding]
    # 3500 Nm in a second; what the bristles lag behind the growing force is below a per cent
    assert torque == pytest.approx(3500 * run.time.values[sliding], rel=0.02)


def test_energy_of_a_stop_is_lost_to_the_last_joule(truck: Model) -> None:
    """What turned is lost in friction, dampers and pumping; the method makes nothing; nothing turns any more."""
    run = run_scenario(truck, load_scenario("engine_stop"))
    energy = {str(name): float(run.energy.sel(share=name)[-1]) for name in run.share.values}
    assert abs(energy["method"]) < 1e-4 * energy["dampers"]
    speed = run.angular_velocity.sel(node="primary")
    assert float(speed.max()) == pytest.approx(600 * RPM, rel=0.1)
    assert float(speed.min()) > -250 * RPM
    last = run.sel(time=slice(float(run.time[-1]) - 0.1, None))
    assert float(abs(last.angular_velocity).max()) < 1 * RPM
    assert float(abs(last.torque.sel(element="dmf")).max()) < 0.01 * float(run.torque_highest.sel(element="dmf"))
    rubbing = [str(name) for name in run.element.values if str(name).startswith("friction_")]
    assert len(rubbing) == 6
    # 600 rpm of 13 litres at 0.91 bar of friction, 92 Nm; less as it gets slower
    idling = run.torque.sel(element=rubbing, time=slice(0.0, 0.1)).sum("element")
    assert float(idling.mean()) == pytest.approx(92, abs=1)


def test_a_stalled_engine_stands_still(truck: Model) -> None:
    """It swings back and forth against the brake and comes to rest, friction holding it in its place."""
    run = run_scenario(truck, load_scenario("stall", ["duration=2 s"]))
    speed = run.angular_velocity.sel(node="primary")
    assert -200 * RPM < float(speed.min()) < 0
    assert float(abs(speed.sel(time=slice(1.8, None))).max()) < 1 * RPM


def test_a_run_up_begins_in_steady_vibration(truck: Model) -> None:
    """At one speed nothing changes from cycle to cycle."""
    speed = 900 * RPM
    run = run_up(truck, SpeedProfile.constant(speed), 1200.0, 1.0, "12")
    torque = run.torque.sel(element="dmf")
    cycle = 4 * np.pi / speed
    swings = [np.ptp(torque.sel(time=slice(t, t + cycle)).values) for t in (0.0, 0.4, 0.8)]
    assert swings == pytest.approx([swings[-1]] * 3, rel=0.05)
    assert float(run.energy.sel(share="dampers")[0]) == 0.0


def test_a_name_and_a_number_do_as_well(truck: Model) -> None:
    """A scenario by its name, a constant speed as a number, as `transient` takes it."""
    named, loaded = (run_scenario(truck, kind) for kind in ("tip_in", load_scenario("tip_in")))
    assert named.attrs["scenario"] == "tip_in"
    np.testing.assert_array_equal(named.torque, loaded.torque)
    by_number, by_profile = (run_up(truck, speed, 1000.0, 0.1) for speed in (100.0, SpeedProfile.constant(100.0)))
    np.testing.assert_array_equal(by_number.torque, by_profile.torque)
    with pytest.raises(ModelError, match="there is no such scenario"):
        run_scenario(truck, "tip_inn")


def test_steps_that_are_too_large_are_refused(truck: Model) -> None:
    short = ["duration=0.6 s", "at=0.1 s"]
    with pytest.raises(ModelError, match=r"step: the step is too large; found 0.005 s; allowed: a hundredth of a turn"):
        run_scenario(truck, load_scenario("tip_in", [*short, "step=5 ms"]))
    coarse, fine = (run_scenario(truck, load_scenario("tip_in", [*short, f"step={h} ms"])) for h in (0.5, 0.1))
    peaks = [float(run.torque_highest.sel(element="dmf")) for run in (coarse, fine)]
    assert peaks[0] == pytest.approx(peaks[1], rel=0.01)


def test_a_detailed_flywheel_carries_what_the_clutch_does() -> None:
    """Its springs, tabs and stop have no rows of their own; together they are the torque of the flywheel."""
    detailed = shipped("truck_dmf_arc_spring")
    run = run_scenario(detailed, load_scenario("tip_out", ["duration=0.3 s", "at=0.25 s", "before=1500 Nm"]))
    means = run.torque.sel(element=["dmf", "clutch"], time=slice(0.0, 0.24)).mean("time").values
    assert means == pytest.approx([1500.0, 1500.0], rel=0.02)
    told = run.attrs["told"]
    assert '"dmf"' in told
    assert "arc_1" not in told


@pytest.mark.parametrize("kind", ["arc", "straight"])
def test_the_torque_of_a_detailed_flywheel_moves_its_secondary(kind: str) -> None:
    """J ω̇ of the secondary flywheel is that torque less the clutch's, while driving and, tabs pushed back, on coast."""
    model = shipped(f"truck_dmf_{kind}_spring")
    changes = ["duration=0.6 s", "at=0.05 s", "before=600 Nm", "after=-120 Nm"]
    run = run_scenario(model, load_scenario("tip_out", changes))
    own, clutch = run.torque.sel(element="dmf"), run.torque.sel(element="clutch")
    needed = clutch + 1.0 * run.acceleration.sel(node="secondary")
    assert float(own.min()) < -300 and float(own.max()) > 600
    np.testing.assert_allclose(own, needed, atol=1e-9)


def test_a_starter_is_off_for_good_once_the_engine_runs(truck: Model) -> None:
    """Too little heat: the crank falls again below the starter's 250 rpm, which pushed again if it were not off."""
    weak = ["governor.speed=270 rpm", "governor.torque=400 Nm", "governor.droop=60 rpm", "duration=2.2 s"]

    def started(*settings: str) -> xr.Dataset:
        return run_scenario(truck, load_scenario("engine_start", [*weak, *settings]))

    run = started("starter.until=2 s", "starter.release=270 rpm")
    crank, on = run.angular_velocity.sel(node="primary"), run.schedule.sel(event="starter").values > 0.5
    reached = float(run.time[crank.values >= 270 * RPM][0])
    assert float(run.time[on][-1]) == pytest.approx(reached, abs=3e-4) and reached < 1.95
    assert float(crank.sel(time=slice(reached, 2.0)).min()) < 250 * RPM
    pushing = started("starter.until=2 s", "starter.release=900 rpm").angular_velocity.sel(node="primary")
    same = crank.time.values <= reached
    assert np.array_equal(crank.values[same], pushing.values[same])
    assert float(np.abs(crank - pushing).max()) > 5 * RPM


@pytest.mark.parametrize(("settings", "said"), [(["starter.release=200 rpm"], "starter.release.*more than.*250 rpm")])
def test_a_starter_that_is_never_off_is_refused(truck: Model, settings: list[str], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        run_scenario(truck, load_scenario("engine_start", settings))


def test_a_run_at_full_load_keeps_its_speed_and_pays_for_its_vibration(truck: Model) -> None:
    """What the ideal drive gives in the end is the power lost in dampers, which the ledger books by itself."""
    speed = 1000 * RPM
    run = run_up(truck, speed, 2500.0, 9.0)
    crank, cycle = run.angular_velocity.sel(node="primary"), 4 * np.pi / speed
    means = [float(crank.sel(time=slice(at, at + cycle - 1e-4)).mean()) for at in (4.0, 8.0)]
    assert means == pytest.approx([speed, speed], abs=0.02 * RPM)
    late = run.energy.sel(share="dampers").sel(time=slice(7.0, 9.0))
    lost = float(late[-1] - late[0]) / float(late.time[-1] - late.time[0])
    ratio = float(run.speed_ratio.sel(node="vehicle"))
    assert lost > 500.0
    assert float(run.end_integral[0]) * speed * ratio == pytest.approx(lost, rel=0.03)


@pytest.mark.parametrize(("duration", "step", "said"), [(0.0, None, "duration"), (1.0, 0.0, "step")])
def test_a_run_takes_time(truck: Model, duration: float, step: float | None, said: str) -> None:
    with pytest.raises(ModelError, match=f"{said}.*positive time"):
        run_up(truck, 90.0, 100.0, duration, step=step)


def test_compression_leaves_a_stalled_line(truck: Model) -> None:
    """What is left in the flywheel is what the friction of the engine at rest holds, and no longer compression."""
    run = run_scenario(truck, load_scenario("stall", ["duration=9 s"]))
    torque = np.abs(run.torque.sel(element="dmf").sel(time=[1.0, 9.0], method="nearest").values)
    rubbing = [name for name in run.element.values if str(name).startswith("friction_")]
    held = float(np.abs(run.torque.sel(element=rubbing)[-1]).sum())
    assert torque[0] > 500 and torque[1] < 0.15 * torque[0]
    assert torque[1] <= 1.02 * held
    assert float(abs(run.angular_velocity.sel(node="primary")[-1])) < 0.01 * RPM
