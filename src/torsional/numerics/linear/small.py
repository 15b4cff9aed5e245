"""Dense linear equations of a few dozen unknowns in compiled code, where a call to LAPACK costs more than the work."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray, IntArray

LEAST = 1e-250


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def factor(a: Array, order: IntArray) -> float:
    """LU factors in place with row exchanges in ``order``; the sign of the determinant, 0 for a singular matrix.

    A singular one is left half done, and ``order`` with it.
    """
    n, sign = a.shape[0], 1.0
    for k in range(n):
        best, largest = k, abs(a[k, k])
        for i in range(k + 1, n):
            if abs(a[i, k]) > largest:
                best, largest = i, abs(a[i, k])
        order[k] = best
        if not largest > 0.0:
            return 0.0
        if best != k:
            sign = -sign
            for j in range(n):
                a[k, j], a[best, j] = a[best, j], a[k, j]
        if a[k, k] < 0.0:
            sign = -sign
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            share = a[i, k] * inverse
            a[i, k] = share
            if share != 0.0:
                for j in range(k + 1, n):
                    a[i, j] -= share * a[k, j]
    return sign


@numba.njit(cache=True, error_model="numpy")
def backsolve(a: Array, order: IntArray, b: Array) -> None:
    """Solve in place for one right-hand side with the factors of `factor`."""
    n = a.shape[0]
    for k in range(n):
        b[k], b[order[k]] = b[order[k]], b[k]
    for i in range(1, n):
        for k in range(i):
            b[i] -= a[i, k] * b[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            b[k] -= a[k, j] * b[j]
        b[k] /= a[k, k]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def row_norms(a: Array, norms: Array) -> None:
    """Euclidean norms of the rows of a matrix that is about to be factored."""
    for i in range(a.shape[0]):
        row, total = a[i], 0.0
        for j in range(row.size):
            total += row[j] * row[j]
        norms[i] = np.sqrt(total)


@numba.njit(cache=True, error_model="numpy")
def scaled_determinant(a: Array, sign: float, norms: Array) -> float:
    """Determinant of factors over the product of the row norms: of order one, it passes through zero as that does."""
    value = sign
    for i in range(a.shape[0]):
        value *= abs(a[i, i]) / norms[i]
        if abs(value) < LEAST:  # of many unknowns the sign alone is kept
            value = sign * LEAST
    return value


@numba.njit(error_model="numpy", inline="always")
def _solved(a: Array | ComplexArray, b: Array | ComplexArray) -> None:
    """Elimination with row exchanges, in the arithmetic of what calls it; b is not a number where a is singular."""
    n, columns = b.shape
    for k in range(n):
        best, largest = k, abs(a[k, k])
        for i in range(k + 1, n):
            if abs(a[i, k]) > largest:
                best, largest = i, abs(a[i, k])
        if not largest > 0.0:
            b[:] = np.nan
            return
        if best != k:
            for j in range(k, n):
                a[k, j], a[best, j] = a[best, j], a[k, j]
            for j in range(columns):
                b[k, j], b[best, j] = b[best, j], b[k, j]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                ratio = a[i, k] / a[k, k]
                for j in range(k + 1, n):
                    a[i, j] -= ratio * a[k, j]
                for j in range(columns):
                    b[i, j] -= ratio * b[k, j]
    for k in range(n - 1, -1, -1):
        for i in range(k + 1, n):
            if a[k, i] != 0.0:
                for j in range(columns):
                    b[k, j] -= a[k, i] * b[i, j]
        for j in range(columns):
            b[k, j] /= a[k, k]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def solve(a: Array, b: Array) -> None:
    """Overwrite b (n, columns) with a⁻¹ b, and a with its triangle; b is not a number where a is singular.

    >>> a, b = np.array([[0.0, 2.0], [1.0, 0.0]]), np.array([[2.0], [3.0]])
    >>> solve(a, b)
    >>> b.tolist()
    [[3.0], [1.0]]
    """
    _solved(a, b)


@numba.njit(cache=True, error_model="numpy")
def complex_solve(a: ComplexArray, b: ComplexArray) -> None:
    """The same of complex numbers, whose products are rounded one by one."""
    _solved(a, b)
