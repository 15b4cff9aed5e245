"""Linear complementarity: contacts that push or are open, found all at once.

    0 ≤ λ ⟂ w = p + M λ ≥ 0

For a P-matrix M (every principal minor positive) there is exactly one solution for every p, and a finite method that
finds it.  The matrices of time steps with one-sided springs are such: see `step_problem`.
"""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.small import backsolve, factor

STRIKES = 3  # passes that may fail to lower the number of wrong contacts before they change one at a time
ROUNDING = 1e-15  # of the terms of a sum, times their number: wrong by no more than rounding
MOST_PASSES = 100_000


class Contacts(NamedTuple):
    """Forces λ (n,), which of them push (n,), the passes it took, those of them that changed one contact only."""

    force: Array
    closed: IntArray
    passes: int
    single: int


@numba.njit(cache=True, error_model="numpy")
def _closed_forces(matrix: Array, offset: Array, closed: IntArray, force: Array) -> bool:
    """λ of M_cc λ_c = −p_c for the closed contacts, zero for the others; whether M_cc could be factored."""
    place = np.flatnonzero(closed)
    n = place.size
    part, order, right = np.empty((n, n)), np.empty(n, dtype=np.int64), np.empty(n)
    for i in range(n):
        right[i] = -offset[place[i]]
        for j in range(n):
            part[i, j] = matrix[place[i], place[j]]
    if n > 0 and factor(part, order) == 0.0:
        return False
    backsolve(part, order, right)
    force[:] = 0.0
    for i in range(n):
        force[place[i]] = right[i]
    return True


@numba.njit(cache=True, error_model="numpy")
def _find_wrong(matrix: Array, offset: Array, closed: IntArray, force: Array, rounding: float, wrong: IntArray) -> int:
    """Closed contacts that pull and open ones that overlap, by more than rounding: their number, and which."""
    n, count, largest = offset.size, 0, np.abs(force).max()
    for i in range(n):
        wrong[i] = force[i] < -rounding * largest
        if closed[i] == 0:
            gap, size = offset[i], abs(offset[i])
            for j in range(n):
                term = matrix[i, j] * force[j]
                gap, size = gap + term, size + abs(term)
            wrong[i] = gap < -rounding * size
        count += wrong[i]
    return count


@numba.njit(cache=True, error_model="numpy")
def _change(closed: IntArray, wrong: IntArray, single: bool) -> None:
    """Wrong contacts change sides: all of them, or the last one alone."""
    for i in range(closed.size - 1, -1, -1):
        if wrong[i] == 1:
            closed[i] = 1 - closed[i]
            if single:
                return


@numba.njit(cache=True, error_model="numpy")
def _returned(closed: IntArray, seen: IntArray, since: int) -> bool:
    """Whether a set has come back to one ``seen``, which is set anew after 1, 2, 4, … passes (Brent's method)."""
    same = since > 1
    for i in range(closed.size):
        same = same and closed[i] == seen[i]
    if since & (since - 1) == 0:
        seen[:] = closed
    return same


@numba.njit(cache=True, error_model="numpy")
def _block_pivoting(matrix: Array, offset: Array, closed: IntArray, force: Array) -> tuple[int, int]:
    """Solve the scaled problem in place, from the contacts that are ``closed`` (n,) of 0 and 1 to begin with.

    All wrong contacts change sides at once; where that has not lowered their number three times, the last one alone
    does until it is lowered (Murty's rule, finite for P-matrices).  That rule goes in circles by rounding only, of
    which it is then let off more.  Back come the passes and how many of them changed one contact; −1 passes where a
    matrix was singular or `MOST_PASSES` did not do.  Source: Kostreva, Linear Algebra Appl. 21 (1978) 207; Júdice and
    Pires, Comput. Oper. Res. 21 (1994) 587.
    """
    n, best, strikes, singles, since = offset.size, offset.size + 1, STRIKES, 0, 0
    wrong, seen, rounding = np.empty(n, dtype=np.int64), np.full(n, -1), ROUNDING * n
    for passes in range(1, MOST_PASSES + 1):
        if not _closed_forces(matrix, offset, closed, force):
            return -1, singles
        count = _find_wrong(matrix, offset, closed, force, rounding, wrong)
        if count == 0:
            np.maximum(force, 0.0, force)
            return passes, singles
        strikes = STRIKES if count < best else strikes - 1
        best = min(best, count)
        _change(closed, wrong, strikes < 0)
        since = since + 1 if strikes < 0 else 0
        singles += strikes < 0
        if since > 0 and _returned(closed, seen, since):
            rounding *= 10.0
    return -1, singles


def solve_contacts(
    matrix: ArrayLike, offset: ArrayLike, *, closed: ArrayLike | None = None, scale: ArrayLike | None = None
) -> Contacts:
    """Solve 0 ≤ λ ⟂ p + M λ ≥ 0 for a P-matrix M (n, n) and p (n,).

    ``closed`` (n,): contacts thought to push, such as those of the step before.  ``scale`` (n,): d of the scaled
    problem D M D, D p with λ = D μ, by default 1/sqrt(M_ii); for springs, whose stiffness spans decades, sqrt(k).
    Raises ModelError where M is no P-matrix as far as it shows.

    >>> solve_contacts([[2.0, 1.0], [1.0, 2.0]], [-1.0, 1.0]).force.tolist()
    [0.5, 0.0]
    """
    M, p = np.atleast_2d(np.asarray(matrix, dtype=float)), np.asarray(offset, dtype=float)
    if M.shape != (p.size, p.size) or not (np.isfinite(M).all() and np.isfinite(p).all()):
        raise ModelError("contacts need a finite square matrix and as many offsets", found=f"{M.shape}, {p.shape}")
    if not (np.diag(M) > 0.0).all():
        raise ModelError("the matrix of contacts needs a positive diagonal", found=str(np.diag(M).min()))
    d = 1.0 / np.sqrt(np.diag(M)) if scale is None else np.asarray(scale, dtype=float)
    pushing = np.zeros(p.size, dtype=np.int64) if closed is None else np.array(closed, dtype=np.int64)
    force = np.zeros(p.size)
    if not p.size:
        return Contacts(force, pushing, 0, 0)
    passes, single = _block_pivoting(np.ascontiguousarray(d[:, None] * M * d), d * p, pushing, force)
    if passes < 0:
        raise ModelError("contacts have no solution to be found", remedy="every stiffness must be positive and finite")
    return Contacts(d * force, pushing, passes, single)


def violation(matrix: ArrayLike, offset: ArrayLike, force: ArrayLike, scale: ArrayLike | None = None) -> float:
    """Certificate of a solution: max |min(λ_i/d_i, d_i w_i)|, zero for an exact one; d as `scale`.

    It is told relative to the largest of the forces λ_i/d_i and overlaps −d_i p_i, whatever the open gaps are.

    >>> violation([[4.0]], [-2.0], [0.5]), violation([[4.0]], [-2.0], [0.0]), violation([[4.0]], [-2.0], [-0.5])
    (0.0, 1.0, 2.0)
    """
    M, p, found = (np.asarray(a, dtype=float) for a in (matrix, offset, force))
    d = 1.0 / np.sqrt(np.diag(M)) if scale is None else np.asarray(scale, dtype=float)
    worst = np.abs(np.minimum(found / d, d * (p + M @ found))).max(initial=0.0)
    size = max(np.abs(found / d).max(initial=0.0), (-d * p).max(initial=0.0))
    return float(worst / size) if size > 0.0 else float(worst)
