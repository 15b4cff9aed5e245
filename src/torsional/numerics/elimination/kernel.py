"""Compiled elimination over cases: designs × frequencies in blocks of lanes, loads in, solutions out.

A lane is one case.  Blocks run across the borders of designs, so that many designs at one frequency fill them as well
as one design at many frequencies; lanes past the last case repeat it.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.elimination.assembly import add_rest, assemble, fill, row_of
from torsional.numerics.elimination.lanes import LANES as L
from torsional.numerics.elimination.steps import GROWTH_LIMIT, execute
from torsional.numerics.elimination.tape import GUARD, OMEGA, OMEGA_SQUARED, SPEED_SQUARED

_U = np.uint64


@njit(cache=True, error_model="numpy", inline="always")
def _tune(w: Array, omega: Array, speed: Array, frequency: int, lo: int, hi: int, step: int) -> None:
    """Set ω, ω² and Ω² of lanes lo … hi; ``step`` 0 repeats one frequency."""
    _copy(w, OMEGA + lo, hi - lo, omega, frequency, step)
    _copy(w, SPEED_SQUARED + lo, hi - lo, speed, frequency, step)
    for lane in range(_U(lo), _U(hi)):
        w[_U(OMEGA_SQUARED) + lane] = w[_U(OMEGA) + lane] * w[_U(OMEGA) + lane]
    for lane in range(_U(lo), _U(hi)):
        w[_U(SPEED_SQUARED) + lane] *= w[_U(SPEED_SQUARED) + lane]


@njit(cache=True, error_model="numpy", inline="always")
def _copy(w: Array, row: int, lanes: int, values: Array, start: int, step: int) -> None:
    """Copy values to lanes; apart for adjacent ones, which is then a plain copy."""
    r, at = _U(row), _U(start)
    if step == 1:
        for lane in range(_U(lanes)):
            w[r + lane] = values[at + lane]
    else:
        for lane in range(_U(lanes)):
            w[r + lane] = values[at]


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


@njit(cache=True, error_model="numpy", inline="always")
def _segment(first: int, lane: int, frequencies: int, cases: int) -> tuple[int, int, int, int]:
    """Design, frequency and frequency step at a lane, and the lane at which these end."""
    case = min(first + lane, cases - 1)
    design = case // frequencies
    frequency = case - design * frequencies
    if first + lane >= cases:
        return design, frequency, 0, L
    return design, frequency, 1, min(lane + frequencies - frequency, L, cases - first)


@njit(cache=True, error_model="numpy", inline="always")
def _prepare(
    w: Array, rows: IntArray, sums: int, slots: Array, rest: Array, weight_rows: IntArray, weights: Array,
    omega: Array, speed: Array, first: int, cases: int,
) -> None:  # fmt: skip
    """Fill the block that starts at case ``first`` with what its designs and frequencies make of each slot."""
    lane = 0
    while lane < L:
        design, frequency, step, stop = _segment(first, lane, omega.size, cases)
        _tune(w, omega, speed, frequency, lane, stop, step)
        assemble(w, rows, sums, slots, design, lane, stop)
        if rest.size:
            add_rest(w, rows, sums, rest, frequency, step, lane, stop)
        for q in range(weight_rows.shape[0]):
            fill(w, weight_rows[q, 0], lane, stop, weights[row_of(weights, design), q])
        lane = stop
    fill(w, GUARD, 0, L, 0.0)


@njit(cache=True, error_model="numpy", inline="always")
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


@njit(cache=True, error_model="numpy", inline="always")
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


@njit(cache=True, error_model="numpy", inline="always")
def _judge(w: Array, flagged: NDArray[np.bool_], first: int) -> int:
    """Flag the cases of a block whose guard has grown too large or is not a number."""
    lanes, sound = _U(min(L, flagged.size - first)), 0
    for lane in range(lanes):
        sound += w[_U(GUARD) + lane] < GROWTH_LIMIT
    if sound < lanes:
        for lane in range(lanes):
            flagged[_U(first) + lane] = not w[_U(GUARD) + lane] < GROWTH_LIMIT
    return int(lanes) - sound


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
    rest: Array,
    weights: Array,
    frequencies: tuple[Array, Array],
    loads: Array,
    strides: tuple[int, int, int],
    x: Array,
    flagged: NDArray[np.bool_],
) -> int:
    """Solve all cases; how many were flagged.

    plan: offsets of the slots, of the weights, program; route: as ``Route``; sizes: nodes, floats of workspace, right-
    hand sides; slots: (designs, slots, 5); rest: (slots, 3, frequencies) or empty, see `add_rest`; loads: floats,
    ``strides`` apart by design, frequency and right-hand side; x: floats of (designs, right-hand sides, outputs,
    frequencies) complex numbers.
    """
    (slot_row, weight_rows, program), (load_rows, output_rows, forward, backward, fused, fused_backward) = plan, route
    (omega, speed), (nodes, workspace, rights) = frequencies, sizes
    count, w = 0, _aligned(workspace)
    for first in range(0, flagged.size, L):
        _prepare(w, slot_row, nodes, slots, rest, weight_rows, weights, omega, speed, first, flagged.size)
        if rights == 1:
            _transport(w, load_rows, loads, strides, 0, omega.size, first, flagged.size)
            execute(w, fused)
        else:
            execute(w, program)
        count += _judge(w, flagged, first)
        for right in range(rights):
            if rights > 1:
                _transport(w, load_rows, loads, strides, right, omega.size, first, flagged.size)
                execute(w, forward)
            execute(w, backward if rights > 1 else fused_backward)
            _deliver(w, output_rows, x, right, rights, omega.size, first, flagged.size)
    return count
