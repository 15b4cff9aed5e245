"""Matrix exponential, compiled, so that compiled loops can call it."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array

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
def exponential(matrix: Array) -> Array:
    """exp(A) of a real square matrix by scaling and squaring of the Padé approximant of degree 13.

    N. J. Higham, The scaling and squaring method for the matrix exponential revisited, SIAM J. Matrix Anal. Appl. 26
    (2005) 1179-1193.

    >>> exponential(np.array([[0.0, 1.0], [0.0, 0.0]])).round(14)
    array([[1., 1.],
           [0., 1.]])
    """
    norm, squarings, b = 0.0, 0, PADE
    for j in range(matrix.shape[1]):
        norm = max(norm, np.abs(matrix[:, j]).sum())
    while norm > LARGEST:
        norm, squarings = 0.5 * norm, squarings + 1
    a, one = matrix / 2.0**squarings, np.eye(matrix.shape[0])
    a2 = a @ a
    a4 = a2 @ a2
    a6 = a2 @ a4
    odd = a @ (a6 @ (b[13] * a6 + b[11] * a4 + b[9] * a2) + b[7] * a6 + b[5] * a4 + b[3] * a2 + b[1] * one)
    even = a6 @ (b[12] * a6 + b[10] * a4 + b[8] * a2) + b[6] * a6 + b[4] * a4 + b[2] * a2 + b[0] * one
    grown = np.ascontiguousarray(np.linalg.solve(even - odd, even + odd))
    for _ in range(squarings):
        grown = grown @ grown
    return grown
