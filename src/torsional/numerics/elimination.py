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
from enum import IntEnum
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from torsional.errors import ModelError
from torsional.numerics import elimination_kernel as kernel
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.dense_fallback import redo
from torsional.numerics.elimination_order import supports
from torsional.numerics.elimination_route import Route, build_route
from torsional.numerics.elimination_tape import Tape, build_tape

_BATCH_FLOATS = 500_000  # coefficients of a batch of designs, few enough to stay in the cache


class Status(IntEnum):
    """How a case was solved."""

    OK = 0
    FALLBACK = 1  # the elimination's pivots were not to be trusted: solved densely, in twice the precision
    SINGULAR = 2  # undamped at resonance, free to turn at zero frequency, or values that are not finite: x is NaN


class Response(NamedTuple):
    """``x`` (designs, frequencies, right-hand sides, outputs) and ``status`` (designs, frequencies)."""

    x: ComplexArray
    status: NDArray[np.int8]


class _Weights(NamedTuple):
    """Weights and what the kernel makes of them, with one row a design or one for all."""

    connection: Array  # (designs, connections, n)
    mass: Array  # (designs, masses, n)
    connection_shares: Array
    mass_shares: Array
    rows: Array


class _Job(NamedTuple):
    """Arrays of one call, checked and contiguous."""

    values: tuple[Array, Array, Array, Array, Array]
    weights: _Weights
    frequencies: tuple[Array, Array]
    loads: ComplexArray  # (designs or 1, frequencies or 1, right-hand sides, nodes)
    designs: int


@dataclass(frozen=True, slots=True, eq=False)
class EliminationPlan:
    """The symbolic elimination of one topology, with the weights it was built for.

    Two discs on a shaft, a unit torque on the first:

    >>> plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    >>> x, status = plan.solve([100.0], None, None, None, [1.0, 1.0], [1.0], 0.0, [0], [[[1.0]]])
    >>> x[0, 0, 0].real.round(6), Status(status[0, 0]).name
    (array([-0.497475, -0.502525]), 'OK')
    """

    tape: Tape
    weights: _Weights

    @classmethod
    def build(
        cls, connection_weights: ArrayLike, mass_weights: ArrayLike, keep_last: Sequence[int] = ()
    ) -> EliminationPlan:
        """Plan for weights (connections, n) and (masses, n) [-], coordinates scaled so that a rigid rotation is all ones.

        Only which weights are not zero matters to the plan.  Nodes of ``keep_last`` are taken out last: a system that
        is loaded, or of interest, at few nodes costs least so.

        Raises ``ModelError`` where the tables do not fit together.
        """
        connection, mass = (np.array(w, dtype=float, order="C") for w in (connection_weights, mass_weights))
        if connection.ndim != 2 or mass.ndim != 2 or connection.shape[1] != mass.shape[1]:
            raise ModelError(
                "weights must be two tables with one column for each node", found=f"{connection.shape} and {mass.shape}"
            )
        patterns = (connection != 0.0).tobytes(), (mass != 0.0).tobytes()
        tape = _cached_tape(*patterns, connection.shape[1], tuple(int(i) for i in keep_last))
        return cls(tape, _weights(tape, connection[None], mass[None]))

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

        ``stiffness`` k [Nm/rad], ``loss`` η [-], ``damping`` c [Nms/rad] and ``centrifugal`` s [Nms²/rad] have one value a
        connection, ``inertia`` J [kgm²] one a mass: of one design, or a row for each.  ``loads`` [Nm] are complex,
        (frequencies, right-hand sides, load nodes), with a leading axis where they differ by design; an axis of
        frequencies of length one serves them all.  Weights that differ by design are (designs, connections or masses,
        n), and zero where the plan's are.  ``outputs`` are the wanted nodes, all by default.  In memory the frequencies
        of x are innermost.  A case has the same bits whichever cases are solved beside it.

        Raises ``ModelError`` where shapes do not fit together.
        """
        job = _job(
            self._weighted(connection_weights, mass_weights),
            (stiffness, loss, damping, centrifugal, inertia),
            (omega, speed),
            loads,
        )
        wanted = tuple(range(self.nodes)) if outputs is None else tuple(outputs)
        if len(load_nodes) != job.loads.shape[3] or len(set(load_nodes)) != len(load_nodes):
            raise ModelError("each loaded node needs one column of loads", where="loads", found=str(job.loads.shape))
        return _solved(self.tape, job, tuple(load_nodes), wanted)

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

    def _weighted(self, connection: ArrayLike | None, mass: ArrayLike | None) -> _Weights:
        """The plan's weights, or the given ones."""
        if connection is None and mass is None:
            return self.weights
        own = self.weights
        tables = [
            given if table is None else _like(np.asarray(table, dtype=float), given)
            for table, given in ((connection, own.connection), (mass, own.mass))
        ]
        return _weights(self.tape, tables[0], tables[1])


def _like(table: Array, given: Array) -> Array:
    """Weights with an axis of designs that are zero where the plan's are."""
    table = np.ascontiguousarray(table if table.ndim == 3 else table[None])
    if table.shape[1:] != given.shape[1:]:
        raise ModelError("weights must have the shape of the plan's", found=str(table.shape), allowed=str(given.shape))
    if np.any(table[:, given[0] == 0.0]):
        raise ModelError("a weight that is zero in the plan cannot differ from zero", remedy="build another plan")
    return table


@lru_cache(maxsize=256)
def _cached_tape(connections: bytes, masses: bytes, n: int, keep_last: tuple[int, ...]) -> Tape:
    patterns = (np.frombuffer(pattern, dtype=bool).reshape(-1, n) for pattern in (connections, masses))
    return build_tape(*(supports(pattern) for pattern in patterns), n, keep_last)


@lru_cache(maxsize=256)
def _cached_route(tape: Tape, loaded: tuple[int, ...], outputs: tuple[int, ...]) -> Route:
    return build_route(tape, loaded, outputs)


def _weights(tape: Tape, connection: Array, mass: Array) -> _Weights:
    return _Weights(
        connection,
        mass,
        kernel.coefficients(connection, tape.connection_terms),
        kernel.coefficients(mass, tape.mass_terms),
        kernel.weights_of_rows(connection, tape.weight_rows),
    )


def _table(values: ArrayLike | None, size: int, name: str) -> Array:
    """One row for each design; zeros where nothing is given."""
    if values is None:
        return np.zeros((1, size))
    table = np.ascontiguousarray(values, dtype=float)
    table = table if table.ndim == 2 else table[None]
    if table.ndim != 2 or table.shape[1] != size:
        raise ModelError("one value for each factor is needed", where=name, found=str(table.shape), allowed=str(size))
    return table


def _job(
    weights: _Weights, values: tuple[ArrayLike | None, ...], frequencies: tuple[ArrayLike, ArrayLike], loads: ArrayLike
) -> _Job:
    """Check the shapes of all arrays against each other."""
    connections, masses = weights.connection.shape[1], weights.mass.shape[1]
    names = ("stiffness", "loss", "damping", "centrifugal", "inertia")
    sizes = (connections,) * 4 + (masses,)
    k, h, c, s, J = (_table(v, size, name) for v, size, name in zip(values, sizes, names, strict=True))
    omega = np.ascontiguousarray(np.atleast_1d(frequencies[0]), dtype=float)
    speed = np.ascontiguousarray(np.broadcast_to(frequencies[1], omega.shape), dtype=float)
    b = np.ascontiguousarray(loads, dtype=complex)
    b = b if b.ndim == 4 else b[None]
    if omega.ndim != 1 or b.ndim != 4 or b.shape[1] not in (1, omega.size):
        raise ModelError(
            "loads must be (frequencies, right-hand sides, nodes)", where="loads", found=str(b.shape), allowed=str(omega.size)
        )
    counts = {table.shape[0] for table in (k, h, c, s, J, weights.connection, weights.mass, b)} - {1}
    if len(counts) > 1:
        raise ModelError("all arrays must agree on the number of designs", found=str(sorted(counts)))
    return _Job((k, h, c, s, J), weights, (omega, speed), b, max(counts, default=1))


def _solved(tape: Tape, job: _Job, loaded: tuple[int, ...], outputs: tuple[int, ...]) -> Response:
    """Run the kernel over batches of designs, then redo what it flagged."""
    route, rights, frequencies = _cached_route(tape, loaded, outputs), job.loads.shape[2], job.frequencies[0].size
    x = np.empty((job.designs, rights, len(outputs), frequencies), dtype=complex)
    flagged = np.zeros((job.designs, frequencies), dtype=bool)
    batch = max(1, _BATCH_FLOATS // (5 * tape.slot_row.size))
    count = 0
    for first in range(0, job.designs, batch):
        part = slice(first, first + batch)
        count += _run(tape, route, _part(job, part, min(batch, job.designs - first)), x[part], flagged[part])
    status = flagged.astype(np.int8)
    if count:
        _redo(job, np.array(loaded), np.array(outputs), x, status)
    return Response(x.transpose(0, 3, 1, 2), status)


def _part(job: _Job, part: slice, designs: int) -> _Job:
    """The job of some of the designs."""
    if designs == job.designs:
        return job
    k, h, c, s, J = (table if table.shape[0] == 1 else table[part] for table in job.values)
    weights = _Weights(*(table if table.shape[0] == 1 else table[part] for table in job.weights))
    loads = job.loads if job.loads.shape[0] == 1 else job.loads[part]
    return _Job((k, h, c, s, J), weights, job.frequencies, loads, designs)


def _run(tape: Tape, route: Route, job: _Job, x: ComplexArray, flagged: NDArray[np.bool_]) -> int:
    """Gather the coefficients of all designs and run the kernel; how many cases it flagged."""
    slots = np.zeros((job.designs, tape.slot_row.size, 5))
    kernel.gather_connections(slots, tape.connection_terms, job.weights.connection_shares, job.values[:4])
    kernel.gather_masses(slots, tape.mass_terms, job.weights.mass_shares, job.values[4])
    strides = tuple(0 if size == 1 else step // 8 for size, step in zip(job.loads.shape[:2], job.loads.strides, strict=False))
    count: int = kernel.respond(
        (tape.slot_row, tape.weight_rows, tape.program),
        (route.loads, route.outputs, route.forward, route.backward, route.fused, route.fused_backward),
        (len(tape.removals), tape.layout.size, job.loads.shape[2]),
        slots,
        job.weights.rows,
        job.frequencies,
        job.loads.reshape(-1).view(float),
        (*strides, 2 * job.loads.shape[3]),
        x.reshape(-1).view(float),
        flagged.reshape(-1),
    )
    return count


def _redo(job: _Job, loaded: NDArray[np.int64], outputs: NDArray[np.int64], x: ComplexArray, status: NDArray[np.int8]) -> None:
    """Solve the flagged cases densely."""
    cases = np.flatnonzero(status)
    sound = np.zeros(cases.size, dtype=bool)
    weights = job.weights.connection, job.weights.mass
    redo(cases, job.values, weights, job.frequencies, loaded, job.loads, outputs, x, sound)
    status.reshape(-1)[cases] = np.where(sound, Status.FALLBACK, Status.SINGULAR)
