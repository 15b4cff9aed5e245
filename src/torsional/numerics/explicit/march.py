"""An explicit integrator of the arrays of time stepping, with its step chosen by the error: for cross-checks.

It shares the right-hand side of no implicit step, looks for no events and takes as many steps as contacts ask for.
"""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.explicit.rates import Places, fill_rates, places
from torsional.numerics.motion.data import Connected, Equations
from torsional.numerics.motion.sources import frame_at, row_product

NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
STAGES = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERROR = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
"""Dormand and Prince's pair of orders 5 and 4 (J. Comput. Appl. Math. 6 (1980) 19)."""

SAFETY, LEAST, MOST, POWER, EARLIER = 0.9, 0.2, 5.0, 0.17, 0.04  # step control: Hairer, Nørsett, Wanner, sec. IV.2
SMALLEST = 16.0 * np.finfo(float).eps  # steps, as a share of the time


class March(NamedTuple):
    """Samples at ``times`` (T,) [s]: ``angles`` [rad], ``rates`` [rad/s], ``accelerations`` (T, N); ``references``
    Ω_r (T,), ``integrals`` (T, G) of governors, ``memories`` (T, E); all ``states`` (T, size); steps taken, refused."""

    times: Array
    angles: Array
    rates: Array
    accelerations: Array
    references: Array
    integrals: Array
    memories: Array
    states: Array
    steps: int
    refused: int


@numba.njit(cache=True, error_model="numpy")
def _stages(connected: Connected, at: Places, t: float, h: float, end: float, k: Array, y: Array, out: Array) -> None:
    """Stages 2 to 7 and the state after a step; none looks at or beyond ``end``, where a load may jump."""
    for s in range(1, 7):
        out[:] = y
        for j in range(s):
            out += h * STAGES[s, j] * k[j]
        fill_rates(connected, at, min(t + NODES[s] * h, end), out, k[s])


@numba.njit(cache=True, error_model="numpy")
def _miss(k: Array, h: float, y: Array, after: Array, kinds: IntArray) -> float:
    """Estimated error of a step, of its kind's largest entry: the root of its mean square."""
    total, first = 0.0, 0
    for last in kinds:
        size = 1e-300
        for i in range(first, last):
            size = max(size, abs(y[i]), abs(after[i]))
        for i in range(first, last):
            error = 0.0
            for s in range(7):
                error += ERROR[s] * k[s, i]
            total += (h * error / size) ** 2
        first = last
    return np.sqrt(total / y.size)


@numba.njit(cache=True, error_model="numpy")
def _carry(
    connected: Connected, at: Places, span: tuple[float, float], y: Array, kinds: IntArray, control: Array
) -> None:
    """Carry y over a span without a jump in the loads; ``control``: tolerance, step, earlier error, counts."""
    t, end, tolerance = span[0], span[1], control[0]
    before_end = np.nextafter(end, t)
    k, after = np.empty((7, y.size)), np.empty(y.size)
    fill_rates(connected, at, t, y, k[0])
    while t < end and control[3] + control[4] < control[5]:
        h = min(control[1], end - t)
        _stages(connected, at, t, h, before_end, k, y, after)
        miss = _miss(k, h, y, after, kinds) / tolerance
        if miss <= 1.0 or h <= SMALLEST * max(abs(t), abs(end)):
            t = end if h >= end - t else t + h
            y[:], k[0] = after, k[6]
            control[3] += 1.0
            growth = SAFETY * max(miss, 1e-8) ** -POWER * control[2] ** EARLIER
            if h >= control[1] or growth < 1.0:  # a step cut short by the span's end tells little of the next
                control[1] = h * min(max(growth, LEAST), MOST)
            control[2] = max(miss, 1e-4)
        else:
            control[1] = h * max(LEAST, SAFETY * miss**-0.2) if np.isfinite(miss) else 0.1 * h
            control[4] += 1.0


@numba.njit(cache=True, error_model="numpy")
def _march(
    connected: Connected, at: Places, stops: Array, kept: IntArray, states: Array, kinds: IntArray, control: Array
) -> bool:
    """Carry the first of ``states`` from stop to stop; whether the steps sufficed."""
    y, row = states[0].copy(), 1
    for i in range(1, stops.size):
        _carry(connected, at, (stops[i - 1], stops[i]), y, kinds, control)
        if control[3] + control[4] >= control[5] or not np.isfinite(y).all():
            return False
        if kept[i] == 1:
            states[row] = y
            row += 1
    return True


def _told(equations: Equations, at: Places, grid: Array, states: Array, control: Array) -> March:
    n, rate, connected = equations.coordinates, np.zeros(at.size), equations.connected
    accelerations, memories = np.empty((grid.size, n)), np.zeros((grid.size, at.memory.size))
    memories[:, at.memory >= 0] = states[:, at.memories :]
    for i in range(grid.size):
        fill_rates(connected, at, grid[i], states[i], rate)
        accelerations[i] = rate[n : 2 * n]
    parts = states[:, :n], states[:, n : 2 * n], accelerations, states[:, 2 * n], states[:, at.governor : at.memories]
    return March(grid, *parts, memories, states, int(control[3]), int(control[4]))


def explicit_march(
    equations: Equations,
    times: ArrayLike,
    angles: ArrayLike,
    rates: ArrayLike,
    *,
    tolerance: float = 1e-10,
    flows: Mapping[int, int] | None = None,
    reference_speed: float | None = None,
    integral: ArrayLike = 0.0,
    memory: ArrayLike = 0.0,
    most_steps: int = 10_000_000,
) -> March:
    """Integrate from ``angles`` [rad] and ``rates`` [rad/s] (N,) at the first of the rising ``times`` [s].

    ``tolerance``: of a step's error, relative to the largest angle and the largest rate at the time.  ``flows``: where
    the rate of its memory is told, by the address of a law's kernel; laws whose memory has none are refused.  Governors
    act without sampling.  To begin with: ``reference_speed`` Ω_r [rad/s], default the speed at the reference;
    ``integral`` (G,) [Nm] of governors; ``memory`` (E,) [rad].  Every time is the end of a step, as are the knots of
    levels.  Raises ModelError for what cannot be integrated, and where ``most_steps`` do not do.
    """
    grid = np.asarray(times, dtype=float)
    if grid.ndim != 1 or grid.size < 2 or not (np.diff(grid) > 0.0).all():
        raise ModelError("times must rise", where="times", found=str(grid[:5]))
    at, n = places(equations, flows), equations.coordinates
    states = np.zeros((grid.size, at.size))
    states[0, :n], states[0, n : 2 * n], states[0, at.governor : at.memories] = angles, rates, integral
    states[0, at.memories :] = np.broadcast_to(np.asarray(memory, dtype=float), at.memory.shape)[at.memory >= 0]
    frame = frame_at(at.outside.knots, at.outside.frame, grid[0])[0]
    turning = frame + row_product(equations.reference, 0, states[0, n : 2 * n])
    states[0, 2 * n] = turning if reference_speed is None else reference_speed
    knots = np.concatenate([equations.driven.level_time, equations.frame_time])
    stops = np.unique(np.concatenate([grid, knots[(knots > grid[0]) & (knots < grid[-1])]]))
    kept = np.isin(stops, grid).astype(np.int64)
    kinds = np.unique([n, *range(2 * n, at.memories + 1), at.size])  # memories together: some are no more than rounding
    control = np.array([tolerance, 1e-6 * (grid[-1] - grid[0]), 1.0, 0.0, 0.0, most_steps])
    if not _march(equations.connected, at, stops, kept, states, kinds, control):
        found = f"{control[3]:g} steps taken"
        raise ModelError(
            "the explicit integrator did not arrive", found=found, remedy="a shorter span or implicit steps"
        )
    return _told(equations, at, grid, states, control)
