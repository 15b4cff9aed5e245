"""Designs of a sweep answered together: numbers of one system a gear, what they share eliminated once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.laws.hinges import hinge_slopes, hinge_tangents
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.solvers.equilibrium import OperatingPoint, linearize
from torsional.solvers.operating import mean_state, torque_places
from torsional.solvers.variants import NUMBERS, Loading, Variants
from torsional.studies.sweeps.designs import Designs, Values
from torsional.studies.sweeps.numbers import Fit, Told, fitted, parts_of
from torsional.system import BoolArray, System, assemble

ELSEWHERE = ("engine", "operation", "landmarks", "name", "torsional")
"""Blocks of a model file that do more than give a system its numbers."""
CHECKED = 6
"""Designs, beside the corners, on which the numbers are proven."""


@dataclass(frozen=True, eq=False)
class Batch:
    """The ``designs`` of a sweep over the key paths of a ``model``, asked through numbers of its systems.

    Everything follows from the plan, nothing from which designs are asked together.
    """

    model: Model
    designs: Designs
    _kept: dict[Any, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, model: Model, designs: Designs) -> Batch | None:
        """The batch of a sweep, or None for one whose designs must be built one by one."""
        roots = {name.partition(".")[0] for name in designs.axes}
        if not model.document or roots & set(ELSEWHERE) or not model.landmarks.throws or not model.landmarks.load:
            return None
        return cls(model, designs)

    def answers(self, gear: str) -> bool:
        """Whether designs can be asked in this gear."""
        return self._fit(gear) is not None

    def covers(self, gear: str, columns: Mapping[str, Any]) -> BoolArray:
        """Which designs of ``columns`` (designs,) can be: the others are to be built one by one."""
        fit = self._fit(gear)
        assert fit is not None
        return fit.covers(columns) & self._sound(gear, fit, columns)

    def _sound(self, gear: str, fit: Fit, columns: Mapping[str, Any]) -> BoolArray:
        """Which designs have no falling law."""
        within = fit.covers(columns)
        sound = within.copy()
        if not within.any():
            return sound
        _, laws = parts_of(self._system(gear), fit.at(_numbers(columns, within)))
        for place in self._varied(gear, fit)[2]:
            rows = laws[place]
            gaps = np.sort(rows[:, 1::3], axis=1)
            between = np.hstack([gaps[:, :1] - 1.0, 0.5 * (gaps[:, 1:] + gaps[:, :-1]), gaps[:, -1:] + 1.0])
            slopes = hinge_slopes(rows, between)
            rising = (slopes >= -1e-9 * abs(rows).max(axis=1)[:, None]).all(axis=1)
            sound[within] &= rising & (slopes[:, [0, -1]] > 0).all(axis=1)
        return sound

    def angles(self, gear: str, loading: Asked, columns: Mapping[str, Any]) -> ComplexArray:
        """Complex 0-peak outputs (designs, outputs, states, frequencies) of designs that are covered."""
        fit = self._fit(gear)
        assert fit is not None
        key = gear, loading.key
        if key not in self._kept:
            self._kept[key] = self._variants(gear, fit, loading)
        numbers = fit.at(_numbers(columns, slice(None)))
        tables, laws = parts_of(self._system(gear), numbers)
        varied = self._varied(gear, fit)
        fixed, _ = parts_of(self._system(gear), fit.start[None])
        changing = {name for name, places in varied[0].items() if places.size}
        told = {name: tables[name] if name in changing else fixed[name] for name in tables}
        found: ComplexArray = self._kept[key].angles(told, {place: laws[place] for place in varied[2]})
        return found

    def numbers(self, gear: str, columns: Mapping[str, Any]) -> tuple[System, dict[str, Array], dict[int, Array]]:
        """A system that stands for all, and of designs that are covered their tables by field, (designs, …), and
        parameters by place of a law."""
        fit = self._fit(gear)
        assert fit is not None
        return self._system(gear), *parts_of(self._system(gear), fit.at(_numbers(columns, slice(None))))

    def systems(self, gear: str, torque: float, columns: Mapping[str, Any]) -> Iterator[System]:
        """The linear systems of designs that are covered, about a mean engine torque [Nm]."""
        system, tables, rows = self.numbers(gear, columns)
        fit = self._fit(gear)
        assert fit is not None
        point = mean_state(self.model, system, torque)
        linear = linearize(system, point)
        fields, _, laws = self._varied(gear, fit)
        tangents = {i: hinge_tangents(rows[i], point.torque[None, i])[:, 0] for i in laws.tolist()}
        for design in range(len(tables["inertia"])):
            own = {name: getattr(linear.connections, name).copy() for name in NUMBERS}
            for name, values in own.items():
                values[fields[name]] = tables[name][design, fields[name]]
            for place, slope in tangents.items():
                own["stiffness"][place] = slope[design]
            masses = replace(linear.masses, inertia=tables["inertia"][design])
            yield replace(linear.with_connections(**own), masses=masses)

    def state(self, gear: str, torques: Array) -> OperatingPoint:
        """The mean states [Nm] of the system that stands for all; their torques are those of every design."""
        key = "state", gear, torques.tobytes()
        if key not in self._kept:
            self._kept[key] = mean_state(self.model, self._system(gear), torques)
        found: OperatingPoint = self._kept[key]
        return found

    def _variants(self, gear: str, fit: Fit, asked: Asked) -> Variants:
        fields, masses, laws = self._varied(gear, fit)
        system = self._system(gear)
        connections = _touched(fields, laws)
        outputs = np.array([system.T[system.node_index(node)] for node in asked.nodes])
        return Variants(system, asked.loading(self.model, system), connections, masses, outputs, asked.backend)

    def _system(self, gear: str) -> System:
        return self._gear(gear)[0]

    def _fit(self, gear: str) -> Fit | None:
        return self._gear(gear)[1]

    def _gear(self, gear: str) -> tuple[System, Fit | None]:
        """The system whose laws and mean torques stand for all, and the numbers of all designs."""
        key = "gear", gear
        if key not in self._kept:
            axes = self.designs.axes
            fit = fitted(lambda values: self._told(gear, values), axes, self._some)
            model = self.model if fit is None else changed(self.model, fit.centre)
            system = assemble(model.powertrain(gear))
            if fit is not None and not self._possible(system, fit):
                fit = None
            self._kept[key] = system, fit
        found: tuple[System, Fit | None] = self._kept[key]
        return found

    def _possible(self, system: System, fit: Fit) -> bool:
        fields, masses, laws = _split(system, fit.places)
        connections = _touched(fields, laws)
        still = mean_state(self.model, system, np.zeros(1))
        nothing = Loading(still, np.zeros((1, 0)), np.zeros((1, 0)), (), np.zeros((1, 0, 0), dtype=complex))
        return Variants(system, nothing, connections, masses, np.zeros((0, len(system.coordinates)))).possible

    def _varied(self, gear: str, fit: Fit) -> tuple[dict[str, IntArray], IntArray, IntArray]:
        return _split(self._system(gear), fit.places)

    @cached_property
    def _some(self) -> list[Values]:
        """Designs from all over the plan."""
        count = len(self.designs)
        places = np.unique(np.linspace(0, count - 1, min(CHECKED, count)).astype(int))
        return [self.designs.rows(place, place + 1)[0] for place in places.tolist()]

    def _told(self, gear: str, values: Values) -> Told | None:
        key = "model", tuple(sorted(values.items()))
        try:
            if key not in self._kept:
                self._kept[key] = changed(self.model, values)
            return Told.of(assemble(self._kept[key].powertrain(gear)))
        except ModelError:
            return None


@dataclass(frozen=True, eq=False)
class Asked:
    """Speeds, mean torques and orders of an analysis, and the ``nodes`` wanted.

    ``grid``: every torque at every speed, the torques being the states and speeds × orders the frequencies; else a
    torque a speed, both being the states.  ``backend``: see `Variants`.
    """

    speeds: Array
    torques: Array
    orders: Array
    nodes: tuple[str, ...]
    grid: bool
    backend: str = ""

    @property
    def key(self) -> tuple[Any, ...]:
        """What tells it from others."""
        return self.speeds.tobytes(), self.torques.tobytes(), self.orders.tobytes(), self.nodes, self.grid, self.backend

    def loading(self, model: Model, system: System) -> Loading:
        """The same for one system of the model."""
        throws = torque_places(model).throws
        speeds, torques = (self.speeds[None, :], self.torques[:, None]) if self.grid else (self.speeds, self.torques)
        excited = model.running_engine.excitation(throws, speeds, torques, self.orders).torque
        loads = np.moveaxis(excited, -2, -1).reshape(len(self.torques), -1, len(throws))
        omega, turning = np.outer(self.speeds, self.orders), np.repeat(self.speeds[:, None], self.orders.size, axis=1)
        if self.grid:
            omega, turning = (np.tile(table.ravel(), (len(self.torques), 1)) for table in (omega, turning))
        return Loading(mean_state(model, system, self.torques), omega, turning, tuple(throws), loads)


def _touched(fields: Mapping[str, IntArray], laws: IntArray) -> IntArray:
    """The connections of which any number varies; one at least, where a parameter does nothing in this gear."""
    found = np.union1d(np.concatenate([fields[name] for name in NUMBERS]), laws).astype(np.int64)
    return found if found.size else np.zeros(1, dtype=np.int64)


def _split(system: System, places: IntArray) -> tuple[dict[str, IntArray], IntArray, IntArray]:
    """Which connections vary by field, which masses, which laws: from places of numbers."""
    mark = np.zeros((1, Told.of(system).numbers.size))
    mark[0, places] = 1.0
    tables, laws = parts_of(system, mark)
    fields = {name: np.flatnonzero(table[0]) for name, table in tables.items()}
    return fields, fields["inertia"], np.array([p for p, row in laws.items() if row.any()], dtype=np.int64)


def _numbers(columns: Mapping[str, Any], chosen: Any) -> dict[str, NDArray[np.float64]]:
    """Columns of plain numbers of the chosen designs."""
    return {name: np.array(np.asarray(column, dtype=object)[chosen], dtype=float) for name, column in columns.items()}
