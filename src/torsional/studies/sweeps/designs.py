"""The designs of a sweep: values of named parameters, any stretch of them at once and always the same ones.

A design is a number; its values follow from the plan and that number alone, so that pieces of a sweep may be worked
out in any order, on any machine, and again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from scipy.stats import qmc

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.studies.sweeps.blocks import BLOCKS, LEAST, WORDS, block_size, drawn, salib

Values: TypeAlias = Mapping[str, Any]
"""Values of one design by parameter."""
METHODS = ("grid", "latin_hypercube", "sobol", "morris", "saltelli", "table")
MOST = 100_000_000
"""Designs that one plan may have."""


@dataclass(frozen=True)
class Axis:
    """What one parameter may be: one of some ``levels``, or any number from ``low`` to ``high``, evenly or by ``log``.

    Raises ModelError for an axis without values, and for ends that do not rise or, by logarithm, are not positive.

    >>> Axis(low=1.0, high=100.0, log=True).at(np.array([0.0, 0.5, 1.0])).round(9).tolist()
    [1.0, 10.0, 100.0]
    >>> Axis(("soft", "stiff")).at(np.array([0.2, 0.9]))
    ['soft', 'stiff']
    """

    levels: tuple[Any, ...] = ()
    low: float = math.nan
    high: float = math.nan
    log: bool = False

    def __post_init__(self) -> None:
        if self.levels:
            return
        if not (math.isfinite(self.low) and math.isfinite(self.high)):
            raise ModelError("a parameter needs levels, or two ends", found=f"{self.low} to {self.high}")
        if not self.low < self.high:
            raise ModelError("the ends of a parameter must rise", found=f"{self.low:g} to {self.high:g}")
        if self.log and self.low <= 0:
            raise ModelError("by logarithm both ends must be positive", found=f"{self.low:g} to {self.high:g}")

    def at(self, share: Array) -> Any:
        """Values at shares from 0 to 1 of the axis: an array (n,), or a list where they are levels."""
        if self.levels:
            places = np.minimum((share * len(self.levels)).astype(int), len(self.levels) - 1)
            return [self.levels[place] for place in places]
        if self.log:
            return np.exp(np.log(self.low) + share * np.log(self.high / self.low))
        return self.low + share * (self.high - self.low)


@dataclass(frozen=True)
class Designs:
    """Designs 0 to ``count`` − 1 over named axes; grids have the last parameter fastest.

    ``method``: one of `METHODS`; ``seed``: of what is drawn, or of the scrambling of Sobol's points.  Raises ModelError
    for an unknown method, a grid over an axis without levels, columns of a table that differ in length, more designs
    than 1e8; of designs in blocks for too few or broken ones, and where SALib is missing.

    >>> grid({"stiffness": [1e4, 2e4], "damping": [5.0, 10.0, 20.0]}).rows(2, 4)
    [{'stiffness': 10000.0, 'damping': 20.0}, {'stiffness': 20000.0, 'damping': 5.0}]
    """

    axes: Mapping[str, Axis]
    count: int
    method: str = "grid"
    seed: int = 0

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise ModelError("there is no such way to choose designs", found=self.method, allowed=", ".join(METHODS))
        if not self.axes:
            raise ModelError("a sweep needs a parameter to vary", where="over")
        if not 1 <= self.count <= MOST:
            raise ModelError("the number of designs is out of range", found=str(self.count), allowed=f"1 to {MOST:.0g}")
        plain = [name for name, axis in self.axes.items() if not axis.levels]
        if plain and self.method in ("grid", "table"):
            raise ModelError(f"a {self.method} needs levels", where=plain[0], remedy="list them, or give their count")
        if self.method in BLOCKS:
            self._refuse_few()

    def _refuse_few(self) -> None:
        """Too few blocks for a sensitivity, and a library that is missing, are told before any work."""
        salib("util")
        blocks, rest = divmod(self.count, self.block)
        if rest or blocks < LEAST[self.method]:
            what, least = WORDS[self.method], LEAST[self.method]
            problem = f"sensitivities need more {what}" if not rest else f"{what} have {self.block} designs each"
            found = f"{blocks}" if not rest else f"{self.count} designs"
            raise ModelError(problem, where="designs.count", found=found, allowed=f">= {least} {what}")

    @property
    def block(self) -> int:
        """How many designs belong together, see `drawn`: 1 where each stands alone."""
        return block_size(self.method, len(self.axes))

    @property
    def told(self) -> dict[str, Any]:
        """How the designs were chosen: method, seed and the parameters in their order."""
        return {"method": self.method, "seed": self.seed, "parameters": list(self.axes)}

    def __len__(self) -> int:
        return self.count

    def columns(self, start: int, stop: int) -> dict[str, Any]:
        """Values of designs ``start`` to ``stop`` − 1 by parameter: arrays, or lists where an axis has levels."""
        if self.method == "grid":
            shape = [len(axis.levels) for axis in self.axes.values()]
            places = np.unravel_index(np.arange(start, stop), shape)
        elif self.method == "table":
            places = (np.arange(start, stop),) * len(self.axes)
        else:
            shares = self._shares(start, stop)
            return {name: axis.at(share) for (name, axis), share in zip(self.axes.items(), shares.T, strict=True)}
        each = zip(self.axes.items(), places, strict=True)
        return {name: [axis.levels[place] for place in at] for (name, axis), at in each}

    def rows(self, start: int, stop: int) -> list[Values]:
        """The same design by design."""
        columns = {name: list(values) for name, values in self.columns(start, stop).items()}
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    def _shares(self, start: int, stop: int) -> Array:
        if self.method == "latin_hypercube":
            return self._hypercube[start:stop]
        if self.method in BLOCKS:
            return self._blocks[start:stop]
        points = qmc.Sobol(len(self.axes), scramble=True, seed=self.seed)
        first = points.random(1)  # alone: scipy warns of a first stretch that is no power of two
        if start == 0:
            return np.concatenate([first, points.random(stop - 1)])
        if start > 1:
            points.fast_forward(start - 1)
        return np.asarray(points.random(stop - start))

    @cached_property
    def _hypercube(self) -> Array:
        return hypercube(self.count, len(self.axes), self.seed)

    @cached_property
    def _blocks(self) -> Array:
        return drawn(self.method, self.count // self.block, len(self.axes), self.seed)


def hypercube(count: int, parameters: int, seed: int) -> Array:
    """Points (count, parameters) of a Latin hypercube of side 1: one in each slice of every parameter.

    >>> np.sort(hypercube(4, 2, seed=1), axis=0).astype(float).__floordiv__(0.25).T.tolist()
    [[0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0]]
    """
    return np.asarray(qmc.LatinHypercube(parameters, seed=seed).random(count))


def grid(levels: Mapping[str, Sequence[Any]]) -> Designs:
    """All combinations of levels, the last parameter fastest."""
    axes = {name: _levels(name, values) for name, values in levels.items()}
    return Designs(axes, math.prod(len(axis.levels) for axis in axes.values()))


def table(columns: Mapping[str, Sequence[Any]]) -> Designs:
    """Designs row by row."""
    axes = {name: _levels(name, values) for name, values in columns.items()}
    lengths = {name: len(axis.levels) for name, axis in axes.items()}
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ModelError("the columns of a table of designs differ in length", found=told)
    return Designs(axes, min(lengths.values(), default=0), "table")


def sampled(method: str, ends: Mapping[str, Any], count: int, seed: int = 0) -> Designs:
    """``count`` designs of a "latin_hypercube" or of "sobol" points; ends (low, high), or an `Axis`, by parameter.

    By "morris" ``count`` is the number of trajectories, each of one design more than there are parameters, and by
    "saltelli" that of base points, each of two more: what `sensitivities` asks for.

    >>> len(sampled("sobol", {"inertia": (0.5, 2.0), "clutch": Axis(("soft", "stiff"))}, 8))
    8
    """
    axes = {name: end if isinstance(end, Axis) else _ends(name, end) for name, end in ends.items()}
    return Designs(axes, count * block_size(method, len(axes)), method, seed)


def _levels(name: str, values: Sequence[Any]) -> Axis:
    listed = tuple(value.item() if isinstance(value, np.generic) else value for value in values)
    if not listed:
        raise ModelError("a parameter has no values", where=name)
    return Axis(listed)


def _ends(name: str, ends: Sequence[float]) -> Axis:
    if len(ends) != 2:
        raise ModelError("two ends are wanted", where=name, found=str(tuple(ends)))
    try:
        return Axis(low=float(ends[0]), high=float(ends[1]))
    except ModelError as error:
        raise ModelError(error.problem, where=name, found=error.found) from None
