"""What time stepping makes once of `Equations`: pairs of coordinates, places in the step matrix, paces of contacts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.linear.sparse_factor import PlaceArray, Tape, places, tape_of
from torsional.numerics.motion.data import (
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    FOLLOW,
    LOAD_AT,
    MEAN_RATE,
    Equations,
    HingeRows,
    Laws,
    Rows,
)
from torsional.numerics.motion.tables import Outside, outside_of

LEFT, RIGHT = range(2)
"""Rows of ``ends``; LEFT is also that of a coordinate or connection in ``extra_at``, RIGHT that of its coordinate."""
PACE = CONTACT_TIME + 1
"""Row that a plan adds to the hinges' ``values``: sqrt(Δk wᵀM⁻¹w) [rad/s], the pace of the contact alone."""
ROW, SLOT = range(2)
"""Rows of a fill's ``at``."""


class Pairs(NamedTuple):
    """Rows w_e (E,) as weights of two coordinates each, (2, E), and what is beyond two one entry at a time: connection
    and coordinate ``extra_at`` (2, X)."""

    ends: PlaceArray
    weights: Array
    extra_at: PlaceArray
    extra: Array


class Masses(NamedTuple):
    """M as its diagonal (n,) and entries ``above`` it at rows and columns ``above_at``; ``slots`` are its values in the
    flat step matrix."""

    diagonal: Array
    above_at: PlaceArray
    above: Array
    slots: Array


class Fill(NamedTuple):
    """Entries weight · value[ROW] that are added to slots of the step matrix, (2, K) and (K,): first those of
    ``steady`` connections, which never change their tangent, up to ``bent`` those of the others, then cranks'."""

    at: PlaceArray
    weight: Array
    steady: int
    bent: int


class Plan(NamedTuple):
    """Everything about a system that steps of any length share."""

    tape: Tape
    outside: Outside
    constants: Array
    masses: Masses
    pairs: Pairs
    hinges: HingeRows
    laws: Laws
    fill: Fill
    moving: bool  # a damper or law counts from a rotation of its own
    spinning: bool  # stiffness or a normal load changes with speed


def prepare(equations: Equations) -> Plan:
    """The plan of a system.  Raises ModelError for numbers that are not finite, and where nothing moves."""
    n, connected, cranks = equations.coordinates, equations.connected, equations.driven.crank_rows
    _refuse(equations)
    M, constants = mass_matrix(equations), connected.constants
    found = [support(rows) for rows in (equations.mass_rows, connected.rows, cranks)]
    tape = tape_of([one for group in found for one in group if len(one) > 1], n)
    slot = _slots(tape)
    bends = constants[CENTRIFUGAL] != 0.0
    bends[connected.hinges.of] = bends[connected.laws.of] = True
    return Plan(
        tape=tape,
        outside=outside_of(equations),
        constants=constants,
        masses=_masses(M, tape),
        pairs=_pairs(connected.rows),
        hinges=_paced(equations, M),
        laws=connected.laws,
        fill=_filled(
            _entries(connected.rows, np.flatnonzero(~bends), slot),
            _entries(connected.rows, np.flatnonzero(bends), slot),
            _entries(cranks, np.arange(len(found[2])), slot),
        ),
        moving=bool((constants[FOLLOW].any() and np.isfinite(equations.reference_time)) or constants[MEAN_RATE].any()),
        spinning=bool(constants[CENTRIFUGAL].any() or (connected.laws.places[LOAD_AT] >= 0).any()),
    )


def support(rows: Rows) -> list[set[int]]:
    """The coordinates that each row reads."""
    return [set(rows.column[a:b].tolist()) for a, b in zip(rows.start[:-1], rows.start[1:], strict=True)]


def dense(rows: Rows, n: int) -> Array:
    """Rows as a table (rows, n)."""
    table = np.zeros((rows.start.size - 1, n))
    np.add.at(table, (np.repeat(np.arange(len(table)), np.diff(rows.start)), rows.column), rows.weight)
    return table


def mass_matrix(equations: Equations) -> Array:
    """M = Σ J v vᵀ (n, n)."""
    v = dense(equations.mass_rows, equations.coordinates)
    return np.asarray((v.T * equations.inertia) @ v)


def matrix_of(masses: Masses) -> Array:
    """M (n, n) again."""
    M = np.diag(masses.diagonal)
    row, column = masses.above_at
    M[row, column] = M[column, row] = masses.above
    return M


def _refuse(equations: Equations) -> None:
    """Numbers that would only come back as numbers that are none."""
    if equations.coordinates < 1:
        raise ModelError("nothing moves", found="no coordinates", remedy="leave a node free")
    c = equations.connected
    groups: Mapping[str, tuple[object, ...]] = {
        "inertia": (equations.inertia,),
        "connections": (*c.rows, c.constants, *c.hinges, *c.laws),
        "sources": tuple(equations.driven),
        "governors": (equations.governed.proportional, equations.governed.integral),
        "frame": (equations.frame_time, equations.frame_value),
    }
    for where, values in groups.items():
        for value in values:
            if isinstance(value, np.ndarray) and not np.isfinite(value).all():
                raise ModelError("a number is not finite", where=where, found=str(value[~np.isfinite(value)][0]))


def _slots(tape: Tape) -> dict[tuple[int, int], int]:
    """Slots by pairs of coordinates, either way round."""
    node, n = tape.node.tolist(), tape.node.size
    found = {(i, i): p for p, i in enumerate(node)}
    for c, (p, r) in enumerate(tape.couplings.T.tolist()):
        found[node[p], node[r]] = found[node[r], node[p]] = n + c
    return found


def _masses(M: Array, tape: Tape) -> Masses:
    row, column = np.nonzero(np.triu(M, 1))
    node = tape.node
    slots = np.append(np.diag(M)[node], M[tuple(node[tape.couplings])])
    return Masses(np.diag(M).copy(), np.array([row, column], dtype=np.uint32), M[row, column], slots)


def _pairs(rows: Rows) -> Pairs:
    count = rows.start.size - 1
    ends, weights = np.zeros((2, count), dtype=np.uint32), np.zeros((2, count))
    extra: list[tuple[int, int, float]] = []
    for e, (a, b) in enumerate(zip(rows.start[:-1], rows.start[1:], strict=True)):
        for k, (column, weight) in enumerate(zip(rows.column[a:b], rows.weight[a:b], strict=True)):
            if k < 2:
                ends[k, e], weights[k, e] = column, weight
            else:
                extra.append((e, int(column), float(weight)))
    at = np.array([places(i for i, _, _ in extra), places(j for _, j, _ in extra)])
    return Pairs(ends, weights, at, np.array([w for _, _, w in extra], dtype=float))


def _paced(equations: Equations, M: Array) -> HingeRows:
    of, values = equations.connected.hinges
    w = dense(equations.connected.rows, equations.coordinates)
    heavy = M + np.diag(np.where(np.diag(M) > 0.0, 0.0, 1e-12 * max(np.abs(M).max(), 1e-300)))
    mobility = np.einsum("ei,ie->e", w, np.linalg.solve(heavy, w.T))[of]
    return HingeRows(of, np.vstack([values, np.sqrt(np.maximum(values[CHANGE] * mobility, 0.0))]))


Entries = Sequence[tuple[int, int, float]]


def _entries(rows: Rows, chosen: Iterable[int], slot: Mapping[tuple[int, int], int]) -> Entries:
    """Row, slot and weight of the entries of w wᵀ of the chosen rows, those off the diagonal once."""
    entries: list[tuple[int, int, float]] = []
    for e in chosen:
        a, b = rows.start[e], rows.start[e + 1]
        own: Sequence[tuple[int, float]] = list(zip(rows.column[a:b].tolist(), rows.weight[a:b].tolist(), strict=True))
        entries += [(int(e), slot[i, j], u * v) for k, (i, u) in enumerate(own) for j, v in own[k:]]
    return entries


def _filled(steady: Entries, bent: Entries, cranks: Entries) -> Fill:
    entries = [*steady, *bent, *cranks]
    at = np.array([places(e for e, _, _ in entries), places(s for _, s, _ in entries)])
    return Fill(at, np.array([w for _, _, w in entries], dtype=float), len(steady), len(steady) + len(bent))
