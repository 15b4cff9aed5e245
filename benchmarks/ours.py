"""This project at the same work."""

from __future__ import annotations

from collections.abc import Callable

import chain15
import numpy as np
from ledger import Floor


def powertrain():
    """Chain15 as a user writes it."""
    from torsional import Damper, Inertia, Powertrain, Shaft

    parts = {name: Inertia(float(J)) for name, J in zip(chain15.NODES, chain15.INERTIA, strict=True)}
    for i, (a, b) in enumerate(zip(chain15.NODES, chain15.NODES[1:], strict=False)):
        parts[f"shaft_{i}"] = Shaft(a, b, float(chain15.STIFFNESS[i]), float(chain15.DAMPING[i]))
    for node, damping in zip(chain15.NODES, chain15.GROUND_DAMPING, strict=True):
        if damping:
            parts[f"bearing_{node}"] = Damper(node, damping=float(damping))
    return Powertrain(parts)


def excitation():
    """The firing torques at all speeds."""
    from torsional import Excitation

    throws = chain15.torque()[chain15.THROWS]
    loads = np.broadcast_to(throws, (chain15.RPM.size, *throws.shape))
    return Excitation([chain15.NODES[i] for i in chain15.THROWS], chain15.ORDERS, chain15.RPM * np.pi / 30.0, loads)


def public_response() -> Callable[[], tuple[np.ndarray, np.ndarray]]:
    """`harmonic_response` with its dataset, the system assembled beforehand."""
    from torsional import assemble, harmonic_response

    system, loads = assemble(powertrain()), excitation()
    shafts = slice(0, chain15.STIFFNESS.size)  # the bearings come behind
    assert system.nodes == chain15.NODES and system.connections.names[shafts][-1] == f"shaft_{shafts.stop - 1}"

    def respond():
        result = harmonic_response(system, loads)
        return result.angle.values, result.torque.values[..., shafts]

    return respond


def kernel_response() -> Callable[[], tuple[np.ndarray]]:
    """The angles alone, by the elimination's own call: arrays in and out, the plan made beforehand."""
    from torsional.numerics.elimination.plan import EliminationPlan

    nodes, difference = chain15.INERTIA.size, chain15.matrices().difference
    grounded = np.flatnonzero(chain15.GROUND_DAMPING)
    stiffness = np.concatenate([chain15.STIFFNESS, np.zeros(grounded.size)])
    damping = np.concatenate([chain15.DAMPING, chain15.GROUND_DAMPING[grounded]])
    omega, speed = chain15.frequencies().ravel(), np.repeat(chain15.RPM * np.pi / 30.0, chain15.ORDERS.size)
    loads = np.tile(chain15.torque()[chain15.THROWS], chain15.RPM.size).T[:, None, :]
    plan = EliminationPlan.build(np.vstack([difference, np.eye(nodes)[grounded]]), np.eye(nodes))
    shape = (chain15.RPM.size, chain15.ORDERS.size, nodes)

    def respond():
        x, _ = plan.solve(stiffness, None, damping, None, chain15.INERTIA, omega, speed, chain15.THROWS, loads)
        return (x[0, :, 0].reshape(shape),)

    return respond


def response_floor(nodes: int = 15) -> Floor:
    """Real operations and bytes of one solve of a chain: what no program can leave out.

    Values: k + iωc and −ω²J + iωc, 3 a node.  Elimination of a node: pivot 2, reciprocal 7, transfer 6, row sum 8, load
    8; back substitution 14.  Torque of a shaft: 8.  Angles and torques are written once, complex.
    """
    per_node = 3 + 2 + 7 + 6 + 8 + 8 + 14
    return Floor(flops=per_node * nodes + 8 * (nodes - 1), bytes=16 * (2 * nodes - 1))


def modes(inertia: np.ndarray, stiffness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues and vectors of many designs by one call of the kernel."""
    from torsional.numerics.modes.undamped import modes

    difference = chain15.matrices().difference
    omega, shapes = modes(difference, stiffness, np.eye(inertia.shape[1]), inertia)
    return omega**2, shapes
