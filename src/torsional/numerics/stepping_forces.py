"""Torques of connections in one time step, their tangents, and whether hinges and laws agree with the motion.

With φ⁺ = φ_p + βh² w·δ and φ̇⁺ = φ̇_p + γh w·δ, where δ is what the solution adds to a, the torque of springs, closed
hinges and dampers T = k φ + c φ̇ − shift grows by (βh² k + γh c) w·δ: its share of the step matrix.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.stepping_plan import Constants, HingeRows, Laws, Loads, Pairs
from torsional.numerics.uncounted import inlined, uncounted

ROUNDING = 1e-15
"""Share of a hinge's angle by which it may be on the wrong side: all that rounding leaves to tell."""
TRUSTED = 4
"""Passes for which the tangent of a law is believed; from then on it is one that cannot overshoot."""


class Connections(NamedTuple):
    """Connections (E,) while a step is sought: where they are, and their tangents; ``share`` of the step matrix with
    and ``step`` without their laws; ``offset`` of the rate by rotations; ``moved`` w·δ of the last pass."""

    twist: Array
    rate: Array
    torque: Array
    offset: Array
    moved: Array
    stiffness: Array
    damping: Array
    shift: Array
    step: Array
    share: Array


class Bent(NamedTuple):
    """Hinges (H,): ``facing`` = side where closed, −side where open, and contact times under the guard.  Laws (L,):
    ``torque``, ``memory`` after the step, normal ``load``, share ``slope`` of the step matrix and that of it which is
    in the matrix, ``drag`` at rates beside the mean one; ``values`` with the loads of now."""

    facing: Array
    contact_time: Array
    torque: Array
    memory: Array
    load: Array
    slope: Array
    built: Array
    drag: Array
    values: Array


@inlined()
def gather(pairs: Pairs, x: Array, out: Array) -> None:
    """w_e·x into ``out`` (E,)."""
    for e in range(out.size):
        out[e] = pairs.first[e] * x[pairs.left[e]] + pairs.second[e] * x[pairs.right[e]]
    for k in range(pairs.extra_row.size):
        out[pairs.extra_row[k]] += pairs.extra_weight[k] * x[pairs.extra_column[k]]


@inlined()
def scatter(pairs: Pairs, torque: Array, x: Array) -> None:
    """x ← x − Σ w_e T_e."""
    for e in range(torque.size):
        x[pairs.left[e]] -= pairs.first[e] * torque[e]
        x[pairs.right[e]] -= pairs.second[e] * torque[e]
    for k in range(pairs.extra_row.size):
        x[pairs.extra_column[k]] -= pairs.extra_weight[k] * torque[pairs.extra_row[k]]


@inlined()
def scatter_one(pairs: Pairs, e: int, torque: float, x: Array) -> None:
    """x ← x − w_e T for one connection."""
    x[pairs.left[e]] -= pairs.first[e] * torque
    x[pairs.right[e]] -= pairs.second[e] * torque
    for k in range(pairs.extra_row.size):
        if pairs.extra_row[k] == e:
            x[pairs.extra_column[k]] -= pairs.extra_weight[k] * torque


@inlined()
def torques(now: Connections) -> None:
    """T = k φ + c φ̇ − shift."""
    for e in range(now.torque.size):
        now.torque[e] = now.stiffness[e] * now.twist[e] + now.damping[e] * now.rate[e] - now.shift[e]


@inlined()
def advance(now: Connections, by_angle: float, by_rate: float) -> None:
    """Twists, rates and torques after δ, of which ``moved`` is w·δ."""
    for e in range(now.twist.size):
        now.twist[e] += by_angle * now.moved[e]
        now.rate[e] += by_rate * now.moved[e]
        now.torque[e] += now.step[e] * now.moved[e]


@uncounted()
def tangents(
    constants: Constants,
    hinges: HingeRows,
    now: Connections,
    bent: Bent,
    squared: float,
    by_angle: float,
    by_rate: float,
) -> None:
    """Tangents of all connections for the hinges that are closed, at Ω² = ``squared``."""
    for e in range(now.stiffness.size):
        now.stiffness[e] = constants.stiffness[e] + squared * constants.centrifugal[e]
        now.damping[e] = constants.damping[e]
        now.shift[e] = 0.0
    for i in range(hinges.of.size):
        if bent.facing[i] * hinges.side[i] > 0.0:
            e, change = hinges.of[i], hinges.change[i]
            now.stiffness[e] += change
            now.damping[e] += change * bent.contact_time[i]
            now.shift[e] += change * hinges.gap[i]
    for e in range(now.step.size):
        now.step[e] = by_angle * now.stiffness[e] + by_rate * now.damping[e]


@inlined()
def disagreeing(hinges: HingeRows, bent: Bent, now: Connections) -> int:
    """Hinges that are open where they should be closed, or closed where open."""
    count = 0
    for i in range(hinges.of.size):
        e = hinges.of[i]
        beyond = now.twist[e] - hinges.gap[i] + bent.contact_time[i] * now.rate[e]
        count += bent.facing[i] * beyond < -ROUNDING * (abs(hinges.gap[i]) + abs(now.twist[e]))
    return count


@uncounted()
def turn(hinges: HingeRows, bent: Bent, now: Connections, one: bool) -> None:
    """Open or close the hinges that disagree; all of them, or the last ``one`` alone."""
    for k in range(hinges.of.size):
        i = hinges.of.size - 1 - k
        e = hinges.of[i]
        beyond = now.twist[e] - hinges.gap[i] + bent.contact_time[i] * now.rate[e]
        if bent.facing[i] * beyond < -ROUNDING * (abs(hinges.gap[i]) + abs(now.twist[e])):
            bent.facing[i] = -bent.facing[i]
            if one:
                return


@uncounted()
def press(loads: Loads, laws: Laws, now: Connections, bent: Bent, squared: float, levels: Array) -> None:
    """Normal loads N of the laws that have one, from Ω² = ``squared`` and the torques of now."""
    for l in range(laws.of.size):
        if laws.load_at[l] < 0:
            continue
        e = laws.of[l]
        total = loads.constant[e] * levels[l] + loads.centrifugal[e] * squared
        for k in range(loads.start[e], loads.start[e + 1]):
            total += loads.share[k] * abs(now.torque[loads.of[k]])
        bent.load[l] = max(0.0, total)
        bent.values[laws.load_at[l]] = bent.load[l]


@uncounted()
def bend(
    laws: Laws, now: Connections, bent: Bent, before: Array, memory: Array, h: float, steps: tuple[float, float], n: int
) -> float:
    """Torques and tangents of the laws at the motion of now; how far the torques were off what was expected [Nm].

    ``before`` (4, E) and ``memory`` (L,) are those at the step's begin, ``steps`` βh², γh, n the pass.  A law with
    memory moves at the mean rate of the step, which is φ⁺ − φ over h; what it lacks at the end is ``drag`` times the
    rate beside the mean.
    """
    worst = 0.0
    by_angle, by_rate = steps[0], steps[1]
    for l in range(laws.of.size):
        e, torque = laws.of[l], law_at(laws.address[l])
        values = bent.values[laws.start[l] : laws.stop[l]]
        rate, mean, weight, drag = now.rate[e], now.rate[e], by_rate, 0.0
        if laws.remembers[l]:
            mean = (now.twist[e] - before[0, e]) / h + 0.5 * (now.offset[e] + before[3, e])
            weight, drag = by_angle / h, bent.drag[l]
        told = torque(values, now.twist[e], mean, memory[l], h)
        rise = told[2]
        if rise < 0.0 or n >= TRUSTED:
            rise = max(rise, _chord(laws, l, values, now.twist[e], mean, memory[l], h, told[0], told[3]))
        drag *= min(max(told[7], 0.0), 1.0)  # a bristle that has slid on through the step has no rate of its own left
        found = told[0] + drag * (rate - mean)
        worst = max(worst, abs(found - bent.torque[l]))
        bent.torque[l], bent.memory[l] = found, told[4]
        bent.slope[l] = by_angle * max(told[1], 0.0) + weight * rise + drag * (by_rate - weight)
    return worst


@uncounted()
def _chord(
    laws: Laws, l: int, values: Array, twist: float, mean: float, memory: float, h: float, found: float, fades: float
) -> float:
    """∂T/∂u where a(u) is held at the last rate, or for a law without memory the chord from rest: not negative."""
    if mean == 0.0:
        return 0.0
    rest = fades * memory
    if not laws.remembers[l]:
        torque = law_at(laws.address[l])
        rest = torque(values, twist, 0.0, memory, h)[0]
    return max(0.0, (found - rest) / mean)


@uncounted()
def drags(laws: Laws, bent: Bent, before: Array, memory: Array) -> None:
    """∂T/∂u at the step's begin with the memory held."""
    for l in range(laws.of.size):
        bent.drag[l] = 0.0
        if laws.remembers[l]:
            e, torque = laws.of[l], law_at(laws.address[l])
            values = bent.values[laws.start[l] : laws.stop[l]]
            bent.drag[l] = max(0.0, torque(values, before[0, e], before[1, e], memory[l], 0.0)[2])
