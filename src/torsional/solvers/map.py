"""Order response over speed, mean torque and gear."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray, StatusArray
from torsional.results import dataset, of_model
from torsional.solvers.equilibrium import with_load_stiffness
from torsional.solvers.harmonic import element_torques, response
from torsional.solvers.operating import mean_state, torque_places
from torsional.system import System, assemble


@checked
def response_map(
    model: Model,
    speed: ArrayLike | None = None,
    torque: ArrayLike | None = None,
    gears: Sequence[str | int] | None = None,
    orders: ArrayLike = HALF_ORDERS,
    *,
    nodes: Sequence[str] | None = None,
    elements: Sequence[str] | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> xr.Dataset:
    """Order response of a ``model`` over ``speed`` [rad/s] × mean ``torque`` [Nm] × ``gears``.

    Each mean torque has its own equilibrium and tangent stiffnesses.  Dimensions (gear, mean_torque, speed, order):
    complex 0-peak ``angle`` [rad] at ``nodes`` (default: the model's landmarks) and ``torque`` [Nm] of ``elements``
    (default: absorber springs and clutch); ``mean_twist`` (gear, mean_torque, element) [rad];
    ``within_full_load`` (mean_torque, speed), false at speeds that the curve does not reach as well; ``status``
    (gear, mean_torque, speed, order), 0 where solved, NaN stands where not.
    ``progress(done, total)`` is called after each gear.  Raises ModelError for a model without an engine.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> found = response_map(truck, [1000 * torsional.RPM], [2000.0], gears=[12], orders=[3.0])
    >>> abs(found.torque.sel(element="dmf")).values.ravel().round().tolist()  # Nm, 0-peak
    [297.0]
    """
    engine = model.running_engine
    speeds = np.atleast_1d(model.speeds(57) if speed is None else np.asarray(speed, dtype=float))
    torques = np.atleast_1d(model.torques(26) if torque is None else np.asarray(torque, dtype=float))
    names = model.chosen_gears(gears)
    n = np.atleast_1d(np.asarray(orders, dtype=float))
    throws = torque_places(model).throws  # a single one takes the torques of all cylinders
    excitation = engine.excitation(throws, speeds[None, :], torques[:, None], n).torque
    loads = np.moveaxis(excitation, -2, -1).reshape(len(torques), -1, excitation.shape[-2])
    cells = []
    for done, gear in enumerate(names, 1):
        cells.append(_one_gear(model, gear, speeds, torques, n, loads, _places(model, nodes, elements)))
        progress(done, len(names))
    angle, torsion, mean, status, ratio = (np.stack(parts) for parts in zip(*cells, strict=True))
    chosen = _places(model, nodes, elements)
    grid = ("gear", "mean_torque", "speed", "order")
    found = dataset(
        {
            "angle": ((*grid, "node"), angle, "angle"),
            "torque": ((*grid, "element"), torsion, "torque"),
            "mean_twist": (("gear", "mean_torque", "element"), mean, "relative_angle"),
            "status": (grid, status, ""),
            "within_full_load": (("mean_torque", "speed"), model.within_full_load(speeds, torques), ""),
        },
        {
            "gear": (np.array(names), ""),
            "mean_torque": (torques, "torque"),
            "speed": (speeds, "speed"),
            "order": (n, "engine_order"),
            "node": (np.array(chosen[0]), ""),
            "element": (np.array(chosen[1]), ""),
        },
        analysis="response map",
        amplitude="complex 0-peak",
    )
    return of_model(found.assign_coords(speed_ratio=(("gear", "node"), ratio)), model)


def _places(model: Model, nodes: Sequence[str] | None, elements: Sequence[str] | None) -> tuple[list[str], list[str]]:
    kept = model.landmarks.observed_nodes if nodes is None else nodes
    twisted = model.landmarks.observed_elements if elements is None else elements
    return [node for node in dict.fromkeys(kept) if node], [name for name in dict.fromkeys(twisted) if name]


def _one_gear(
    model: Model,
    gear: str,
    speeds: Array,
    torques: Array,
    orders: Array,
    loads: ComplexArray,
    places: tuple[list[str], list[str]],
) -> tuple[ComplexArray, ComplexArray, Array, StatusArray, Array]:
    system = with_load_stiffness(assemble(model.powertrain(gear)))
    state = mean_state(model, system, torques)
    values = {"stiffness": state.stiffness}
    if (state.damping != system.connections.damping).any():  # a law that damps at rest
        values["damping"] = state.damping
    turning, omega = np.repeat(speeds, len(orders)), np.outer(speeds, orders).ravel()
    q, status = response(system, omega, turning, model.landmarks.throws, loads, values)
    shape = (len(torques), len(speeds), len(orders), -1)
    nodes = [system.node_index(node) for node in places[0]]
    twisted = _elements(system, places[1])
    angle = (q @ system.T[nodes].T).reshape(shape)
    part = dataclasses.replace(system, connections=system.connections.picked(twisted))
    told = {key: value[:, twisted] for key, value in values.items()}
    torque = element_torques(part, omega, turning, q, told).reshape(shape)
    return angle, torque, state.angle[:, twisted], status.reshape(shape[:-1]), system.speed_ratio[nodes]


def _elements(system: System, names: list[str]) -> list[int]:
    known = system.connections.names
    for name in names:
        if name not in known:
            raise ModelError(f"there is no connection '{name}'", where=name, remedy=nearest(name, known))
    return [known.index(name) for name in names]
