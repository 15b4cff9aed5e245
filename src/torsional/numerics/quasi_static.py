"""Torques while one angle is moved slowly: no inertia, friction that remembers, springs that only push; compiled.

The last coordinate is moved, the others find their balance at the end of every step,

    Σ_e w_e [k_e φ_e + c_e φ̇_e + F_e(φ_e, φ̇_e, memory_e)] = 0,   φ̇ = Δφ/Δt,

by Newton's method in them (an active set for hinges), memories by the laws' own kernels: backward Euler.  Everything
reads the arrays of `torsional.numerics.stepping_data`; levels over time count as one, the reference turns steadily.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import Any, NamedTuple

import numba
import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.small_linear import backsolve, factor
from torsional.numerics.sources import row_product
from torsional.numerics.stepping_data import Connected

ITERATIONS = 60
CUTS = 25
"""Places that are tried along one Newton step."""
LEAST = 2.0**-20
"""Share of a step below which no shorter one is tried."""
QUICK = 1e-5
"""Time [s] below which no step is shortened for the sake of a jump."""
NEAR = 1e-10
"""What may be left of the balance, over the largest torque."""
ROUNDING = 4 * 2.0**-52
ENOUGH = 0.5
"""A whole Newton step is taken where the unbalanced torque along it falls to this."""


class Work(NamedTuple):
    """What one evaluation leaves behind, a value a connection, and the equations of the coordinates that are free.

    ``hold`` [Nm/rad]: a spring to the place before the step, so weak that it only keeps what is free from drifting;
    ``reach`` [rad]: the largest angles to be expected, which tell what rounding leaves, and by how much a step may
    miss where the pace of the last would have led; ``pace`` [rad/s] of the free coordinates.
    """

    angle: Array
    spring: Array
    spring_slope: Array
    torque: Array
    slope: Array
    load: Array
    load_slope: Array
    memory: Array
    law_values: Array
    rest: Array
    tangent: Array
    order: IntArray
    move: Array
    hold: Array
    reach: Array
    pace: Array


def work_for(connected: Connected, coordinates: int, reach: float, miss: float) -> Work:
    """Room for a march over ``coordinates`` (the moved one among them) up to an angle of ``reach`` [rad].

    ``miss`` [rad]: how far a step may miss where the pace of the one before would have led, before it is shortened.
    """
    count, free = len(connected.stiffness), coordinates - 1
    stiffest = connected.stiffness.max(initial=0.0) + np.abs(connected.change).max(initial=0.0)
    square = np.zeros((free, free)), np.zeros(free, dtype=np.int64)
    ends = np.zeros(free), np.array([1e-12 * stiffest]), np.array([reach, miss]), np.zeros(free)
    values = [np.zeros(count) for _ in range(8)]
    given: tuple[Any, ...] = (*values, connected.law_values.copy(), np.zeros(free), *square, *ends)
    return Work(*given)


@numba.njit(cache=True, error_model="numpy")
def _spring(c: Connected, e: int, square: float, rate: float, step: float, w: Work) -> None:
    """Torque and slope of spring, hinges and damper of one connection at its angle."""
    angle = w.angle[e]
    stiffness = c.stiffness[e] + square * c.centrifugal[e]
    torque, slope = stiffness * angle + c.damping[e] * rate, stiffness + c.damping[e] / step
    for h in range(c.hinge_start[e], c.hinge_start[e + 1]):
        side, change, delay = c.side[h], c.change[h], c.contact_time[h]
        beyond = side * (angle - c.gap[h] + delay * rate)
        if beyond > 0.0:
            torque += side * change * beyond
            slope += change * (1.0 + delay / step)
    w.spring[e], w.spring_slope[e] = torque, slope


@numba.njit(cache=True, error_model="numpy")
def _load(c: Connected, e: int, square: float, w: Work) -> float:
    """The normal load of one connection under the springs' torques."""
    load = c.load_constant[e] + square * c.load_centrifugal[e]
    for k in range(c.load_start[e], c.load_start[e + 1]):
        load += c.load_share[k] * abs(w.spring[c.load_of[k]])
    return float(max(0.0, load))


@numba.njit(cache=True, error_model="numpy")
def _law(c: Connected, e: int, square: float, rate: float, memory: float, step: float, w: Work) -> None:
    """Adds the law of one connection; its torque is a straight line in the normal load, whose slope is a chord's."""
    told_by = law_at(c.address[e])
    values = w.law_values[c.law_start[e] : c.law_start[e + 1]]
    place = c.load_place[e]
    if place >= 0:
        w.load[e] = _load(c, e, square, w)
        more = max(w.load[e], 1.0)
        values[place] = w.load[e] + more
        w.load_slope[e] = told_by(values, w.angle[e], rate, memory, step)[0]
        values[place] = w.load[e]
    told = told_by(values, w.angle[e], rate, memory, step)
    w.torque[e] += told[0]
    w.slope[e] += told[1] + told[2] / step
    w.memory[e] = told[4]
    if place >= 0:
        w.load_slope[e] = (w.load_slope[e] - told[0]) / more


@numba.njit(cache=True, error_model="numpy")
def evaluate(c: Connected, square: float, old: Array, place: Array, memory: Array, step: float, w: Work) -> None:
    """Torques and slopes of all connections at ``place``, reached from ``old`` within ``step`` [s]; ``square`` is Ω².

    ``old``, ``place`` (coordinates,), ``memory`` (E,) before the step.
    """
    for e in range(c.stiffness.size):
        w.angle[e] = row_product(c.rows, e, place)
        _spring(c, e, square, (w.angle[e] - row_product(c.rows, e, old)) / step, step, w)
        w.torque[e], w.slope[e] = w.spring[e], w.spring_slope[e]
    for e in range(c.stiffness.size):
        if c.address[e] != 0:
            _law(c, e, square, (w.angle[e] - row_product(c.rows, e, old)) / step, memory[e], step, w)


@numba.njit(cache=True, error_model="numpy")
def unbalanced(c: Connected, old: Array, place: Array, w: Work) -> bool:
    """What is left of the balance of every free coordinate; whether it is next to nothing."""
    free = w.rest.size
    for i in range(free):
        w.rest[i] = w.hold[0] * (place[i] - old[i])
    largest, rounding = 0.0, 0.0
    for e in range(c.stiffness.size):
        largest = max(largest, abs(w.torque[e]))
        rounding = max(rounding, w.slope[e] * max(abs(w.angle[e]), w.reach[0]))
        for k in range(c.rows.start[e], c.rows.start[e + 1]):
            if c.rows.column[k] < free:
                w.rest[c.rows.column[k]] += c.rows.weight[k] * w.torque[e]
    left = 0.0
    for i in range(free):
        left = max(left, abs(w.rest[i]))
    return bool(left <= NEAR * largest + ROUNDING * rounding)


@numba.njit(cache=True, error_model="numpy")
def _add(c: Connected, e: int, j: int, slope: float, w: Work) -> None:
    """Adds w_e w_jᵀ times a slope to the tangent."""
    free = w.rest.size
    for k in range(c.rows.start[e], c.rows.start[e + 1]):
        row = c.rows.column[k]
        if row < free:
            for m in range(c.rows.start[j], c.rows.start[j + 1]):
                column = c.rows.column[m]
                if column < free:
                    w.tangent[row, column] += slope * c.rows.weight[k] * c.rows.weight[m]


@numba.njit(cache=True, error_model="numpy")
def _newton_step(c: Connected, w: Work) -> bool:
    """The Newton step into ``move``; whether there is one."""
    w.tangent[:] = 0.0
    for e in range(c.stiffness.size):
        _add(c, e, e, w.slope[e], w)
        if c.load_place[e] >= 0 and w.load[e] > 0.0:
            for k in range(c.load_start[e], c.load_start[e + 1]):
                j = c.load_of[k]
                side = 1.0 if w.spring[j] > 0.0 else -1.0
                _add(c, e, j, w.load_slope[e] * c.load_share[k] * side * w.spring_slope[j], w)
    for i in range(w.rest.size):
        w.tangent[i, i] += w.hold[0]
        w.move[i] = -w.rest[i]
    if factor(w.tangent, w.order) == 0.0:
        return False
    backsolve(w.tangent, w.order, w.move)
    return True


@numba.njit(cache=True, error_model="numpy")
def _power(w: Work) -> float:
    """The unbalanced torque along the Newton step: negative before the balance, positive beyond it."""
    return float(np.dot(w.rest, w.move))


@numba.njit(cache=True, error_model="numpy")
def settle(c: Connected, square: float, old: Array, place: Array, memory: Array, step: float, w: Work) -> bool:
    """Moves the free coordinates of ``place`` to their balance at the end of a step; whether they found it.

    Springs and dry friction have a convex potential: the Newton step is cut where the unbalanced torque along it
    changes its sign, which is the lowest place along it.
    """
    evaluate(c, square, old, place, memory, step, w)
    free = w.rest.size
    for _ in range(ITERATIONS):
        if unbalanced(c, old, place, w):
            return True
        if not _newton_step(c, w):
            return False
        before = _power(w)
        low, high, gone, chosen = 0.0, 1.0, 0.0, 1.0
        for _ in range(CUTS):
            for i in range(free):
                place[i] += (chosen - gone) * w.move[i]
            gone = chosen
            evaluate(c, square, old, place, memory, step, w)
            unbalanced(c, old, place, w)
            now = _power(w)
            if not before < 0.0 or abs(now) <= ENOUGH * abs(before) or high - low < 1e-9:
                break
            if now > 0.0:
                high = chosen
            elif chosen == 1.0:
                break
            else:
                low = chosen
            chosen = 0.5 * (low + high)
    return False


@numba.njit(cache=True, error_model="numpy")
def _coarse(old: Array, place: Array, step: float, w: Work) -> bool:
    """Whether free coordinates went far from where their pace would have taken them, in a step that may be cut."""
    largest = 0.0
    for i in range(old.size - 1):
        largest = max(largest, abs(place[i] - old[i] - step * w.pace[i]))
    return step > QUICK and largest > w.reach[1]


@numba.njit(cache=True, error_model="numpy")
def _advance(
    c: Connected, square: float, old: Array, place: Array, memory: Array, drive: float, step: float, w: Work
) -> bool:
    """One step to ``drive`` from ``old``, begun at the pace of the one before, or else from rest."""
    free = w.rest.size
    found = False
    for guess in range(2):
        if not found:
            place[:free] = old[:free] + (1 - guess) * step * w.pace
            place[free] = drive
            found = settle(c, square, old, place, memory, step, w)
    return found


@numba.njit(cache=True, error_model="numpy")
def moved(c: Connected, square: float, place: Array, memory: Array, drive: float, step: float, w: Work) -> int:
    """Moves the last coordinate to ``drive`` within ``step`` [s], in shorter steps where it must be; ``place`` and
    ``memory`` are brought along.  Returns how many of them found no balance.

    Where friction lets go the steps become so short that the speed in between is that which dampers allow: what a
    jump loses then depends on no step.
    """
    free = w.rest.size
    first, done, share, lost = place[free], 0.0, 1.0, 0
    old, rough = place.copy(), False
    while done < 1.0:
        ok = _advance(c, square, old, place, memory, first + (drive - first) * (done + share), share * step, w)
        if not ok and rough:  # a shorter step finds nothing, the longer one did
            share *= 2.0
            ok = _advance(c, square, old, place, memory, first + (drive - first) * (done + share), share * step, w)
        elif share > LEAST and (not ok or _coarse(old, place, share * step, w)):
            rough = ok
            share *= 0.5
            continue
        rough = False
        lost += 0 if ok else 1
        w.pace[:] = (place[:free] - old[:free]) / (share * step)
        old[:] = place
        memory[:] = w.memory
        done += share
        share = min(2.0 * share, 1.0 - done)
    return lost


@numba.njit(cache=True, error_model="numpy")
def march(
    c: Connected,
    square: float,
    place: Array,
    memory: Array,
    drive: Array,
    step: float,
    w: Work,
    places: Array,
    told: Array,
) -> int:
    """Moves the last coordinate along ``drive`` (samples,), ``step`` [s] each; into ``places`` (samples, coordinates)
    and ``told`` (2, samples, E): torques, normal loads.  Returns how many steps found no balance."""
    lost = 0
    for s in range(drive.size):
        lost += moved(c, square, place, memory, drive[s], step, w)
        places[s], told[0, s], told[1, s] = place, w.torque, w.load
    return lost
