"""Compiled elimination over cases: designs × frequencies in blocks of lanes, loads in, solutions out.

A lane is one case.  Blocks run across the borders of designs, so that many designs at one frequency fill them as well
as one design at many frequencies; lanes past the last case repeat it.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from torsional.numerics import elimination_lanes as steps
from torsional.numerics import elimination_tape as tape
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.lanes import LANES

_U = np.uint64
L = LANES
_OMEGA, _OMEGA_SQUARED, _SPEED_SQUARED, _GUARD = tape.OMEGA, tape.OMEGA_SQUARED, tape.SPEED_SQUARED, tape.GUARD


@njit(cache=True, error_model="numpy")
def weight_sum(weights: Array) -> float:
    """Sum of a factor's weights; what rounding alone has left over counts as zero."""
    total, size = 0.0, 0.0
    for weight in weights:
        total += weight
        size += abs(weight)
    return 0.0 if abs(total) <= 4e-16 * weights.size * size else total


@njit(cache=True, error_model="numpy")
def _coefficient(weights: Array, total: float, i: int, j: int) -> float:
    """What a factor of value 1 adds to a slot: itself, to a row sum or to a coupling."""
    if i < 0:
        return 1.0
    return weights[i] * total if j < 0 else -weights[i] * weights[j]


@njit(cache=True, error_model="numpy")
def coefficients(weights: Array, terms: IntArray) -> Array:
    """The coefficient of each term, one row for each set of weights (sets, factors, n)."""
    found = np.empty((weights.shape[0], terms.shape[0]))
    for d in range(weights.shape[0]):
        for q in range(terms.shape[0]):
            f = terms[q, 0]
            found[d, q] = _coefficient(weights[d, f], weight_sum(weights[d, f]), terms[q, 2], terms[q, 3])
    return found


@njit(cache=True, error_model="numpy")
def weights_of_rows(weights: Array, rows: IntArray) -> Array:
    """The weights that lanes need, one row for each set of weights."""
    found = np.empty((weights.shape[0], rows.shape[0]))
    for d in range(weights.shape[0]):
        for q in range(rows.shape[0]):
            own, node = weights[d, rows[q, 1]], rows[q, 2]
            found[d, q] = 0.0 if node < -1 else weight_sum(own) if node < 0 else own[node]
    return found


@njit(cache=True, error_model="numpy")
def _row(table: Array, design: int) -> int:
    """A table holds one row for each design or one for all."""
    return min(design, table.shape[0] - 1)


@njit(cache=True, error_model="numpy")
def gather_connections(
    slots: Array, terms: IntArray, shares: Array, values: tuple[Array, Array, Array, Array]
) -> None:
    """Add each term's k, ηk, c and s to its slot (designs, slots, 5)."""
    stiffness, loss, damping, centrifugal = values
    for d in range(slots.shape[0]):
        k, h = stiffness[_row(stiffness, d)], loss[_row(loss, d)]
        c, s = damping[_row(damping, d)], centrifugal[_row(centrifugal, d)]
        g = shares[_row(shares, d)]
        for q in range(terms.shape[0]):
            f, slot = terms[q, 0], slots[d, terms[q, 1]]
            slot[0] += g[q] * k[f]
            slot[1] += g[q] * (k[f] * h[f])
            slot[2] += g[q] * c[f]
            slot[3] += g[q] * s[f]


@njit(cache=True, error_model="numpy")
def gather_masses(slots: Array, terms: IntArray, shares: Array, inertia: Array) -> None:
    """Add each term's J to its slot."""
    for d in range(slots.shape[0]):
        J, g = inertia[_row(inertia, d)], shares[_row(shares, d)]
        for q in range(terms.shape[0]):
            slots[d, terms[q, 1], 4] += g[q] * J[terms[q, 0]]


@njit(cache=True, error_model="numpy")
def _assemble(w: Array, rows: IntArray, sums: int, slots: Array, design: int, lo: int, hi: int) -> None:
    """re = k + Ω² s − ω² J and im = ηk + ω c in lanes lo … hi; absent terms are skipped, which changes no value.

    The first ``sums`` slots are row sums, whose squared size is kept too.
    """
    for q in range(rows.size):
        row, k, h = rows[q], slots[design, q, 0], slots[design, q, 1]
        c, s, m = slots[design, q, 2], slots[design, q, 3], slots[design, q, 4]
        if m != 0.0:
            steps.fill_line(w, row, lo, hi, k, -m, _OMEGA_SQUARED)
        else:
            steps.fill(w, row, lo, hi, k)
        if s != 0.0:
            steps.add_line(w, row, lo, hi, s, _SPEED_SQUARED)
        if c != 0.0:
            steps.fill_line(w, row + L, lo, hi, h, c, _OMEGA)
        else:
            steps.fill(w, row + L, lo, hi, h)
        if q < sums:
            steps.measure(w, row, lo, hi)


@njit(cache=True, error_model="numpy")
def _tune(w: Array, omega: Array, speed: Array, frequency: int, lo: int, hi: int, step: int) -> None:
    """Set ω, ω² and Ω² of lanes lo … hi; ``step`` 0 repeats one frequency."""
    for lane in range(hi - lo):
        at = frequency + step * lane
        w[_OMEGA + lo + lane] = omega[at]
        w[_OMEGA_SQUARED + lo + lane] = omega[at] * omega[at]
        w[_SPEED_SQUARED + lo + lane] = speed[at] * speed[at]


@njit(cache=True, error_model="numpy")
def _load(w: Array, rows: IntArray, lo: int, hi: int, loads: Array, start: int, step: int) -> None:
    """Take each load's lanes from complex numbers ``step`` floats apart."""
    by = _U(step)
    for q in range(rows.size):
        row, at = _U(rows[q]), _U(start + 2 * q)
        for l in range(_U(hi - lo)):
            w[row + _U(lo) + l] = loads[at + l * by]
            w[row + _U(L) + _U(lo) + l] = loads[at + l * by + _U(1)]


@njit(cache=True, error_model="numpy")
def _store(w: Array, rows: IntArray, lo: int, hi: int, x: Array, start: int, step: int) -> None:
    """Write lanes lo … hi of each result as adjacent complex numbers, the results ``step`` floats apart."""
    for q in range(rows.size):
        row, at = _U(rows[q]), _U(start + step * q)
        for l in range(_U(hi - lo)):
            x[at + l + l] = w[row + _U(lo) + l]
            x[at + l + l + _U(1)] = w[row + _U(L) + _U(lo) + l]


@njit(cache=True, error_model="numpy")
def _segment(first: int, lane: int, frequencies: int, cases: int) -> tuple[int, int, int, int]:
    """Design, frequency and frequency step at a lane, and the lane at which these end."""
    case = min(first + lane, cases - 1)
    design = case // frequencies
    frequency = case - design * frequencies
    if first + lane >= cases:
        return design, frequency, 0, L
    return design, frequency, 1, min(lane + frequencies - frequency, L, cases - first)


@njit(cache=True, error_model="numpy")
def _prepare(
    w: Array, rows: IntArray, sums: int, slots: Array, weight_rows: IntArray, weights: Array, omega: Array, speed: Array,
    first: int, cases: int,
) -> None:  # fmt: skip
    """Fill the block that starts at case ``first`` with what its designs and frequencies make of each slot."""
    lane = 0
    while lane < L:
        design, frequency, step, stop = _segment(first, lane, omega.size, cases)
        _tune(w, omega, speed, frequency, lane, stop, step)
        _assemble(w, rows, sums, slots, design, lane, stop)
        for q in range(weight_rows.shape[0]):
            steps.fill(w, weight_rows[q, 0], lane, stop, weights[_row(weights, design), q])
        lane = stop
    steps.fill(w, _GUARD, 0, L, 0.0)


@njit(cache=True, error_model="numpy")
def _transport(
    w: Array, rows: IntArray, loads: Array, strides: tuple[int, int, int], right: int, frequencies: int,
    first: int, cases: int,
) -> None:  # fmt: skip
    """Bring in one right-hand side of a block."""
    lane = 0
    while lane < L:
        design, frequency, step, stop = _segment(first, lane, frequencies, cases)
        start = design * strides[0] + frequency * strides[1] + right * strides[2]
        _load(w, rows, lane, stop, loads, start, step * strides[1])
        lane = stop


@njit(cache=True, error_model="numpy")
def _deliver(
    w: Array, rows: IntArray, x: Array, right: int, rights: int, frequencies: int, first: int, cases: int
) -> None:
    """Write the solutions of one right-hand side of a block."""
    lane = 0
    while lane < min(L, cases - first):
        design, frequency, _, stop = _segment(first, lane, frequencies, cases)
        start = 2 * ((design * rights + right) * rows.size * frequencies + frequency)
        _store(w, rows, lane, stop, x, start, 2 * frequencies)
        lane = stop


@njit(cache=True, error_model="numpy")
def _judge(w: Array, flagged: NDArray[np.bool_], first: int) -> int:
    """Flag the cases of a block whose guard has grown too large or is not a number."""
    count = 0
    for lane in range(min(L, flagged.size - first)):
        bad = not w[_GUARD + lane] < steps.GROWTH_LIMIT
        flagged[first + lane] = bad
        count += bad
    return count


@njit(cache=True, error_model="numpy")
def _aligned(size: int) -> Array:
    """Doubles from the start of a cache line on."""
    held = np.empty(size + 8)
    start = (64 - held.ctypes.data % 64) // 8 % 8
    return held[start : start + size]


@njit(cache=True, error_model="numpy")
def respond(
    plan: tuple[IntArray, IntArray, IntArray],
    route: tuple[IntArray, IntArray, IntArray, IntArray, IntArray, IntArray],
    sizes: tuple[int, int, int],
    slots: Array,
    weights: Array,
    frequencies: tuple[Array, Array],
    loads: Array,
    strides: tuple[int, int, int],
    x: Array,
    flagged: NDArray[np.bool_],
) -> int:
    """Solve all cases; how many were flagged.

    plan: offsets of the slots, of the weights, program; route: as ``Route``; sizes: nodes, floats of workspace, right-
    hand sides; loads: floats, ``strides`` apart by design, frequency and right-hand side; x: floats of (designs, right-
    hand sides, outputs, frequencies) complex numbers.
    """
    (slot_row, weight_rows, program), (load_rows, output_rows, forward, backward, fused, fused_backward) = plan, route
    (omega, speed), (nodes, workspace, rights) = frequencies, sizes
    count, w = 0, _aligned(workspace)
    for first in range(0, flagged.size, L):
        _prepare(w, slot_row, nodes, slots, weight_rows, weights, omega, speed, first, flagged.size)
        if rights == 1:
            _transport(w, load_rows, loads, strides, 0, omega.size, first, flagged.size)
            steps.execute(w, fused)
        else:
            steps.execute(w, program)
        count += _judge(w, flagged, first)
        for right in range(rights):
            if rights > 1:
                _transport(w, load_rows, loads, strides, right, omega.size, first, flagged.size)
                steps.execute(w, forward)
            steps.execute(w, backward if rights > 1 else fused_backward)
            _deliver(w, output_rows, x, right, rights, omega.size, first, flagged.size)
    return count
