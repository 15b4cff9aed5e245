"""What drives a time step against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from tests.numerics.motion.packed import packed_levels, packed_profiles, periodic_profile

from torsional.engine import SliderCrank
from torsional.errors import ModelError
from torsional.numerics.motion.data import Driven, Governed, rows_of
from torsional.numerics.motion.sources import (
    crank_terms,
    frame_at,
    govern,
    level_at,
    source_torques,
)
from torsional.numerics.motion.tables import Outside, tables_of

TWO_PI = 2.0 * np.pi
NONE = np.zeros(0)


def ints(values: list[int]) -> np.ndarray:
    return np.array(values, dtype=np.int64)


def driven(
    rows: list[list[float]],
    *,
    levels: list[tuple[list[float], list[float]]],
    profiles: list[tuple[np.ndarray, float]],
    level_of: list[int],
    profile_of: list[int],
    multiple: list[float],
    phase: list[float],
    feedback: list[float],
    cranks: tuple[list[list[float]], list[list[float]]] = ([], []),
) -> Driven:
    """Cranks: their rows, and of each multiple, phase, mass, radius, rod, offset, included."""
    crank_rows = rows_of(np.reshape(np.array(cranks[0], dtype=float), (len(cranks[0]), len(rows[0]))))
    values = np.array(cranks[1], dtype=float).reshape(-1, 7).T.copy()
    profile_start, profile, period = packed_profiles(profiles)
    level_start, time, value = packed_levels(levels)
    listed = (np.array(v, dtype=float) for v in (multiple, phase, feedback))
    return Driven(
        *(rows_of(np.array(rows)), *listed, ints(profile_of), profile_start, profile, period),
        *(ints(level_of), level_start, time, value, crank_rows, *values),
    )


def outside(source: Driven, governor: Governed | None = None) -> Outside:
    """The tables of sources and governors in a frame that stands."""
    nobody = rows_of(np.zeros((0, 1)))
    none = Governed(nobody, nobody, ints([]), NONE, NONE, NONE, NONE, ints([0]), ints([]))
    return tables_of(source, governor or none, rows_of(np.ones((1, 1))), np.inf, (np.zeros(1), np.zeros(1)))


# --- levels and the frame --------------------------------------------------------------------------------------------


def test_a_level_is_linear_between_knots_constant_beyond_and_may_jump() -> None:
    start, time, value = packed_levels([(0.0, 7.0), ([1.0, 2.0, 2.0, 4.0], [0.0, 10.0, -4.0, 0.0])])
    times = [0.0, 1.0, 1.25, 2.0 - 1e-12, 2.0, 3.0, 4.0, 9.0]
    knots = np.array([time, value])
    found = [level_at(start, knots, 1, t) for t in times]
    np.testing.assert_allclose(found, [0.0, 0.0, 2.5, 10.0, -4.0, -2.0, 0.0, 0.0], atol=1e-10)
    assert [level_at(start, knots, p, 3.3) for p in (0, -1)] == [7.0, 1.0]
    with pytest.raises(ModelError, match="rising times"):
        packed_levels([([1.0, 0.0], [0.0, 0.0])])


@pytest.mark.parametrize("first", [0.0, -2.0, 1.5])
def test_the_frames_angle_is_the_integral_of_its_speed(first: float) -> None:
    """Against quadrature, before the first knot, within and beyond the last."""
    time, value = first + np.array([0.0, 0.5, 0.5, 3.0]), np.array([10.0, 30.0, 20.0, -5.0])
    knots = np.array([time, value])
    for t in (-4.0, 0.0, 0.3, 1.2, 2.9, 7.0):
        speed, angle = frame_at(knots, 0, t)
        assert speed == pytest.approx(np.interp(t, time, value), rel=1e-14)
        expected = quad(lambda s: frame_at(knots, 0, s)[0], 0.0, t, points=sorted(time), limit=200)[0]
        assert angle == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_the_frames_angle_keeps_its_digits() -> None:
    assert frame_at(np.array([[0.0], [150.0]]), 0, 1e4) == (150.0, 1.5e6)
    assert frame_at(np.array([[7.0, 0.0, 10.0], [9.0, 0.0, 200.0]]), 1, 10.0) == (200.0, 1000.0)


# --- profiles --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [3, 4, 7, 64])
def test_a_profile_is_the_periodic_spline(count: int) -> None:
    """scipy's periodic spline, another solver of the same equations."""
    y = np.random.default_rng(count).normal(size=count)
    spline = CubicSpline(np.arange(count + 1), np.append(y, y[0]), bc_type="periodic")
    np.testing.assert_allclose(periodic_profile(y), spline.c[::-1].T, atol=3e-14)


def test_profiles_converge_with_the_fourth_power() -> None:
    """Within the bound 5/384 h⁴ max |f⁗| of cubic splines; of exp(sin) that is 4e."""
    miss = []
    for count in (36, 72):
        samples = np.exp(np.sin(TWO_PI * np.arange(count) / count))
        source = outside(driven([[1.0]], levels=[], profiles=[(samples, 2.0)], level_of=[-1], profile_of=[0],
                        multiple=[1.0], phase=[0.0], feedback=[0.0]))  # fmt: skip
        angles, out = np.linspace(-30.0, 30.0, 999), np.zeros(1)
        found = np.empty(angles.size)
        for i, angle in enumerate(angles):
            source_torques(source, 0.0, angle, np.zeros(1), np.zeros(1), out)
            found[i] = out[0]
        miss.append(np.abs(found - np.exp(np.sin(0.5 * angles))).max())
        assert miss[-1] < 5.0 / 384.0 * (TWO_PI / count) ** 4 * 4.0 * np.e
    assert np.log2(miss[0] / miss[1]) == pytest.approx(4.0, abs=0.3)


def test_what_is_no_profile_is_refused() -> None:
    for values in ([1.0, 2.0], [[1.0, 2.0, 3.0]], [1.0, np.nan, 2.0]):
        with pytest.raises(ModelError, match="finite samples"):
            periodic_profile(values)
    with pytest.raises(ModelError, match="period must be positive"):
        packed_profiles([([1.0, 2.0, 3.0], 0.0)])


# --- sources ---------------------------------------------------------------------------------------------------------

SAMPLES = np.cos(TWO_PI * np.arange(720) / 720)


def two_sources() -> Driven:
    """Order 1.5 at a node of twice the reference's speed that moves its own events, and a plain level."""
    return driven(
        [[2.0, 0.0], [0.0, 1.0]],
        levels=[([0.0, 2.0], [0.0, 100.0]), ([0.0], [-30.0])],
        profiles=[(SAMPLES, 1.0 / 1.5)],
        level_of=[0, 1], profile_of=[0, -1], multiple=[2.0, 1.0], phase=[0.3, 0.0], feedback=[0.5, 0.0],
    )  # fmt: skip


def test_torque_follows_time_angle_and_the_parts_own_motion() -> None:
    q, extra, out = np.array([0.11, 5.0]), np.array([8.0, 0.5]), np.zeros(2)
    for t, frame in ((0.4, 3.0), (1.9, 1234.5)):
        source_torques(outside(two_sources()), t, frame, q, extra, out)
        angle = 2.0 * frame + 2.0 * q[0] + 0.3
        assert out[0] == pytest.approx((50.0 * t + 8.0) * np.cos(1.5 * angle), abs=3e-8)
        assert out[1] == -29.5


@pytest.mark.parametrize("offset", [0.0, 0.01])
def test_a_crank_follows_lagrange(offset: float) -> None:
    """constant − inertia θ̈ against d/dt of ½ m x'² θ̇² by finite differences of the same crank in Python."""
    crank = SliderCrank(0.079, 0.2675, offset)
    mass, included, multiple, phase = 3.0, 0.5 * 3.0 * 0.079**2, 1.5, 2.0
    made = driven([[0.0]], levels=[], profiles=[], level_of=[-1], profile_of=[-1], multiple=[1.0], phase=[0.0],
                  feedback=[0.0], cranks=([[multiple]], [[multiple, phase, mass, 0.079, 0.2675, offset, included]]),
                  )  # fmt: skip
    constant, inertia = np.zeros(1), np.zeros(1)
    q, v, acceleration, frame_speed = np.array([0.2]), np.array([7.0]), 900.0, 150.0
    crank_terms(outside(made), 11.0, frame_speed, q, v, constant, inertia)
    angle, rate = multiple * (11.0 + 0.2) + phase, multiple * (frame_speed + 7.0)
    turned = multiple * acceleration
    expected = float(crank.reciprocating_torque(mass, rate, angle, turned)) + included * turned
    assert constant[0] - inertia[0] * turned == pytest.approx(expected, rel=1e-12)
    h = 1e-5  # −d/dt(m x'² θ̇) + ½ m (x'²)' θ̇²
    x1 = (crank.inertia(mass, angle + h) - crank.inertia(mass, angle - h)) / (2 * h)
    lagrange = -x1 * rate**2 - crank.inertia(mass, angle) * turned + 0.5 * x1 * rate**2
    assert constant[0] - (inertia[0] + included) * turned == pytest.approx(float(lagrange), rel=1e-7)


# --- governors -------------------------------------------------------------------------------------------------------


def governor(sources: list[int], *, limit: float = 50.0) -> Governed:
    one = np.ones(1)
    act = rows_of(np.array([[0.0, 0.0]] if sources else [[1.0, 0.0]]))
    return Governed(rows_of(np.array([[1.0, 0.0]])), act, ints([1]), 4.0 * one, 10.0 * one, -limit * one,
                    limit * one, ints([0, len(sources)]), ints(sources))  # fmt: skip


def test_a_governor_is_proportional_and_integral_and_may_add_to_levels() -> None:
    source, integral, torque, extra = two_sources(), np.zeros(1), np.zeros(1), np.zeros(2)
    for expected in (4.0 * 2.0, 4.0 * 2.0 + 0.2, 4.0 * 2.0 + 0.4):  # level −30, speed −32: an error of 2
        govern(outside(source, governor([0])), 1.0, 0.01, 100.0, np.array([-132.0, 9.0]), integral, torque, extra)
        assert torque[0] == pytest.approx(expected, rel=1e-13)
        assert extra.tolist() == [torque[0], 0.0]
    govern(outside(source, governor([])), 1.0, 0.0, 100.0, np.array([-132.0, 9.0]), integral, torque, extra)
    assert extra.tolist() == [0.0, 0.0] and integral[0] == pytest.approx(0.6)


def test_a_governor_at_its_limit_does_not_wind_up() -> None:
    source, integral, torque, extra = two_sources(), np.array([20.0]), np.zeros(1), np.zeros(2)
    for _ in range(100):
        govern(outside(source, governor([])), 1.0, 0.1, 0.0, np.array([-60.0, 0.0]), integral, torque, extra)
    assert torque[0] == 50.0 and integral[0] == 20.0
    govern(outside(source, governor([])), 1.0, 0.1, 0.0, np.array([-29.0, 0.0]), integral, torque, extra)
    assert torque[0] == pytest.approx(16.0) and integral[0] == pytest.approx(19.0)
