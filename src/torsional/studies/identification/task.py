"""An identification as it is asked for, and the fits of its models."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.estimates import LEVEL, Identified, Measured, Unknown
from torsional.studies.identification.sources import Source, Use
from torsional.studies.identify import Errors, Prediction, appraised, identified, refined
from torsional.studies.loop_torques import ANGLE_OFFSET, TORQUE_OFFSET
from torsional.studies.rig import ROUGH

ZERO_NAMES = (TORQUE_OFFSET, ANGLE_OFFSET)
Told = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Candidate:
    """A model of the data: its ``base``, the ``unknowns`` by key path (and the sensors' zeros), and which other values
    keep their ``ratios`` to them."""

    name: str
    base: Model
    unknowns: tuple[Unknown, ...]
    ratios: Mapping[str, Mapping[str, float]]

    def made(self) -> Callable[[Mapping[str, float]], Model]:
        """Models made of values by key path, the latest few kept."""

        @lru_cache(maxsize=4)
        def model(values: tuple[tuple[str, float], ...]) -> Model:
            edits = {path: value for path, value in values if path not in ZERO_NAMES}
            for path, value in tuple(edits.items()):
                edits |= {other: ratio * value for other, ratio in self.ratios.get(path, {}).items()}
            return changed(self.base, edits)

        return lambda values: model(tuple(values.items()))


@dataclass(frozen=True, eq=False)
class Task:
    """An identification: what was measured (``sources``), models of it (``candidates``, the first the plan's own),
    points ``held`` back, random ``starts`` with their ``seed``, the ``level`` of intervals, points of ``profiles``."""

    name: str
    sources: tuple[Source, ...]
    candidates: tuple[Candidate, ...]
    held: frozenset[str] = frozenset()
    starts: int = 1
    seed: int = 0
    level: float = LEVEL
    profiles: int = 0

    @property
    def names(self) -> tuple[str, ...]:
        """The points, in the plan's order."""
        return tuple(point.name for source in self.sources for point in source.points)

    def parts(self, held: bool) -> tuple[Source, ...]:
        """The sources without what is held back, or that alone."""
        chosen = [name for name in self.names if (name in self.held) == held]
        mine = [(source, [p.name for p in source.points if p.name in chosen]) for source in self.sources]
        return tuple(source.only(names) for source, names in mine if names)


@dataclass(frozen=True, eq=False)
class Fit:
    """A candidate fitted: what was found, and the ``predictions`` of all points of the task, held ones included."""

    candidate: Candidate
    found: Identified
    predictions: tuple[Array, ...]
    held_misfit: float


def joined(sources: Sequence[Source], made: Callable[[Mapping[str, float]], Model], use: Use) -> Prediction:
    """What all sources would show, one after the other."""
    each = [source.predicted(made, use) for source in sources]
    return lambda values: [array for told in each for array in told(values)]


def joined_errors(sources: Sequence[Source], made: Callable[[Mapping[str, float]], Model]) -> Errors:
    """The errors of all sources' angles."""
    each = [source.errors(made) for source in sources]
    return lambda values: [array for told in each for array in told(values)]


def fitted(task: Task, candidate: Candidate) -> Fit:
    """One model fitted: roughly first, from there on finely, then all points predicted."""
    sources = task.parts(held=False)
    points = [point for source in sources for point in source.points]
    made = candidate.made()
    near = identified(
        joined(sources, made, "search"), points, candidate.unknowns, starts=task.starts, seed=task.seed, enough=ROUGH
    )
    left, slopes = joined(sources, made, "residuals"), joined(sources, made, "slopes")
    found = refined(left, points, near, errors=joined_errors(sources, made), rough=slopes)
    return _predicted(task, candidate, found)


def _predicted(task: Task, candidate: Candidate, found: Identified) -> Fit:
    told = joined(task.sources, candidate.made(), "residuals")(found.values)
    points = [point for source in task.sources for point in source.points]
    held = [
        (point.values - each) / point.noise for point, each in zip(points, told, strict=True) if point.name in task.held
    ]
    misfit = float(np.sqrt(np.mean(np.square(np.concatenate(held))))) if held else np.nan
    return Fit(candidate, found, tuple(told), misfit)


def fits_of(task: Task, moved: Callable[[int, int], None] | None = None) -> tuple[Fit, ...]:
    """All candidates fitted, one after the other; ``moved`` is told (done, all)."""
    fits = []
    for number, candidate in enumerate(task.candidates):
        try:
            fits.append(fitted(task, candidate))
        except ModelError as error:
            where = f"models.{candidate.name}" if number else ""
            raise error.located(prefix=where) from None
        if moved:
            moved(number + 1, len(task.candidates))
    return tuple(fits)


def profile(task: Task, fit: Fit, name: str, reach: float = 3.0) -> tuple[Array, Array]:
    """Values of a parameter about its estimate, ± ``reach`` standard deviations, and the sum of squares with all others
    fitted anew over that of the fit (D. Bates, D. Watts, Nonlinear Regression Analysis, 1988, ch. 6)."""
    place = [unknown.name for unknown in fit.found.unknowns].index(name)
    unknown, centre = fit.found.unknowns[place], float(fit.found.estimates[place])
    width = reach * float(fit.found.deviations[place])
    ends = max(unknown.low, centre - width), min(unknown.high, centre + width)
    values = np.linspace(*ends, task.profiles)
    return values, np.array([_held_at(task, fit, name, float(value)) for value in values])


def _held_at(task: Task, fit: Fit, name: str, value: float) -> float:
    """Sum of squares with a parameter held, all others fitted from where they were found, over that of the fit."""
    sources, made = task.parts(held=False), fit.candidate.made()
    points = [point for source in sources for point in source.points]
    own, slopes = joined(sources, made, "residuals"), joined(sources, made, "slopes")
    base = float(squares(points, own(fit.found.values)))
    others = [replace(u, start=fit.found.values[u.name]) for u in fit.found.unknowns if u.name != name]

    def held(told: Prediction) -> Prediction:
        return lambda values: told({u.name: values.get(u.name, value) for u in fit.found.unknowns})

    if not others:
        return float(squares(points, held(own)({}))) / base
    rough = held(slopes)
    return refined(held(own), points, appraised(rough, points, others), rough=rough).squares / base


def squares(points: Sequence[Measured], told: Sequence[Array]) -> float:
    """Sum of squares of weighted residuals over the noise."""
    pairs = zip(points, told, strict=True)
    return sum(float(np.square(p.weight * (p.values - each) / p.noise).sum()) for p, each in pairs)
