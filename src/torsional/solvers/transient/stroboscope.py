"""A line looked at once a period of its drive: does it repeat itself, and do neighbouring motions stay together?"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.stepping.batch import BLOCK, LITTLE, VIEWS
from torsional.numerics.stepping.stroboscopic import repeats
from torsional.solvers.transient.character import Character, dimension, drifts, named, restless
from torsional.solvers.transient.marching import Accuracy, Marched, marched, motion_lost
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState, grounded, tangents
from torsional.system import System
from torsional.units import show_speed

NEAR = 1e-6
"""Distance of the neighbour, over the size of the motion, from which the exponent is measured."""
PARTING, SKIPPED = 300, 50
"""Periods over which it is, and those before."""
MAPPED = 1500
"""Stroboscopic points for a dimension."""
FALLING = 0.7
SECOND = 320
"""Periods that half the step is given."""
FURTHER = np.concatenate([-np.geomspace(1e-3, 1.0, 7), np.geomspace(1e-3, 1.0, 7)])
"""Angles [rad] at which a law that is flat in equilibrium is asked for its slope."""


@dataclass(eq=False)
class Stroboscope:
    """Periods of one ``problem`` from a state on; every period takes the same whole number of steps."""

    problem: Problem
    accuracy: Accuracy
    state: MotionState
    base_order: float
    points: Array = field(init=False)
    size: float = field(init=False, default=0.0)
    notes: dict[str, str] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.points = self.seen(self.state.angle[None], self.state.speed[None])

    @property
    def period(self) -> float:
        """Period of the drive [s]."""
        return 2 * np.pi / (self.base_order * self.problem.start_speed)

    @property
    def steps(self) -> int:
        """Steps a period, a multiple of the moments that are looked at."""
        return VIEWS * int(np.ceil(self.period / self.accuracy.step / VIEWS * (1 - 1e-9)))

    @property
    def settled(self) -> Accuracy:
        """The accuracy with a step that fits the period."""
        return replace(self.accuracy, step=self.period / self.steps)

    @cached_property
    def _rows(self) -> tuple[Array, Array]:
        """What turns angles and speeds into states whose squares are energies; rigid rotation is not seen."""
        system = self.problem.system
        stiffness = sizes(system, self.state.angle, self.problem.start_speed)
        return np.sqrt(stiffness)[:, None] * system.connections.weights, self.rates

    @property
    def rates(self) -> Array:
        """What turns speeds into states whose squares are energies (inertias, coordinates)."""
        system = self.problem.system
        masses = system.switched(self.problem.start_speed).masses
        v = np.sqrt(masses.inertia)[:, None] * masses.weights
        return v if grounded(system) else v - np.outer(v.sum(axis=1), system.M.sum(axis=0) / system.M.sum())

    def seen(self, angle: Array, speed: Array) -> Array:
        """States (moments, states) [√J] of angles and speeds (moments, coordinates)."""
        w, v = self._rows
        return np.concatenate([angle @ w.T, speed @ v.T], axis=1)

    def run(self, periods: int) -> Marched:
        """Go on for some periods; the points are kept."""
        told = self._on(self.state, periods, self.steps // VIEWS)
        views = self.seen(told.angle, told.speed)
        self.points = np.concatenate([self.points, views[VIEWS::VIEWS]])
        last = views[-2 * VIEWS :]
        self.size = float(np.sqrt(np.square(last - last.mean(axis=0)).sum(axis=1)).max())
        self.state = told.end
        return told

    def full(self, periods: int) -> Marched:
        """Go on for some periods with every step in the record."""
        told = self._on(self.state, periods, 1)
        self.state = told.end
        return told

    def _on(self, state: MotionState, periods: int, every: int) -> Marched:
        """Go on for some periods; ModelError where the steps lose the motion."""
        told = marched(self.problem, state, periods * self.steps, self.settled, every)
        if not np.isfinite(told.end.angle).all():
            raise motion_lost(told, self.settled, show_speed(self.problem.start_speed))
        return told

    def exponent(self, periods: int = PARTING) -> float:
        """Largest Lyapunov exponent a period: how neighbouring motions part, the distance set back every period.

        Both begin every period afresh, so that they differ by nothing but the distance.
        """
        random = np.random.default_rng(7)
        own = self.state
        step_off = random.standard_normal((2, len(own.angle)))
        apart = np.linalg.norm(self.seen(step_off[:1], step_off[1:]))
        share = NEAR * self.size / apart
        other = own.moved(share * step_off[0], share * step_off[1])
        grown = np.zeros(periods)
        for i in range(periods):
            own = self._on(own.moved(0.0, 0.0), 1, self.steps).end
            other = self._on(other, 1, self.steps).end
            angle, speed = other.angle - own.angle, other.speed - own.speed
            factor = np.linalg.norm(self.seen(angle[None], speed[None])) / (NEAR * self.size)
            grown[i] = np.log(factor) if factor > 0 else -np.inf
            back = float(1.0 / factor) if factor > 0 else 0.0
            other = own.moved(back * angle, back * speed, back * (other.memory - own.memory))
        return float(grown[min(SKIPPED, periods // 2) :].mean())

    def until_periodic(self, longest: int, most: int, tolerance: float) -> tuple[int, float, bool]:
        """Periods after which it repeats itself (0: it does not), what is left, and whether that was falling."""
        left, history = np.inf, [np.inf]
        while len(self.points) <= most:
            self.run(min(BLOCK, most + 1 - len(self.points)) if len(self.points) > 1 else BLOCK)
            count, left = repeats(self.points, self.size, longest, tolerance)
            if count:
                return count, left, True
            history.append(left)
        half = len(history) // 2
        return 0, left, bool(left < FALLING * min(history[: half + 1]))

    def _by_half_the_step(self, count: int, left: float, longest: int, tolerance: float) -> tuple[int, float]:
        """The same where the motion does repeat itself with half the step, which is gone on with: little contacts that
        rattle are the step's own.  What is only less with it is noted."""
        gap, step = restless(self.points, self.size, longest), self.settled.step
        if not tolerance < gap < LITTLE:
            return count, left
        twin = Stroboscope(self.problem, replace(self.accuracy, step=0.5 * step), self.state, self.base_order)
        found, rest, _ = twin.until_periodic(longest, SECOND, tolerance)
        finer = restless(twin.points, twin.size, longest)
        what = f"with {step:.3g} s {gap:.1e} of the motion changes from period to period"
        if found == 1:
            self.accuracy, self.state, self.size = twin.accuracy, twin.state, twin.size
            self.points = np.concatenate([self.points, twin.points[1:]])
            self.notes["refined"] = f"step halved to {0.5 * step:.3g} s: {what}, with half of it nothing"
            return found, rest
        if finer < 0.5 * gap:
            self.notes["unresolved"] = f"{what}, with half of it {finer:.1e}: take a smaller step"
        return count, left

    def character(self, longest: int, most: int, tolerance: float, thorough: bool = True) -> Character:
        """What the motion is, after at most ``most`` periods; the exponent is asked of one that does not repeat itself,
        the dimension where the exponent does not decide."""
        count, left, falling = self.until_periodic(longest, most, tolerance)
        if count > 1 or (thorough and not falling):
            count, left = self._by_half_the_step(count, left, longest, tolerance)
        if count or not thorough or not self.size > 0:
            return named(count, left, float("nan"), float("nan"), falling)
        if not falling and drifts(self.points, longest):
            return Character("drifting", 0, left)
        exponent = self.exponent()
        if abs(exponent) < 0.1 and not falling:
            self.run(MAPPED)
            return named(0, left, exponent, dimension(self.points[-MAPPED:]), falling)
        return named(0, left, exponent, float("nan"), falling)


def sizes(system: System, angle: Array, speed: float) -> Array:
    """A stiffness of every connection's own size [Nm/rad]: its slope in equilibrium, or where a law is flat there a
    mean of its slopes further out."""
    found = tangents(system, angle, speed)[0].real
    for i, law in enumerate(system.connections.laws):
        if law is not None and not found[i] > 0 and not system.connections.whole_speed[i]:
            found[i] = float(np.mean(law.tangent(FURTHER)))
    return np.maximum(found, 0.0)
