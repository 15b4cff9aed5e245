"""Floquet multipliers: how a small deviation from a periodic motion has grown after one period.

Between two crossings a piecewise-linear system is linear, and at a crossing its force is continuous, so a deviation
passes unchanged: the monodromy matrix is the product of the segments' propagators,

    Φ = Π exp(A_i τ_i),   det Φ = exp(−∫ tr(M⁻¹C) dt).

Each propagator is taken in the eigenbasis of its stages, and only the products V_after⁻¹ V_before stand between them.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.linear.exponential import exponential
from torsional.numerics.piecewise.basis import StageBases

TWO_PI = 2.0 * np.pi

Key = tuple[int, ...]


class _Tables(NamedTuple):
    """Bases and transitions that a batch of products needs, by running number."""

    matrices: Array
    decay: Array
    turn: Array
    plain: Array
    transitions: Array


@numba.njit(cache=True, error_model="numpy")
def _advance(x: Array, basis: int, time: float, tables: _Tables) -> Array:
    """exp(B t) x for one basis."""
    if tables.plain[basis]:
        grown: Array = exponential(tables.matrices[basis] * time) @ x
        return grown
    out = np.empty_like(x)
    for j in range(x.shape[0]):
        beta = tables.turn[basis, j]
        size, partner = np.exp(tables.decay[basis, j] * time), j
        if beta != 0.0:
            partner = j + 1 if beta > 0.0 else j - 1
        c, s = size * np.cos(beta * time), size * np.sin(beta * time)
        for i in range(x.shape[1]):
            out[j, i] = c * x[j, i] + s * x[partner, i]
    return out


@numba.njit(cache=True, error_model="numpy")
def _products(ends: IntArray, used: IntArray, turned: IntArray, times: Array, tables: _Tables) -> Array:
    """One product a point: segment s lasts ``times[s]`` in basis ``used[s]`` and ends with transition ``turned[s]``.

    A transition below zero is none.  ``ends`` are the points' last segments, plus one.
    """
    size = tables.decay.shape[1]
    out, start = np.empty((ends.size, size, size)), 0
    for point in range(ends.size):
        x = np.eye(size)
        for s in range(start, ends[point]):
            x = _advance(x, used[s], times[s], tables)
            if turned[s] >= 0:
                x = tables.transitions[turned[s]] @ x
        out[point], start = x, ends[point]
    return out


def _tables(bases: StageBases, combinations: dict[Key, int], changes: dict[tuple[Key, Key], int]) -> _Tables:
    listed = [bases.basis(key) for key in combinations]
    size = bases.coordinates.size
    transitions = [bases.transition(*pair) for pair in changes]
    return _Tables(
        np.array([basis.matrix for basis in listed]),
        np.array([basis.decay for basis in listed]),
        np.array([basis.turn for basis in listed]),
        np.array([basis.plain for basis in listed]),
        np.array(transitions).reshape(-1, size, size),
    )


def _chained(bases: StageBases, chains: Sequence[Sequence[tuple[Key, float]]], *, closed: bool) -> Array:
    """Products along chains of (stages, duration) in the bases of their ends; closed ones return to their first."""
    combinations: dict[Key, int] = {}
    changes: dict[tuple[Key, Key], int] = {}
    ends, used, turned, times = [], [], [], []
    for chain in chains:
        for i, (key, time) in enumerate(chain):
            used.append(combinations.setdefault(key, len(combinations)))
            times.append(time)
            following = chain[(i + 1) % len(chain)][0]
            last = i + 1 == len(chain) and not closed
            change = -1 if last or following == key else changes.setdefault((key, following), len(changes))
            turned.append(change)
        ends.append(len(used))
    tables = _tables(bases, combinations, changes)
    return np.asarray(_products(np.array(ends), np.array(used), np.array(turned), np.array(times, dtype=float), tables))


def _chain(times: ArrayLike, stages: ArrayLike, period: float) -> list[tuple[Key, float]]:
    """Segments (stages, duration) from the first crossing to its return, those without duration left out."""
    at = np.asarray(times, dtype=float).ravel()
    keys = [tuple(row) for row in np.atleast_2d(np.asarray(stages, dtype=np.int64)).tolist()]
    if len(keys) != max(at.size, 1) or np.any(np.diff(at) < 0.0) or (at.size and not at[-1] - at[0] <= period):
        raise ModelError("crossings must ascend within the period, each with the stages that follow it")
    durations = np.diff(at, append=at[0] + period) if at.size else np.array([period])
    return [(key, time) for key, time in zip(keys, durations.tolist(), strict=True) if time > 0.0]


def monodromy(bases: StageBases, times: ArrayLike, stages: ArrayLike, period: float) -> Array:
    """Monodromy matrix (size, size) of a periodic motion from t = 0 to ``period`` [s], in the states of ``bases``.

    ``times`` (s,): crossings of stages, ascending in [0, period); ``stages`` (s, m): stage numbers after each, the last
    ones to the first crossing of the next period; without crossings (1, m).  Φ = Π exp(A_i τ_i), exact.  Raises
    ModelError where times and stages do not fit.

    >>> bases = StageBases([[1.0]], [[0.0]], [[0.0]], [[1.0]], [[1.0]])
    >>> monodromy(bases, [], [[0]], np.pi / 2).round(12)
    array([[ 0.,  1.],
           [-1.,  0.]])
    """
    chain = _chain(times, stages, period)
    at = np.asarray(times, dtype=float).ravel()
    if at.size and at[0] > 0.0:
        key, time = chain[-1]
        chain = [(key, at[0]), *chain[:-1], (key, time - at[0])]
    product = _chained(bases, [chain], closed=False)[0]
    return np.asarray(bases.basis(chain[-1][0]).vectors @ product @ bases.basis(chain[0][0]).inverse)


def multipliers(
    bases: StageBases, times: Sequence[ArrayLike], stages: Sequence[ArrayLike], periods: ArrayLike
) -> ComplexArray:
    """Floquet multipliers (points, size) of periodic motions, by falling modulus.

    ``times`` and ``stages`` of each point as in `monodromy`, ``periods`` (points,) [s].  The ``coordinates.removed``
    multipliers +1 of rigid modes are not among them.

    >>> bases = StageBases([[1.0]], [[0.2]], [[0.0]], [[1.0]], [[1.0]])
    >>> abs(multipliers(bases, [[]], [[[0]]], [2.0])).round(6)
    array([[0.818731, 0.818731]])
    """
    given = np.broadcast_to(np.asarray(periods, dtype=float), len(times))
    chains = [_chain(t, s, period) for t, s, period in zip(times, stages, given.tolist(), strict=True)]
    return ordered(np.linalg.eigvals(_chained(bases, chains, closed=True))) if chains else np.zeros((0, 0), complex)


def ordered(values: ArrayLike) -> ComplexArray:
    """Multipliers (…, n) by falling modulus, the positive imaginary part of a pair first."""
    given = np.asarray(values, dtype=complex)
    size = np.abs(given)
    order = np.lexsort((-given.imag, -size), axis=-1)
    return np.take_along_axis(given, order, axis=-1)
