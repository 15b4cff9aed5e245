"""Compiled kernel of the undamped modes: generalised singular values to high relative accuracy, designs side by side.

The designs lie in the last axis ("lanes") of every work array, so that each operation of the algorithm is one vector
instruction over several designs.  Nothing here may be compiled with ``fastmath``: plain IEEE operations in one fixed
order make the result of a design the same bits, whatever lies in the lanes beside it.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np
from numba import njit

from torsional.numerics.arrays import Array, IntArray

SWEEPS = 60  # four to seven are usual


CANCELLED = 1e-14  # a difference this small against its terms is a zero that rounding has blurred


@njit(cache=True)
def counted(columns: int, lanes: int) -> IntArray:
    order = np.empty((columns, lanes), np.int64)
    for j in range(columns):
        for lane in range(lanes):
            order[j, lane] = j
    return order


@njit(cache=True)
def _swap_rows(a: Array, i: int, j: int, lane: int) -> None:
    for t in range(a.shape[1]):
        a[i, t, lane], a[j, t, lane] = a[j, t, lane], a[i, t, lane]


@njit(cache=True)
def _swap_columns(a: Array, order: IntArray, i: int, j: int, lane: int) -> None:
    order[i, lane], order[j, lane] = order[j, lane], order[i, lane]
    for t in range(a.shape[0]):
        a[t, i, lane], a[t, j, lane] = a[t, j, lane], a[t, i, lane]


@njit(cache=True)
def _sort_rows(a: Array) -> None:
    """IntArray the rows by their largest entry, largest first: Householder steps are then stable row by row."""
    rows, columns, lanes = a.shape
    largest = np.zeros((rows, lanes))
    for i in range(rows):
        for j in range(columns):
            for lane in range(lanes):
                largest[i, lane] = max(largest[i, lane], abs(a[i, j, lane]))
    for lane in range(lanes):
        for i in range(rows - 1):
            best = i + int(np.argmax(largest[i:, lane]))
            if best != i:
                _swap_rows(a, i, best, lane)
                largest[best, lane] = largest[i, lane]


@njit(cache=True)
def _pivot(a: Array, step: int, order: IntArray, squares: Array) -> None:
    """Bring the column with the largest remainder to the place ``step``."""
    rows, columns, lanes = a.shape
    squares[step:] = 0.0
    for i in range(step, rows):
        for j in range(step, columns):
            for lane in range(lanes):
                squares[j, lane] += a[i, j, lane] * a[i, j, lane]
    for lane in range(lanes):
        best = step
        for j in range(step + 1, columns):
            if squares[j, lane] > squares[best, lane]:
                best = j
        if best != step:
            squares[step, lane] = squares[best, lane]
            _swap_columns(a, order, step, best, lane)


@njit(cache=True)
def _reflect(a: Array, step: int, square: Array, head: Array, dot: Array) -> None:
    """Householder step: clear the column ``step`` below its diagonal."""
    rows, columns, lanes = a.shape
    for lane in range(lanes):
        pivot = a[step, step, lane]
        norm = np.sqrt(square[lane])
        reach = norm * (norm + abs(pivot))
        square[lane] = 1.0 / reach if reach > 0.0 else 0.0
        head[lane] = -norm if pivot >= 0.0 else norm
        a[step, step, lane] = pivot - head[lane]
    for j in range(step + 1, columns):
        dot[:] = 0.0
        for i in range(step, rows):
            for lane in range(lanes):
                dot[lane] += a[i, step, lane] * a[i, j, lane]
        for lane in range(lanes):
            dot[lane] *= square[lane]
        for i in range(step, rows):
            for lane in range(lanes):
                a[i, j, lane] -= a[i, step, lane] * dot[lane]
    a[step, step] = head
    a[step + 1 :, step] = 0.0


@njit(cache=True)
def pivoted_qr(a: Array, rank: int) -> IntArray:
    """Overwrite a (rows, columns, lanes) with R of A P = Q R; returns the pivoted order of the columns.

    Rows sorted and columns pivoted: accurate for diagonal × well-conditioned × diagonal however wild the two diagonals
    are.  Source: Higham, Linear Algebra Appl. 309 (2000) 153, doi 10.1016/S0024-3795(99)00230-X.
    """
    columns, lanes = a.shape[1:]
    order = counted(columns, lanes)
    squares, head, dot = np.empty((columns, lanes)), np.empty(lanes), np.empty(lanes)
    _sort_rows(a)
    for step in range(rank):
        _pivot(a, step, order, squares)
        _reflect(a, step, squares[step], head, dot)
    return order


@njit(cache=True)
def _largest(a: Array, step: int, size: Array, row: IntArray, column: IntArray) -> None:
    """Place of the largest remaining entry of every lane."""
    rows, columns, lanes = a.shape
    for lane in range(lanes):
        size[lane], row[lane], column[lane] = 0.0, step, step
    for i in range(step, rows):
        for j in range(step, columns):
            for lane in range(lanes):
                larger = abs(a[i, j, lane]) > size[lane]
                size[lane] = abs(a[i, j, lane]) if larger else size[lane]
                row[lane] = i if larger else row[lane]
                column[lane] = j if larger else column[lane]


@njit(cache=True)
def _clear(a: Array, step: int, factor: Array) -> None:
    """Elimination step below the pivot; the factors stay where they made zeros."""
    rows, columns, lanes = a.shape
    for i in range(step + 1, rows):
        if not np.any(a[i, step]):
            continue
        for lane in range(lanes):
            pivot = a[step, step, lane]
            factor[lane] = a[i, step, lane] / (pivot if pivot != 0.0 else 1.0)
            a[i, step, lane] = factor[lane]
        for j in range(step + 1, columns):
            for lane in range(lanes):
                term = factor[lane] * a[step, j, lane]
                rest = a[i, j, lane] - term
                a[i, j, lane] = rest if abs(rest) > CANCELLED * abs(term) else 0.0


@njit(cache=True)
def _eliminate_completely(a: Array, rank: int) -> IntArray:
    """Overwrite a (rows, columns, lanes) with L and D U of P A Q = L D U; returns the pivoted order of the columns.

    Complete pivoting gives each factor small relative errors when A is an incidence matrix between two diagonals, which
    is what a network of shafts and inertias is.  Source: Demmel, Gu, Eisenstat, Slapničar, Veselić and Drmač, Linear
    Algebra Appl. 299 (1999) 21, doi 10.1016/S0024-3795(99)00134-2.
    """
    columns, lanes = a.shape[1:]
    order = counted(columns, lanes)
    size, row, column = np.empty(lanes), np.empty(lanes, np.int64), np.empty(lanes, np.int64)
    for step in range(rank):
        _largest(a, step, size, row, column)
        for lane in range(lanes):
            if row[lane] != step:
                _swap_rows(a, step, row[lane], lane)
            if column[lane] != step:
                _swap_columns(a, order, step, column[lane], lane)
        _clear(a, step, size)
    return order


@njit(cache=True)
def graded_rows(a: Array, rank: int) -> tuple[Array, IntArray]:
    """X (rank, columns, lanes) with A Q = (orthogonal) X, rows graded and well-conditioned, and the column order Q.

    A = L D U first, then L D P = (orthogonal) R and X = R Pᵀ U; a is overwritten.
    """
    rows, columns, lanes = a.shape
    order = _eliminate_completely(a, rank)
    lower, upper = np.zeros((rows, rank, lanes)), np.zeros((rank, columns, lanes))
    for k in range(rank):
        lower[k, k] = a[k, k]
        for i in range(k + 1, rows):
            for lane in range(lanes):
                lower[i, k, lane] = a[i, k, lane] * a[k, k, lane]
    turned = pivoted_qr(lower, rank)
    for i in range(rank):
        for lane in range(lanes):
            k = turned[i, lane]
            pivot = a[k, k, lane]
            for j in range(k, columns):
                upper[i, j, lane] = a[k, j, lane] / (pivot if pivot != 0.0 else 1.0)
    return _product(lower, upper), order


@njit(cache=True)
def _product(triangle: Array, b: Array) -> Array:
    """Upper triangle times b."""
    rank, columns, lanes = b.shape
    x = np.zeros((rank, columns, lanes))
    for i in range(rank):
        for k in range(i, rank):
            for j in range(columns):
                for lane in range(lanes):
                    x[i, j, lane] += triangle[i, k, lane] * b[k, j, lane]
    return x


@njit(cache=True)
def _must_turn(dot: Array, p: Array, q: Array, squared_tolerance: float) -> bool:
    turned = False
    for lane in range(dot.size):
        turned |= dot[lane] * dot[lane] > squared_tolerance * p[lane] * q[lane]
    return turned


@njit(cache=True)
def _angles(dot: Array, p: Array, q: Array, cosine: Array, sine: Array, squared_tolerance: float) -> None:
    """Jacobi angles that make two rows orthogonal, given their product and squared norms, which are brought up to date.

    tan 2φ = 2 p·q / (q² − p²), written with one division and two roots; an angle is zero where none is needed.
    """
    for lane in range(dot.size):
        product = dot[lane]
        turn = product * product > squared_tolerance * p[lane] * q[lane]
        twice = 2.0 * product if turn else 0.0
        apart = q[lane] - p[lane] if turn else 1.0
        far = abs(apart) + np.sqrt(apart * apart + twice * twice)
        root = np.sqrt(far * far + twice * twice)
        inverse = 1.0 / (far * root)
        signed = twice if apart >= 0.0 else -twice
        cosine[lane] = far * far * inverse if turn else 1.0
        sine[lane] = signed * far * inverse
        shift = signed * root * inverse * product
        p[lane] -= shift
        q[lane] += shift


@njit(cache=True)
def _turn(p: Array, q: Array, cosine: Array, sine: Array) -> None:
    for t in range(p.shape[0]):
        for lane in range(p.shape[1]):
            a, b = p[t, lane], q[t, lane]
            p[t, lane] = cosine[lane] * a - sine[lane] * b
            q[t, lane] = sine[lane] * a + cosine[lane] * b


@njit(cache=True)
def orthogonalize_rows(a: Array) -> Array:
    """Rotate the rows of a (rows, columns, lanes) until they are orthogonal; returns their squared norms.

    One-sided Jacobi: each singular value keeps its own relative accuracy.  Source: Demmel and Veselić, SIAM J. Matrix
    Anal. Appl. 13 (1992) 1204, doi 10.1137/0613074; on the triangle of a pivoted QR it converges in few sweeps: Drmač
    and Veselić, SIAM J. Matrix Anal. Appl. 29 (2008) 1322, doi 10.1137/050639193.  A lane that has converged turns no
    more, so its neighbours cannot change it.
    """
    rank, columns, lanes = a.shape
    tolerance = (columns * 2.3e-16) ** 2  # of the square of the cosine between two rows
    squares = np.empty((rank, lanes))
    dot, cosine, sine = np.empty(lanes), np.empty(lanes), np.empty(lanes)
    for _ in range(SWEEPS):
        squares[:] = 0.0
        for i in range(rank):
            for t in range(columns):
                for lane in range(lanes):
                    squares[i, lane] += a[i, t, lane] * a[i, t, lane]
        turned = False
        for i in range(rank - 1):
            for j in range(i + 1, rank):
                dot[:] = 0.0
                for t in range(columns):
                    for lane in range(lanes):
                        dot[lane] += a[i, t, lane] * a[j, t, lane]
                if _must_turn(dot, squares[i], squares[j], tolerance):
                    _angles(dot, squares[i], squares[j], cosine, sine, tolerance)
                    _turn(a[i], a[j], cosine, sine)
                    turned = True
        if not turned:
            break
    return squares
