"""Compiled assembly: coefficients of each design's slots, and the rows that its lanes make of them."""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

import numpy as np
from numba import njit

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.elimination.lanes import LANES as L
from torsional.numerics.elimination.tape import OMEGA, OMEGA_SQUARED, SPEED_SQUARED


@njit(cache=True, error_model="numpy")
def fill(w: Array, row: int, lo: int, hi: int, value: float) -> None:
    """Set lanes lo … hi of a row."""
    r = np.uint64(row)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] = value


@njit(cache=True, error_model="numpy")
def _fill_line(w: Array, row: int, lo: int, hi: int, value: float, factor: float, other: int) -> None:
    """Set lanes lo … hi of a row to value + factor × another row."""
    r, o = np.uint64(row), np.uint64(other)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] = value + factor * w[o + l]


@njit(cache=True, error_model="numpy")
def _add_line(w: Array, row: int, lo: int, hi: int, factor: float, other: int) -> None:
    """Add factor × another row to lanes lo … hi of a row."""
    r, o = np.uint64(row), np.uint64(other)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] += factor * w[o + l]


@njit(cache=True, error_model="numpy")
def measure(w: Array, row: int, lo: int, hi: int) -> None:
    """Put the squared magnitude of a complex row in the row behind it."""
    r, n = np.uint64(row), np.uint64(L)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + n + n + l] = w[r + l] * w[r + l] + w[r + n + l] * w[r + n + l]


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
def row_of(table: Array, design: int) -> int:
    """A table holds one row for each design or one for all."""
    return min(design, table.shape[0] - 1)


@njit(cache=True, error_model="numpy")
def gather_connections(slots: Array, terms: IntArray, shares: Array, values: tuple[Array, Array, Array, Array]) -> None:
    """Add each term's k, ηk, c and s to its slot (designs, slots, 5)."""
    stiffness, loss, damping, centrifugal = values
    for d in range(slots.shape[0]):
        k, h = stiffness[row_of(stiffness, d)], loss[row_of(loss, d)]
        c, s = damping[row_of(damping, d)], centrifugal[row_of(centrifugal, d)]
        g = shares[row_of(shares, d)]
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
        J, g = inertia[row_of(inertia, d)], shares[row_of(shares, d)]
        for q in range(terms.shape[0]):
            slots[d, terms[q, 1], 4] += g[q] * J[terms[q, 0]]


@njit(cache=True, error_model="numpy")
def assemble(w: Array, rows: IntArray, sums: int, slots: Array, design: int, lo: int, hi: int) -> None:
    """re = k + Ω² s − ω² J and im = ηk + ω c in lanes lo … hi; absent terms are skipped, which changes no value.

    The first ``sums`` slots are row sums, whose squared size is kept too.
    """
    for q in range(rows.size):
        row, k, h = rows[q], slots[design, q, 0], slots[design, q, 1]
        c, s, m = slots[design, q, 2], slots[design, q, 3], slots[design, q, 4]
        if m != 0.0:
            _fill_line(w, row, lo, hi, k, -m, OMEGA_SQUARED)
        else:
            fill(w, row, lo, hi, k)
        if s != 0.0:
            _add_line(w, row, lo, hi, s, SPEED_SQUARED)
        if c != 0.0:
            _fill_line(w, row + L, lo, hi, h, c, OMEGA)
        else:
            fill(w, row + L, lo, hi, h)
        if q < sums:
            measure(w, row, lo, hi)


@njit(cache=True, error_model="numpy")
def add_rest(w: Array, rows: IntArray, sums: int, rest: Array, frequency: int, step: int, lo: int, hi: int) -> None:
    """Add what all designs have in common to lanes lo … hi, from (slots, 3, frequencies): real and imaginary part and,
    of row sums, the squared size they were summed from; ``step`` 0 repeats one frequency."""
    by, n = np.uint64(step), np.uint64(L)
    for q in range(rows.size):
        for part in range(3 if q < sums else 2):
            row, values, at = np.uint64(rows[q]) + np.uint64(part) * n, rest[q, part], np.uint64(frequency)
            for l in range(np.uint64(hi - lo)):
                w[row + np.uint64(lo) + l] += values[at + l * by]
