"""Floquet multipliers where laws remember: deviations of the motion and of the memories marched together.

Over a step a law's torque is a ramp between its ends and the linear part moves exactly; the law gives the derivatives
of its torque and of its new memory by angle, rate (the mean one over the step) and old memory, as in time stepping.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.linear.exponential import exponential
from torsional.numerics.piecewise.basis import Coordinates


@numba.njit(cache=True, error_model="numpy")
def _derivatives(address: int, law: Array, angles: Array, rates: Array, step: float, told: Array) -> None:
    """Derivatives (samples, 6) of the second of two periods: torque by angle, rate, memory; memory by the same."""
    torque = law_at(address)
    size, memory = angles.size, 0.0
    for i in range(2 * size):
        here = i % size
        answer = torque(law, angles[here], rates[here], memory, step)
        memory = answer[4]
        told[here, 0], told[here, 1], told[here, 2] = answer[1], answer[2], answer[3]
        told[here, 3], told[here, 4], told[here, 5] = answer[5], answer[6], answer[7]


@numba.njit(cache=True, error_model="numpy")
def _steps(matrix: Array, push: Array, step: float) -> tuple[Array, Array, Array]:
    """Over one step: flow of the state (n, n), responses (n, m) to torques that end at one, and that begin at one."""
    n, m = push.shape
    wide = np.zeros((n + 2 * m, n + 2 * m))
    wide[:n, :n], wide[:n, n : n + m] = matrix * step, push * step
    for e in range(m):
        wide[n + e, n + m + e] = 1.0
    grown = exponential(wide)
    flow, ramp = np.ascontiguousarray(grown[:n, :n]), np.ascontiguousarray(grown[:n, n + m :])
    return flow, ramp, np.ascontiguousarray(grown[:n, n : n + m]) - ramp


@numba.njit(cache=True, error_model="numpy")
def _torques(
    told: Array, remembers: IntArray, first: bool, seen: Array, before: Array, now: Array, memory: Array, step: float
) -> Array:
    """Deviations (m, columns) of the torques, less the reference's; ``seen`` (2, m, m): what they do to angle, rate.

    ``told`` (m, 6) derivatives, the reference taken off the first two; ``now`` (2, m, columns): angles and rates
    without the torques that are looked for.  At the ``first`` sample angle and memory alone tell the torque.
    """
    m = told.shape[0]
    system, right = np.eye(m), np.empty_like(memory)
    for e in range(m):
        d, own = told[e], remembers[e] == 1
        pace = d[1] / step if own and not first else 0.0
        drag = 0.0 if own else d[1]
        right[e] = -(d[0] + pace) * now[0, e] + pace * before[e] - drag * now[1, e] - d[2] * memory[e]
        for f in range(m):
            if not first:
                system[e, f] += (d[0] + pace) * seen[0, e, f] + drag * seen[1, e, f]
    answer: Array = np.ascontiguousarray(np.linalg.solve(system, right))
    return answer


@numba.njit(cache=True, error_model="numpy")
def _march(matrix: Array, push: Array, angle: Array, told: Array, remembers: IntArray, step: float) -> Array:
    """Monodromy matrix of (state, memories); ``told`` (samples, m, 6), the reference stiffness taken off."""
    n, m = push.shape
    flow, ramp, hold = _steps(matrix, push, step)
    rate_rows = np.ascontiguousarray(push.T)
    seen, now = np.empty((2, m, m)), np.empty((2, m, n + m))
    seen[0], seen[1] = angle @ ramp, rate_rows @ ramp
    whole = np.eye(n + m)
    z, memory = whole[:n].copy(), whole[n:].copy()
    g, before = np.zeros((m, n + m)), angle @ z
    for i in range(told.shape[0] + 1):
        d = told[i % told.shape[0]]
        if i > 0:
            z = flow @ z + hold @ g
        now[0], now[1] = angle @ z, rate_rows @ z
        g = _torques(d, remembers, i == 0, seen, before, now, memory, step)
        if i > 0:
            z = z + ramp @ g
            after = angle @ z
            for e in range(m):
                memory[e] = d[e, 3] * after[e] + d[e, 4] * (after[e] - before[e]) / step + d[e, 5] * memory[e]
            before = after
    whole[:n], whole[n:] = z, memory
    return whole


def monodromy_remembering(
    linear: Coordinates,
    laws: list[tuple[int, Array]],
    remembers: Array,
    reference: Array,
    angles: Array,
    rates: Array,
    period: float,
) -> Array:
    """Monodromy matrix (states + remembering laws, same) over one ``period`` [s] of a motion.

    ``linear``: `coordinates` with the ``reference`` stiffness (m,) [Nm/rad] of each connection in K; ``laws``: address
    of the kernel and parameters of each; ``remembers`` (m,) 0 or 1; ``angles``, ``rates`` (m, samples) of the motion.
    The error falls with the square of the samples for smooth laws; with their number alone where a law that remembers
    gives a torque of the rate as well, which is the mean one over a step.
    """
    samples = angles.shape[1]
    step = period / samples
    flags = np.asarray(remembers, dtype=np.int64)
    told = np.zeros((len(laws), samples, 6))
    for e, (address, law) in enumerate(laws):
        mean_rates = (angles[e] - np.roll(angles[e], 1)) / step
        given = np.ascontiguousarray(mean_rates if flags[e] else rates[e])
        _derivatives(address, np.ascontiguousarray(law), np.ascontiguousarray(angles[e]), given, step, told[e])
    told[:, :, 0] -= np.asarray(reference, dtype=float)[:, None]
    by_sample = np.ascontiguousarray(np.moveaxis(told, 0, 1))
    push = np.ascontiguousarray(linear.rate_rows.T)
    whole = _march(linear.matrix, push, linear.angle_rows, by_sample, flags, step)
    kept = np.concatenate([np.arange(linear.size), linear.size + np.flatnonzero(flags)])
    return np.asarray(whole[np.ix_(kept, kept)])
