"""The tape: rows of a workspace of lanes and the programs that eliminate and substitute, once per topology.

No value of stiffness, inertia or ratio enters.  Rows are named by their offset in one flat workspace: ω, ω², Ω², the
guard and scratch first, then a column for each position (row sum, its squared size, couplings to later positions),
then the connections kept whole (value, sum of weights, weights), then loads.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum, auto
from itertools import combinations
from typing import Any

import numpy as np

from torsional.numerics.arrays import IntArray
from torsional.numerics.elimination.lanes import COMPLEX, LANES, OPERANDS
from torsional.numerics.elimination.order import Removal, removals

OMEGA, OMEGA_SQUARED, SPEED_SQUARED, GUARD, OPEN_PIVOT, PIVOT, TRANSFER = (LANES * row for row in (0, 1, 2, 3, 4, 6, 8))
_HEAD = 10 * LANES
FIRST_COUPLING = 3 * LANES  # behind the row sum (complex) and its squared size
WEIGHT_SUM = COMPLEX  # behind the value of a whole connection
FIRST_TRANSFER = 2 * COMPLEX  # behind what a node on a whole connection leaves aside


class Op(IntEnum):
    """Operations of the lane program, named like the functions of `steps`."""

    LOADED_LEAF = auto()
    BACKWARD = auto()
    LEAF = auto()
    FIRST_LEAF = auto()
    BACKWARD_LEAF = auto()
    FORWARD = auto()
    MULTIPLY = auto()
    COUPLE = auto()
    TRANSFER = auto()
    COPY = auto()
    ADD = auto()
    INVERT = auto()
    ROOT = auto()
    CLEAR = auto()
    STIFFEN = auto()
    BEND_WHOLE = auto()
    PASS_WHOLE = auto()
    SOFTEN_WHOLE = auto()
    ABSORB_WHOLE = auto()
    MERGE_WHOLE = auto()
    TURN = auto()
    TWIST_WHOLE = auto()
    LOAD_WHOLE = auto()


Step = tuple[int, ...]
"""An operation and its offsets."""


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Offsets of everything in the workspace, by node and connection."""

    columns: dict[int, int]
    couplings: dict[frozenset[int], int]
    whole: dict[int, int]  # by connection: value, sum of weights
    weights: dict[tuple[int, int], int]  # (connection, node)
    turns: dict[tuple[int, int], int]  # of a connection turned away from a node: the turn's four coefficients
    aside: dict[int, int]  # of a node on a whole connection: 1/s₀, z w_i / s, then t_j of its other couplings
    loads: dict[int, int]  # of each node; its solution replaces it
    twists: dict[int, int]  # of each whole connection: what its w·x is counted from
    size: int


@dataclass(frozen=True, slots=True, eq=False)
class Tape:
    """What the kernel follows."""

    removals: tuple[Removal, ...]
    columns: tuple[tuple[int, ...], ...]  # the neighbours of each removal, in the order of their own
    layout: Layout
    slot_row: IntArray  # (slots,) offset of each value: row sums, couplings, whole connections
    connection_terms: IntArray  # (terms, 4): connection, slot, nodes i, j; j = −1: row sum; i = −1: the value
    mass_terms: IntArray  # (terms, 4): the same for the masses
    weight_rows: IntArray  # (rows, 3): offset, connection, node (−1: the sum; −2: nothing) of weights
    steps: tuple[tuple[Step, ...], ...]  # the operations of each removal
    program: IntArray  # (operations, 1 + OPERANDS): all of them


def build_tape(
    connections: Sequence[set[int]], masses: Sequence[set[int]], n: int, keep_last: Sequence[int] = ()
) -> Tape:
    """The tape of a topology: ``connections`` and ``masses`` are the sets of nodes their factors join."""
    order = tuple(removals(connections, masses, n, keep_last))
    position = {removal.node: p for p, removal in enumerate(order)}
    columns = tuple(tuple(sorted(removal.neighbours, key=position.__getitem__)) for removal in order)
    rows = _layout(order, columns, connections)
    offsets = [*rows.columns.values(), *rows.couplings.values(), *rows.whole.values()]
    slot = {offset: index for index, offset in enumerate(offsets)}
    terms = [
        (f, slot[offset], i, j)
        for f, support in enumerate(connections)
        for offset, i, j in ([(rows.whole[f], -1, -1)] if f in rows.whole else _entries(support, rows))
    ]
    steps = tuple(tuple(_steps(removal, column, rows)) for removal, column in zip(order, columns, strict=True))
    return Tape(
        removals=order,
        columns=columns,
        layout=rows,
        slot_row=table([[offset] for offset in offsets], 1).reshape(-1),
        connection_terms=table(terms, 4),
        mass_terms=table([(m, slot[o], i, j) for m, s in enumerate(masses) for o, i, j in _entries(s, rows)], 4),
        weight_rows=table([row for f in rows.whole for row in _weight_rows(f, rows)], 3),
        steps=steps,
        program=table([step for own in steps for step in own], 1 + OPERANDS),
    )


def _layout(order: Sequence[Removal], columns: Sequence[Sequence[int]], connections: Sequence[set[int]]) -> Layout:
    """Lay out the workspace: each part behind the one before."""
    rows = Layout({}, {}, {}, {}, {}, {}, {}, {}, 0)
    wholes = [f for f, support in enumerate(connections) if len(support) > 2]
    parts: list[tuple[dict[Any, int], Any, int]] = []
    for removal, column in zip(order, columns, strict=True):
        parts += [(rows.columns, removal.node, FIRST_COUPLING)]
        parts += [(rows.couplings, frozenset((removal.node, j)), COMPLEX) for j in column]
    for f in wholes:
        others = [removal.neighbours for removal in order if removal.whole == f]
        others += [nodes for removal in order for g, nodes in removal.merged if f in (g, removal.whole)]
        parts += [(rows.whole, f, WEIGHT_SUM + COMPLEX)]
        parts += [(rows.weights, (f, node), COMPLEX) for node in sorted(connections[f].union(*others))]
    for removal in order:
        parts += [(rows.turns, (g, removal.node), 4 * COMPLEX) for g, _ in removal.merged]
        if removal.whole >= 0:
            parts += [(rows.aside, removal.node, FIRST_TRANSFER + COMPLEX * len(removal.neighbours))]
    parts += [(rows.loads, removal.node, COMPLEX) for removal in order] + [(rows.twists, f, COMPLEX) for f in wholes]
    at = _HEAD
    for offsets, key, size in parts:
        offsets[key] = at
        at += size
    return replace(rows, size=at)


def table(rows: Sequence[Sequence[int]], width: int) -> IntArray:
    """Rows of integers, filled up with zeros; not to be written to."""
    filled = np.zeros((len(rows), width), dtype=np.int64)
    for index, row in enumerate(rows):
        filled[index, : len(row)] = row
    filled.flags.writeable = False
    return filled


def _weight_rows(f: int, rows: Layout) -> list[tuple[int, int, int]]:
    """The weights of a whole connection: real in the beginning."""
    found = [(rows.whole[f] + WEIGHT_SUM, f, -1)] + [(at, f, node) for (g, node), at in rows.weights.items() if g == f]
    return found + [(at + LANES, f, -2) for at, *_ in found]


def _entries(support: set[int], rows: Layout) -> list[tuple[int, int, int]]:
    """Where a factor enters, and with which nodes' weights: row sums (node, −1) and couplings."""
    own = [(rows.columns[i], i, -1) for i in sorted(support)]
    return own + [(rows.couplings[frozenset((i, j))], i, j) for i, j in combinations(sorted(support), 2)]


def _steps(removal: Removal, column: Sequence[int], rows: Layout) -> list[Step]:
    """Take out one node."""
    own = rows.columns[removal.node]
    steps = [step for g, nodes in removal.merged for step in _merge(removal, g, nodes, rows)]
    if removal.whole >= 0:
        return steps + _whole_star(removal, column, rows)
    if not column:
        return [*steps, (Op.ROOT, own)]
    if len(column) == 1:
        return [*steps, (Op.LEAF, own, rows.columns[column[0]])]
    return [*steps, *_star(removal, column, rows), (Op.COPY, own, OPEN_PIVOT)]


def _merge(removal: Removal, g: int, nodes: Iterable[int], rows: Layout) -> list[Step]:
    """Turn one of two whole connections away from the node; what is left of it on a single node is a row sum."""
    f, node, turn = removal.whole, removal.node, rows.turns[g, removal.node]
    ends = rows.weights[f, node], rows.weights[g, node]
    steps: list[Step] = [(Op.MERGE_WHOLE, rows.whole[f], rows.whole[g], *ends, turn)]
    steps += [(Op.TURN, rows.whole[f] + WEIGHT_SUM, rows.whole[g] + WEIGHT_SUM, turn)]
    steps += [(Op.TURN, rows.weights[f, j], rows.weights[g, j], turn) for j in sorted(nodes)]
    absorbed = [j for h, j in removal.absorbed() if h == g]
    return steps + [(Op.ABSORB_WHOLE, rows.columns[j], rows.whole[g], rows.weights[g, j]) for j in absorbed]


def _star(removal: Removal, column: Sequence[int], rows: Layout) -> list[Step]:
    """A node with several neighbours: they become coupled to each other.  1/s₀, and 1/s, are left in scratch rows."""
    own, node = rows.columns[removal.node], removal.node
    couplings = {j: rows.couplings[frozenset((node, j))] for j in column}
    steps: list[Step] = [(Op.COPY, OPEN_PIVOT, own), *((Op.ADD, OPEN_PIVOT, couplings[j]) for j in column)]
    steps += _pivots(removal, rows)
    for i, j in enumerate(column):
        steps += [(Op.TRANSFER, couplings[j], own, rows.columns[j])]
        steps += [(Op.COUPLE, rows.couplings[frozenset((j, k))], couplings[k]) for k in column[i + 1 :]]
        steps += [(Op.COPY, couplings[j], TRANSFER)] if removal.whole < 0 else _bent(removal, i, j, rows)
    return steps


def _pivots(removal: Removal, rows: Layout) -> list[Step]:
    """1/s₀ and, with the share of a whole connection, 1/s."""
    f, node = removal.whole, removal.node
    steps: list[Step] = [] if f < 0 else [(Op.STIFFEN, rows.whole[f], rows.weights[f, node]), (Op.INVERT, PIVOT)]
    return [*steps, (Op.INVERT, OPEN_PIVOT)]


def _pass(removal: Removal, j: int, rows: Layout) -> Step:
    """What neighbour j takes over through a whole connection."""
    f, node = removal.whole, removal.node
    ends = rows.weights[f, node], rows.weights[f, j], rows.columns[node], rows.columns[j]
    return (Op.PASS_WHOLE, rows.couplings[frozenset((node, j))], rows.whole[f], *ends)


def _bent(removal: Removal, i: int, j: int, rows: Layout) -> list[Step]:
    """A neighbour, the i-th, that the node is coupled to beside the whole connection."""
    f, node = removal.whole, removal.node
    aside = rows.aside[node] + FIRST_TRANSFER + COMPLEX * i
    bend = (Op.BEND_WHOLE, rows.weights[f, j], rows.weights[f, node])
    return [(Op.COPY, aside, TRANSFER), _pass(removal, j, rows), bend]


def _whole_star(removal: Removal, column: Sequence[int], rows: Layout) -> list[Step]:
    """A node on a whole connection, which gets softer and lives on between the others."""
    f, node, own = removal.whole, removal.node, rows.columns[removal.node]
    if removal.alone:
        steps: list[Step] = [(Op.COPY, OPEN_PIVOT, own), *_pivots(removal, rows)]
        steps += [_pass(removal, j, rows) for j in column]
    else:
        steps = _star(removal, column, rows)
    steps += [(Op.SOFTEN_WHOLE, rows.whole[f], rows.weights[f, node], own, rows.aside[node]), (Op.COPY, own, PIVOT)]
    if len(column) == 1:
        steps += [(Op.ABSORB_WHOLE, rows.columns[column[0]], rows.whole[f], rows.weights[f, column[0]])]
    return steps
