"""What drives a time step, in compiled code: the frame, levels, profiles over crank angle, moving pistons, governors.

Everything reads the tables of `torsional.numerics.motion.tables`.
"""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.crank_kinematics import piston_ratios
from torsional.numerics.motion.data import Rows
from torsional.numerics.motion.pendulum_path import pendulum_terms, weight_terms
from torsional.numerics.motion.tables import (
    CRANK_INCLUDED,
    CRANK_MASS,
    CRANK_MULTIPLE,
    CRANK_OFFSET,
    CRANK_PHASE,
    CRANK_RADIUS,
    CRANK_ROD,
    FEEDBACK,
    HIGH,
    INTEGRAL,
    LEAK_SOURCE,
    LEVEL_OF,
    LOW,
    MULTIPLE,
    PERIOD,
    PHASE,
    PROFILE_START,
    PROFILE_STOP,
    PROPORTIONAL,
    SOURCE_START,
    SOURCE_STOP,
    TIME,
    VALUE,
    WANTED_OF,
    Outside,
)
from torsional.numerics.uncounted import inner, merged, uncounted

TURN = 2.0 * np.pi

_piston = uncounted()(piston_ratios)


@uncounted()
def row_product(rows: Rows, i: int, x: Array) -> float:
    """Row i times the coordinates x (N,)."""
    total = 0.0
    for k in range(rows.start[i], rows.start[i + 1]):
        total += rows.weight[k] * x[rows.column[k]]
    return total


@uncounted()
def _row_sum(rows: Rows, i: int) -> float:
    """Row i times the rigid rotation, the vector of ones."""
    total = 0.0
    for k in range(rows.start[i], rows.start[i + 1]):
        total += rows.weight[k]
    return total


@inner()
def _last_knot(knots: Array, first: int, last: int, t: float) -> int:
    """The last knot k in [first, last) with time ≤ t, or first − 1."""
    low, high = first, last
    while low < high:
        middle = (low + high) // 2
        if knots[TIME, middle] <= t:
            low = middle + 1
        else:
            high = middle
    return low - 1


@inner()
def _linear(knots: Array, first: int, last: int, t: float) -> float:
    """Linear between knots, constant beyond; of two knots at one time the second counts from there on."""
    k = _last_knot(knots, first, last, t)
    if k < first:
        return knots[VALUE, first]
    if k == last - 1:
        return knots[VALUE, k]
    low, high, begun = knots[VALUE, k], knots[VALUE, k + 1], knots[TIME, k]
    return low + (high - low) * (t - begun) / (knots[TIME, k + 1] - begun)


@uncounted()
def level_at(level_start: IntArray, knots: Array, p: int, t: float) -> float:
    """Level p of `Outside` at time t [s]; p = −1 is one.  A jump is two knots at one time."""
    if p < 0:
        return 1.0
    return _linear(knots, level_start[p], level_start[p + 1], t)


@inner()
def _swept(knots: Array, first: int, t: float) -> float:
    """Integral of the linear pieces from the knot ``first`` to t."""
    count = knots.shape[1]
    last = _last_knot(knots, first, count, t)
    if last < first:
        return knots[VALUE, first] * (t - knots[TIME, first])
    total = 0.0
    for k in range(first, last):
        total += 0.5 * (knots[VALUE, k] + knots[VALUE, k + 1]) * (knots[TIME, k + 1] - knots[TIME, k])
    return total + 0.5 * (knots[VALUE, last] + _linear(knots, first, count, t)) * (t - knots[TIME, last])


@uncounted()
def frame_at(knots: Array, frame: int, t: float) -> tuple[float, float]:
    """The frame's speed [rad/s], whose knots go from ``frame`` on, and its angle φ_f = ∫ speed dt [rad], exactly, zero
    at t = 0 [s]."""
    speed = _linear(knots, frame, knots.shape[1], t)
    return speed, _swept(knots, frame, t) - _swept(knots, frame, 0.0)


@uncounted()
def profile_at(profile: Array, first: int, last: int, period: float, angle: float) -> float:
    """The profile of the pieces ``first`` to ``last`` and a period [turns], at an angle [rad]."""
    count = last - first
    per_angle = count / (TURN * period)
    place = angle * per_angle
    place -= count * np.floor(place / count)
    if not place >= 0.0:  # the motion has grown beyond all numbers
        return place
    i = min(int(place), count - 1)
    x, c = place - i, profile[first + i]
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]))


@merged()
def _source(outside: Outside, s: int, t: float, frame_angle: float, q: Array, extra: Array) -> float:
    """T_s [Nm]."""
    place, multiple, feedback = outside.source_places, outside.sources[MULTIPLE, s], outside.sources[FEEDBACK, s]
    level = level_at(outside.level_start, outside.knots, place[LEVEL_OF, s], t) + extra[s]
    first, last = place[PROFILE_START, s], place[PROFILE_STOP, s]
    if first == last or level == 0.0:
        return level
    angle = multiple * (frame_angle + feedback * row_product(outside.rows, s, q)) + outside.sources[PHASE, s]
    return level * profile_at(outside.profile, first, last, outside.sources[PERIOD, s], angle)


@uncounted()
def source_torques(outside: Outside, t: float, frame_angle: float, q: Array, extra: Array, out: Array) -> None:
    """Torques T_s [Nm] (S,) along the rows r_s into ``out``; ``extra`` (S,) is what governors add to the levels."""
    for s in range(out.size):
        out[s] = _source(outside, s, t, frame_angle, q, extra)


@uncounted()
def crank_terms(
    outside: Outside, frame_angle: float, frame_speed: float, q: Array, v: Array, constant: Array, inertia: Array
) -> None:
    """The torque along each crank row r_m, constant_m − inertia_m r_m·q̈: into arrays [Nm] and [kgm²] (cranks,).

    constant = −m x'(θ) x''(θ) θ̇²,  inertia = m x'(θ)² − included,  θ = multiple φ_f + r_m·q + phase

    Behind the cranks come three rows a pendulum, see `torsional.numerics.motion.data.Driven`.
    """
    cranks, rows = outside.cranks, outside.rows
    for m in range(cranks.shape[1]):
        multiple, mass, row = cranks[CRANK_MULTIPLE, m], cranks[CRANK_MASS, m], outside.crank_row + m
        angle = multiple * frame_angle + row_product(rows, row, q) + cranks[CRANK_PHASE, m]
        rate = multiple * frame_speed + row_product(rows, row, v)
        first, second = _piston(cranks[CRANK_RADIUS, m], cranks[CRANK_ROD, m], cranks[CRANK_OFFSET, m], angle)
        constant[m] = -mass * first * second * rate * rate
        inertia[m] = mass * first * first - cranks[CRANK_INCLUDED, m]
    if outside.pendulums.size:
        first_row, frame = outside.crank_row + cranks.shape[1], (frame_angle, frame_speed)
        _pendulums(outside.pendulums, rows, first_row, frame, q, v, constant, inertia)


@inner()
def _pendulums(
    pendulums: Array,
    rows: Rows,
    row: int,
    frame: tuple[float, float],
    q: Array,
    v: Array,
    constant: Array,
    inertia: Array,
) -> None:
    """Torque and inertia of each pendulum along the rows of θ, s and θ + s, beyond the mass m c² (θ̇ + ṡ/c)².

    δM = m (R² − c²) θ̈² + 2 m (G − c) θ̈ s̈ as squares: a − b on θ, −b on s, b on θ + s.
    """
    ahead = constant.size - 3 * pendulums.shape[0]
    for p in range(pendulums.shape[0]):
        mass, distance, radius = pendulums[p, 0], pendulums[p, 1], pendulums[p, 2]
        flattening, place, multiple, gravity = (
            pendulums[p, 3],
            pendulums[p, 4],
            pendulums[p, 5],
            pendulums[p, 6],
        )
        m, r = ahead + 3 * p, row + 3 * p
        arc, rate = row_product(rows, r + 1, q), row_product(rows, r + 1, v)
        turning = multiple * frame[1] + row_product(rows, r, v)
        angle = multiple * frame[0] + row_product(rows, r, q) + place
        squared, lever, on_carrier, along = pendulum_terms(radius, flattening, distance, arc, rate, turning)
        heavy, falls = weight_terms(radius, flattening, distance, arc, angle, gravity)
        both = mass * (lever - distance)
        constant[m], constant[m + 1], constant[m + 2] = mass * (heavy - on_carrier), mass * (falls - along), 0.0
        inertia[m], inertia[m + 1], inertia[m + 2] = mass * (squared - distance * distance) - both, -both, both


@uncounted()
def governed_torque(governors: Array, g: int, error: float, integral: float) -> tuple[float, float]:
    """T_g = clip(k_p e + I, low, high) [Nm] and dI/dt = k_i e; I waits while it would push past a limit."""
    wanted, low, high = governors[PROPORTIONAL, g] * error + integral, governors[LOW, g], governors[HIGH, g]
    growth = governors[INTEGRAL, g] * error
    if (wanted > high and growth > 0.0) or (wanted < low and growth < 0.0):
        growth = 0.0
    return min(max(wanted, low), high), growth


@uncounted()
def governor_error(outside: Outside, g: int, t: float, frame_speed: float, v: Array) -> float:
    """What the speed that governor g senses lacks of the one that it wants [rad/s]."""
    wanted = level_at(outside.level_start, outside.knots, outside.governor_places[WANTED_OF, g], t)
    row = outside.sense + g
    return wanted - (row_product(outside.rows, row, v) + frame_speed * _row_sum(outside.rows, row))


@uncounted()
def govern(
    outside: Outside, t: float, step: float, frame_speed: float, v: Array, integral: Array, torque: Array, extra: Array
) -> None:
    """Governors at the beginning t of a step [s]: ``torque`` (G,) that they hold over it, ``extra`` (S,) of sources.

    ``integral`` (G,) [Nm] is advanced in place by k_i e step; with a step of zero it stays.
    """
    extra[:] = 0.0
    places = outside.governor_places
    own = torque.size - outside.leaks.shape[1]
    for g in range(own):
        error = governor_error(outside, g, t, frame_speed, v)
        torque[g], growth = governed_torque(outside.governors, g, error, integral[g])
        integral[g] += step * growth
        for k in range(places[SOURCE_START, g], places[SOURCE_STOP, g]):
            extra[outside.governed[k]] += torque[g]
    for k in range(outside.leaks.shape[1]):
        extra[int(outside.leaks[LEAK_SOURCE, k])] = integral[own + k]
