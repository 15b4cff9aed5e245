"""Compiled modes of many designs: factors in, frequencies and shapes out, sixteen designs side by side.

Trap: the compiled code on disk is renewed when this file changes, not when ``jacobi`` does; touch both.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np
from numba import njit

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.modes.jacobi import counted, graded_rows, orthogonalize_rows, pivoted_qr

LANES = 16  # two vectors of eight doubles
TIE = 1e-6  # entries this close to the largest count as equally large, lest rounding choose the sign


@njit(cache=True)
def _own(shared: Array, design: int) -> Array:
    """The matrix of one design, or the one that all share."""
    matrix: Array = shared[min(design, len(shared) - 1)]
    return matrix


@njit(cache=True)
def _weighted(weights: Array, values: Array, order: IntArray) -> Array:
    """√value × weights of each lane, columns in the given order: (rows, columns, lanes)."""
    (lanes, rows), columns = values.shape, weights.shape[2]
    a = np.empty((rows, columns, lanes))
    for lane in range(lanes):
        for i in range(rows):
            root = np.sqrt(values[lane, i])
            for j in range(columns):
                a[i, j, lane] = root * _own(weights, lane)[i, order[j, lane]]
    return a


@njit(cache=True)
def _divide_right(a: Array, triangle: Array) -> None:
    """A := A R⁻¹ with R the upper triangle."""
    rows, columns, lanes = a.shape
    for j in range(columns):
        for i in range(j):
            if not np.any(triangle[i, j]):
                continue
            for row in range(rows):
                for lane in range(lanes):
                    a[row, j, lane] -= a[row, i, lane] * triangle[i, j, lane]
        for row in range(rows):
            for lane in range(lanes):
                a[row, j, lane] /= triangle[j, j, lane]


@njit(cache=True)
def _divide_left(a: Array, triangle: Array) -> None:
    """Aᵀ := R⁻¹ Aᵀ with R the upper triangle: from mass-weighted coordinates back to angles."""
    rows, columns, lanes = a.shape
    for i in range(columns - 1, -1, -1):
        for j in range(i + 1, columns):
            if not np.any(triangle[i, j]):
                continue
            for row in range(rows):
                for lane in range(lanes):
                    a[row, i, lane] -= triangle[i, j, lane] * a[row, j, lane]
        for row in range(rows):
            for lane in range(lanes):
                a[row, i, lane] /= triangle[i, i, lane]


@njit(cache=True)
def _normalized(a: Array, squares: Array, pivots: IntArray) -> Array:
    """Rows of unit length with the columns put back from their pivoted places; ``squares`` become the row lengths."""
    rank, lanes = squares.shape
    columns = a.shape[1]
    unit = np.empty((rank, columns, lanes))
    for i in range(rank):
        for lane in range(lanes):
            squares[i, lane] = np.sqrt(squares[i, lane])
        for j in range(columns):
            for lane in range(lanes):
                unit[i, pivots[j, lane], lane] = a[i, j, lane] / squares[i, lane]
    return unit


@njit(cache=True)
def _dot(a: Array, b: Array) -> float:
    total = 0.0
    for i in range(a.size):
        total += a[i] * b[i]
    return total


@njit(cache=True)
def _rigid(mass_weights: Array, inertia: Array, null: Array, shapes: Array) -> None:
    """The structural null vectors made orthonormal in M, twice over for safety, as the first ``shapes``."""
    nodes, count = null.shape
    masses = inertia.size
    momentum = np.zeros((count, masses))  # √J (w·θ): its square is twice the kinetic energy
    for z in range(count):
        for j in range(nodes):
            shapes[j, z] = null[j, z]
        for i in range(masses):
            momentum[z, i] = np.sqrt(inertia[i]) * _dot(mass_weights[i], shapes[:, z])
        for again in range(2 * z):
            other = again % z
            _add(momentum[z], -_dot(momentum[z], momentum[other]), momentum[other], shapes[:, z], shapes[:, other])
        norm = np.sqrt(_dot(momentum[z], momentum[z]))
        for i in range(masses):
            momentum[z, i] /= norm
        for j in range(nodes):
            shapes[j, z] /= norm


@njit(cache=True)
def _add(a: Array, share: float, b: Array, c: Array, d: Array) -> None:
    """a += share b and c += share d, unless the share is nothing: exact zeros stay."""
    if share != 0.0:
        for i in range(a.size):
            a[i] += share * b[i]
        for j in range(c.size):
            c[j] += share * d[j]


@njit(cache=True)
def _point_up(shapes: Array) -> None:
    """Make the largest entry of each column positive, the first one among equals."""
    nodes, count = shapes.shape
    for z in range(count):
        largest = 0.0
        for j in range(nodes):
            largest = max(largest, abs(shapes[j, z]))
        first = 0
        while first < nodes - 1 and abs(shapes[first, z]) < (1.0 - TIE) * largest:
            first += 1
        if shapes[first, z] < 0.0:
            for j in range(nodes):
                shapes[j, z] = -shapes[j, z]


@njit(cache=True)
def _ascending(values: Array) -> IntArray:
    """Indices that sort the values, by insertion: stable, and the pivoting has left little to do."""
    rank = np.empty(values.size, np.int64)
    for i in range(values.size):
        place = i
        while place > 0 and values[rank[place - 1]] > values[i]:
            rank[place] = rank[place - 1]
            place -= 1
        rank[place] = i
    return rank


@njit(cache=True)
def _sorted_out(unit: Array, frequency: Array, order: IntArray, omega: Array, shapes: Array) -> None:
    """Elastic modes of every lane in ascending order behind the rigid ones, columns back in their places."""
    count, nodes, lanes = unit.shape
    rigid = nodes - count
    for lane in range(lanes):
        rank = _ascending(frequency[:, lane])
        for i in range(count):
            omega[lane, rigid + i] = frequency[rank[i], lane]
            for j in range(nodes):
                shapes[lane, order[j, lane], rigid + i] = unit[rank[i], j, lane]


@njit(cache=True)
def _is_diagonal(mass_weights: Array) -> bool:
    """Whether each mass moves with one coordinate alone."""
    for i in range(mass_weights.shape[0]):
        count = 0
        for j in range(mass_weights.shape[1]):
            count += mass_weights[i, j] != 0.0
        if count > 1:
            return False
    return True


@njit(cache=True)
def _mass_triangle(weights: Array, inertia: Array, diagonal: bool) -> tuple[Array, IntArray]:
    """R of M = Rᵀ R and the order of its columns; roots of sums where M is diagonal."""
    lanes, nodes = len(inertia), weights.shape[2]
    order = counted(nodes, lanes)
    root = _weighted(weights, inertia, order)
    if not diagonal:
        return root, pivoted_qr(root, nodes)
    triangle = np.zeros((nodes, nodes, lanes))
    for j in range(nodes):
        for i in range(len(root)):
            for lane in range(lanes):
                triangle[j, j, lane] += root[i, j, lane] * root[i, j, lane]
        for lane in range(lanes):
            triangle[j, j, lane] = np.sqrt(triangle[j, j, lane])
    return triangle, order


@njit(cache=True)
def _chunk(
    w: Array, k: Array, v: Array, inertia: Array, null: Array, omega: Array, shapes: Array, diagonal: bool
) -> None:
    """Modes of one chunk of designs: the whole algorithm on one page."""
    lanes, nodes = omega.shape
    rigid = null.shape[2]
    mass, order = _mass_triangle(v, inertia, diagonal)
    elastic = _weighted(w, k, order)
    _divide_right(elastic, mass)
    elastic, pivots = graded_rows(elastic, nodes - rigid)
    frequency = orthogonalize_rows(elastic)
    unit = _normalized(elastic, frequency, pivots)
    _divide_left(unit, mass)
    omega[:, :rigid] = 0.0
    _sorted_out(unit, frequency, order, omega, shapes)
    for lane in range(lanes):
        _rigid(_own(v, lane), inertia[lane], _own(null, lane), shapes[lane])
        _point_up(shapes[lane])


@njit(cache=True)
def solve_designs(w: Array, k: Array, v: Array, inertia: Array, null: Array, omega: Array, shapes: Array) -> None:
    """Fill ``omega`` (designs, nodes) and ``shapes`` (designs, nodes, modes), a run of like designs at a time."""
    a = 0
    while a < len(k):
        diagonal, b = _is_diagonal(_own(v, a)), a + 1
        while b < min(a + LANES, len(k)) and (len(v) == 1 or _is_diagonal(_own(v, b)) == diagonal):
            b += 1
        w_ab = w[a:b] if len(w) > 1 else w
        v_ab = v[a:b] if len(v) > 1 else v
        null_ab = null[a:b] if len(null) > 1 else null
        _chunk(w_ab, k[a:b], v_ab, inertia[a:b], null_ab, omega[a:b], shapes[a:b], diagonal)
        a = b
