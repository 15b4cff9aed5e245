"""Floquet multipliers where laws remember: deviations of the motion and of the memories marched together.

Over a step a law's torque is a ramp between its ends and the linear part moves exactly; the law gives the derivatives of
its torque and of its new memory by angle, rate (the mean one over the step) and old memory, as in time stepping.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.exponential import exponential
from torsional.numerics.piecewise_basis import Coordinates


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
def _march(
    matrix: Array, push: Array, angle: Array, reference: Array, told: Array, remembers: IntArray, step: float
) -> Array:
    """Monodromy matrix of (state, memories); ``told`` (m, samples, 6); ``reference`` (m, 2) stiffness and damping."""
    n, m = matrix.shape[0], push.shape[1]
    wide = np.zeros((n + 2 * m, n + 2 * m))
    wide[:n, :n], wide[:n, n : n + m] = matrix * step, push * step
    for e in range(m):
        wide[n + e, n + m + e] = 1.0
    grown = exponential(wide)
    flow, ramp = np.ascontiguousarray(grown[:n, :n]), np.ascontiguousarray(grown[:n, n + m :])
    hold = np.ascontiguousarray(grown[:n, n : n + m]) - ramp
    seen = np.ascontiguousarray(angle @ ramp)
    rate_rows = np.ascontiguousarray(push.T)
    z = np.eye(n + m)[:n].copy()
    memory = np.zeros((m, n + m))
    for e in range(m):
        memory[e, n + e] = 1.0
    g = np.zeros((m, n + m))
    for i in range(told.shape[1] + 1):
        here = i % told.shape[1]
        before = angle @ z
        if i > 0:
            z = flow @ z + hold @ g
        now, rate = angle @ z, rate_rows @ z
        system, right = np.eye(m), np.zeros((m, n + m))
        for e in range(m):
            d = told[e, here]
            pace = d[1] / step if remembers[e] else 0.0
            if i == 0:
                right[e] = (reference[e, 0] - d[0]) * now[e] + (reference[e, 1] - d[1] * (1 - remembers[e])) * rate[e]
                right[e] -= d[2] * memory[e]
                continue
            by_angle = d[0] - reference[e, 0] + pace
            right[e] = -by_angle * now[e] + pace * before[e] - d[2] * memory[e]
            right[e] += (reference[e, 1] - d[1] * (1 - remembers[e])) * rate[e]
            for f in range(m):
                system[e, f] += by_angle * seen[e, f]
        g = np.linalg.solve(system, right)
        if i > 0:
            z = z + ramp @ g
            now = angle @ z
            for e in range(m):
                d = told[e, here]
                memory[e] = d[3] * now[e] + d[4] * (now[e] - before[e]) / step + d[5] * memory[e]
    out = np.empty((n + m, n + m))
    out[:n], out[n:] = z, memory
    return out


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

    ``linear``: `coordinates` with ``reference`` (m, 2) stiffness [Nm/rad] and damping [Nms/rad] of each connection in K
    and C; ``laws``: address of the kernel and parameters of each; ``remembers`` (m,) 0 or 1; ``angles``, ``rates`` (m,
    samples) of the motion.  The error falls with the square of the samples for smooth laws.
    """
    samples = angles.shape[1]
    step = period / samples
    flags = np.asarray(remembers, dtype=np.int64)
    told = np.zeros((len(laws), samples, 6))
    for e, (address, law) in enumerate(laws):
        mean_rates = (angles[e] - np.roll(angles[e], 1)) / step
        given = np.ascontiguousarray(mean_rates if flags[e] else rates[e])
        _derivatives(address, np.ascontiguousarray(law), np.ascontiguousarray(angles[e]), given, step, told[e])
    whole = _march(
        linear.matrix,
        np.ascontiguousarray(linear.rate_rows.T),
        linear.angle_rows,
        np.asarray(reference, dtype=float),
        told,
        flags,
        step,
    )
    kept = np.concatenate([np.arange(linear.size), linear.size + np.flatnonzero(flags)])
    return np.asarray(whole[np.ix_(kept, kept)])
