"""Samples at the moments that are asked for, and what a run says of its own energy."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges, LuGre
from torsional.powertrain import Powertrain
from torsional.solvers.transient import Governor, MotionState, TorqueHistory, transient
from torsional.system import assemble

DISC = assemble(Powertrain({"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 100.0)}))
PUSH = Excitation(("disc",), [0.0], 10.0, [[100.0]])


def between_stops(step: float, **settings: object) -> xr.Dataset:
    """A small mass thrown at elastic stops of 1e8 Nm/rad."""
    law = Contacts.between(-0.01, 0.01, 1e8, 0.0)
    line = assemble(Powertrain({"mass": Inertia(0.003), "stops": Coupling("ground", "mass", law)}))
    start = MotionState.at_rest(line).moved(0.0, [1.0])
    return transient(line, (), 0.02, start, speed=0.0, step=step, **settings)  # type: ignore[arg-type]


def test_moments_are_hit() -> None:
    times = np.array([0.0, 0.01, np.pi / 100, 0.1, 0.25])
    data = transient(DISC, PUSH, 0.3, "rest", output=times)
    np.testing.assert_allclose(data.time.values, times, atol=1e-15)
    np.testing.assert_allclose(data.angle.values[:, 0], 1 - np.cos(10 * times), atol=2e-7)
    assert data.attrs["end_time"] == pytest.approx(0.3, rel=1e-14)
    with pytest.raises(ModelError, match="outside the run"):
        transient(DISC, PUSH, 0.3, "rest", output=[0.1, 0.4])


@pytest.mark.parametrize("settings", [{"method": "newmark"}, {"spectral_radius": 0.5}])
def test_a_stop_that_the_step_cannot_follow_is_told(settings: dict[str, object]) -> None:
    """A contact lasts π sqrt(3e-11) = 17 µs: steps of 20 µs lose energy in it and say so, steps of 0.1 µs do not."""
    coarse, fine = (between_stops(step, **settings) for step in (2e-5, 1e-7))
    assert abs(coarse.angular_velocity.values[-1, 0]) < 0.5
    assert "stops" in coarse.attrs["guarded"] and "took away" in coarse.attrs["energy_error"]
    assert coarse.attrs["damped"] == coarse.attrs["guarded"]
    assert abs(fine.angular_velocity.values[-1, 0]) == pytest.approx(1.0, abs=3e-5)
    assert not {"guarded", "damped", "energy_error", "refined"} & set(fine.attrs)


def loose(large: float, beside: float) -> xr.Dataset:
    """A small mass of 3 g m² between stops, behind which a spring holds it or not, beside a large swinging one."""
    stops = Coupling("large", "small", Contacts.between(-0.01, 0.01, 1e6, 0.0))
    parts = {"large": Inertia(large), "base": Shaft("ground", "large", 1e4 * large), "small": Inertia(0.003)}
    parts |= {"stops": stops, "held": Shaft("large", "small", beside)}
    line = assemble(Powertrain(parts))
    return transient(line, (), 0.5, MotionState.at_rest(line).moved(0.0, np.array([2.0, 2.0])), speed=0.0)


@pytest.mark.parametrize(("beside", "told"), [(1.0, True), (1e4, False)])
def test_a_guard_that_brings_a_small_mass_to_rest_is_told_however_little_that_is(beside: float, told: bool) -> None:
    """Loose, it loses at its stops what reaches it; held by a spring that never meets them it loses nothing."""
    data = loose(1000.0, beside)
    assert "stops" in data.attrs["guarded"] and abs(data.attrs["method_share"]) < 1e-3
    assert ("stops" in data.attrs.get("damped", "")) is told


def test_a_pulse_shorter_than_the_step_and_a_chattering_governor_are_told() -> None:
    free = assemble(Powertrain({"disc": Inertia(0.01)}))
    pulse = TorqueHistory("disc", (0.0, 0.00203, 0.002055, 0.00208), (0.0, 0.0, 4e4, 0.0))
    assert "2.5e-05 s" in transient(free, pulse, 0.01, "rest", speed=0.0).attrs["unresolved"]
    assert "unresolved" not in transient(free, pulse, 0.01, "rest", speed=0.0, step=2.5e-5).attrs
    for gain, told in ((50.0, False), (250.0, True)):
        governor = Governor("disc", 1.0, acts_on="disc", proportional=gain, low=-1e3, high=1e3)
        assert ("restless" in transient(free, governor, 0.01, "rest", speed=0.0).attrs) is told


@pytest.mark.parametrize(
    "wrong",
    [
        {"reference_time": -0.1},
        {"reference_time": float("nan")},
        {"angle_error": float("nan")},
        {"output": -1.0},
        {"output": float("inf")},
        {"tolerance": float("nan")},
        {"step": 0.0},
    ],
    ids=str,
)
def test_settings_without_meaning_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ModelError):
        transient(DISC, PUSH, 0.01, "rest", **wrong)  # type: ignore[arg-type]


def test_runs_end_where_they_should_and_never_beyond_numbers() -> None:
    assert transient(DISC, PUSH, 0.010004, "rest").attrs["end_time"] == pytest.approx(0.010004, rel=1e-12)
    with pytest.raises(ModelError, match="beyond all numbers"):
        transient(DISC, PUSH, 0.01, MotionState.at_rest(DISC).moved(0.0, [1e160]))


def test_a_spring_to_the_ground_takes_the_mean_torque_whatever_node_is_held() -> None:
    held, free = (transient(DISC, PUSH, 0.1, "rest", hold=hold) for hold in ("disc", ""))
    np.testing.assert_array_equal(held.angle.values, free.angle.values)
    with pytest.raises(ModelError, match="dics"):
        transient(DISC, PUSH, 0.1, "rest", hold="dics")


@pytest.mark.parametrize(("step", "told"), [(2e-5, True), (2e-6, False)])
def test_a_small_mass_that_is_pumped_up_beside_a_large_one_is_told(step: float, told: bool) -> None:
    """1.5 mJ between stops just below the guard, beside 5 MJ: nothing of the whole, but 0.2 % of what goes through."""
    stiffness = 0.003 * (0.49 / 2e-5) ** 2
    stops = Hinges(0.0, (0.01, -0.01), (1.0, -1.0), (stiffness, stiffness))
    small = {"small": Inertia(0.003), "stops": Coupling("ground", "small", stops)}
    line = assemble(Powertrain(small | {"large": Inertia(1000.0), "spring": Shaft("ground", "large", 1e5)}, 2))
    start = MotionState.at_rest(line).moved(0.0, np.array([1.0, 100.0]))
    data = transient(line, (), 2.0, start, speed=0.0, step=step, method="newmark", output=0.1)
    assert abs(data.attrs["method_share"]) < 1e-4
    assert ("stops" in data.attrs.get("energy_error", "")) is told


@pytest.mark.parametrize("stiffness", [1e5, 1e8])
def test_bristles_that_bend_within_a_step_take_no_energy_at_the_start(stiffness: float) -> None:
    law = LuGre(stiffness, stiffness**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001)
    parts = {"mass": Inertia(1.0), "spring": Shaft("ground", "mass", 100.0), "rub": Coupling("ground", "mass", law)}
    line = assemble(Powertrain(parts))
    start = MotionState.at_rest(line).moved(0.0, [1.0])
    ends = [transient(line, (), 0.5, start, speed=0.0, step=h).energy.values[-1, :2].sum() for h in (1e-3, 1e-5)]
    assert ends[0] == pytest.approx(ends[1], rel=5e-3)


@pytest.mark.parametrize(
    ("damper", "step", "said"), [("cut", 1e-4, True), ("limited", 1e-4, True), ("cut", 1e-6, False)]
)
def test_contacts_that_no_step_can_guard_are_told(damper: str, step: float, said: bool) -> None:
    """ω = 1e4/s: h ω = 1 at 0.1 ms, 0.01 at 1 µs."""
    stop = Contacts.between(-0.1, 0.1, 1e8, 1e-6, damper=damper)
    line = {"disc": Inertia(1.0), "stop": Coupling("ground", "disc", stop)}
    run = transient(
        assemble(Powertrain(line)), TorqueHistory("disc", (0.0,), (1.0,)), 0.002, "rest", speed=0.0, step=step
    )
    assert ("unguarded" in run.attrs) == said
    assert not said or "stop" in run.attrs["unguarded"]
