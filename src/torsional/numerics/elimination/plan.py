"""Linear response by elimination in row-sum form: one plan a topology, any number of designs and frequencies.

    Z(ω, Ω) x = b,   Z = Σ_e (k_e (1 + iη_e) + Ω² s_e + iω c_e) w_e w_eᵀ − ω² Σ_m J_m v_m v_mᵀ

Couplings a_ij = −Z_ij and row sums e_i = Σ_j Z_ij are kept instead of diagonals.  Taking out node i,

    s = e_i + Σ_j a_ij;  t_j = a_ij / s;  e_j += t_j e_i;  b_j += t_j b_i;  a_jk += t_j a_ik

adds stiffnesses but never subtracts them, as Grassmann, Taksar and Heyman did with probabilities, Oper. Res. 33 (1985)
1107, doi:10.1287/opre.33.5.1107: 1e9 Nm/rad beside 10 Nm/rad lose no digits to each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.elimination.job import Response, Status, Weights, checked, like, prepared, solved
from torsional.numerics.elimination.order import supports
from torsional.numerics.elimination.route import Route, build_route
from torsional.numerics.elimination.tape import Tape, build_tape

__all__ = ["EliminationPlan", "Response", "Status"]


@dataclass(frozen=True, slots=True, eq=False)
class EliminationPlan:
    """The symbolic elimination of one topology, with the weights it was built for.

    Two discs on a shaft, a unit torque on the first:

    >>> plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    >>> x, status = plan.solve([100.0], None, None, None, [1.0, 1.0], [1.0], 0.0, [0], [[[1.0]]])
    >>> x[0, 0, 0].real.round(6), Status(status[0, 0]).name
    (array([-0.497487, -0.502513]), 'OK')
    """

    tape: Tape
    weights: Weights

    @classmethod
    def build(
        cls, connection_weights: ArrayLike, mass_weights: ArrayLike, keep_last: Sequence[int] = ()
    ) -> EliminationPlan:
        """Plan for weights (connections, n) and (masses, n) [-].

        Coordinates are best scaled so that a rigid rotation is all ones: the weights of a connection then add up to
        zero.  Which of them are not zero is all that matters to the order of elimination.  Nodes of ``keep_last`` are
        taken out last: a system that is loaded, or of interest, at few nodes costs least so.

        Raises ``ModelError`` where the tables do not fit together.
        """
        connection, mass = (np.array(w, dtype=float, order="C") for w in (connection_weights, mass_weights))
        if connection.ndim != 2 or mass.ndim != 2 or connection.shape[1] != mass.shape[1]:
            raise ModelError(
                "weights must be two tables with one column for each node", found=f"{connection.shape} and {mass.shape}"
            )
        patterns = (connection != 0.0).tobytes(), (mass != 0.0).tobytes()
        tape = _cached_tape(*patterns, connection.shape[1], tuple(int(i) for i in keep_last))
        return cls(tape, prepared(tape, connection[None], mass[None]))

    @property
    def nodes(self) -> int:
        """Number of coordinates n."""
        return len(self.tape.removals)

    def solve(
        self,
        stiffness: ArrayLike,
        loss: ArrayLike | None,
        damping: ArrayLike | None,
        centrifugal: ArrayLike | None,
        inertia: ArrayLike,
        omega: ArrayLike,
        speed: ArrayLike,
        load_nodes: Sequence[int],
        loads: ArrayLike,
        outputs: Sequence[int] | None = None,
        *,
        connection_weights: ArrayLike | None = None,
        mass_weights: ArrayLike | None = None,
    ) -> Response:
        """Response x to loads b at angular frequencies ``omega`` ω [rad/s] and mean ``speed`` Ω [rad/s].

        ``stiffness`` k [Nm/rad], ``loss`` η [-], ``damping`` c [Nms/rad] and ``centrifugal`` s [Nms²/rad] have one
        value a connection, ``inertia`` J [kgm²] one a mass: of one design, or a row for each.  ``loads`` [Nm] are
        complex, (frequencies, right-hand sides, load nodes), with a leading axis where they differ by design; an axis
        of frequencies of length one serves them all.  Weights that differ by design are (designs, connections or
        masses, n), and zero where the plan's are.  ``outputs`` are the wanted nodes, all by default.  In memory the
        frequencies of x are innermost.  A case has the same bits whichever cases are solved beside it.

        Raises ``ModelError`` where shapes do not fit together.
        """
        job = checked(
            self._weighted(connection_weights, mass_weights),
            (stiffness, loss, damping, centrifugal, inertia),
            (omega, speed),
            loads,
        )
        wanted = tuple(range(self.nodes)) if outputs is None else tuple(outputs)
        if len(load_nodes) != job.loads.shape[3] or len(set(load_nodes)) != len(load_nodes):
            raise ModelError("each loaded node needs one column of loads", where="loads", found=str(job.loads.shape))
        return solved(self.tape, _cached_route(self.tape, tuple(load_nodes), wanted), job, tuple(load_nodes), wanted)

    def receptance(
        self,
        stiffness: ArrayLike,
        loss: ArrayLike | None,
        damping: ArrayLike | None,
        centrifugal: ArrayLike | None,
        inertia: ArrayLike,
        omega: ArrayLike,
        speed: ArrayLike,
        inputs: Sequence[int],
        outputs: Sequence[int] | None = None,
        *,
        connection_weights: ArrayLike | None = None,
        mass_weights: ArrayLike | None = None,
    ) -> Response:
        """Receptances G (designs, frequencies, outputs, inputs) [rad/Nm]: the response to a unit load at each input."""
        x, status = self.solve(
            stiffness, loss, damping, centrifugal, inertia, omega, speed, inputs, np.eye(len(inputs))[None], outputs,
            connection_weights=connection_weights, mass_weights=mass_weights,
        )  # fmt: skip
        return Response(x.transpose(0, 1, 3, 2), status)

    def _weighted(self, connection: ArrayLike | None, mass: ArrayLike | None) -> Weights:
        """The plan's weights, or the given ones."""
        if connection is None and mass is None:
            return self.weights
        own = self.weights
        tables = [
            given if table is None else like(np.asarray(table, dtype=float), given)
            for table, given in ((connection, own.connection), (mass, own.mass))
        ]
        return prepared(self.tape, tables[0], tables[1])


@lru_cache(maxsize=256)
def _cached_tape(connections: bytes, masses: bytes, n: int, keep_last: tuple[int, ...]) -> Tape:
    connection, mass = (supports(np.frombuffer(p, dtype=bool).reshape(-1, n)) for p in (connections, masses))
    return build_tape(connection, mass, n, keep_last)


@lru_cache(maxsize=256)
def _cached_route(tape: Tape, loaded: tuple[int, ...], outputs: tuple[int, ...]) -> Route:
    return build_route(tape, loaded, outputs)
