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
from torsional.numerics.balance_data import Balance, harmonic_part, receptance_at, static_part
from torsional.numerics.hinge_spectrum import hinge_spectrum
from torsional.numerics.sampled_spectrum import remembered_spectrum, smooth_spectrum
from torsional.numerics.small_linear import backsolve, factor, scaled_determinant

MOST_ITERATIONS = 12
ENOUGH = 1e-9


@numba.njit(cache=True, error_model="numpy")
def own_motion(z: Array, connection: int, connections: int, x: Array) -> None:
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
    found: Array,
) -> int:
    """Harmonics of the law of connection e (H + 1,), their derivatives (H + 1, 2H + 1), tangent spectra, crossings."""
    m, count = balance.reference_stiffness.size, force.size
    x = np.empty(2 * count - 1)
    own_motion(z, e, m, x)
    law = balance.law_values[balance.law_start[e] : balance.law_start[e + 1]]
    pace = balance.base_order * speed
    if balance.address[e] == 0:
        offset = np.empty_like(stiffness)
        samples = balance.table @ x
        crossed = hinge_spectrum(law, x, samples, stiffness, offset, found)
        _toeplitz(stiffness, rate[:0], pace, jacobian)
        for k in range(count):
            total = -offset[k] if k == 0 else -2.0 * offset[k]
            for j in range(x.size):
                total += jacobian[k, j] * x[j]
            force[k] = total
        return crossed
    if balance.remembers[e]:
        remembered_spectrum(balance.address[e], law, x, balance.table, pace, force, jacobian)
        stiffness[:], rate[:] = np.nan, np.nan
    else:
        smooth_spectrum(balance.address[e], law, x, balance.table, pace, force, stiffness, rate)
        _toeplitz(stiffness, rate, pace, jacobian)
    return 0


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
    for h in range(1, count):
        harmonic_part(balance, h, p, speed, g, dg, b, db)
    force, own = np.empty((m, count), dtype=np.complex128), np.empty((m, count, 2 * count - 1), dtype=np.complex128)
    found = np.empty((0, 3))
    for e in range(m):
        force_harmonics(balance, e, z, speed, force[e], own[e], spectra[e, 0], spectra[e, 1], found)
    _less_reference(balance, z, speed, force, own)
    _gathered(balance, z, speed, (g, dg, b, db), force, own, residual, jacobian, slope)


@numba.njit(cache=True, error_model="numpy")
def _less_reference(balance: Balance, z: Array, speed: float, force: ComplexArray, own: ComplexArray) -> None:
    """Take the reference spring and damper off the force and its derivatives."""
    m, count = force.shape
    for e in range(m):
        k, c = balance.reference_stiffness[e], balance.reference_damping[e] * balance.base_order * speed
        force[e, 0] -= k * z[e]
        own[e, 0, 0] -= k
        for h in range(1, count):
            at = m * (2 * h - 1) + e
            reference = complex(k, h * c)
            force[e, h] -= reference * complex(z[at], z[at + m])
            own[e, h, 2 * h - 1] -= reference
            own[e, h, 2 * h] -= complex(-h * c, k)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _gathered(
    balance: Balance,
    z: Array,
    speed: float,
    linear: tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray],
    force: ComplexArray,
    own: ComplexArray,
    residual: Array,
    jacobian: Array,
    slope: Array,
) -> None:
    """The real equations from the complex ones, connection by connection."""
    g, dg, b, db = linear
    m, count = force.shape
    for h in range(count):
        for e in range(m):
            row = e if h == 0 else m * (2 * h - 1) + e
            x = complex(z[row], 0.0) if h == 0 else complex(z[row], z[row + m])
            total, rise = x - b[h, e], -db[h, e]
            for f in range(m):
                total += g[h, e, f] * force[f, h]
                rise += dg[h, e, f] * force[f, h]
                if balance.by_speed == 1 and h > 0:
                    at = m * (2 * h - 1) + f
                    pace = complex(0.0, h * balance.base_order * balance.reference_damping[f])
                    rise -= g[h, e, f] * pace * complex(z[at], z[at + m])
            residual[row], slope[row] = total.real, rise.real
            if h:
                residual[row + m], slope[row + m] = total.imag, rise.imag
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
def _bordered(balance: Balance, jacobian: Array, slope: Array, normal: Array, a: Array) -> None:
    """Scaled equations with the normal as their last row."""
    n = slope.size
    for i in range(n):
        inverse = 1.0 / balance.scale[i]
        for j in range(n):
            a[i, j] = jacobian[i, j] * inverse * balance.scale[j]
        a[i, n] = slope[i] * inverse * balance.scale[n]
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
    size, last = np.inf, np.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        equations(balance, z[:n] * balance.scale[:n], z[n] * balance.scale[n], residual, jacobian, slope, spectra)
        _bordered(balance, jacobian, slope, normal, a)
        step[:n] = residual / balance.scale[:n]
        step[n] = normal @ (z - guess)
        size = np.abs(step).max()
        if factor(a, order) == 0.0:
            return z, tangent, iteration, size, False, values
        backsolve(a, order, step)
        change = np.abs(step).max()
        if not np.isfinite(change) or (iteration > 3 and change > 4.0 * last):
            return z, tangent, iteration, size, False, values
        z -= step
        last = change
        if change <= ENOUGH:
            tangent[n] = 1.0
            backsolve(a, order, tangent)
            tangent /= np.sqrt(tangent @ tangent)
            tested(balance, z, tangent, jacobian, slope, spectra, values)
            return z, tangent, iteration, size, True, values
    return z, tangent, MOST_ITERATIONS, size, False, values


@numba.njit(cache=True, error_model="numpy")
def tested(
    balance: Balance, z: Array, tangent: Array, jacobian: Array, slope: Array, spectra: ComplexArray, values: Array
) -> None:
    """The bordered determinant (zero at branch points) and that of the odd half orders (zero at period doublings)."""
    n = slope.size
    order = np.empty(n + 1, dtype=np.int64)
    if values.size > 0:
        a = np.empty((n + 1, n + 1))
        _bordered(balance, jacobian, slope, tangent, a)
        values[0] = scaled_determinant(a, order)
    if values.size > 1:
        half = half_order_block(balance, z[n] * balance.scale[n], spectra)
        values[1] = scaled_determinant(half, np.empty(half.shape[0], dtype=np.int64))


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def half_order_block(balance: Balance, p: float, spectra: ComplexArray) -> Array:
    """The linearised equations of the odd multiples of ν/2, real, in the order of the unknowns."""
    m, count = spectra.shape[0], balance.half_orders
    speed = p if balance.by_speed == 1 else balance.fixed_speed
    block = np.zeros((2 * m * count, 2 * m * count))
    g, dg = np.empty((m, m), dtype=np.complex128), np.empty((m, m), dtype=np.complex128)
    for i in range(count):
        receptance_at(balance, (i + 0.5) * balance.base_order, speed, g, dg)
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
                    by_real, by_imaginary = g[e, f] * real, g[e, f] * imaginary
                    block[row, column], block[row + m, column] = by_real.real, by_real.imag
                    block[row, column + m], block[row + m, column + m] = by_imaginary.real, by_imaginary.imag
    for i in range(2 * m * count):
        block[i, i] += 1.0
    return block


@numba.njit(cache=True, error_model="numpy")
def forces_along(balance: Balance, points: Array, forces: ComplexArray, crossed: Array, counts: Array) -> None:
    """Force harmonics (points, m, H + 1) of scaled points, and of each connection with hinges the crossings.

    ``crossed`` (points, m, places, 3) takes (τ, hinge, rising), ``counts`` (points, m) how many there are.
    """
    n = points.shape[1] - 1
    m, count = forces.shape[1:]
    stiffness, rate = np.empty(n // m + 3, dtype=np.complex128), np.empty(n // m + 3, dtype=np.complex128)
    jacobian = np.empty((count, 2 * count - 1), dtype=np.complex128)
    for i in range(points.shape[0]):
        p = points[i, n] * balance.scale[n]
        speed = p if balance.by_speed == 1 else balance.fixed_speed
        z = points[i, :n] * balance.scale[:n]
        for e in range(m):
            counts[i, e] = force_harmonics(
                balance, e, z, speed, forces[i, e], jacobian, stiffness, rate, crossed[i, e]
            )


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
