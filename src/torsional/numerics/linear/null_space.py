"""Exact elimination of linear conditions ``weights · θ = 0`` and structural null spaces.

Gauss–Jordan elimination on the weights themselves, with complete pivoting.  A sum that cancels to 1e-12 of its terms
is taken as zero, so ranks are counted, not guessed from rounding; ones stay exactly one.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from torsional.numerics.arrays import Array, IntArray

CANCELLED = 1e-12  # a sum this small against its terms is a zero that rounding has blurred
TIE = 1e-9  # coefficients this close to the largest count as equally large, lest rounding choose the pivot

Rows = Sequence[Mapping[int, float]] | Array


@njit(cache=True)
def _largest(a: Array, done: int, width: int, used: NDArray[np.bool_]) -> tuple[int, int]:
    """Row and column of the next pivot: the largest entry of the remaining rows, the later column among equals."""
    row, column, largest = -1, -1, 0.0
    for i in range(done, a.shape[0]):
        for j in range(width):
            size = abs(a[i, j])
            if not used[j] and size > 0.0:
                tied = abs(size - largest) <= TIE * largest
                if (not tied and size > largest) or (tied and j > column):
                    row, column, largest = i, j, max(size, largest)
    return row, column


@njit(cache=True)
def _subtract(a: Array, i: int, pivot: int, column: int) -> None:
    """Clear ``a[i, column]`` with the pivot row, whose entry there is one."""
    factor = a[i, column]
    for j in range(a.shape[1]):
        if a[pivot, j] != 0.0:
            term = factor * a[pivot, j]
            rest = a[i, j] - term
            a[i, j] = 0.0 if abs(rest) <= CANCELLED * (abs(a[i, j]) + abs(term)) else rest
    a[i, column] = 0.0


@njit(cache=True)
def _reduce(a: Array, width: int, used: NDArray[np.bool_]) -> IntArray:
    """Bring the first ``width`` columns of a to reduced echelon form in place; returns the pivot column of each row.

    ``used`` marks columns that may not become pivots; the pivots are added to it.  Rows of ``a`` may be exchanged.
    """
    pivots = np.full(a.shape[0], -1)
    for step in range(a.shape[0]):
        row, column = _largest(a, step, width, used)
        if row < 0:
            break
        largest = a[row, column]
        for j in range(a.shape[1]):
            pivot = a[row, j] / largest
            a[row, j] = a[step, j]
            a[step, j] = pivot
        for i in range(a.shape[0]):
            if i != step and a[i, column] != 0.0:
                _subtract(a, i, step, column)
        pivots[step], used[column] = column, True
    return pivots


@njit(cache=True)
def _null(weights: Array) -> Array:
    columns = weights.shape[1]
    a, used = weights.copy(), np.zeros(columns, np.bool_)
    pivots = _reduce(a, columns, used)
    free = np.flatnonzero(~used)
    vectors = np.zeros((columns, free.size))
    for z in range(free.size):
        vectors[free[z], z] = 1.0
        for i in range(pivots.size):
            if pivots[i] >= 0:
                vectors[pivots[i], z] = 0.0 - a[i, free[z]]
    return vectors


def null_vectors(weights: ArrayLike) -> Array:
    """Structural null space of elastic rows: the combinations of angles that load none of them, the rigid modes.

    ``weights`` (rows, columns) → (columns, modes).  A network of plain shafts has one vector of exact ones and zeros
    for each part that is connected and not held.

    >>> null_vectors([[-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 1.0]]).T
    array([[1., 1., 0., 0.],
           [0., 0., 1., 1.]])
    """
    return np.asarray(_null(np.ascontiguousarray(np.atleast_2d(np.asarray(weights, dtype=float)))))


def transformed(weights: ArrayLike, transform: ArrayLike) -> Array:
    """Rows of weights on θ = T q as rows on q, W T, with the sums that cancel set to exactly zero.

    ``weights`` (rows, nodes), ``transform`` (nodes, independent) → (rows, independent).

    >>> transformed([[1.0, -3.0]], [[0.3], [0.1]])
    array([[0.]])
    """
    w, t = np.atleast_2d(np.asarray(weights, dtype=float)), np.asarray(transform, dtype=float)
    product, size = w @ t, np.abs(w) @ np.abs(t)
    return np.where(np.abs(product) <= CANCELLED * size, 0.0, product)


@dataclass(frozen=True, slots=True)
class Loop:
    """Conditions (``rows``, ascending) that close a loop: one too many, or together they lock ``node``."""

    rows: tuple[int, ...]
    node: int | None = None


@dataclass(frozen=True, slots=True)
class Elimination:
    """θ = ``transform`` q, with ``transform`` (nodes, independent) and the nodes that q lists in ``independent``.

    ``redundant``: loops of which any one condition follows from the others.  ``locked``: loops that contradict
    themselves, so that a node that is not held stands still.
    """

    transform: Array
    independent: tuple[int, ...]
    redundant: tuple[Loop, ...]
    locked: tuple[Loop, ...]


def _dense(weights: Rows, nodes: int) -> Array:
    if isinstance(weights, np.ndarray):
        return np.array(weights, dtype=float).reshape(-1, nodes)
    rows = np.zeros((len(weights), nodes))
    for i, row in enumerate(weights):
        for node, weight in row.items():
            rows[i, node] += weight
    return rows


def _loop(tracked: Array, node: int | None = None) -> Loop:
    return Loop(tuple(int(row) for row in np.flatnonzero(tracked)), node)


def eliminate(weights: Rows, nodes: int, ground: int | None = None) -> Elimination:
    """Solve the conditions ``weights · θ = 0`` once and for all: θ = transform · q.

    ``weights``: one mapping {node index: weight} a condition, or an array (conditions, nodes).  ``ground`` is a node
    that stands still; it is kept as a variable until the end, so that a part held by it is told from a part that
    contradictory conditions lock.  The node of the largest weight becomes dependent, the later one among equals.

    A planetary gear set θ2 = (1−g) θ0 + g θ1 with g = 3:

    >>> eliminate([{2: -1.0, 0: -2.0, 1: 3.0}], nodes=3).transform
    array([[1.        , 0.        ],
           [0.66666667, 0.33333333],
           [0.        , 1.        ]])
    """
    rows = _dense(weights, nodes)
    reduced, held = np.hstack([rows, np.eye(len(rows))]), np.zeros(nodes, bool)
    if ground is not None:
        held[ground] = True
    used = held.copy()
    pivots = _reduce(reduced, nodes, used)
    free = np.flatnonzero(~used)
    transform = np.zeros((nodes, free.size))
    transform[free, np.arange(free.size)] = 1.0
    taken = pivots >= 0
    transform[pivots[taken]] = 0.0 - reduced[np.ix_(taken, free)]
    alone = taken & (np.count_nonzero(reduced[:, :nodes], axis=1) == 1)
    return Elimination(
        transform,
        tuple(int(node) for node in free),
        tuple(_loop(row[nodes:]) for row in reduced[~taken]),
        tuple(_loop(reduced[i, nodes:], int(pivots[i])) for i in np.flatnonzero(alone)),
    )
