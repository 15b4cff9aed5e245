"""Products z_e (w_e · x) of factored connections, for many designs and frequencies, without forming a matrix."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array, ComplexArray


@njit(cache=True, error_model="numpy")
def _combine(x: Array, weights: Array, sums: Array) -> None:
    """w·x for one row; ``x`` (n, 2F), real and imaginary part in turn."""
    sums[:] = 0.0
    for j in range(weights.size):
        w, row = weights[j], x[j]
        if w != 0.0:
            for f in range(sums.size):
                sums[f] += w * row[f]


@njit(cache=True, error_model="numpy")
def _multiply(sums: Array, values: Array, omega: Array, square: Array, out: Array) -> None:
    """(k + Ω²s + i(kη + ωc)) times the sums, ``values`` being k, kη, c, s."""
    k, h, c, s = values
    for f in range(omega.size):
        spring, loss = k + square[f] * s, h + omega[f] * c
        out[2 * f] = spring * sums[2 * f] - loss * sums[2 * f + 1]
        out[2 * f + 1] = spring * sums[2 * f + 1] + loss * sums[2 * f]


@njit(cache=True)
def _products(x: Array, weights: Array, values: Array, omega: Array, square: Array, out: Array) -> None:
    """``x`` (designs, n, 2F); ``values`` (designs or 1, rows, 4); ``out`` (designs, rows, 2F)."""
    sums = np.empty(x.shape[2])
    for d in range(x.shape[0]):
        own = values[min(d, values.shape[0] - 1)]
        for e in range(weights.shape[0]):
            _combine(x[d], weights[e], sums)
            _multiply(sums, own[e], omega, square, out[d, e])


def factor_products(
    x: ComplexArray,
    weights: Array,
    stiffness: ArrayLike,
    loss: ArrayLike,
    damping: ArrayLike,
    centrifugal: ArrayLike,
    omega: Array,
    speed: Array,
) -> ComplexArray:
    """(k(1 + iη) + iωc + Ω²s) w·x for every row of ``weights`` (rows, n), along the last axis of x (…, F, n).

    Values have one place a row, or (designs, rows) with x (designs, F, n).  Frequencies are innermost in memory, as in
    the response that x comes from.

    >>> factor_products(np.array([[1.0 + 0j, 3.0]]), np.array([[-1.0, 1.0]]), [10.0], [0.0], [0.5], [0.0],
    ...                 np.array([4.0]), np.array([0.0])).tolist()
    [[(20+4j)]]
    """
    stacked = x if x.ndim == 3 else x[np.newaxis]
    given = (np.atleast_2d(np.asarray(v, dtype=float)) for v in (stiffness, loss, damping, centrifugal))
    k, eta, c, s = np.broadcast_arrays(*given)
    out = np.empty((len(stacked), len(weights), omega.size), dtype=complex)
    inner = np.ascontiguousarray(stacked.transpose(0, 2, 1)).view(float)
    values = np.stack([k, k * eta, c, s], axis=-1)
    _products(inner, np.ascontiguousarray(weights), values, omega, speed**2, out.view(float))
    products = out.transpose(0, 2, 1)
    return products if x.ndim == 3 else products[0]
