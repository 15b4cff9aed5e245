"""Routes through an eliminated system: where loads enter, where results leave, and the programs between."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from torsional.numerics.arrays import IntArray
from torsional.numerics.elimination.lanes import COMPLEX, OPERANDS
from torsional.numerics.elimination.order import Removal
from torsional.numerics.elimination.tape import FIRST_TRANSFER, TRANSFER, Layout, Op, Step, Tape, table


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """Where loads enter, where results leave, and the programs that take one to the other."""

    loads: IntArray  # offsets
    outputs: IntArray
    forward: IntArray
    backward: IntArray
    fused: IntArray  # for a single right-hand side: elimination and forward substitution in one go
    fused_backward: IntArray


def build_route(tape: Tape, loaded: Sequence[int], outputs: Sequence[int]) -> Route:
    """Forwards only where loads reach, backwards only where results are wanted."""
    ways = list(zip(tape.removals, tape.columns, tape.steps, strict=True))
    loads = _Loads(tape.layout, set(loaded))
    forward = [loads.forward(removal, column) for removal, column, _ in ways]
    fused = [step for own, (_, _, steps) in zip(forward, ways, strict=True) for step in _fused(list(steps), own)]
    needed, backward, fused_backward = set(outputs), [], []
    for removal, column, _ in ways:
        needed.update(column if removal.node in needed else ())
    for removal, column, steps in reversed(ways):
        if removal.node in needed:
            loaded_here, leaf = removal.node in loads.filled, steps[-1][0] == Op.LEAF
            backward += _backward(tape.layout, removal, column, loaded_here, removal.whole >= 0)
            fused_backward += _backward(tape.layout, removal, column, loaded_here, removal.whole >= 0 or leaf)
    return Route(
        loads=table([[tape.layout.loads[node]] for node in loaded], 1).reshape(-1),
        outputs=table([[tape.layout.loads[node]] for node in outputs], 1).reshape(-1),
        forward=table([step for own in forward for step in own], 1 + OPERANDS),
        backward=table(backward, 1 + OPERANDS),
        fused=table(fused, 1 + OPERANDS),
        fused_backward=table(fused_backward, 1 + OPERANDS),
    )


@dataclass
class _Loads:
    """The nodes, and the whole connections, that a load has reached so far."""

    rows: Layout
    filled: set[int]
    twisted: set[int] = field(default_factory=set)

    def forward(self, removal: Removal, column: Sequence[int]) -> list[Step]:
        """Hand on what has come to a node: b_j += t_j b_i."""
        steps = [step for g, _ in removal.merged for step in self._turn(removal, g)]
        steps += [step for g, node in removal.absorbed() for step in self._untwist(g, node)]
        if removal.whole >= 0:
            return steps + self._forward_whole(removal, column)
        if removal.node not in self.filled:
            return steps
        couplings = [self.rows.couplings[frozenset((removal.node, j))] for j in column]
        return steps + self._hand_on(removal.node, column, couplings)

    def _hand_on(self, node: int, column: Iterable[int], transfers: Iterable[int]) -> list[Step]:
        """The first load to arrive at a node without one of its own sets it."""
        steps: list[Step] = []
        for j, transfer in zip(column, transfers, strict=True):
            own, other = self.rows.loads[node], self.rows.loads[j]
            steps += [(Op.FORWARD, transfer, own, other) if j in self.filled else (Op.MULTIPLY, other, transfer, own)]
            self.filled.add(j)
        return steps

    def _forward_whole(self, removal: Removal, column: Sequence[int]) -> list[Step]:
        """The same where a whole connection stays on the neighbours, to be twisted by the load."""
        f, node, rows = removal.whole, removal.node, self.rows
        if node not in self.filled and f not in self.twisted:
            return []
        steps = self._clear(node) + self._clear_twist(f)
        if not removal.alone:
            first = rows.aside[node] + FIRST_TRANSFER
            steps += self._hand_on(node, column, [first + COMPLEX * i for i in range(len(column))])
        own = rows.loads[node], rows.twists[f], rows.weights[f, node], rows.aside[node], rows.columns[node]
        return [*steps, (Op.TWIST_WHOLE, *own), *(self._untwist(f, column[0]) if len(column) == 1 else [])]

    def _turn(self, removal: Removal, g: int) -> list[Step]:
        """The twists of two connections turn with them."""
        f, rows = removal.whole, self.rows
        if not self.twisted & {f, g}:
            return []
        steps = self._clear_twist(f) + self._clear_twist(g)
        return [*steps, (Op.TURN, rows.twists[f], rows.twists[g], rows.turns[g, removal.node])]

    def _untwist(self, f: int, node: int) -> list[Step]:
        """A connection that is left on a single node leaves its twist as a load."""
        if f not in self.twisted:
            return []
        own = self.rows.twists[f], self.rows.whole[f], self.rows.weights[f, node]
        return [*self._clear(node), (Op.LOAD_WHOLE, self.rows.loads[node], *own)]

    def _clear_twist(self, f: int) -> list[Step]:
        new = f not in self.twisted
        self.twisted.add(f)
        return [(Op.CLEAR, self.rows.twists[f])] if new else []

    def _clear(self, node: int) -> list[Step]:
        new = node not in self.filled
        self.filled.add(node)
        return [(Op.CLEAR, self.rows.loads[node])] if new else []


def _fused(steps: list[Step], forward: list[Step]) -> list[Step]:
    """A leaf hands its load on and divides it by its pivot while it is taken out."""
    if not forward or steps[-1][0] != Op.LEAF or forward[-1][0] not in (Op.FORWARD, Op.MULTIPLY):
        return steps + forward
    kind, *offsets = forward[-1]
    own, other = (offsets[1], offsets[2]) if kind == Op.FORWARD else (offsets[2], offsets[0])
    leaf = (Op.LOADED_LEAF if kind == Op.FORWARD else Op.FIRST_LEAF, *steps[-1][1:], own, other)
    return [*steps[:-1], *forward[:-1], leaf]


def _backward(rows: Layout, removal: Removal, column: Sequence[int], loaded: bool, divided: bool) -> list[Step]:
    """x_i = b_i / s + Σ t_j x_j, without b_i where no load comes; ``divided``: b_i / s is there already."""
    own, offset = rows.loads[removal.node], rows.columns[removal.node]
    terms = [(rows.couplings[frozenset((removal.node, j))], rows.loads[j]) for j in column]
    if loaded and not divided and len(terms) == 1:
        return [(Op.BACKWARD_LEAF, offset, own, terms[0][1])]
    start: list[Step] = [] if divided else [(Op.MULTIPLY, TRANSFER, own, offset), (Op.COPY, own, TRANSFER)]
    if not loaded:
        start = [(Op.MULTIPLY, own, *terms.pop(0))] if terms else [(Op.CLEAR, own)]
    return start + [(Op.BACKWARD, coupling, own, other) for coupling, other in terms]
