"""The lines of a design, gear by gear, under mean torques: built from its model, or from the numbers of a batch."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from torsional.laws import Hinges
from torsional.laws.hinges import hinge_angles, hinge_slopes
from torsional.model import Model
from torsional.numerics.arrays import Array, IntArray
from torsional.solvers.equilibrium import OperatingPoint, linearize
from torsional.solvers.operating import mean_state
from torsional.studies.down_speeding import travels
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.envelopes import spring_ways
from torsional.system import System, assemble


@dataclass(frozen=True)
class Line:
    """A design in one gear with its mean states under some torques, and which of them each point has."""

    system: System
    state: OperatingPoint
    places: IntArray

    def linear(self, point: int) -> System:
        """The linear system about the state of a point."""
        return linearize(self.system, self.state.at(int(self.places[point])))

    def angle(self, name: str) -> Array:
        """Mean twists of a connection at the points."""
        return np.asarray(self.state.angle[self.places, self.state.names.index(name)])


class Design(Protocol):
    """What tells a design's lines, and the ways of its springs."""

    def line(self, gear: str, torque: Array) -> Line:
        """The line in a gear under mean torques [Nm], a point each."""

    def way(self, name: str) -> float:
        """The way of a spring to its stop [rad], infinite without one."""


@dataclass(frozen=True)
class Built:
    """A design by its ``model``."""

    model: Model
    known: dict[Any, Any] = field(default_factory=dict, compare=False)

    def line(self, gear: str, torque: Array) -> Line:
        """The line in a gear under mean torques [Nm], a point each."""
        own, places = np.unique(torque, return_inverse=True)
        if gear not in self.known:
            self.known[gear] = assemble(self.model.powertrain(gear))
        key = gear, own.tobytes()
        if key not in self.known:
            self.known[key] = mean_state(self.model, self.known[gear], own)
        return Line(self.known[gear], self.known[key], places.ravel())

    def way(self, name: str) -> float:
        """The way of a spring to its stop [rad], infinite without one."""
        return spring_ways(self.model)[name]


@dataclass(frozen=True)
class Numbers:
    """Designs of a ``batch`` by their ``columns``, found together."""

    batch: Batch
    columns: Mapping[str, Any]
    known: dict[Any, Any] = field(default_factory=dict)

    def gear(self, gear: str) -> tuple[System, dict[str, Array], dict[int, Array]]:
        """What stands for all designs in a gear, tables and parameters of laws."""
        if gear not in self.known:
            self.known[gear] = self.batch.numbers(gear, self.columns)
        found: tuple[System, dict[str, Array], dict[int, Array]] = self.known[gear]
        return found

    def mean(self, gear: str, own: Array) -> tuple[OperatingPoint, Array, Array]:
        """The state that stands for all, and of every design angles and tangents, (designs, states, connections).

        Statics give every design the same mean torques.
        """
        key = gear, own.tobytes()
        if key not in self.known:
            system, tables, laws = self.gear(gear)
            state = self.batch.state(gear, own)
            count = len(next(iter(tables.values())))
            angle, tangent = (np.repeat(values[None], count, axis=0) for values in (state.angle, state.stiffness))
            for place, law in enumerate(system.connections.laws):
                torque = state.torque[:, place]
                if isinstance(law, Hinges):
                    angle[:, :, place] = hinge_angles(laws[place], torque)
                    tangent[:, :, place] = hinge_slopes(laws[place], angle[:, :, place])
                elif law is None and (tables["stiffness"][:, place] > 0).all():
                    angle[:, :, place] = torque / tables["stiffness"][:, place, None]
            self.known[key] = state, angle, tangent
        found: tuple[OperatingPoint, Array, Array] = self.known[key]
        return found


@dataclass(frozen=True)
class Numbered:
    """One of the designs of some ``numbers``, by its ``place``."""

    numbers: Numbers
    place: int

    def line(self, gear: str, torque: Array) -> Line:
        """The line in a gear under mean torques [Nm], a point each."""
        own, places = np.unique(torque, return_inverse=True)
        system, tables, _ = self.numbers.gear(gear)
        state, angle, tangent = self.numbers.mean(gear, own)
        mine = {name: table[self.place] for name, table in tables.items()}
        inertia = mine.pop("inertia")
        damping = state.damping - system.connections.damping + mine["damping"]
        moved = dataclasses.replace(
            system,
            connections=dataclasses.replace(system.connections, **mine),
            masses=dataclasses.replace(system.masses, inertia=inertia),
        )
        point = dataclasses.replace(state, angle=angle[self.place], stiffness=tangent[self.place], damping=damping)
        return Line(moved, point, places.ravel())

    def way(self, name: str) -> float:
        """The way of a spring to its stop [rad], infinite without one."""
        model = self.numbers.batch.model
        if name not in travels(model):
            return spring_ways(model)[name]
        system, _, laws = self.numbers.gear(model.gear_name(None))
        return float(laws[system.connections.names.index(name)][self.place, 1::3].max())
