"""Parameters of a model found from what was measured: weighted least squares within bounds.

What is measured may be anything that a model predicts as arrays: torques of loops, order curves, histories.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares, lsq_linear

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.studies.estimates import Identified, Measured, Unknown

__all__ = ["Errors", "Identified", "Measured", "Prediction", "Unknown", "appraised", "identified", "refined"]

Prediction = Callable[[Mapping[str, float]], Sequence[Array]]
"""What a model predicts from parameters by name: an array for each operating point."""
Errors = Callable[[Mapping[str, float]], Sequence[Array]]
"""What errors of the angles, or whatever else it is given, do to a prediction: an array (samples, errors) for each
operating point, the change by one standard deviation of each error; errors of different points are independent."""
STEP = 0.02
"""Step of differences over the scale of a parameter: wide, since friction makes predictions bend sharply."""
ENOUGH = 1e-6
"""Share of the sum of squares, and of the parameters, below which the search ends."""
APART, AGAIN, MOST, SETTLED = 2.0, 0.25, 8, 0.01
"""Of a refinement: differences over so many standard deviations to either side, the share of that way after which they
are taken anew, steps at most, and the gain in squares, over those of one degree of freedom, with which it is done."""


class _Problem:
    """Weighted residuals and their slopes over scaled parameters; the last evaluation is kept."""

    def __init__(self, predicted: Prediction, measured: Sequence[Measured], unknowns: Sequence[Unknown]) -> None:
        self.predicted, self.measured, self.unknowns = predicted, measured, unknowns
        self.scale = np.array([unknown.scale for unknown in unknowns])
        self.high = np.array([unknown.high for unknown in unknowns]) / self.scale
        self.low = np.array([unknown.low for unknown in unknowns]) / self.scale
        self.evaluations = 0
        self._last: tuple[Array, list[Array]] | None = None

    def each(self, scaled: Array) -> list[Array]:
        """Residuals over the noise of every point."""
        if self._last is not None and np.array_equal(self._last[0], scaled):
            return self._last[1]
        self.evaluations += 1
        names = [unknown.name for unknown in self.unknowns]
        told = self.predicted(dict(zip(names, (scaled * self.scale).tolist(), strict=True)))
        self._last = scaled.copy(), list(self._over_noise(told))
        return self._last[1]

    def _over_noise(self, told: Sequence[Array]) -> Iterator[Array]:
        if len(told) != len(self.measured):
            found = f"{len(told)} predicted, {len(self.measured)} measured"
            raise ModelError("operating points differ", where="identification", found=found)
        for point, model in zip(self.measured, told, strict=True):
            if np.shape(model) != point.values.shape or not np.isfinite(model).all():
                found = f"{np.shape(model)} predicted, {point.values.shape} measured"
                raise ModelError("the model predicts no finite value for each one", where=point.name, found=found)
            yield (point.values - model) / point.noise

    def weighted(self, scaled: Array) -> Array:
        """All residuals in one row."""
        parts = zip(self.measured, self.each(scaled), strict=True)
        return np.concatenate([point.weight * each for point, each in parts])

    def slopes(self, scaled: Array) -> Array:
        """Forward differences, backward at an upper bound."""
        base = self.weighted(scaled)
        found = np.empty((base.size, scaled.size))
        for i, value in enumerate(scaled):
            step = STEP if value + STEP <= self.high[i] else -STEP
            moved = scaled.copy()
            moved[i] += step
            found[:, i] = (self.weighted(moved) - base) / step
        return found

    def local_slopes(self, scaled: Array, apart: Array) -> Array:
        """Central differences over so much to either side, within the bounds."""
        found = np.empty((self.weighted(scaled).size, scaled.size))
        for i, step in enumerate(apart):
            ends = np.array([max(scaled[i] - step, self.low[i]), min(scaled[i] + step, self.high[i])])
            below, above = (np.where(np.arange(scaled.size) == i, end, scaled) for end in ends)
            found[:, i] = (self.weighted(above) - self.weighted(below)) / (ends[1] - ends[0])
        return found

    def told(self, scaled: Array, slopes: Array, errors: Errors | None) -> Identified:
        """What was found at one place."""
        names, weights = tuple(p.name for p in self.measured), tuple(p.weight for p in self.measured)
        residuals = tuple(self.each(scaled))
        found = Identified(
            tuple(self.unknowns), scaled * self.scale, names, residuals, weights, slopes, self.evaluations
        )
        return found if errors is None else replace(found, inputs=self._inputs(errors(found.values)))

    def _inputs(self, changes: Sequence[Array]) -> tuple[Array, ...]:
        """What errors of what the model is given do to the weighted residuals of every point."""
        parts = zip(self.measured, changes, strict=True)
        return tuple(each * (-point.weight / point.noise) for point, each in parts)


def _problem(predicted: Prediction, measured: Sequence[Measured], unknowns: Sequence[Unknown]) -> _Problem:
    names = [unknown.name for unknown in unknowns]
    if not measured or not unknowns or len(set(names)) != len(names):
        found = f"{len(measured)} operating points, parameters {', '.join(names) or 'none'}"
        raise ModelError("something measured is wanted, and parameters of different names", found=found)
    samples = sum(point.values.size for point in measured)
    if samples <= len(unknowns):
        found, allowed = f"{samples} values for {len(unknowns)} parameters", "more values than parameters"
        raise ModelError("too little was measured", where="identification", found=found, allowed=allowed)
    return _Problem(predicted, measured, unknowns)


@checked
def identified(
    predicted: Prediction,
    measured: Sequence[Measured],
    unknowns: Sequence[Unknown],
    *,
    starts: int = 1,
    seed: int = 0,
    enough: float = ENOUGH,
    rough: Prediction | None = None,
    errors: Errors | None = None,
) -> Identified:
    """The parameters with which a model comes nearest to what was measured, min Σ (weight · residual/noise)².

    ``predicted`` gives, from values by name, an array for each of the operating points ``measured``.  A trust region
    of scipy's, within the bounds of the ``unknowns`` and over their scales.  Of several ``starts`` the first is that
    of the unknowns, the others lie evenly at random between the bounds (``seed``); the best counts.  The search ends
    where a step changes the sum of squares, or the parameters, by a share of less than ``enough``.  A ``rough`` model,
    which takes less time, serves for the slopes where there is one.  ``errors`` of what the model is given widen
    what is told of the estimates.
    Raises ModelError where there is less measured than looked for, and for predictions of another shape.

    >>> x = np.linspace(0.0, 1.0, 5)
    >>> unknowns = [Unknown("k", "stiffness", 1.0, 0.0, 9.0), Unknown("T", "torque", 0.0, -1.0, 1.0, scale=1.0)]
    >>> line = Measured("line", 3.0 * x + 0.5, noise=0.01)
    >>> found = identified(lambda v: [v["k"] * x + v["T"]], [line], unknowns)
    >>> {name: round(value, 6) for name, value in found.values.items()}
    {'k': 3.0, 'T': 0.5}
    """
    problem = _problem(predicted, measured, unknowns)
    sloped = _problem(rough, measured, unknowns) if rough else problem
    first = np.array([unknown.start for unknown in unknowns]) / problem.scale
    draw = np.random.default_rng(seed)
    others = (problem.low + (problem.high - problem.low) * draw.random(first.size) for _ in range(starts - 1))
    runs = [_search(problem, sloped, first, enough)]
    for start in others:
        with suppress(ModelError):  # what lies between the bounds may be no model together
            runs.append(_search(problem, sloped, start, enough))
    best = min(runs, key=lambda run: float(run.cost))
    return problem.told(best.x, np.asarray(best.jac), errors)


def _search(problem: _Problem, sloped: _Problem, start: Array, enough: float) -> Any:
    bounds = problem.low, problem.high
    return least_squares(problem.weighted, start, sloped.slopes, bounds, ftol=enough, xtol=enough, gtol=None)


@checked
def refined(
    predicted: Prediction,
    measured: Sequence[Measured],
    found: Identified,
    *,
    errors: Errors | None = None,
    rough: Prediction | None = None,
) -> Identified:
    """What was ``found`` taken to the very minimum, from where it is: Gauss and Newton's steps within the bounds, with
    slopes over two standard deviations to either side, of a ``rough`` model where there is one.

    A search with wide slopes ends where friction bends them, some standard deviations away, which intervals would know
    nothing of.  Slopes are taken anew where it has gone half a standard deviation.

    >>> x = np.linspace(0.0, 1.0, 9)
    >>> bent, unknown = 2.0 * x + 0.01 * x**3, Unknown("k", "stiffness", 1.9, 0.0, 9.0)
    >>> line = Measured("line", bent, noise=0.01)
    >>> near = appraised(lambda v: [v["k"] * x + 0.01 * x**3], [line], [unknown])
    >>> round(refined(lambda v: [v["k"] * x + 0.01 * x**3], [line], near).values["k"], 9)
    2.0
    """
    problem = _problem(predicted, measured, found.unknowns)
    sloped = _problem(rough, measured, found.unknowns) if rough else problem
    near, slopes, there = found.estimates / problem.scale, found.slopes, None
    known = np.where(np.isfinite(found.deviations), found.deviations, np.inf) / problem.scale
    apart = np.clip(APART * known, ENOUGH, STEP)
    for _ in range(MOST):
        before = problem.weighted(near)
        if there is None or (np.abs(near - there) > AGAIN * apart).any():
            slopes, there = sloped.local_slopes(near, apart), near
        step = _step(slopes, before, problem.low - near, problem.high - near)
        squares, enough = float(before @ before), SETTLED * float(before @ before) / found.freedom
        last = squares - float(np.square(before + slopes @ step).sum()) < enough
        parts = (1.0,) if last else (1.0, 0.5, 0.25)
        shares = (np.clip(near + share * step, problem.low, problem.high) for share in parts)
        tried = ((each, float(np.square(problem.weighted(each)).sum())) for each in shares)
        near, left = next((pair for pair in tried if pair[1] < squares), (near, squares))
        if last or squares - left < enough:
            break
    return problem.told(near, slopes, errors)


def _step(slopes: Array, residuals: Array, low: Array, high: Array) -> Array:
    """The step within bounds that leaves least of the residuals, were these linear."""
    turn, small = np.linalg.qr(slopes)
    reach = np.where(high - low > 0.0, high - low, 1.0) * 1e-12
    return np.asarray(lsq_linear(small, -turn.T @ residuals, (np.minimum(low, -reach), np.maximum(high, reach))).x)


@checked
def appraised(
    predicted: Prediction, measured: Sequence[Measured], unknowns: Sequence[Unknown], *, errors: Errors | None = None
) -> Identified:
    """What the measurement tells of parameters where they are, at their start values, without looking for better ones.

    Its deviations and correlations say what a fit of them all would be worth.
    """
    problem = _problem(predicted, measured, unknowns)
    here = np.array([unknown.start for unknown in unknowns]) / problem.scale
    return problem.told(here, problem.slopes(here), errors)
