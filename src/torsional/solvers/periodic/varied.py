"""A harmonic balance along any quantity of the system: a stiffness, a gap, an inertia, a damping."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.equations import ENOUGH, MOST_ITERATIONS, doubling_test
from torsional.numerics.continuation.following import Corrected
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.problem import HarmonicProblem, Setting
from torsional.system import System

KEPT = 64
NUDGE = 1e-5
"""Share of the parameter's scale by which it is moved to find the derivatives."""


class VariedProblem(HarmonicProblem):
    """A problem whose system is built anew at each value of the parameter; its derivative is a central difference, at
    the ``bounds`` of what can be built one to the inside."""

    def __init__(
        self,
        setting: Setting,
        base_order: float,
        build: Callable[[float], System],
        bounds: tuple[float, float] = (-np.inf, np.inf),
    ) -> None:
        super().__init__(setting, base_order)
        self.build, self.bounds = build, bounds
        self._frozen: OrderedDict[float, HarmonicProblem] = OrderedDict()

    def frozen(self, value: float) -> HarmonicProblem:
        """The problem of the system at one value; of linear parts that are equal the first is taken again."""
        if value not in self._frozen:
            split = Split(self.build(value), self.setting.split.speed, self.setting.split)
            self._frozen[value] = HarmonicProblem(replace(self.setting, split=split), self.base_order)
            while len(self._frozen) > KEPT:
                self._frozen.popitem(last=False)
        return self._frozen[value]

    def pieces(self, points: Array) -> Iterator[tuple[slice, HarmonicProblem]]:
        """Every point has a system of its own."""
        for i, z in enumerate(points):
            yield slice(i, i + 1), self.frozen(float(z[-1] * self.scale[-1]))

    def linearised(self, z: Array) -> tuple[Array, Array, Array, ComplexArray]:
        """Residual, Jacobian, derivative by the parameter and tangent spectra."""
        residual, jacobian, _, spectra = super().linearised(z)
        return residual, jacobian, self._slope(z), spectra

    def _slope(self, z: Array) -> Array:
        """Derivative of the residual by the parameter."""
        low, high = (bound / self.scale[-1] for bound in self.bounds)
        ways = (float(z[-1] + NUDGE <= high), -float(z[-1] - NUDGE >= low))
        sides = [super(VariedProblem, self).linearised(np.append(z[:-1], z[-1] + s * NUDGE))[0] for s in ways]
        return np.asarray((sides[0] - sides[1]) / ((ways[0] - ways[1]) * NUDGE * self.scale[-1]))

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method across a normal, as the compiled one; derivatives by the parameter are those of the guess."""
        z, tangent, values = guess.copy(), np.zeros_like(guess), np.zeros(len(self.tests))
        slope, size, last = self._slope(guess), np.inf, np.inf
        for iteration in range(1, MOST_ITERATIONS + 1):
            residual, jacobian, _, spectra = super().linearised(z)
            rows = np.column_stack([jacobian * self.scale[:-1], slope * self.scale[-1]]) / self.scale[:-1, None]
            rows = np.vstack([rows, normal])
            step = np.append(residual / self.scale[:-1], normal @ (z - guess))
            size = float(np.abs(step).max())
            try:
                both = np.linalg.solve(rows, np.column_stack([step, np.eye(z.size)[-1]]))
            except np.linalg.LinAlgError:
                break
            change = float(np.abs(both[:, 0]).max())
            if not np.isfinite(change) or (iteration > 3 and change > 4 * last):
                break
            z, last = z - both[:, 0], change
            if change <= ENOUGH * max(1.0, float(np.abs(z).max())):
                tangent = both[:, 1] / np.linalg.norm(both[:, 1])
                frozen = self.frozen(float(z[-1] * self.scale[-1]))
                values[0] = np.linalg.det(rows / np.linalg.norm(rows, axis=1)[:, None]) / (normal @ tangent)
                if values.size > 1:
                    values[1] = doubling_test(frozen.balance, float(z[-1] * self.scale[-1]), spectra)
                return Corrected(z, tangent, iteration, size, True, values)
        return Corrected(z, tangent, MOST_ITERATIONS, size, False, values)
