"""The truck's straight-spring flywheel shoe by shoe, in time, against SciPy on formulas of its own."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from torsional.engine import Excitation
from torsional.files import load_model
from torsional.laws import LuGre, hinge_rows
from torsional.solvers.transient import MotionState, engine_drive, order_tracking, transient
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import starting
from torsional.system import System, assemble
from torsional.units import RPM

SPEED = 900 * RPM
LOADED, LIGHT = 1200.0, 60.0  # Nm: springs always pressed; shoes that leave their tabs and rattle


@cache
def machine(torque: float) -> tuple[System, Excitation]:
    model = load_model("examples/truck_dmf_straight_spring.yaml").detailed()
    return assemble(model.powertrain()), engine_drive(model, SPEED, torque, 12.0)


def stepped(torque: float, span: float, step: float, **given: object) -> xr.Dataset:
    system, drive = machine(torque)
    return transient(system, drive, span, hold="vehicle", step=step, **given)  # type: ignore[arg-type]


def begun(torque: float) -> tuple[Problem, MotionState]:
    system, drive = machine(torque)
    problem = Problem.of(system, drive, SPEED, hold="vehicle")
    return problem, starting("equilibrium", system, problem.acting, "vehicle", SPEED)


class Formulas:
    """ẏ of y = (q, q̇, z): springs, one-sided springs, dampers, and bristles pressed by rotation and springs."""

    def __init__(self, torque: float) -> None:
        system, drive = machine(torque)
        self.problem, self.start = begun(torque)
        c = system.connections
        self.w, self.n = c.weights, len(system.coordinates)
        self.stiffness, self.damping, hinges = c.stiffness.copy(), c.damping, []
        for e, law in enumerate(c.laws):
            if (found := hinge_rows(law)) is not None:
                self.stiffness[e] += found.stiffness
                each = zip(found.gap, found.side, found.change, found.contact_time, strict=True)
                hinges += [(e, *values) for values in each]
        of, self.gap, self.side, self.change, self.time = np.array(hinges).T
        self.of = of.astype(int)
        self.rubs = np.array([e for e, law in enumerate(c.laws) if isinstance(law, LuGre)])
        fields = "bristle_stiffness bristle_damping viscous_damping sliding_torque breakaway_torque stribeck_rate"
        laws = [c.laws[e] for e in self.rubs]
        self.bristles = np.array([[getattr(law, name) for law in laws] for name in fields.split()])
        self.grease = np.array([law.grease_damping for law in laws])  # type: ignore[union-attr]
        self.press(c)
        self.reference = system.T[system.node_index(self.problem.reference_node)]
        self.inverse = np.linalg.inv(system.M)
        self.orders = drive.orders
        torques = drive.torque.reshape(len(drive.nodes), -1)
        self.harmonics = torques.T @ system.T[[system.node_index(node) for node in drive.nodes]]
        held = system.T[system.node_index("vehicle")]
        mean = self.harmonics[drive.orders == 0.0].sum(axis=0).real
        self.constant = -held * mean.sum() / held.sum()

    def press(self, c: Any) -> None:
        """Normal loads: constant + centrifugal Ω² + shares of torques."""
        loads = [c.loads[e] for e in self.rubs]
        self.pressed = np.array([(load.constant, load.centrifugal) for load in loads]).T
        self.shares = np.zeros((len(loads), len(c.names)))
        for row, load in zip(self.shares, loads, strict=True):
            for name, share in load.share_of.items():
                row[c.names.index(name)] = share

    def __call__(self, t: float, y: np.ndarray) -> np.ndarray:
        q, v, z = np.split(y, [self.n, 2 * self.n])
        twist, rate = self.w @ q, self.w @ v
        beyond = self.side * (twist[self.of] - self.gap) + self.time * self.side * rate[self.of]
        torque = self.stiffness * twist + self.damping * rate
        np.add.at(torque, self.of, self.side * self.change * np.maximum(0.0, beyond))
        s0, s1, s2, sliding, breakaway, width = self.bristles
        u = rate[self.rubs]
        constant, centrifugal = self.pressed
        turning = SPEED + self.reference @ v
        load = np.maximum(0.0, constant + centrifugal * turning**2 + self.shares @ np.abs(torque))
        flow = u - s0 * np.abs(u) * z / (sliding + (breakaway - sliding) * np.exp(-((u / width) ** 2)))
        torque[self.rubs] += load * (s0 * z + s1 * flow + s2 * u) + self.grease * u
        outside = (np.exp(1j * self.orders * SPEED * t) @ self.harmonics).real + self.constant
        return np.concatenate([v, self.inverse @ (outside - torque @ self.w), flow])


@cache
def reference(torque: float, span: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and angles of all nodes, every tenth of a millisecond."""
    rates = Formulas(torque)
    start = np.concatenate([rates.start.angle, rates.start.speed, np.zeros(len(rates.rubs))])
    times = np.linspace(0.0, span, round(span / 1e-4) + 1)
    found = solve_ivp(rates, (0.0, span), start, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-12)
    assert found.success
    return times, found.y[: rates.n].T @ machine(torque)[0].T.T


def missed(torque: float, step: float) -> float:
    """How far any angle is off over 0.1 s, of the largest way."""
    times, exact = reference(torque, 0.1)
    run = stepped(torque, 0.1, step, output=1e-4)
    np.testing.assert_allclose(run.time.values, times, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.angle.values[0], exact[0], rtol=0, atol=1e-14)
    return float(np.abs(run.angle.values - exact).max() / np.abs(exact - exact[0]).max())


# step [s], then what may be missed: springs pressed all the time, shoes that leave their tabs
@pytest.mark.parametrize("torque, coarse, fine", [(LOADED, 5e-4, 2e-6), (LIGHT, 1.5e-2, 2.5e-5)])
def test_the_first_tenth_of_a_second(torque: float, coarse: float, fine: float) -> None:
    """Steps of 0.1 ms, and of 6.25 µs: of second order all the way."""
    far, near = missed(torque, 1e-4), missed(torque, 6.25e-6)
    assert far < coarse and near < fine
    assert np.log2(far / near) / 4.0 > 1.9


def test_what_presses_and_rubs_is_what_the_formulas_say() -> None:
    """Normal loads and bristles of all guides after 0.02 s under the light torque."""
    rates, span = Formulas(LIGHT), 0.02
    start = np.concatenate([rates.start.angle, rates.start.speed, np.zeros(len(rates.rubs))])
    end = solve_ivp(rates, (0.0, span), start, method="DOP853", rtol=1e-9, atol=1e-12).y[:, -1]
    run = stepped(LIGHT, span, 5e-6, output=span).isel(time=-1)
    z = end[2 * rates.n :]
    np.testing.assert_allclose(run.memory.values, z, rtol=0, atol=1e-4 * np.abs(z).max())
    constant, centrifugal = rates.pressed
    turning = SPEED + rates.reference @ end[rates.n : 2 * rates.n]
    sprung = rates.shares @ np.abs(run.torque.sel(element=list(machine(LIGHT)[0].connections.names)).values)
    np.testing.assert_allclose(run.normal_load.values, constant + centrifugal * turning**2 + sprung, rtol=1e-6)


@pytest.mark.parametrize("torque, bar", [(LOADED, 1e-3), (LIGHT, 3e-3), (20.0, 1e-2)])
def test_long_runs_agree_in_their_orders(torque: float, bar: float) -> None:
    """1.5 s by steps of 0.1 ms and 10 µs: where shoes rattle no trajectory stays, orders of the whole flywheel do."""
    runs = [stepped(torque, 1.5, step, output=1e-4) for step in (1e-4, 1e-5)]
    for element, name in (("dmf", "twist"), ("clutch", "torque")):
        found = [order_tracking(run[name].sel(element=element), run.crank_angle, [0.0, 3.0]) for run in runs]
        coarse, fine = (np.abs(each.values[-6:]).mean(axis=0) for each in found)
        np.testing.assert_allclose(coarse, fine, rtol=bar)
    assert all(abs(run.attrs["method_share"]) < 1e-3 for run in runs)
