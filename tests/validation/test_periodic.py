"""Branches of periodic motion against published figures, closed forms and integration in time."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from scipy.special import ellipk
from tests.solvers.periodic.machines import (
    TWO_STAGES,
    Machine,
    bifurcations,
    dmf12,
    oscillator,
    picked,
    respond,
    rpm,
    stop_machine,
)
from tests.validation import periodic_reference as reference
from tests.validation.periodic_reference import RPM, Cubic, Stages

# T_m, Ω, whether doubled; mean, A1/2, A1, A3/2 by the exact piecewise solution, T_a = 1
TWO_STAGE = [
    (1.0, 3.00, False, 0.9715228, 0.0, 0.1309417, 0.0),
    (1.0, 2.40, False, 0.9504980, 0.0, 0.2274590, 0.0),
    (1.0, 2.41, True, 0.8654713, 0.5336911, 0.2435232, 0.0076506),
    (1.2, 2.40, False, 1.0785064, 0.0, 0.2463264, 0.0),
    (1.2, 2.57, True, 1.0342741, 0.4399869, 0.2102095, 0.0049593),
]
FLIPPED = {1.0: (2.14, 2.64), 1.2: (2.28, 2.78)}
GRID = np.round(np.arange(2.10, 2.85, 0.02), 2)


def two_stage(mean: float) -> Machine:
    return oscillator(TWO_STAGES, 0.04, {0.0: mean, 1.0: 1.0})


@cache
def two_stage_branches(mean: float, highest: float) -> xr.Dataset:
    return respond(two_stage(mean), (2.0, 3.2), highest_order=highest, at=np.append(GRID, [3.0, 2.41, 2.57]))


# --- two-stage oscillator ---


@pytest.mark.parametrize("highest, tolerance", [(5.0, 1e-3), (12.0, 1e-6), (24.0, 1e-7)])
@pytest.mark.parametrize("mean, speed, doubled, steady, half, first, third", TWO_STAGE)
def test_two_stage_oscillator(
    highest: float,
    tolerance: float,
    mean: float,
    speed: float,
    doubled: bool,
    steady: float,
    half: float,
    first: float,
    third: float,
) -> None:
    data = two_stage_branches(mean, highest)
    at = picked(data, speed, "period doubling" if doubled else "main").twist.sel(element="spring")
    found = [float(abs(at.sel(order=order)).max()) for order in (0.0, 0.5, 1.0, 1.5)]
    np.testing.assert_allclose(found, [steady, half, first, third], atol=tolerance)


@pytest.mark.parametrize(
    "mean, speed, kind, largest, digits",
    [
        (1.0, 2.40, "main", (-1.33454, -0.67482), 5e-6),
        (1.2, 2.40, "main", (-1.22914,), 5e-6),
        (1.0, 2.41, "period doubling", (0.9010,), 5e-5),
    ],
)
def test_multipliers_of_the_two_stage_oscillator(
    mean: float, speed: float, kind: str, largest: tuple[float, ...], digits: float
) -> None:
    at = picked(two_stage_branches(mean, 24.0), speed, kind)
    found = at.multiplier.values[0, : len(largest)]
    told = np.where(found.imag == 0, found.real, np.abs(found))
    np.testing.assert_allclose(told, largest, atol=digits)
    assert bool(at.stable[0]) == (kind != "main")


@pytest.mark.parametrize("mean", FLIPPED)
def test_flip_unstable_interval(mean: float) -> None:
    data, (low, high) = two_stage_branches(mean, 12.0), FLIPPED[mean]
    stable = {speed: bool(picked(data, speed, "main").stable.values.all()) for speed in GRID.tolist()}
    assert stable == {speed: not low - 1e-9 <= speed <= high + 1e-9 for speed in GRID.tolist()}
    lower, upper = bifurcations(data, "period doubling")
    assert low - 0.02 < lower < low and high < upper < high + 0.02


# --- truck-like chain ---


@cache
def truck(highest: float) -> xr.Dataset:
    return respond(dmf12(), (rpm(600), rpm(1200)), highest_order=highest, at=[rpm(940)])


def test_truck_at_600_rpm() -> None:
    at = picked(truck(13.5), rpm(600), "main")
    assert float(abs(at.twist.sel(element="dmf", order=3.0)).item()) == pytest.approx(0.0580488697, abs=1e-10)


def test_period_doublings_of_the_truck() -> None:
    data = truck(13.5)
    np.testing.assert_allclose(bifurcations(data, "period doubling") / RPM, [911.66612, 985.27543], atol=2e-5)
    expected = [(0.08699948, 0.01456165), (0.08480922, 0.02379483)]
    events = data.isel(point=np.flatnonzero((data.event == "period doubling").values & (data.branch == 0).values))
    twist = events.twist.sel(element="dmf")
    found = np.stack([twist.sel(order=0.0).values.real, abs(twist.sel(order=3.0)).values], axis=1)
    np.testing.assert_allclose(found[np.argsort(events.value.values)], expected, atol=5e-9)


def test_more_harmonics_move_the_doublings_by_less_than_a_twentieth() -> None:
    few, many = (bifurcations(truck(highest), "period doubling") / RPM for highest in (13.5, 37.5))
    assert np.abs(few - many).max() < 0.05


def test_doubled_branch_of_the_truck() -> None:
    at = picked(truck(37.5), rpm(940), "period doubling").twist.sel(element="dmf").isel(point=0)
    found = [abs(complex(at.sel(order=order))) for order in (0.0, 1.5, 3.0)]
    np.testing.assert_allclose(found, [0.083132186, 0.030240829, 0.016682064], atol=1e-9)


# --- smooth springs ---

DUFFING = {
    "NLvib": (
        oscillator(Cubic(0.1), 0.05, {1.0: 0.18}, 1.0),
        (0.5, 2.0),
        {1.11570025: 1.08187032, 1.26960196: 2.82501671},
    ),
    "SKHiPPR": (
        oscillator(Cubic(2.0), 0.16, {1.0: 0.5}, 1.0),
        (0.8, 3.0),
        {1.52738458: 0.55429749, 2.09598517: 1.47365213},
    ),
}


@pytest.mark.parametrize("name", DUFFING)
def test_folds_of_duffing_oscillators(name: str) -> None:
    machine, span, folds = DUFFING[name]
    data = respond(machine, span, highest_order=7)
    np.testing.assert_allclose(bifurcations(data, "fold"), sorted(folds), atol=6e-9)
    at = data.isel(point=np.flatnonzero((data.event == "fold").values))
    found = abs(at.twist.sel(element="spring", order=1.0)).values[np.argsort(at.value.values)]
    np.testing.assert_allclose(found, [folds[speed] for speed in sorted(folds)], atol=1e-8)


def peak(data: xr.Dataset, point: int) -> float:
    """Largest angle of the spring over a period."""
    turns = np.exp(1j * np.outer(data.order.values, np.linspace(0, 2 * np.pi, 8001)))
    return float((data.twist.sel(element="spring").values[point] @ turns).real.max())


def duffing_backbone(amplitude: float, gamma: float) -> float:
    square = gamma * amplitude**2
    return float(np.pi * np.sqrt(1 + square) / (2 * ellipk(square / (2 * (1 + square)))))


def free_amplitude(machine: Machine, speed: float) -> float:
    """Amplitude of free vibration at a frequency.

    Along the amplitude of the excitation a hardening spring held at one frequency turns twice, the second time where
    the damper takes what the least excitation gives: the free vibration but for terms with the square of the damping,
    which two dampings tell.
    """
    found = {}
    for damping in (1e-2, 1e-3):
        (a, b, law, _), (unit,) = machine.laws["spring"], machine.torques["disc"].values()
        damped = Machine(
            machine.discs, machine.springs, {"spring": (a, b, law, damping)}, torques={"disc": {1.0: unit}}
        )
        data = respond(
            damped,
            (0.3 * damping, 25.0),
            parameter="amplitude",
            speed=speed,
            highest_order=41.0,
            depth=0,
            stability=False,
        )
        folds = np.flatnonzero((data.event == "fold").values)
        found[damping] = peak(data, int(folds[np.argmin(data.value.values[folds])]))
    return found[1e-3] + (found[1e-3] - found[1e-2]) / 99.0


@pytest.mark.parametrize(
    "law, stiffness, speed, amplitude",
    [
        (Cubic(1.0), 1.0, 1.3177760650, 1.0),
        (Stages((-1.0, 1.0), (3.0, 1.0, 3.0)), 0.0, 1.32943815, 2.0),
        (Stages((-1.0, 1.0), (3.0, 1.0, 3.0)), 0.0, 1.57823324, 5.0),
    ],
)
def test_backbones(law: Cubic | Stages, stiffness: float, speed: float, amplitude: float) -> None:
    found = free_amplitude(oscillator(law, 0.0, {1.0: 1.0}, stiffness), speed)
    assert found == pytest.approx(amplitude, rel=1e-6)
    if isinstance(law, Cubic):
        assert duffing_backbone(amplitude, law.gamma) == pytest.approx(speed, abs=1e-10)


def test_bilinear_oscillator() -> None:
    """Stiffness 1 : 3, a frequency that does not hang on the amplitude: in quadrature with its excitation there."""
    speed = 2 * np.sqrt(3.0) / (1 + np.sqrt(3.0))
    assert speed == pytest.approx(1.2679491924, abs=1e-10)
    machine = oscillator(Stages((0.0,), (1.0, 3.0)), 1e-2, {1.0: 1.0})
    near = speed + 1e-3 * np.array([-1.0, 0.0, 1.0])
    data = respond(machine, (1.26, 1.275), highest_order=41.0, depth=0, stability=False, at=near)
    phase = [float(np.angle(picked(data, w).twist.sel(element="spring", order=1.0).values[0])) for w in near]
    zero = np.polynomial.Polynomial.fit(near, np.array(phase) + np.pi / 2, 2).roots()
    assert zero[np.argmin(abs(zero - speed))] == pytest.approx(speed, abs=1e-6)


# --- stops ---


def test_folds_of_a_one_sided_stop() -> None:
    """The published amplitudes are lengths of all harmonics, the mean among them, to their last figures."""
    data = respond(
        oscillator(Stages((10.0,), (0.0, 1000.0)), 0.1 * np.sqrt(40.0), {1.0: 100.0}, 40.0),
        (3.0, 12.0),
        highest_order=20,
        depth=0,
    )
    folds = data.isel(point=np.flatnonzero((data.event == "fold").values & (data.branch == 0).values))
    length = np.sqrt((abs(folds.twist.sel(element="spring")) ** 2).sum("order").values)
    found = sorted(zip(folds.value.values.tolist(), length.tolist(), strict=True))
    np.testing.assert_allclose(found, [(6.998, 10.01), (8.566, 18.19)], rtol=2e-3)


def test_nlvib_example_03() -> None:
    grid = np.round(np.arange(0.7500, 0.7530, 0.0002), 4)
    data = respond(stop_machine(), (0.3, 1.9), highest_order=21, depth=0, at=grid)
    second = abs(data.angle.sel(node="second", order=1.0)).values
    assert second.max() == pytest.approx(0.9372, abs=1e-4)
    assert data.value.values[second.argmax()] == pytest.approx(0.7516, abs=5e-4)


# --- integration in time ---


def timed(machine: Machine, data: xr.Dataset, point: int) -> tuple[reference.Steady, np.ndarray]:
    """The motion by shooting from a point's state, and the point's harmonics (order, coordinate) of its own branch."""
    _, kept = machine.onto
    case, row = machine.case(), data.isel(point=point)
    orders, step = row.order.values, data.base_order.values[int(row.branch)]
    q = row.angle.sel(node=list(machine.discs)).values[:, kept][:: round(step / orders[1])]
    start = reference.state_from_orders(step * np.arange(len(q)), q, float(row.speed))
    sub = round(case.order / step)
    return reference.time_steady(case, float(row.speed), start, sub=sub, harmonics=len(q) - 1), q


CASES = {
    "two stages": (
        two_stage(1.0),
        (2.0, 3.2),
        12.0,
        1e-3,
        [(2.2, "main"), (3.1, "main"), (2.2, "period doubling"), (2.55, "period doubling")],
    ),
    "cubic": (DUFFING["SKHiPPR"][0], (0.8, 3.0), 15.0, 1e-6, [(0.9, "main"), (1.8, "main"), (2.6, "main")]),
    "stop": (stop_machine(), (0.3, 1.9), 30.0, 1e-3, [(0.5, "main"), (0.7, "main")]),
    "truck": (dmf12(), (rpm(600), rpm(1200)), 13.5, 1e-3, [(rpm(700), "main"), (rpm(960), "period doubling")]),
}


@pytest.mark.parametrize("name", CASES)
def test_against_integration_in_time(name: str) -> None:
    """Every point at these speeds, stable or not: harmonics, and multipliers by the variational equations."""
    machine, span, highest, tolerance, places = CASES[name]
    values = [value for value, _ in places]
    data = respond(machine, span, highest_order=highest, at=values)
    for value, kind in places:
        at = picked(data, value, kind)
        assert at.sizes["point"] > 0
        for point in range(at.sizes["point"]):
            compared(machine, at, point, tolerance)


def compared(machine: Machine, data: xr.Dataset, point: int, tolerance: float) -> None:
    steady, q = timed(machine, data, point)
    assert np.abs(q - steady.angle).max() <= tolerance * np.abs(steady.angle[1:]).max()
    largest = np.abs(steady.multipliers[0])
    if abs(largest - 1.0) > 0.03:
        assert bool(data.stable.values[point]) == (largest < 1.0)
    # thirty harmonics leave 12 % in the multipliers of a hard stop, 84 leave 0.4 %
    np.testing.assert_allclose(
        np.abs(data.multiplier.values[point, 0]), largest, rtol=0.15 if "stop" in machine.laws else 0.03
    )


@pytest.mark.full
@pytest.mark.parametrize("highest, tolerance", [(13.5, 1e-3), (37.5, 1e-5)])
@pytest.mark.parametrize("speed", [625, 850, 915, 930, 945, 965, 983, 1100])
def test_truck_against_integration_in_time(speed: float, highest: float, tolerance: float) -> None:
    data = respond(dmf12(), (rpm(600), rpm(1200)), highest_order=highest, at=[rpm(speed)])
    at = picked(data, rpm(speed))
    assert at.sizes["point"] == 1 + (911.7 < speed < 985.2)
    for point in range(at.sizes["point"]):
        compared(dmf12(), at, point, tolerance)


def test_the_error_falls_with_more_harmonics() -> None:
    machine, errors = two_stage(1.0), []
    exact = reference.time_steady(machine.case(), 2.41, sub=2, harmonics=4)
    for highest in (3.0, 6.0, 12.0, 24.0):
        data = respond(machine, (2.0, 3.2), highest_order=highest, at=[2.41], stability=False)
        found = picked(data, 2.41, "period doubling").twist.sel(element="spring").values[0, :5]
        errors.append(np.abs(np.abs(found) - np.abs(exact.twist[:5, 0])).max())
    assert errors[0] < 1e-3 and all(after < 0.5 * before for before, after in pairwise(errors))
