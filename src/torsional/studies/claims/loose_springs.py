"""The truck with springs and shoes that are loose in their channels, and its rates for general integrators."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np

from torsional.absorbers.straight_spring import StraightSprings, straight_spring_flywheel
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.motion.data import CENTRIFUGAL, CHANGE, CONTACT_TIME, DAMPER, GAP, SIDE, SPRING, HingeRows
from torsional.numerics.stepping.plan import LEFT, RIGHT, Pairs, dense, mass_matrix
from torsional.solvers.transient.acting import row_of
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState, starting
from torsional.studies.answers import main_order
from torsional.studies.straight_springs import DESIGN
from torsional.system import System, assemble
from torsional.units import RPM

SPEED, TORQUE = 650.0 * RPM, 300.0
SPAN, SAMPLING = 0.5, 1e-3
EXACT = 1e-9
"""Tolerance of the motion that the others are measured by."""


def loosened(model: Model, design: StraightSprings = DESIGN) -> Model:
    """The truck with its flywheels' springs by a design; raises ModelError where it has no such flywheels."""
    parts = straight_spring_flywheel(design).components
    missing = {"primary", "secondary", "dmf"} - set(model.components)
    if missing:
        raise ModelError("the truck has no dual mass flywheel to put springs into", found=f"without {min(missing)}")
    kept = {name: part for name, part in model.components.items() if name not in parts}
    return model.replaced(components={**kept, **parts}, document={})


@dataclass(frozen=True, eq=False)
class LooseMotion:
    """The truck at one speed [rad/s] from equilibrium under a mean torque [Nm] on, driven by the firing order."""

    model: Model
    speed: float = SPEED
    torque: float = TORQUE
    design: StraightSprings = DESIGN

    @cached_property
    def system(self) -> System:
        """The line in top gear."""
        return assemble(loosened(self.model, self.design).powertrain())

    @cached_property
    def excitation(self) -> Excitation:
        """Torques of the throws."""
        orders = [0.0, main_order(self.model)]
        return self.model.running_engine.excitation(self.model.landmarks.throws, self.speed, self.torque, orders)

    @cached_property
    def problem(self) -> Problem:
        """All of it as arrays."""
        return Problem.of(self.system, self.excitation, None, hold=self.model.landmarks.load)

    @cached_property
    def start(self) -> MotionState:
        """Equilibrium under the mean torque."""
        given = self.problem.acting, self.model.landmarks.load, self.speed
        return starting("equilibrium", self.system, *given)

    @property
    def times(self) -> Array:
        """The samples [s]."""
        return np.linspace(0.0, SPAN, round(SPAN / SAMPLING) + 1)

    @cached_property
    def exact(self) -> Array:
        """The flywheels' relative angle [rad] at the samples."""
        found = explicit_march(self.problem.equations, self.times, self.start.angle, self.start.speed, tolerance=EXACT)
        return self.twist(found.angles)

    def twist(self, angles: Array) -> Array:
        """The flywheels' relative angle [rad] of coordinates (…, N)."""
        row = row_of(self.system, "secondary") - row_of(self.system, "primary")
        return np.asarray(angles @ row)

    def error(self, twist: Array) -> float:
        """Root of the mean square deviation over the run, over that of the exact motion about its mean."""
        return float(np.sqrt(np.mean((twist - self.exact) ** 2)) / self.exact.std())

    def loads(self) -> Array:
        """Torques [Nm] of the coordinates (3, N): mean, cosine and sine of the firing order's phase."""
        rows = np.array([row_of(self.system, node) for node in self.excitation.nodes])
        mean, swing = (rows.T @ self.excitation.torque[:, h] for h in (0, 1))
        held = row_of(self.system, self.model.landmarks.load)
        return np.array([mean.real - held * mean.real.sum() / held.sum(), swing.real, -swing.imag])

    def rates(self) -> Callable[[float, Array], Array]:
        """ẏ(t, y) of y = (q, q̇), compiled; raises ModelError for more than springs, dampers and hinges."""
        equations, plan = self.problem.equations, self.problem.plan
        if plan.laws.of.size or plan.pairs.extra.size or plan.constants[CENTRIFUGAL].any():
            raise ModelError("only springs, dampers and hinges of pairs have this right-hand side")
        inverse = np.asarray(np.linalg.inv(mass_matrix(equations)), dtype=float)
        springs = plan.constants[[SPRING, DAMPER]]
        frequency, loads = float(self.excitation.orders[1]) * self.speed, self.loads()

        def rates(t: float, y: Array) -> Array:
            out = np.empty_like(y)
            _rates(plan.pairs, springs, plan.hinges, inverse, loads, frequency * t, y, out)
            return out

        return rates

    def jacobian(self) -> Callable[[float, Array], Array]:
        """∂ẏ/∂y of the same."""
        equations = self.problem.equations
        n, on, hinges = equations.coordinates, equations.connected, self.problem.plan.hinges
        w, inverse = dense(on.rows, n), np.linalg.inv(mass_matrix(equations))
        of = hinges.of.astype(int)
        gap, side, change, delay = hinges.values[[GAP, SIDE, CHANGE, CONTACT_TIME]]

        def jacobian(t: float, y: Array) -> Array:
            depth = w[of] @ y[:n] - gap + delay * (w[of] @ y[n:])
            closed = np.where(side * depth > 0.0, change, 0.0)
            k = on.constants[SPRING] + np.bincount(of, closed, len(w))
            c = on.constants[DAMPER] + np.bincount(of, closed * delay, len(w))
            lower = [-inverse @ ((w.T * each) @ w) for each in (k, c)]
            return np.block([[np.zeros((n, n)), np.eye(n)], [lower[0], lower[1]]])

        return jacobian


@numba.njit(cache=True, error_model="numpy")
def _rates(
    pairs: Pairs, springs: Array, hinges: HingeRows, inverse: Array, loads: Array, phase: float, y: Array, out: Array
) -> None:
    n, count, ends, weights = inverse.shape[0], springs.shape[1], pairs.ends, pairs.weights
    q, v, torque = y[:n], y[n:], np.empty(n)
    angle, rate, held = np.empty(count), np.empty(count), np.empty(count)
    for i in range(n):
        torque[i] = loads[0, i] + loads[1, i] * math.cos(phase) + loads[2, i] * math.sin(phase)
    for e in range(count):
        left, right, first, second = ends[LEFT, e], ends[RIGHT, e], weights[LEFT, e], weights[RIGHT, e]
        angle[e], rate[e] = first * q[left] + second * q[right], first * v[left] + second * v[right]
        held[e] = springs[0, e] * angle[e] + springs[1, e] * rate[e]
    for i in range(hinges.of.size):
        e = hinges.of[i]
        depth = angle[e] - hinges.values[GAP, i] + hinges.values[CONTACT_TIME, i] * rate[e]
        if hinges.values[SIDE, i] * depth > 0.0:
            held[e] += hinges.values[CHANGE, i] * depth
    for e in range(count):
        torque[ends[LEFT, e]] -= weights[LEFT, e] * held[e]
        torque[ends[RIGHT, e]] -= weights[RIGHT, e] * held[e]
    for i in range(n):
        out[i], total = v[i], 0.0
        for j in range(n):
            total += inverse[i, j] * torque[j]
        out[n + i] = total
