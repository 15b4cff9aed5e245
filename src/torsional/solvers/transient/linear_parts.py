"""Lines of linear parts, hinges and contacts alone: what event by event integration and complementarity can judge."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.contacts.step import OneSided
from torsional.numerics.linear.sparse_factor import PlaceArray
from torsional.numerics.motion.data import CENTRIFUGAL, DAMPER, MEAN_RATE, SPRING
from torsional.numerics.stepping.plan import dense, mass_matrix
from torsional.solvers.transient.problem import Problem


class Parts(NamedTuple):
    """M, C, K (N, N) of what is linear, the one-sided springs ``walls`` with the connection ``of`` and the ``side`` of
    each, and the rows w (E, N), stiffness and damping (E,) of the connections."""

    mass: Array
    damping: Array
    stiffness: Array
    walls: OneSided
    of: PlaceArray
    side: Array
    rows: Array
    springs: Array
    dampers: Array

    def torques(self, q: Array, v: Array) -> Array:
        """k φ + c φ̇ and hinges, of every connection (T, E) [Nm], at coordinates and rates (T, N)."""
        torque = (q @ self.rows.T) * self.springs + (v @ self.rows.T) * self.dampers
        np.add.at(torque.T, self.of, (self.side * self.forces(q, v)).T)
        return np.asarray(torque)

    def forces(self, q: Array, v: Array) -> Array:
        """λ (T, H), negative where a stage ends, its stiffness being so."""
        w, walls = self.walls.directions, self.walls
        opening = walls.gap + q @ w + walls.contact_time * (v @ w)
        return np.asarray(np.maximum(0.0, -opening) * walls.stiffness)


def parts_of(problem: Problem, what: str) -> Parts:
    """The parts of a line for ``what`` wants them; raises ModelError that names what is neither linear nor such."""
    c, n = problem.equations.connected, problem.equations.coordinates
    names = problem.system.connections.names
    for wrong, why in (
        (c.laws.of, "is a law that is no sum of hinges and contacts"),
        (np.flatnonzero(c.constants[CENTRIFUGAL]), "is stiffened by centrifugal forces"),
        (np.flatnonzero(c.constants[MEAN_RATE]), "counts from the whole speed"),
    ):
        if wrong.size:
            raise ModelError(f"{what} knows linear parts, hinges and contacts; this {why}", where=names[wrong[0]])
    if problem.equations.driven.pendulums.size:
        raise ModelError(f"{what} knows no pendulums", where="pendulum")
    w, mass = dense(c.rows, n), mass_matrix(problem.equations)
    if np.linalg.matrix_rank(mass, hermitian=True) < n:
        raise ModelError(f"{what} needs a mass at every coordinate", remedy="condense massless ones first")
    of, (gap, side, change, time) = c.hinges
    walls = OneSided(-(w[of] * side[:, None]).T, side * gap, change, time)
    springs, dampers = c.constants[SPRING], c.constants[DAMPER]
    return Parts(mass, (w.T * dampers) @ w, (w.T * springs) @ w, walls, of, side, w, springs, dampers)
