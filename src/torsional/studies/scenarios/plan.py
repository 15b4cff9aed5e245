"""What a scenario comes to: a line, what drives it, how it starts, and what is worth looking at."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from torsional.powertrain import Powertrain
from torsional.solvers.transient.acting import Drive
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.speed_profile import SpeedProfile, as_speed
from torsional.solvers.transient.starts import MotionState, starting
from torsional.studies.scenarios.lines import stuck
from torsional.studies.scenarios.schedule import Knots
from torsional.system import System, assemble

FOLLOWING = 0.1
"""Time constant [s] with which absolute dampers follow the crank's own speed, where it changes of itself."""
SETTLING = 1.0
"""Time [s] before the time zero that a vibration has to become steady."""


class Span(NamedTuple):
    """From a time ``at`` [s] on it is another ``line``."""

    at: float
    line: Powertrain


class Phase(NamedTuple):
    """What happens from a time to another [s], in words."""

    name: str
    begin: float
    end: float


class Release(NamedTuple):
    """A starter of a ``free`` speed [rad/s] that is off for good once the crank has reached ``speed`` before ``until``
    [s]; ``off`` gives the plan in which it is off from a moment on."""

    speed: float
    free: float
    until: float
    off: Callable[[float], Plan]


@dataclass(frozen=True, eq=False)
class Plan:
    """A scenario ready to be stepped: plain values for `transient`.

    ``line``; ``drives``; ``speed`` of the frame [rad/s], the engine's before anything happens, or over time;
    ``duration`` [s]; ``following``: time constant [s] with which absolute dampers follow the crank's own speed;
    ``start`` as `transient` has it; ``turned``: the crank angle [rad] at which it stands; ``lag`` [rad/s] by which the
    nodes ``lagging`` turn slower than the frame, seen at the engine; ``hold``: the node that takes up the mean load of
    the time zero; ``stuck``: linings that carry their share of it; ``levels`` of normal loads over time.  ``crank``:
    the node of the engine's speed; ``springs``, ``watched``: absorber springs, and further connections, to be drawn;
    ``shown``: what happens, over time, by its name and quantity; ``inner``: parts of an absorber in detail, which get
    no row of their own; ``later``: lines that take the place of the first one, one after the other, at a constant
    ``speed``; ``phases`` of what happens, to be marked; ``release`` of a starter.
    """

    title: str
    line: Powertrain
    drives: tuple[Drive, ...]
    speed: float | SpeedProfile
    duration: float
    crank: str
    springs: tuple[str, ...]
    start: str = "rest"
    turned: float = 0.0
    lag: float = 0.0
    lagging: frozenset[str] = frozenset()
    hold: str = ""
    stuck: tuple[str, ...] = ()
    levels: Mapping[str, Knots] = field(default_factory=dict)
    watched: tuple[str, ...] = ()
    nodes: tuple[str, ...] = ()
    shown: Mapping[str, tuple[Knots, str]] = field(default_factory=dict)
    step: float | None = None
    gear: str = ""
    inner: frozenset[str] = frozenset()
    following: float = FOLLOWING
    later: tuple[Span, ...] = ()
    phases: tuple[Phase, ...] = ()
    release: Release | None = None

    def started(self, system: System) -> MotionState:
        """Where it starts: as asked for, but turned, and part of it slower, and linings that hold a torque."""
        if self.stuck:
            return self._carrying(system)
        if not (self.turned or self.lag):
            return self._as_asked(system)
        state = MotionState.at_rest(system)
        slow = np.array([node in self.lagging for node in system.coordinates])
        angle = np.full(len(system.coordinates), self.turned)
        return MotionState(0.0, angle, np.where(slow, -self.lag, 0.0), state.memory, state.integral)

    def _as_asked(self, system: System) -> MotionState:
        problem = Problem.of(system, self.drives, self.speed, hold=self.hold, levels=self.levels)
        return starting(self.start, system, problem.acting, self.hold, problem.start_speed)

    def _carrying(self, system: System) -> MotionState:
        """The start in which linings stick: friction remembers the twist that its mean torque takes."""
        twin = assemble(stuck(self.line, self.stuck))
        state = self._as_asked(twin)
        twist = system.connections.weights @ state.angle
        sticks = np.array([name in self.stuck for name in system.connections.names])
        return dataclasses.replace(state, memory=np.where(sticks, twist, 0.0))

    @property
    def settling(self) -> float:
        """Time [s] before the time zero in which a steady vibration settles: whole cycles, so that the crank stands as
        it would; none from rest."""
        speed = float(as_speed(self.speed).at(0.0))
        cycle = 4 * np.pi / speed if speed > 0 else 0.0
        return float(np.ceil(SETTLING / cycle) * cycle) if self.start == "vibrating" and cycle else 0.0
