"""Centrifugal pendulums along their exact paths in time, against an integration of their own equations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from torsional.absorbers import CentrifugalPendulum
from torsional.absorbers.pendulum import flattening, path_end
from torsional.components import Inertia, Shaft
from torsional.engine import Excitation
from torsional.numerics.motion.pendulum_path import pendulum_terms, weight_terms
from torsional.powertrain import Powertrain
from torsional.solvers.transient import MotionState, transient
from torsional.system import System, assemble

ORDER, DISTANCE, INERTIA, MASS, SPEED = 3.0, 0.1 * (1 + 1 / 9), 0.5, 1.0, 100.0
RHO = DISTANCE / (1 + ORDER**2)
QUIET = Excitation(("rotor",), [3.0], SPEED, [[0.0]])


def rotor(inertia: float = INERTIA, **options: object) -> System:
    pendulum = CentrifugalPendulum("rotor", MASS, DISTANCE, ORDER, **options)  # type: ignore[arg-type]
    return assemble(Powertrain({"rotor": Inertia(inertia), "pendulum": pendulum}))


def from_arc(arc: float, count: int = 1) -> MotionState:
    """The pendulums pushed aside, all else at rest in the turning frame."""
    angle = np.append(0.0, np.full(count, arc / DISTANCE))
    return MotionState(0.0, angle, np.zeros(count + 1), np.zeros(count), np.zeros(0))


@pytest.mark.parametrize("degrees", [5.0, 30.0, 60.0])
def test_a_circle_loses_its_order_with_amplitude(degrees: float) -> None:
    """On a heavy rotor n(φ0)/n0 = π/(2 K(sin²(φ0/2)))."""
    half = np.radians(degrees)
    data = transient(rotor(1e9), QUIET, 0.1, from_arc(RHO * half), step=2e-5, spectral_radius=1.0)
    twist = data.twist.sel(element="pendulum.suspension").values
    fall = int(np.flatnonzero((twist[:-1] > 0) & (twist[1:] <= 0))[1])  # five quarters of a period
    at = data.time.values[fall] + 2e-5 * twist[fall] / (twist[fall] - twist[fall + 1])
    exact = ORDER * np.pi / (2 * ellipk(np.sin(half / 2) ** 2))
    slowed = 1 - (exact * SPEED * 2e-5) ** 2 / 12  # by the steps themselves, where nothing is damped
    assert 2.5 * np.pi / (SPEED * at) == pytest.approx(exact * slowed, rel=3e-7)


@pytest.mark.parametrize("path", ["circular", "cycloid", "tautochrone"])
@pytest.mark.parametrize("count", [1, 2])
def test_rotor_and_pendulums_move_by_their_own_equations(path: str, count: int) -> None:
    """Large amplitudes, damping, a torque, and weight where there are several: integrated with rtol 1e-11."""
    torque, damping, arc = 60.0, 0.02, 0.6 * RHO
    lam, share = flattening(path, ORDER), MASS / count  # type: ignore[arg-type]
    places = 2 * np.pi * np.arange(count) / count

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        """θ, s…, θ̇, ṡ… with the whole angle."""
        n = count + 1
        heavy, load = np.diag(np.append(INERTIA, np.full(count, share))), np.zeros(n)
        load[0] = torque * np.cos(3 * SPEED * t)
        for p in range(count):
            s, rate = y[1 + p], y[n + 1 + p]
            squared, lever, on_carrier, along = pendulum_terms(RHO, lam, DISTANCE, s, rate, y[n])
            weight = weight_terms(RHO, lam, DISTANCE, s, y[0] + places[p], 9.80665 if count > 1 else 0.0)
            heavy[0, 0] += share * squared
            heavy[0, 1 + p] = heavy[1 + p, 0] = share * lever
            load[0] += share * (weight[0] - on_carrier)
            load[1 + p] += share * (weight[1] - along) - damping / count / DISTANCE**2 * rate
        return np.append(y[n:], np.linalg.solve(heavy, load))

    start = np.concatenate([[0.0], np.full(count, arc), [SPEED], np.zeros(count)])
    times = np.linspace(0.0, 0.1, 11)
    told = solve_ivp(slope, (0.0, 0.1), start, method="DOP853", t_eval=times, rtol=1e-11, atol=1e-13).y
    driven = Excitation(("rotor",), [3.0], SPEED, [[torque]])
    errors = []
    for step in (1e-4, 2e-5):
        data = transient(
            rotor(path=path, count=count, damping=damping), driven, 0.1, from_arc(arc, count), step=step, output=0.01
        )
        names = ["pendulum.suspension"] if count == 1 else [f"pendulum_{p + 1}.suspension" for p in range(count)]
        arcs = DISTANCE * data.twist.sel(element=names).values.T
        errors.append(np.abs(arcs - told[1 : count + 1]).max() / arc)
        np.testing.assert_allclose(
            data.angle.sel(node="rotor").values, told[0] - SPEED * times, atol=40 * step**2 * 1e3
        )
    assert errors[1] < 1e-3 and errors[0] / errors[1] > 20  # second order: 25


@pytest.mark.parametrize("path", ["circular", "cycloid", "tautochrone"])
def test_at_standstill_a_pendulum_swings_between_the_ends_of_its_path(path: str) -> None:
    line = rotor(path=path)
    start = MotionState.at_rest(line).moved(0.0, np.array([0.0, 20.0]))
    data = transient(line, (), 0.2, start, speed=0.0)
    arc = DISTANCE * data.twist.sel(element="pendulum.suspension").values
    assert data.attrs["status"] == "complete"
    assert 0.9 * path_end(path, ORDER, DISTANCE) < np.abs(arc).max() < path_end(path, ORDER, DISTANCE)  # type: ignore[arg-type]


@pytest.mark.parametrize("options", [{}, {"stop": 0.008}])
def test_a_run_begins_with_pendulums_in_the_middle_of_their_paths(options: dict[str, float]) -> None:
    """The carrier is wound up by the mean torque, by five times the length of the path here."""
    pendulum = CentrifugalPendulum("rotor", MASS, DISTANCE, ORDER, **options)  # type: ignore[arg-type]
    parts = {
        "rotor": Inertia(INERTIA),
        "load": Inertia(3.0),
        "shaft": Shaft("load", "rotor", 200.0),
        "pendulum": pendulum,
    }
    line = assemble(Powertrain(parts))
    driven = Excitation(("rotor",), [0.0, 3.0], SPEED, [[100.0, 20.0]])
    data = transient(line, driven, 0.2, hold="load", output=1e-3)
    assert float(data.twist.sel(element="shaft")[0]) == pytest.approx(0.5, rel=1e-3)
    assert np.abs(data.twist.sel(element="pendulum.suspension").values).max() < 0.05
