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
from torsional.units import QUANTITIES

NEAR = 1e-3
"""Nearness to a bound, over the way between both."""
CONFUSED = 0.9
"""Correlation from which on two parameters are hardly told apart."""


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
    change with the parameters over their scales; ``evaluations`` of the model.
    """

    unknowns: tuple[Unknown, ...]
    estimates: Array
    points: tuple[str, ...]
    residuals: tuple[Array, ...]
    weights: tuple[float, ...]
    slopes: Array
    evaluations: int

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

    @cached_property
    def covariance(self) -> Array:
        """s² (JᵀJ)⁻¹ of the estimates in SI, J the slopes and s² what residuals leave a degree of freedom.

        Infinite where the data tell nothing of some combination of parameters (G. Seber, C. Wild, Nonlinear
        Regression, 1989, ch. 2).
        """
        scale = np.array([unknown.scale for unknown in self.unknowns])
        _, strength, ways = np.linalg.svd(self.slopes, full_matrices=False)
        if strength[-1] <= strength[0] * self.slopes.shape[0] * np.finfo(float).eps:
            return np.full((scale.size, scale.size), np.inf)
        left = np.concatenate([w * r for w, r in zip(self.weights, self.residuals, strict=True)])
        spread = float(left @ left) / max(left.size - scale.size, 1)
        each = (ways / strength[:, None]) * scale
        return np.asarray(spread * each.T @ each)

    @property
    def deviations(self) -> Array:
        """Standard deviations of the estimates in SI: noise alone, as far as the model is linear in them."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def correlation(self) -> Array:
        """Correlations (parameters, parameters) of the estimates; near ±1 the data hardly tell the two apart."""
        if not np.isfinite(self.covariance).all():
            return np.full(self.covariance.shape, np.nan)
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
