"""An engine that stops: the motion in time against an integration by hand, of one rigid crank with dry friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from tests.shipped import shipped

from torsional import CylinderTorques, Inertia, MotionState, Powertrain, assemble, transient
from torsional.engine import Engine

INERTIA, START = 4.0, 600 * np.pi / 30
CYCLE = 4 * np.pi


@cache
def engine() -> Engine:
    """One whose cylinders hold what they have: what leaks is checked in tests/solvers/transient/test_leaks.py."""
    found = shipped("truck_dmf_two_stage").engine
    assert found is not None
    return replace(found, leakage_time=1e9)


def friction() -> tuple[float, float]:
    """Dry [Nm] and growing with speed [Nms/rad], from the coefficients of Chen and Flynn: FMEP V/4π."""
    law, piston = engine().friction, engine().stroke * START / np.pi
    peak = float(engine().peak_pressure(START, motored()).max())
    arm = engine().displacement / CYCLE
    dry = (law.constant + law.peak_pressure_factor * peak) * arm
    return dry, (law.linear * piston + law.quadratic * piston**2) * arm / START


def motored() -> float:
    return float(engine().motored_torque(START)) * (1 - 1e-9)


@cache
def gas() -> CubicSpline:
    """Gas torque of all cylinders over the crank angle, motored."""
    angle = np.linspace(0.0, CYCLE, 2881)
    torque = engine().torque(START, motored(), angle, reciprocating=False).sum(axis=0)
    torque = torque + engine().mean_torque_split(START, motored()).friction.sum()
    return CubicSpline(angle, np.append(torque[:-1], torque[0]), bc_type="periodic")


def pistons(angle: float) -> tuple[float, float]:
    """Σ m x'² [kgm²] and Σ m x' x'' at a crank angle, from the slider-crank itself."""
    r, rod, mass = engine().stroke / 2, engine().rod_length, engine().reciprocating_mass
    a = angle - np.array(engine().layout.firing_angles)
    s = np.sqrt(rod**2 - (r * np.sin(a)) ** 2)
    first = -r * np.sin(a) * (1 + r * np.cos(a) / s)
    second = -r * np.cos(a) - r * r * (np.cos(2 * a) / s + (r * np.sin(a) * np.cos(a)) ** 2 / s**3)
    return mass * float(first @ first), mass * float(first @ second)


def motion(side: float) -> Callable[[float, np.ndarray], list[float]]:
    dry, damping = friction()
    r = engine().stroke / 2
    rotating = INERTIA - 6 * engine().reciprocating_mass * r * r / 2  # the throws' inertia holds half of the pistons

    def rates(_: float, y: np.ndarray) -> list[float]:
        squares, products = pistons(y[0])
        torque = float(gas()(y[0] % CYCLE)) - products * y[1] ** 2 - side * dry - damping * y[1]
        return [y[1], torque / (rotating + squares)]

    return rates


def by_hand() -> np.ndarray:
    """Times [s] and angles [rad] at which the crank turns round, the last one where friction holds it."""

    def still(_: float, y: np.ndarray) -> float:
        return float(y[1])

    still.terminal = True  # type: ignore[attr-defined]
    time, y, side, found = 0.0, np.array([0.0, START]), 1.0, []
    for _ in range(40):
        still.direction = -side  # type: ignore[attr-defined]
        told = solve_ivp(motion(side), (time, time + 10.0), y, events=still, rtol=1e-9, atol=1e-11)
        time, y = float(told.t[-1]), np.array([told.y[0, -1], 0.0])
        found.append((time, y[0]))
        held = float(gas()(y[0] % CYCLE))
        if abs(held) <= friction()[0]:
            return np.array(found)
        side = float(np.sign(held))
    raise AssertionError("it never comes to rest")


@cache
def stopped() -> xr.Dataset:
    line = assemble(Powertrain({"crank": Inertia(INERTIA)}))
    drive = CylinderTorques(engine(), ("crank",), START, motored() + 1.0, level=(0.0,))
    start = MotionState.at_rest(line).moved(0.0, np.array([START]))
    return transient(line, drive, 5.0, start, speed=0.0, output=1e-3)


def turning(run: xr.Dataset) -> np.ndarray:
    """Times and angles at which a run turns round."""
    time, speed, angle = (np.asarray(v) for v in (run.time, run.angular_velocity.isel(node=0), run.angle.isel(node=0)))
    at = np.flatnonzero(speed[:-1] * speed[1:] < 0)
    when = time[at] + (time[at + 1] - time[at]) * speed[at] / (speed[at] - speed[at + 1])
    return np.column_stack([when, np.interp(when, time, angle)])


def test_a_rigid_engine_stops_and_swings_back_as_by_hand() -> None:
    hand, found = by_hand(), turning(stopped())
    assert len(hand) > 5
    # twelve turns of the crank and the swings after them; bristles give way by 2 mrad
    assert found[0] == pytest.approx(hand[0], rel=1e-4)
    np.testing.assert_allclose(found[:5], hand[:5], atol=3e-3)
    assert float(stopped().angle[-1, 0]) == pytest.approx(hand[-1, 1], abs=0.03)


def test_friction_holds_what_gas_is_left_at_standstill() -> None:
    run = stopped()
    assert abs(float(run.angular_velocity[-1, 0])) < 1e-3
    held = float(run.torque.sel(element="friction_crank")[-1])
    assert held == pytest.approx(float(gas()(float(run.angle[-1, 0]) % CYCLE)), abs=0.5)
    assert abs(held) < friction()[0]


def test_what_turned_is_lost_in_friction_and_pumping() -> None:
    """Kinetic energy at the start = friction along the way + what gas took."""
    run = stopped()
    dry, damping = friction()
    speed, time = run.angular_velocity.isel(node=0).values, run.time.values
    rubbed = float(np.trapezoid(dry * np.abs(speed) + damping * speed**2, time))
    end = float(run.angle[-1, 0])
    taken = -gas().integrate(0.0, CYCLE) * (end // CYCLE) - gas().integrate(0.0, end % CYCLE)
    r = engine().stroke / 2
    rotating = INERTIA - 6 * engine().reciprocating_mass * r * r / 2
    before = 0.5 * (rotating + pistons(0.0)[0]) * START**2
    assert before == pytest.approx(rubbed + float(taken), rel=2e-3)
    assert float(run.energy.sel(share="friction")[-1]) == pytest.approx(rubbed, rel=2e-3)
    assert abs(run.attrs["method_share"]) < 1e-6


def test_friction_at_speed_is_that_of_the_operating_point() -> None:
    drive = CylinderTorques(engine(), ("crank",), START, 500.0)
    (dry,), (damping,) = drive.friction()
    assert (dry, damping) == pytest.approx(friction(), rel=1e-9)
    split = float(engine().mean_torque_split(START, motored()).friction.sum())
    assert dry + damping * START == pytest.approx(split)
    (whole,), (none,) = CylinderTorques(engine(), ("crank",), START, 500.0, feedback=False).friction()
    assert (whole, none) == pytest.approx((split, 0.0))
