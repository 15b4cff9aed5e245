"""Compiled motion of a piecewise-linear system on an even grid of times, leaving it where a stage changes.

From one sample to the next the motion is z ← exp(A_s Δ) z + r_s(k), with the responses r_s to the loads of one period
in tables: exact, and untroubled by resonances and by eigenvectors that coincide.  A step in which a connection leaves
its stage, or may have in between, is taken again as a series in time.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.linear.exponential import exponential_less_one
from torsional.numerics.piecewise.basis import StageBases
from torsional.numerics.piecewise.series import Motion, Record, combination, copy, travel


class Tables(NamedTuple):
    """Propagators over one sample less one, transposed, and responses; by combination, filled when first needed."""

    ready: IntArray
    grown: Array
    forced: Array
    pushed: Array


def equations(bases: StageBases, loads: ComplexArray, orders: IntArray, omega: float) -> Motion:
    """The equations in all combinations of stages, with ``loads`` (harmonics + 1, size) already on the states."""
    state, laws = bases.coordinates, bases.laws
    slow, rows = len(state.scale), state.rate_rows
    counts = [len(law.slopes) for law in laws]
    lower, constant, reach = [], [], []
    for stages in np.ndindex(*counts):
        A = bases.matrix(stages)
        offsets = np.array([law.offsets[j] for law, j in zip(laws, stages, strict=True)])
        size = np.sqrt(np.abs(A).sum(axis=0).max() * np.abs(A).sum(axis=1).max())
        lower.append(A[slow:].T)
        constant.append((loads[0].real - offsets @ rows)[slow:])
        reach.append(1.0 / max(size, omega * orders.max(initial=1)))
    bounds = np.full((len(laws), max(counts) + 1), np.inf)
    for e, law in enumerate(laws):
        bounds[e, : counts[e]] = np.append(-np.inf, law.edges)
    stride = np.append(np.cumprod(counts[:0:-1])[::-1], 1).astype(np.int64)
    return Motion(
        scale=state.scale,
        lower=np.array(lower),
        constant=np.array(constant),
        reach=np.array(reach),
        harmonics=orders.astype(float),
        real=np.ascontiguousarray(loads[orders, slow:].real),
        imag=np.ascontiguousarray(loads[orders, slow:].imag),
        omega=omega,
        angles=np.ascontiguousarray(state.angle_rows[:, :slow]),
        rates=np.ascontiguousarray(rows[:, slow : 2 * slow]),
        bounds=bounds,
        stride=stride,
        pulse=np.zeros(len(state.matrix) - slow),
    )


def new_tables(motion: Motion, samples: int) -> Tables:
    """Tables with nothing in them yet."""
    count, n = motion.lower.shape[:2]
    ready = np.zeros(count, np.int64)
    return Tables(ready, np.empty((count, n, n)), np.empty((count, samples, n)), np.empty((count, n)))


def prepare(motion: Motion, tables: Tables, c: int) -> None:
    """Fill the tables of one combination of stages, by exponentials of A bordered with each load in turn."""
    slow, n, samples = motion.scale.size, motion.lower.shape[1], tables.forced.shape[1]
    width = 2.0 * np.pi / samples
    step = width / motion.omega
    wide = np.zeros((n + 2, n + 2))
    wide[np.arange(slow), slow + np.arange(slow)] = motion.scale * step
    wide[slow:n, :n] = motion.lower[c].T * step
    wide[slow:n, n], wide[slow:n, n + 1] = motion.constant[c] * step, motion.pulse * step
    grown = exponential_less_one(wide)
    tables.grown[c], tables.forced[c], tables.pushed[c] = grown[:n, :n].T, grown[:n, n], grown[:n, n + 1]
    count = np.arange(samples)
    for h, real, imag in zip(motion.harmonics, motion.real, motion.imag, strict=True):
        wide[slow:n, n], wide[slow:n, n + 1] = real * step, -imag * step
        wide[n + 1, n], wide[n, n + 1] = h * width, -h * width
        grown, turn = exponential_less_one(wide), (h * count % samples) * width
        tables.forced[c] += np.outer(np.cos(turn), grown[:n, n]) + np.outer(np.sin(turn), grown[:n, n + 1])
    tables.ready[c] = 1


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _step(tables: Tables, c: int, k: int, pulse: float, z: Array, out: Array) -> None:
    """exp(A Δ) z and the responses to the loads."""
    forced, pushed, grown = tables.forced[c, k], tables.pushed[c], tables.grown[c]
    for i in range(z.size):
        out[i] = forced[i] + pulse * pushed[i]
    for j in range(z.size):
        row, value = grown[j], z[j]
        for i in range(z.size):
            out[i] += row[i] * value
    for i in range(z.size):
        out[i] += z[i]


@numba.njit(cache=True, error_model="numpy")
def _observe(motion: Motion, z: Array, seen: Array) -> None:
    """Angles and rates (2, m) of the connections."""
    slow = motion.scale.size
    for e in range(seen.shape[1]):
        angle, rate = 0.0, 0.0
        for j in range(slow):
            angle += motion.angles[e, j] * z[j]
            rate += motion.rates[e, j] * z[slow + j]
        seen[0, e], seen[1, e] = angle, rate


@numba.njit(cache=True, error_model="numpy")
def _stays(motion: Motion, stage: IntArray, before: Array, after: Array, step: float, wary: bool) -> bool:
    """Whether no connection left its stage in a step, not even to come back: where it turned, its rates tell how far.

    Steps long against the fastest mode (``wary``) are doubted as well where the angle did not turn.
    """
    for e in range(stage.size):
        low, high = motion.bounds[e, stage[e]], motion.bounds[e, stage[e] + 1]
        least, most = min(before[0, e], after[0, e]), max(before[0, e], after[0, e])
        if wary or before[1, e] * after[1, e] <= 0.0:
            reach = step * max(abs(before[1, e]), abs(after[1, e]))
            least, most = least - reach, most + reach
        if least <= low or most >= high:
            return False
    return True


@numba.njit(cache=True, error_model="numpy")
def _travel_on(
    motion: Motion, z: Array, stage: IntArray, samples: int, window: Array, record: Record, at: IntArray
) -> None:
    """One step by series, in parts where the pulse begins or ends."""
    period = 2.0 * np.pi / motion.omega
    step, origin, k = period / samples, (at[1] // samples) * period, at[1] % samples
    begin, end = k * step, (k + 1) * step
    while begin < end and at[0] >= 0:
        until = end
        for i in range(2):
            if begin < window[i] - origin < until:
                until = window[i] - origin
        middle = 0.5 * (begin + until) + origin
        pulse = 1.0 if window[0] <= middle < window[1] else 0.0
        travel(motion, z, stage, begin, until - begin, origin, pulse, record, at)
        begin = until


@numba.njit(cache=True, error_model="numpy")
def _march(
    motion: Motion, tables: Tables, z: Array, stage: IntArray, steps: int, window: Array, record: Record, at: IntArray
) -> None:
    """Carry z and stages on, until all steps are done, the tables of some stages are wanting, or it gets stuck."""
    samples = tables.forced.shape[1]
    step = 2.0 * np.pi / (motion.omega * samples)
    following, before, after = np.empty(z.size), np.empty((2, stage.size)), np.empty((2, stage.size))
    _observe(motion, z, before)
    while at[1] < steps and at[0] >= 0:
        s, c = at[1], combination(motion, stage)
        if tables.ready[c] == 0:
            return
        if s < record.states.shape[0]:
            copy(z, record.states[s])
        begin, end = s * step, (s + 1) * step
        plain = not (begin < window[0] < end or begin < window[1] < end)
        if plain:
            _step(tables, c, s % samples, 1.0 if window[0] <= begin and end <= window[1] else 0.0, z, following)
            _observe(motion, following, after)
            plain = _stays(motion, stage, before, after, step, motion.reach[c] < 0.5 * step)
        if plain:
            copy(following, z)
            copy(after[0], before[0])
            copy(after[1], before[1])
        else:
            _travel_on(motion, z, stage, samples, window, record, at)
            _observe(motion, z, before)
        at[1] += 1


def march(
    motion: Motion, tables: Tables, z: Array, stage: IntArray, periods: int, window: Array, record: Record
) -> int:
    """Carry z and stages over whole periods, in place; returns the number of crossings, −1 where it does not get on.

    ``window``: times [s] at which the pulse begins and ends.
    """
    at, steps = np.zeros(2, np.int64), periods * tables.forced.shape[1]
    while at[1] < steps and at[0] >= 0:
        c = int(combination.py_func(motion, stage))
        if not tables.ready[c]:
            prepare(motion, tables, c)
        _march(motion, tables, z, stage, steps, window, record, at)
    return int(at[0])
