"""From points of branches to what every node and connection does there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.forces import forces_along
from torsional.numerics.elimination.plan import EliminationPlan
from torsional.solvers.harmonic import element_torques, node_angles
from torsional.solvers.periodic.problem import HarmonicProblem


@dataclass(frozen=True, eq=False)
class States:
    """Complex 0-peak harmonics of points: ``angle`` (points, H + 1, nodes) [rad], ``twist`` and ``torque`` (points,
    H + 1, connections) [rad], [Nm], ``coordinates`` (points, H + 1, N) [rad]; harmonic 0 is the mean, with the node
    that takes up the mean torque at rest."""

    angle: ComplexArray
    twist: ComplexArray
    torque: ComplexArray
    coordinates: ComplexArray


def _law_forces(problem: HarmonicProblem, points: Array) -> ComplexArray:
    """Harmonics (points, m, H + 1) of the laws' torques [Nm] at scaled points."""
    forces = np.empty((len(points), problem.connections, problem.harmonics + 1), dtype=complex)
    places = np.empty((len(points), problem.connections, 0, 3))
    forces_along(problem.balance, points, forces, places, np.empty((len(points), problem.connections)))
    return forces


def states(problem: HarmonicProblem, points: Array) -> States:
    """Everything that moves at scaled points (points, n + 1), from the linear part with the laws' torques as loads."""
    found = [_states(piece, points[run]) for run, piece in problem.pieces(points)]
    return States(
        *(
            np.concatenate(parts)
            for parts in zip(*((s.angle, s.twist, s.torque, s.coordinates) for s in found), strict=True)
        )
    )


def _states(problem: HarmonicProblem, points: Array) -> States:
    setting, split = problem.setting, problem.setting.split
    count = problem.harmonics
    value = points[:, -1] * problem.scale[-1]
    speed = value if setting.speed is None else np.full(len(points), setting.speed)
    harmonics, force = problem.harmonics_of(points), _law_forces(problem, points)
    omega = np.multiply.outer(speed, problem.base_order * np.arange(count + 1))
    reference = split.reference_stiffness[:, None] + 1j * omega[:, None] * split.reference_damping[:, None]
    loads = driving(problem, value) - np.einsum("pmh,mn->phn", force - reference * harmonics, split.weights)
    q = np.empty(loads.shape, dtype=complex)
    q[:, 0] = _mean(problem, loads[:, 0].real)
    q[:, 1:] = _vibration(problem, omega[:, 1:], speed, loads[:, 1:])
    flat, turning = q.reshape(-1, q.shape[-1]), np.repeat(speed, count + 1)
    torque = element_torques(split.system, omega.ravel(), turning, flat).reshape(*q.shape[:2], -1)
    torque[..., list(split.places)] += np.moveaxis(force, 1, 2)
    angle = node_angles(split.system, flat).reshape(*q.shape[:2], -1)
    twist = np.asarray(q @ split.system.connections.weights.T, dtype=complex)
    return States(angle, twist, torque, q)


def driving(problem: HarmonicProblem, value: Array) -> ComplexArray:
    """Torques of the load on the coordinates (points, H + 1, N), the reaction to the mean included."""
    setting = problem.setting
    system, load = setting.split.system, setting.load
    onto = np.array([system.T[system.node_index(node)] for node in load.nodes])
    orders = problem.base_order * np.arange(problem.harmonics + 1)
    at = load.at(value)
    picked = np.zeros((len(value), len(orders), len(load.nodes)), dtype=complex)
    for h, n in enumerate(orders):
        same = np.flatnonzero(np.abs(load.orders - n) < 1e-9)
        if same.size:
            picked[:, h] = at[:, :, same[0]]
    out = picked @ onto
    if picked[:, 0].any():
        out[:, 0] = picked[:, 0] @ setting.split.balanced(onto, setting.hold)
    return np.asarray(out)


def _mean(problem: HarmonicProblem, loads: Array) -> Array:
    """Mean deviation (points, N), the node that takes up the mean torque at rest."""
    split, hold = problem.setting.split, problem.setting.hold
    q = split.deflection(loads)
    if split.rigid.size and hold:
        held = split.system.T[split.system.node_index(hold)]
        along = held @ split.rigid
        q = q - np.outer(q @ held, along / (along @ along)) @ split.rigid.T
    return np.asarray(q)


def _vibration(problem: HarmonicProblem, omega: Array, speed: Array, loads: ComplexArray) -> ComplexArray:
    """Coordinates (points, H, N) from the linear part with the references in it."""
    split = problem.setting.split
    c, m = split.system.connections, split.system.switched(split.speed).masses
    stiffness, damping = c.stiffness.copy(), c.damping.copy()
    stiffness[list(split.places)] += split.reference_stiffness
    damping[list(split.places)] += split.reference_damping
    plan = EliminationPlan.build(c.weights, m.weights)
    found = plan.solve(
        stiffness,
        c.loss_factor,
        damping,
        c.centrifugal_stiffness,
        m.inertia,
        omega.ravel(),
        np.repeat(speed, omega.shape[1]),
        range(loads.shape[-1]),
        loads.reshape(omega.size, 1, -1),
        connection_weights=c.weights,
        mass_weights=m.weights,
    )
    return np.asarray(found.x[0, :, 0].reshape(loads.shape))
