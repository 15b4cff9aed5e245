"""What time stepping makes once of `Equations`: pairs of coordinates, places in the step matrix, paces of contacts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.sparse_factor import PlaceArray, Tape, places, tape_of
from torsional.numerics.stepping_data import Driven, Equations, Governed, Rows


class Pairs(NamedTuple):
    """Rows w_e (E,) as first x[left] + second x[right], and what is beyond two coordinates one entry at a time."""

    left: PlaceArray
    right: PlaceArray
    first: Array
    second: Array
    extra_row: PlaceArray
    extra_column: PlaceArray
    extra_weight: Array


class Masses(NamedTuple):
    """M as its diagonal (n,) and entries above it; ``slots`` are its values in the flat step matrix."""

    diagonal: Array
    above_row: PlaceArray
    above_column: PlaceArray
    above: Array
    slots: Array


class HingeRows(NamedTuple):
    """Hinges (H,) of connections ``of``; ``pace`` = sqrt(Δk wᵀM⁻¹w) [rad/s] is that of the contact alone."""

    of: PlaceArray
    gap: Array
    side: Array
    change: Array
    contact_time: Array
    pace: Array


class Laws(NamedTuple):
    """Laws (L,) by address on connections ``of``; values ``start`` to ``stop``, normal load at ``load_at`` or −1."""

    of: PlaceArray
    address: IntArray
    remembers: IntArray
    start: IntArray
    stop: IntArray
    values: Array
    load_at: IntArray


class Constants(NamedTuple):
    """What `Connected` tells of each connection (E,)."""

    stiffness: Array
    damping: Array
    centrifugal: Array
    follow: Array
    mean_rate: Array


class Loads(NamedTuple):
    """What `Connected` tells of the normal load of each connection."""

    constant: Array
    level: IntArray
    centrifugal: Array
    start: IntArray
    of: IntArray
    share: Array


class Outside(NamedTuple):
    """What acts from outside, and what rotations count from."""

    driven: Driven
    governed: Governed
    reference: Rows
    reference_time: float
    frame_time: Array
    frame_value: Array


class Fill(NamedTuple):
    """Entries weight · value[row] that are added to slots of the step matrix."""

    row: PlaceArray
    slot: PlaceArray
    weight: Array


class Plan(NamedTuple):
    """Everything about a system that steps of any length share; ``steady`` connections never change their tangent."""

    tape: Tape
    outside: Outside
    constants: Constants
    loads: Loads
    masses: Masses
    pairs: Pairs
    hinges: HingeRows
    laws: Laws
    steady: Fill
    bent: Fill
    cranks: Fill
    moving: bool  # a damper or law counts from a rotation of its own
    spinning: bool  # stiffness or a normal load changes with speed


def prepare(equations: Equations) -> Plan:
    """The plan of a system.  Raises ModelError for numbers that are not finite, and where nothing moves."""
    n, connected = equations.coordinates, equations.connected
    _refuse(equations)
    M = mass_matrix(equations)
    found = [support(rows) for rows in (equations.mass_rows, connected.rows, equations.driven.crank_rows)]
    tape = tape_of([one for group in found for one in group if len(one) > 1], n)
    slot = _slots(tape)
    counts = np.diff(connected.hinge_start)
    bends = (counts > 0) | (connected.address != 0) | (connected.centrifugal != 0.0)
    return Plan(
        tape=tape,
        outside=_outside(equations),
        constants=Constants(*(getattr(connected, name) for name in Constants._fields)),
        loads=Loads(*(getattr(connected, f"load_{name}") for name in Loads._fields)),
        masses=_masses(M, tape),
        pairs=_pairs(connected.rows),
        hinges=_hinges(equations, M, counts),
        laws=_laws(equations),
        steady=_fill(connected.rows, np.flatnonzero(~bends), slot),
        bent=_fill(connected.rows, np.flatnonzero(bends), slot),
        cranks=_fill(equations.driven.crank_rows, np.arange(len(found[2])), slot),
        moving=bool((connected.follow.any() and np.isfinite(equations.reference_time)) or connected.mean_rate.any()),
        spinning=bool(connected.centrifugal.any() or (connected.load_place >= 0).any()),
    )


def _outside(equations: Equations) -> Outside:
    e = equations
    return Outside(e.driven, e.governed, e.reference, float(e.reference_time), e.frame_time, e.frame_value)


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
    M[masses.above_row, masses.above_column] = M[masses.above_column, masses.above_row] = masses.above
    return M


def _refuse(equations: Equations) -> None:
    """Numbers that would only come back as numbers that are none."""
    if equations.coordinates < 1:
        raise ModelError("nothing moves", found="no coordinates", remedy="leave a node free")
    groups: Mapping[str, tuple[object, ...]] = {
        "inertia": (equations.inertia,),
        "connections": tuple(equations.connected),
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
    for c, (p, r) in enumerate(zip(tape.column.tolist(), tape.row.tolist(), strict=True)):
        found[node[p], node[r]] = found[node[r], node[p]] = n + c
    return found


def _masses(M: Array, tape: Tape) -> Masses:
    row, column = np.nonzero(np.triu(M, 1))
    node = tape.node
    slots = np.append(np.diag(M)[node], M[node[tape.column], node[tape.row]])
    return Masses(np.diag(M).copy(), places(row), places(column), M[row, column], slots)


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
    row, column = places(i for i, _, _ in extra), places(j for _, j, _ in extra)
    more = np.array([w for _, _, w in extra], dtype=float)
    return Pairs(ends[0], ends[1], weights[0], weights[1], row, column, more)


def _hinges(equations: Equations, M: Array, counts: IntArray) -> HingeRows:
    connected = equations.connected
    of = np.repeat(np.arange(counts.size), counts)
    w = dense(connected.rows, equations.coordinates)
    heavy = M + np.diag(np.where(np.diag(M) > 0.0, 0.0, 1e-12 * max(np.abs(M).max(), 1e-300)))
    mobility = np.einsum("ei,ie->e", w, np.linalg.solve(heavy, w.T))[of]
    pace = np.sqrt(np.maximum(connected.change * mobility, 0.0))
    return HingeRows(places(of), connected.gap, connected.side, connected.change, connected.contact_time, pace)


def _laws(equations: Equations) -> Laws:
    connected = equations.connected
    of = np.flatnonzero(connected.address)
    load = connected.load_place[of]
    return Laws(
        places(of),
        connected.address[of],
        connected.remembers[of],
        connected.law_start[of],
        connected.law_start[of + 1],
        connected.law_values,
        np.where(load >= 0, connected.law_start[of] + load, -1),
    )


def _fill(rows: Rows, chosen: Iterable[int], slot: Mapping[tuple[int, int], int]) -> Fill:
    """The entries of w wᵀ of the chosen rows, those off the diagonal once."""
    entries: list[tuple[int, int, float]] = []
    for e in chosen:
        a, b = rows.start[e], rows.start[e + 1]
        own: Sequence[tuple[int, float]] = list(zip(rows.column[a:b].tolist(), rows.weight[a:b].tolist(), strict=True))
        entries += [(int(e), slot[i, j], u * v) for k, (i, u) in enumerate(own) for j, v in own[k:]]
    weight = np.array([w for _, _, w in entries], dtype=float)
    return Fill(places(e for e, _, _ in entries), places(s for _, s, _ in entries), weight)
