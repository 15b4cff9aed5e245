"""Order response along a run-up, each speed with its own mean torque and the stiffnesses of its own equilibrium."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import dataset, of_model
from torsional.solvers.equilibrium import OperatingPoint, linearize
from torsional.solvers.harmonic import element_torques, node_angles, response
from torsional.solvers.operating import mean_state
from torsional.system import System, assemble


@checked
def run_up_response(
    model: Model,
    speed: ArrayLike | None = None,
    torque: ArrayLike | None = None,
    gear: str | int | None = None,
    orders: ArrayLike = HALF_ORDERS,
) -> xr.Dataset:
    """Order response of a ``model`` in one ``gear`` over ``speed`` [rad/s], each with its mean ``torque`` [Nm].

    The torque defaults to full load.  Complex 0-peak ``angle`` (speed, order, node) [rad], ``torque`` [Nm] and
    ``twist`` [rad] (speed, order, element), ``mean_twist`` (speed, element) [rad] and ``mean_torque`` (speed) [Nm].
    A grid of torques has these only roughly between its lines.  Raises ModelError for a model without an engine, and
    for speeds that the full-load curve does not reach.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> found = run_up_response(truck, [900 * torsional.RPM, 1200 * torsional.RPM], orders=[3.0])
    >>> abs(found.torque.sel(element="dmf", order=3.0)).values.round().tolist()
    [474.0, 234.0]
    """
    _ = model.running_engine
    speeds = np.atleast_1d(model.speeds(141) if speed is None else np.asarray(speed, dtype=float))
    carried = model.full_load(speeds) if torque is None else np.asarray(torque, dtype=float)
    if carried.shape not in ((), (1,), speeds.shape):
        given = f"{carried.size} torques and {speeds.size} speeds"
        raise ModelError("one torque is wanted, or one for each speed", where="torque", found=given)
    torques = np.broadcast_to(carried, speeds.shape)
    n = np.atleast_1d(np.asarray(orders, dtype=float))
    system = assemble(model.powertrain(gear))
    state = mean_state(model, system, torques)
    q, twisting = _coordinates(model, system, state, speeds, torques, n)
    over, at = ("speed", "order"), ("speed", "order", "element")
    found = dataset(
        {
            "angle": ((*over, "node"), node_angles(system, q), "angle"),
            "torque": (at, twisting, "torque"),
            "twist": (at, q @ system.connections.weights.T, "relative_angle"),
            "mean_twist": (("speed", "element"), state.angle, "relative_angle"),
            "mean_torque": (("speed",), torques, "torque"),
        },
        {
            "speed": (speeds, "speed"),
            "order": (n, "engine_order"),
            "node": (np.array(system.nodes), ""),
            "element": (np.array(system.connections.names), ""),
        },
        analysis="run-up response",
        amplitude="complex 0-peak",
    )
    return of_model(found.assign_coords(speed_ratio=("node", system.speed_ratio)), model, model.gear_name(gear))


@checked
def full_load_response(
    model: Model,
    speed: ArrayLike | None = None,
    torque: ArrayLike | None = None,
    gears: Sequence[str | int] | None = None,
    orders: ArrayLike = HALF_ORDERS,
) -> xr.Dataset:
    """Run-ups of all ``gears`` together, at the model's landmarks: dimension ``gear`` in front.

    Nodes are the crankshaft and the node to be kept quiet, elements the absorber's springs and the clutch.

    Orders [rad] and [Nm] as in `run_up_response`, which tells the errors too.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> full_load_response(truck, [1000 * torsional.RPM], gears=[11, 12], orders=[3.0]).angle.dims
    ('gear', 'speed', 'order', 'node')
    """
    marks = model.landmarks
    nodes, elements = list(marks.observed_nodes), list(marks.observed_elements)
    names = model.chosen_gears(gears)
    found = [run_up_response(model, speed, torque, gear, orders).sel(node=nodes, element=elements) for gear in names]
    every = [name for name in found[0].data_vars if name != "mean_torque"]
    settings = {"data_vars": every, "coords": ["speed_ratio"], "compat": "override", "combine_attrs": "override"}
    return xr.concat(found, "gear", **settings).assign_coords(gear=names)  # type: ignore[call-overload, no-any-return]


def _coordinates(
    model: Model, system: System, state: OperatingPoint, speeds: Array, torques: Array, orders: Array
) -> tuple[ComplexArray, ComplexArray]:
    """Coordinates and element torques (speeds, orders, …); speeds of equal stiffnesses are solved together."""
    engine, throws = model.running_engine, model.landmarks.throws
    q = np.empty((len(speeds), len(orders), len(system.coordinates)), dtype=complex)
    twisting = np.empty((len(speeds), len(orders), len(system.connections.names)), dtype=complex)
    _, group = np.unique(np.hstack([state.stiffness, state.damping]), axis=0, return_inverse=True)
    for number in range(int(group.max()) + 1):
        at = np.flatnonzero(group.ravel() == number)
        linear = linearize(system, state.at(int(at[0])))
        excitation = engine.excitation(throws, speeds[at], torques[at], orders)
        loads = np.moveaxis(excitation.torque, 1, 2).reshape(-1, len(throws))
        omega, turning = np.outer(speeds[at], orders).ravel(), np.repeat(speeds[at], len(orders))
        part, _ = response(linear, omega, turning, throws, loads)
        q[at] = part.reshape(len(at), len(orders), -1)
        twisting[at] = element_torques(linear, omega, turning, part).reshape(len(at), len(orders), -1)
    return q, twisting
