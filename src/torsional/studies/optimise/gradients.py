"""Criteria of the linear response at single operating points, with their exact derivatives by the design."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.solvers.derivatives import Slope, coordinate_derivatives
from torsional.solvers.harmonic import order_response
from torsional.studies.optimise.lines import Design, Line
from torsional.studies.sweeps.absorbers import EnvelopeRun
from torsional.studies.sweeps.analyses import MapRun, ResponseRun
from torsional.studies.sweeps.criteria import CriteriaRun, Criterion, selected
from torsional.studies.sweeps.envelopes import spring_ways
from torsional.system import System

LINEAR = ("acceleration", "acceleration_swing", "twist", "reach")
"""Figures of the linear analyses that have exact derivatives."""


@dataclass(frozen=True)
class Points:
    """Operating points of one criterion, a place each: ``gear``, ``speed`` [rad/s], mean ``torque`` [Nm].

    ``figure`` is an acceleration of the node ``where``, or twist or reach of the connection of that name, at ``order``.
    """

    figure: str
    where: str
    order: float
    gear: tuple[str, ...]
    speed: Array
    torque: Array

    def some(self, places: IntArray) -> Points:
        """Some of the points."""
        gear = tuple(self.gear[place] for place in places)
        return Points(self.figure, self.where, self.order, gear, self.speed[places], self.torque[places])


def points_of(run: Any, name: str, model: Model) -> list[Points]:
    """All operating points that a criterion is the largest of; none where it is no figure with exact derivatives."""
    if not isinstance(run, CriteriaRun) or not (criterion := run.criteria[name]).of:
        return []
    asked: Any = run.ask[criterion.of]
    if criterion.worst != "largest" or criterion.figure not in LINEAR:
        return []
    if isinstance(asked, EnvelopeRun):
        speeds = asked.speeds(model)
        torques = np.multiply.outer(np.array(asked.loads), model.full_load(speeds))
        gears = tuple(asked.gears or model.gear_names)
        orders = np.array(asked.orders or model.engine_orders(1), dtype=float)
        node = model.landmarks.input
    elif isinstance(asked, MapRun | ResponseRun):
        speeds, orders, node = asked.speeds(model), asked.asked_orders(model), asked.place(model)
        torques, gears = _torques(asked, model, speeds)
    else:
        return []
    if orders.size != 1 or any(key not in ("gear", "speed", "element", "order") for key in criterion.select):
        return []
    return _chosen(criterion, model, (gears, speeds, torques, float(orders[0])), node)


def _torques(asked: Any, model: Model, speeds: Array) -> tuple[Array, tuple[str, ...]]:
    """Mean torques (loads, speeds), not a number beyond full load, and gears."""
    if isinstance(asked, MapRun):
        levels = model.torques(asked.torques)
        within = model.within_full_load(speeds, levels)
        return np.where(within, levels[:, None], np.nan), tuple(asked.gears or model.gear_names)
    mean = model.full_load(speeds) if asked.torque is None else np.full(speeds.size, asked.torque)
    return np.atleast_2d(mean), (model.gear_name(asked.gear or None),)


def _chosen(
    criterion: Criterion, model: Model, grid: tuple[tuple[str, ...], Array, Array, float], node: str
) -> list[Points]:
    """The points that the criterion selects, of a node or spring by spring."""
    gears, speeds, torques, order = grid
    shape = (len(gears), *torques.shape)
    marks = {"gear": list(gears), "speed": ("speed", speeds, {"quantity": "speed"})}
    places = xr.DataArray(np.arange(np.prod(shape)).reshape(shape), dims=("gear", "load", "speed"), coords=marks)
    of_springs = criterion.figure in ("twist", "reach")
    springs = xr.DataArray(list(spring_ways(model)), dims="element")
    springs = springs.assign_coords(element=springs.values)
    for dimension, label in criterion.select.items():
        if dimension in places.dims:
            places = selected(places, dimension, label)
        elif dimension == "element" and of_springs:
            springs = selected(springs, dimension, label)
    gear, load, speed = np.unravel_index(places.values.ravel(), shape)
    known = np.isfinite(torques[load, speed])
    gear, load, speed = gear[known], load[known], speed[known]
    where = springs.values.tolist() if of_springs else [node]
    names = tuple(gears[g] for g in gear)
    return [Points(criterion.figure, each, order, names, speeds[speed], torques[load, speed]) for each in where]


@dataclass(frozen=True)
class Around:
    """A design of a ``model``, and pairs of designs about it by parameter, each with the parameter's difference."""

    model: Model
    centre: Design
    sides: Mapping[str, tuple[Design, Design, float]]

    def values(self, points: Points) -> tuple[Array, Array]:
        """The figure at every point (points,) and its derivatives (points, parameters)."""
        found, slopes = np.empty(points.speed.size), np.empty((points.speed.size, len(self.sides)))
        gears = np.array(points.gear)
        for gear in dict.fromkeys(points.gear):
            at = np.flatnonzero(gears == gear)
            found[at], slopes[at] = self._one_gear(gear, points.some(at))
        return found, slopes

    def _one_gear(self, gear: str, points: Points) -> tuple[Array, Array]:
        line = self.centre.line(gear, points.torque)
        sides = [[side.line(gear, points.torque) for side in pair[:2]] for pair in self.sides.values()]
        steps = np.array([pair[2] for pair in self.sides.values()])
        tangents = np.hstack([line.state.stiffness, line.state.damping])[line.places]
        _, group = np.unique(tangents, axis=0, return_inverse=True)
        swing = np.empty(points.speed.size, dtype=complex)
        change = np.empty((points.speed.size, len(steps)), dtype=complex)
        for number in range(int(group.max()) + 1):
            at = np.flatnonzero(group.ravel() == number)
            slopes = [
                Slope.between(low.linear(int(at[0])), high.linear(int(at[0])), float(step))
                for (low, high), step in zip(sides, steps, strict=True)
            ]
            system = line.linear(int(at[0]))
            swing[at], change[at] = _motion(self.model, system, points.some(at), slopes)
        size = np.abs(swing)
        rise = (swing.conj()[:, None] * change).real / np.maximum(size, 1e-300)[:, None]
        if points.figure.startswith("acceleration"):
            square = (points.order * points.speed) ** 2
            return square * size, square[:, None] * rise
        return self._twisted(points, line, sides, steps, size, rise)

    def _twisted(
        self, points: Points, line: Line, sides: list[list[Line]], steps: Array, size: Array, rise: Array
    ) -> tuple[Array, Array]:
        """Mean and vibration together, over the way to the stop where reach is asked."""
        mean = line.angle(points.where)
        slope = np.array([(high.angle(points.where) - low.angle(points.where)) for low, high in sides]).T / steps
        whole, moved = np.abs(mean) + size, np.sign(mean)[:, None] * slope + rise
        if points.figure == "twist":
            return whole, moved
        way = self.centre.way(points.where)
        ways = [[side.way(points.where) for side in pair[:2]] for pair in self.sides.values()]
        longer = np.array([high - low if np.isfinite(high) else 0.0 for low, high in ways]) / steps
        return whole / way, moved / way - np.outer(whole, longer) / way**2


def _motion(model: Model, system: System, points: Points, slopes: list[Slope]) -> tuple[ComplexArray, ComplexArray]:
    """Angle of the node, or twist of the connection, (points,), and its derivatives (points, parameters)."""
    engine, throws = model.running_engine, model.landmarks.throws
    drive = engine.excitation(throws, points.speed, points.torque, [points.order])
    _, _, omega, turning, q = order_response(system, drive)
    moved = coordinate_derivatives(system, drive, omega, turning, q, slopes)
    if points.figure.startswith("acceleration"):
        place = system.node_index(points.where)
        row, rows = system.T[place], [slope.T[place] for slope in slopes]
    else:
        place = system.connections.names.index(points.where)
        row, rows = system.connections.weights[place], [slope.W[place] for slope in slopes]
    change = [part @ row + q @ own for part, own in zip(moved, rows, strict=True)]
    return np.asarray(q @ row), np.asarray(change).reshape(len(slopes), len(q)).T
