"""What drives a time step, in compiled code: the frame, levels, profiles over crank angle, moving pistons, governors.

Everything reads the arrays of `torsional.numerics.stepping_data`.
"""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.crank_kinematics import piston_ratios
from torsional.numerics.pendulum_path import pendulum_terms, weight_terms
from torsional.numerics.stepping_data import Driven, Governed, Rows
from torsional.numerics.uncounted import uncounted

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
def row_sum(rows: Rows, i: int) -> float:
    """Row i times the rigid rotation, the vector of ones."""
    total = 0.0
    for k in range(rows.start[i], rows.start[i + 1]):
        total += rows.weight[k]
    return total


@uncounted()
def _last_knot(time: Array, first: int, last: int, t: float) -> int:
    """The last knot k in [first, last) with time[k] ≤ t, or first − 1."""
    low, high = first, last
    while low < high:
        middle = (low + high) // 2
        if time[middle] <= t:
            low = middle + 1
        else:
            high = middle
    return low - 1


@uncounted()
def _linear(time: Array, value: Array, first: int, last: int, t: float) -> float:
    """Linear between knots, constant beyond; of two knots at one time the second counts from there on."""
    k = _last_knot(time, first, last, t)
    if k < first:
        return value[first]
    if k == last - 1:
        return value[k]
    return value[k] + (value[k + 1] - value[k]) * (t - time[k]) / (time[k + 1] - time[k])


@uncounted()
def level_at(level_start: IntArray, level_time: Array, level_value: Array, p: int, t: float) -> float:
    """Level p of `Driven` at time t [s]; p = −1 is one.  A jump is two knots at one time."""
    if p < 0:
        return 1.0
    return _linear(level_time, level_value, level_start[p], level_start[p + 1], t)


@uncounted()
def _swept(time: Array, value: Array, t: float) -> float:
    """Integral of the linear pieces from the first knot to t."""
    last = _last_knot(time, 0, time.size, t)
    if last < 0:
        return value[0] * (t - time[0])
    total = 0.0
    for k in range(last):
        total += 0.5 * (value[k] + value[k + 1]) * (time[k + 1] - time[k])
    return total + 0.5 * (value[last] + _linear(time, value, 0, time.size, t)) * (t - time[last])


@uncounted()
def frame_at(frame_time: Array, frame_value: Array, t: float) -> tuple[float, float]:
    """The frame's speed [rad/s] and its angle φ_f = ∫ speed dt [rad], exactly, zero at t = 0 [s]."""
    speed = _linear(frame_time, frame_value, 0, frame_time.size, t)
    return speed, _swept(frame_time, frame_value, t) - _swept(frame_time, frame_value, 0.0)


@uncounted()
def profile_at(driven: Driven, p: int, angle: float) -> tuple[float, float]:
    """Profile p of `Driven` at an angle [rad] and its slope by it; p = −1 is one."""
    if p < 0:
        return 1.0, 0.0
    first = driven.profile_start[p]
    count = driven.profile_start[p + 1] - first
    per_angle = count / (TURN * driven.period[p])
    place = angle * per_angle
    place -= count * np.floor(place / count)
    if not place >= 0.0:  # the motion has grown beyond all numbers
        return place, place
    i = min(int(place), count - 1)
    x, c = place - i, driven.profile[first + i]
    slope = c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])
    return c[0] + x * (c[1] + x * (c[2] + x * c[3])), slope * per_angle


@uncounted()
def _source(driven: Driven, s: int, t: float, frame_angle: float, q: Array, extra: Array) -> tuple[float, float]:
    """T_s and its slope by r_s·q."""
    level = level_at(driven.level_start, driven.level_time, driven.level_value, driven.level_of[s], t) + extra[s]
    if driven.profile_of[s] < 0:
        return level, 0.0
    angle = frame_angle + driven.feedback[s] * row_product(driven.rows, s, q)
    value, slope = profile_at(driven, driven.profile_of[s], driven.multiple[s] * angle + driven.phase[s])
    return level * value, level * slope * driven.multiple[s] * driven.feedback[s]


@uncounted()
def source_torques(driven: Driven, t: float, frame_angle: float, q: Array, extra: Array, out: Array) -> None:
    """Torques T_s [Nm] (S,) along the rows r_s into ``out``; ``extra`` (S,) is what governors add to the levels."""
    for s in range(out.size):
        out[s] = _source(driven, s, t, frame_angle, q, extra)[0]


@uncounted()
def source_slopes(driven: Driven, t: float, frame_angle: float, q: Array, extra: Array, out: Array) -> None:
    """∂T_s/∂(r_s·q) [Nm/rad] (S,) into ``out``: zero but where the part's own motion moves the events."""
    for s in range(out.size):
        out[s] = _source(driven, s, t, frame_angle, q, extra)[1]


@uncounted()
def crank_terms(
    driven: Driven, frame_angle: float, frame_speed: float, q: Array, v: Array, constant: Array, inertia: Array
) -> None:
    """The torque along each crank row r_m, constant_m − inertia_m r_m·q̈: into arrays [Nm] and [kgm²] (cranks,).

    constant = −m x'(θ) x''(θ) θ̇²,  inertia = m x'(θ)² − included,  θ = multiple φ_f + r_m·q + phase

    Behind the cranks come three rows a pendulum, see `Driven`.
    """
    for m in range(driven.crank_mass.size):
        multiple, mass = driven.crank_multiple[m], driven.crank_mass[m]
        angle = multiple * frame_angle + row_product(driven.crank_rows, m, q) + driven.crank_phase[m]
        rate = multiple * frame_speed + row_product(driven.crank_rows, m, v)
        radius, rod, offset = driven.crank_radius[m], driven.crank_rod[m], driven.crank_offset[m]
        first, second = _piston(radius, rod, offset, angle)
        constant[m] = -mass * first * second * rate * rate
        inertia[m] = mass * first * first - driven.crank_included[m]
    if driven.pendulums.size:
        _pendulums(driven, frame_angle, frame_speed, q, v, constant, inertia)


@uncounted()
def _pendulums(
    driven: Driven, frame_angle: float, frame_speed: float, q: Array, v: Array, constant: Array, inertia: Array
) -> None:
    """Torque and inertia of each pendulum along the rows of θ, s and θ + s, beyond the mass m c² (θ̇ + ṡ/c)².

    δM = m (R² − c²) θ̈² + 2 m (G − c) θ̈ s̈ as squares: a − b on θ, −b on s, b on θ + s.
    """
    for p in range(driven.pendulums.shape[0]):
        mass, distance, radius = driven.pendulums[p, 0], driven.pendulums[p, 1], driven.pendulums[p, 2]
        flattening, place, multiple, gravity = (
            driven.pendulums[p, 3],
            driven.pendulums[p, 4],
            driven.pendulums[p, 5],
            driven.pendulums[p, 6],
        )
        m = driven.crank_mass.size + 3 * p
        arc, rate = row_product(driven.crank_rows, m + 1, q), row_product(driven.crank_rows, m + 1, v)
        turning = multiple * frame_speed + row_product(driven.crank_rows, m, v)
        angle = multiple * frame_angle + row_product(driven.crank_rows, m, q) + place
        squared, lever, on_carrier, along = pendulum_terms(radius, flattening, distance, arc, rate, turning)
        heavy, falls = weight_terms(radius, flattening, distance, arc, angle, gravity)
        both = mass * (lever - distance)
        constant[m], constant[m + 1], constant[m + 2] = mass * (heavy - on_carrier), mass * (falls - along), 0.0
        inertia[m], inertia[m + 1], inertia[m + 2] = mass * (squared - distance * distance) - both, -both, both


@uncounted()
def governed_torque(governed: Governed, g: int, error: float, integral: float) -> tuple[float, float]:
    """T_g = clip(k_p e + I, low, high) [Nm] and dI/dt = k_i e; I waits while it would push past a limit."""
    wanted = governed.proportional[g] * error + integral
    growth = governed.integral[g] * error
    if (wanted > governed.high[g] and growth > 0.0) or (wanted < governed.low[g] and growth < 0.0):
        growth = 0.0
    return min(max(wanted, governed.low[g]), governed.high[g]), growth


@uncounted()
def govern(
    governed: Governed,
    driven: Driven,
    t: float,
    step: float,
    frame_speed: float,
    v: Array,
    integral: Array,
    torque: Array,
    extra: Array,
) -> None:
    """Governors at the beginning t of a step [s]: ``torque`` (G,) that they hold over it, ``extra`` (S,) of sources.

    ``integral`` (G,) [Nm] is advanced in place by k_i e step; with a step of zero it stays.
    """
    extra[:] = 0.0
    for g in range(torque.size):
        wanted = level_at(driven.level_start, driven.level_time, driven.level_value, governed.wanted_of[g], t)
        speed = row_product(governed.sense, g, v) + frame_speed * row_sum(governed.sense, g)
        torque[g], growth = governed_torque(governed, g, wanted - speed, integral[g])
        integral[g] += step * growth
        for k in range(governed.source_start[g], governed.source_start[g + 1]):
            extra[governed.source[k]] += torque[g]


def periodic_profile(values: ArrayLike) -> Array:
    """Coefficients (n, 4), as in `Driven.profile`, of the periodic cubic spline through n ≥ 3 evenly spaced samples.

    The samples span one period without its end: sample i lies at i/n of it.  Raises ModelError for too few or values
    that are not finite.

    >>> periodic_profile([1.0, 1.0, 1.0]).tolist()[0]
    [1.0, 0.0, 0.0, 0.0]
    """
    y = np.asarray(values, dtype=float)
    if y.ndim != 1 or y.size < 3 or not np.isfinite(y).all():
        raise ModelError("a profile needs finite samples", found=f"shape {y.shape}", allowed="three or more in a row")
    after = np.roll(y, -1)
    bend = np.fft.rfft(6.0 * ((after - y) - (y - np.roll(y, 1))))
    m = np.fft.irfft(bend / (4.0 + 2.0 * np.cos(TURN * np.arange(bend.size) / y.size)), y.size)
    ahead = np.roll(m, -1)
    return np.stack([y, after - y - (2.0 * m + ahead) / 6.0, 0.5 * m, (ahead - m) / 6.0], axis=1)


def packed_profiles(profiles: Sequence[tuple[ArrayLike, float]]) -> tuple[IntArray, Array, Array]:
    """``profile_start``, ``profile``, ``period`` of `Driven` from samples and periods in turns of 2π, by pairs.

    >>> start, table, period = packed_profiles([([0.0, 1.0, 0.0, -1.0], 2.0), ([1.0, 0.0, 0.0], 1.0)])
    >>> start.tolist(), table.shape, period.tolist()
    ([0, 4, 7], (7, 4), [2.0, 1.0])
    """
    tables = [periodic_profile(values) for values, _ in profiles]
    periods = np.array([period for _, period in profiles], dtype=float)
    if not (np.isfinite(periods) & (periods > 0.0)).all():
        raise ModelError("a profile's period must be positive", found=str(periods.tolist()))
    start = np.cumsum([0, *(len(table) for table in tables)]).astype(np.int64)
    return start, np.concatenate([np.zeros((0, 4)), *tables]), periods


def packed_levels(levels: Sequence[tuple[ArrayLike, ArrayLike]]) -> tuple[IntArray, Array, Array]:
    """``level_start``, ``level_time``, ``level_value`` of `Driven` from knots: times [s] and values, one pair a level.

    Raises ModelError where times fall, or their number is not that of the values.

    >>> packed_levels([(0.0, 5.0), ([0.0, 1.0], [0.0, 2.0])])[0].tolist()
    [0, 1, 3]
    """
    times = [np.atleast_1d(np.asarray(time, dtype=float)) for time, _ in levels]
    values = [np.atleast_1d(np.asarray(value, dtype=float)) for _, value in levels]
    for time, value in zip(times, values, strict=True):
        rising = time.shape == value.shape and time.size > 0 and bool((np.diff(time) >= 0.0).all())
        if not rising or not np.isfinite([time, value]).all():
            raise ModelError("a level needs rising times and a finite value at each", found=f"{time} and {value}")
    start = np.cumsum([0, *(time.size for time in times)]).astype(np.int64)
    return start, np.concatenate([np.zeros(0), *times]), np.concatenate([np.zeros(0), *values])
