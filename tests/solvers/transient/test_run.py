"""Runs in time against closed forms, the frequency domain and themselves."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import expm

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Contacts, Hinges, Jenkins, LuGre
from torsional.powertrain import Powertrain
from torsional.results import load_results, save_results
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.operating import at_operating_point
from torsional.solvers.transient import Governor, MotionState, OrderTorques, SpeedProfile, TorqueHistory, transient
from torsional.solvers.transient.marching import LEDGER
from torsional.stamps import SpeedSwitch
from torsional.system import System, assemble

SPEED = 100.0
LOSSES = ["dampers", "contacts", "friction"]


def pair(damping: float = 4.0) -> System:
    parts = {"a": Inertia(1.8), "b": Inertia(1.2), "s": Shaft("b", "a", 12e3, damping)}
    return assemble(Powertrain(parts))


def spring(stiffness: float = 100.0, damping: float = 0.0) -> System:
    return assemble(Powertrain({"disc": Inertia(1.0), "spring": Shaft("ground", "disc", stiffness, damping)}))


def thirds(mean: float = 0.0) -> Excitation:
    return Excitation(("a",), [0.0, 3.0], SPEED, [[mean, 100.0 + 40.0j]])


def state(system: System, angle: float, speed: float) -> MotionState:
    still = MotionState.at_rest(system)
    return still.moved(np.array([angle]), np.array([speed]))


# --- closed forms ---


def test_a_loaded_spring_swings_about_its_new_place() -> None:
    found = transient(spring(), TorqueHistory("disc", (0.0,), (50.0,)), 1.0, "rest", speed=0.0, step=1e-3)
    expected = 0.5 * (1 - np.cos(10 * found.time))
    np.testing.assert_allclose(found.angle.values[:, 0], expected, atol=1e-4)
    np.testing.assert_allclose(found.torque.values[:, 0], 100 * found.twist.values[:, 0], atol=1e-12)


def test_error_falls_with_the_square_of_the_step() -> None:
    law = spring(100.0, 2.0)
    roots = -1.0 + 1j * np.sqrt(99.0)

    def error(step: float) -> float:
        found = transient(law, (), 1.0, state(law, 1.0, 0.0), speed=0.0, step=step)
        free = (np.exp(roots * found.time.values) * (1 - 1j / np.sqrt(99.0))).real
        return float(np.abs(found.angle.values[:, 0] - free).max())

    assert error(2e-3) / error(1e-3) == pytest.approx(4.0, rel=0.05)
    assert error(1e-3) < 2e-4


def test_a_contact_throws_the_mass_back() -> None:
    """m = 1, k = 100, gap 0.1, v = 1: in contact for π/10 s, leaves with v = −1."""
    law = Hinges(0.0, (0.1,), (1.0,), (100.0,))
    stop = assemble(Powertrain({"m": Inertia(1.0), "c": Coupling("ground", "m", law)}))
    still = MotionState.at_rest(stop).moved(0.0, np.array([1.0]))
    found = transient(stop, (), 0.6, still, speed=0.0, step=1e-4, spectral_radius=1.0)
    touching = float((found.torque.values[:, 0] > 0).sum()) * 1e-4
    assert touching == pytest.approx(np.pi / 10, abs=2e-4)
    assert float(found.angular_velocity[-1, 0]) == pytest.approx(-1.0, abs=1e-4)


# --- the frequency domain ---


def on_the_steady_motion(step: float, radius: float = 0.8) -> float:
    """Largest distance from the linear response over five periods of a run that starts on it."""
    system, drive = pair(), thirds()
    linear = harmonic_response(system, Excitation(("a",), [3.0], [SPEED], [[[100.0 + 40.0j]]])).isel(speed=0)
    found = transient(system, drive, 10 * np.pi / 300, linear, step=step, spectral_radius=radius)
    phase = np.exp(3j * SPEED * found.time.values)[:, None]
    return float(np.abs(found.angle.values - (phase * linear.angle.values[0]).real).max() / abs(linear.angle).max())


def test_a_run_from_the_linear_response_stays_on_it() -> None:
    errors = [on_the_steady_motion(step) for step in (4e-4, 2e-4, 1e-4)]
    assert errors[2] < 1e-3
    np.testing.assert_allclose([errors[0] / errors[1], errors[1] / errors[2]], 4.0, rtol=0.1)


def test_a_linear_truck_keeps_to_its_response() -> None:
    model = load_model("examples/truck_dmf_two_stage.yaml")
    assert model.engine is not None
    linear, _ = at_operating_point(model, 1500.0)
    given = model.engine.excitation(model.landmarks.throws, [SPEED], [1500.0], np.arange(0.5, 9.5, 0.5))
    response = harmonic_response(linear, given).isel(speed=0)

    def error(step: float) -> float:
        found = transient(linear, given, 4 * np.pi / SPEED, response, step=step, speed=SPEED)
        turns = np.exp(1j * SPEED * np.multiply.outer(found.time.values, response.order.values))
        expected = (turns @ response.torque.values).real
        return float(np.abs(found.torque.values - expected).max() / np.abs(expected).max())

    coarse, fine = error(2e-4), error(1e-4)
    assert fine < 2e-3 and coarse / fine == pytest.approx(4.0, rel=0.15)


def test_feedback_off_is_the_frequency_domain_on_is_not() -> None:
    system = pair()
    ways = (OrderTorques(thirds(), feedback) for feedback in (False, True))
    held, fed = (transient(system, way, 0.2, "vibrating", step=2e-4) for way in ways)
    plain = transient(system, thirds(), 0.2, "vibrating", step=2e-4)
    assert held.equals(plain)
    # the events move by the node's own angle, some 2 mrad: the torque by 3 × that of its amplitude
    assert 1e-4 < float(abs(fed.twist - held.twist).max() / abs(held.twist).max()) < 0.1


# --- energy ---


@pytest.mark.parametrize("radius", [1.0, 0.8, 0.3])
def test_energy_is_kept_account_of(radius: float) -> None:
    law = Hinges.staged([(20.0, 4e3), (500.0, 12e3)], lash=0.004)
    system = assemble(Powertrain({"a": Inertia(1.8), "b": Inertia(1.2), "s": Coupling("b", "a", law, 3.0)}))
    found = transient(system, thirds(30.0), 0.5, hold="b", spectral_radius=radius, output=1e-3)
    share = (found.energy - found.energy.isel(time=0)).sel(share=list(LEDGER))
    stored = share.sel(share=["kinetic", "strain"]).sum("share")
    left = stored - share.sel(share="sources") + share.sel(share=LOSSES).sum("share") - share.sel(share="method")
    through = float(share.sel(share="dampers")[-1])
    assert through > 0.01
    assert float(abs(left).max()) < 1e-10 * through
    # kinetic and strain energy by their own definitions
    kinetic = 0.5 * (np.array([1.8, 1.2]) * (found.angular_velocity.values - SPEED) ** 2).sum(axis=1)
    np.testing.assert_allclose(found.energy.sel(share="kinetic").values, kinetic, atol=1e-9 * kinetic.max())


# --- going on ---


def rubbing() -> System:
    """Stops that are struck, bristles under a load, washers, a governor to come."""
    parts = {
        "a": Inertia(1.8),
        "b": Inertia(1.2),
        "s": Coupling("b", "a", Contacts.between(-0.002, 0.002, 2e5, 1e-5), damping=4.0),
        "rub": Coupling("b", "a", LuGre(1e4, 3.0, 5.0, breakaway_torque=6.0, stribeck_rate=0.1)),
        "washer": Coupling("b", "a", Jenkins(5e3, 4.0)),
    }
    return assemble(Powertrain(parts))


def test_a_stored_run_goes_on_to_the_last_bit(tmp_path: Path) -> None:
    governor = Governor("a", SPEED, acts_on="a", proportional=20.0, integral=200.0, low=-500.0, high=500.0)
    system, drives = rubbing(), [OrderTorques(thirds(50.0), feedback=True), governor]
    whole, first = (transient(system, drives, time, "rest", hold="b") for time in (0.1, 0.05))
    save_results(first, tmp_path / "first.nc")
    second = transient(system, drives, 0.05, load_results(tmp_path / "first.nc"), hold="b")
    assert np.ptp(whole.twist.sel(element="s").values) > 0.004 and second.sizes["time"] == 501
    for name in ("angle", "angular_velocity", "acceleration", "torque", "memory", "energy", "end_standing"):
        late = whole[name].values[-501:] if "time" in whole[name].dims else whole[name].values
        np.testing.assert_array_equal(second[name].values, late, err_msg=name)
    np.testing.assert_array_equal(second.time.values, whole.time.values[-501:])


def test_the_explicit_integrator_goes_on_with_the_rotation_that_dampers_count_from() -> None:
    """x″ = 50 − 100 x − 8 (ẋ − δ), δ̇ = (ẋ − δ)/T from rest, by its exponential; in two runs, and in one."""
    line, push = spring(100.0, 8.0), TorqueHistory("disc", (0.0,), (50.0,))
    given = {"method": "explicit", "tolerance": 1e-10, "output": 0.05, "reference_time": 0.5, "speed": SPEED}
    whole, half = (transient(line, push, time, "rest", **given) for time in (0.6, 0.3))  # type: ignore[arg-type]
    rest = transient(line, push, 0.3, half, **given)  # type: ignore[arg-type]
    rates = np.array([[0.0, 1.0, 0.0, 0.0], [-100.0, -8.0, 8.0, 50.0], [0.0, 2.0, -2.0, 0.0], np.zeros(4)])
    exact = np.array([expm(rates * time)[0, 3] for time in whole.time.values])
    np.testing.assert_allclose(whole.angle.values[:, 0], exact, rtol=0, atol=1e-8)
    np.testing.assert_allclose(rest.angle.values[:, 0], exact[6:], rtol=0, atol=1e-8)


@pytest.mark.parametrize("other", [{"spectral_radius": 0.5}, {"drives": thirds(60.0)}], ids=str)
def test_from_a_run_by_another_method_or_under_other_torques_it_begins_afresh(other: dict[str, Any]) -> None:
    system, given = pair(), {"drives": thirds(50.0), "hold": "b"}
    first = transient(system, time=0.05, **given)
    second = transient(system, time=0.05, start=first, **given | other)
    assert float(second.energy.sel(share="sources")[0]) == 0.0 != float(first.energy.sel(share="sources")[-1])
    plain = MotionState.ending(first, system)
    np.testing.assert_array_equal(second.angle, transient(system, time=0.05, start=plain, **given | other).angle)


def test_samples_and_names_that_are_kept() -> None:
    found = transient(pair(), thirds(), 0.1, "rest", output=1e-3, keep=["s", "b"])
    assert found.sizes["node"] == found.sizes["element"] == 1
    np.testing.assert_allclose(np.diff(found.time), 1e-3)
    with pytest.raises(ModelError, match="no node or element 'bb'"):
        transient(pair(), thirds(), 0.1, "rest", keep=["bb"])


def test_speeds_are_whole_and_angles_are_deviations() -> None:
    ramp = SpeedProfile.ramp(SPEED, 2 * SPEED, 0.2)
    found = transient(pair(), (), 0.2, "rest", speed=ramp, step=1e-3)
    assert float(abs(found.angle).max()) == 0.0
    np.testing.assert_allclose(found.angular_velocity.values[:, 1], found.speed.values)
    assert float(found.crank_angle[-1]) == pytest.approx(0.2 * 1.5 * SPEED)


def test_a_governor_holds_a_speed_against_a_load() -> None:
    governor = Governor("a", SPEED, acts_on="a", proportional=20.0, integral=200.0, low=0.0, high=500.0)
    load = TorqueHistory("b", (0.0, 0.1, 0.1), (0.0, 0.0, -80.0))
    found = transient(pair(20.0), [governor, load], 3.0, "rest", speed=SPEED, output=1e-2)
    assert float(found.angular_velocity.sel(node="b").min()) < SPEED - 0.5
    assert float(found.angular_velocity.sel(node="b")[-1]) == pytest.approx(SPEED, abs=0.02)
    assert float(found.torque[-1, 0]) == pytest.approx(80.0, rel=0.01)


def test_an_inertia_that_would_switch_is_told() -> None:
    parts = {"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("b", "a", 1e3)}
    system = assemble(Powertrain(parts))
    switch = SpeedSwitch(3.0, 120.0)
    system = dataclasses.replace(system, masses=dataclasses.replace(system.masses, switches=(None, switch)))
    passing = transient(system, (), 0.1, "rest", speed=SpeedProfile.ramp(100.0, 150.0, 0.1), step=1e-3)
    assert "inertias of b stay" in passing.attrs["switched"]
    assert "switched" not in transient(system, (), 0.1, "rest", speed=100.0, step=1e-3).attrs


# --- being stopped, being refused ---


def test_interrupted_it_gives_what_was_reached() -> None:
    told: list[tuple[float, float, float]] = []

    def impatient(*now: float) -> None:
        told.append(now)  # type: ignore[arg-type]
        if len(told) == 3:
            raise KeyboardInterrupt

    found = transient(pair(), thirds(), 10.0, "rest", progress=impatient)
    assert found.attrs["status"].startswith("interrupted at 0.3")
    assert float(found.time[-1]) == pytest.approx(0.3)
    assert told[1][0] == pytest.approx(0.2) and told[1][1] == 10.0 and told[1][2] > 0
    went_on = transient(pair(), thirds(), 0.1, found)
    assert isinstance(went_on, xr.Dataset) and float(went_on.time[-1]) == pytest.approx(0.4)


@pytest.mark.parametrize(
    "given, told",
    [
        ({"time": -1.0}, "takes some time"),
        ({"step": 0.0}, "step must be positive"),
        ({"method": "euler"}, "unknown method"),
        ({"spectral_radius": 2.0}, "no such time step"),
        ({"speed": None}, "mean speed is missing"),
    ],
)
def test_what_cannot_be_stepped_is_refused(given: dict[str, object], told: str) -> None:
    settings: dict[str, object] = {"time": 0.1, "speed": 10.0, **given}
    with pytest.raises(ModelError, match=told):
        transient(pair(), (), settings.pop("time"), "rest", **settings)  # type: ignore[arg-type]
