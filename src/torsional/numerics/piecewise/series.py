"""Compiled motion of a piecewise-linear system under harmonic loads, from crossing to crossing.

    ż = A_s z + c_s + Re Σ_h L_h exp(ihωt) + pulse            in the combination of stages s

The motion is carried by its Taylor series, whose terms follow from each other, to rounding; where the polynomial of a
connection's angle leaves the bounds of its stage, the stage changes and the series starts anew.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from torsional.numerics.arrays import Array, IntArray

TERMS = 48
ROUNDING = 1e-14
MOST_CROSSINGS = 1000  # in one step: a motion that crosses more often does not get on


class Motion(NamedTuple):
    """Equations by combination of stages; the first entries of z are σ y, with the rates σ ẏ after them.

    ``lower`` (combinations, n, rates): the other rows of A, transposed; ``constant`` (combinations, rates);
    ``reach`` (combinations,): longest Taylor step [s]; ``harmonics`` (H,), ``real`` and ``imag`` (H, rates) loads;
    ``angles``, ``rates`` (m, elastic): rows of the connections; ``bounds`` (m, stages + 1) [rad]; ``stride`` (m,): of
    the combinations' number; ``pulse`` (rates,).
    """

    scale: Array
    lower: Array
    constant: Array
    reach: Array
    harmonics: Array
    real: Array
    imag: Array
    omega: float
    angles: Array
    rates: Array
    bounds: Array
    stride: IntArray
    pulse: Array


class Record(NamedTuple):
    """Where crossings (time and stages after it) and samples of the state go; empty arrays take none."""

    times: Array
    stages: IntArray
    states: Array


@numba.njit(cache=True, error_model="numpy")
def copy(source: Array | IntArray, target: Array | IntArray) -> None:
    """Entry by entry: a plain loop compiles much quicker than an assignment of arrays."""
    for i in range(target.size):
        target[i] = source[i]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _slope(motion: Motion, c: int, z: Array, turn: Array, constant: float, pulse: float, out: Array) -> None:
    """A z and the loads: the next derivative, ``turn`` the loads' phasors in this one."""
    slow = motion.scale.size
    rates = out[slow:]
    for j in range(slow):
        out[j] = motion.scale[j] * z[slow + j]
    for i in range(rates.size):
        rates[i] = constant * motion.constant[c, i] + pulse * motion.pulse[i]
    for j in range(z.size):
        row = motion.lower[c, j]
        for i in range(rates.size):
            rates[i] += row[i] * z[j]
    for h in range(turn.shape[1]):
        for i in range(rates.size):
            rates[i] += turn[0, h] * motion.real[h, i] - turn[1, h] * motion.imag[h, i]


@numba.njit(cache=True, error_model="numpy")
def _scaled(values: Array, share: float) -> float:
    """Multiply in place; the largest absolute value."""
    largest = 0.0
    for i in range(values.size):
        values[i] *= share
        largest = max(largest, abs(values[i]))
    return largest


@numba.njit(cache=True, error_model="numpy")
def _series(motion: Motion, c: int, z: Array, time: float, step: float, pulse: float, out: Array) -> int:
    """Taylor coefficients (terms, n) of z in t/step from ``time`` on; returns their number."""
    turn = np.empty((2, motion.harmonics.size))
    for h in range(motion.harmonics.size):
        angle = motion.omega * time * motion.harmonics[h]
        turn[0, h], turn[1, h] = np.cos(angle), np.sin(angle)
    copy(z, out[0])
    largest, small = _scaled(out[0], 1.0), 0
    for k in range(TERMS - 1):
        constant = 1.0 if k == 0 else 0.0
        _slope(motion, c, out[k], turn, constant, constant * pulse, out[k + 1])
        share = step / (k + 1)
        for h in range(motion.harmonics.size):
            angle = motion.omega * motion.harmonics[h] * share
            turn[0, h], turn[1, h] = -angle * turn[1, h], angle * turn[0, h]
        size = _scaled(out[k + 1], share)
        largest = max(largest, size)
        small = small + 1 if size <= 1e-17 * largest else 0
        if k >= 5 and small >= 2:
            return k + 2
    return TERMS


@numba.njit(cache=True, error_model="numpy")
def _value(p: Array, tau: float) -> tuple[float, float]:
    """A polynomial and its derivative."""
    value, slope = 0.0, 0.0
    for k in range(p.size - 1, -1, -1):
        slope = slope * tau + value
        value = value * tau + p[k]
    return value, slope


@numba.njit(cache=True, error_model="numpy")
def _zero(p: Array, low: float, high: float) -> float:
    """The place between two, of opposite sign, where a polynomial is zero: Newton's method kept in its bracket."""
    rising = _value(p, high)[0] > 0.0
    tau = 0.5 * (low + high)
    for _ in range(80):
        value, slope = _value(p, tau)
        if (value > 0.0) == rising:
            high = tau
        else:
            low = tau
        following = tau - value / slope if slope != 0.0 else -1.0
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - tau) <= 4e-16 or value == 0.0:
            return following if value != 0.0 else tau
        tau = following
    return tau


@numba.njit(cache=True, error_model="numpy")
def _derivative(p: Array) -> Array:
    out = np.empty(p.size - 1)
    for k in range(out.size):
        out[k] = (k + 1) * p[k + 1]
    return out


@numba.njit(cache=True, error_model="numpy")
def _exit(p: Array, blur: float) -> float:
    """First τ in [0, 1] after which the polynomial is above zero; above one if none.  It starts at or below zero."""
    start, end = _value(p, 0.0), _value(p, 1.0)
    on_edge = start[0] >= -blur
    if on_edge and start[1] > 0.0:
        return 0.0
    if end[0] > blur:
        return _zero(p, _zero(_derivative(p), 0.0, 1.0), 1.0) if on_edge and start[1] < 0.0 else _zero(p, 0.0, 1.0)
    if not on_edge and start[1] > 0.0 and end[1] < 0.0:
        top = _zero(_derivative(p), 0.0, 1.0)
        if _value(p, top)[0] > blur:
            return _zero(p, 0.0, top)
    return 2.0


@numba.njit(cache=True, error_model="numpy")
def _beyond(row: Array, series: Array, side: int, edge: float) -> Array:
    """How far a connection is beyond an edge, as a polynomial."""
    out = np.empty(series.shape[0])
    for k in range(out.size):
        total = 0.0
        for j in range(row.size):
            total += row[j] * series[k, j]
        out[k] = side * total
    out[0] -= side * edge
    return out


@numba.njit(cache=True, error_model="numpy")
def _first_exit(motion: Motion, stage: IntArray, series: Array) -> tuple[float, int, int]:
    """When the first connection leaves its stage, which it is, and whether up or down; (2, −1, 0) if none does."""
    soonest, which, way = 2.0, -1, 0
    slow = motion.scale.size
    for e in range(stage.size):
        blur = 0.0
        for j in range(slow):
            blur += ROUNDING * abs(motion.angles[e, j] * series[0, j])
        for side in (1, -1):
            edge = motion.bounds[e, stage[e] + (side + 1) // 2]
            if np.isfinite(edge):
                at = _exit(_beyond(motion.angles[e], series, side, edge), blur)
                if at < soonest:
                    soonest, which, way = at, e, side
    return soonest, which, way


@numba.njit(cache=True, error_model="numpy")
def combination(motion: Motion, stage: IntArray) -> int:
    """Running number of a combination of stages."""
    total = 0
    for e in range(stage.size):
        total += stage[e] * motion.stride[e]
    return total


@numba.njit(cache=True, error_model="numpy")
def travel(
    motion: Motion,
    z: Array,
    stage: IntArray,
    time: float,
    length: float,
    origin: float,
    pulse: float,
    record: Record,
    at: IntArray,
) -> None:
    """Carry z and stages over ``length`` [s] by Taylor series, crossings on the way included.

    ``time`` is counted from the period's begin at ``origin``; ``at[0]``: crossings so far, −1 if it gets stuck.
    """
    done, crossed = 0.0, 0
    out = np.empty((TERMS, z.size))
    while done < length:
        c = combination(motion, stage)
        step = min(length - done, motion.reach[c])
        last = step == length - done
        terms = _series(motion, c, z, time + done, step, pulse, out)
        tau, which, way = _first_exit(motion, stage, out[:terms])
        tau = min(tau, 1.0)
        for i in range(z.size):
            z[i] = _value(out[:terms, i], tau)[0]
        done = length if last and which < 0 else done + tau * step
        if which < 0:
            continue
        stage[which] += way
        if at[0] < record.times.size:
            record.times[at[0]] = origin + time + done
            copy(stage, record.stages[at[0]])
        crossed += 1
        at[0] += 1
        if crossed > MOST_CROSSINGS:
            at[0] = -1
            return
