"""Branches of periodic solutions and how they hang together: traced, and left for others at their bifurcations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import End, Point, Settings, Trace, both_ways, followed
from torsional.solvers.periodic.problem import JOINED, HarmonicProblem, Setting, WatchedProblem
from torsional.solvers.periodic.stability import with_hidden_events
from torsional.solvers.periodic.start import first_solution
from torsional.solvers.periodic.verdict import Verdict, verdict

MAIN, DOUBLED, BROKEN, CROSSED, ISOLATED = "main", "period doubling", "symmetry breaking", "crossing", "isolated"
TRACING = Settings(first_step=0.01, largest_step=0.1, largest_angle=0.35, most_points=2000)
DEPARTED = "departed"
NOT_BIFURCATIONS = ("", JOINED, DEPARTED)
DEPARTURES = (0.02, 0.005, 0.001, 1e-4, 0.08)
"""First steps onto a branch that leaves another, in scaled angles, in the order in which they are tried."""
NEAR = {"fold": 1e-4, "branch point": 5e-3}
"""Scaled distance from where two branches meet within which a fold is the tip, a branch point the meeting itself."""
ALIKE, NEAREST = 1e-5, 3
"""Scaled distance below which two points are the same; how many chords of a branch are tried."""


@dataclass(eq=False)
class Branch:
    """One branch: its points in order, where it comes from and why it ends."""

    kind: str
    problem: HarmonicProblem
    points: tuple[Point, ...]
    started: str
    ended: str
    parent: tuple[int, int] = (-1, -1)
    """Number of the branch it leaves, and of the event there."""

    @property
    def base_order(self) -> float:
        """Order of which its harmonics are multiples."""
        return self.problem.base_order

    @property
    def events(self) -> list[Point]:
        """Its bifurcations."""
        return [point for point in self.points if point.event not in NOT_BIFURCATIONS and not self._leaving(point)]

    def _leaving(self, point: Point) -> bool:
        """Whether a point is where this branch meets the one it leaves: what is found there belongs to that one."""
        joints = (joint.z for joint in self.points if joint.event in (JOINED, DEPARTED))
        near = NEAR.get(point.event, 0.0)
        return any(float(np.abs(point.z - z).max()) < near for z in joints)

    @cached_property
    def verdict(self) -> Verdict:
        """Floquet multipliers and stability of its points."""
        return verdict(self.problem, self.points)

    @property
    def scaled(self) -> Array:
        """Scaled points (points, n + 1)."""
        return np.array([point.z for point in self.points])

    @property
    def values(self) -> Array:
        """The parameter along it."""
        return np.array([point.parameter for point in self.points])


@dataclass(eq=False)
class Explorer:
    """Follows the main branch of a setting over a span, and all that leave it up to a ``depth`` of departures."""

    setting: Setting
    base_order: float
    span: tuple[float, float]
    settings: Settings = TRACING
    depth: int = 2
    stability: bool = True
    branches: list[Branch] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    """Departures that could not be followed, in words."""
    make: Callable[[Setting, float], HarmonicProblem] = HarmonicProblem
    problems: dict[float, HarmonicProblem] = field(default_factory=dict)
    """Problems by base order, each made once."""

    def problem(self, base_order: float) -> HarmonicProblem:
        """The problem in multiples of a base order."""
        if base_order not in self.problems:
            self.problems[base_order] = self.make(self.setting, base_order)
        return self.problems[base_order]

    def explored(self) -> list[Branch]:
        """All branches that hang together with the main one."""
        self.main()
        self.leave_all()
        return self.branches

    def leave_all(self, number: int = 0) -> None:
        """Follow what leaves the branches from a number on."""
        while number < len(self.branches):
            if self._generation(number) < self.depth:
                for place, event in enumerate(self.branches[number].events):
                    self._leave(number, place, event)
            number += 1

    def main(self) -> None:
        """The main branches from both ends of the span, which mostly are one and the same."""
        problem = self.problem(self.base_order)
        low, high = self.span
        failed: list[ModelError] = []
        for value, direction in ((low, 1), (high, -1)):
            try:
                start = first_solution(problem, value)
            except ModelError as error:
                failed.append(error)
                continue
            if not self.known(problem, start):
                self.follow(problem, start, direction)
        if not self.branches:
            raise failed[0]
        self.lost += [str(error) for error in failed]

    def follow(self, problem: HarmonicProblem, start: Array, direction: int) -> None:
        """Add the main branch through a scaled solution at an end of the span."""
        trace = followed(problem, start, direction, self.span, self.settings)
        self._add(MAIN, problem, trace, "started at an end of the range")

    def isolated(self, problem: HarmonicProblem, start: Array, kind: str = ISOLATED) -> bool:
        """Add the branch through a scaled solution that lies on none of those known; whether it was a new one."""
        if self.known(problem, start):
            return False
        trace = both_ways(problem, start, self.span, self.settings)
        if len(trace.points) < 2:
            return False
        began = trace.began.advice if trace.began else End.CLOSED.advice
        self._add(kind, problem, trace, began)
        return True

    def known(self, problem: HarmonicProblem, z: Array) -> bool:
        """Whether a scaled solution lies on a known branch, be it moved by periods of the excitation or mirrored."""
        if any(_passes(branch, problem, z) for branch in self.branches):
            return True
        harmonics = problem.harmonics_of(z)
        for times in range(round(self.base_order / problem.base_order), 1, -1):  # is its period shorter than it seems?
            rest = np.arange(harmonics.shape[1]) % times != 0
            if np.abs(harmonics[:, rest]).max(initial=0.0) <= ALIKE * self.setting.angle_scale.min():
                wider = self.problem(times * problem.base_order)
                return self.known(wider, wider.point_of(harmonics[:, ::times], float(z[-1] * problem.scale[-1])))
        return False

    def _generation(self, number: int) -> int:
        count = 0
        while self.branches[number].parent[0] >= 0:
            number, count = self.branches[number].parent[0], count + 1
        return count

    def _leave(self, number: int, place: int, event: Point) -> None:
        branch = self.branches[number]
        if event.event == "period doubling":
            self._double(branch, (number, place), event)
        elif event.event == "branch point":
            self._cross(branch, (number, place), event)

    def _double(self, branch: Branch, origin: tuple[int, int], event: Point) -> None:
        """Follow the branch of twice the period from where it leaves to where it joins again, or as far as it goes."""
        problem = self.problem(0.5 * branch.base_order)
        if self._joined(problem, event):
            return
        watched = WatchedProblem.of_odd(problem)
        null = np.linalg.svd(branch.problem.half_order_block(event.z))[2][-1]
        harmonics = branch.problem.harmonics_of(event.z)
        wide = np.zeros((harmonics.shape[0], 2 * harmonics.shape[1] - 1), dtype=complex)
        wide[:, ::2] = harmonics
        start = problem.point_of(wide, event.parameter)
        heading = np.zeros_like(start)
        heading[watched.watched] = null[: int(watched.watched.sum())]
        self._depart(DOUBLED, problem, watched, start, heading, origin)

    def _cross(self, branch: Branch, origin: tuple[int, int], event: Point) -> None:
        """Follow the branch that crosses another at a branch point, to both sides unless they mirror each other."""
        problem, null = branch.problem, _crossing(branch, event)
        part = np.abs(null) > 1e-5 * np.abs(null).max()
        if np.abs(event.z[part]).max() < 1e-5 and not part[-1]:
            if not self._joined(problem, event):
                self._depart(BROKEN, problem, WatchedProblem(problem, part), event.z, null, origin)
            return
        for side in (1.0, -1.0):
            self._depart(CROSSED, problem, None, event.z, side * null, origin)

    def _joined(self, problem: HarmonicProblem, event: Point) -> bool:
        """Whether a branch that was followed before ended at this bifurcation."""
        ends = (branch.points[-1] for branch in self.branches if branch.base_order == problem.base_order)
        return any(
            end.event == JOINED and abs(end.parameter - event.parameter) <= 1e-4 * abs(self.span[1] - self.span[0])
            for end in ends
        )

    def _depart(
        self,
        kind: str,
        problem: HarmonicProblem,
        watched: WatchedProblem | None,
        start: Array,
        heading: Array,
        origin: tuple[int, int],
    ) -> None:
        heading = heading / np.linalg.norm(heading)
        event = self.branches[origin[0]].events[origin[1]]
        for step in DEPARTURES:
            found = problem.correct(start + step * heading, heading)
            if found.converged and self.span[0] <= found.z[-1] * problem.scale[-1] <= self.span[1]:
                break
        else:
            place = f"{event.event} at {event.parameter:g} of branch {origin[0]}"
            self.lost.append(f"{place}: no point of the branch that leaves there was found")
            return
        if self.known(problem, found.z):
            return
        settings = replace(self.settings, terminal=(JOINED,) if watched else ())
        trace = followed(watched or problem, found.z, 1, self.span, settings, heading=heading)
        leaving = Point(start, heading, found.values, event.parameter, -step, 0, event.residual, DEPARTED)
        trace = replace(trace, points=(leaving, *trace.points))
        told = f"left branch {origin[0]} at a {'period doubling' if kind == DOUBLED else 'branch point'}"
        self._add(kind, problem, trace, told, origin)

    def _add(
        self,
        kind: str,
        problem: HarmonicProblem,
        trace: Trace,
        started: str,
        parent: tuple[int, int] = (-1, -1),
    ) -> None:
        ended = "joined the branch it left, or its copy" if trace.end is End.TERMINAL else trace.end.advice
        if not trace.points:
            return
        branch = Branch(kind, problem, trace.points, started, ended, parent)
        if self.stability:
            told = branch.verdict
            points = with_hidden_events(problem, trace.points, told.multipliers, told.confirmed)
            if len(points) > len(trace.points):
                branch = replace(branch, points=points)
        self.branches.append(branch)


def _crossing(branch: Branch, event: Point) -> Array:
    """Direction of the curve that crosses a branch at a branch point.

    Two directions solve the linearised equations there; it is the one across the way that the branch itself takes.
    """
    _, jacobian, slope, _ = branch.problem.linearised(event.z)
    scale = branch.problem.scale
    rows = np.column_stack([jacobian * scale[:-1], slope * scale[-1]]) / scale[:-1, None]
    plane = np.linalg.svd(rows)[2][-2:]
    place = next(i for i, point in enumerate(branch.points) if point is event)
    before, after = branch.points[max(place - 1, 0)], branch.points[min(place + 1, len(branch.points) - 1)]
    along = plane @ (after.z - before.z)
    return np.asarray(np.array([-along[1], along[0]]) @ plane / np.linalg.norm(along))


def _passes(branch: Branch, problem: HarmonicProblem, z: Array) -> bool:
    """Whether a branch passes through a scaled point, up to a shift of the time by periods of the excitation.

    The chord nearest to the point is corrected in the plane across it that the point lies in: the same point is found
    again if the branch passes there.
    """
    if branch.base_order != problem.base_order or len(branch.points) < 2:
        return False
    scaled = branch.scaled
    start, chord = scaled[:-1], np.diff(scaled, axis=0)
    length = np.maximum((chord**2).sum(axis=1), 1e-300)
    for copy in copies(problem, z):
        share = np.clip(((copy - start) * chord).sum(axis=1) / length, 0.0, 1.0)[:, None]
        guess = start + share * chord
        distance = np.linalg.norm(guess - copy, axis=1)
        for i in np.argsort(distance)[:NEAREST]:
            if distance[i] > np.sqrt(length[i]) + ALIKE:
                continue
            found = problem.correct(guess[i], chord[i] / np.sqrt(length[i]))
            if found.converged and np.abs(found.z - copy).max() <= ALIKE * max(1.0, float(np.abs(copy).max())):
                return True
    return False


def copies(problem: HarmonicProblem, z: Array) -> Iterator[Array]:
    """The point itself, and of a sub-harmonic one those moved in time by whole periods of the excitation."""
    yield z
    harmonics = problem.harmonics_of(z)
    times = round(problem.setting.load.base_order / problem.base_order)
    for shift in range(1, times):
        turns = np.exp(2j * np.pi * shift * np.arange(harmonics.shape[1]) / times)
        yield problem.point_of(harmonics * turns, float(z[-1] * problem.scale[-1]))
