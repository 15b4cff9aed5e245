"""System: a powertrain as plain arrays, and its linearisation at an operating point."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.laws import Law
from torsional.notebook import html_table
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.null_space import transformed
from torsional.powertrain import Powertrain
from torsional.stamps import Connection, Mass, NormalLoad, SpeedSwitch, Swing
from torsional.structure import weight_rows
from torsional.units import show

BoolArray = NDArray[np.bool_]

VALUES = ("stiffness", "damping", "loss_factor", "centrifugal_stiffness")
"""What `Connections` have one number of each: with the weights the whole of a linear connection."""


@dataclass(frozen=True, eq=False)
class Masses:
    """Factored kinetic energy ½ Σ J (v·q̇)²: ``weights`` (masses, coordinates), ``inertia`` [kgm²]."""

    names: tuple[str, ...]
    weights: Array
    inertia: Array
    switches: tuple[SpeedSwitch | None, ...]


@dataclass(frozen=True, eq=False)
class Connections:
    """Factored springs and dampers along w·q: ``weights`` (connections, coordinates) and one value a connection.

    ``stiffness`` [Nm/rad], ``damping`` [Nms/rad], ``loss_factor`` [-], ``centrifugal_stiffness`` [Nms²/rad] for the
    squared speed of the reference node, ``laws`` (None where linear), ``loads`` (None where constant: the law has
    it), their ``centrifugal`` referred to that node too; ``whole_speed``: damper and law see the whole speed;
    ``swings``: paths of the pendulums that they suspend.
    """

    names: tuple[str, ...]
    weights: Array
    stiffness: Array
    damping: Array
    loss_factor: Array
    centrifugal_stiffness: Array
    laws: tuple[Law | None, ...]
    loads: tuple[NormalLoad | None, ...]
    whole_speed: BoolArray
    swings: tuple[Swing | None, ...] = ()

    @property
    def values(self) -> Array:
        """The numbers of every connection, (connections, 4): stiffness, damping, loss factor, centrifugal stiffness."""
        return np.column_stack([getattr(self, name) for name in VALUES])

    def picked(self, index: Sequence[int] | IntArray, weights: Array | None = None) -> Connections:
        """Some of the connections, in the order of ``index``, or with other ``weights`` (chosen, coordinates)."""
        chosen = np.asarray(index, dtype=np.int64)
        some: dict[str, Any] = {name: getattr(self, name)[chosen] for name in (*VALUES, "weights", "whole_speed")}
        some |= {
            name: tuple(getattr(self, name)[i] for i in chosen)
            for name in ("names", "laws", "loads", *(("swings",) if self.swings else ()))
        }
        return dataclasses.replace(self, **some if weights is None else some | {"weights": weights})


@dataclass(frozen=True, eq=False)
class System:
    """M q̈ + C q̇ + (K + iH + Ω²S) q + Σ w law(w·q) = u, θ = T q, kept as factors.

    Coordinates are scaled by mean speed ratios: a rigid rotation is the vector of ones.
    ``T`` (nodes, coordinates); the matrices ``M`` [kgm²], ``C`` [Nms/rad], ``K`` and ``H`` [Nm/rad], ``S`` [kgm²] are
    (coordinates, coordinates).  Made by `assemble`.
    """

    nodes: tuple[str, ...]
    coordinates: tuple[str, ...]
    T: Array
    speed_ratio: Array
    masses: Masses
    connections: Connections

    def _matrix(self, values: Array) -> Array:
        w = self.connections.weights
        return np.asarray((w.T * values) @ w)

    @cached_property
    def M(self) -> Array:
        """Inertia matrix [kgm²], (coordinates, coordinates)."""
        v = self.masses.weights
        return np.asarray((v.T * self.masses.inertia) @ v)

    @cached_property
    def C(self) -> Array:
        """Damping matrix [Nms/rad]."""
        return self._matrix(self.connections.damping)

    @cached_property
    def K(self) -> Array:
        """Stiffness matrix [Nm/rad] of the linear connections."""
        return self._matrix(self.connections.stiffness)

    @cached_property
    def H(self) -> Array:
        """Hysteretic stiffness η k [Nm/rad], the imaginary part in the frequency domain."""
        return self._matrix(self.connections.stiffness * self.connections.loss_factor)

    @cached_property
    def S(self) -> Array:
        """Centrifugal stiffness [Nms²/rad], to be multiplied by Ω² of the reference node."""
        return self._matrix(self.connections.centrifugal_stiffness)

    @property
    def elements(self) -> tuple[tuple[str, Array, Law], ...]:
        """The nonlinear connections: name, direction w on the coordinates, law."""
        c = self.connections
        return tuple((n, w, law) for n, w, law in zip(c.names, c.weights, c.laws, strict=True) if law is not None)

    @cached_property
    def hash(self) -> str:
        """Sixteen hexadecimal digits that tell this system from every other: names, weights, values, laws."""
        c, m = self.connections, self.masses
        values = (self.T, m.weights, m.inertia, c.weights, *(getattr(c, name) for name in VALUES))
        named: tuple[object, ...] = (self.nodes, c.names, m.names, m.switches, c.laws)
        if any(c.loads) or c.whole_speed.any():
            named = (*named, c.loads, c.whole_speed.tolist())
        if any(c.swings):
            named = (*named, c.swings)
        told = hashlib.sha256(repr(named).encode())
        for array in values:
            told.update(array.tobytes())
        return told.hexdigest()[:16]

    def __repr__(self) -> str:
        bent = f", with laws: {', '.join(name for name, _, _ in self.elements)}" if self.elements else ", linear"
        return f"<System: {len(self.nodes)} nodes, {len(self.coordinates)} coordinates{bent}>"

    def _repr_html_(self) -> str:
        m, c = self.masses, self.connections
        discs = [[name, show(float(inertia), "inertia")] for name, inertia in zip(m.names, m.inertia, strict=True)]
        columns = zip(c.names, c.stiffness, c.damping, c.laws, strict=True)
        springs = [[n, *_told(k, d), "" if law is None else type(law).__name__] for n, k, d, law in columns]
        headings = ["connection", "stiffness", "damping", "law"]
        return html_table(repr(self)[1:-1], ["mass", "inertia"], discs) + html_table("", headings, springs)

    def shares_linear_part(self, other: System) -> bool:
        """Whether two systems differ in nothing but their laws."""
        mine, theirs = ((s.connections, s.masses) for s in (self, other))
        same = all(np.array_equal(getattr(mine[0], f), getattr(theirs[0], f)) for f in ("weights", *VALUES))
        return same and all(np.array_equal(getattr(mine[1], f), getattr(theirs[1], f)) for f in ("weights", "inertia"))

    def node_index(self, node: str) -> int:
        """Position of a node; raises ModelError with the nearest name."""
        if node not in self.nodes:
            raise ModelError(f"there is no node '{node}'", where=node, remedy=nearest(node, self.nodes))
        return self.nodes.index(node)

    def switched(self, speed: float, rising: bool = True) -> System:
        """The system with every speed-switched inertia settled for a mean ``speed`` [rad/s]."""
        pairs = zip(self.masses.inertia, self.masses.switches, strict=True)
        settled = [s.inertia if s is not None and s.above(speed, rising) else value for value, s in pairs]
        masses = dataclasses.replace(
            self.masses, inertia=np.array(settled, dtype=float), switches=(None,) * len(settled)
        )
        return dataclasses.replace(self, masses=masses)

    def loaded(self, speed: float, torque: Mapping[str, float] | None = None) -> System:
        """The system with every normal load settled at a mean ``speed`` [rad/s] of the reference node.

        ``torque``: mean torques {connection: Nm} for loads that have shares of them, as an operating point has them.
        Levels over time count as one.  Raises ModelError for shares of torques that are not given.
        """
        c, known, laws = self.connections, dict(torque or {}), list(self.connections.laws)
        if not any(c.loads):
            return self
        for i, (law, load) in enumerate(zip(c.laws, c.loads, strict=True)):
            if law is None or load is None:
                continue
            for name in load.share_of:
                if name not in known:
                    remedy = "give loaded(speed, torque) the mean torques, as those of an equilibrium"
                    found = f"a share of the torque of '{name}'"
                    raise ModelError("the normal load follows a torque", where=c.names[i], found=found, remedy=remedy)
            laws[i] = law.loaded(load.at(speed, known))
        return self.with_connections(laws=tuple(laws), loads=(None,) * len(laws))

    def with_connections(self, **changes: Any) -> System:
        """The same system with other values of its `Connections`, as ``laws`` or ``damping``."""
        return dataclasses.replace(self, connections=dataclasses.replace(self.connections, **changes))


def _told(stiffness: float, damping: float) -> tuple[str, str]:
    return show(float(stiffness), "stiffness"), show(float(damping), "damping")


@checked
def assemble(powertrain: Powertrain) -> System:
    """A powertrain as arrays: one loop over its stamps, rigid conditions eliminated.

    >>> from torsional.components import GearPair, Inertia, Shaft
    >>> line = {"engine": Inertia(1.0), "pinion": Inertia(0.1), "wheel": Inertia(3.0)}
    >>> line |= {"shaft": Shaft("engine", "pinion", 1e4), "gear": GearPair("pinion", "wheel", ratio=2.0)}
    >>> assemble(Powertrain(line)).K.tolist()
    [[10000.0, -10000.0], [-10000.0, 10000.0]]
    """
    structure, stamps = powertrain.structure, powertrain.stamps
    masses = [stamp for stamp in stamps if isinstance(stamp, Mass)]
    connections = [stamp for stamp in stamps if isinstance(stamp, Connection)]
    ratio = dict(zip(structure.nodes, structure.speed_ratio, strict=True))

    def reduced(chosen: list[Mass] | list[Connection]) -> Array:
        return _balanced(transformed(weight_rows(chosen, structure.nodes), structure.transform))

    loads = [_referred(c, connections, ratio) for c in connections]
    return System(
        structure.nodes,
        structure.coordinates,
        structure.transform,
        structure.speed_ratio,
        Masses(
            tuple(m.name for m in masses),
            reduced(masses),
            np.array([m.inertia for m in masses]),
            tuple(m.switch for m in masses),
        ),
        Connections(
            tuple(c.name for c in connections),
            reduced(connections),
            np.array([c.stiffness for c in connections]),
            np.array([c.damping for c in connections]),
            np.array([c.loss_factor for c in connections]),
            np.array([c.centrifugal_stiffness * ratio.get(c.carrier, 1.0) ** 2 for c in connections]),
            tuple(_pressed(c) for c in connections),
            tuple(loads),
            np.array([c.whole_speed for c in connections], dtype=bool),
            tuple(c.swing for c in connections),
        ),
    )


def _pressed(own: Connection) -> Law | None:
    """The law of one connection, with its normal load where that is constant."""
    if own.law is None or own.load is None or own.load.follows:
        return own.law
    return own.law.loaded(own.load.at(0.0, {}))


def _referred(own: Connection, connections: list[Connection], ratio: Mapping[str, float]) -> NormalLoad | None:
    """The load of one connection over the reference node's speed; None where the law may have it for good."""
    if own.load is None or not own.load.follows:
        return None
    load, names = own.load, [c.name for c in connections]
    for name in load.share_of:
        if name not in names or name == own.name:
            problem = "its normal load would follow itself" if name == own.name else f"there is no connection '{name}'"
            raise ModelError(problem, where=f"{own.name}.load.shares", remedy=nearest(name, set(names) - {own.name}))
    if load.carrier and load.carrier not in ratio:
        raise ModelError(
            f"there is no node '{load.carrier}'", where=f"{own.name}.load.carrier", remedy=nearest(load.carrier, ratio)
        )
    at = ratio.get(load.carrier, 1.0) ** 2
    return dataclasses.replace(load, centrifugal=load.centrifugal * at, carrier="")


def _balanced(rows: Array) -> Array:
    """Rows whose sum is zero but for rounding are made to sum to zero exactly, in the order in which sums are taken."""
    for row in rows:
        used = np.flatnonzero(row)
        total = sum(row[i] for i in used)
        if used.size > 1 and 0 < abs(total) <= 1e-12 * np.abs(row).sum():
            row[used[-1]] = -sum(row[i] for i in used[:-1])
    return rows
