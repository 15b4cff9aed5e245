"""Curves of folds and period doublings in two parameters: the boundary of a region of sub-harmonic vibration.

    R(x, p; r) = 0,   g(x, p; r) = 0   with   [D b; cᵀ 0] [v; g] = [0; 1]

D is the matrix that is singular there: the Jacobian at a fold, the block of odd half orders at a period doubling.  The
border b, c from the null vectors of the last point makes g a smooth function that is zero where D is singular
(Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria, SIAM 2000, doi 10.1137/1.9780898719543).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.balance.equations import ENOUGH, MOST_ITERATIONS
from torsional.numerics.continuation.following import FOLD, Corrected, Point, Settings, Trace, both_ways
from torsional.solvers.periodic.problem import HarmonicProblem

CURVE = Settings(first_step=0.02, largest_step=0.1, largest_angle=0.3, most_points=600)
DOUBLING = "period doubling"
OUT = "left the range"
NUDGE = 1e-6


class _CurveProblem:
    """Unknowns (x, p) of a bifurcation, scaled, along a second parameter r.

    ``family`` gives the problem over p for a value of r; ``kind`` is "fold" or "period doubling"; the curve is left
    where p leaves ``span``.
    """

    def __init__(
        self,
        family: Callable[[float], HarmonicProblem],
        kind: str,
        start: Array,
        second: float,
        scale: float,
        span: tuple[float, float],
    ) -> None:
        if kind not in (FOLD, DOUBLING):
            raise ModelError("there is no such curve", where="kind", found=kind, allowed=f"{FOLD}, {DOUBLING}")
        self.family, self.kind, self.span = family, kind, span
        self.scale = np.append(family(second).scale, scale)
        self.tests = (OUT,)
        self.border = self._null(family(second), start)

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method; derivatives of g and by r are differences, the equations themselves are exact."""
        y, last = guess.copy(), np.inf
        size = np.inf
        for iteration in range(1, MOST_ITERATIONS + 1):
            try:
                value, slope = self._equations(y)
                rows = np.vstack([slope, normal])
                step = np.append(value, normal @ (y - guess))
                size = float(np.abs(step).max())
                both = np.linalg.solve(rows, np.column_stack([step, np.eye(y.size)[-1]]))
            except (np.linalg.LinAlgError, ModelError):
                break
            change = float(np.abs(both[:, 0]).max())
            if not np.isfinite(change) or (iteration > 4 and change > 4 * last):
                break
            y, last = y - both[:, 0], change
            if change <= 10 * ENOUGH * max(1.0, float(np.abs(y).max())):
                self.border = self._null(self._problem(y), y[:-1])
                tangent = both[:, 1] / np.linalg.norm(both[:, 1])
                return Corrected(y, tangent, iteration, size, True, np.array([self._inside(y)]))
        return Corrected(y, np.zeros_like(y), MOST_ITERATIONS, size, False, np.zeros(1))

    def _problem(self, y: Array) -> HarmonicProblem:
        return self.family(float(y[-1] * self.scale[-1]))

    def _inside(self, y: Array) -> float:
        p, (low, high) = float(y[-2] * self.scale[-2]), self.span
        return (p - low) * (high - p) / (high - low) ** 2

    def _equations(self, y: Array) -> tuple[Array, Array]:
        problem, n = self._problem(y), y.size - 2
        residual, jacobian, slope, _ = problem.linearised(y[:-1])
        value = np.append(residual / problem.scale[:-1], self._g(problem, y[:-1]))
        rows = np.zeros((n + 1, n + 2))
        rows[:n, :n] = jacobian * problem.scale[:-1] / problem.scale[:-1, None]
        rows[:n, n] = slope * problem.scale[-1] / problem.scale[:-1]
        for j in range(n + 1):
            moved = [self._g(problem, y[:-1] + s * NUDGE * np.eye(n + 1)[j]) for s in (1, -1)]
            rows[n, j] = (moved[0] - moved[1]) / (2 * NUDGE)
        rows[:, n + 1] = self._by_second(y)
        return value, rows

    def _by_second(self, y: Array) -> Array:
        sides = []
        for s in (1, -1):
            problem = self.family(float((y[-1] + s * 1e2 * NUDGE) * self.scale[-1]))
            residual = problem.linearised(y[:-1])[0]
            sides.append(np.append(residual / problem.scale[:-1], self._g(problem, y[:-1])))
        return np.asarray((sides[0] - sides[1]) / (2e2 * NUDGE))

    def _block(self, problem: HarmonicProblem, z: Array) -> Array:
        if self.kind == DOUBLING:
            return problem.half_order_block(z)
        jacobian = problem.linearised(z)[1]
        return np.asarray(jacobian * problem.scale[:-1] / problem.scale[:-1, None])

    def _g(self, problem: HarmonicProblem, z: Array) -> float:
        left, right = self.border
        block = self._block(problem, z)
        whole = np.block([[block, left[:, None]], [right[None, :], np.zeros((1, 1))]])
        return float(np.linalg.solve(whole, np.eye(len(whole))[-1])[-1])

    def _null(self, problem: HarmonicProblem, z: Array) -> tuple[Array, Array]:
        left, _, right = np.linalg.svd(self._block(problem, z))
        return left[:, -1], right[-1]


def bifurcation_curve(
    family: Callable[[float], HarmonicProblem],
    event: Point,
    second: float,
    span: tuple[float, float],
    second_span: tuple[float, float],
    settings: Settings = CURVE,
) -> Trace:
    """The curve of a located fold or period doubling over a second parameter, both ways from where it was found.

    ``family`` gives the problem over the first parameter for a ``second`` one; ``span`` and ``second_span`` bound
    them.  Points are (x, p, r); their ``parameter`` is r.
    """
    scale = max(abs(second_span[0]), abs(second_span[1]))
    problem = _CurveProblem(family, event.event, event.z, second, scale, span)
    start = np.append(event.z, second / scale)
    return both_ways(problem, start, second_span, replace(settings, terminal=(OUT,)))
