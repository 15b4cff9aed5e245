"""Equilibrium under mean torques, and the linear system that small vibrations about it see."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError, nearest
from torsional.laws import Hinges, Law
from torsional.numerics.arrays import Array
from torsional.numerics.null_space import null_vectors
from torsional.system import System

ITERATIONS = 100


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """Mean state of every connection: ``torque`` [Nm], ``angle`` [rad], ``stiffness`` (tangent) [Nm/rad].

    Arrays have the shape of the mean torques asked for, then one place a connection of ``names``; ``laws`` (None where
    linear) are those the state was found with.
    """

    names: tuple[str, ...]
    torque: Array
    angle: Array
    stiffness: Array
    laws: tuple[Law | None, ...]

    def at(self, case: int) -> OperatingPoint:
        """One of several operating points, by its place among the mean torques."""
        return dataclasses.replace(
            self, torque=self.torque[case], angle=self.angle[case], stiffness=self.stiffness[case]
        )

    def stage(self, name: str) -> str:
        """The active stage of one connection, of an operating point at a single torque, in words."""
        i = self._index(name)
        law = self.laws[i]
        return "linear" if law is None else law.stage_name(float(self.angle[i]))

    def distance_to_stop(self, name: str) -> float:
        """The way [rad] one connection has left to its stop; not a number where it has none."""
        i = self._index(name)
        law = self.laws[i]
        return float("nan") if law is None else law.distance_to_stop(float(self.angle[i]), float(self.torque[i]))

    def _index(self, name: str) -> int:
        if name not in self.names:
            raise ModelError(f"there is no connection '{name}'", where=name, remedy=nearest(name, self.names))
        if self.angle.ndim > 1:
            raise ModelError("the operating point is one of many", where=name, remedy="ask for a single mean torque")
        return self.names.index(name)


def equilibrium(system: System, torques: Mapping[str, ArrayLike], hold: str) -> OperatingPoint:
    """Mean twist of every connection under mean ``torques`` {node: Nm}, taken up at the node ``hold``.

    K q + Σ w f(w·q) = u with uᵀ1 = 0: the torque at ``hold`` balances the others through the speed ratios, never a
    soft ground spring.  Torques may be arrays of one shape.  Where statics alone fix the torques (no two spring paths
    side by side) each law is inverted exactly, in a free range to its middle; else Newton's method.
    Raises ModelError for unknown nodes and for torques that no spring can carry.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)})
    >>> equilibrium(assemble(pair), {"a": 100.0}, hold="b").angle.round(12).tolist()
    [-0.01]
    """
    loads = _balanced(system, torques, hold)
    carrying = _carrying(system)
    weights = system.connections.weights[carrying]
    shares, _, rank, _ = np.linalg.lstsq(weights.T, loads.T, rcond=None)
    if rank == len(weights):
        residual = np.abs(weights.T @ shares - loads.T).max(initial=0.0)
        if residual > 1e-9 * np.abs(loads).max(initial=1.0):
            raise ModelError("no spring carries the mean torque to the node that takes it up", where=hold)
        torque = np.zeros((len(loads), carrying.size))
        torque[:, carrying] = shares.T
        angle = np.array([_angles(system, i, torque[:, i]) for i in range(carrying.size)]).T
    else:
        found = [_newton(system, load) for load in loads]
        angle = np.array([system.connections.weights @ q for q in found])
        torque = np.array([_forces(system, a)[0] for a in angle])
    shape = np.broadcast_shapes(*(np.shape(value) for value in torques.values()))
    stiffness = np.array([_forces(system, a)[1] for a in angle])
    names = system.connections.names
    torque, angle, stiffness = (v.reshape(*shape, carrying.size) for v in (torque, angle, stiffness))
    return OperatingPoint(names, torque, angle, stiffness, system.connections.laws)


def linearize(system: System, point: OperatingPoint) -> System:
    """The same system with each law replaced by its tangent at one operating point.

    Raises ModelError for a point of several operating points (pick one with its ``at``).
    """
    if point.names != system.connections.names:
        raise ModelError("the operating point belongs to another system", found=", ".join(point.names[:8]))
    stiffness = np.where(
        [law is None for law in system.connections.laws], system.connections.stiffness, point.stiffness
    )
    none: tuple[Law | None, ...] = (None,) * len(point.names)
    connections = dataclasses.replace(system.connections, stiffness=stiffness, laws=none)
    return dataclasses.replace(system, connections=connections)


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


def _angles(system: System, index: int, torque: Array) -> Array:
    c = system.connections
    law = c.laws[index]
    if law is None:
        return np.asarray(torque / c.stiffness[index]) if c.stiffness[index] > 0 else np.zeros_like(torque)
    try:
        return law.angle(torque) if isinstance(law, Hinges) else _inverted(law, torque)
    except ModelError as error:
        raise error.located(prefix=c.names[index]) from None


def _inverted(law: Law, torque: Array) -> Array:
    """The angle of a smooth rising law, by Newton's method."""
    angle = np.zeros_like(torque)
    for _ in range(ITERATIONS):
        force, slope = law.evaluate(angle)[:2]
        step = (torque - force) / slope
        angle = angle + step
        if np.all(np.abs(step) <= 1e-14 * (1 + np.abs(angle))):
            return angle
    raise ModelError("no angle found that carries the mean torque", found=f"{np.ravel(torque)[0]:g} Nm")


def _forces(system: System, angle: Array) -> tuple[Array, Array]:
    """Torque and tangent stiffness of every connection at its angle."""
    c = system.connections
    torque, tangent = c.stiffness * angle, c.stiffness.copy()
    for i, law in enumerate(c.laws):
        if law is not None:
            force, slope = law.evaluate(angle[i])[:2]
            torque[i], tangent[i] = torque[i] + force, tangent[i] + slope
    return torque, tangent


def _newton(system: System, load: Array) -> Array:
    """Coordinates in equilibrium where springs act side by side; rigid rotation is left out by least squares.

    Rising laws have a convex potential: Newton's direction with an exact search along it finds its lowest place.
    """
    weights = system.connections.weights
    q, scale = np.zeros(weights.shape[1]), max(float(np.abs(load).max()), 1.0)
    for _ in range(ITERATIONS):
        angle = weights @ q
        torque, tangent = _forces(system, angle)
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
