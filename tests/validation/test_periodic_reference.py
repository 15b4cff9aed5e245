"""The reference of the periodic tests against figures that others found by shooting and by five harmonic balances."""

from __future__ import annotations

import numpy as np
import pytest
from tests.validation import periodic_reference as reference
from tests.validation.periodic_reference import RPM, Case, Steady

# T_m, Ω, periods; mean, A1/2, A1, A3/2; exact piecewise solution with T_a = 1
TWO_STAGE = [
    (1.0, 3.00, 1, 0.9715228, 0.0, 0.1309417, 0.0),
    (1.0, 2.40, 1, 0.9504980, 0.0, 0.2274590, 0.0),
    (1.0, 2.41, 2, 0.8654713, 0.5336911, 0.2435232, 0.0076506),
    (1.2, 2.40, 1, 1.0785064, 0.0, 0.2463264, 0.0),
    (1.2, 2.57, 2, 1.0342741, 0.4399869, 0.2102095, 0.0049593),
]
# largest multipliers where they are known, to the digits known: real ones with their sign, a pair by its size
MULTIPLIERS = {(1.0, 2.40): (-1.33454, 5e-6), (1.2, 2.40): (-1.22914, 5e-6), (1.0, 2.41): (0.9010, 5e-5)}


@pytest.fixture(scope="module")
def truck() -> Case:
    return reference.dmf12()


@pytest.mark.parametrize("mean, speed, sub, steady, half, first, third", TWO_STAGE)
def test_two_stage_oscillator(
    mean: float, speed: float, sub: int, steady: float, half: float, first: float, third: float
) -> None:
    motion = reference.time_steady(reference.two_stage(mean, 1.0), speed, sub=sub)
    amplitudes = {float(order): abs(motion.at(order)) for order in motion.orders[:4]}
    expected = {0.0: steady, 1.0: first} | ({0.5: half, 1.5: third} if sub == 2 else {})
    assert {order: amplitudes[order] for order in expected} == pytest.approx(expected, abs=1e-7)
    if (mean, speed) in MULTIPLIERS:
        (known, digits), largest = MULTIPLIERS[mean, speed], motion.multipliers[0]
        assert (largest.real if known < 0 else abs(largest)) == pytest.approx(known, abs=digits)


def liouville(motion: Steady) -> float:
    """What the product of the multipliers must be: exp(−∫ tr M⁻¹C dt)."""
    case = motion.case
    return float(np.exp(-np.trace(np.linalg.solve(case.M, case.C)) * motion.period))


@pytest.mark.parametrize("case, speed", [(reference.two_stage(1.0, 1.0), 2.4), (reference.duffing_nlvib(), 1.4)])
def test_multipliers_two_ways(case: Case, speed: float) -> None:
    motion = reference.time_steady(case, speed)
    differences = reference.difference_multipliers(motion)
    np.testing.assert_allclose(np.sort_complex(differences), np.sort_complex(motion.multipliers), atol=1e-7)
    assert np.prod(motion.multipliers).real == pytest.approx(liouville(motion), rel=1e-10)


def test_doubled_motion_of_the_truck(truck: Case) -> None:
    motion = reference.time_steady(truck, 940 * RPM, sub=2)
    found = [motion.at(0).real, abs(motion.at(1.5)), abs(motion.at(3))]
    np.testing.assert_allclose(found, [0.083132186, 0.030240829, 0.016682064], atol=1.5e-9)
    assert np.prod(motion.multipliers).real == pytest.approx(liouville(motion), rel=1e-8)


@pytest.mark.parametrize("rpm, mean, third", [(911.66612, 0.08699948, 0.01456165), (985.27543, 0.08480922, 0.02379483)])
def test_period_doublings_of_the_truck(truck: Case, rpm: float, mean: float, third: float) -> None:
    """Nine harmonics and their sampling move the doubling by a few hundredths of a revolution per minute."""
    motion = reference.time_steady(truck, rpm * RPM)
    assert motion.at(0).real == pytest.approx(mean, abs=3e-7)
    assert abs(motion.at(3)) == pytest.approx(third, abs=3e-7)
    assert reference.flip_speed(truck, (rpm - 0.05) * RPM, (rpm + 0.05) * RPM) > 0  # a change of sign within 0.05


@pytest.mark.parametrize(
    "case, speed, amplitude",
    [
        (reference.duffing_nlvib(), 1.26960196, 2.82501671),
        (reference.duffing_nlvib(), 1.11570025, 1.08187032),
        (reference.duffing_skhippr(), 2.09598517, 1.47365213),
        (reference.duffing_skhippr(), 1.52738458, 0.55429749),
    ],
)
def test_folds_of_duffing_oscillators(case: Case, speed: float, amplitude: float) -> None:
    """Seven harmonics of these leave an error of some 1e-8."""
    found = reference.fold(case, speed, near(case, speed, amplitude))
    assert found.speed == pytest.approx(speed, abs=3e-8)
    assert abs(found.at(1)) == pytest.approx(amplitude, abs=2e-7)


def near(case: Case, speed: float, amplitude: float) -> np.ndarray:
    """State at time zero of one harmonic whose amplitude is known; the balance of power gives its phase."""
    delay = np.arcsin(min(1.0, case.C[0, 0] * speed * amplitude / case.loads[1][0]))
    phase = delay if speed**2 < case.K[0, 0] + 0.75 * case.laws[0].slope(amplitude, 0) / 3 else np.pi - delay
    return amplitude * np.array([np.cos(phase), speed * np.sin(phase)])


def test_one_sided_stop() -> None:
    case = reference.one_stop()
    found = reference.fold(case, 6.998, np.array([-10.0, 0.0]))
    assert (found.speed, abs(found.at(1))) == pytest.approx((6.998, 10.0), abs=2e-3)
    assert np.sort(found.multipliers.real)[-1] == pytest.approx(1.0, abs=1e-6)
