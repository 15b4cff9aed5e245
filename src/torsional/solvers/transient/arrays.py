"""A system as the arrays that time steps work on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.laws import Contacts, Law, hinge_rows, packed
from torsional.laws import HingeRows as LawRows
from torsional.numerics.arrays import Array
from torsional.numerics.linear.sparse_factor import places
from torsional.numerics.motion.data import Connected, Driven, HingeRows, Laws, Rows, rows_of
from torsional.stamps import NormalLoad
from torsional.system import Connections, System
from torsional.units import GRAVITY

ROUNDING = 1e-12
NEARLY, BOUNCING = 0.95, 2000.0
"""Share of a path at which a pendulum without stops is stopped, and by a contact of what rate [rad/s]."""


def masses(system: System, speed: float, rising: bool = True) -> tuple[Rows, Array]:
    """Rows v_m over the coordinates and inertias J_m [kgm²], speed-switched ones settled at a ``speed`` [rad/s].

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)}))
    >>> masses(pair, 100.0)[1].tolist()
    [1.0, 2.0]
    """
    settled = system.switched(speed, rising).masses
    return rows_of(settled.weights), np.ascontiguousarray(settled.inertia, dtype=float)


def connected(system: System, levels: Mapping[str, int] | None = None) -> Connected:
    """All connections of a system; ``levels`` {name: its number in `Driven`} of the levels that normal loads follow.

    Laws that are sums of hinges come as hinges, others by the address of their kernel.
    Raises ModelError for a loss factor (see `with_viscous_losses`), for an unknown level, and for a normal load that
    follows the torque of a law that is neither spring nor hinges.
    """
    c = system.connections
    _refuse_loss(c)
    laws = _stopped(c)
    hinges = [hinge_rows(law) for law in laws]
    bent = [law if rows is None else None for law, rows in zip(laws, hinges, strict=True)]
    softer = np.array([0.0 if rows is None else rows.stiffness for rows in hinges])
    whole = _rotation(c)
    following = np.where(c.whole_speed, 0.0, whole), np.where(c.whole_speed, whole, 0.0)
    constants = (c.stiffness + softer, c.damping, c.centrifugal_stiffness - _swung(system), *following)
    return Connected(rows_of(c.weights), np.array(constants), _hinges(hinges), _laws(c, bent, levels or {}))


def _hinges(found: Sequence[LawRows | None]) -> HingeRows:
    """The hinges of all connections, one after the other."""
    listed = [np.zeros((4, 0)) if rows is None else np.array(rows[1:]) for rows in found]
    of = np.repeat(np.arange(len(listed)), [values.shape[1] for values in listed])
    return HingeRows(places(of), np.concatenate([np.zeros((4, 0)), *listed], axis=1))


def _laws(c: Connections, bent: Sequence[Law | None], levels: Mapping[str, int]) -> Laws:
    """The other laws, and the loads of those that have one."""
    values, start, address, remembers = packed(bent)
    of = np.flatnonzero(address)
    own = [(c.names[e], c.loads[e], bent[e]) for e in of.tolist()]
    shares = [_shares(c, name, load, bent) for name, load, _ in own]
    at = [first + law.load_place if law and load else -1 for first, (_, load, law) in zip(start[of], own, strict=True)]
    level = [_level(name, load, levels) for name, load, _ in own]
    ends = np.append(0, np.cumsum([len(each) for each in shares]))
    table = (of, address[of], remembers[of], start[of], start[of + 1], at, level, ends[:-1], ends[1:])
    loads = [(load.constant, load.centrifugal) if load else (0.0, 0.0) for _, load, _ in own]
    listed = [pair for each in shares for pair in each]
    return Laws(
        np.array(table, dtype=np.int64),
        values,
        np.array(loads, dtype=float).reshape(-1, 2).T.copy(),
        places(j for j, _ in listed),
        np.array([share for _, share in listed], dtype=float),
    )


def with_pendulums(driven: Driven, system: System, gravity: float = GRAVITY) -> Driven:
    """What drives a system, with the exact motion of its pendulums instead of their centrifugal springs.

    ``gravity`` [m/s²]: zero where the axis stands upright.  Several pendulums on one carrier hang at their places;
    a single one that stands for all of them has no weight, since theirs is balanced.
    """
    c = system.connections
    hung = [(i, swing) for i, swing in enumerate(c.swings) if swing is not None]
    if not hung:
        return driven
    alone = Counter(swing.carrier for _, swing in hung)
    rows, table = [], []
    for i, swing in hung:
        carrier = system.T[system.node_index(swing.carrier)]
        way = swing.distance * c.weights[i]
        weight = gravity if alone[swing.carrier] > 1 else 0.0
        rows += [carrier, way, carrier + way]
        path = (swing.curvature_radius, swing.flattening, swing.place)
        table.append((swing.mass, swing.distance, *path, float(carrier.sum()), weight))
    cranks = np.vstack([_dense(driven.crank_rows, system.T.shape[1]), *rows])
    return driven._replace(crank_rows=rows_of(cranks), pendulums=np.array(table))


def _stopped(c: Connections) -> list[Law | None]:
    """The laws, and for pendulums without stops a soft end of the path, which they meet when nothing spins them."""
    laws = list(c.laws)
    for i, swing in enumerate(c.swings):
        if swing is not None and laws[i] is None:
            reach = NEARLY * swing.path_end / swing.distance
            stiffness = (BOUNCING**2) * swing.mass * swing.distance**2
            laws[i] = Contacts.between(-reach, reach, stiffness, 1.0 / BOUNCING)
    return laws


def _swung(system: System) -> Array:
    """The centrifugal stiffness that the exact motion of pendulums replaces, for the reference node's speed."""
    c, lift = system.connections, np.zeros_like(system.connections.centrifugal_stiffness)
    for i, swing in enumerate(c.swings):
        if swing is not None:
            lift[i] = swing.centrifugal_stiffness * system.speed_ratio[system.node_index(swing.carrier)] ** 2
    return lift


def _dense(rows: Rows, coordinates: int) -> Array:
    out = np.zeros((len(rows.start) - 1, coordinates))
    out[np.repeat(np.arange(len(out)), np.diff(rows.start)), rows.column] = rows.weight
    return out


def with_viscous_losses(system: System, frequency: float) -> System:
    """The system with each loss factor η as the damper η k/ω that loses as much a cycle at one ``frequency`` [Hz].

    Away from it a damper's loss grows with frequency, where that of a loss factor does not.
    """
    if not frequency > 0:
        raise ModelError("the frequency must be positive", where="frequency", found=f"{frequency:g} Hz")
    c = system.connections
    damping = c.damping + c.loss_factor * c.stiffness / (2 * np.pi * frequency)
    return system.with_connections(damping=damping, loss_factor=np.zeros_like(c.loss_factor))


def _refuse_loss(c: Connections) -> None:
    lossy = np.flatnonzero(c.loss_factor * c.stiffness).tolist()
    for i in lossy[:1]:
        others = ", ".join(dict.fromkeys(c.names[other].partition(".")[0] for other in lossy[1:]))
        found = f"loss_factor {c.loss_factor[i]:g}" + (f", and more in {others}" if others else "")
        problem = "a loss factor is a matter of the frequency domain, time has none"
        remedy = "give it a damping c = ηk/ω at the frequency that matters instead (of a system: with_viscous_losses)"
        raise ModelError(problem, where=c.names[i], found=found, remedy=remedy)


def _rotation(c: Connections) -> Array:
    """w·1: what the mean rotation does to a connection; zero but for rounding is zero."""
    total = c.weights.sum(axis=1)
    return np.asarray(np.where(np.abs(total) <= ROUNDING * np.abs(c.weights).sum(axis=1), 0.0, total))


def _shares(c: Connections, name: str, load: NormalLoad | None, bent: Sequence[Law | None]) -> list[tuple[int, float]]:
    """(connection, share) of the torques that one load follows."""
    if load is None:
        return []
    listed = [(c.names.index(other), share) for other, share in load.share_of.items()]
    for j, _ in listed:
        if bent[j] is not None:
            problem = f"the normal load follows the torque of '{c.names[j]}', which is neither spring nor hinges"
            remedy = "give Hinges.through(points) in place of a curve, or name the spring beside the friction"
            raise ModelError(problem, where=name, found=type(bent[j]).__name__, remedy=remedy)
    return listed


def _level(name: str, load: NormalLoad | None, levels: Mapping[str, int]) -> int:
    if load is None or not load.level:
        return -1
    if load.level not in levels:
        remedy = nearest(load.level, levels)
        raise ModelError("no level over time is given for a normal load", where=name, found=load.level, remedy=remedy)
    return levels[load.level]
