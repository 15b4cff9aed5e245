"""Designs made better by exact gradients: the worst of the linear response, within the limits, by SLSQP.

A largest value is no smooth function of the design, its values at single operating points are: t is made small under
t ≥ a_i for the points that matter, and points that come to matter are added.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import minimize

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.optimise.gradients import Around, Points, points_of
from torsional.studies.optimise.lines import Built, Design, Numbered, Numbers
from torsional.studies.optimise.program import Program
from torsional.studies.optimise.task import Task
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.criteria import CriteriaRun

SIDE = 1e-4
"""Half the difference of a parameter between two models, over its value."""
NEAR, GEARS = 0.95, 2
"""Points that matter: all speeds, at the worst load, of so many gears whose largest is at least so much of all."""
ROUNDS, ITERATIONS = 6, 5
REACH = 0.25
"""How far shares of the axes may go in one round, after which it is looked anew which points matter."""
BEYOND = 1e30
"""More than any sum of objectives."""
ENOUGH = 1e-3
"""A round that makes the aim smaller by less, over itself, is the last."""


@dataclass
class Active:
    """The operating points of one criterion, all of them and those that matter."""

    every: list[Points]
    places: list[set[int]]

    @classmethod
    def of(cls, every: list[Points]) -> Active:
        """None of them matters yet."""
        return cls(every, [set() for _ in every])

    def look(self, around: Around) -> None:
        """Add the points that matter at a design."""
        values = [around.values(points)[0] for points in self.every]
        largest = max(float(each.max()) for each in values)
        for places, points, each in zip(self.places, self.every, values, strict=True):
            worst = _worst_loads(points, each)
            gears = np.array(points.gear)[worst]
            size = {gear: float(each[worst[gears == gear]].max()) for gear in dict.fromkeys(gears.tolist())}
            near = sorted((gear for gear in size if size[gear] >= NEAR * largest), key=lambda gear: -size[gear])
            places |= set(worst[np.isin(gears, near[:GEARS])].tolist())

    def values(self, around: Around) -> tuple[Array, Array]:
        """Figures at the points that matter, and their derivatives."""
        chosen = [points.some(np.array(sorted(p))) for p, points in zip(self.places, self.every, strict=True) if p]
        found = [around.values(points) for points in chosen]
        return np.concatenate([each[0] for each in found]), np.concatenate([each[1] for each in found])


def _worst_loads(points: Points, values: Array) -> Array:
    """Of every gear and speed the place of the largest value."""
    best: dict[tuple[str, float], int] = {}
    for place, key in enumerate(zip(points.gear, points.speed.tolist(), strict=True)):
        if key not in best or values[place] > values[best[key]]:
            best[key] = place
    return np.array(list(best.values()))


@dataclass
class Refinement:
    """A design of a ``task`` to be made better: the sum of its objectives times ``weights`` smaller, limits kept.

    ``batch``: of all designs that there may be, where they can be asked together, which is quicker.
    """

    task: Task
    weights: Mapping[str, float]
    batch: Batch | None = None
    active: dict[str, Active] = field(default_factory=dict)
    _known: dict[bytes, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        task = self.task
        if not isinstance(task.build, Model) or not isinstance(task.run, CriteriaRun):
            raise ModelError("gradients are taken of models of files and of criteria of a plan", where="refine")
        if any(path.partition(".")[0] in ("engine", "operation") for path in task.axes):
            raise ModelError("the engine's torques are held while designs are refined", where="refine")
        for name in (*self.weights, *task.limits):
            limit = task.limits.get(name)
            if name in task.maximised or (limit is not None and np.isfinite(limit.least)):
                continue
            if points := points_of(task.run, name, task.build):
                self.active[name] = Active.of(points)
        if not self.active.keys() & self.weights.keys():
            raise ModelError("no objective is a largest value of one order of a linear analysis", where="refine")

    def refined(self, start: Array) -> Array:
        """Shares of the axes that are no worse than those of ``start``, or not as far beyond limits."""
        best = found = start
        least, reach = self._aim(start), REACH
        for _ in range(ROUNDS):
            for each in self.active.values():
                each.look(self.alone(found))
            self._known.clear()
            found = self._solved(best, reach)
            aim = self._aim(found)
            gained = least - aim
            if gained > 0:
                best, least = found, aim
            if abs(gained) <= ENOUGH * abs(least):
                break
            reach *= 0.5 if gained < 0 else 1.0
        return best

    def _aim(self, shares: Array) -> float:
        """The weighted objectives of a design as they are; beyond limits more than any, the more the farther; infinite
        without an answer."""
        try:
            found = self._asked(self.task.wanted, [self._values(shares)])[0]
        except ModelError:
            return float("inf")
        over = sum(max(0.0, float(limit.beyond(np.array(found[n])))) for n, limit in self.task.limits.items())
        told = [w * self.task.sign(name) * found[name] for name, w in self.weights.items()]
        if not np.isfinite([over, *told]).all():
            return float("inf")
        return BEYOND * (1.0 + over) if over > 0 else float(sum(told))

    def within(self, shares: Array) -> bool:
        """Whether a design has an answer that keeps all limits."""
        return self._aim(shares) < BEYOND

    def goals(self, shares: Array) -> Array:
        """The objectives of the task, to be made small, of a design."""
        found = self._asked(self.task.objectives, [self._values(shares)])[0]
        return np.array([self.task.sign(name) * found[name] for name in self.task.objectives])

    def _asked(self, names: Iterable[str], designs: Sequence[Mapping[str, Any]]) -> list[dict[str, float]]:
        """Some of the criteria of some designs."""
        run, listed = self.run_of(names), list(names)
        columns = {name: [design[name] for design in designs] for name in self.task.axes}
        if self.batch is not None and run.covers(self.batch, columns).all():
            found = run.many(self.batch, columns)
            return [{name: float(found[name][place]) for name in listed} for place in range(len(designs))]
        assert isinstance(self.task.build, Model)
        answers = [run(changed(self.task.build, design)) for design in designs]
        return [{name: float(each[name]) for name in listed} for each in answers]

    def run_of(self, names: Any) -> CriteriaRun:
        """The question for some of the criteria alone."""
        assert isinstance(self.task.run, CriteriaRun)
        return self.task.run.of(names)

    def _values(self, shares: Array) -> dict[str, Any]:
        return {name: values[0] for name, values in self.task.columns(shares[None]).items()}

    @cached_property
    def free(self) -> list[tuple[int, str]]:
        """The parameters that are numbers between two ends: place and name."""
        return [(i, name) for i, (name, axis) in enumerate(self.task.axes.items()) if not axis.levels]

    @property
    def others(self) -> list[str]:
        """Objectives and limits whose derivatives are differences."""
        return [name for name in dict.fromkeys((*self.weights, *self.task.limits)) if name not in self.active]

    def at(self, shares: Array) -> tuple[dict[str, tuple[Array, Array]], dict[str, tuple[float, Array]]]:
        """Figures with their derivatives by the shares: at the points that matter, and of all other criteria."""
        key = shares.tobytes()
        if key not in self._known:
            around, scale = self.around(shares), self._scale(shares)
            exact = {name: each.values(around) for name, each in self.active.items()}
            told = {name: (values, slopes * scale) for name, (values, slopes) in exact.items()}
            self._known = {key: (told, self._differences(shares, scale))}
        return self._known[key]  # type: ignore[no-any-return]

    def alone(self, shares: Array) -> Around:
        """A design without those about it."""
        assert isinstance(self.task.build, Model)
        return Around(self.task.build, self._designs([self._values(shares)])[0], {})

    def around(self, shares: Array) -> Around:
        """A design and those about it, two a parameter."""
        assert isinstance(self.task.build, Model)
        values, steps = self._about(shares)
        centre, *sides = self._designs(values)
        pairs = zip(self.free, sides[::2], sides[1::2], steps, strict=True)
        return Around(self.task.build, centre, {name: (low, high, step) for (_, name), low, high, step in pairs})

    def _about(self, shares: Array) -> tuple[list[dict[str, Any]], list[float]]:
        """The values of a design and of two designs about it for each parameter, and how far these are apart."""
        values = self._values(shares)
        found, steps = [values], []
        for _, name in self.free:
            axis = self.task.axes[name]
            side = SIDE * abs(float(values[name])) or SIDE * (axis.high - axis.low)
            ends = [max(axis.low, float(values[name]) - side), min(axis.high, float(values[name]) + side)]
            found += [{**values, name: end} for end in ends]
            steps.append(ends[1] - ends[0])
        return found, steps

    def _designs(self, values: Sequence[dict[str, Any]]) -> list[Design]:
        """Designs by their values: through the numbers of a batch, or built."""
        assert isinstance(self.task.build, Model)
        columns = {name: np.array([float(each[name]) for each in values]) for _, name in self.free}
        batch = self.batch if len(self.free) == len(self.task.axes) else None
        if batch is not None and self.run_of(self.task.wanted).covers(batch, columns).all():
            numbers = Numbers(batch, columns)
            return [Numbered(numbers, place) for place in range(len(values))]
        return [Built(changed(self.task.build, each)) for each in values]

    def _scale(self, shares: Array) -> Array:
        """How a value changes with its share."""
        values = self._values(shares)
        rates = []
        for _, name in self.free:
            axis = self.task.axes[name]
            rates.append(float(values[name]) * np.log(axis.high / axis.low) if axis.log else axis.high - axis.low)
        return np.array(rates)

    def _differences(self, shares: Array, scale: Array) -> dict[str, tuple[float, Array]]:
        if not self.others:
            return {}
        values, steps = self._about(shares)
        own, *sides = self._asked(self.others, values)
        pairs = list(zip(sides[::2], sides[1::2], steps, strict=True))
        return {
            name: (own[name], np.array([(high[name] - low[name]) / step for low, high, step in pairs]) * scale)
            for name in self.others
        }

    def _solved(self, start: Array, reach: float) -> Array:
        """No farther than ``reach``, the shares that SLSQP (Kraft, 1988) comes to."""
        exact = [name for name in self.weights if name in self.active]
        own = np.array([i for i, _ in self.free])
        program = Program(self, start, own, exact)
        begun = np.concatenate([start[own], np.ones(len(exact))])
        near = [(max(0.0, share - reach), min(1.0, share + reach)) for share in start[own]]
        bounds = [*near, *[(0.0, None)] * len(exact)]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a step that leaves the bounds by rounding is clipped
            try:
                found = minimize(
                    program.goal,
                    begun,
                    jac=True,
                    bounds=bounds,
                    constraints={"type": "ineq", "fun": program.margin, "jac": program.margin_slopes},
                    method="SLSQP",
                    options={"maxiter": ITERATIONS, "ftol": 1e-5},
                )
            except ModelError:  # a step to a design that cannot be
                return start
        return program.shares(found.x)
