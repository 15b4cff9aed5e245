"""The front of a search made better by gradients: its ends, designs between them, its knee."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.studies.crew import Lost
from torsional.studies.optimise.front import front, knee
from torsional.studies.optimise.generations import Bench, Generations, keyed
from torsional.studies.optimise.refine import Refinement
from torsional.studies.optimise.search import scored
from torsional.studies.optimise.task import Limit, Method, Task

KEPT = 10**7
"""Number of the first chunk that holds refined designs."""
STARTS, APART = 4, 0.3
"""Designs from which an end of a front is looked for, and how far apart they are as shares of some axis."""


def refined(task: Task, method: Method, between: int, kept: Generations) -> str:
    """Refine the front of what was searched, the designs found being one more generation; why none is, if none."""
    shares, goals, beyond = known(task, kept)
    good = beyond == 0
    polish = Polish(task, kept, shares[good], goals[good])
    begun = len(polish.goals)
    try:
        if not begun:
            polish.into_limits(shares, beyond)
        if not len(polish.goals):
            return "no design keeps all limits"
        polish.ends()
        if len(task.objectives) == 2:
            polish.between(between)
        if len(task.objectives) > 1:
            polish.knee()
    except ModelError as error:
        return error.problem if error.where == "refine" else str(error)
    found = polish.shares[begun:]
    if not len(found):
        return "gradients found nothing better"
    kept.answers(method.generations + 1, task.columns(found))
    return ""


def known(task: Task, kept: Generations) -> tuple[Array, Array, Array]:
    """Shares and objectives, to be made small, of the searched designs that have an answer, and how far each is beyond
    limits in all, 0 where it keeps them."""
    shares, goals, over = [], [], []
    for columns, answers in kept.found[task.nominal_values is not None :]:
        every, beyond = scored(task, answers)
        told = answers.answered
        shares.append(task.shares(columns)[told])
        goals.append(every[told])
        over.append(np.maximum(beyond[told], 0.0).sum(axis=1))
    return np.concatenate(shares), np.concatenate(goals), np.concatenate(over)


@dataclass(frozen=True, eq=False)
class Start:
    """A design by its ``shares``, from which the sum of objectives times ``weights`` is to be made smaller within
    ``limits``; kept under its ``number``."""

    number: int
    shares: Array
    weights: Mapping[str, float]
    limits: Mapping[str, Limit]

    @property
    def key(self) -> np.ndarray:
        """What tells this task from others, as bytes."""
        limits = {name: [repr(limit.least), repr(limit.most)] for name, limit in self.limits.items()}
        return keyed([self.shares.tolist(), dict(self.weights), limits])

    def worked(self, at: Bench) -> None:
        """Refine it: where gradients led, and the objectives there."""
        refinement = Refinement(replace(at.task, limits=self.limits), self.weights, at.batch)
        found = refinement.refined(self.shares)
        told = {"goals": refinement.goals(found), "within": np.array(refinement.within(found))}
        at.store.put(self.number, {"start": self.key, "shares": found, **told})


@dataclass
class Polish:
    """Designs that keep all limits, by their ``shares`` and ``goals``."""

    task: Task
    kept: Generations
    shares: Array
    goals: Array
    number: int = KEPT

    def into_limits(self, shares: Array, beyond: Array) -> None:
        """Where the search found none that keeps all limits, from those that miss them by least."""
        first = self.task.objectives[0]
        starts = [self._from(shares[place], {first: 1.0}, {}) for place in unlike(shares, beyond, STARTS)]
        self._refine(starts)

    def ends(self) -> None:
        """Each objective alone, from designs that are best and unlike each other: there may be more than one valley."""
        starts = [
            self._start(place, {name: 1.0}, {})
            for column, name in enumerate(self.task.objectives)
            for place in unlike(self.shares, self.goals[:, column], STARTS)
        ]
        self._refine(starts)

    def between(self, count: int) -> None:
        """The second objective within limits of the first, evenly from end to end."""
        first, second = self.task.objectives
        places, sign = self._front(), self.task.sign(first)
        on, starts = self.goals[places][:, 0], []
        for level in np.linspace(on[0], on[-1], count + 2)[1:-1].tolist():
            limit = Limit(most=sign * level) if sign > 0 else Limit(least=sign * level)
            near = places[np.flatnonzero(on <= level)[-1]]
            starts.append(self._start(int(near), {second: 1.0}, {first: limit}))
        self._refine(starts)

    def knee(self) -> None:
        """The sum of the objectives over their spans on the front."""
        places = self._front()
        spans = np.ptp(self.goals[places], axis=0)
        weights = {name: 1.0 / (span or 1.0) for name, span in zip(self.task.objectives, spans, strict=True)}
        self._refine([self._start(int(places[knee(self.goals[places])]), weights, {})])

    def _front(self) -> IntArray:
        return front(self.goals)

    def _start(self, place: int, weights: Mapping[str, float], narrower: Mapping[str, Limit]) -> Start:
        return self._from(self.shares[place], weights, narrower)

    def _from(self, shares: Array, weights: Mapping[str, float], narrower: Mapping[str, Limit]) -> Start:
        own = self.task.limits
        limits = {**own, **{name: _both(limit, own.get(name)) for name, limit in narrower.items()}}
        self.number += 1
        return Start(self.number, shares, weights, limits)

    def _refine(self, starts: Sequence[Start]) -> None:
        """Refine designs side by side, and take up those that were made better."""
        for _, told in self.kept.crew.results([start for start in starts if self._known(start) is None]):
            if isinstance(told, Lost):
                raise ModelError("a process died while it refined a design", where="refine")
        found = [(start, each) for start in starts if (each := self._known(start)) is not None]
        better = [each for start, each in found if each["within"] and not np.array_equal(each["shares"], start.shares)]
        self.shares = np.vstack([self.shares, *(each["shares"] for each in better)])
        self.goals = np.vstack([self.goals, *(each["goals"] for each in better)])

    def _known(self, start: Start) -> dict[str, np.ndarray] | None:
        told = self.kept.store.get(start.number)
        return told if told is not None and np.array_equal(told["start"], start.key) else None


def unlike(shares: Array, goal: Array, count: int) -> list[int]:
    """Places of the best of designs, at most ``count``: from one to another shares of some axis differ by `APART`.

    >>> unlike(np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.9]]), np.array([1.0, 2.0, 3.0]), 2)
    [0, 2]
    """
    found: list[int] = []
    for place in np.argsort(goal, kind="stable").tolist():
        if len(found) < count and all(abs(shares[place] - shares[other]).max() >= APART for other in found):
            found.append(place)
    return found


def _both(one: Limit, other: Limit | None) -> Limit:
    return one if other is None else Limit(max(one.least, other.least), min(one.most, other.most))
