"""The compiled loop over points of one row, speed after speed: each is begun where the last one ended, looked at once a
period until it repeats itself, and summed up into orders.

What differs between the points of a row, profiles and knots, is laid into the one plan that they share.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.stepping.loop import run
from torsional.numerics.stepping.plan import Plan
from torsional.numerics.stepping.restart import restart
from torsional.numerics.stepping.state import LOST, MADE, MEMORY, TURNING, TWIST, Q, Records, Settings, State, V
from torsional.numerics.stepping.step import Work
from torsional.numerics.stepping.stroboscopic import gap_between, repeats
from torsional.numerics.uncounted import inner, uncounted

BLOCK, VIEWS = 32, 32
"""Periods between two looks at whether a motion repeats itself; moments of a period at which its size is measured."""
LOOKED_AT = BLOCK - 2 + 2 * VIEWS
"""Moments of a block that are recorded: the ends of its periods, and in the last two all views."""
LITTLE = 0.02
"""Change from period to period, over the motion's size, that half the step is asked about."""


class _Ended(IntEnum):
    """How a point ended, below zero; zero and above it is a `Status` of the march."""

    RESTLESS = -1  # not periodic within the periods that it is given
    FINER = -2  # repeats itself, but little contacts that rattle may be the step's own


PERIODS, TAKEN, HOW = range(3)
"""Columns of ``counts``."""
LEFT_OVER, SIZE, TURNED = range(3)
"""Columns of ``figures``."""


class Points(NamedTuple):
    """What P points of a row have of their own: ``profile`` (P, pieces, 4) and ``knots`` (P, 2, K) of `Outside`,
    ``step`` h [s] and ``steps`` of a period (P,), and ``stiffness`` (P, E), the roots of what weighs the twists."""

    profile: Array
    knots: Array
    step: Array
    steps: IntArray
    stiffness: Array


class Told(NamedTuple):
    """What is told of P points: ``sums`` (P, 2, orders, n + E), real and imaginary parts of sums over the samples of
    coordinates and torques, and the two ``edges`` (P, 2, n + E) of these samples; the ``end`` q, q̇ (P, 2, n) and
    ``memory`` (P, L); ``ledger`` (P, entries) and ``passed`` (P, 4, E) of `State`; ``figures``, ``counts`` (P, 3)."""

    sums: Array
    edges: Array
    end: Array
    memory: Array
    ledger: Array
    passed: Array
    figures: Array
    counts: IntArray


class Room(NamedTuple):
    """Memory of the loop: ``at`` and ``records`` of the longest stretch, stroboscopic ``points`` and the last ``views``
    as states [√J], what turns coordinates' rates into them (m, n), and the inverse of M (n, n)."""

    at: IntArray
    records: Records
    points: Array
    views: Array
    rates: Array
    mobility: Array


class Limits(NamedTuple):
    """What a point is given: at most that many ``blocks`` of periods, ``longest`` and ``tolerance`` of `repeats`,
    orders in ``parts`` of the base order."""

    blocks: int
    longest: int
    tolerance: float
    parts: int


@inner()
def _lay(plan: Plan, points: Points, p: int) -> None:
    """The point's own into the plan."""
    profile, knots = plan.outside.profile, plan.outside.knots
    for i in range(profile.shape[0]):
        for j in range(profile.shape[1]):
            profile[i, j] = points.profile[p, i, j]
    for i in range(knots.shape[0]):
        for j in range(knots.shape[1]):
            knots[i, j] = points.knots[p, i, j]


@inner()
def _see(twist: Array, v: Array, stiffness: Array, rates: Array, out: Array) -> None:
    """A state whose square is an energy."""
    for e in range(twist.size):
        out[e] = stiffness[e] * twist[e]
    for m in range(rates.shape[0]):
        total = 0.0
        for i in range(v.size):
            total += rates[m, i] * v[i]
        out[twist.size + m] = total


@inner()
def _look(records: Records, stiffness: Array, room: Room, count: int) -> int:
    """What a block has recorded as points from ``count`` on, and the views of its last two periods; points then."""
    for k in range(LOOKED_AT):
        view = k - (BLOCK - 2)
        out = room.points[count] if view < 0 else room.views[view]
        _see(records.connection[0, k], records.motion[1, k], stiffness, room.rates, out)
        if view >= 0 and (view + 1) % VIEWS == 0:
            for i in range(out.size):
                room.points[count, i] = out[i]
        if view < 0 or (view + 1) % VIEWS == 0:
            count += 1
    return count


@inner()
def _size(views: Array, mean: Array) -> float:
    """The farthest of the views from their ``mean``, which is worked out here."""
    for i in range(views.shape[1]):
        mean[i] = 0.0
        for k in range(views.shape[0]):
            mean[i] += views[k, i] / views.shape[0]
    most = 0.0
    for k in range(views.shape[0]):
        total = 0.0
        for i in range(views.shape[1]):
            total += (views[k, i] - mean[i]) ** 2
        if not total <= most:
            most = total
    return math.sqrt(most)


@inner()
def _moments(at: IntArray, steps: int) -> int:
    """The steps of a block that are recorded, and how many they are."""
    for k in range(BLOCK - 2):
        at[k] = (k + 1) * steps
    for k in range(2 * VIEWS):
        at[BLOCK - 2 + k] = (BLOCK - 2) * steps + (k + 1) * (steps // VIEWS)
    return LOOKED_AT


@inner()
def _every(at: IntArray, steps: int) -> int:
    """The same for one period that is recorded whole."""
    for k in range(steps + 1):
        at[k] = k
    return steps + 1


@inner()
def _edge(records: Records, k: int, out: Array) -> None:
    n = records.motion.shape[2]
    for j in range(n):
        out[j] = records.motion[0, k, j]
    for j in range(out.size - n):
        out[n + j] = records.connection[1, k, j]


@inner()
def _sum(records: Records, steps: int, first: int, parts: int, sums: Array, edges: Array) -> None:
    """Samples of one period, the ``first`` of them counted from the start, into the sums of all orders."""
    n, width = records.motion.shape[2], sums.shape[2]
    for k in range(steps):
        turn = 2.0 * math.pi * ((first + k) % (parts * steps)) / (parts * steps)
        for i in range(sums.shape[1]):
            real, imaginary = math.cos(i * turn), -math.sin(i * turn)
            for j in range(n):
                sums[0, i, j] += real * records.motion[0, k, j]
                sums[1, i, j] += imaginary * records.motion[0, k, j]
            for j in range(width - n):
                sums[0, i, n + j] += real * records.connection[1, k, j]
                sums[1, i, n + j] += imaginary * records.connection[1, k, j]
    for end in range(1 if first else 0, 2):
        _edge(records, end * steps, edges[end])


@inner()
def _ending(state: State, told: Told, p: int) -> None:
    """Where the point's run stands, and what it has booked."""
    for i in range(state.coordinates.shape[1]):
        told.end[p, 0, i], told.end[p, 1, i] = state.coordinates[Q, i], state.coordinates[V, i]
    for l in range(state.law.shape[1]):
        told.memory[p, l] = state.law[MEMORY, l]
    for i in range(state.ledger.size):
        told.ledger[p, i] = state.ledger[i]
    for e in range(state.connection.shape[1]):
        for row in range(MADE, LOST + 1):
            told.passed[p, row - MADE, e] = state.connection[row, e]
    told.figures[p, TURNED] = state.reference[TURNING]


@uncounted(nogil=True)
def settled_points(
    plan: Plan,
    state: State,
    w: Work,
    settings: Settings,
    method: tuple[float, float, float, float],
    points: Points,
    limits: Limits,
    room: Room,
    told: Told,
    first: int,
) -> int:
    """Points from the ``first`` on, from the coordinates, rates and memories of the state; the first that is left, the
    number of points when none is.  ``plan``, ``state``, ``w`` and ``room`` are changed."""
    at, records = room.at, room.records
    for p in range(first, points.step.size):
        h, steps, stiffness = points.step[p], points.steps[p], points.stiffness[p]
        _lay(plan, points, p)
        restart(plan, state, w, room.mobility, h)
        _see(state.connection[TWIST], state.coordinates[V], stiffness, room.rates, room.points[0])
        count, k, left, size, n, total = 1, 0, np.inf, 0.0, 0, limits.parts
        while n < total:
            if k == 0 and limits.blocks * BLOCK < count + BLOCK - 1:
                told.counts[p, HOW] = _Ended.RESTLESS
                return p
            wanted = _every(at, steps) if k else _moments(at, steps)
            # called in one place, since its code comes with every call
            status = run(plan, state, w, settings, method, h, steps if k else BLOCK * steps, at[:wanted], records)
            if status != 0:
                told.counts[p, HOW] = status
                return p
            if k:
                _sum(records, steps, n * steps, limits.parts, told.sums[p], told.edges[p])
                n += 1
                continue
            count = _look(records, stiffness, room, count)
            size = _size(room.views, room.points[count])
            k, left = repeats(room.points[:count], size, limits.longest, limits.tolerance)
            if k > 1 and limits.tolerance < gap_between(room.points[:count], size, limits.longest, 1) < LITTLE:
                told.counts[p, HOW] = _Ended.FINER
                return p
            while k and total % k:
                total += limits.parts
        _ending(state, told, p)
        told.figures[p, LEFT_OVER], told.figures[p, SIZE] = left, size
        told.counts[p, PERIODS], told.counts[p, TAKEN], told.counts[p, HOW] = k, count - 1, 0
    return points.step.size
