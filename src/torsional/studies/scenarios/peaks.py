"""What springs carry at most in a scenario, without its signals: all that a sweep keeps of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from torsional.files.scenario_blocks import Scenario
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.transient.marching import Marched
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.run import run_of, started
from torsional.solvers.transient.starts import MotionState
from torsional.studies.scenarios.joining import Turning, carried_over
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import OUTPUT, STEP, TABS, refuse_coarse, refuse_refined, released
from torsional.studies.scenarios.spans import lines_of

SHARE = 0.25
"""Of a step before the time zero by which a moment may be late."""


class Peaks(NamedTuple):
    """Of ``springs`` by name the lowest and the highest ``torque`` [Nm] and ``twist`` [rad], (2, springs) each."""

    springs: tuple[str, ...]
    torque: Array
    twist: Array


def spring_peaks(model: Model, scenario: Scenario) -> Peaks:
    """The peaks of the absorber's springs that `run_scenario` reads off, but for rounding.

    The same steps, looked at piece by piece as they are taken; Ctrl-C ends it without an answer.
    Raises ModelError as `run_scenario` does.
    """
    plan = planned(scenario, model)
    refuse_coarse(plan)
    seen = _seen(plan, model.landmarks.springs)
    plan, again = released(plan, *seen.crank)
    if again:
        seen = _seen(plan, model.landmarks.springs)
    refuse_refined(plan, seen.refined, seen.step)
    return seen.peaks()


def _seen(plan: Plan, springs: Sequence[str]) -> _Seen:
    """All pieces of a plan's run, line after line."""
    step, (turning, ends) = plan.step or STEP, lines_of(plan)
    seen = _Seen(plan, [name for name in springs if any(name in own.system.connections.names for own in turning)])
    state = plan.started(turning[0].system).since(-plan.settling)
    for place, (own, end) in enumerate(zip(turning, ends, strict=True)):
        if place:
            state = carried_over(state, turning[place - 1], own, plan.crank)
        state = seen.along(own, state, end, step, first=not place)
    return seen


@dataclass(eq=False)
class _Seen:
    """What is seen of a run while it goes on."""

    plan: Plan
    springs: list[str]
    refined: bool = False
    step: float = 0.0
    _ends: list[Array] = field(default_factory=list)
    _crank: list[tuple[Array, Array]] = field(default_factory=list)

    def along(self, own: Turning, state: MotionState, end: float, step: float, first: bool) -> MotionState:
        """Along one line from a state to an ``end`` [s]; the state there.  Where one line follows another its first
        moment is that of the one before."""
        plan, time = self.plan, end - state.time
        given = {"hold": plan.hold, "levels": plan.levels, "reference": plan.crank, "reference_time": plan.following}
        problem = Problem.of(own.system, plan.drives, plan.speed, **given)  # type: ignore[arg-type]
        run = run_of(problem, step, time)
        for part in run.pieces(started(problem, state), time, max(OUTPUT, step)):
            self._look(problem, part, run.accuracy.step, 0 if first else 1)
            state, first = part.end, True
        self.refined, self.step = self.refined or "refined" in run.notes, run.accuracy.step
        return replace(state, standing=None, step=0.0)

    def _look(self, problem: Problem, part: Marched, step: float, skipped: int) -> None:
        """Lowest and highest of one piece from the time zero on, and the crank's speed where a starter waits for it."""
        system = problem.system
        if self.plan.release is not None:
            at = system.node_index(self.plan.crank)
            turning = part.speed @ system.T[at] + problem.speed.at(part.time) * system.speed_ratio[at]
            self._crank.append((part.time, turning))
        late = part.time >= -SHARE * step
        late[:skipped] = False
        if late.any():
            signals = np.array([self._signals(problem, part, name) for name in self.springs])
            signals = signals.reshape(-1, 2, part.time.size)[..., late]
            self._ends.append(np.array([signals.min(axis=-1), signals.max(axis=-1)]))

    def _signals(self, problem: Problem, part: Marched, name: str) -> tuple[Array, Array]:
        """Torque and twist of a spring over the moments of a piece; nothing in a line without it."""
        names, weights = problem.system.connections.names, problem.system.connections.weights
        if name not in names:
            return np.zeros(part.time.size), np.zeros(part.time.size)
        at = names.index(name)
        torque, twist = part.torque[:, at], np.zeros(part.time.size)
        for coordinate in np.flatnonzero(weights[at]).tolist():
            twist = twist + weights[at, coordinate] * part.angle[:, coordinate]
        for place, sign in self._tabs(names):
            torque = torque + sign * part.torque[:, place]
        return torque, twist

    def _tabs(self, names: Sequence[str]) -> list[tuple[int, float]]:
        """Places and signs of the tabs of a detailed dual mass flywheel, see `with_tabs`."""
        inner = [name for name in names if name in self.plan.inner and len(self.plan.springs) == 1]
        return [(names.index(name), sign) for end, sign in TABS.items() for name in inner if name.endswith(end)]

    @property
    def crank(self) -> tuple[Array, Array]:
        """Times [s] and speeds [rad/s] of the crank; none where no starter waits for them."""
        times, speeds = zip(*self._crank, strict=True) if self._crank else ((), ())
        return np.concatenate([np.zeros(0), *times]), np.concatenate([np.zeros(0), *speeds])

    def peaks(self) -> Peaks:
        """Of all pieces."""
        both = np.array(self._ends)
        torque, twist = np.moveaxis(np.array([both[:, 0].min(axis=0), both[:, 1].max(axis=0)]), -1, 0)
        return Peaks(tuple(self.springs), torque, twist)
