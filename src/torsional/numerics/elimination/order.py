"""In which order to take out the nodes of a coupled system, and what each removal joins.

Connections of three and more nodes (a shaft behind a planetary gear set) are kept *whole*, as z w wᵀ: spread over
couplings of both signs, a stiff one would leave nothing but rounding of what is soft beside it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Removal:
    """One node taken out: what it was joined to, and what becomes of the whole connections on it."""

    node: int
    neighbours: frozenset[int]
    whole: int  # the connection that stays whole and lives on between the neighbours, or −1
    alone: bool  # nothing but whole connections joins the node to others
    merged: tuple[tuple[int, frozenset[int]], ...]  # others turned away from the node beforehand: on whose nodes

    def absorbed(self) -> list[tuple[int, int]]:
        """The turned connections of which a single node is left: (connection, node)."""
        return [(g, next(iter(nodes - {self.node}))) for g, nodes in self.merged if len(nodes) == 2]


@dataclass
class _Graph:
    """Nodes still there: coupled one by one, or by connections that are still whole."""

    coupled: list[set[int]]
    whole: list[set[int]]
    removals: list[Removal] = field(default_factory=list)

    def neighbours(self, node: int) -> set[int]:
        return self.coupled[node].union(*(self.whole[f] for f in self.on(node))) - {node}

    def on(self, node: int) -> list[int]:
        return [f for f, support in enumerate(self.whole) if node in support]

    def cost(self, node: int) -> tuple[int, int, int]:
        """What to keep small: neighbours, whole connections; the lowest index among equals."""
        return len(self.neighbours(node)), len(self.on(node)), node

    def join(self, nodes: Iterable[int]) -> None:
        for i, j in combinations(nodes, 2):
            self.coupled[i].add(j)
            self.coupled[j].add(i)

    def keep(self, f: int, nodes: Iterable[int]) -> None:
        """Leave a connection on these nodes; on a single one it is a row sum."""
        self.whole[f] = set(nodes)
        if len(self.whole[f]) == 1:
            self.whole[f] = set()

    def remove(self, node: int) -> None:
        neighbours, (f, *others) = frozenset(self.neighbours(node)), self.on(node) or [-1]
        merged = []
        for g in others:
            self.whole[f] |= self.whole[g]
            merged += [(g, frozenset(self.whole[f]))]
            self.keep(g, self.whole[f] - {node})
        alone = f >= 0 and not self.coupled[node]
        if not alone:
            self.join(neighbours)
        if f >= 0:
            self.keep(f, neighbours)
        for other in neighbours:
            self.coupled[other].discard(node)
        self.removals.append(Removal(node, neighbours, f, alone, tuple(merged)))


def supports(pattern: NDArray[np.bool_]) -> list[set[int]]:
    """The nodes at which each factor (row) has a weight.

    >>> supports(np.array([[1.0, -1.0, 0.0]]) != 0)
    [{0, 1}]
    """
    return [set(np.flatnonzero(row).tolist()) for row in pattern]


def removals(
    connections: Sequence[set[int]], masses: Sequence[set[int]], n: int, keep_last: Sequence[int] = ()
) -> list[Removal]:
    """Fewest neighbours first, the lowest index among equals; the nodes of ``keep_last`` after all others.

    >>> [[r.node for r in removals([{0, 1}, {1, 2}], [], 3, keep_last)] for keep_last in ([], [0])]
    [[0, 1, 2], [2, 1, 0]]
    """
    graph = _Graph([set() for _ in range(n)], [set(s) if len(s) > 2 else set() for s in connections])
    for support in (*(s for s in connections if len(s) <= 2), *masses):
        graph.join(support)
    for group in (set(range(n)) - set(keep_last), set(keep_last)):
        while group:
            node = min(group, key=graph.cost)
            group.remove(node)
            graph.remove(node)
    return graph.removals
