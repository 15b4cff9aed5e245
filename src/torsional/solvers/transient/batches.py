"""Rows of a map settled in one compiled loop: all speeds of a torque one after the other, all torques side by side."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from torsional.engine import Excitation
from torsional.engine.orders import HIGHEST_ORDER
from torsional.numerics.arrays import Array
from torsional.numerics.motion.tables import Outside, tables_of
from torsional.numerics.stepping.batch import (
    BLOCK,
    LOOKED_AT,
    TURNED,
    VIEWS,
    Limits,
    Points,
    Room,
    Told,
    settled_points,
)
from torsional.numerics.stepping.loop import new_work
from torsional.numerics.stepping.marching import begin, blank_records, typed
from torsional.numerics.stepping.plan import Plan, matrix_of
from torsional.numerics.stepping.state import MEMORY, Entry, Q, V
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient.acting import assembled
from torsional.solvers.transient.drives import OrderTorques
from torsional.solvers.transient.marching import Accuracy
from torsional.solvers.transient.problem import Levels, Problem
from torsional.solvers.transient.starts import MotionState, starting
from torsional.solvers.transient.steady import steady_state
from torsional.solvers.transient.stroboscope import Stroboscope, sizes
from torsional.system import System

GIVEN = 32
"""Blocks of periods that a point is given in the compiled loop."""


@dataclass(frozen=True)
class Asked:
    """What a map asks of every point, as the settings of `steady_state` of the same names."""

    hold: str = ""
    levels: Levels | None = None
    start: object = "vibrating"
    step: float = 1e-4
    method: str = "chung_hulbert"
    spectral_radius: float = 0.8
    longest: int = 8
    most_periods: int = 3000
    tolerance: float = 1e-5
    thorough: bool = True
    parts: int = 2

    @property
    def accuracy(self) -> Accuracy:
        """How finely it is stepped, before the step is made to fit the period."""
        return Accuracy(self.step, self.method, self.spectral_radius)

    @property
    def limits(self) -> Limits:
        """What a point is given."""
        blocks = min(GIVEN, int(self.most_periods) // BLOCK)
        return Limits(blocks, int(self.longest), float(self.tolerance), int(self.parts))


@dataclass(eq=False)
class Batch:
    """Points of one ``system``: the ``drives`` of rows, each over rising speeds."""

    system: System
    drives: Sequence[Sequence[Excitation | OrderTorques]]
    asked: Asked

    @cached_property
    def problems(self) -> list[list[Problem]]:
        """What every point is made of."""
        hold, levels = self.asked.hold, self.asked.levels
        return [[Problem.of(self.system, one, None, hold=hold, levels=levels) for one in row] for row in self.drives]

    @cached_property
    def first(self) -> Problem:
        """The point whose plan is that of all."""
        return self.problems[0][0]

    @cached_property
    def tables(self) -> list[list[Outside]]:
        """What acts from outside at every point."""
        return [[self._tables(problem) for problem in row] for row in self.problems]

    def _tables(self, problem: Problem) -> Outside:
        shared, frame = self.first.equations, problem.speed.level
        driven, governed, _ = assembled(problem.acting, shared.coordinates, problem.levels)
        return tables_of(driven, governed, shared.reference, shared.reference_time, (frame.time, frame.value))

    @cached_property
    def strobes(self) -> list[Stroboscope]:
        """The points of the first row as they are looked at; the state is no matter."""
        still = MotionState.at_rest(self.system)
        return [Stroboscope(one, self.asked.accuracy, still, self.first.base_order) for one in self.problems[0]]

    @cached_property
    def orders(self) -> Array:
        """The orders that are told."""
        fine = self.first.base_order / self.asked.parts
        return np.asarray(fine * np.arange(int(HIGHEST_ORDER / fine + 1e-9) + 1), dtype=float)

    @property
    def refusal(self) -> str:
        """Why its points must be settled one by one, "" where they need not."""
        asked, outside = self.asked, self.first.plan.outside
        if asked.method in ("explicit", "exact"):
            return f"the method '{asked.method}' chooses its own steps"
        if min(asked.longest, asked.parts) < 1 or not asked.tolerance > 0:
            return "settings that the compiled loop does not know"
        if outside.governors.shape[1] or outside.cranks.shape[1] or outside.pendulums.size or self.first.acting.drags:
            return "governors, pistons, friction of cylinders and pendulums want a state of their own"
        heavy = matrix_of(self.first.plan.masses)
        if np.linalg.eigvalsh(heavy)[0] <= 1e-14 * np.abs(heavy).max():
            return "a coordinate has no mass"
        if any(not np.array_equal(self._inertia(one), self._inertia(self.first)) for one in self.problems[0]):
            return "inertias switch with the speed"
        for row, tables in zip(self.problems, self.tables, strict=True):
            if not all(self._alike(one, own) for one, own in zip(row, tables, strict=True)):
                return "the drives of the points are not made alike"
        fewest = min(strobe.steps for strobe in self.strobes)
        return "the step is too long for the orders" if 2 * len(self.orders) > asked.parts * fewest else ""

    def _inertia(self, problem: Problem) -> Array:
        return np.asarray(self.system.switched(problem.start_speed).masses.inertia)

    def _alike(self, problem: Problem, own: Outside) -> bool:
        """Whether nothing but profiles and knots tells a point from the first one."""
        other, base = self.tables[0][0], self.first.base_order
        same = all(np.array_equal(getattr(own, name), getattr(other, name)) for name in _SHARED)
        shapes = own.profile.shape == other.profile.shape and own.knots.shape == other.knots.shape
        return bool(same and shapes and 0 < problem.base_order == base and problem.start_speed > 0)

    def settled(self) -> list[Row]:
        """All rows, settled side by side as far as there are processors."""
        rows = [Row(self, number) for number in range(len(self.drives))]
        while waiting := [row for row in rows if row.reached < len(row.problems)]:
            with ThreadPoolExecutor(min(len(waiting), _processors())) as pool:
                list(pool.map(Row.go, waiting))
            for row in waiting:
                if row.reached < len(row.problems):
                    row.alone()
        return rows


_SHARED = ("sources", "source_places", "level_start", "leaks")


def _processors() -> int:
    """As many as there are, or as compiled code may use in a process of many."""
    found = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    allowed = os.environ.get("NUMBA_NUM_THREADS", "")
    return min(found, max(int(allowed), 1)) if allowed.isdecimal() else found


class Row:
    """Points of one torque, and the memory of the loop over them."""

    def __init__(self, batch: Batch, number: int) -> None:
        self.batch, self.problems = batch, batch.problems[number]
        first = self.problems[0]
        self.start = starting(batch.asked.start, first.system, first.acting, first.hold, first.start_speed)
        self.drives, self.reached = batch.drives[number], 0
        self.others: dict[int, xr.Dataset] = {}
        plan, tables = batch.first.plan, batch.tables[number]
        outside = plan.outside
        self.plan = plan._replace(outside=outside._replace(profile=outside.profile.copy(), knots=outside.knots.copy()))
        self.standing = _standing(self.plan)
        steps = np.array([strobe.steps for strobe in batch.strobes], dtype=np.int64)
        self.points = Points(
            profile=np.array([own.profile for own in tables]),
            knots=np.array([own.knots for own in tables]),
            step=np.array([strobe.settled.step for strobe in batch.strobes]),
            steps=steps,
            stiffness=np.array([np.sqrt(sizes(batch.system, self.start.angle, speed)) for speed in self.speeds]),
        )
        self.told = _told(len(steps), len(batch.orders), self.standing)
        self.room = _room(batch, self.plan, int(steps.max()))

    @property
    def speeds(self) -> list[float]:
        """Mean speed of each point [rad/s]."""
        return [problem.start_speed for problem in self.problems]

    def accuracy(self, place: int) -> Accuracy:
        """How finely a point was stepped."""
        return replace(self.batch.asked.accuracy, step=float(self.points.step[place]))

    def go(self) -> None:
        """Settle points until one must be settled alone; the compiled loop lets other threads run."""
        self._put(self.start)
        family = self.batch.asked.accuracy.family
        self.reached = settled_points(
            self.plan,
            self.standing,
            new_work(self.plan, self.standing),
            typed(self.batch.asked.accuracy.settings),
            (family.alpha_m, family.alpha_f, family.beta, family.gamma),
            self.points,
            self.batch.asked.limits,
            self.room,
            self.told,
            self.reached,
        )
        if self.reached and self.reached - 1 not in self.others:
            self.start = self.end(self.reached - 1)

    def _put(self, state: MotionState) -> None:
        self.standing.coordinates[Q], self.standing.coordinates[V] = state.angle, state.speed
        self.standing.law[MEMORY] = state.memory[self.plan.laws.of]

    def end(self, place: int) -> MotionState:
        """Where a point ended."""
        memory = np.zeros(self.plan.constants.shape[1])
        memory[self.plan.laws.of] = self.told.memory[place]
        angle, speed = self.told.end[place].copy()
        return MotionState(0.0, angle, speed, memory, np.zeros(0), float(self.told.figures[place, TURNED]))

    def alone(self) -> None:
        """Settle the next point by itself, from where the one before it ended."""
        place, asked = self.reached, self.batch.asked
        found = steady_state(
            self.batch.system,
            self.drives[place],
            hold=asked.hold,
            levels=asked.levels,
            start=self.start,
            step=asked.step,
            method=asked.method,
            spectral_radius=asked.spectral_radius,
            base_order=self.batch.first.base_order,
            longest=asked.longest,
            most_periods=asked.most_periods,
            tolerance=asked.tolerance,
            thorough=asked.thorough,
            parts=asked.parts,
        )
        self.others[place] = found
        self.start, self.reached = MotionState.ending(found, self.batch.system), place + 1


def _standing(plan: Plan) -> Standing:
    """A state for the loop to work on."""
    still = np.zeros(plan.tape.node.size)
    return begin(plan, still, still)


def _told(points: int, orders: int, state: Standing) -> Told:
    n, edges, laws = state.coordinates.shape[1], state.connection.shape[1], state.law.shape[1]
    return Told(
        sums=np.zeros((points, 2, orders, n + edges)),
        edges=np.zeros((points, 2, n + edges)),
        end=np.zeros((points, 2, n)),
        memory=np.zeros((points, laws)),
        ledger=np.zeros((points, len(Entry))),
        passed=np.zeros((points, 4, edges)),
        figures=np.zeros((points, 3)),
        counts=np.zeros((points, 3), dtype=np.int64),
    )


def _room(batch: Batch, plan: Plan, steps: int) -> Room:
    rates = batch.strobes[0].rates
    states, most = plan.constants.shape[1] + len(rates), max(LOOKED_AT, steps + 1)
    return Room(
        at=np.zeros(most, dtype=np.int64),
        records=blank_records(plan, most),
        points=np.zeros((batch.asked.limits.blocks * BLOCK + 2, states)),
        views=np.zeros((2 * VIEWS, states)),
        rates=np.ascontiguousarray(rates),
        mobility=np.ascontiguousarray(np.linalg.inv(matrix_of(plan.masses))),
    )
