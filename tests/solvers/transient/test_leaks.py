"""Cylinders that stand still lose their charge past the rings; running ones do not."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from torsional.components import Inertia
from torsional.engine import ChenFlynn, CombustionCycle, CrankLayout, Engine, LoadTable
from torsional.errors import ModelError
from torsional.powertrain import Powertrain
from torsional.solvers.transient import CylinderTorques, MotionState, TorqueHistory, transient
from torsional.system import assemble

LEAKAGE, INERTIA, INTAKE, CRANKCASE = 0.1, 2.0, 1.05e5, 1.0e5
IDLE = 62.8
WEIGHT = 60.0
"""A torque [Nm] that pushes the piston up, against its charge."""
ONE = Engine(
    bore=0.131,
    stroke=0.158,
    rod_length=0.2675,
    reciprocating_mass=0.0,
    compression_ratio=18.1,
    layout=CrankLayout.inline((1,)),
    gas=CombustionCycle(boost=LoadTable(((0.0, INTAKE), (1e5, INTAKE)))),
    friction=ChenFlynn(0.0, 0.0, 0.0, 0.0),
    crankcase_pressure=CRANKCASE,
    leakage_time=LEAKAGE,
)
LINE = assemble(Powertrain({"crank": Inertia(INERTIA)}))


def pushed(engine: Engine, torque: float = WEIGHT) -> list[CylinderTorques | TorqueHistory]:
    """What acts on the crank: the cylinder without fuel, and the weight."""
    gas = CylinderTorques(engine, ("crank",), IDLE, 0.0, level=(0.0,), reciprocating="none")
    return [gas, TorqueHistory("crank", (0.0,), (torque,))]


def moved(engine: Engine, angle: float, time: float, **settings: object) -> xr.Dataset:
    """The crank let go at an angle [rad], its frame at rest."""
    start = MotionState(0.0, np.array([angle]), np.zeros(1), np.zeros(len(LINE.connections.names)), np.zeros(0))
    told: dict[str, object] = {"step": 2e-5, "output": 1e-3} | settings
    return transient(LINE, pushed(engine), time, start, speed=0.0, **told)  # type: ignore[arg-type]


def by_hand(angle: float, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """J θ̈ = A x'(θ) (c p − p_c) + T, ċ = −(c − p_c/p)(1 − |θ̇|/20)/τ, valves closed; θ, θ̇ and c at times."""
    r, l, area = 0.079, 0.2675, 0.25 * np.pi * 0.131**2
    clearance = 2 * r * area / 17.1

    def piston(a: float) -> tuple[float, float]:
        low = np.sqrt(l * l - (r * np.sin(a)) ** 2)
        return r * (1 - np.cos(a)) + l - low, r * np.sin(a) * (1 + r * np.cos(a) / low)

    def rates(_: float, y: NDArray[np.float64]) -> list[float]:
        (x, lever), closing = piston(y[0]), piston(np.radians(-150.0))[0]
        p = INTAKE * ((clearance + area * closing) / (clearance + area * x)) ** 1.35
        leaking = max(0.0, 1 - abs(y[1]) / 20.0) / LEAKAGE
        return [
            y[1],
            area * lever * (y[2] * p - CRANKCASE) / INERTIA + WEIGHT / INERTIA,
            -leaking * (y[2] - CRANKCASE / p),
        ]

    found = solve_ivp(rates, (0.0, times[-1]), [angle, 0.0, 1.0], t_eval=times, rtol=1e-10, atol=1e-12)
    return np.asarray(found.y)


def test_a_piston_swings_on_its_leaking_charge_as_worked_out_by_hand() -> None:
    run = moved(ONE, np.radians(-100.0), 1.0)
    angle, speed, charge = by_hand(np.radians(-100.0), run.time.values)
    assert np.ptp(angle) > 0.5 and charge[-1] < 0.7
    assert run.angle.values[:, 0] == pytest.approx(angle, abs=5e-4 * np.ptp(angle))
    assert run.angular_velocity.values[:, 0] == pytest.approx(speed, abs=5e-4 * np.ptp(speed))
    assert float(run.end_charge[0]) + 1 == pytest.approx(charge[-1], abs=1e-3)


def test_a_tight_cylinder_swings_for_ever() -> None:
    run = moved(dataclasses.replace(ONE, leakage_time=1e9), np.radians(-100.0), 2.0)
    assert float(run.angle[-1000:].max()) == pytest.approx(np.radians(-100.0), abs=1e-3)


def test_it_goes_on_to_the_last_bit_and_agrees_with_the_explicit_integrator() -> None:
    whole = moved(ONE, np.radians(-100.0), 0.3)
    half = moved(ONE, np.radians(-100.0), 0.15)
    rest = transient(LINE, pushed(ONE), 0.15, half, speed=0.0, step=2e-5, output=1e-3)
    np.testing.assert_array_equal(rest.angle.values, whole.angle.values[150:])
    np.testing.assert_array_equal(rest.end_charge.values, whole.end_charge.values)
    other = moved(ONE, np.radians(-100.0), 0.3, method="explicit", tolerance=1e-9)
    assert other.angle.values == pytest.approx(whole.angle.values, abs=2e-3)
    assert other.end_charge.values == pytest.approx(whole.end_charge.values, abs=2e-3)


def test_a_running_engine_sees_none_of_it() -> None:
    """Down to 20 rad/s of the crank itself, whatever the leakage: to the last bit."""

    def running(leakage: float) -> xr.Dataset:
        engine = dataclasses.replace(ONE, leakage_time=leakage)
        drive = CylinderTorques(engine, ("crank",), IDLE, 50.0)
        return transient(LINE, drive, 0.5, "rest", speed=IDLE, hold="crank")

    leaky, tight = running(0.01), running(1e9)
    assert 20.0 < float(leaky.angular_velocity.min()) < IDLE
    np.testing.assert_array_equal(leaky.angle, tight.angle)
    assert float(abs(leaky.end_charge).max()) == 0.0


def test_valves_that_open_fill_the_cylinder() -> None:
    """Turned through a standstill: the charge is lost, and whole again after the next intake stroke."""
    run = moved(ONE, np.radians(-100.0), 0.3)
    assert float(run.end_charge[0]) < -0.3
    turned = MotionState.ending(run, LINE).moved(0.0, 60.0)
    gone = transient(LINE, pushed(ONE, 0.0), 0.5, turned, speed=0.0)
    assert float(gone.angle[-1, 0]) > 4 * np.pi and float(gone.end_charge[0]) == 0.0


def test_a_leakage_time_is_positive() -> None:
    with pytest.raises(ModelError, match="leakage_time"):
        dataclasses.replace(ONE, leakage_time=0.0)
