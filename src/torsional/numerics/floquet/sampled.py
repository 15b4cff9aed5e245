"""Monodromy of smooth laws: their stiffness and damping vary in time, along a few connections only.

    ż = A z + b g(t),   g = −(δk(t) a + δc(t) d) · z        A holds a mean stiffness and damping along each connection

The exact propagator of A carries z, however stiff the cranks are; only the torques g, as many as there are connections,
are approximated: by the parabola through three samples (collocation at equidistant points, Lobatto's three, so the
error over a period falls with the fourth power of the step).
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.linear.exponential import exponential
from torsional.numerics.linear.small import solve
from torsional.numerics.piecewise.basis import Coordinates


class SampledMonodromy(NamedTuple):
    """``matrix`` (size, size) and an estimate of the largest ``error`` of its entries."""

    matrix: Array
    error: float


class _Step(NamedTuple):
    """What carries a double step: rows (n + 4m, n + m) on (z, g_0), and the responses to g_1 and g_2.

    The rows give z at the end without g_1 and g_2, then angles and rates in the middle, angles and rates at the end.
    """

    rows: Array
    responses: Array
    size: int
    connections: int


@numba.njit(cache=True, error_model="numpy")
def _bordered(matrix: Array, push: Array, step: float) -> Array:
    """exp of A bordered by torques 1, ν and ν²/2 over one step: exp(A h), and the responses to the three."""
    n, m = push.shape
    wide = np.zeros((n + 3 * m, n + 3 * m))
    wide[:n, :n] = matrix * step
    wide[:n, n : n + m] = push * step
    for i in range(2 * m):
        wide[n + i, n + m + i] = 1.0
    grown: Array = exponential(wide)
    return grown


@numba.njit(cache=True, error_model="numpy")
def _lagrange(grown: Array, n: int, m: int) -> Array:
    """Propagator and responses (n, n + 3m) to torques that are one at ν = 0, 1 or 2 and zero at the others."""
    out = grown[:n].copy()
    linear, square = grown[:n, n + m : n + 2 * m], grown[:n, n + 2 * m :]
    out[:, n : n + m] += square - 1.5 * linear
    out[:, n + m : n + 2 * m] = 2.0 * (linear - square)
    out[:, n + 2 * m :] = square - 0.5 * linear
    return out


@numba.njit(cache=True, error_model="numpy")
def _double_step(matrix: Array, angles: Array, rates: Array, step: float) -> _Step:
    n, m = matrix.shape[0], angles.shape[0]
    once = _bordered(matrix, np.ascontiguousarray(rates.T), step)
    middle, end = _lagrange(once, n, m), _lagrange(once @ once, n, m)
    wide = np.empty((n + 4 * m, n + 3 * m))
    wide[:n] = end
    wide[n : n + m], wide[n + m : n + 2 * m] = angles @ middle, rates @ middle
    wide[n + 2 * m : n + 3 * m], wide[n + 3 * m :] = angles @ end, rates @ end
    return _Step(np.ascontiguousarray(wide[:, : n + m]), np.ascontiguousarray(wide[:, n + m :]), n, m)


@numba.njit(cache=True, error_model="numpy")
def _torques(step: _Step, y: Array, stiffness: Array, damping: Array) -> Array:
    """g_1 and g_2 (2m, columns), which the response to them must agree with; deviations (2, m) at ν = 1 and 2."""
    n, m = step.size, step.connections
    system, right = np.eye(2 * m), np.empty((2 * m, y.shape[1]))
    for k in range(2):
        for e in range(m):
            angle, rate, row = n + 2 * m * k + e, n + 2 * m * k + m + e, m * k + e
            right[row] = -(stiffness[k, e] * y[angle] + damping[k, e] * y[rate])
            system[row] += stiffness[k, e] * step.responses[angle] + damping[k, e] * step.responses[rate]
    solve(system, right)
    return right


@numba.njit(cache=True, error_model="numpy")
def _march(step: _Step, stiffness: Array, damping: Array, angles: Array, rates: Array) -> Array:
    """The product of all double steps of one period; deviations (samples, m)."""
    n, m, samples = step.size, step.connections, stiffness.shape[0]
    z = np.zeros((n + m, n))
    for i in range(n):
        z[i, i] = 1.0
    for e in range(m):
        z[n + e] = -(stiffness[0, e] * angles[e] + damping[0, e] * rates[e])
    k, c = np.empty((2, m)), np.empty((2, m))
    for first in range(0, samples, 2):
        last = (first + 2) % samples
        k[0], k[1], c[0], c[1] = stiffness[first + 1], stiffness[last], damping[first + 1], damping[last]
        y = step.rows @ z
        g = _torques(step, y, k, c)
        z[:n] = y[:n] + step.responses[:n] @ g
        z[n:] = g[m:]
    return z[:n].copy()


def monodromy_sampled(linear: Coordinates, stiffness: ArrayLike, damping: ArrayLike, period: float) -> SampledMonodromy:
    """Monodromy matrix over ``period`` [s] where laws vary smoothly along the motion, in the states of ``linear``.

    ``linear``: `coordinates` with a mean stiffness and damping of every connection in K and C.  ``stiffness`` [Nm/rad]
    and ``damping`` [Nms/rad] (samples, m): what the laws' tangents differ from these by, at t = j period/samples, the
    number of samples a multiple of four.  The result is extrapolated from all samples and every other one; ``error``
    is their largest difference, which for smooth laws is well above the error, and for laws that jump is of its size.

    >>> from torsional.numerics.piecewise.basis import coordinates
    >>> oscillator = coordinates([[1.0]], [[0.0]], [[2.0]], [[1.0]])
    >>> monodromy_sampled(oscillator, np.full((8, 1), -1.0), np.zeros((8, 1)), np.pi / 2).matrix.round(3)
    array([[ 0.   ,  1.414],
           [-0.707,  0.   ]])
    """
    m = len(linear.weights)
    dk, dc = (np.ascontiguousarray(a, dtype=float) for a in np.broadcast_arrays(stiffness, damping))
    if dk.ndim != 2 or dk.shape[1] != m or len(dk) % 4 or not len(dk):
        raise ModelError(
            "stiffness and damping need (samples, connections), samples a multiple of four", found=str(dk.shape)
        )
    angles, rates = linear.angle_rows, linear.rate_rows
    coarse, fine = (
        _march(
            _double_step(linear.matrix, angles, rates, period / len(dk) * every),
            np.ascontiguousarray(dk[::every]),
            np.ascontiguousarray(dc[::every]),
            angles,
            rates,
        )
        for every in (2, 1)
    )
    difference = fine - coarse
    return SampledMonodromy(fine + difference / 15.0, float(np.abs(difference).max()))
