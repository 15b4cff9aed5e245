"""System: a powertrain as plain arrays, and its linearisation at an operating point."""

from __future__ import annotations

import dataclasses
import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.laws import Law
from torsional.numerics.arrays import Array
from torsional.numerics.null_space import transformed
from torsional.powertrain import Powertrain
from torsional.stamps import Connection, Mass, SpeedSwitch
from torsional.structure import weight_rows


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
    squared speed of the reference node, ``laws`` (None where linear).
    """

    names: tuple[str, ...]
    weights: Array
    stiffness: Array
    damping: Array
    loss_factor: Array
    centrifugal_stiffness: Array
    laws: tuple[Law | None, ...]


@dataclass(frozen=True, eq=False)
class System:
    """M q̈ + C q̇ + (K + iH + Ω²S) q + Σ w law(w·q) = u, θ = T q, kept as factors.

    Coordinates are scaled by mean speed ratios: a rigid rotation is the vector of ones.
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
        values = (
            self.T,
            m.weights,
            m.inertia,
            c.weights,
            c.stiffness,
            c.damping,
            c.loss_factor,
            c.centrifugal_stiffness,
        )
        told = hashlib.sha256(repr((self.nodes, c.names, m.names, m.switches, c.laws)).encode())
        for array in values:
            told.update(array.tobytes())
        return told.hexdigest()[:16]

    def shares_linear_part(self, other: System) -> bool:
        """Whether two systems differ in nothing but their laws."""
        mine, theirs = ((s.connections, s.masses) for s in (self, other))
        fields = ("weights", "stiffness", "damping", "loss_factor", "centrifugal_stiffness")
        same = all(np.array_equal(getattr(mine[0], name), getattr(theirs[0], name)) for name in fields)
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
            tuple(c.law for c in connections),
        ),
    )


def _balanced(rows: Array) -> Array:
    """Rows whose sum is zero but for rounding are made to sum to zero exactly, in the order in which sums are taken."""
    for row in rows:
        used = np.flatnonzero(row)
        total = sum(row[i] for i in used)
        if used.size > 1 and 0 < abs(total) <= 1e-12 * np.abs(row).sum():
            row[used[-1]] = -sum(row[i] for i in used[:-1])
    return rows
