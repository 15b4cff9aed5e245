"""Parameters of a model found from what was measured: weighted least squares within bounds.

What is measured may be anything that a model predicts as arrays: torques of loops, order curves, histories.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np
from scipy.optimize import least_squares

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.studies.estimates import Identified, Measured, Unknown

__all__ = ["Identified", "Measured", "Prediction", "Unknown", "appraised", "identified"]

Prediction = Callable[[Mapping[str, float]], Sequence[Array]]
"""What a model predicts from parameters by name: an array for each operating point."""
STEP = 0.02
"""Step of differences over the scale of a parameter: wide, since friction makes predictions bend sharply."""
ENOUGH = 1e-6
"""Share of the sum of squares, and of the parameters, below which the search ends."""


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

    def told(self, scaled: Array, slopes: Array) -> Identified:
        """What was found at one place."""
        names, weights = tuple(p.name for p in self.measured), tuple(p.weight for p in self.measured)
        residuals = tuple(self.each(scaled))
        return Identified(
            tuple(self.unknowns), scaled * self.scale, names, residuals, weights, slopes, self.evaluations
        )


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
) -> Identified:
    """The parameters with which a model comes nearest to what was measured, min Σ (weight · residual/noise)².

    ``predicted`` gives, from values by name, an array for each of the operating points ``measured``.  A trust region
    of scipy's, within the bounds of the ``unknowns`` and over their scales.  Of several ``starts`` the first is that
    of the unknowns, the others lie evenly at random between the bounds (``seed``); the best counts.  The search ends
    where a step changes the sum of squares, or the parameters, by a share of less than ``enough``.  A ``rough`` model,
    which takes less time, serves for the slopes where there is one.
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
    runs = [
        least_squares(
            problem.weighted,
            start,
            sloped.slopes,
            bounds=(problem.low, problem.high),
            ftol=enough,
            xtol=enough,
            gtol=None,
        )
        for start in (first, *others)
    ]
    best = min(runs, key=lambda run: float(run.cost))
    return problem.told(best.x, np.asarray(best.jac))


@checked
def appraised(predicted: Prediction, measured: Sequence[Measured], unknowns: Sequence[Unknown]) -> Identified:
    """What the measurement tells of parameters where they are, at their start values, without looking for better ones.

    Its deviations and correlations say what a fit of them all would be worth.
    """
    problem = _problem(predicted, measured, unknowns)
    here = np.array([unknown.start for unknown in unknowns]) / problem.scale
    return problem.told(here, problem.slopes(here))
