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
    spread: tuple[tuple[int, frozenset[int]], ...]  # connections spread over couplings beforehand, and on which nodes
    whole: int  # the connection that stays whole and lives on between the neighbours, or −1
    alone: bool  # nothing but that connection joins the node to others


@dataclass
class _Graph:
    """Nodes still there: coupled one by one, or by connections that are still whole."""

    coupled: list[set[int]]
    whole: list[set[int]]
    removals: list[Removal] = field(default_factory=list)

    def neighbours(self, node: int) -> set[int]:
        on_it = (support for support in self.whole if node in support)
        return self.coupled[node].union(*on_it) - {node}

    def cost(self, node: int) -> tuple[int, int, int]:
        """What to keep small: connections that cannot stay whole, then neighbours; the lowest index among equals."""
        lost = sum(node in support for support in self.whole) - 1
        return max(0, lost), len(self.neighbours(node)), node

    def join(self, nodes: Iterable[int]) -> None:
        for i, j in combinations(nodes, 2):
            self.coupled[i].add(j)
            self.coupled[j].add(i)

    def remove(self, node: int) -> None:
        neighbours = frozenset(self.neighbours(node))
        whole, *others = [f for f, support in enumerate(self.whole) if node in support] or [-1]
        spread = tuple((f, frozenset(self.whole[f])) for f in others)
        for f in others:
            self.join(self.whole[f])
            self.whole[f] = set()
        alone = whole >= 0 and not self.coupled[node]
        if not alone:
            self.join(neighbours)
        if whole >= 0:
            self.whole[whole] = set(neighbours) if len(neighbours) > 1 else set()
        for other in neighbours:
            self.coupled[other].discard(node)
        self.removals.append(Removal(node, neighbours, spread, whole, alone))


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

    >>> [removal.node for removal in removals([{0, 1}, {1, 2}], [], 3)], [r.node for r in removals([{0, 1}], [], 2, [0])]
    ([0, 1, 2], [1, 0])
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
