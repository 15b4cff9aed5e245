"""The front of a search made better by gradients: its ends, designs between them, its knee."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.studies.optimise.front import front, knee
from torsional.studies.optimise.generations import Generations
from torsional.studies.optimise.refine import Refinement
from torsional.studies.optimise.search import scored
from torsional.studies.optimise.task import Limit, Method, Task

KEPT = 10**7
"""Number of the first chunk that holds refined designs."""
STARTS, APART = 4, 0.3
"""Designs from which an end of a front is looked for, and how far apart they are as shares of some axis."""


def refined(task: Task, method: Method, between: int, kept: Generations) -> str:
    """Refine the front of what was searched, the designs found being one more generation; why none is, if none."""
    shares, goals = feasible(task, kept)
    if not len(goals):
        return "no design keeps all limits"
    polish = Polish(task, kept, shares, goals, len(goals))
    try:
        polish.ends()
        if len(task.objectives) == 2:
            polish.between(between)
        if len(task.objectives) > 1:
            polish.knee()
    except ModelError as error:
        return error.problem if error.where == "refine" else str(error)
    found = polish.shares[len(shares) :]
    if not len(found):
        return "gradients found nothing better"
    kept.answers(method.generations + 1, task.columns(found))
    return ""


def feasible(task: Task, kept: Generations) -> tuple[Array, Array]:
    """Shares and objectives, to be made small, of the searched designs that keep all limits."""
    shares, goals = [], []
    for columns, answers in kept.found[task.nominal_values is not None :]:
        every, beyond = scored(task, answers)
        good = (beyond <= 0).all(axis=1)
        shares.append(task.shares(columns)[good])
        goals.append(every[good])
    return np.concatenate(shares), np.concatenate(goals)


@dataclass
class Polish:
    """Designs by their ``shares`` and ``goals``, those from place ``searched`` on being refined ones."""

    task: Task
    kept: Generations
    shares: Array
    goals: Array
    searched: int
    number: int = KEPT

    def __post_init__(self) -> None:
        self.batch = self.task.batch()

    def ends(self) -> None:
        """Each objective alone, from designs that are best and unlike each other: there may be more than one valley."""
        for place, name in enumerate(self.task.objectives):
            for start in unlike(self.shares[: self.searched], self.goals[: self.searched, place], STARTS):
                self._from(start, {name: 1.0}, self.task)

    def between(self, count: int) -> None:
        """The second objective within limits of the first, evenly from end to end."""
        first, second = self.task.objectives
        on = self.goals[self._front()][:, 0]
        for level in np.linspace(on[0], on[-1], count + 2)[1:-1].tolist():
            allowed = self.task.sign(first) * level
            limit = Limit(most=allowed) if self.task.sign(first) > 0 else Limit(least=allowed)
            narrower = replace(self.task, limits={**self.task.limits, first: _both(limit, self.task.limits.get(first))})
            places = self._front()
            near = [place for place in places if self.goals[place, 0] <= level]
            self._from(int(near[-1]), {second: 1.0}, narrower)

    def knee(self) -> None:
        """The sum of the objectives over their spans on the front."""
        places = self._front()
        spans = np.ptp(self.goals[places], axis=0)
        weights = {name: 1.0 / (span or 1.0) for name, span in zip(self.task.objectives, spans, strict=True)}
        self._from(int(places[knee(self.goals[places])]), weights, self.task)

    def _front(self) -> IntArray:
        return front(self.goals)

    def _from(self, place: int, weights: Mapping[str, float], task: Task) -> None:
        """Refine one design, and take it up where that made it better."""
        start, self.number = self.shares[place], self.number + 1
        refinement = Refinement(task, weights, self.batch)
        known = self.kept.store.get(self.number)
        if known is None or not np.array_equal(known["start"], start):
            known = {"start": start, "shares": refinement.refined(start)}
            self.kept.store.put(self.number, known)
        if not np.array_equal(known["shares"], start):
            self.shares = np.vstack([self.shares, known["shares"]])
            self.goals = np.vstack([self.goals, refinement.goals(known["shares"])])


def unlike(shares: Array, goal: Array, count: int) -> list[int]:
    """Places of the best of designs, at most ``count``, whose shares of some axis differ by `APART` from one to another.

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
