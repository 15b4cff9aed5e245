"""Floquet multipliers of branches: four other ways to them, their product, and what they are at bifurcations."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from scipy.linalg import expm
from tests.solvers.periodic.machines import (
    TWO_STAGES,
    Machine,
    clutch_machine,
    dmf12,
    geared,
    oscillator,
    picked,
    respond,
    rpm,
    three_laws,
)
from tests.validation import periodic_reference as reference
from tests.validation.periodic_reference import Case, Cubic, Stages

from torsional.absorbers import CentrifugalPendulum
from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Polynomial
from torsional.powertrain import Powertrain
from torsional.solvers.periodic import periodic_response
from torsional.system import assemble

# machine, span, highest order, speeds
MACHINES: dict[str, tuple[Machine, tuple[float, float], float, tuple[float, ...]]] = {
    "two stages": (oscillator(TWO_STAGES, 0.04, {0.0: 1.0, 1.0: 1.0}), (2.0, 3.0), 24.0, (2.05, 2.4, 2.55)),
    "cubic": (oscillator(Cubic(2.0), 0.16, {1.0: 0.5}, 1.0), (1.0, 3.0), 15.0, (1.2, 1.8, 2.5)),
    "truck": (dmf12(), (rpm(600), rpm(1200)), 13.5, (rpm(700), rpm(940))),
    "flywheel and clutch": (clutch_machine(), (70.0, 110.0), 18.0, (75.0,)),
    "three laws": (three_laws(), (79.5, 80.5), 45.0, (80.0,)),
    "without ground": (geared(), (70.0, 100.0), 18.0, (75.0,)),
}


@cache
def answer(name: str) -> xr.Dataset:
    machine, span, highest, at = MACHINES[name]
    return respond(machine, span, highest_order=highest, at=at, depth=int(name in ("two stages", "truck")))


def points(name: str) -> list[tuple[xr.Dataset, Case, np.ndarray, float, float]]:
    """Of every solution at the speeds: its point, matrices, harmonics (order, coordinate), base order and period."""
    machine, _, _, speeds = MACHINES[name]
    _, kept = machine.onto
    out = []
    for speed in speeds:
        data = picked(answer(name), speed)
        for i in range(data.sizes["point"]):
            row = data.isel(point=i)
            step = float(data.base_order.values[int(row.branch)])
            q = row.angle.sel(node=list(machine.discs)).values[:, kept][:: round(step / data.order.values[1])]
            out.append((row, machine.case(), q, step, 2 * np.pi / (step * speed)))
    return out


def slopes_along(case: Case, q: np.ndarray, samples: int) -> np.ndarray:
    """Slopes of the laws (samples, law) over the period."""
    tau = (np.arange(samples) + 0.5) * 2 * np.pi / samples
    x = (np.exp(1j * np.outer(tau, np.arange(len(q)))) @ (q @ case.weights.T)).real
    return np.stack([law.slopes_along(x[:, e]) for e, law in enumerate(case.laws)], axis=1)


def first_order(case: Case, slopes: np.ndarray) -> np.ndarray:
    A, B = case.linear()
    wide = np.hstack([case.weights, np.zeros_like(case.weights)])
    return np.asarray(A - B @ case.weights.T @ (slopes[:, None] * wide))


def matched(found: np.ndarray, expected: np.ndarray) -> float:
    """Largest distance of a found multiplier from the expected one that is left for it."""
    rest, worst = list(expected), 0.0
    for value in found:
        nearest = int(np.argmin(np.abs(np.array(rest) - value)))
        worst = max(worst, abs(rest.pop(nearest) - value))
    return worst


def monodromy_of_steps(case: Case, q: np.ndarray, period: float, samples: int = 1 << 14) -> np.ndarray:
    """The product of exponentials of runs of equal slopes, from dense samples: kinks are known to a sample."""
    slopes = slopes_along(case, q, samples)
    cuts = np.flatnonzero((np.diff(slopes, axis=0) != 0).any(axis=1)) + 1
    ends = np.concatenate([[0], cuts, [samples]])
    out = np.eye(2 * case.nodes)
    for i, j in pairwise(ends):
        out = expm(first_order(case, slopes[i]) * period * (j - i) / samples) @ out
    return out


@pytest.mark.parametrize("name", [name for name in MACHINES if name != "cubic"])
def test_product_of_exponentials(name: str) -> None:
    for row, case, q, _, period in points(name):
        every = np.linalg.eigvals(monodromy_of_steps(case, q, period))
        found = row.multiplier.values
        # those +1 of a line that turns freely are not listed
        assert found.size == every.size - (2 if name == "without ground" else 0)
        assert matched(found, every) < 2e-3 * max(1.0, np.abs(found[0]))


@pytest.mark.parametrize("name", MACHINES)
def test_determinant(name: str) -> None:
    """Liouville: the product of the multipliers is what the dampers take."""
    data, case = answer(name), MACHINES[name][0].case()
    size = data.sizes["multiplier"]
    rate = np.trace(np.linalg.solve(case.M, case.C))
    for point in range(0, data.sizes["point"], 7):
        step = float(data.base_order.values[int(data.branch[point])])
        period = 2 * np.pi / (step * float(data.speed[point]))
        values = data.multiplier.values[point]
        expected = -rate * period
        if expected > -200 and size <= 2:  # of the smallest of many multipliers no digit is right
            assert np.prod(values).real == pytest.approx(np.exp(expected), rel=1e-9)
        assert np.log(np.abs(values)).sum() == pytest.approx(
            expected, abs=max(1e-9, 1e-2 * size * (size > 2)), rel=2e-2
        )


def koopman_hill(case: Case, q: np.ndarray, period: float, count: int) -> np.ndarray:
    """Monodromy matrix C exp(H T) W from Hill's matrix of 2 count + 1 blocks; Bayer and Leine (2023), doi
    10.1007/s11071-023-08564-3: neither sorted eigenvalues nor any that the truncation bears."""
    n, samples = 2 * case.nodes, 1 << 13
    slopes = slopes_along(case, q, samples)
    tau = (np.arange(samples) + 0.5) * 2 * np.pi / samples
    spectrum = np.exp(-1j * np.outer(np.arange(2 * count + 1), tau)) @ slopes / samples
    still, size = first_order(case, np.zeros(len(case.laws))), 2 * count + 1
    blocks = [first_order(case, s) - still if k else first_order(case, s.real) for k, s in enumerate(spectrum)]
    H = np.zeros((size * n, size * n), dtype=complex)
    for i in range(size):
        for j in range(size):
            block = blocks[abs(i - j)]
            H[i * n : (i + 1) * n, j * n : (j + 1) * n] = block if i >= j else block.conj()
        H[i * n : (i + 1) * n, i * n : (i + 1) * n] -= 2j * np.pi / period * (i - count) * np.eye(n)
    W = np.zeros((size * n, n))
    W[count * n : (count + 1) * n] = np.eye(n)
    return np.asarray((np.tile(np.eye(n), size) @ (expm(H * period) @ W)).real)


@pytest.mark.parametrize("name, count, tolerance", [("cubic", 20, 1e-7), ("two stages", 24, 0.03)])
def test_hills_matrix(name: str, count: int, tolerance: float) -> None:
    for row, case, q, _, period in points(name):
        expected = np.linalg.eigvals(koopman_hill(case, q, period, count))
        assert matched(row.multiplier.values, expected) < tolerance


@pytest.mark.full
def test_hills_matrix_of_a_line() -> None:
    for row, case, q, _, period in points("flywheel and clutch"):
        expected = np.linalg.eigvals(koopman_hill(case, q, period, 24))
        assert matched(row.multiplier.values[:4], expected) < 0.02


@pytest.mark.parametrize("name, speed", [("two stages", 2.4), ("two stages", 2.55), ("cubic", 1.2), ("cubic", 1.8)])
def test_differences_of_the_flow(name: str, speed: float) -> None:
    for row, case, q, step, _ in points(name):
        if float(row.speed) != speed:
            continue
        start = reference.state_from_orders(step * np.arange(len(q)), q, speed)
        steady = reference.time_steady(case, speed, start, sub=round(case.order / step), harmonics=4)
        expected = reference.difference_multipliers(steady)
        # a motion of 24 or 48 harmonics misses the kinks of the exact one by some 1e-6
        assert matched(row.multiplier.values, expected) < (1e-6 if name == "cubic" else 1e-5)


@pytest.mark.parametrize("name", MACHINES)
def test_stable_means_inside_of_the_circle(name: str) -> None:
    data = answer(name)
    quiet = data.event.values == ""
    largest = np.abs(data.multiplier.values[:, 0])
    # closer to it the determinants of the balance decide, since multipliers of few harmonics miss a little
    clear = quiet & (np.abs(largest - 1) > 0.02)
    np.testing.assert_array_equal(data.stable.values[clear], (largest < 1)[clear])


# --- bifurcations ---


def test_at_a_period_doubling_a_multiplier_is_minus_one() -> None:
    for name, tolerance in (("two stages", 1e-4), ("truck", 3e-3)):
        data = answer(name)
        flips = (data.event.values == "period doubling") & (data.branch.values == 0)
        assert flips.sum() == 2
        nearest = np.abs(data.multiplier.values[flips] + 1).min(axis=1)
        assert nearest.max() < tolerance


def test_at_a_fold_a_multiplier_is_plus_one() -> None:
    data = answer("cubic")
    folds = data.event.values == "fold"
    assert folds.sum() == 2
    assert np.abs(data.multiplier.values[folds] - 1).min(axis=1).max() < 1e-6


def test_at_a_fold_between_stages_too() -> None:
    machine = oscillator(Stages((-1.0, 1.0), (3.0, 1.0, 3.0)), 0.05, {0.0: 0.0, 1.0: 0.3})
    data = respond(machine, (0.6, 3.0), highest_order=41.0, depth=0)
    folds = data.event.values == "fold"
    assert folds.sum() == 2
    assert np.abs(data.multiplier.values[folds] - 1).min(axis=1).max() < 1e-3
    # and between them the branch is unstable
    first, last = np.flatnonzero(folds)
    assert not data.stable.values[first + 1 : last].any()
    assert data.stable.values[: first - 1].all() and data.stable.values[last + 2 :].all()


def test_between_period_doublings_the_main_branch_is_unstable_and_the_doubled_one_stable() -> None:
    data = answer("truck")
    low, high = np.sort(data.bifurcation_value.values[data.on_branch.values == 0])
    main = data.isel(point=np.flatnonzero((data.branch.values == 0) & (data.event.values == "")))
    inside = (main.value.values > low) & (main.value.values < high)
    np.testing.assert_array_equal(main.stable.values, ~inside)
    doubled = data.isel(point=np.flatnonzero((data.branch.values == 1) & (data.event.values == "")))
    assert doubled.stable.values.mean() > 0.8


def test_the_branch_of_twice_the_period_squares_the_multipliers_where_it_leaves() -> None:
    data = answer("two stages")
    flips = np.flatnonzero((data.event.values == "period doubling") & (data.branch.values == 0))
    for flip in flips:
        near = np.flatnonzero((data.branch.values == 1) & (np.abs(data.value.values - data.value.values[flip]) < 1e-6))
        assert near.size
        single = data.multiplier.values[flip]
        assert matched(data.multiplier.values[near[0]], single**2) < 1e-3


# --- what does not move with the span ---


def test_multipliers_beside_a_pendulum_do_not_depend_on_the_span() -> None:
    """The pendulum's spring grows with the square of the speed: that of the point, not that of the middle."""
    parts = {
        "engine": Inertia(1.5),
        "secondary": Inertia(0.8),
        "end": Inertia(60.0),
        "dmf": Coupling("secondary", "engine", Polynomial((9e3, 0.0, 2e6)), 15.0),
        "pendulum": CentrifugalPendulum("secondary", mass=1.0, distance=0.15, order=3.0, damping=0.05),
        "drive": Shaft("end", "secondary", 9e3, 20.0),
    }
    system, load = assemble(Powertrain(parts)), Excitation(("engine",), [0.0, 3.0], 1.0, [[200.0, 600.0]])
    found = []
    for span in ((60.0, 160.0), (79.0, 81.0)):
        data = periodic_response(system, load, span, hold="end", at=[80.0], highest_order=9.0, depth=0)
        found.append(picked(data, 80.0).multiplier.values[0])
    assert matched(*found) < 1e-9
