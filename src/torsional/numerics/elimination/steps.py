"""Steps of an elimination over one block of lanes, each a formula over rows, and the program that strings them.

A column is the row sum e_i (complex), the squared size it was summed from, then the couplings a_ij (complex).  Taking
node i out leaves 1/s in the place of e_i and t_j in that of a_ij.  What each step's offsets mean stands in ``Step``.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.elimination.lanes import COMPLEX, Complex, Formula, Rows, lane_program
from torsional.numerics.elimination.tape import (
    FIRST_COUPLING,
    GUARD,
    OPEN_PIVOT,
    PIVOT,
    TRANSFER,
    WEIGHT_SUM,
    Op,
)

GROWTH_LIMIT = 1e8
"""Largest Σ|t|² that passes: |t| is how much a rounding error of one pivot grows, so four digits of sixteen at most."""
ROOT_LIMIT = 1e-8
"""Smallest squared ratio of a last pivot to what it was summed from: nearer to a resonance the case is redone."""
COUPLING_LIMIT = 1e-8
"""Smallest squared ratio of a coupling to what was added to it."""

_WORSE = 1e300  # more than any limit
_FORMULAS: dict[int, Formula] = {}


def _step(op: Op) -> Callable[[Formula], Formula]:
    """Register the formula of an operation."""

    def register(formula: Formula) -> Formula:
        _FORMULAS[op] = formula
        return formula

    return register


def _spread(w: Rows, t: Complex, column: Any, e: Complex, other: Any) -> None:
    """e_j += t e_i, the size it is summed from likewise, and the guard sums |t|²."""
    growth = t.squared()
    w.add(other, t * e)
    w.add(other, growth * w.real(column, COMPLEX), COMPLEX)
    w.add(GUARD, growth)


def _flag(w: Rows, total: Complex, share: Complex, limit: float) -> None:
    """Flag a sum that nearly cancels one of its terms: it has lost its digits."""
    w.add(GUARD, total.squared().unless(">=", share.squared() * limit, _WORSE))


def _couple(w: Rows, target: Any, share: Complex) -> None:
    """Add to a coupling."""
    a = w.complex(target) + share
    w.put(target, a)
    _flag(w, a, share, COUPLING_LIMIT)


def _leaf(w: Rows, column: Any, other: Any) -> tuple[Complex, Complex]:
    """1/s and t of a node with one neighbour."""
    e, a = w.complex(column), w.complex(column, FIRST_COUPLING)
    pivot = (e + a).inverse()
    t = a * pivot
    w.put(column, t, FIRST_COUPLING)
    _spread(w, t, column, e, other)
    return pivot, t


@_step(Op.LEAF)
def leaf(w: Rows, column: Any, other: Any, *_: Any) -> None:
    """Take out a node with one neighbour."""
    pivot, _t = _leaf(w, column, other)
    w.put(column, pivot)


@_step(Op.LOADED_LEAF)
def loaded_leaf(w: Rows, column: Any, other: Any, own: Any, far: Any, *_: Any) -> None:
    """As ``leaf``, handing the load on and dividing it: b_j += t b_i, b_i := b_i / s."""
    pivot, t = _leaf(w, column, other)
    b = w.complex(own)
    w.put(own, b * pivot)
    w.add(far, t * b)


@_step(Op.FIRST_LEAF)
def first_leaf(w: Rows, column: Any, other: Any, own: Any, far: Any, *_: Any) -> None:
    """As ``loaded_leaf`` where the neighbour has no load yet: b_j = t b_i."""
    pivot, t = _leaf(w, column, other)
    b = w.complex(own)
    w.put(own, b * pivot)
    w.put(far, t * b)


@_step(Op.ROOT)
def root(w: Rows, column: Any, *_: Any) -> None:
    """Take out a node without neighbours; its row sum must not be what a cancellation has left over."""
    e = w.complex(column)
    w.put(column, e.inverse())
    w.add(GUARD, e.squared().unless(">", w.real(column, COMPLEX) * ROOT_LIMIT, _WORSE))


@_step(Op.COPY)
def copy(w: Rows, target: Any, row: Any, *_: Any) -> None:
    """Copy a complex row."""
    w.put(target, w.complex(row))


@_step(Op.ADD)
def add(w: Rows, target: Any, row: Any, *_: Any) -> None:
    """Add a complex row to another."""
    w.add(target, w.complex(row))


@_step(Op.INVERT)
def invert(w: Rows, row: Any, *_: Any) -> None:
    """Replace a complex row by its reciprocal."""
    w.put(row, w.complex(row).inverse())


@_step(Op.CLEAR)
def clear(w: Rows, row: Any, *_: Any) -> None:
    """Zero a complex row."""
    zero = w.constant(0.0)
    w.put(row, Complex(zero, zero))


@_step(Op.TRANSFER)
def transfer(w: Rows, coupling: Any, column: Any, other: Any, *_: Any) -> None:
    """Put t = a_ij / s₀ aside and add its share of the row sum to the other node's."""
    t = w.complex(coupling) * w.complex(OPEN_PIVOT)
    w.put(TRANSFER, t)
    _spread(w, t, column, w.complex(column), other)


@_step(Op.COUPLE)
def couple(w: Rows, target: Any, coupling: Any, *_: Any) -> None:
    """a_jk += t_j a_ik."""
    _couple(w, target, w.complex(TRANSFER) * w.complex(coupling))


@_step(Op.STIFFEN)
def stiffen(w: Rows, connection: Any, weight: Any, *_: Any) -> None:
    """s = s₀ + z w_i² of a node on a whole connection."""
    own = w.complex(weight)
    w.put(PIVOT, w.complex(OPEN_PIVOT) + w.complex(connection) * (own * own))


@_step(Op.PASS_WHOLE)
def pass_whole(w: Rows, coupling: Any, connection: Any, near: Any, far: Any, column: Any, other: Any, *_: Any) -> None:
    """t_j = (a_ij − z w_i w_j) / s of a node on a whole connection takes the place of a_ij."""
    share = w.complex(connection) * (w.complex(near) * w.complex(far))
    t = (w.complex(coupling) - share) * w.complex(PIVOT)
    growth = t.squared()
    w.put(coupling, t)
    w.add(other, growth * w.real(column, COMPLEX), COMPLEX)
    w.add(GUARD, growth)


@_step(Op.BEND_WHOLE)
def bend_whole(w: Rows, far: Any, near: Any, *_: Any) -> None:
    """w_j += t_j w_i with t_j = a_ij / s₀: a neighbour turns the connection through the node's other couplings."""
    w.add(far, w.complex(near) * w.complex(TRANSFER))


@_step(Op.SOFTEN_WHOLE)
def soften_whole(w: Rows, connection: Any, near: Any, column: Any, aside: Any, *_: Any) -> None:
    """z := z s₀ / s, which is 1/z + w_i² / s₀ turned over, and Σw −= w_i e_i / s₀."""
    opened, pivot, own, z = w.complex(OPEN_PIVOT), w.complex(PIVOT), w.complex(near), w.complex(connection)
    w.put(aside, opened)
    w.put(aside, z * own * pivot, COMPLEX)
    w.put(connection, w.complex(connection, WEIGHT_SUM) - own * (w.complex(column) * opened), WEIGHT_SUM)
    w.put(connection, z * (opened.inverse() * pivot))


@_step(Op.ABSORB_WHOLE)
def absorb_whole(w: Rows, column: Any, connection: Any, weight: Any, *_: Any) -> None:
    """What is left of a whole connection on a single node: e_j += z w_j²."""
    own = w.complex(weight)
    share = w.complex(connection) * (own * own)
    w.add(column, share)
    w.add(column, share.squared(), COMPLEX)


@_step(Op.MERGE_WHOLE)
def merge_whole(w: Rows, first: Any, second: Any, near_first: Any, near_second: Any, turn: Any, *_: Any) -> None:
    """Turn two whole connections z w wᵀ + y v vᵀ on node i so that only the first is still on it.

    s = z w_i² + y v_i²: z := s along (z w_i w + y v_i v) / s, y := z y / s along w_i v − v_i w.
    """
    z, y, wi, vi = w.complex(first), w.complex(second), w.complex(near_first), w.complex(near_second)
    share, other = z * wi, y * vi
    total = share * wi + other * vi
    inverse = total.inverse()
    _flag(w, total, share * wi, ROOT_LIMIT)
    for index, coefficient in enumerate((share * inverse, other * inverse, wi, vi)):
        w.put(turn, coefficient, COMPLEX * index)
    w.put(first, total)
    w.put(second, z * y * inverse)


@_step(Op.TURN)
def turn(w: Rows, first: Any, second: Any, turn: Any, *_: Any) -> None:
    """(u, v) := (α u + β v, w_i v − v_i u) of whatever belongs to two merged connections."""
    u, v = w.complex(first), w.complex(second)
    alpha, beta, wi, vi = (w.complex(turn, COMPLEX * index) for index in range(4))
    w.put(first, alpha * u + beta * v)
    w.put(second, wi * v - vi * u)


@_step(Op.TWIST_WHOLE)
def twist_whole(w: Rows, own: Any, twist: Any, near: Any, aside: Any, column: Any, *_: Any) -> None:
    """A load moves a whole connection z (w·x − γ): b_i := b_i / s + γ z w_i / s and γ −= w_i b_i / s₀."""
    b, offset = w.complex(own), w.complex(twist)
    w.put(own, b * w.complex(column) + offset * w.complex(aside, COMPLEX))
    w.put(twist, offset - w.complex(near) * (b * w.complex(aside)))


@_step(Op.LOAD_WHOLE)
def load_whole(w: Rows, target: Any, twist: Any, connection: Any, weight: Any, *_: Any) -> None:
    """b_j += z w_j γ of a connection that is whole no longer."""
    w.add(target, w.complex(connection) * (w.complex(weight) * w.complex(twist)))


@_step(Op.FORWARD)
def forward(w: Rows, coupling: Any, own: Any, other: Any, *_: Any) -> None:
    """Hand a node's load on: b_j += t b_i."""
    w.add(other, w.complex(coupling) * w.complex(own))


@_step(Op.MULTIPLY)
def multiply(w: Rows, target: Any, row: Any, other: Any, *_: Any) -> None:
    """The product of two complex rows."""
    w.put(target, w.complex(row) * w.complex(other))


@_step(Op.BACKWARD)
def backward(w: Rows, coupling: Any, own: Any, other: Any, *_: Any) -> None:
    """Add a neighbour's share of the solution: x_i += t x_j."""
    w.add(own, w.complex(coupling) * w.complex(other))


@_step(Op.BACKWARD_LEAF)
def backward_leaf(w: Rows, column: Any, own: Any, other: Any, *_: Any) -> None:
    """The solution of a loaded node with one neighbour: x_i = b_i / s + t x_j."""
    w.put(own, w.complex(own) * w.complex(column) + w.complex(column, FIRST_COUPLING) * w.complex(other))


_operate = lane_program(_FORMULAS)


@njit(cache=True, error_model="numpy")
def execute(w: Array, program: IntArray) -> None:
    """Run a program of lane operations."""
    for q in range(program.shape[0]):
        op, a, b, c = program[q, 0], program[q, 1], program[q, 2], program[q, 3]
        _operate(w, op, a, b, c, program[q, 4], program[q, 5], program[q, 6], program[q, 7])
