"""A pendulum's path: its closed forms against quadrature, and its equations against those of a mass point."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import ellipk

from torsional.numerics.motion.pendulum_path import path_at, pendulum_terms, weight_terms

ORDER, DISTANCE = 3.0, 0.1 * (1 + 1 / 9)
RHO = DISTANCE / (1 + ORDER**2)
TAUTOCHRONE = ORDER / math.sqrt(1 + ORDER**2)
PATHS = {"circle": 0.0, "nearly a circle": 1e-3, "half": 0.5, "tautochrone": TAUTOCHRONE, "cycloid": 1.0}


@pytest.mark.parametrize("lam", PATHS.values(), ids=PATHS)
@pytest.mark.parametrize("share", [-0.7, 1e-7, 0.3, 0.9])
def test_position_is_the_integral_of_the_direction(lam: float, share: float) -> None:
    arc = share * RHO

    def direction(s: float) -> float:
        return s / RHO if lam == 0 else math.asin(lam * s / RHO) / lam

    x, y, cosine, sine, curvature = path_at(RHO, lam, DISTANCE, arc)
    assert x == pytest.approx(quad(lambda s: math.cos(direction(s)), 0, arc, epsabs=1e-16)[0], rel=1e-11)
    assert DISTANCE - y == pytest.approx(quad(lambda s: math.sin(direction(s)), 0, arc, epsabs=1e-16)[0], abs=1e-15)
    assert math.hypot(cosine, sine) == pytest.approx(1.0, abs=1e-15)
    assert curvature == pytest.approx(1 / math.sqrt(RHO**2 - (lam * arc) ** 2), rel=1e-12)


def test_tautochrone_has_its_squared_distance() -> None:
    """R² = c² − n² s², G² = R² − (R R')²."""
    for arc in np.linspace(-0.9, 0.9, 7) * DISTANCE / (ORDER * math.sqrt(1 + ORDER**2)):
        squared, lever, _, along = pendulum_terms(RHO, TAUTOCHRONE, DISTANCE, arc, 0.0, 1.0)
        assert squared == pytest.approx(DISTANCE**2 - ORDER**2 * arc**2, rel=1e-13)
        assert along == pytest.approx(ORDER**2 * arc, rel=1e-9, abs=1e-15)
        assert lever**2 == pytest.approx(squared - (ORDER**2 * arc) ** 2, rel=1e-12)


@pytest.mark.parametrize("lam", PATHS.values(), ids=PATHS)
def test_accelerations_are_those_of_a_mass_point(lam: float) -> None:
    """The virtual work of m r̈ along both coordinates, r(θ, s) differentiated numerically, with weight."""
    angle, turning, spin = 0.7, 31.0, 11.0
    arc, rate, slip = 0.6 * RHO, 0.9, -4.0

    def place(theta: float, s: float) -> np.ndarray:
        x, y, *_ = path_at(RHO, lam, DISTANCE, s)
        return np.array([y * math.sin(theta) + x * math.cos(theta), y * math.cos(theta) - x * math.sin(theta)])

    def at(t: float) -> np.ndarray:
        return place(angle + turning * t + 0.5 * spin * t * t, arc + rate * t + 0.5 * slip * t * t)

    h, e = 1e-5, 1e-6
    acceleration = (at(h) - 2 * at(0) + at(-h)) / h**2 + np.array([0.0, 9.81])
    by_angle = (place(angle + e, arc) - place(angle - e, arc)) / (2 * e)
    by_arc = (place(angle, arc + e * RHO) - place(angle, arc - e * RHO)) / (2 * e * RHO)
    squared, lever, on_carrier, along = pendulum_terms(RHO, lam, DISTANCE, arc, rate, turning)
    weight = weight_terms(RHO, lam, DISTANCE, arc, angle, 9.81)
    # weight_terms exerts, so it stands on the other side
    assert squared * spin + lever * slip + on_carrier - weight[0] == pytest.approx(acceleration @ by_angle, rel=1e-5)
    assert slip + lever * spin + along - weight[1] == pytest.approx(acceleration @ by_arc, rel=1e-5)


def test_detuning_of_a_circle() -> None:
    """n(φ0)/n0 = π/(2 K(sin²(φ0/2))) at constant speed, by integration: .98288908 at 30°."""
    turning, start = 100.0, math.radians(30.0)

    def slope(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -pendulum_terms(RHO, 0.0, DISTANCE, y[0], y[1], turning)[3]]

    def crossing(_: float, y: np.ndarray) -> float:
        return y[0]

    crossing.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(slope, (0, 1), [RHO * start, 0.0], events=crossing, rtol=1e-12, atol=1e-15, method="DOP853")
    order = math.pi / 2 / (turning * found.t_events[0][0])
    assert order / ORDER == pytest.approx(math.pi / (2 * ellipk(math.sin(start / 2) ** 2)), rel=1e-9)
    assert order / ORDER == pytest.approx(0.98288908, abs=2e-8)
