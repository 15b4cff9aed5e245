"""Order response along the full-load curve, gear by gear, with the travel of springs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import dataset
from torsional.solvers.campbell import full_load
from torsional.solvers.equilibrium import linearize
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.map import HALF_ORDERS
from torsional.solvers.operating import mean_state
from torsional.stamps import Connection
from torsional.structure import weight_rows
from torsional.system import assemble


def full_load_response(
    model: Model,
    speed: ArrayLike | None = None,
    torque: ArrayLike | None = None,
    gears: Sequence[str | int] | None = None,
    orders: ArrayLike = HALF_ORDERS,
) -> xr.Dataset:
    """Order response of a ``model`` over ``speed`` [rad/s], each speed with its own mean ``torque`` [Nm].

    The torque defaults to full load.  Every speed has the tangent stiffnesses of its own equilibrium, which a grid of
    torques has between its lines only roughly.  Complex 0-peak ``angle`` (gear, speed, order, node) [rad] and ``twist``
    (gear, speed, order, element) [rad] of the absorber's springs and the clutch, with their ``mean_twist``
    (gear, speed, element); ``mean_torque`` (speed) [Nm].  Raises ModelError for a model without an engine, and for
    speeds that the curve does not reach.
    """
    if model.engine is None:
        raise ModelError("the model has no engine, so nothing excites it", where="engine", remedy="add an engine block")
    speeds = np.atleast_1d(model.speeds(141) if speed is None else np.asarray(speed, dtype=float))
    carried = full_load(model, speeds) if torque is None else np.asarray(torque, dtype=float)
    torques = np.broadcast_to(carried, speeds.shape)
    names = [str(gear) for gear in gears] if gears is not None else list(model.gear_names)
    n = np.atleast_1d(np.asarray(orders, dtype=float))
    marks = model.landmarks
    nodes = [node for node in dict.fromkeys((marks.crankshaft, marks.input)) if node]
    elements = [name for name in dict.fromkeys((*marks.springs, marks.clutch)) if name]
    found = [_one_gear(model, gear, speeds, torques, n, nodes, elements) for gear in names]
    angle, twist, mean = (np.stack(parts) for parts in zip(*found, strict=True))
    return dataset(
        {
            "angle": (("gear", "speed", "order", "node"), angle, "angle"),
            "twist": (("gear", "speed", "order", "element"), twist, "relative_angle"),
            "mean_twist": (("gear", "speed", "element"), mean, "relative_angle"),
            "mean_torque": (("speed",), torques, "torque"),
        },
        {
            "gear": (np.array(names), ""),
            "speed": (speeds, "speed"),
            "order": (n, "engine_order"),
            "node": (np.array(nodes, dtype=str), ""),
            "element": (np.array(elements, dtype=str), ""),
        },
        analysis="full-load response",
        model=model.name,
        model_hash=model.hash,
        amplitude="complex 0-peak",
    )


def _one_gear(
    model: Model, gear: str, speeds: Array, torques: Array, orders: Array, nodes: list[str], elements: list[str]
) -> tuple[ComplexArray, ComplexArray, Array]:
    """Angles at nodes, twists and mean twists of elements; speeds of equal stiffness are solved together."""
    powertrain = model.powertrain(gear or None)
    system = assemble(powertrain)
    state = mean_state(model, system, torques)
    engine, throws = model.engine, list(model.landmarks.throws)
    assert engine is not None
    angle = np.empty((len(speeds), len(orders), len(system.nodes)), dtype=complex)
    _, group = np.unique(state.stiffness, axis=0, return_inverse=True)
    for number in np.unique(group):
        at = np.flatnonzero(group.ravel() == number)
        fields = {key: getattr(state, key)[at[0]] for key in ("torque", "angle", "stiffness")}
        excitation = engine.excitation(throws, speeds[at], torques[at], orders)
        angle[at] = harmonic_response(linearize(system, replace(state, **fields)), excitation).angle.values
    kinds = {stamp.name: stamp for stamp in powertrain.stamps if isinstance(stamp, Connection)}
    along = weight_rows([kinds[name] for name in elements], system.nodes)
    at_nodes = [system.node_index(node) for node in nodes]
    columns = [state.names.index(name) for name in elements]
    return angle[..., at_nodes], np.asarray(angle @ along.T), state.angle[:, columns]
