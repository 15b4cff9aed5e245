"""The nonlinear program of a refinement, as SLSQP takes it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from torsional.numerics.arrays import Array
from torsional.studies.optimise.task import Limit

if TYPE_CHECKING:
    from torsional.studies.optimise.refine import Refinement

SPARE = 1e-5
"""How far within its limits a refined design shall be, over their size, so that rounding puts none beyond."""


@dataclass
class Program:
    """The nonlinear program of a refinement: variables are free shares, and a t for each exact objective."""

    refinement: Refinement
    start: Array
    own: Any
    exact: list[str]

    def __post_init__(self) -> None:
        values, _ = self.refinement.at(self.start)
        self.sizes = {name: float(values[name][0].max()) for name in self.exact}
        told = self.refinement.at(self.start)[1]
        weights, task = self.refinement.weights, self.refinement.task
        sizes = [w * self.sizes[name] if name in self.sizes else w * abs(told[name][0]) for name, w in weights.items()]
        self.scale, self.task = sum(sizes) or 1.0, task

    def shares(self, x: Array) -> Array:
        """The whole design of some variables."""
        whole = self.start.copy()
        whole[self.own] = np.clip(x[: len(self.own)], 0.0, 1.0)
        return whole

    def goal(self, x: Array) -> tuple[float, Array]:
        """The aim over its size at the start, and its gradient."""
        _, told = self.refinement.at(self.shares(x))
        goal, slope, count = 0.0, np.zeros(x.size), len(self.own)
        for name, weight in self.refinement.weights.items():
            if name in self.exact:
                place, size = count + self.exact.index(name), self.sizes[name]
                goal, slope[place] = goal + weight * size * x[place], weight * size
            else:
                goal += weight * self.task.sign(name) * told[name][0]
                slope[:count] += weight * self.task.sign(name) * told[name][1]
        return goal / self.scale, slope / self.scale

    def margin(self, x: Array) -> Array:
        """What must not be negative."""
        return np.concatenate([values for values, _ in self._margins(x)])

    def margin_slopes(self, x: Array) -> Array:
        """Its derivatives."""
        return np.concatenate([slopes for _, slopes in self._margins(x)])

    def _margins(self, x: Array) -> Iterator[tuple[Array, Array]]:
        values, told = self.refinement.at(self.shares(x))
        count = len(self.own)
        for place, name in enumerate(self.exact, count):
            found, slopes = (each / self.sizes[name] for each in values[name])
            rows = np.zeros((found.size, x.size))
            rows[:, :count], rows[:, place] = -slopes, 1.0
            yield x[place] - found, rows
        for name, limit in self.task.limits.items():
            one = values[name] if name in values else (np.array([told[name][0]]), told[name][1][None])
            yield from _within(limit, one, x.size)


def _within(limit: Limit, found: tuple[Array, Array], size: int) -> Iterator[tuple[Array, Array]]:
    for end, sign in ((limit.most, 1.0), (limit.least, -1.0)):
        if np.isfinite(end):
            rows = np.zeros((found[0].size, size))
            rows[:, : found[1].shape[1]] = -sign * found[1] / (abs(end) or 1.0)
            yield sign * (end - found[0]) / (abs(end) or 1.0) - SPARE, rows
