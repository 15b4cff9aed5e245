"""Small dense equations, of real and of complex numbers, against LAPACK."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from torsional.numerics.linear.small import complex_solve, solve

SOLVERS = [(solve, 0.0), (complex_solve, 1j)]


@pytest.mark.parametrize(("compiled", "turned"), SOLVERS)
def test_columns_are_those_of_dense_algebra(compiled: Callable[..., None], turned: complex) -> None:
    draw = np.random.default_rng(3)
    for n in (1, 5, 24):
        a, b = (draw.normal(size=(n, m)) + turned * draw.normal(size=(n, m)) for m in (n, 3))
        a[0, 0] = 0.0 if n > 1 else 2.0  # rows must change places
        expected = np.linalg.solve(a, b)
        compiled(a, b)
        np.testing.assert_allclose(b, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize(("compiled", "turned"), SOLVERS)
def test_a_singular_matrix_has_no_solution(compiled: Callable[..., None], turned: complex) -> None:
    a, b = np.array([[1.0, 2.0], [2.0, 4.0]]) + 0 * turned, np.ones((2, 2)) + 0 * turned
    compiled(a, b)
    assert np.isnan(b).all()
