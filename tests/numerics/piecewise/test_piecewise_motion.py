"""Exact piecewise-linear motion against closed forms, published figures and tight integration."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.validation.periodic_reference import Case, Stages, dmf12, flow

from torsional.errors import ModelError
from torsional.numerics.piecewise.basis import StageBases
from torsional.numerics.piecewise.monodromy import ordered
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.units import RPM

TWO_PI = 2.0 * np.pi


def oscillator(law: list[float], damping: float = 0.0, stiffness: float = 0.0, mass: float = 1.0) -> StageBases:
    return StageBases([[mass]], [[damping]], [[stiffness]], [[1.0]], [law])


def start(motion: PiecewiseMotion, angles: list[float], rates: list[float]) -> np.ndarray:
    return motion.bases.coordinates.state(angles, rates)


def ends(motion: PiecewiseMotion, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return motion.bases.coordinates.angles(state), motion.bases.coordinates.rates(state)


# --- closed forms ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("samples", [4, 16, 256])
def test_impact_on_a_gap_spring(samples: int) -> None:
    """m = 1, v = 1, gap 0.1, k = 100: contact of π/10 s, and back with v = −1; the grid may be coarse."""
    motion = PiecewiseMotion(oscillator([0.0, 0.1, 1.0, 100.0]), [[0.0]], TWO_PI, samples)
    way = motion.flow(start(motion, [0.0], [1.0]))
    np.testing.assert_allclose(way.times, [0.0, 0.1, 0.1 + np.pi / 10.0], rtol=1e-13)
    assert way.stages.tolist() == [[0], [1], [0]]
    angle, rate = ends(motion, way.state)
    np.testing.assert_allclose(rate, [-1.0], rtol=1e-13)
    np.testing.assert_allclose(angle, [0.1 - (0.9 - np.pi / 10.0)], rtol=1e-12)


@pytest.mark.parametrize("samples", [7, 64, 256])
def test_clearance_oscillator_comes_back_after_its_period(samples: int) -> None:
    """m = 1 between stops k = 100 at ±1, from 2 at rest: 4/10 (1 + π/2) = 1.0283185307 s."""
    period = 0.4 * (1.0 + 0.5 * np.pi)
    assert round(period, 10) == 1.0283185307
    law = [0.0, 1.0, 1.0, 100.0, -1.0, -1.0, 100.0]
    motion = PiecewiseMotion(oscillator(law), [[0.0]], TWO_PI / period, samples)
    way = motion.flow(start(motion, [2.0], [0.0]), 50)
    angle, rate = ends(motion, way.state)
    np.testing.assert_allclose([angle[0], rate[0]], [2.0, 0.0], atol=3e-11)
    assert len(way.times) == 1 + 50 * 4
    quarter = 0.05 * np.pi
    expected = np.array([quarter, quarter + 0.2, 3 * quarter + 0.2, 3 * quarter + 0.4])
    np.testing.assert_allclose(way.times[1:5], expected, rtol=1e-13)


def test_one_sided_forced_oscillator() -> None:
    """x″ + 0.1 x′ + x + 8 max(x, 0) = cos 2t from rest, after 150 periods: figures of the design paper."""
    motion = PiecewiseMotion(oscillator([0.0, 0.0, 1.0, 8.0], 0.1, 1.0), [[0.0], [1.0]], 2.0)
    angle, rate = ends(motion, motion.run(periods=150).state)
    np.testing.assert_allclose([angle[0], rate[0]], [-0.8611948799, 0.1000478798], atol=5e-11)


def test_resonance_without_damping_and_free_flight_under_a_mean_load() -> None:
    """x″ + x = cos t grows as t sin(t)/2; in free play x″ = 1 falls as t²/2: no particular solution exists."""
    motion = PiecewiseMotion(oscillator([1.0]), [[0.0], [1.0]], 1.0)
    found = motion.run(periods=20)
    np.testing.assert_allclose(found.angles[:, 0], 0.5 * found.times * np.sin(found.times), atol=1e-10)
    falling = PiecewiseMotion(oscillator([0.0, 1e3, 1.0, 1.0]), [[1.0]], 1.0).run(periods=3)
    np.testing.assert_allclose(falling.angles[:, 0], 0.5 * falling.times**2, rtol=1e-12)


def test_a_pulse_moves_a_free_mass_by_its_impulse() -> None:
    """Two discs of 1 and 3 kgm² free of each other within a gap: only their relative angle is told."""
    rigid = [[1.0], [1.0]]
    law = [0.0, 5.0, 1.0, 10.0, -5.0, -1.0, 10.0]
    bases = StageBases(np.diag([1.0, 3.0]), np.zeros((2, 2)), np.zeros((2, 2)), [[-1.0, 1.0]], [law], rigid)
    motion = PiecewiseMotion(bases, [[0.0, 0.0]], TWO_PI)
    found = motion.run(periods=2, pulse=(0.123, 0.457, [2.0, 0.0]))
    length, t = 0.457 - 0.123, found.times
    pushed = np.clip(t - 0.123, 0.0, length)
    expected = 2.0 * (0.5 * pushed**2 + length * np.clip(t - 0.457, 0.0, None))
    np.testing.assert_allclose(found.angles[:, 1] - found.angles[:, 0], -expected, atol=1e-13)
    np.testing.assert_allclose(found.angles @ [1.0, 3.0], 0.0, atol=1e-13)
    assert motion.run(periods=2).angles.max() == 0.0  # the pulse leaves no trace in later runs


# --- two-stage oscillator --------------------------------------------------------------------------------------------

TWO_STAGES = [1.0, 1.0, 1.0, 1.0]

# mean load, frequency, mean, A½, A1, A3/2: figures of the design paper by shooting on the exact piecewise solution
TABLE = [
    (1.0, 3.0, 0.9715228, 0.0, 0.1309417, 0.0),
    (1.0, 2.41, 0.8654713, 0.5336911, 0.2435232, 0.0076506),
    (1.2, 2.57, 1.0342741, 0.4399869, 0.2102095, 0.0049593),
]


@pytest.mark.parametrize(("mean", "omega", "x0", "half", "one", "three_halves"), TABLE)
@pytest.mark.parametrize("newton", [False, True])
def test_two_stage_oscillator_settles(
    mean: float, omega: float, x0: float, half: float, one: float, three_halves: float, newton: bool
) -> None:
    motion = PiecewiseMotion(oscillator(TWO_STAGES, 0.04), [[mean], [1.0]], omega)
    found = motion.steady(start(motion, [mean], [0.0]), newton=newton)
    assert found.converged and found.subharmonic == (2 if half else 1)
    harmonics = motion.harmonics(found.state, 3, 2)[:, 0]
    assert harmonics[0] == pytest.approx(x0, abs=1e-7)
    np.testing.assert_allclose(np.abs(harmonics[1:]), [half, one, three_halves], atol=1e-7)


@pytest.mark.parametrize(
    ("mean", "omega", "periods", "size", "figures"),
    [
        (1.0, 2.4, 1, (0.9504980, 0.2274590), [-1.33454, -0.67482]),
        (1.2, 2.4, 1, (1.0785064, 0.2463264), [-1.22914]),
        (1.0, 2.41, 2, (0.8654713, 0.5336911), [0.9010 * np.exp(1j * 0.3096)]),
    ],
)
def test_two_stage_oscillator_closed_by_newton(
    mean: float, omega: float, periods: int, size: tuple[float, float], figures: list[complex]
) -> None:
    """The motion of one period is found although it is unstable; multipliers to the digits of the design paper."""
    motion = PiecewiseMotion(oscillator(TWO_STAGES, 0.04), [[mean], [1.0]], omega)
    state = start(motion, [mean], [0.0]) if periods == 1 else motion.steady(start(motion, [mean], [0.0])).state
    closed = motion.shoot(state, periods)
    assert closed.converged
    harmonics = motion.harmonics(closed.state, 1, periods)[:, 0]
    np.testing.assert_allclose(np.abs(harmonics), size, atol=1e-7)
    found = ordered(np.linalg.eigvals(closed.monodromy))
    np.testing.assert_allclose(np.abs(found[: len(figures)]), np.abs(figures), atol=5.1e-5 if periods == 2 else 5.1e-6)


def test_harmonics_do_not_hang_on_the_number_of_samples() -> None:
    bases = oscillator(TWO_STAGES, 0.04)
    found = [PiecewiseMotion(bases, [[1.0], [1.0]], 2.4, samples) for samples in (256, 8192)]
    state = found[0].shoot(start(found[0], [1.0], [0.0])).state
    few, many = (motion.harmonics(state, 12) for motion in found)
    np.testing.assert_allclose(few, many, atol=1e-11)
    assert np.abs(few[12]) > 1e-7


def test_a_motion_that_passes_hinges_without_end_is_refused() -> None:
    """A disc of 1 kgm² that flies at 1 rad/s between stops 2e-6 rad apart meets them half a million times a second."""
    law = [0.0, 1e-6, 1.0, 1e14, -1e-6, -1.0, 1e14]
    motion = PiecewiseMotion(oscillator(law), [[0.0]], TWO_PI, 4)
    with pytest.raises(ModelError, match=r"passes a hinge without end.* enormous stiffness"):
        motion.flow(start(motion, [0.0], [1.0]))


# --- several coordinates ---------------------------------------------------------------------------------------------


def random_case(seed: int) -> tuple[StageBases, Case]:
    """Three coordinates, one of them held by a spring, two connections with two and three stages."""
    rng = np.random.default_rng(seed)
    R, D = rng.normal(size=(3, 3)), rng.normal(size=(3, 3))
    M, C, K = R @ R.T + np.eye(3), 0.05 * D @ D.T, np.diag([1.0, 2.0, 3.0])
    W = np.array([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]])
    loads = rng.normal(size=(4, 3)) + 1j * rng.normal(size=(4, 3))
    loads[0] = loads[0].real
    laws = (Stages((-0.3, 0.5), (3.0, 1.0, 5.0)), Stages((0.1,), (0.0, 6.0)))
    parameters = [[1.0, 0.5, 1.0, 4.0, -0.3, -1.0, 2.0], [0.0, 0.1, 1.0, 6.0]]
    return StageBases(M, C, K, W, parameters), Case(M, C, K, W, laws, dict(enumerate(loads)))


@pytest.mark.parametrize("seed", range(4))
def test_against_integration_from_kink_to_kink(seed: int) -> None:
    """DOP853 with a relative tolerance of 1e-12 on the equations written out anew."""
    bases, case = random_case(seed)
    motion = PiecewiseMotion(bases, np.array(list(case.loads.values())), 0.7)
    initial = np.array([0.4, -0.2, 0.3, 0.1, 0.5, -0.4])
    end, samples = flow(case, 0.7, initial, 3 * motion.period, samples=3 * 256)
    found = motion.run(bases.coordinates.state(initial[:3], initial[3:]), 3, samples_per_period=256)
    assert found.crossings >= 6
    np.testing.assert_allclose(np.hstack([found.angles, found.rates]), samples, atol=2e-9)
    np.testing.assert_allclose(np.concatenate(ends(motion, found.state)), end[:, 0], atol=2e-9)


@pytest.mark.parametrize("samples", [8, 33, 1024])
def test_crossings_are_found_on_any_grid(samples: int) -> None:
    """A grid far coarser than the default finds the same motion: turns in between are looked for, and fast modes."""
    bases, case = random_case(1)
    loads = np.array(list(case.loads.values()))
    expected = PiecewiseMotion(bases, loads, 0.7).flow(None, 20)
    found = PiecewiseMotion(bases, loads, 0.7, samples).flow(None, 20)
    assert len(found.times) == len(expected.times) > 40
    np.testing.assert_allclose(found.times, expected.times, atol=1e-9)
    np.testing.assert_allclose(found.state, expected.state, atol=1e-9)


def test_a_hinge_that_is_barely_reached() -> None:
    """From rest under cos t the angle swings between 0 and 2(1 − …): a hinge 1e-9 below its top is crossed twice."""
    free = PiecewiseMotion(oscillator([1.0]), [[1.0]], 1.0)  # x = 1 − cos t
    assert free.flow().times.size == 1
    for depth, crossings in ((1e-3, 2), (1e-6, 2), (1e-9, 2), (-1e-9, 0), (-1e-3, 0)):
        motion = PiecewiseMotion(oscillator([1.0, 2.0 - depth, 1.0, 5.0]), [[1.0]], 1.0, 50)
        way = motion.flow()
        assert len(way.times) == 1 + crossings, depth
        if crossings:
            assert way.times[1] == pytest.approx(np.pi - np.arccos(1.0 - depth), abs=1e-7)
        angle = ends(motion, way.state)[0][0]
        assert abs(angle) < 5.0 * abs(depth) ** 1.5 + 1e-12


def test_energy_is_kept_without_damping() -> None:
    """Free motion of two coordinates over 200 s and hundreds of crossings: kinetic and elastic energy stay."""
    law = [0.5, 0.2, 1.0, 40.0, -0.1, -1.0, 15.0]
    bases = StageBases(np.diag([1.0, 2.0]), np.zeros((2, 2)), np.diag([1.0, 0.0]), [[-1.0, 1.0]], [law])
    motion = PiecewiseMotion(bases, [[0.0, 0.0]], 1.0)
    found = motion.run(start(motion, [0.5, -0.3], [0.2, 1.0]), 32)
    x = found.angles[:, 1] - found.angles[:, 0]
    elastic = 0.5 * (0.5 * x**2 + 40.0 * np.maximum(x - 0.2, 0) ** 2 + 15.0 * np.maximum(-0.1 - x, 0) ** 2)
    energy = elastic + 0.5 * found.angles[:, 0] ** 2 + 0.5 * found.rates**2 @ [1.0, 2.0]
    assert found.crossings > 200
    np.testing.assert_allclose(energy, energy[0], rtol=1e-12)


def test_a_free_chain_with_and_without_a_damper_to_ground() -> None:
    """Relative motion as integrated with the rigid part in it; the speed of the whole settles at load over damper."""
    M, K = np.diag([1.0, 0.5, 4.0]), np.array([[2.0, -2.0, 0.0], [-2.0, 2.0, 0.0], [0.0, 0.0, 0.0]])
    W, law = np.array([[0.0, -1.0, 1.0]]), [3.0, 0.1, 1.0, 4.0]
    loads = np.array([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    for damper in (0.0, 0.8):
        C = 0.1 * K / 2.0 + np.diag([0.0, 0.0, damper])
        bases = StageBases(M, C, K, W, [law], np.ones((3, 1)))
        motion = PiecewiseMotion(bases, loads, 1.3)
        assert bases.coordinates.size == (5 if damper else 4)

        def derivative(t: float, z: np.ndarray, C: np.ndarray = C) -> np.ndarray:
            x = z[2] - z[1]
            torque = 3.0 * x + 4.0 * max(0.0, x - 0.1)
            force = (loads[0] + loads[1] * np.cos(1.3 * t)) - K @ z[:3] - C @ z[3:] - W[0] * torque
            return np.concatenate([z[3:], force / np.diag(M)])

        end = solve_ivp(derivative, (0.0, 5 * motion.period), np.zeros(6), rtol=1e-11, atol=1e-12, max_step=0.01)
        angle, rate = ends(motion, motion.flow(None, 5).state)
        np.testing.assert_allclose(np.diff(angle), np.diff(end.y[:3, -1]), atol=1e-8)
        np.testing.assert_allclose(np.diff(rate), np.diff(end.y[3:, -1]), atol=1e-8)
        if damper:
            np.testing.assert_allclose(rate, end.y[3:, -1], atol=1e-8)
            settled = motion.run(motion.steady(newton=True).state)
            np.testing.assert_allclose(settled.rates.mean(axis=0), 1.0 / damper, rtol=1e-6)


def test_the_truck_on_its_period_doubled_motion() -> None:
    """Twelve bodies at 940 rpm; figures of the design paper from 25 half orders and from time integration."""
    case = dmf12()
    law = [10e3, 0.08, 1.0, 15e3, -0.08, -1.0, 15e3]
    bases = StageBases(case.M, case.C, case.K, case.weights, [law])
    motion = PiecewiseMotion(bases, np.array([case.loads[0], case.loads[1]]), 3 * 940 * RPM)
    found = motion.steady(newton=True)
    assert found.converged and found.subharmonic == 2
    harmonics = np.abs(motion.harmonics(found.state, 2, 2)[:, 0])
    np.testing.assert_allclose(harmonics, [0.083132186, 0.030240829, 0.016682064], atol=1e-8)


# --- input -----------------------------------------------------------------------------------------------------------


def test_wrong_loads_states_and_frequencies_are_refused() -> None:
    bases = oscillator(TWO_STAGES)
    with pytest.raises(ModelError, match="loads"):
        PiecewiseMotion(bases, [[0.0, 1.0]], 1.0)
    with pytest.raises(ModelError, match="base frequency"):
        PiecewiseMotion(bases, [[0.0]], 0.0)
    with pytest.raises(ModelError, match="state"):
        PiecewiseMotion(bases, [[0.0]], 1.0).flow([1.0])
