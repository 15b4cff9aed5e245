"""LDLᵀ over a static pattern against dense algebra, and the order it takes nodes out in."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.numerics.arrays import Array
from torsional.numerics.linear.sparse_factor import Tape, elimination, factor, substitute, tape_of

CHANNEL = [{0, 1}, {1, 2}, {2, 3}]


def filled(tape: Tape, matrix: Array) -> Array:
    """The flat values of a dense matrix."""
    return np.append(np.diag(matrix)[tape.node], matrix[tuple(tape.node[tape.couplings])])


def solved(tape: Tape, matrix: Array, load: Array) -> tuple[bool, Array]:
    lower, inverse = np.empty(tape.couplings.shape[1]), np.empty(len(matrix))
    definite = factor(tape, filled(tape, matrix), lower, inverse)
    x, out = load[tape.node], np.empty(len(matrix))
    substitute(tape.couplings, lower, inverse, x)
    out[tape.node] = x
    return definite, out


def random_case(seed: int) -> tuple[list[set[int]], Array]:
    """Supports of up to four coordinates and a positive definite matrix over them."""
    draw = np.random.default_rng(seed)
    n = int(draw.integers(1, 25))
    supports = [set(draw.choice(n, min(n, int(draw.integers(1, 5))), replace=False).tolist()) for _ in range(2 * n)]
    matrix = np.diag(draw.uniform(1e-4, 1.0, n))
    for support in supports:
        w = np.zeros(n)
        w[list(support)] = draw.normal(size=len(support))
        matrix += 10.0 ** draw.uniform(-3, 4) * np.outer(w, w)
    return supports, matrix


@pytest.mark.parametrize("seed", range(20))
def test_solution_is_that_of_dense_algebra(seed: int) -> None:
    supports, matrix = random_case(seed)
    load = np.random.default_rng(seed).normal(size=len(matrix))
    definite, x = solved(tape_of(supports, len(matrix)), matrix, load)
    assert definite
    assert np.abs(matrix @ x - load).max() <= 1e-13 * np.abs(matrix).max() * np.abs(x).max()
    np.testing.assert_allclose(x, np.linalg.solve(matrix, load), rtol=1e-6)


def test_a_matrix_that_is_not_positive_definite_is_told() -> None:
    assert not solved(tape_of([{0, 1}], 2), np.array([[1.0, 2.0], [2.0, 1.0]]), np.ones(2))[0]
    assert not solved(tape_of([], 2), np.diag([1.0, 0.0]), np.ones(2))[0]


def two_channels() -> list[set[int]]:
    """Bodies 0 to 3, then two channels of seven shoes that slide between bodies 0 and 1."""
    supports = [{0, 1}, {1, 2}, {2, 3}]
    for first in (4, 11):
        shoes = range(first, first + 7)
        supports += [{b, 0} for b in shoes] + [{b, b + 1} for b in shoes[:-1]]
        supports += [{shoes[0], 1}, {shoes[-1], 1}]
    return supports


def test_shoes_come_first_and_bodies_last() -> None:
    order = elimination(two_channels(), 18)
    assert {node for node, _, _ in order[-2:]} == {0, 1}
    assert max(level for _, level, _ in order) <= 8, "neighbours queue up"
    assert sum(len(left) for _, _, left in order) <= 46


def test_a_coordinate_on_its_own_is_divided_by_its_entry() -> None:
    matrix = np.diag([3.0, 3.0, 3.0, 3.0, 8.0])
    for i in range(3):
        matrix[i, i + 1] = matrix[i + 1, i] = -1.0
    definite, found = solved(tape_of(CHANNEL, 5), matrix, np.array([1.0, 2.0, -1.0, 0.5, 4.0]))
    assert definite and found[4] == 0.5
    np.testing.assert_allclose(matrix @ found, [1.0, 2.0, -1.0, 0.5, 4.0], atol=1e-14)
