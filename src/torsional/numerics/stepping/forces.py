"""Torques of connections in one time step, their tangents, and whether hinges and laws agree with the motion.

With φ⁺ = φ_p + βh² w·δ and φ̇⁺ = φ̇_p + γh w·δ, where δ is what the solution adds to a, the torque of springs, closed
hinges and dampers T = k φ + c φ̇ − shift grows by (βh² k + γh c) w·δ: its share of the step matrix.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import wrongly
from torsional.numerics.motion.data import (
    ADDRESS,
    CENTRIFUGAL,
    CHANGE,
    DAMPER,
    GAP,
    LAW_OF,
    LOAD_AT,
    REMEMBERS,
    SIDE,
    SPRING,
    START,
    STOP,
    HingeRows,
    Laws,
)
from torsional.numerics.motion.normal_load import normal_load
from torsional.numerics.stepping.plan import LEFT, RIGHT, Pairs
from torsional.numerics.stepping.state import LAW_TORQUE, LOAD, MEMORY, OFFSET, RATE, TORQUE, TWIST
from torsional.numerics.uncounted import inner, merged

TRUSTED = 4
"""Passes for which the tangent of a law is believed; from then on it is one that cannot overshoot."""
MOVED, STIFFNESS, DAMPING, SHIFT, STEP, SHARE = range(4, 10)
"""Rows of ``now`` (10, E), the connections while a step is sought, after the first four of `State.connection`.

w·δ of the last pass, tangents and shift with the closed hinges, shares of the step matrix without and with the laws.
"""
CONNECTION_ROWS = 10
FACING, DELAY = range(2)
"""Rows of the hinges while a step is sought: side where closed, −side where open; contact times under the guard."""
SLOPE, BUILT, DRAG, LEVEL = range(3, 7)
"""Rows of the laws, after the first three of `State.law`: share of the step matrix, that of it which is in the matrix,
the tangent at rates beside the mean one, the level that the load follows."""
LAW_ROWS = 7


class Bent(NamedTuple):
    """Hinges (2, H), laws (7, L), and the laws' ``values`` with the loads of now."""

    hinges: Array
    laws: Array
    values: Array


@merged()
def gather(pairs: Pairs, x: Array, out: Array) -> None:
    """w_e·x into ``out`` (E,)."""
    ends, weights = pairs.ends, pairs.weights
    for e in range(out.size):
        out[e] = weights[LEFT, e] * x[ends[LEFT, e]] + weights[RIGHT, e] * x[ends[RIGHT, e]]
    for k in range(pairs.extra.size):
        out[pairs.extra_at[LEFT, k]] += pairs.extra[k] * x[pairs.extra_at[RIGHT, k]]


@merged()
def scatter(pairs: Pairs, torque: Array, x: Array) -> None:
    """x ← x − Σ w_e T_e."""
    ends, weights = pairs.ends, pairs.weights
    for e in range(torque.size):
        x[ends[LEFT, e]] -= weights[LEFT, e] * torque[e]
        x[ends[RIGHT, e]] -= weights[RIGHT, e] * torque[e]
    for k in range(pairs.extra.size):
        x[pairs.extra_at[RIGHT, k]] -= pairs.extra[k] * torque[pairs.extra_at[LEFT, k]]


@merged()
def scatter_one(pairs: Pairs, e: int, torque: float, x: Array) -> None:
    """x ← x − w_e T for one connection."""
    x[pairs.ends[LEFT, e]] -= pairs.weights[LEFT, e] * torque
    x[pairs.ends[RIGHT, e]] -= pairs.weights[RIGHT, e] * torque
    for k in range(pairs.extra.size):
        if pairs.extra_at[LEFT, k] == e:
            x[pairs.extra_at[RIGHT, k]] -= pairs.extra[k] * torque


@merged()
def torques(now: Array) -> None:
    """T = k φ + c φ̇ − shift."""
    for e in range(now.shape[1]):
        now[TORQUE, e] = now[STIFFNESS, e] * now[TWIST, e] + now[DAMPING, e] * now[RATE, e] - now[SHIFT, e]


@merged()
def advance(now: Array, by_angle: float, by_rate: float) -> None:
    """Twists, rates and torques after δ, of which MOVED is w·δ."""
    for e in range(now.shape[1]):
        now[TWIST, e] += by_angle * now[MOVED, e]
        now[RATE, e] += by_rate * now[MOVED, e]
        now[TORQUE, e] += now[STEP, e] * now[MOVED, e]


@inner()
def tangents(
    constants: Array, hinges: HingeRows, now: Array, bent: Array, squared: float, by_angle: float, by_rate: float
) -> None:
    """Tangents of all connections for the hinges ``bent`` that are closed, at Ω² = ``squared``."""
    for e in range(now.shape[1]):
        now[STIFFNESS, e] = constants[SPRING, e] + squared * constants[CENTRIFUGAL, e]
        now[DAMPING, e] = constants[DAMPER, e]
        now[SHIFT, e] = 0.0
    for i in range(hinges.of.size):
        if bent[FACING, i] * hinges.values[SIDE, i] > 0.0:
            e, change = hinges.of[i], hinges.values[CHANGE, i]
            now[STIFFNESS, e] += change
            now[DAMPING, e] += change * bent[DELAY, i]
            now[SHIFT, e] += change * hinges.values[GAP, i]
    for e in range(now.shape[1]):
        now[STEP, e] = by_angle * now[STIFFNESS, e] + by_rate * now[DAMPING, e]


@merged()
def disagreeing(hinges: HingeRows, bent: Array, now: Array) -> int:
    """Hinges that are open where they should be closed, or closed where open."""
    count = 0
    for i in range(hinges.of.size):
        e = hinges.of[i]
        count += wrongly(bent[FACING, i], now[TWIST, e], now[RATE, e], hinges.values[GAP, i], bent[DELAY, i])
    return count


@inner()
def turn(hinges: HingeRows, bent: Array, now: Array, one: bool) -> None:
    """Open or close the hinges that disagree; all of them, or the last ``one`` alone."""
    for k in range(hinges.of.size):
        i = hinges.of.size - 1 - k
        e = hinges.of[i]
        if wrongly(bent[FACING, i], now[TWIST, e], now[RATE, e], hinges.values[GAP, i], bent[DELAY, i]):
            bent[FACING, i] = -bent[FACING, i]
            if one:
                return


@inner()
def press(laws: Laws, now: Array, bent: Bent, squared: float) -> None:
    """Normal loads N of the laws that have one, from Ω² = ``squared`` and the torques of now."""
    places, torque = laws.places, now[TORQUE]
    for l in range(places.shape[1]):
        if places[LOAD_AT, l] >= 0:
            bent.laws[LOAD, l] = normal_load(laws, l, bent.laws[LEVEL, l], squared, torque)
            bent.values[places[LOAD_AT, l]] = bent.laws[LOAD, l]


@inner()
def bend(
    laws: Laws, now: Array, bent: Bent, before: Array, memory: Array, h: float, steps: tuple[float, float], n: int
) -> float:
    """Torques and tangents of the laws at the motion of now; how far the torques were off what was expected [Nm].

    ``before`` (4, E) and ``memory`` (L,) are those at the step's begin, ``steps`` βh², γh, n the pass.  A law with
    memory moves at the mean rate of the step, which is φ⁺ − φ over h; what it lacks at the end is DRAG times the rate
    beside the mean.
    """
    worst, places, own = 0.0, laws.places, bent.laws
    by_angle, by_rate = steps[0], steps[1]
    for l in range(places.shape[1]):
        e, torque = places[LAW_OF, l], law_at(places[ADDRESS, l])
        values, twist = bent.values[places[START, l] : places[STOP, l]], now[TWIST, e]
        rate, mean, weight, drag = now[RATE, e], now[RATE, e], by_rate, 0.0
        if places[REMEMBERS, l]:
            mean = (twist - before[TWIST, e]) / h + 0.5 * (now[OFFSET, e] + before[OFFSET, e])
            weight, drag = by_angle / h, own[DRAG, l]
        told = torque(values, twist, mean, memory[l], h)
        rise = told[2]
        if rise < 0.0 or n >= TRUSTED:
            rise = max(rise, _chord(places, l, values, twist, mean, memory[l], h, told[0], told[3]))
        drag *= min(max(told[7], 0.0), 1.0)  # a bristle that has slid on through the step has no rate of its own left
        found = told[0] + drag * (rate - mean)
        worst = max(worst, abs(found - own[LAW_TORQUE, l]))
        own[LAW_TORQUE, l], own[MEMORY, l] = found, told[4]
        own[SLOPE, l] = by_angle * max(told[1], 0.0) + weight * rise + drag * (by_rate - weight)
    return worst


@inner()
def _chord(
    places: IntArray,
    l: int,
    values: Array,
    twist: float,
    mean: float,
    memory: float,
    h: float,
    found: float,
    fades: float,
) -> float:
    """∂T/∂u where a(u) is held at the last rate, or for a law without memory the chord from rest: not negative."""
    if mean == 0.0:
        return 0.0
    rest = fades * memory
    if not places[REMEMBERS, l]:
        torque = law_at(places[ADDRESS, l])
        rest = torque(values, twist, 0.0, memory, h)[0]
    return max(0.0, (found - rest) / mean)


@inner()
def drags(places: IntArray, bent: Bent, before: Array, memory: Array) -> None:
    """∂T/∂u at the step's begin with the memory held."""
    for l in range(places.shape[1]):
        bent.laws[DRAG, l] = 0.0
        if places[REMEMBERS, l]:
            e, torque = places[LAW_OF, l], law_at(places[ADDRESS, l])
            values = bent.values[places[START, l] : places[STOP, l]]
            bent.laws[DRAG, l] = max(0.0, torque(values, before[TWIST, e], before[RATE, e], memory[l], 0.0)[2])
