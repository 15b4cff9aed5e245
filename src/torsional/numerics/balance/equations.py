"""Harmonic balance on the connections that have a law: residual, Jacobian, tangent and test functions, compiled.

    R_h = X_h + G_h (F_h(X) − (k_r + ihνΩ c_r) X_h) − b_h,   h = 0 … H

A motion in multiples of ν/2 as well grows out of one in multiples of ν where the determinant of the same equations
for the odd multiples of ν/2, linearised, is zero: the period doubling.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.data import Balance, harmonic_parts, receptances_at, static_part
from torsional.numerics.balance.forces import force_harmonics
from torsional.numerics.linear.small import backsolve, factor, row_norms, scaled_determinant

MOST_ITERATIONS = 12
ENOUGH = 1e-9


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def equations(
    balance: Balance, z: Array, p: float, residual: Array, jacobian: Array, slope: Array, spectra: ComplexArray
) -> None:
    """R (n,), its Jacobian (n, n), its derivative by the parameter (n,), tangent ``spectra`` (m, 2, 2H + 2)."""
    m = balance.reference_stiffness.size
    count = (z.size // m + 1) // 2
    speed = p if balance.by_speed == 1 else balance.fixed_speed
    g, dg = np.zeros((count, m, m), dtype=np.complex128), np.zeros((count, m, m), dtype=np.complex128)
    b, db = np.zeros((count, m), dtype=np.complex128), np.zeros((count, m), dtype=np.complex128)
    static_part(balance, p, b, db)
    g[0] = balance.static
    harmonic_parts(balance, p, speed, g, dg, b, db)
    force, own = np.empty((m, count), dtype=np.complex128), np.empty((m, count, 2 * count - 1), dtype=np.complex128)
    drift, found = np.zeros((m, count), dtype=np.complex128), np.empty((0, 3))
    for e in range(m):
        force_harmonics(balance, e, z, speed, force[e], own[e], spectra[e, 0], spectra[e, 1], drift[e], found)
    by_speed = balance.by_speed * balance.base_order
    _less_reference(balance.reference_stiffness, balance.reference_damping, z, balance.base_order * speed, force, own)
    _values(balance.reference_damping, by_speed, z, g, dg, b, db, force, drift, residual, slope)
    _slopes(g, own, jacobian)


# Arrays are handed on one by one: all of a balance at once takes longer to hand on than this to compute.


@numba.njit(cache=True, error_model="numpy")
def _less_reference(
    stiffness: Array, damping: Array, z: Array, pace: float, force: ComplexArray, own: ComplexArray
) -> None:
    """Take the reference spring and damper off the force and its derivatives."""
    m, count = force.shape
    for e in range(m):
        k, c = stiffness[e], damping[e] * pace
        force[e, 0] -= k * z[e]
        own[e, 0, 0] -= k
        for h in range(1, count):
            at = m * (2 * h - 1) + e
            reference = complex(k, h * c)
            force[e, h] -= reference * complex(z[at], z[at + m])
            own[e, h, 2 * h - 1] -= reference
            own[e, h, 2 * h] -= complex(-h * c, k)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _values(
    damping: Array,
    by_speed: float,
    z: Array,
    g: ComplexArray,
    dg: ComplexArray,
    b: ComplexArray,
    db: ComplexArray,
    force: ComplexArray,
    drift: ComplexArray,
    residual: Array,
    slope: Array,
) -> None:
    """Residual and its derivative by the parameter; ``by_speed`` is ν where that is the speed, else 0."""
    m, count = force.shape
    for h in range(count):
        for e in range(m):
            row = e if h == 0 else m * (2 * h - 1) + e
            x = complex(z[row], 0.0) if h == 0 else complex(z[row], z[row + m])
            total, rise = x - b[h, e], -db[h, e]
            for f in range(m):
                total += g[h, e, f] * force[f, h]
                rise += dg[h, e, f] * force[f, h] + g[h, e, f] * by_speed * drift[f, h]
                if h > 0:
                    at = m * (2 * h - 1) + f
                    rise -= g[h, e, f] * complex(0.0, h * by_speed * damping[f]) * complex(z[at], z[at + m])
            residual[row], slope[row] = total.real, rise.real
            if h:
                residual[row + m], slope[row + m] = total.imag, rise.imag


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _slopes(g: ComplexArray, own: ComplexArray, jacobian: Array) -> None:
    """The Jacobian I + G dF in real form, connection by connection."""
    m, count = own.shape[0], own.shape[1]
    for h in range(count):
        for e in range(m):
            row = e if h == 0 else m * (2 * h - 1) + e
            for f in range(m):
                through = g[h, e, f]
                for j in range(2 * count - 1):
                    column = f if j == 0 else m * j + f
                    term = through * own[f, h, j]
                    jacobian[row, column] = term.real
                    if h:
                        jacobian[row + m, column] = term.imag
            jacobian[row, row] += 1.0
            if h:
                jacobian[row + m, row + m] += 1.0


@numba.njit(cache=True, error_model="numpy")
def bordered(scale: Array, jacobian: Array, slope: Array, normal: Array, a: Array) -> None:
    """Scaled equations with the normal as their last row."""
    n = slope.size
    for i in range(n):
        inverse = 1.0 / scale[i]
        for j in range(n):
            a[i, j] = jacobian[i, j] * inverse * scale[j]
        a[i, n] = slope[i] * inverse * scale[n]
    a[n] = normal


@numba.njit(cache=True, error_model="numpy")
def corrected(
    balance: Balance, guess: Array, normal: Array, tests: int
) -> tuple[Array, Array, int, float, bool, Array]:
    """Newton's method across the normal: z, tangent, iterations, residual, whether converged, values of the tests.

    All scaled.  ``tests``: 0 none; 1 the bordered determinant; 2 that of the odd half orders as well.
    """
    n = guess.size - 1
    z, a, order = guess.copy(), np.empty((n + 1, n + 1)), np.empty(n + 1, dtype=np.int64)
    residual, jacobian, slope = np.empty(n), np.empty((n, n)), np.empty(n)
    m = balance.reference_stiffness.size
    spectra = np.empty((m, 2, n // m + 3), dtype=np.complex128)
    tangent, step, values = np.zeros(n + 1), np.empty(n + 1), np.zeros(tests)
    norms, size, last = np.empty(n + 1), np.inf, np.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        equations(balance, z[:n] * balance.scale[:n], z[n] * balance.scale[n], residual, jacobian, slope, spectra)
        bordered(balance.scale, jacobian, slope, normal, a)
        step[:n] = residual / balance.scale[:n]
        step[n] = normal @ (z - guess)
        size = np.abs(step).max()
        row_norms(a, norms)
        sign = factor(a, order)
        if sign == 0.0:
            break
        backsolve(a, order, step)
        change = np.abs(step).max()
        if not np.isfinite(change) or (iteration > 3 and change > 4.0 * last):
            break
        z -= step
        last = change
        if change <= ENOUGH * max(1.0, np.abs(z).max()):
            tangent[n] = 1.0
            backsolve(a, order, tangent)
            tangent /= np.sqrt(tangent @ tangent)
            if tests > 0:  # with the tangent in place of the normal the determinant is that much larger
                values[0] = scaled_determinant(a, sign, norms) / (normal @ tangent)
            if tests > 1:
                values[1] = doubling_test(balance, z[n] * balance.scale[n], spectra)
            return z, tangent, iteration, size, True, values
    return z, tangent, MOST_ITERATIONS, size, False, values


@numba.njit(cache=True, error_model="numpy")
def doubling_test(balance: Balance, p: float, spectra: ComplexArray) -> float:
    """The scaled determinant of the odd half orders, zero at period doublings."""
    half = half_order_block(balance, p, spectra)
    norms = np.empty(half.shape[0])
    row_norms(half, norms)
    sign = factor(half, np.empty(half.shape[0], dtype=np.int64))
    return scaled_determinant(half, sign, norms)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def half_order_block(balance: Balance, p: float, spectra: ComplexArray) -> Array:
    """The linearised equations of the odd multiples of ν/2, real, in the order of the unknowns."""
    m, count = spectra.shape[0], balance.half_orders
    speed = p if balance.by_speed == 1 else balance.fixed_speed
    block = np.zeros((2 * m * count, 2 * m * count))
    g, dg = np.empty((count, m, m), dtype=np.complex128), np.empty((count, m, m), dtype=np.complex128)
    orders = np.empty(count)
    for i in range(count):
        orders[i] = (i + 0.5) * balance.base_order
    receptances_at(balance, orders, speed, g, dg)
    for i in range(count):
        for f in range(m):
            reference = balance.reference_damping[f] * balance.base_order * speed
            for j in range(count):
                turn = complex(0.0, (j + 0.5) * balance.base_order * speed)
                near = spectra[f, 0, i - j] if i >= j else spectra[f, 0, j - i].conjugate()
                far = spectra[f, 0, i + j + 1]
                if balance.address[f] != 0:
                    near += turn * (spectra[f, 1, i - j] if i >= j else spectra[f, 1, j - i].conjugate())
                    far -= turn * spectra[f, 1, i + j + 1]
                if i == j:
                    near -= complex(balance.reference_stiffness[f], (j + 0.5) * reference)
                real, imaginary = near + far, complex(far.imag - near.imag, near.real - far.real)
                for e in range(m):
                    row, column = 2 * m * i + e, 2 * m * j + f
                    by_real, by_imaginary = g[i, e, f] * real, g[i, e, f] * imaginary
                    block[row, column], block[row + m, column] = by_real.real, by_real.imag
                    block[row, column + m], block[row + m, column + m] = by_imaginary.real, by_imaginary.imag
    for i in range(2 * m * count):
        block[i, i] += 1.0
    return block


@numba.njit(cache=True, error_model="numpy")
def corrected_at(balance: Balance, guesses: Array) -> tuple[Array, Array]:
    """Newton's method at the parameters of many scaled guesses (points, n + 1): points, and 1 where it converged."""
    out, good = guesses.copy(), np.zeros(guesses.shape[0])
    normal = np.zeros(guesses.shape[1])
    normal[-1] = 1.0
    for i in range(guesses.shape[0]):
        z, _, _, _, converged, _ = corrected(balance, guesses[i], normal, 0)
        if converged:
            out[i], good[i] = z, 1.0
    return out, good
