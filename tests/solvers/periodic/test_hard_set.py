"""The hard set: grazing, steep stages, no damping, corners, free play.  No wrong point is given out as a solution."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.solvers.periodic.machines import (
    TWO_STAGES,
    Machine,
    leftover,
    oscillator,
    picked,
    respond,
    stop_machine,
    thirty_nodes,
    three_laws,
    worst_leftover,
)
from tests.validation.periodic_reference import Cubic, Stages

from torsional.errors import ModelError
from torsional.numerics.continuation.following import Settings

SHORT = Settings(first_step=0.01, largest_step=0.1, largest_angle=0.35, most_points=200)
PLAY = Stages((-1.0, 1.0), (1.0, 0.0, 1.0))
STEEP = Stages((-1.0, 1.0), (50.0, 1.0, 50.0))
STEEP_PLAY = Stages((-1.0, 1.0), (50.0, 0.0, 50.0))
STOP = Stages((10.0,), (0.0, 1000.0))

# machine, span, highest order
HARD: dict[str, tuple[Machine, tuple[float, float], float]] = {
    "ratio 50 about zero": (oscillator(STEEP, 0.05, {0.0: 0.0, 1.0: 0.3}), (0.8, 8.0), 21.0),
    "ratio 50 with a mean": (oscillator(STEEP, 0.05, {0.0: 0.9, 1.0: 0.3}), (0.7, 8.0), 21.0),
    "ratio 50, mean at the corner": (oscillator(STEEP, 0.05, {0.0: 1.0, 1.0: 0.3}), (1.0, 8.0), 21.0),
    "mean at the corner": (oscillator(TWO_STAGES, 0.04, {0.0: 1.0, 1.0: 0.3}), (0.3, 4.0), 15.0),
    "mean at the corner, hardly excited": (oscillator(TWO_STAGES, 0.04, {0.0: 1.0, 1.0: 1e-6}), (0.3, 4.0), 15.0),
    "no damping": (oscillator(TWO_STAGES, 0.0, {0.0: 0.5, 1.0: 0.3}), (0.5, 4.0), 15.0),
    "no damping, from the linear resonance": (oscillator(TWO_STAGES, 0.0, {0.0: 0.5, 1.0: 0.3}), (1.0, 4.0), 15.0),
    "no damping, smooth": (oscillator(Cubic(0.1), 0.0, {1.0: 0.18}, 1.0), (0.7, 3.0), 7.0),
    "no damping, smooth, from the resonance": (oscillator(Cubic(0.1), 0.0, {1.0: 0.18}, 1.0), (1.0, 3.0), 7.0),
    "play, no mean": (oscillator(PLAY, 0.05, {1.0: 0.3}), (0.5, 3.0), 15.0),
    "play, crossed by the torque": (oscillator(PLAY, 0.05, {0.0: 0.1, 1.0: 0.3}), (1.0, 3.0), 15.0),
    "play, left by the torque": (oscillator(PLAY, 0.05, {0.0: -0.3, 1.0: 0.3}), (0.6, 3.0), 15.0),
    "play, touched by the torque": (oscillator(PLAY, 0.05, {0.0: 1.0, 1.0: 1.0}), (0.5, 3.0), 15.0),
    "steep play, no mean": (oscillator(STEEP_PLAY, 0.05, {1.0: 1.0}), (3.0, 8.0), 21.0),
    "steep play, no mean, no damping": (oscillator(STEEP_PLAY, 0.0, {1.0: 1.0}), (3.0, 8.0), 21.0),
    "steep play": (oscillator(STEEP_PLAY, 0.05, {0.0: 0.3, 1.0: 1.0}), (3.0, 8.0), 21.0),
    "stop": (oscillator(STOP, 0.1 * np.sqrt(40.0), {1.0: 100.0}, 40.0), (3.0, 12.0), 15.0),
    "stop before two masses": (stop_machine(), (0.3, 1.9), 21.0),
    "bilinear": (oscillator(Stages((0.0,), (1.0, 3.0)), 0.02, {0.0: 0.0, 1.0: 1.0}), (0.4, 3.0), 15.0),
    "three laws": (three_laws(), (75.0, 110.0), 18.0),
    "three laws, no mean": (three_laws(0.0, 800.0, grounded=False), (60.0, 110.0), 12.0),
    "three laws, no mean, on the ground": (three_laws(0.0, 800.0), (60.0, 110.0), 12.0),
    "three laws, no mean, strong": (three_laws(0.0, 4000.0, grounded=False), (90.0, 130.0), 12.0),
    "thirty nodes": (thirty_nodes(), (80.0, 130.0), 18.0),
    "thirty nodes, no mean": (thirty_nodes(0.0, 4000.0), (90.0, 130.0), 12.0),
}


def assert_honest(machine: Machine, data: xr.Dataset, tolerance: float) -> None:
    """Every point meets Newton's equations; every branch tells where it comes from and why it ends."""
    assert worst_leftover(machine, data, step=max(1, data.sizes["point"] // 30)) < tolerance
    assert all(data.started.values) and all(data.ended.values)
    low, high = data.value.values.min(), data.value.values.max()
    assert np.isfinite(data.twist.values).all() and np.isfinite(data.multiplier.values).all()
    assert low < high


HEAVY = (
    "ratio 50 about zero",
    "no damping, smooth",
    "three laws, no mean",
    "steep play, no mean",
    "play, touched by the torque",
    "steep play, no mean, no damping",
    "steep play",
    "three laws",
    "three laws, no mean, strong",
    "thirty nodes, no mean",
)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.full) if name in HEAVY else name for name in HARD]
)
def test_no_wrong_point(name: str) -> None:
    machine, span, highest = HARD[name]
    data = respond(machine, span, highest_order=highest, depth=int(name != "three laws"), settings=SHORT)
    assert_honest(machine, data, 1e-6)
    assert span[0] <= data.value.values.min() and data.value.values.max() <= span[1]
    # what is there at the ends of the range is reached from at least one of them
    assert {span[0], span[1]} & set(data.value.values.tolist())


# --- grazing ---


def linear_peak(speed: float, damping: float) -> float:
    return float(1 / np.sqrt((1 - speed**2) ** 2 + (damping * speed) ** 2))


@pytest.mark.parametrize("steeper", [1.0, 50.0, 1000.0])
def test_just_below_and_just_above_the_gap(steeper: float) -> None:
    """Below its gap a spring is not there, to rounding; above, the answer departs with the depth to the power 3/2."""
    speed, damping = 0.8, 0.05
    machine = oscillator(Stages((linear_peak(speed, damping),), (1.0, 1.0 + steeper)), damping, {0.0: 0.0, 1.0: 1.0})
    exact = 1 / (1 - speed**2 + 1j * damping * speed)
    for share in (-1e-3, -1e-6, -1e-9, 0.0, 1e-9, 1e-6, 1e-3):
        data = respond(
            machine, (0.98, 1.02), parameter="amplitude", speed=speed, highest_order=21.0, at=[1 + share], depth=0
        )
        at = picked(data, 1 + share).twist.sel(element="spring", order=1.0).values
        apart = np.abs(at - (1 + share) * exact)
        assert apart.min() <= (1e-13 if share <= 0 else 10 * steeper * share**1.5 + 1e-12)
    assert_amplitudes(machine, data, speed)


def assert_amplitudes(machine: Machine, data: xr.Dataset, speed: float) -> None:
    for point in range(0, data.sizes["point"], max(1, data.sizes["point"] // 30)):
        (node,) = machine.torques
        factor = float(data.value[point])
        case = machine.with_torques(
            {node: {n: t * (factor if n else 1.0) for n, t in machine.torques[node].items()}}
        ).case()
        q = data.angle.sel(node=list(machine.discs)).values[point]
        assert leftover(case, speed, q, data.order.values[1] / case.order) < 1e-7


@pytest.mark.parametrize("share", [-1e-6, -1e-9, 0.0, 1e-9, 1e-6])
@pytest.mark.parametrize("steeper", [1.0, 50.0])
def test_a_resonance_that_hardly_reaches_the_gap(share: float, steeper: float) -> None:
    damping = 0.1
    speed = float(np.sqrt(1 - damping**2 / 2))
    gap = linear_peak(speed, damping) * (1 - share)
    machine = oscillator(Stages((gap,), (1.0, 1.0 + steeper)), damping, {0.0: 0.0, 1.0: 1.0})
    data = respond(machine, (0.5, 1.5), highest_order=15.0, at=[speed], settings=SHORT)
    assert_honest(machine, data, 1e-8)
    found = abs(picked(data, speed).twist.sel(element="spring", order=1.0).values)
    assert found == pytest.approx([linear_peak(speed, damping)], rel=1e-12 if share <= 0 else 1e-5)
    assert data.sizes["branches"] == 1 and data.stable.values.all()


@pytest.mark.parametrize("where", [0.6, 0.8, 0.95])
def test_a_branch_that_enters_and_leaves_the_gap(where: float) -> None:
    """Grazing on both flanks of the resonance: the branch passes through both and is the linear one outside."""
    damping = 0.1
    machine = oscillator(Stages((linear_peak(where, damping),), (1.0, 3.0)), damping, {0.0: 0.0, 1.0: 1.0})
    data = respond(machine, (0.4, 2.5), highest_order=15.0, settings=SHORT, at=[where])
    assert_honest(machine, data, 1e-8)
    outside = (data.value.values < where) & (abs(data.twist.sel(element="spring", order=2.0).values) == 0.0)
    exact = 1 / (1 - data.value.values**2 + 1j * damping * data.value.values)
    found = data.twist.sel(element="spring", order=1.0).values
    assert outside.any() and np.abs(found - exact)[outside].max() < 1e-12
    assert {0.4, 2.5} <= set(data.value.values.tolist())


# --- corners, free play ---


def test_the_torque_exactly_at_the_corner_of_two_stages() -> None:
    """Excited less and less, the answer is that of two half periods of different stiffness, in proportion to it."""
    found = []
    for size in (1e-2, 1e-5, 1e-8):
        machine = oscillator(TWO_STAGES, 0.04, {0.0: 1.0, 1.0: size})
        data = respond(machine, (0.5, 0.7), highest_order=15.0, at=[0.6], depth=0)
        found.append(picked(data, 0.6).twist.sel(element="spring").values[0])
        assert worst_leftover(machine, data, step=5) < 1e-9
        assert found[-1][0] - 1.0 != 0.0 or size < 1e-7
    np.testing.assert_allclose(found[1][1:] / 1e-5, found[0][1:] / 1e-2, atol=1e-9)
    # unknowns are solved for to 1e-9 of the gap
    np.testing.assert_allclose(found[2][1:] / 1e-8, found[0][1:] / 1e-2, atol=1e-3)


def test_play_without_mean_torque_keeps_its_symmetry() -> None:
    data = respond(HARD["play, no mean"][0], (0.8, 3.0), highest_order=15.0, depth=0, settings=SHORT)
    even = data.twist.sel(element="spring", order=[0.0, 2.0, 4.0]).values[data.branch.values == 0]
    assert np.abs(even).max() < 1e-9


def test_free_flight_inside_of_play() -> None:
    """Too little torque to reach an edge: the mean is anywhere.  That is said, or one of these motions is given."""
    machine = oscillator(PLAY, 0.0, {1.0: 1e-3})
    try:
        data = respond(machine, (3.0, 4.0), highest_order=5.0)
    except ModelError as error:
        assert "no periodic solution" in str(error)
    else:
        assert worst_leftover(machine, data) < 1e-9


# --- without damping ---


def test_undamped_duffing_has_both_of_its_branches() -> None:
    """In phase up to any amplitude, and against it from infinity of speed to a fold and up again."""
    data = respond(
        oscillator(Cubic(0.1), 0.0, {1.0: 0.18}, 1.0), (0.7, 3.0), highest_order=7.0, at=[2.0], stability=False
    )
    x = picked(data, 2.0).twist.sel(element="spring", order=1.0).values.real
    # one term: (1 − Ω²) a + ¾ γ a³ = F has three real solutions
    expected = np.sort(np.roots([0.075, 0.0, 1 - 2.0**2, -0.18]).real)
    assert np.sort(x) == pytest.approx(expected, rel=0.05)


# --- nothing is told twice ---


@pytest.mark.parametrize("name", ["ratio 50 with a mean", "mean at the corner", "stop", "bilinear", "thirty nodes"])
def test_no_motion_is_told_twice(name: str) -> None:
    """Neither the copy of a motion a period later, nor its mirror image, nor one branch on another: sizes tell them."""
    machine, span, highest = HARD[name]
    values = np.linspace(*span, 23)[1:-1] * 1.0001
    data = respond(machine, span, highest_order=highest, depth=2, at=values, stability=False)
    for value in values:
        sizes = np.abs(picked(data, float(value)).twist.sel(element=list(machine.laws)).values)
        apart = np.abs(sizes[:, None] - sizes[None]).max(axis=(2, 3)) + np.eye(len(sizes))
        assert len(sizes) and apart.min() > 1e-6 * sizes.max()
