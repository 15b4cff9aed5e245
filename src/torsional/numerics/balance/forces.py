"""Harmonics of the laws' forces along a motion, with their derivatives: exact for hinges, sampled for other laws."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.data import Balance
from torsional.numerics.balance.hinge_spectrum import hinge_spectrum
from torsional.numerics.balance.sampled_spectrum import remembered_spectrum, smooth_spectrum


@numba.njit(cache=True, error_model="numpy")
def _own_motion(z: Array, connection: int, connections: int, x: Array) -> None:
    """Put (x_0, Re X_1, Im X_1, …) of one connection into x."""
    x[0] = z[connection]
    for h in range(1, x.size // 2 + 1):
        at = connections * (2 * h - 1) + connection
        x[2 * h - 1], x[2 * h] = z[at], z[at + connections]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _toeplitz(stiffness: ComplexArray, rate: ComplexArray, pace: float, jacobian: ComplexArray) -> None:
    """Derivatives of the force harmonics (rows k) by x_0, Re X_1, Im X_1, … from the spectra of the tangents."""
    count = jacobian.shape[0]
    dashed = rate.size > 0
    for k in range(count):
        for h in range(count):
            near = stiffness[k - h] if k >= h else stiffness[h - k].conjugate()
            far = stiffness[k + h]
            if dashed:
                turn = complex(0.0, h * pace)
                near += turn * (rate[k - h] if k >= h else rate[h - k].conjugate())
                far -= turn * rate[k + h]
            if h == 0:
                jacobian[k, 0] = near if k == 0 else near + far
            elif k == 0:
                jacobian[0, 2 * h - 1] = 0.5 * (near + far).real
                jacobian[0, 2 * h] = -0.5 * (near - far).imag
            else:
                jacobian[k, 2 * h - 1] = near + far
                jacobian[k, 2 * h] = complex(far.imag - near.imag, near.real - far.real)


@numba.njit(cache=True, error_model="numpy")
def force_harmonics(
    balance: Balance,
    e: int,
    z: Array,
    speed: float,
    force: ComplexArray,
    jacobian: ComplexArray,
    stiffness: ComplexArray,
    rate: ComplexArray,
    drift: ComplexArray,
    found: Array,
) -> int:
    """Harmonics of the law of connection e (H + 1,), their derivatives (H + 1, 2H + 1), tangent spectra, ``drift``
    (H + 1,) of the harmonics with the pace νΩ, crossings."""
    m, count = balance.reference_stiffness.size, force.size
    x = np.empty(2 * count - 1)
    _own_motion(z, e, m, x)
    law = balance.law_values[balance.law_start[e] : balance.law_start[e + 1]]
    pace = balance.base_order * speed
    if balance.address[e] == 0:
        offset = np.empty_like(stiffness)
        samples = balance.table @ x
        crossed = hinge_spectrum(law, x, samples, stiffness, offset, found)
        drift[:] = 0.0
        _toeplitz(stiffness, rate[:0], pace, jacobian)
        for k in range(count):
            total = -offset[k] if k == 0 else -2.0 * offset[k]
            for j in range(x.size):
                total += jacobian[k, j] * x[j]
            force[k] = total
        return crossed
    if balance.remembers[e]:
        remembered_spectrum(balance.address[e], law, x, balance.table, pace, force, jacobian, drift)
        stiffness[:], rate[:] = np.nan, np.nan
    else:
        smooth_spectrum(balance.address[e], law, x, balance.table, pace, force, stiffness, rate, drift)
        _toeplitz(stiffness, rate, pace, jacobian)
    return 0


@numba.njit(cache=True, error_model="numpy")
def forces_along(balance: Balance, points: Array, forces: ComplexArray, crossed: Array, counts: Array) -> None:
    """Force harmonics (points, m, H + 1) of scaled points, and of each connection with hinges the crossings.

    ``crossed`` (points, m, places, 3) takes (τ, hinge, rising), ``counts`` (points, m) how many there are.
    """
    n = points.shape[1] - 1
    m, count = forces.shape[1:]
    stiffness, rate = np.empty(n // m + 3, dtype=np.complex128), np.empty(n // m + 3, dtype=np.complex128)
    jacobian, drift = np.empty((count, 2 * count - 1), dtype=np.complex128), np.empty(count, dtype=np.complex128)
    for i in range(points.shape[0]):
        p = points[i, n] * balance.scale[n]
        speed = p if balance.by_speed == 1 else balance.fixed_speed
        z = points[i, :n] * balance.scale[:n]
        for e in range(m):
            counts[i, e] = force_harmonics(
                balance, e, z, speed, forces[i, e], jacobian, stiffness, rate, drift, crossed[i, e]
            )
