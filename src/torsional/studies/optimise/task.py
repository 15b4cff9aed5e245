"""What is to be optimised: designs, what is asked of them, objectives and limits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.files.scaling import read_document, values_at
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.compiling import WATCH
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.designs import Axis, Designs, sampled, table
from torsional.studies.sweeps.identity import plan_of
from torsional.studies.sweeps.work import Build, Run, Together, Work


@dataclass(frozen=True)
class Limit:
    """The ``least`` and the ``most`` that a criterion may be; raises ModelError where it is no limit.

    >>> Limit(most=2.5).beyond(np.array([2.0, 3.0])).tolist()
    [-0.2, 0.2]
    """

    least: float = -math.inf
    most: float = math.inf

    def __post_init__(self) -> None:
        if not (math.isfinite(self.least) or math.isfinite(self.most)) or self.least > self.most:
            raise ModelError("a limit is the least or the most", found=f"{self.least:g} to {self.most:g}")

    def beyond(self, values: Array) -> Array:
        """How far values lie beyond it, over its size; negative within."""
        low = (
            (self.least - values) / (abs(self.least) or 1.0)
            if math.isfinite(self.least)
            else np.full_like(values, -np.inf)
        )
        high = (
            (values - self.most) / (abs(self.most) or 1.0)
            if math.isfinite(self.most)
            else np.full_like(values, -np.inf)
        )
        return np.asarray(np.maximum(low, high))


@dataclass(frozen=True)
class Method:
    """How it is searched: designs of a ``population``, ``generations`` of them, the ``seed`` of all that is drawn."""

    population: int = 40
    generations: int = 30
    seed: int = 1

    def __post_init__(self) -> None:
        for name, least in (("population", 4), ("generations", 1), ("seed", 0)):
            if getattr(self, name) < least:
                told = {"found": str(getattr(self, name)), "allowed": f"{least} and more"}
                raise ModelError("the search cannot be", where=f"method.{name}", **told)


@dataclass(frozen=True)
class Task:
    """Designs between the ends of ``axes``, made by ``build`` and asked by ``run``; of their criteria the
    ``objectives`` are to be as small as can be (those ``maximised`` as large), within ``limits``.

    ``nominal``: the design that all are compared with, by parameter; None: that of the model's own file.  Raises
    ModelError without objectives, and for names twice.
    """

    build: Build
    axes: Mapping[str, Axis]
    run: Run
    objectives: tuple[str, ...]
    limits: Mapping[str, Limit] = field(default_factory=dict)
    maximised: frozenset[str] = frozenset()
    nominal: Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        if not self.objectives or len(set(self.objectives)) < len(self.objectives):
            found = ", ".join(self.objectives) or "none"
            raise ModelError("an optimisation needs objectives, each once", where="objectives", found=found)
        if not self.axes:
            raise ModelError("an optimisation needs a parameter to vary", where="over")

    @property
    def wanted(self) -> tuple[str, ...]:
        """The criteria that are asked for: objectives and limited ones."""
        return tuple(dict.fromkeys((*self.objectives, *self.limits)))

    def sign(self, name: str) -> float:
        """-1 where a criterion is to be as large as can be, else 1."""
        return -1.0 if name in self.maximised else 1.0

    def refuse_unknown(self, known: Mapping[str, Any]) -> None:
        """ModelError for an objective or a limit that no criterion has."""
        for where, names in (("objectives", self.objectives), ("constraints", self.limits)):
            for name in names:
                if name not in known:
                    told = {"found": repr(name), "remedy": nearest(name, known)}
                    raise ModelError("there is no such criterion", where=where, **told)

    def plan(self) -> dict[str, Any]:
        """What the optimisation is, as plain values."""
        one = plan_of(Work(self.build, self.work([[0.5] * len(self.axes)]).designs, self.run))
        axes = {name: list(axis.levels) or [axis.low, axis.high, axis.log] for name, axis in self.axes.items()}
        limits = {name: [repr(limit.least), repr(limit.most)] for name, limit in self.limits.items()}
        told = {"objectives": list(self.objectives), "maximised": sorted(self.maximised), "limits": limits}
        return {"build": one["build"], "run": one["run"], "axes": axes, "nominal": self.nominal_values, **told}

    def columns(self, shares: Any) -> dict[str, list[Any]]:
        """Values by parameter of designs at shares (designs, parameters) of the axes."""
        every = np.asarray(shares, dtype=float)
        return {name: list(axis.at(every[:, i])) for i, (name, axis) in enumerate(self.axes.items())}

    def shares(self, columns: Mapping[str, Any]) -> Array:
        """The shares of the axes of designs by their values."""
        told = [[share_of(axis, value) for value in columns[name]] for name, axis in self.axes.items()]
        return np.array(told, dtype=float).T

    def work(self, shares: Any) -> Work:
        """The work on designs at shares (designs, parameters)."""
        return self.work_on(table(self.columns(shares)))

    def work_on(self, designs: Designs, batch: Batch | None = None) -> Work:
        """The work on some designs, asked together with all those of a ``batch``."""
        return Work(self.build, designs, self.run, batch)

    def batch(self) -> Batch | None:
        """All designs that there may be, where the analysis can ask them together."""
        if not (isinstance(self.build, Model) and isinstance(self.run, Together)):
            return None
        found = Batch.of(self.build, sampled("sobol", self.axes, 64))
        with WATCH.silent():
            return found if found is not None and self.run.possible(found) else None

    @cached_property
    def nominal_values(self) -> dict[str, Any] | None:
        """The nominal design by parameter; what the file leaves out is None, so that its default holds."""
        if self.nominal is not None:
            return dict(self.nominal)
        if not isinstance(self.build, Model) or not self.build.document:
            return None
        file = read_document(self.build.document)
        return {path: next(iter(values_at(file, path).values()), None) for path in self.axes}

    @property
    def nominal_share(self) -> Array | None:
        """Where the nominal design lies on the axes; None where it does not lie between their ends."""
        values = self.nominal_values
        if values is None:
            return None
        shares = [share_of(axis, values[name]) for name, axis in self.axes.items()]
        inside = all(share is not None and 0 <= share <= 1 for share in shares)
        return np.array(shares, dtype=float) if inside else None


def share_of(axis: Axis, value: Any) -> float | None:
    """Where a value lies on an axis, 0 to 1; None for one that does not.

    >>> share_of(Axis(low=1.0, high=100.0, log=True), 10.0), share_of(Axis((1, 2)), 2), share_of(Axis((1, 2)), 3)
    (0.5, 0.75, None)
    """
    if axis.levels:
        return (axis.levels.index(value) + 0.5) / len(axis.levels) if value in axis.levels else None
    if not isinstance(value, int | float) or (axis.log and value <= 0):
        return None
    if axis.log:
        return math.log(value / axis.low) / math.log(axis.high / axis.low)
    return (value - axis.low) / (axis.high - axis.low)
