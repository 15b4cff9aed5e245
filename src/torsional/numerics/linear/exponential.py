"""Matrix exponential, compiled, so that compiled loops can call it."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.linear.small import solve

LARGEST = 5.371920351148152  # 1-norm up to which the approximant of degree 13 is exact to rounding
PADE = (
    64764752532480000.0,
    32382376266240000.0,
    7771770303897600.0,
    1187353796428800.0,
    129060195264000.0,
    10559470521600.0,
    670442572800.0,
    33522128640.0,
    1323241920.0,
    40840800.0,
    960960.0,
    16380.0,
    182.0,
    1.0,
)


@numba.njit(cache=True, error_model="numpy")
def _sum(c6: float, a6: Array, c4: float, a4: Array, c2: float, a2: Array, c0: float) -> Array:
    out = np.empty_like(a2)
    for i in range(a2.shape[0]):
        for j in range(a2.shape[1]):
            out[i, j] = c6 * a6[i, j] + c4 * a4[i, j] + c2 * a2[i, j]
        out[i, i] += c0
    return out


@numba.njit(cache=True, error_model="numpy")
def _scaled(matrix: Array) -> tuple[Array, int]:
    """The matrix divided by so many powers of two that its 1-norm is within the approximant's reach."""
    norm, squarings, share = 0.0, 0, 1.0
    for j in range(matrix.shape[1]):
        total = 0.0
        for i in range(matrix.shape[0]):
            total += abs(matrix[i, j])
        norm = max(norm, total)
    while norm * share > LARGEST and squarings < 1000:
        share, squarings = 0.5 * share, squarings + 1
    out = np.empty(matrix.shape)
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            out[i, j] = share * matrix[i, j]
    return out, squarings


@numba.njit(cache=True, error_model="numpy")
def _pade(a: Array) -> tuple[Array, Array]:
    """Even and odd part p, q of the approximant (p − q)⁻¹ (p + q)."""
    b = PADE
    a2 = a @ a
    a4 = a2 @ a2
    a6 = a2 @ a4
    odd = a6 @ _sum(b[13], a6, b[11], a4, b[9], a2, 0.0)
    odd = a @ (odd + _sum(b[7], a6, b[5], a4, b[3], a2, b[1]))
    even = a6 @ _sum(b[12], a6, b[10], a4, b[8], a2, 0.0) + _sum(b[6], a6, b[4], a4, b[2], a2, b[0])
    return even, odd


@numba.njit(cache=True, error_model="numpy")
def exponential(matrix: Array) -> Array:
    """exp(A) of a real square matrix by scaling and squaring of the Padé approximant of degree 13.

    N. J. Higham, The scaling and squaring method for the matrix exponential revisited, SIAM J. Matrix Anal. Appl. 26
    (2005) 1179-1193.

    >>> exponential(np.array([[0.0, 1.0], [0.0, 0.0]])).round(14)
    array([[1., 1.],
           [0., 1.]])
    """
    scaled, squarings = _scaled(matrix)
    even, odd = _pade(scaled)
    below, grown = even - odd, even + odd
    solve(below, grown)
    for _ in range(squarings):
        grown = grown @ grown
    return grown


@numba.njit(cache=True, error_model="numpy")
def exponential_less_one(matrix: Array) -> Array:
    """exp(A) − 1 without the cancellation, for thousands of small steps z + (exp(A) − 1) z that must not drift.

    >>> round(float(exponential_less_one(np.array([[1e-12]]))[0, 0] * 1e12), 6)
    1.0
    """
    scaled, squarings = _scaled(matrix)
    even, odd = _pade(scaled)
    below, gain = even - odd, 2.0 * odd
    solve(below, gain)
    for _ in range(squarings):
        gain = gain @ gain + 2.0 * gain
    return gain
