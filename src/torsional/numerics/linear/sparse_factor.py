"""LDLᵀ of a sparse symmetric positive definite matrix whose pattern never changes: order and tape once, then numbers.

Values live in one flat array: the diagonal in the order of elimination, then the couplings below it column by column.
The order takes out nodes with the fewest neighbours first and, among equals, those that wait for the fewest others, so
that the shoes of a spring channel come before the bodies they slide between, and neighbours do not queue up.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from torsional.numerics.arrays import Array
from torsional.numerics.uncounted import uncounted

PlaceArray = NDArray[np.uint32]

LEVEL, COUPLED, UPDATED = range(3)
"""Rows of ``levels``."""
COLUMN, ROW = range(2)
"""Rows of ``couplings``."""
TARGET, LEFT, RIGHT = range(3)
"""Rows of ``updates``."""


class Tape(NamedTuple):
    """What factor and solve follow.  Positions count in the order of elimination, slots in the flat array.

    ``node`` (n,) is the coordinate at each position.  ``levels`` (3, levels + 1): positions of one level, from LEVEL to
    the next, do not depend on each other; their couplings are those from COUPLED on, their updates those from UPDATED
    on.  ``couplings`` (2, …): COLUMN and ROW, positions.  ``updates`` (3, …): a[TARGET] −= l[LEFT] a[RIGHT], slots,
    LEFT counted among couplings.
    """

    node: PlaceArray
    levels: PlaceArray
    couplings: PlaceArray
    updates: PlaceArray


def places(values: Iterable[int]) -> PlaceArray:
    """Indices as compiled code likes them: without a sign, so that none counts from the end."""
    return np.array(list(values), dtype=np.uint32)


def elimination(supports: Sequence[set[int]], n: int) -> list[tuple[int, int, set[int]]]:
    """(node, level, neighbours left) in the order of elimination, levels rising.

    >>> [(node, level) for node, level, _ in elimination([{0, 1}, {1, 2}, {2, 3}], 4)]
    [(0, 0), (3, 0), (1, 1), (2, 2)]
    """
    joined: list[set[int]] = [set() for _ in range(n)]
    for support in supports:
        for i, j in combinations(support, 2):
            joined[i].add(j)
            joined[j].add(i)
    level, left, found = [0] * n, set(range(n)), []
    while left:
        node = min(left, key=lambda i: (len(joined[i]), level[i], i))
        left.remove(node)
        found.append((node, level[node], set(joined[node])))
        for i in joined[node]:
            joined[i] |= joined[node] - {i}
            joined[i].discard(node)
            level[i] = max(level[i], level[node] + 1)
    return sorted(found, key=lambda one: one[1])


def tape_of(supports: Sequence[set[int]], n: int) -> Tape:
    """The tape of an (n, n) matrix that couples the coordinates of each support.

    >>> tape_of([{0, 1}, {1, 2}], 3).node.tolist()
    [0, 2, 1]
    """
    order = elimination(supports, n)
    position = {node: p for p, (node, _, _) in enumerate(order)}
    below = [sorted(position[j] for j in neighbours) for _, _, neighbours in order]
    levels = [level for _, level, _ in order]
    couplings, slots, updates, coupled, updated = [], {}, [], [0], [0]
    starts = [p for p in range(n) if p == 0 or levels[p] != levels[p - 1]] + [n]
    for first, last in pairwise(starts):
        members = range(first, last)
        for k in range(max(len(below[p]) for p in members)):  # in turn, so that no node is written to twice in a row
            couplings += [(p, below[p][(k + p) % len(below[p])]) for p in members if k < len(below[p])]
        slots = {pair: n + slot for slot, pair in enumerate(couplings)} | {(p, p): p for p in range(n)}
        coupled.append(len(couplings))
        updates += [(i, j, p) for p in members for a, j in enumerate(below[p]) for i in below[p][a:]]
        updated.append(len(updates))
    taken = [(slots[j, i], slots[p, i] - n, slots[p, j]) for i, j, p in updates]
    return Tape(
        node=places(node for node, _, _ in order),
        levels=np.array([starts, coupled, updated], dtype=np.uint32),
        couplings=np.array(couplings, dtype=np.uint32).reshape(-1, 2).T.copy(),
        updates=np.array(taken, dtype=np.uint32).reshape(-1, 3).T.copy(),
    )


@uncounted()
def factor(tape: Tape, matrix: Array, lower: Array, inverse: Array) -> bool:
    """LDLᵀ of ``matrix`` (slots,), which is used up: ``lower`` (couplings,) and ``inverse`` (n,) = 1/D.

    False where a pivot is not positive: the matrix is not positive definite.
    """
    n, worst, levels, updates = np.uint32(inverse.size), np.inf, tape.levels, tape.updates
    for level in range(levels.shape[1] - 1):
        for p in range(levels[LEVEL, level], levels[LEVEL, level + 1]):
            worst = min(worst, matrix[p])
            inverse[p] = 1.0 / matrix[p]
        for c in range(levels[COUPLED, level], levels[COUPLED, level + 1]):
            lower[c] = matrix[n + c] * inverse[tape.couplings[COLUMN, c]]
        for u in range(levels[UPDATED, level], levels[UPDATED, level + 1]):
            matrix[updates[TARGET, u]] -= lower[updates[LEFT, u]] * matrix[updates[RIGHT, u]]
    return worst > 0.0


@uncounted(forceinline=True)
def substitute(couplings: PlaceArray, lower: Array, inverse: Array, x: Array) -> None:
    """The solution in place of the right-hand side x (n,), both in the order of elimination."""
    count = lower.size
    for c in range(count):
        x[couplings[ROW, c]] -= lower[c] * x[couplings[COLUMN, c]]
    for p in range(x.size):
        x[p] *= inverse[p]
    for c in range(count - 1, -1, -1):
        x[couplings[COLUMN, c]] -= lower[c] * x[couplings[ROW, c]]
