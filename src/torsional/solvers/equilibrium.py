"""Equilibrium under mean torques, and the linear system that small vibrations about it see."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.laws import Law
from torsional.notebook import operating_point_table
from torsional.numerics.arrays import Array
from torsional.numerics.linear.null_space import null_vectors
from torsional.system import System

ITERATIONS = 100


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """Mean state of every connection: ``torque`` [Nm], ``angle`` [rad], tangents ``stiffness``, ``damping`` [Nms/rad].

    Arrays have the shape of the mean torques asked for, then one place a connection of ``names``; ``laws`` (None where
    linear) are those the state was found with.  The tangents are those at rest, where friction sticks.
    It is what `equilibrium` gives; raises ModelError where one of several points is asked for and none is picked.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)}))
    >>> equilibrium(pair, {"a": [100.0, 200.0]}, hold="b").at(1).torque.round(6).tolist()
    [-200.0]
    """

    names: tuple[str, ...]
    torque: Array
    angle: Array
    stiffness: Array
    damping: Array
    laws: tuple[Law | None, ...]

    def at(self, case: int) -> OperatingPoint:
        """One of several operating points, by its place among the mean torques."""
        fields = ("torque", "angle", "stiffness", "damping")
        return dataclasses.replace(self, **{name: getattr(self, name)[case] for name in fields})

    def stage(self, name: str) -> str:
        """The active stage of one connection, of an operating point at a single torque, in words."""
        law = self.laws[i := self._index(name)]
        return "linear" if law is None else law.stage_name(float(self.angle[i]))

    def distance_to_stop(self, name: str) -> float:
        """The way [rad] one connection has left to its stop; not a number where it has none."""
        law = self.laws[i := self._index(name)]
        return float("nan") if law is None else law.distance_to_stop(float(self.angle[i]), float(self.torque[i]))

    _repr_html_ = operating_point_table

    def _index(self, name: str) -> int:
        if name not in self.names:
            raise ModelError(f"there is no connection '{name}'", where=name, remedy=nearest(name, self.names))
        if self.angle.ndim > 1:
            raise ModelError("the operating point is one of many", where=name, remedy="ask for a single mean torque")
        return self.names.index(name)


@checked
def equilibrium(system: System, torques: Mapping[str, ArrayLike], hold: str) -> OperatingPoint:
    """Mean twist of every connection under mean ``torques`` {node: Nm}, taken up at the node ``hold``.

    K q + Σ w f(w·q) = u with uᵀ1 = 0: the torque at ``hold`` balances the others through the speed ratios, never a
    soft ground spring.  Torques may be arrays of one shape.  Where statics alone fix the torques (no two spring paths
    side by side) each law is inverted exactly, in a free range to its middle; else Newton's method.  Friction carries
    no mean torque: vibration has relaxed it.
    Raises ModelError for unknown nodes and for torques that no spring can carry.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)})
    >>> equilibrium(assemble(pair), {"a": 100.0}, hold="b").angle.round(12).tolist()
    [-0.01]
    """
    elastic = _without_friction(system)
    torque, angle = _settled(system, elastic, _balanced(elastic, torques, hold), hold)
    return _point(system, np.broadcast_shapes(*(np.shape(value) for value in torques.values())), torque, angle)


def _settled(system: System, elastic: System, loads: Array, hold: str) -> tuple[Array, Array]:
    """Torques and angles (cases, connections) under balanced loads (cases, coordinates)."""
    carrying = _carrying(elastic)
    weights = system.connections.weights[carrying]
    shares, _, rank, _ = np.linalg.lstsq(weights.T, loads.T, rcond=None)
    if rank == len(weights):
        residual = np.abs(weights.T @ shares - loads.T).max(initial=0.0)
        if residual > 1e-9 * np.abs(loads).max(initial=1.0):
            raise ModelError("no spring carries the mean torque to the node that takes it up", where=hold)
        torque = np.zeros((len(loads), carrying.size))
        torque[:, carrying] = shares.T
        angle = np.array([_angles(elastic, i, torque[:, i]) for i in range(carrying.size)]).T
        _take_along(system, angle, carrying)
        return torque, angle
    found = [_newton(elastic, load) for load in loads]
    angle = np.array([system.connections.weights @ q for q in found])
    return np.array([_forces(elastic, a)[0] for a in angle]), angle


def settled(system: System, load: Array) -> Array:
    """Angles [rad] of all connections in equilibrium under balanced torques (coordinates,) [Nm] on the coordinates.

    Raises ModelError where no spring can carry them.
    """
    return np.asarray(_settled(system, _without_friction(system), load[None], "")[1][0])


def _point(system: System, shape: tuple[int, ...], torque: Array, angle: Array) -> OperatingPoint:
    """The tangents beside torques and angles (cases, connections), in the shape of the mean torques asked for.

    Normal loads are those of the mean torques at standstill; what speed adds is `with_load_stiffness`.
    """
    c = system.connections
    if any(load is not None for load in c.loads):
        pressed = [dict(zip(c.names, t, strict=True)) for t in torque]
        found = [_forces(system.loaded(0.0, p), a) for p, a in zip(pressed, angle, strict=True)]
        tangent, drag = (np.array([each[place] for each in found]) for place in (1, 2))
    else:
        _, tangent, drag = _forces(system, angle)
    each = (torque, angle, tangent, drag)
    torque, angle, stiffness, damping = (value.reshape(*shape, len(c.names)) for value in each)
    return OperatingPoint(c.names, torque, angle, stiffness, damping, c.laws)


@checked
def linearize(system: System, point: OperatingPoint) -> System:
    """The same system with each law replaced by its tangents at one operating point; friction sticks.

    Raises ModelError for a point of several operating points (pick one with its ``at``).

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.laws import Polynomial
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> bent = Coupling("b", "a", Polynomial((100.0, 0.0, 1e4)))
    >>> pair = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "spring": bent}))
    >>> round(linearize(pair, equilibrium(pair, {"a": 20.0}, hold="b")).K[0, 0])  # 100 + 3e4 φ² at φ = 0.1
    400
    """
    if point.names != system.connections.names:
        raise ModelError("the operating point belongs to another system", found=", ".join(point.names[:8]))
    pressed = with_load_stiffness(system)
    c = pressed.connections
    plain = [law is None for law in c.laws]
    stiffness, damping = (
        np.where(plain, old, new) for old, new in ((c.stiffness, point.stiffness), (c.damping, point.damping))
    )
    return pressed.with_connections(stiffness=stiffness, damping=damping, laws=(None,) * len(point.names))


def with_load_stiffness(system: System) -> System:
    """The system in which the centrifugal normal loads of sticking friction are centrifugal stiffnesses.

    The torque of bristles is N σ0 z, so that N = m r Ω² makes them a stiffness m r σ0 Ω².  Their damping stays that of
    standstill.  Raises ModelError for a load that falls with speed.
    """
    c = system.connections
    lift, loads, laws = c.centrifugal_stiffness.copy(), list(c.loads), list(c.laws)
    for i, (law, load) in enumerate(zip(c.laws, c.loads, strict=True)):
        if law is None or load is None or c.whole_speed[i] or not load.centrifugal:
            continue
        if load.centrifugal < 0:
            remedy = "settle it at one speed: system.loaded(speed)"
            raise ModelError("a normal load that falls with speed is no stiffness", where=c.names[i], remedy=remedy)
        loose, pressed = (float(law.loaded(n).tangent(0.0)) for n in (0.0, load.centrifugal))
        lift[i] += pressed - loose
        rest = bool(load.constant or load.shares)
        laws[i] = law if rest else law.loaded(0.0)
        loads[i] = dataclasses.replace(load, centrifugal=0.0) if rest else None
    return system.with_connections(centrifugal_stiffness=lift, loads=tuple(loads), laws=tuple(laws))


def _balanced(system: System, torques: Mapping[str, ArrayLike], hold: str) -> Array:
    """Mean torques on the coordinates (cases, coordinates), the reaction at ``hold`` included.

    No work is left on what is free to turn; springs to the ground take no share.
    """
    held = system.T[system.node_index(hold)]
    values = np.broadcast_arrays(*(np.asarray(value, dtype=float) for value in torques.values()))
    rows = np.array([system.T[system.node_index(node)] for node in torques])
    loads = np.column_stack([np.ravel(value) for value in values]) @ rows
    turns = np.array([system.speed_ratio[system.node_index(node)] != 0 for node in system.coordinates], dtype=float)
    for free in (null_vectors(system.connections.weights[_carrying(system)]), turns[:, None]):
        along = held @ free
        if along.any():
            return np.asarray(loads - np.outer(loads @ free @ along / (along @ along), held))
    raise ModelError(f"node '{hold}' does not turn and takes up no mean torque", where=hold)


def _carrying(system: System) -> Array:
    """Connections that can carry a mean torque: dampers and pendulums cannot."""
    c = system.connections
    return np.asarray((c.stiffness > 0) | np.array([law is not None for law in c.laws], dtype=bool))


def _without_friction(system: System) -> System:
    """The system without the laws that carry no mean torque; a pendulum hangs between its stops."""
    c = system.connections
    idle = c.whole_speed | (c.centrifugal_stiffness > 0)
    pairs = zip(c.laws, idle, strict=True)
    laws = tuple(law if law and law.carries_mean_torque and not without else None for law, without in pairs)
    return system.with_connections(laws=laws)


def _take_along(system: System, angle: Array, carrying: Array) -> None:
    """Give friction the angles that the springs beside it have; none where no springs say them."""
    c = system.connections
    sliding = [i for i, law in enumerate(c.laws) if law is not None and not carrying[i]]
    if sliding:
        follows = np.linalg.lstsq(c.weights[carrying].T, c.weights[sliding].T, rcond=None)[0].T
        told = np.abs(follows @ c.weights[carrying] - c.weights[sliding]).max(axis=1) < 1e-9
        angle[:, sliding] = np.where(told, angle[:, carrying] @ follows.T, 0.0)


def _angles(system: System, index: int, torque: Array) -> Array:
    c = system.connections
    law, stiffness = c.laws[index], c.stiffness[index]
    if law is None:
        return np.asarray(torque / stiffness) if stiffness > 0 else np.zeros_like(torque)
    try:
        return law.angle(torque, stiffness)
    except ModelError as error:
        raise error.located(prefix=c.names[index]) from None


def _forces(system: System, angle: Array) -> tuple[Array, Array, Array]:
    """Torque, tangent stiffness and tangent damping of every connection at rest at its angle (…, connections)."""
    c = system.connections
    torque = c.stiffness * angle
    tangent, damping = (np.broadcast_to(value, angle.shape).copy() for value in (c.stiffness, c.damping))
    for i, law in enumerate(c.laws):
        if law is not None and not c.whole_speed[i]:
            told = law.evaluate(angle[..., i])[:3]
            for values, own in zip((torque, tangent, damping), told, strict=True):
                values[..., i] += own
    return torque, tangent, damping


def _newton(system: System, load: Array) -> Array:
    """Coordinates in equilibrium where springs act side by side; rigid rotation is left out by least squares.

    Rising laws have a convex potential: Newton's direction with an exact search along it finds its lowest place.
    """
    weights = system.connections.weights
    q, scale = np.zeros(weights.shape[1]), max(float(np.abs(load).max()), 1.0)
    for _ in range(ITERATIONS):
        angle = weights @ q
        torque, tangent, _ = _forces(system, angle)
        rest = load - weights.T @ torque
        rounding = 8 * np.finfo(float).eps * float((np.abs(torque) + tangent * np.abs(angle)).max())
        if np.abs(rest).max() <= 1e-11 * scale + rounding:
            return q
        soft = np.maximum(tangent, 1e-9 * tangent.max() or 1.0)  # a free range is crossed, not divided by
        step = np.asarray(np.linalg.lstsq((weights.T * soft) @ weights, rest, rcond=1e-14)[0])
        q = q + _length(system, q, step, load) * step
    raise ModelError("no equilibrium found under the mean torque", found=f"{np.abs(load).max():g} Nm")


def _length(system: System, q: Array, step: Array, load: Array) -> float:
    """How many Newton steps to go until the unbalanced torque does no more work along them: one, where that will do."""
    weights = system.connections.weights

    def work(length: float) -> float:
        return float((load - weights.T @ _forces(system, weights @ (q + length * step))[0]) @ step)

    start, end = work(0.0), work(1.0)
    if abs(end) <= 0.5 * start:
        return 1.0
    from scipy.optimize import brentq  # imported where used: most equilibria are settled by statics

    low, high = (0.0, 1.0) if end < 0 else (1.0, 2.0)
    while work(high) > 0 and high < 2.0**60:
        low, high = high, 2 * high
    return float(brentq(work, low, high, xtol=1e-300)) if work(high) <= 0 else high
