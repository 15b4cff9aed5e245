"""Polynomials and curves through points, against numpy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from torsional.errors import ModelError
from torsional.laws import Hinges, Polynomial, Table

rising = st.lists(st.tuples(st.floats(1e-3, 0.2), st.floats(0.0, 500.0)), min_size=1, max_size=8).map(
    lambda rows: tuple(
        (float(x), float(y))
        for x, y in zip(
            np.cumsum([-0.3, *(dx for dx, _ in rows)]), np.cumsum([-200.0, *(dy for _, dy in rows)]), strict=True
        )
    )
)


@given(st.lists(st.floats(-1e4, 1e4), min_size=1, max_size=6), st.floats(-0.5, 0.5))
def test_polynomial_beside_numpy(coefficients: list[float], angle: float) -> None:
    law = Polynomial(tuple(coefficients))
    curve = np.polynomial.Polynomial([0.0, *coefficients])
    assert float(law.torque(angle)) == pytest.approx(curve(angle), rel=1e-12, abs=1e-9)
    assert float(law.tangent(angle)) == pytest.approx(curve.deriv()(angle), rel=1e-12, abs=1e-9)


@given(rising, st.floats(0.0, 1.0))
def test_table_beside_scipy_inside_and_straight_outside(points: tuple[tuple[float, float], ...], at: float) -> None:
    law, (x, y) = Table(points), np.array(points).T
    inside = x[0] + at * (x[-1] - x[0])
    if len(points) > 2:
        curve = PchipInterpolator(x, y)
        assert float(law.torque(inside)) == pytest.approx(float(curve(inside)), abs=1e-9 * abs(y).max())
        assert float(law.tangent(inside)) == pytest.approx(float(curve.derivative()(inside)), rel=1e-6, abs=1e-5)
    slope = float(law.tangent(x[-1]))
    assert float(law.torque(x[-1] + 0.5)) == pytest.approx(y[-1] + 0.5 * slope, rel=1e-12, abs=1e-9)
    assert (np.diff(law.torque(np.linspace(x[0] - 0.1, x[-1] + 0.1, 500))) >= -1e-9).all()


@given(rising, st.floats(-0.6, 1.0))
def test_lines_through_points(points: tuple[tuple[float, float], ...], angle: float) -> None:
    """The points moved so that the lines pass through the origin, against numpy's lines and straight on outside."""
    x, y = np.array(points).T
    y = y - np.interp(0.0, x, y) if x[-1] >= 0 else y - y[-1] + (y[-1] - y[-2]) / (x[-1] - x[-2]) * x[-1]
    law = Hinges.through(list(zip(x.tolist(), y.tolist(), strict=True)))
    ends = [(y[1] - y[0]) / (x[1] - x[0]), (y[-1] - y[-2]) / (x[-1] - x[-2])]
    expected = np.interp(angle, x, y) + ends[0] * min(angle - x[0], 0.0) + ends[1] * max(angle - x[-1], 0.0)
    assert float(law.torque(angle)) == pytest.approx(expected, abs=1e-9 * max(abs(y).max(), max(ends), 1.0))


def test_lines_along_one_line_have_no_hinges() -> None:
    law = Hinges.through([(x, 3e3 * x) for x in (-0.3, -0.1, 0.1, 0.7)])
    assert (law.stiffness, law.gaps) == (pytest.approx(3e3, rel=1e-14), ())


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([(0.0, 0.0)], "two points or more"),
        ([(0.0, 0.0), (0.1, float("nan"))], "each a finite number is wanted"),
        ([(0.0, 0.0), (0.1, 10.0), (0.1, 20.0)], "rising angles"),
        ([(0.0, 0.0), (0.1, 10.0), (0.2, 9.0)], "torques that do not fall"),
    ],
)
def test_points_refused(points: list[tuple[float, float]], said: str) -> None:
    for make in (Hinges.through, Table):
        with pytest.raises(ModelError, match=said):
            make(tuple(points))


def test_lines_that_miss_the_origin_are_refused() -> None:
    with pytest.raises(ModelError, match="miss the point"):
        Hinges.through([(-0.1, 5.0), (0.1, 20.0)])


@pytest.mark.parametrize("coefficients", [(), (float("inf"),), ((1.0, 2.0),), (float("nan"), 1.0)])
def test_coefficients_refused(coefficients: tuple[float, ...]) -> None:
    with pytest.raises(ModelError, match=r"coefficients: a (polynomial has finite|list, each a finite)"):
        Polynomial(coefficients)
