"""Steps of an elimination over one block of lanes, each a formula over rows, and the program that strings them.

A column is the row sum e_i (complex), the squared size it was summed from, then the couplings a_ij (complex).  Taking
node i out leaves 1/s in the place of e_i and t_j in that of a_ij.  What each step's offsets mean stands in ``Step``.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.elimination_tape import (
    FIRST_COUPLING,
    GUARD,
    OPEN_PIVOT,
    PIVOT,
    TRANSFER,
    WEIGHT_SUM,
    Op,
)
from torsional.numerics.lanes import COMPLEX, LANES, Complex, Rows, lane_operation

GROWTH_LIMIT = 1e8
"""Largest Σ|t|² that passes: |t| is how much a rounding error of one pivot grows, so four digits of sixteen at most."""
ROOT_LIMIT = 1e-8
"""Smallest squared ratio of a last pivot to what it was summed from: nearer to a resonance the case is redone."""
COUPLING_LIMIT = 1e-8
"""Smallest squared ratio of a coupling to what was added to it."""

_WORSE = 1e300  # more than any limit


def _spread(w: Rows, t: Complex, column: Any, e: Complex, other: Any) -> None:
    """e_j += t e_i, the size it is summed from likewise, and the guard sums |t|²."""
    growth = t.squared()
    w.add(other, t * e)
    w.add(other, growth * w.real(column, COMPLEX), COMPLEX)
    w.add(GUARD, growth)


def _couple(w: Rows, target: Any, share: Complex) -> None:
    """Add to a coupling; a sum that nearly cancels has lost its digits and is flagged."""
    a = w.complex(target) + share
    w.put(target, a)
    w.add(GUARD, a.squared().unless(">=", share.squared() * COUPLING_LIMIT, _WORSE))


def _leaf(w: Rows, column: Any, other: Any) -> tuple[Complex, Complex]:
    """1/s and t of a node with one neighbour."""
    e, a = w.complex(column), w.complex(column, FIRST_COUPLING)
    pivot = (e + a).inverse()
    t = a * pivot
    w.put(column, t, FIRST_COUPLING)
    _spread(w, t, column, e, other)
    return pivot, t


@lane_operation
def leaf(w: Rows, column: Any, other: Any, *_: Any) -> None:
    """Take out a node with one neighbour."""
    pivot, _t = _leaf(w, column, other)
    w.put(column, pivot)


@lane_operation
def loaded_leaf(w: Rows, column: Any, other: Any, own: Any, far: Any, *_: Any) -> None:
    """As ``leaf``, handing the load on and dividing it: b_j += t b_i, b_i := b_i / s."""
    pivot, t = _leaf(w, column, other)
    b = w.complex(own)
    w.put(own, b * pivot)
    w.add(far, t * b)


@lane_operation
def first_leaf(w: Rows, column: Any, other: Any, own: Any, far: Any, *_: Any) -> None:
    """As ``loaded_leaf`` where the neighbour has no load yet: b_j = t b_i."""
    pivot, t = _leaf(w, column, other)
    b = w.complex(own)
    w.put(own, b * pivot)
    w.put(far, t * b)


@lane_operation
def root(w: Rows, column: Any, *_: Any) -> None:
    """Take out a node without neighbours; its row sum must not be what a cancellation has left over."""
    e = w.complex(column)
    w.put(column, e.inverse())
    w.add(GUARD, e.squared().unless(">", w.real(column, COMPLEX) * ROOT_LIMIT, _WORSE))


@lane_operation
def copy(w: Rows, target: Any, row: Any, *_: Any) -> None:
    """Copy a complex row."""
    w.put(target, w.complex(row))


@lane_operation
def add(w: Rows, target: Any, row: Any, *_: Any) -> None:
    """Add a complex row to another."""
    w.add(target, w.complex(row))


@lane_operation
def invert(w: Rows, row: Any, *_: Any) -> None:
    """Replace a complex row by its reciprocal."""
    w.put(row, w.complex(row).inverse())


@lane_operation
def clear(w: Rows, row: Any, *_: Any) -> None:
    """Zero a complex row."""
    zero = w.constant(0.0)
    w.put(row, Complex(zero, zero))


@lane_operation
def transfer(w: Rows, coupling: Any, column: Any, other: Any, *_: Any) -> None:
    """Put t = a_ij / s₀ aside and add its share of the row sum to the other node's."""
    t = w.complex(coupling) * w.complex(OPEN_PIVOT)
    w.put(TRANSFER, t)
    _spread(w, t, column, w.complex(column), other)


@lane_operation
def couple(w: Rows, target: Any, coupling: Any, *_: Any) -> None:
    """a_jk += t_j a_ik."""
    _couple(w, target, w.complex(TRANSFER) * w.complex(coupling))


@lane_operation
def stiffen(w: Rows, connection: Any, weight: Any, *_: Any) -> None:
    """s = s₀ + z w_i² of a node on a whole connection."""
    own = w.complex(weight)
    w.put(PIVOT, w.complex(OPEN_PIVOT) + w.complex(connection) * (own * own))


@lane_operation
def pass_whole(w: Rows, coupling: Any, connection: Any, near: Any, far: Any, column: Any, other: Any, *_: Any) -> None:
    """t_j = (a_ij − z w_i w_j) / s of a node on a whole connection takes the place of a_ij."""
    share = w.complex(connection) * (w.complex(near) * w.complex(far))
    t = (w.complex(coupling) - share) * w.complex(PIVOT)
    growth = t.squared()
    w.put(coupling, t)
    w.add(other, growth * w.real(column, COMPLEX), COMPLEX)
    w.add(GUARD, growth)


@lane_operation
def bend_whole(w: Rows, far: Any, near: Any, *_: Any) -> None:
    """w_j += t_j w_i with t_j = a_ij / s₀: a neighbour turns the connection through the node's other couplings."""
    w.add(far, w.complex(near) * w.complex(TRANSFER))


@lane_operation
def soften_whole(w: Rows, connection: Any, near: Any, column: Any, aside: Any, *_: Any) -> None:
    """z := z s₀ / s, which is 1/z + w_i² / s₀ turned over, and Σw −= w_i e_i / s₀."""
    opened, pivot, own, z = w.complex(OPEN_PIVOT), w.complex(PIVOT), w.complex(near), w.complex(connection)
    w.put(aside, opened)
    w.put(aside, z * own * pivot, COMPLEX)
    w.put(connection, w.complex(connection, WEIGHT_SUM) - own * (w.complex(column) * opened), WEIGHT_SUM)
    w.put(connection, z * (opened.inverse() * pivot))


@lane_operation
def absorb_whole(w: Rows, column: Any, connection: Any, weight: Any, *_: Any) -> None:
    """What is left of a whole connection on a single node: e_j += z w_j²."""
    own = w.complex(weight)
    share = w.complex(connection) * (own * own)
    w.add(column, share)
    w.add(column, share.squared(), COMPLEX)


@lane_operation
def spread_sum(w: Rows, column: Any, connection: Any, weight: Any, *_: Any) -> None:
    """e_j += z w_j Σw of a connection that cannot stay whole."""
    share = w.complex(connection) * (w.complex(weight) * w.complex(connection, WEIGHT_SUM))
    w.add(column, share)
    w.add(column, share.squared(), COMPLEX)


@lane_operation
def spread_coupling(w: Rows, target: Any, connection: Any, first: Any, second: Any, floor: Any, *_: Any) -> None:
    """a_jk −= z w_j w_k of a connection that cannot stay whole; ``floor`` keeps how large that was."""
    share = w.complex(connection) * (w.complex(first) * w.complex(second))
    w.put(target, w.complex(target) - share)
    w.add(floor, share.squared())


@lane_operation
def check(w: Rows, coupling: Any, floor: Any, *_: Any) -> None:
    """Flag a coupling that others have cancelled down to the rounding of what was spread."""
    w.add(GUARD, w.complex(coupling).squared().unless(">=", w.real(floor) * COUPLING_LIMIT, _WORSE))


@lane_operation
def clear_real(w: Rows, row: Any, *_: Any) -> None:
    """Zero a row."""
    w.put(row, w.constant(0.0))


@lane_operation
def twist_whole(w: Rows, own: Any, twist: Any, near: Any, aside: Any, column: Any, *_: Any) -> None:
    """A load moves a whole connection z (w·x − γ): b_i := b_i / s + γ z w_i / s and γ −= w_i b_i / s₀."""
    b, offset = w.complex(own), w.complex(twist)
    w.put(own, b * w.complex(column) + offset * w.complex(aside, COMPLEX))
    w.put(twist, offset - w.complex(near) * (b * w.complex(aside)))


@lane_operation
def load_whole(w: Rows, target: Any, twist: Any, connection: Any, weight: Any, *_: Any) -> None:
    """b_j += z w_j γ of a connection that is whole no longer."""
    w.add(target, w.complex(connection) * (w.complex(weight) * w.complex(twist)))


@lane_operation
def forward(w: Rows, coupling: Any, own: Any, other: Any, *_: Any) -> None:
    """Hand a node's load on: b_j += t b_i."""
    w.add(other, w.complex(coupling) * w.complex(own))


@lane_operation
def multiply(w: Rows, target: Any, row: Any, other: Any, *_: Any) -> None:
    """The product of two complex rows."""
    w.put(target, w.complex(row) * w.complex(other))


@lane_operation
def backward(w: Rows, coupling: Any, own: Any, other: Any, *_: Any) -> None:
    """Add a neighbour's share of the solution: x_i += t x_j."""
    w.add(own, w.complex(coupling) * w.complex(other))


@lane_operation
def backward_leaf(w: Rows, column: Any, own: Any, other: Any, *_: Any) -> None:
    """The solution of a loaded node with one neighbour: x_i = b_i / s + t x_j."""
    w.put(own, w.complex(own) * w.complex(column) + w.complex(column, FIRST_COUPLING) * w.complex(other))


(
    _LOADED_LEAF,
    _BACKWARD,
    _LEAF,
    _FIRST_LEAF,
    _BACKWARD_LEAF,
    _FORWARD,
    _MULTIPLY,
    _COUPLE,
    _TRANSFER,
    _COPY,
    _ADD,
    _INVERT,
    _ROOT,
    _CLEAR,
    _STIFFEN,
    _BEND_WHOLE,
    _PASS_WHOLE,
    _SOFTEN_WHOLE,
    _ABSORB_WHOLE,
    _SPREAD_SUM,
    _SPREAD_COUPLING,
    _TWIST_WHOLE,
    _LOAD_WHOLE,
    _CHECK,
    _CLEAR_REAL,
) = (int(op) for op in Op)


@njit(cache=True, error_model="numpy")
def execute(w: Array, program: IntArray) -> None:
    """Run a program of lane operations; the frequent ones are asked for first."""
    for q in range(program.shape[0]):
        op, a, b, c = program[q, 0], program[q, 1], program[q, 2], program[q, 3]
        d, e, f, g = program[q, 4], program[q, 5], program[q, 6], program[q, 7]
        if op == _LOADED_LEAF:
            loaded_leaf(w, a, b, c, d, e, f, g)
        elif op == _BACKWARD:
            backward(w, a, b, c, d, e, f, g)
        elif op == _LEAF:
            leaf(w, a, b, c, d, e, f, g)
        elif op == _FIRST_LEAF:
            first_leaf(w, a, b, c, d, e, f, g)
        elif op == _BACKWARD_LEAF:
            backward_leaf(w, a, b, c, d, e, f, g)
        elif op == _FORWARD:
            forward(w, a, b, c, d, e, f, g)
        elif op == _MULTIPLY:
            multiply(w, a, b, c, d, e, f, g)
        elif op == _COUPLE:
            couple(w, a, b, c, d, e, f, g)
        elif op == _TRANSFER:
            transfer(w, a, b, c, d, e, f, g)
        elif op == _COPY:
            copy(w, a, b, c, d, e, f, g)
        elif op == _ADD:
            add(w, a, b, c, d, e, f, g)
        elif op == _INVERT:
            invert(w, a, b, c, d, e, f, g)
        elif op == _ROOT:
            root(w, a, b, c, d, e, f, g)
        elif op == _CLEAR:
            clear(w, a, b, c, d, e, f, g)
        elif op == _STIFFEN:
            stiffen(w, a, b, c, d, e, f, g)
        elif op == _BEND_WHOLE:
            bend_whole(w, a, b, c, d, e, f, g)
        elif op == _PASS_WHOLE:
            pass_whole(w, a, b, c, d, e, f, g)
        elif op == _SOFTEN_WHOLE:
            soften_whole(w, a, b, c, d, e, f, g)
        elif op == _ABSORB_WHOLE:
            absorb_whole(w, a, b, c, d, e, f, g)
        elif op == _SPREAD_SUM:
            spread_sum(w, a, b, c, d, e, f, g)
        elif op == _SPREAD_COUPLING:
            spread_coupling(w, a, b, c, d, e, f, g)
        elif op == _TWIST_WHOLE:
            twist_whole(w, a, b, c, d, e, f, g)
        elif op == _LOAD_WHOLE:
            load_whole(w, a, b, c, d, e, f, g)
        elif op == _CHECK:
            check(w, a, b, c, d, e, f, g)
        elif op == _CLEAR_REAL:
            clear_real(w, a, b, c, d, e, f, g)


@njit(cache=True, error_model="numpy")
def fill(w: Array, row: int, lo: int, hi: int, value: float) -> None:
    """Set lanes lo … hi of a row."""
    r = np.uint64(row)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] = value


@njit(cache=True, error_model="numpy")
def fill_line(w: Array, row: int, lo: int, hi: int, value: float, factor: float, other: int) -> None:
    """Set lanes lo … hi of a row to value + factor × another row."""
    r, o = np.uint64(row), np.uint64(other)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] = value + factor * w[o + l]


@njit(cache=True, error_model="numpy")
def add_line(w: Array, row: int, lo: int, hi: int, factor: float, other: int) -> None:
    """Add factor × another row to lanes lo … hi of a row."""
    r, o = np.uint64(row), np.uint64(other)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + l] += factor * w[o + l]


@njit(cache=True, error_model="numpy")
def measure(w: Array, row: int, lo: int, hi: int) -> None:
    """Put the squared magnitude of a complex row in the row behind it."""
    r, n = np.uint64(row), np.uint64(LANES)
    for l in range(np.uint64(lo), np.uint64(hi)):
        w[r + n + n + l] = w[r + l] * w[r + l] + w[r + n + l] * w[r + n + l]
