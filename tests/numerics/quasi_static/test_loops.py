"""What loops amount to, against closed forms: ellipses, spring and slider, straight lines."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.laws import Jenkins
from torsional.numerics.quasi_static.loops import (
    half_swing,
    harmonic_stiffness,
    loss_factor,
    loss_per_cycle,
    secant_stiffness,
)

AMPLITUDE, STIFFNESS = 0.2, 1500.0
PHASE = 2 * np.pi * np.arange(4000) / 4000


@pytest.mark.parametrize("damping", [0.0, 3.0, 40.0])
def test_viscous_ellipse(damping: float) -> None:
    """k φ + c φ̇ at the circular frequency ω loses π c ω A²; its loss factor is c ω/k."""
    omega = 7.0
    angle = AMPLITUDE * np.cos(PHASE)
    torque = STIFFNESS * angle - damping * omega * AMPLITUDE * np.sin(PHASE)
    loss = loss_per_cycle(angle, torque)
    assert loss == pytest.approx(np.pi * damping * omega * AMPLITUDE**2, rel=1e-6)
    assert secant_stiffness(angle, torque) == pytest.approx(STIFFNESS, rel=1e-12)
    assert harmonic_stiffness(angle, torque) == pytest.approx(STIFFNESS, rel=1e-6)
    assert loss_factor(loss, STIFFNESS, half_swing(angle)) == pytest.approx(damping * omega / STIFFNESS, rel=1e-6)


def jenkins(limit: float, stiffness: float) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the loop of a spring and slider, wherever the slider is: two straight lines each way."""
    turn = 2 * limit / stiffness
    angle = np.array([-AMPLITUDE, -AMPLITUDE + turn, AMPLITUDE, AMPLITUDE - turn])
    return angle, np.array([-limit, limit, limit, -limit])


def test_spring_and_slider() -> None:
    """Four points are enough: all figures are exact for straight lines (Iwan's harmonics of the bilinear element)."""
    limit, stiffness = 60.0, 1000.0
    angle, torque = jenkins(limit, stiffness)
    assert loss_per_cycle(angle, torque) == pytest.approx(4 * limit * (AMPLITUDE - limit / stiffness), rel=1e-12)
    assert secant_stiffness(angle, torque) == pytest.approx(limit / AMPLITUDE, rel=1e-12)
    theta = np.arccos(1 - 2 * limit / (stiffness * AMPLITUDE))
    expected = stiffness / np.pi * (theta - 0.5 * np.sin(2 * theta))  # Caughey, J. Appl. Mech. 27 (1960) 640
    assert harmonic_stiffness(angle, torque) == pytest.approx(expected, rel=1e-12)
    expected = 4 / np.pi * (1 - limit / (stiffness * AMPLITUDE))
    found = loss_factor(loss_per_cycle(angle, torque), secant_stiffness(angle, torque), half_swing(angle))
    assert found == pytest.approx(expected, rel=1e-12)


def test_a_law_marched_gives_the_same_loop() -> None:
    limit, stiffness = 60.0, 1000.0
    angle = AMPLITUDE * np.cos(np.append(PHASE, PHASE))
    torque = Jenkins(limit, stiffness).march(angle, 1e-3)[0]
    last = slice(PHASE.size, None)
    corners = jenkins(limit, stiffness)
    assert loss_per_cycle(angle[last], torque[last]) == pytest.approx(loss_per_cycle(*corners), rel=2e-4)
    assert harmonic_stiffness(angle[last], torque[last]) == pytest.approx(harmonic_stiffness(*corners), rel=2e-4)


def test_where_a_loop_begins_and_its_mean_do_not_matter() -> None:
    """Beside a mean the cosine's angle at the ends of the loop has half the digits."""
    angle, torque = jenkins(60.0, 1000.0)
    for shift in range(4):
        moved = np.roll(angle, shift) + 0.7, np.roll(torque, shift) + 300.0
        for figure in (loss_per_cycle, secant_stiffness, harmonic_stiffness):
            assert figure(*moved) == pytest.approx(figure(angle, torque), rel=1e-6)


def test_many_loops_at_once() -> None:
    angle, torque = jenkins(60.0, 1000.0)
    both = np.stack([torque, 2 * torque])
    for figure in (loss_per_cycle, secant_stiffness, harmonic_stiffness):
        assert figure(angle, both) == pytest.approx(np.array([1, 2]) * figure(angle, torque))
