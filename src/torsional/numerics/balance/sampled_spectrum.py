"""Fourier coefficients of smooth laws, and of laws with memory, along a periodic motion, by even samples of it.

Sampling takes harmonics beyond half the number of samples for lower ones: take many more samples than harmonics.
A law with memory is marched through two periods from rest, with the derivatives by every harmonic carried along, and
the second period is read: what it remembers of its start has then been forgotten, or never will be.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.callbacks import law_at

NUDGE = 1e-6
"""Share by which the pace is changed to see what that does to a law with memory."""


@numba.njit(cache=True, error_model="numpy")
def _rates(x: Array, pace: float) -> Array:
    """The rate's coefficients in the order of the motion's: 0, Re, Im of ihp X_h."""
    rate = np.zeros(x.size)
    for h in range(1, x.size // 2 + 1):
        rate[2 * h - 1], rate[2 * h] = -h * pace * x[2 * h], h * pace * x[2 * h - 1]
    return rate


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _spectrum(values: Array, out: ComplexArray) -> None:
    """Two-sided coefficients c_j, j ≥ 0, of even samples."""
    size = values.size
    turn = complex(np.cos(2.0 * np.pi / size), -np.sin(2.0 * np.pi / size))
    step = complex(1.0, 0.0)
    for j in range(out.size):
        total, phasor = complex(0.0, 0.0), complex(1.0, 0.0)
        for i in range(size):
            total += values[i] * phasor
            phasor *= step
        out[j] = total / size
        step *= turn


@numba.njit(cache=True, error_model="numpy")
def smooth_spectrum(
    address: int,
    law: Array,
    x: Array,
    table: Array,
    pace: float,
    force: ComplexArray,
    stiffness: ComplexArray,
    rate: ComplexArray,
    drift: ComplexArray,
) -> None:
    """Force harmonics (complex 0-peak) of a law without memory, the two-sided spectra of its tangents, and the
    ``drift`` of the force harmonics with the pace."""
    torque = law_at(address)
    angles, rates = table @ x, table @ _rates(x, pace)
    forces, tangents, dashes = np.empty_like(angles), np.empty_like(angles), np.empty_like(angles)
    for i in range(angles.size):
        told = torque(law, angles[i], rates[i], 0.0, 0.0)
        forces[i], tangents[i], dashes[i] = told[0], told[1], told[2]
    _spectrum(forces, force)
    force[1:] *= 2.0
    _spectrum(tangents, stiffness)
    _spectrum(dashes, rate)
    for i in range(angles.size):
        dashes[i] *= rates[i] / pace
    _spectrum(dashes, drift)
    drift[1:] *= 2.0


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def remembered_spectrum(
    address: int,
    law: Array,
    x: Array,
    table: Array,
    pace: float,
    force: ComplexArray,
    jacobian: ComplexArray,
    drift: ComplexArray,
) -> None:
    """Force harmonics of a law with memory, their derivatives by x_0, Re X_1, Im X_1, …, their drift with the pace."""
    size, n = table.shape
    forces, slopes = np.empty(size), np.empty((size, n))
    angles, step = table @ x, 2.0 * np.pi / (pace * size)
    later, sooner = np.empty(size), np.empty(size)
    marched(address, law, angles, table[:, :0], step / (1.0 + NUDGE), later, slopes[:, :0])
    marched(address, law, angles, table[:, :0], step / (1.0 - NUDGE), sooner, slopes[:, :0])
    _spectrum((later - sooner) / (2.0 * NUDGE * pace), drift)
    drift[1:] *= 2.0
    marched(address, law, angles, table, step, forces, slopes)
    for k in range(force.size):
        scale = (1.0 if k == 0 else 2.0) / size
        force[k] = 0.0
        jacobian[k] = 0.0
        for i in range(size):
            weight = complex(table[i, 2 * k - 1], table[i, 2 * k]) * scale if k else complex(scale, 0.0)
            force[k] += forces[i] * weight
            for j in range(n):
                jacobian[k, j] += slopes[i, j] * weight


@numba.njit(cache=True, error_model="numpy")
def marched(
    address: int, law: Array, angles: Array, directions: Array, step: float, forces: Array, slopes: Array
) -> None:
    """The second of two periods: forces (samples,) and their derivatives along the directions (samples, n)."""
    torque = law_at(address)
    size, n = directions.shape
    memory, carried, moved = 0.0, np.zeros(n), np.zeros(n)
    for i in range(2 * size):
        here, before = i % size, (i - 1) % size
        rate = (angles[here] - angles[before]) / step
        t, by_angle, by_rate, by_memory, memory, m_angle, m_rate, m_memory = torque(
            law, angles[here], rate, memory, step
        )
        for j in range(n):
            moved[j] = (directions[here, j] - directions[before, j]) / step
            old = carried[j]
            carried[j] = m_angle * directions[here, j] + m_rate * moved[j] + m_memory * old
            if i >= size:
                slopes[here, j] = by_angle * directions[here, j] + by_rate * moved[j] + by_memory * old
        if i >= size:
            forces[here] = t
