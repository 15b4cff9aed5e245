"""What is looked for, what was measured, and what was found of it: the values of an identification.

Residuals are told over the noise, so that a model that explains all but the noise has a misfit of 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from torsional import checks
from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.telling import Way, ways
from torsional.units import QUANTITIES

NEAR = 1e-3
"""Nearness to a bound, over the way between both."""
CONFUSED = 0.9
"""Correlation from which on two parameters are hardly told apart."""
ROUNDING = 1e-10
"""Share of the largest singular value of slopes below which differences tell nothing but their rounding."""
FREE = 1e-6
"""Share of a parameter in a combination that the data tell nothing of, from which on they tell nothing of it."""
LEVEL = 0.95
"""Confidence of intervals unless told otherwise."""


@dataclass(frozen=True)
@checked_fields
class Unknown:
    """A parameter that is looked for: its ``name``, the ``quantity`` of the nomenclature that it is, where the search
    begins and between which bounds it stays, in SI.

    ``scale``: what counts as much of it (default: the start value, which then must not be zero).  Raises ModelError
    for bounds that do not hold the start.

    >>> Unknown("grease_damping", "damping", 0.1, 0.0, 2.0).scale
    0.1
    """

    name: str
    quantity: str
    start: float
    low: float
    high: float
    scale: float = 0.0

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES:
            raise ModelError("there is no such quantity", where=self.name, found=self.quantity)
        values = [checks.number(value, self.name) for value in (self.start, self.low, self.high, self.scale)]
        if not (all(map(math.isfinite, values)) and self.low <= self.start <= self.high and self.low < self.high):
            found, allowed = f"{self.start:g} between {self.low:g} and {self.high:g}", "low ≤ start ≤ high"
            raise ModelError("the bounds do not hold the start", where=self.name, found=found, allowed=allowed)
        if self.scale == 0.0:
            object.__setattr__(self, "scale", abs(self.start))
        if self.scale <= 0.0:
            remedy = "give scale, a value that counts as much of it"
            raise ModelError("a start of zero tells no scale", where=self.name, remedy=remedy)


@dataclass(frozen=True, eq=False)
class Measured:
    """What was measured at one operating point: ``values`` (samples,), the standard deviation of their ``noise`` in
    their unit, and the ``weight`` that the point has among others.

    Raises ModelError for fewer than two values, for values that are not finite, and for no noise.
    """

    name: str
    values: Array
    noise: float
    weight: float = 1.0

    def __post_init__(self) -> None:
        if self.values.ndim != 1 or self.values.size < 2:
            found, allowed = f"{self.values.size}", "at least 2 in a row"
            raise ModelError("too few values were measured", where=self.name, found=found, allowed=allowed)
        bad = int(np.count_nonzero(~np.isfinite(self.values)))
        if bad:
            raise ModelError("measured values must be finite", where=self.name, found=f"{bad} that are not")
        if not (0.0 < self.noise < math.inf and 0.0 < self.weight < math.inf):
            found = f"noise {self.noise:g}, weight {self.weight:g}"
            raise ModelError("noise and weight must be positive", where=self.name, found=found)


@dataclass(frozen=True, eq=False)
class Identified:
    """Parameters that were found, and what they are worth.

    ``estimates`` (parameters,) of the ``unknowns``; ``residuals``: measured less predicted over the noise, an array
    for each operating point in ``points``; ``slopes`` (samples, parameters): how the weighted residuals of all points
    change with the parameters over their scales; ``evaluations`` of the model.  ``inputs`` (samples, errors) of each
    point: how they change by one standard deviation of each error in what the model was given, as a measured angle;
    empty where that is exact.
    """

    unknowns: tuple[Unknown, ...]
    estimates: Array
    points: tuple[str, ...]
    residuals: tuple[Array, ...]
    weights: tuple[float, ...]
    slopes: Array
    evaluations: int
    inputs: tuple[Array, ...] = ()

    @property
    def values(self) -> dict[str, float]:
        """Estimates by name."""
        return {unknown.name: float(value) for unknown, value in zip(self.unknowns, self.estimates, strict=True)}

    @property
    def misfits(self) -> Array:
        """RMS of the residuals over the noise, of each point."""
        return np.array([float(np.sqrt(np.mean(np.square(each)))) for each in self.residuals])

    @property
    def misfit(self) -> float:
        """RMS of all residuals over the noise: 1 where the model explains all but noise."""
        return float(np.sqrt(np.mean(np.square(np.concatenate(self.residuals)))))

    @property
    def samples(self) -> int:
        """How many values were measured."""
        return sum(each.size for each in self.residuals)

    @property
    def squares(self) -> float:
        """Sum of the squares of the weighted residuals over the noise."""
        return sum(float(np.square(w * r).sum()) for w, r in zip(self.weights, self.residuals, strict=True))

    @property
    def freedom(self) -> int:
        """Degrees of freedom: values less parameters."""
        return max(self.samples - len(self.unknowns), 1)

    @cached_property
    def covariance(self) -> Array:
        """s² (JᵀJ)⁻¹ + (J⁺S)(J⁺S)ᵀ of the estimates in SI, J the slopes, s² what residuals leave a degree of freedom,
        S what errors of the ``inputs`` do to the residuals.

        Infinite for parameters in combinations of which the data tell nothing (G. Seber, C. Wild, Nonlinear
        Regression, 1989, ch. 2; errors of what a model is given: W. Fuller, Measurement Error Models, 1987, ch. 3).
        """
        scale = np.array([unknown.scale for unknown in self.unknowns])
        strength, right, moved = self._principal
        told = strength > 0.0
        each = (right[told] / strength[told, None]).T * scale[:, None]
        through = each @ moved[told]
        found = self.squares / self.freedom * each @ each.T + through @ through.T
        free = np.abs(right[~told]).max(axis=0, initial=0.0) > FREE  # they move together, held by nothing
        return np.where(free[:, None] | free, np.inf, found)

    @cached_property
    def _principal(self) -> tuple[Array, Array, Array]:
        """Singular values of the slopes (zero where they are rounding alone), the combinations of parameters in rows,
        and what errors of the inputs are along them."""
        left, strength, right = np.linalg.svd(self.slopes, full_matrices=False)
        strength[strength <= strength[0] * ROUNDING] = 0.0
        ends = np.cumsum([each.size for each in self.residuals])[:-1]
        parts = zip(np.split(left, ends), self.inputs, strict=True) if self.inputs else ()
        moved = [np.zeros((strength.size, 1)), *(own.T @ errors for own, errors in parts)]
        return strength, right, np.hstack(moved)

    @property
    def deviations(self) -> Array:
        """Standard deviations of the estimates in SI: noise alone, as far as the model is linear in them."""
        return np.sqrt(np.diag(self.covariance))

    def intervals(self, level: float = LEVEL) -> Array:
        """Intervals (parameters, low and high) that hold the truth in a share ``level`` of all measurements alike.

        Estimates ± t · their deviations, t the quantile of Student's distribution at the degrees of freedom; bounds of
        the search count for nothing here.
        """
        from scipy.special import stdtrit

        reach = float(stdtrit(self.freedom, 0.5 * (1.0 + level))) * self.deviations
        return np.column_stack([self.estimates - reach, self.estimates + reach])

    @property
    def ways(self) -> tuple[Way, ...]:
        """Combinations of the parameters over their scales that the data tell one by one, the least known first."""
        strength, right, moved = self._principal
        noise = np.sqrt(self.squares / self.freedom + np.square(moved).sum(axis=1))
        deviation = np.divide(noise, strength, out=np.full(strength.size, np.inf), where=strength > 0.0)
        return ways(right, deviation, tuple(unknown.name for unknown in self.unknowns))

    @property
    def aicc(self) -> float:
        """Akaike's criterion corrected for few values, n ln(S/n) + 2k + 2k(k + 1)/(n − k − 1): of several models of the
        same data the one with the least explains best (K. Burnham, D. Anderson, Model Selection, 2002, § 2.4)."""
        n, k = self.samples, len(self.unknowns) + 1  # the noise is a parameter too
        return n * math.log(self.squares / n) + 2 * k + 2 * k * (k + 1) / max(n - k - 1, 1)

    @property
    def bic(self) -> float:
        """Schwarz's criterion n ln(S/n) + k ln n, harder on parameters (G. Schwarz, Ann. Statist. 6 (1978) 461)."""
        n, k = self.samples, len(self.unknowns) + 1
        return n * math.log(self.squares / n) + k * math.log(n)

    @property
    def correlation(self) -> Array:
        """Correlations (parameters, parameters) of the estimates; near ±1 the data hardly tell the two apart."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.covariance / np.outer(self.deviations, self.deviations))

    def confused(self, limit: float = CONFUSED) -> list[tuple[str, str, float]]:
        """Pairs of parameters whose correlation is ``limit`` and more either way, the closest first."""
        names, found = [unknown.name for unknown in self.unknowns], self.correlation
        pairs = [(a, names[j], float(found[i, j])) for i, a in enumerate(names) for j in range(i)]
        return sorted((pair for pair in pairs if abs(pair[2]) >= limit), key=lambda pair: -abs(pair[2]))

    def at_bounds(self) -> list[str]:
        """Names of the parameters that ran into a bound: the data ask for more, or tell nothing of them."""
        near = [NEAR * (unknown.high - unknown.low) for unknown in self.unknowns]
        return [
            unknown.name
            for unknown, value, close in zip(self.unknowns, self.estimates, near, strict=True)
            if min(value - unknown.low, unknown.high - value) < close
        ]

    def dataset(self) -> xr.Dataset:
        """Estimates, standard deviations and correlations over ``parameter``, misfits over ``point``.

        Values of parameters are in the SI units that the coordinate ``unit`` tells.
        """
        names = np.array([unknown.name for unknown in self.unknowns])
        pair = ("parameter", "other")
        return labelled(
            {
                "estimate": (("parameter",), self.estimates, ""),
                "deviation": (("parameter",), self.deviations, ""),
                "correlation": (pair, self.correlation, "number"),
                "misfit": (("point",), self.misfits, "ratio"),
            },
            {
                "parameter": (names, ""),
                "other": (names, ""),
                "unit": (np.array([QUANTITIES[unknown.quantity].unit for unknown in self.unknowns]), "", "parameter"),
                "point": (np.array(self.points), ""),
            },
            analysis="identification",
            evaluations=self.evaluations,
        )
