"""Order response of a linear system: angles of all nodes and torques of all connections, order by order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray, StatusArray
from torsional.numerics.elimination.plan import EliminationPlan, Status
from torsional.numerics.linear.factor_products import factor_products
from torsional.results import dataset
from torsional.solvers.checks import linear
from torsional.solvers.modal import natural_frequencies
from torsional.system import System
from torsional.units import show


@checked
def harmonic_response(system: System, excitation: Excitation) -> xr.Dataset:
    """Steady response of a linear ``system`` to the orders of an ``excitation`` over its speeds.

    (K(1 + iη) + Ω²S + iωC − ω²M) q = Tᵀ u with ω = nΩ.  Dimensions (speed, order, node) of the complex 0-peak ``angle``
    [rad] and (speed, order, element) of the ``torque`` [Nm] of each connection, its damper's share included; order 0 is
    left to `equilibrium`.  Raises ModelError for a nonlinear system (linearize it first), for a node that is not there
    and where an undamped mode is met exactly (the mode is named).

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = {"a": Inertia(1.8), "b": Inertia(1.2), "s": Shaft("a", "b", 12e3)}
    >>> at = Excitation.unit("a", [1.0], [60 * np.pi])
    >>> response = harmonic_response(assemble(Powertrain(pair)), at)
    >>> [f"{x.real:.8e}" for x in response.angle.values[0, 0]]
    ['-2.11618759e-05', '8.28883610e-06']
    """
    speed, orders, omega, turning, q = order_response(system, excitation)
    grid = (len(speed), len(orders), -1)
    return dataset(
        {
            "angle": (("speed", "order", "node"), node_angles(system, q).reshape(grid), "angle"),
            "torque": (
                ("speed", "order", "element"),
                element_torques(system, omega, turning, q).reshape(grid),
                "torque",
            ),
        },
        {
            "speed": (speed, "speed"),
            "order": (orders, "engine_order"),
            "node": (np.array(system.nodes), ""),
            "element": (np.array(system.connections.names), ""),
            "speed_ratio": (system.speed_ratio, "gear_ratio", "node"),
        },
        analysis="harmonic response",
        amplitude="complex 0-peak",
        system_hash=system.hash,
    )


def order_response(system: System, excitation: Excitation) -> tuple[Array, Array, Array, Array, ComplexArray]:
    """`harmonic_response` as arrays: speeds, orders; of every pair its frequency, speed and coordinates (pairs, …)."""
    linear(system)
    speed = np.atleast_1d(excitation.speed)
    if speed.ndim > 1:
        raise ModelError("the excitation has more than one axis of speeds", remedy="use response_map for grids")
    kept = excitation.orders > 0
    orders = excitation.orders[kept]
    torque = np.moveaxis(excitation.torque.reshape(len(speed), len(excitation.nodes), -1)[..., kept], 1, 2)
    turning = np.repeat(speed, len(orders))
    omega = np.outer(speed, orders).ravel()
    q, status = response(system, omega, turning, excitation.nodes, torque.reshape(omega.size, -1))
    _refuse_singular(system, status, omega, turning)
    return speed, orders, omega, turning, q


def response(
    system: System,
    omega: Array,
    speed: Array,
    nodes: Sequence[str],
    torque: ComplexArray,
    values: Mapping[str, ArrayLike] | None = None,
) -> tuple[ComplexArray, StatusArray]:
    """Coordinates q (frequencies, coordinates) and a status for each case, by the compiled elimination; designs first.

    ``omega`` and ``speed`` (frequencies,) [rad/s]; ``torque`` (frequencies, nodes), or with a leading axis of designs.
    ``values`` exchanges connection or mass values by name of the field (stiffness, damping, loss_factor,
    centrifugal_stiffness, inertia), each (values,) or (designs, values).  A speed-switched inertia takes its value at
    each speed.
    """
    states = _switch_states(system, speed)
    if len(states) == 1:
        return _solved(system.switched(float(speed[0])), omega, speed, nodes, torque, values)
    parts = [
        (mask, _solved(system.switched(at), omega[mask], speed[mask], nodes, torque[..., mask, :], values))
        for at, mask in states
    ]
    q = np.empty((*parts[0][1][0].shape[:-2], omega.size, len(system.coordinates)), dtype=complex)
    status = np.empty(q.shape[:-1], dtype=parts[0][1][1].dtype)
    for mask, (part, told) in parts:
        q[..., mask, :], status[..., mask] = part, told
    return q, status


def _switch_states(system: System, speed: Array) -> list[tuple[float, np.ndarray[tuple[int], np.dtype[np.bool_]]]]:
    """Groups of speeds at which every switched inertia has one value: a speed of the group, and its members."""
    if not any(system.masses.switches):
        return [(float(speed[0]), np.ones(speed.size, dtype=bool))]
    state = np.zeros(speed.size, dtype=np.int64)
    for switch in system.masses.switches:
        if switch is not None:
            state = 2 * state + np.array([switch.above(v) for v in speed])
    return [(float(speed[state == s][0]), state == s) for s in np.unique(state)]


def _solved(
    system: System,
    omega: Array,
    speed: Array,
    nodes: Sequence[str],
    torque: ComplexArray,
    values: Mapping[str, ArrayLike] | None,
) -> tuple[ComplexArray, StatusArray]:
    c, m, own = system.connections, system.masses, dict(values or {})
    plan = EliminationPlan.build(c.weights, m.weights)
    loaded, loads = _loads(system, nodes, torque)
    q, status = plan.solve(
        own.get("stiffness", c.stiffness),
        own.get("loss_factor", c.loss_factor),
        own.get("damping", c.damping),
        own.get("centrifugal_stiffness", c.centrifugal_stiffness),
        own.get("inertia", m.inertia),
        omega,
        speed,
        loaded,
        loads[..., np.newaxis, :],
        connection_weights=c.weights,
        mass_weights=m.weights,
    )
    many = torque.ndim > 2 or any(np.ndim(value) > 1 for value in own.values())
    return (q[..., 0, :], status) if many else (q[0, :, 0], status[0])


def _loads(system: System, nodes: Sequence[str], torque: ComplexArray) -> tuple[tuple[int, ...], ComplexArray]:
    """Loaded coordinates and the torques on them, Tᵀu without the coordinates that nothing loads."""
    onto = np.array([system.T[system.node_index(node)] for node in nodes])
    loaded = tuple(int(i) for i in np.flatnonzero(onto.any(axis=0)))
    first = np.abs(onto).argmax(axis=1)
    if np.count_nonzero(onto) == len(nodes) == len(loaded) and (onto[np.arange(len(nodes)), first] == 1).all():
        return tuple(int(i) for i in first), torque
    return loaded, np.asarray(torque @ onto[:, list(loaded)])


def node_angles(system: System, q: ComplexArray) -> ComplexArray:
    """θ = T q for coordinates on the last axis."""
    used = np.count_nonzero(system.T, axis=1)
    if used.max() > 1:
        return np.asarray(q @ system.T.T)
    column = np.abs(system.T).argmax(axis=1)
    factor = system.T[np.arange(len(column)), column]
    if np.array_equal(column, np.arange(q.shape[-1])) and (factor == 1).all():
        return q
    return np.asarray(q[..., column] * factor)


def element_torques(
    system: System, omega: Array, speed: Array, q: ComplexArray, values: Mapping[str, ArrayLike] | None = None
) -> ComplexArray:
    """Torque of each connection [Nm], (k(1 + iη) + iωc + Ω²s) w·q: the one definition, damper share included."""
    c, own = system.connections, dict(values or {})
    k, eta, damping, lift = (
        own.get(key, getattr(c, key)) for key in ("stiffness", "loss_factor", "damping", "centrifugal_stiffness")
    )
    return factor_products(q, c.weights, k, eta, damping, lift, omega, speed)


def _refuse_singular(system: System, status: StatusArray, omega: Array, speed: Array) -> None:
    """Name the mode that is met without damping, or the rigid body at standstill."""
    where = np.flatnonzero(status == Status.SINGULAR)
    if not where.size:
        return
    at = float(omega[where[0]])
    if at == 0:
        raise ModelError("a rigid body cannot be held at zero frequency", found="0 rad/s", allowed="speeds above 0")
    modes = natural_frequencies(system, float(speed[where[0]]))
    nearest = float(modes[np.argmin(np.abs(modes - at))])
    raise ModelError(
        "an undamped mode is met exactly, its response is infinite",
        where=show(float(speed[where[0]]), "speed"),
        found=f"mode at {show(nearest / (2 * np.pi), 'frequency')}",
        remedy="give some connection of this mode a damping or a loss_factor, or move the speed",
    )
