"""The reciprocating torque against its classical series and against quadrature in many digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from torsional.engine import SliderCrank

ORDERS = [1, 2, 3, 4]


def series(ratio: float) -> list[float]:
    """b_h of T = m r² Ω² Σ b_h sin hθ, the usual expansion in λ (Biezeno and Grammel), cut after λ⁶."""
    l = ratio
    return [
        l / 4 + l**3 / 16 + 15 * l**5 / 512,
        -(1 / 2 + l**4 / 32 + l**6 / 32),
        -(3 * l / 4 + 9 * l**3 / 32 + 81 * l**5 / 512),
        -(l**2 / 4 + l**4 / 8 + l**6 / 16),
    ]


def sine_parts(crank: SliderCrank) -> np.ndarray:
    return -crank.reciprocating_harmonics(1.0, ORDERS).imag / crank.crank_radius**2


def test_published_numbers_at_a_quarter() -> None:
    found = sine_parts(SliderCrank(0.08, 0.32))
    assert found == pytest.approx([0.063506, -0.500130, -0.192056, -0.016129], abs=6e-7)


@pytest.mark.parametrize("ratio", [0.02, 0.1, 0.2])
def test_series_in_the_crank_ratio(ratio: float) -> None:
    assert sine_parts(SliderCrank(0.05, 0.05 / ratio)) == pytest.approx(series(ratio), abs=0.3 * ratio**7 + 1e-15)


def test_quadrature_in_thirty_digits() -> None:
    mpmath.mp.dps = 30
    lam = mpmath.mpf("0.31")

    def position(t: mpmath.mpf) -> mpmath.mpf:
        return 1 + 1 / lam - mpmath.cos(t) - mpmath.sqrt(1 / lam**2 - mpmath.sin(t) ** 2)

    def twice_energy(t: mpmath.mpf) -> mpmath.mpf:
        return mpmath.diff(position, t) ** 2

    # T = -d(x'^2/2)/dθ at constant speed; integrated by parts against sin hθ
    expected = [
        float(
            mpmath.quad(
                lambda t, h=h: h * mpmath.cos(h * t) * twice_energy(t) / 2, mpmath.linspace(0, 2 * mpmath.pi, 9)
            )
            / mpmath.pi
        )
        for h in ORDERS
    ]
    assert sine_parts(SliderCrank(0.31, 1.0)) == pytest.approx(expected, abs=1e-13)


def test_no_mean_no_half_orders_no_cosines() -> None:
    crank = SliderCrank(0.079, 0.2675)
    assert np.abs(crank.reciprocating_harmonics(4.2, [0, 0.5, 1.5, 2.5])).max() < 1e-16
    assert np.abs(crank.reciprocating_harmonics(4.2, ORDERS).real).max() < 1e-15


def test_torque_is_the_loss_of_kinetic_energy() -> None:
    crank, mass, speed = SliderCrank(0.079, 0.2675, 0.012), 4.2, 130.0
    ends = np.array([0.3, 2.9])
    angle = np.linspace(*ends, 200_001)
    work = np.trapezoid(crank.reciprocating_torque(mass, speed, angle), angle)
    kinetic = 0.5 * mass * (crank.velocity_ratio(ends) * speed) ** 2
    assert work == pytest.approx(kinetic[0] - kinetic[1], rel=1e-9)
