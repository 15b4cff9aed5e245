"""A system as the arrays that time steps work on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.laws import Contacts, HingeRows, Law, hinge_rows
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import Connected, Driven, Rows, rows_of
from torsional.stamps import NormalLoad
from torsional.system import Connections, System
from torsional.units import GRAVITY

ROUNDING = 1e-12
NEARLY, BOUNCING = 0.95, 2000.0
"""Share of a path at which a pendulum without stops is stopped, and by a contact of what rate [rad/s]."""
_NONE = HingeRows(0.0, *(np.zeros(0),) * 4)


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
    hinges = [hinge_rows(law) for law in _stopped(c)]
    bent = [law if rows is None else None for law, rows in zip(c.laws, hinges, strict=True)]
    rows = [_NONE if found is None else found for found in hinges]
    shares = [_shares(c, name, load, bent) for name, load in zip(c.names, c.loads, strict=True)]
    whole = _rotation(c)
    values = [np.zeros(0) if law is None else np.asarray(law.parameters, dtype=float) for law in bent]
    return Connected(
        rows=rows_of(c.weights),
        stiffness=c.stiffness + np.array([found.stiffness for found in rows]),
        damping=_copied(c.damping),
        centrifugal=c.centrifugal_stiffness - _swung(system),
        follow=np.where(c.whole_speed, 0.0, whole),
        mean_rate=np.where(c.whole_speed, whole, 0.0),
        hinge_start=_starts([found.gap for found in rows]),
        gap=_joined([found.gap for found in rows]),
        side=_joined([found.side for found in rows]),
        change=_joined([found.change for found in rows]),
        contact_time=_joined([found.contact_time for found in rows]),
        address=_integers([0 if law is None else law.address for law in bent]),
        law_start=_starts(values),
        law_values=_joined(values),
        remembers=_integers([int(law is not None and law.remembers) for law in bent]),
        load_place=_integers([law.load_place if law and load else -1 for law, load in zip(bent, c.loads, strict=True)]),
        load_constant=np.array([load.constant if load else 0.0 for load in c.loads]),
        load_level=_integers([_level(name, load, levels or {}) for name, load in zip(c.names, c.loads, strict=True)]),
        load_centrifugal=np.array([load.centrifugal if load else 0.0 for load in c.loads]),
        load_start=_starts(shares),
        load_of=_integers([j for own in shares for j, _ in own]),
        load_share=np.array([share for own in shares for _, share in own], dtype=float),
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


def _starts(parts: Sequence[Sequence[object] | Array]) -> IntArray:
    """Where each part starts in a row of all of them, and where the last one ends."""
    return np.append(0, np.cumsum([len(part) for part in parts])).astype(np.int64)


def _joined(parts: Sequence[Array]) -> Array:
    return np.concatenate([np.zeros(0), *parts])


def _integers(values: Sequence[int]) -> IntArray:
    return np.array(values, dtype=np.int64)


def _copied(values: Array) -> Array:
    return np.array(values, dtype=float)
