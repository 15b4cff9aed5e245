from __future__ import annotations

import numpy as np
import pytest

from torsional.engine import SliderCrank
from torsional.errors import ModelError

CRANKS = [SliderCrank(0.079, 0.2675), SliderCrank(0.079, 0.2675, 0.01), SliderCrank(0.04, 0.09, -0.02)]
ANGLE = np.linspace(0.0, 4 * np.pi, 97)


@pytest.mark.parametrize("crank", CRANKS)
def test_rod_keeps_its_length(crank: SliderCrank) -> None:
    r, l, e = crank.crank_radius, crank.rod_length, crank.pin_offset
    turned = ANGLE + np.arcsin(e / (r + l))
    pin_height = np.sqrt((r + l) ** 2 - e**2) - crank.position(ANGLE)
    rod = np.hypot(pin_height - r * np.cos(turned), e - r * np.sin(turned))
    assert rod == pytest.approx(np.full_like(rod, l), rel=1e-14)


@pytest.mark.parametrize("crank", CRANKS)
def test_derivatives_by_finite_differences(crank: SliderCrank) -> None:
    h = 1e-5
    first = (crank.position(ANGLE + h) - crank.position(ANGLE - h)) / (2 * h)
    second = (crank.velocity_ratio(ANGLE + h) - crank.velocity_ratio(ANGLE - h)) / (2 * h)
    assert crank.velocity_ratio(ANGLE) == pytest.approx(first, abs=1e-11)
    assert crank.acceleration_ratio(ANGLE) == pytest.approx(second, abs=1e-11)


@pytest.mark.parametrize("crank", CRANKS)
def test_dead_centres(crank: SliderCrank) -> None:
    ends = np.array([0.0, crank.bottom_dead_centre])
    assert crank.velocity_ratio(ends) == pytest.approx([0, 0], abs=1e-16)
    assert crank.position(ends) == pytest.approx([0, crank.stroke], abs=1e-15)
    assert crank.position(ANGLE).min() > -1e-15
    assert crank.velocity_ratio(0.1) > 0  # the piston goes down after top dead centre


def test_half_share_is_the_mean_inertia_of_a_long_rod() -> None:
    crank = SliderCrank(0.08, 80.0)
    mean = crank.inertia(3.0, ANGLE[:-1]).mean()
    assert crank.half_share(3.0) == pytest.approx(mean, rel=1e-6)
    assert crank.half_share(3.0) == pytest.approx(0.0096)


def test_acceleration_torque_is_that_of_the_inertia() -> None:
    crank = CRANKS[1]
    extra = crank.reciprocating_torque(2.0, 50.0, ANGLE, 7.0) - crank.reciprocating_torque(2.0, 50.0, ANGLE)
    assert extra == pytest.approx(-7.0 * crank.inertia(2.0, ANGLE), abs=1e-12)


@pytest.mark.parametrize(
    ("lengths", "where"),
    [
        ((0.0, 1.0), "crank_radius"),
        ((1.0, float("nan")), "rod_length"),
        ((0.1, 0.12, 0.03), "rod_length"),
        ((0.1, 0.3, "x"), "pin_offset"),
    ],
)
def test_refused(lengths: tuple, where: str) -> None:
    with pytest.raises(ModelError) as caught:
        SliderCrank(*lengths)
    assert caught.value.where == where
