"""One call of the elimination: its arrays checked against each other, and the kernel run over them."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray, IntArray, StatusArray
from torsional.numerics.elimination import assembly
from torsional.numerics.elimination.dense_fallback import factor_values, solve_dense
from torsional.numerics.elimination.kernel import respond
from torsional.numerics.elimination.route import Route
from torsional.numerics.elimination.tape import Tape

_T = TypeVar("_T", bound=np.generic)
_BATCH_FLOATS = 100_000  # coefficients of a batch of designs, few enough to stay in the cache


class Status(IntEnum):
    """How a case was solved."""

    OK = 0
    FALLBACK = 1  # the elimination's pivots were not to be trusted: solved densely, in twice the precision
    SINGULAR = 2  # undamped at resonance, free to turn at zero frequency, or values that are not finite: x is NaN


class Response(NamedTuple):
    """``x`` (designs, frequencies, right-hand sides, outputs) and ``status`` (designs, frequencies)."""

    x: ComplexArray
    status: StatusArray


class Weights(NamedTuple):
    """Weights and what the kernel makes of them, with one row a design or one for all."""

    connection: Array  # (designs, connections, n)
    mass: Array  # (designs, masses, n)
    connection_shares: Array
    mass_shares: Array
    rows: Array


class Job(NamedTuple):
    """Arrays of one call, checked and contiguous."""

    values: tuple[Array, Array, Array, Array, Array]
    weights: Weights
    frequencies: tuple[Array, Array]
    loads: ComplexArray  # (designs or 1, frequencies or 1, right-hand sides, nodes)
    designs: int
    rest: Array  # (slots, 3, frequencies) that all designs have in common, or none


def like(table: Array, given: Array) -> Array:
    """Weights with an axis of designs that are zero where the plan's are."""
    table = np.ascontiguousarray(table if table.ndim == 3 else table[None])
    if table.shape[1:] != given.shape[1:]:
        raise ModelError("weights must have the shape of the plan's", found=str(table.shape), allowed=str(given.shape))
    if np.any(table[:, given[0] == 0.0]):
        raise ModelError("a weight that is zero in the plan cannot differ from zero", remedy="build another plan")
    return table


def prepared(tape: Tape, connection: Array, mass: Array) -> Weights:
    """Weights (designs, factors, n) and their products for each slot."""
    connection, mass = _frozen(connection), _frozen(mass)
    return Weights(
        connection,
        mass,
        assembly.coefficients(connection, tape.connection_terms),
        assembly.coefficients(mass, tape.mass_terms),
        assembly.weights_of_rows(connection, tape.weight_rows),
    )


def _frozen(array: NDArray[_T]) -> NDArray[_T]:
    """A contiguous view that cannot be written to: numba compiles anew for each mixture of frozen and open arrays."""
    view = np.ascontiguousarray(array).view()
    view.flags.writeable = False
    return view


def _table(values: ArrayLike | None, size: int, name: str) -> Array:
    """One row for each design; zeros where nothing is given."""
    if values is None:
        return _frozen(np.zeros((1, size)))
    table = np.asarray(values, dtype=float)
    table = _frozen(table if table.ndim == 2 else table[None])
    if table.ndim != 2 or table.shape[1] != size:
        raise ModelError("one value for each factor is needed", where=name, found=str(table.shape), allowed=str(size))
    return table


def checked(
    weights: Weights,
    values: tuple[ArrayLike | None, ...],
    frequencies: tuple[ArrayLike, ArrayLike],
    loads: ArrayLike,
    rest: Array | None = None,
) -> Job:
    """Check the shapes of all arrays against each other."""
    connections, masses = weights.connection.shape[1], weights.mass.shape[1]
    names = ("stiffness", "loss", "damping", "centrifugal", "inertia")
    sizes = (connections,) * 4 + (masses,)
    k, h, c, s, J = (_table(v, size, name) for v, size, name in zip(values, sizes, names, strict=True))
    omega = _frozen(np.atleast_1d(np.asarray(frequencies[0], dtype=float)))
    speed = _frozen(np.broadcast_to(np.asarray(frequencies[1], dtype=float), omega.shape))
    b = np.asarray(loads, dtype=complex)
    b = _frozen(b if b.ndim == 4 else b[None])
    if omega.ndim != 1 or b.ndim != 4 or b.shape[1] not in (1, omega.size):
        raise ModelError("loads must be (frequencies, right-hand sides, nodes)", where="loads", found=str(b.shape))
    counts = {table.shape[0] for table in (k, h, c, s, J, weights.connection, weights.mass, b)} - {1}
    if len(counts) > 1:
        raise ModelError("all arrays must agree on the number of designs", found=str(sorted(counts)))
    common = _frozen(np.zeros((0, 3, 1)) if rest is None else rest)
    return Job((k, h, c, s, J), weights, (omega, speed), b, max(counts, default=1), common)


def solved(tape: Tape, route: Route, job: Job, loaded: tuple[int, ...], outputs: tuple[int, ...]) -> Response:
    """Run the kernel, then redo what it flagged."""
    x, flagged, count = eliminated(tape, route, job, len(outputs))
    status = flagged.astype(np.int8)
    if count:
        _redo(job, np.array(loaded), np.array(outputs), x, status)
    return Response(x.transpose(0, 3, 1, 2), status)


def eliminated(tape: Tape, route: Route, job: Job, outputs: int) -> tuple[ComplexArray, NDArray[np.bool_], int]:
    """Run the kernel over batches of designs: x (designs, right-hand sides, outputs, frequencies), which cases it
    flagged (designs, frequencies), and how many."""
    rights, frequencies = job.loads.shape[2], job.frequencies[0].size
    x = np.empty((job.designs, rights, outputs, frequencies), dtype=complex)
    flagged = np.zeros((job.designs, frequencies), dtype=bool)
    batch = max(1, _BATCH_FLOATS // (5 * tape.slot_row.size))
    count = 0
    for first in range(0, job.designs, batch):
        part = slice(first, first + batch)
        count += _run(tape, route, part_of(job, part), x[part], flagged[part])
    return x, flagged, count


def part_of(job: Job, part: slice) -> Job:
    """The job of some of the designs."""
    designs = len(range(*part.indices(job.designs)))
    if designs == job.designs:
        return job
    k, h, c, s, J = (table if table.shape[0] == 1 else table[part] for table in job.values)
    weights = Weights(*(table if table.shape[0] == 1 else table[part] for table in job.weights))
    loads = job.loads if job.loads.shape[0] == 1 else job.loads[part]
    return Job((k, h, c, s, J), weights, job.frequencies, loads, designs, job.rest)


def _run(tape: Tape, route: Route, job: Job, x: ComplexArray, flagged: NDArray[np.bool_]) -> int:
    """Gather the coefficients of all designs and run the kernel; how many cases it flagged."""
    slots = np.zeros((job.designs, tape.slot_row.size, 5))
    assembly.gather_connections(slots, tape.connection_terms, job.weights.connection_shares, job.values[:4])
    assembly.gather_masses(slots, tape.mass_terms, job.weights.mass_shares, job.values[4])
    loads = job.loads
    strides = [0 if loads.shape[axis] == 1 else loads.strides[axis] // 8 for axis in (0, 1)]
    count: int = respond(
        (tape.slot_row, tape.weight_rows, tape.program),
        (route.loads, route.outputs, route.forward, route.backward, route.fused, route.fused_backward),
        (len(tape.removals), tape.layout.size, loads.shape[2]),
        slots,
        job.rest,
        job.weights.rows,
        job.frequencies,
        loads.reshape(-1).view(float),
        (strides[0], strides[1], 2 * loads.shape[3]),
        x.reshape(-1).view(float),
        flagged.reshape(-1),
    )
    return count


def _redo(job: Job, loaded: IntArray, outputs: IntArray, x: ComplexArray, status: StatusArray) -> None:
    """Solve the flagged cases densely."""
    full = np.empty((x.shape[1], job.weights.connection.shape[2]), dtype=complex)
    for d, f in np.argwhere(status):
        k, h, c, s, J = (_own(table, d) for table in job.values)
        z = factor_values(k, h, c, s, J, job.frequencies[0][f], job.frequencies[1][f])
        weights = np.concatenate([_own(job.weights.connection, d), _own(job.weights.mass, d)])
        sound = solve_dense(weights, z, loaded, _own(_own(job.loads, d), f), full)
        x[d, :, :, f] = full[:, outputs] if sound else complex(np.nan, np.nan)
        status[d, f] = Status.FALLBACK if sound else Status.SINGULAR


def _own(table: NDArray[_T], index: int) -> NDArray[_T]:
    """One of several rows, or the one that serves all."""
    row: NDArray[_T] = table[index if len(table) > 1 else 0]
    return row
