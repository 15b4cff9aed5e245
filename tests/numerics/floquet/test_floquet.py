"""Monodromy matrices against closed forms, tight integrations, differences of the flow and Mathieu's equation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b
from tests.validation.periodic_reference import Case, Stages, dmf12, flow, time_steady, two_stage

from torsional.errors import ModelError
from torsional.laws import Coulomb, Jenkins, LuGre, Polynomial
from torsional.numerics.floquet.remembering import monodromy_remembering
from torsional.numerics.floquet.sampled import monodromy_sampled
from torsional.numerics.linear.exponential import exponential, exponential_less_one
from torsional.numerics.piecewise.basis import StageBases, coordinates
from torsional.numerics.piecewise.monodromy import monodromy, multipliers, ordered

TWO_PI = 2.0 * np.pi
TWO_STAGES = [1.0, 1.0, 1.0, 1.0]  # f = x for x ≤ 1, 1 + 2 (x − 1) above


def truck(grounded: bool = True, damper: float = 0.0) -> StageBases:
    """The twelve bodies of the driveline in the papers on dual mass flywheels."""
    case = dmf12()
    K, C = case.K.copy(), case.C.copy()
    K[11, 11] -= 0.0 if grounded else 1000.0
    C[11, 11] += damper
    law = [10e3, 0.08, 1.0, 15e3, -0.08, -1.0, 15e3]
    return StageBases(case.M, C, K, case.weights, [law], None if grounded else np.ones((12, 1)))


def full_matrix(bases: StageBases, stages: tuple[int, ...]) -> np.ndarray:
    """First-order matrix of angles and rates, nothing taken out."""
    slopes = [law.slopes[j] for law, j in zip(bases.laws, stages, strict=True)]
    W, n, inverse = np.asarray(bases.weights), len(np.asarray(bases.mass)), np.linalg.inv(bases.mass)
    K = bases.stiffness + W.T @ np.diag(slopes) @ W
    return np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ bases.damping]])


def full_product(bases: StageBases, times: list[float], stages: list[tuple[int, ...]], period: float) -> np.ndarray:
    edges = [0.0, *times, period]
    product = np.eye(2 * len(np.asarray(bases.mass)))
    for stage, duration in zip([stages[-1], *stages], np.diff(edges), strict=True):
        product = expm(full_matrix(bases, stage) * duration) @ product
    return product


def random_case(seed: int) -> StageBases:
    """Three coordinates held by springs, two connections with laws of three stages."""
    rng = np.random.default_rng(seed)
    R, D = rng.normal(size=(3, 3)), rng.normal(size=(3, 3))
    laws = [[1.0, 0.5, 1.0, 4.0, -0.3, -1.0, 2.0], [0.0, 0.1, 1.0, 3.0, -0.1, -1.0, 3.0]]
    weights = [[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]]
    return StageBases(R @ R.T + np.eye(3), 0.02 * D @ D.T, np.diag([1.0, 2.0, 3.0]), np.array(weights), laws)


# --- the exponential -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [0.01, 1.0, 30.0])
def test_exponential_of_a_rotation_with_growth(size: float) -> None:
    a, b = 0.1 * size, size
    expected = np.exp(a) * np.array([[np.cos(b), np.sin(b)], [-np.sin(b), np.cos(b)]])
    np.testing.assert_allclose(exponential(np.array([[a, b], [-b, a]])), expected, atol=2e-14 * np.exp(a) * (1 + size))


def test_exponential_of_a_small_step_keeps_its_digits() -> None:
    """cos b − 1 = −2 sin²(b/2), also where squarings come in."""
    for b, tolerance in ((1e-7, 1e-15), (0.04, 1e-15), (30.0, 1e-13)):
        gain = exponential_less_one(np.array([[0.0, b], [-b, 0.0]]))
        assert gain[0, 0] == pytest.approx(-2.0 * np.sin(0.5 * b) ** 2, rel=tolerance)
        assert gain[0, 1] == pytest.approx(np.sin(b), rel=10 * tolerance)


# --- segment by segment ----------------------------------------------------------------------------------------------


def two_stage_crossings(speed: float) -> tuple[list[float], list[tuple[int]], np.ndarray]:
    """Crossings of x = 1 on the motion of one period by integration and bisection, and its multipliers."""
    case = two_stage(1.0, 1.0)
    steady = time_steady(case, speed)

    def distance(t: float) -> float:
        return float(flow(case, speed, steady.state, t)[0][0, 0] - 1.0) if t > 0 else float(steady.state[0] - 1.0)

    grid = np.linspace(0.0, steady.period, 33)
    values = [distance(t) for t in grid]
    places = [i for i in range(32) if values[i] * values[i + 1] < 0.0]
    times = [brentq(distance, grid[i], grid[i + 1], xtol=1e-13) for i in places]
    return times, [(int(values[i + 1] > 0.0),) for i in places], steady.multipliers


def test_two_stage_oscillator_beside_its_period_doubled_motion() -> None:
    """Figures of the design paper, by shooting on the exact piecewise solution: μ = −1.33454, −0.67482."""
    times, stages, reference = two_stage_crossings(2.4)
    bases = StageBases([[1.0]], [[0.04]], [[0.0]], [[1.0]], [TWO_STAGES])
    found = multipliers(bases, [times], [stages], TWO_PI / 2.4)[0]
    np.testing.assert_allclose(found, [-1.33454, -0.67482], atol=5.1e-6)
    np.testing.assert_allclose(found, reference, atol=1e-8)


@pytest.mark.parametrize("seed", range(5))
def test_monodromy_is_the_product_of_plain_exponentials(seed: int) -> None:
    bases, period = random_case(seed), 7.0
    rng = np.random.default_rng(seed)
    times = np.sort(rng.uniform(0.0, period, 6)).tolist()
    stages = [tuple(row) for row in rng.integers(0, 3, (6, 2)).tolist()]
    state = bases.coordinates
    columns = np.eye(6)
    to_state = np.array([state.state(c[:3], c[3:]) for c in columns]).T
    back = np.vstack([state.angles(columns).T, state.rates(columns).T])
    np.testing.assert_allclose(to_state @ back, columns, atol=1e-13)
    expected = full_product(bases, times, stages, period)
    np.testing.assert_allclose(back @ monodromy(bases, times, stages, period) @ to_state, expected, atol=1e-11)
    found = multipliers(bases, [times], [stages], period)[0]
    np.testing.assert_allclose(found, ordered(np.linalg.eigvals(expected)), atol=1e-10)


@pytest.mark.parametrize("seed", range(5))
def test_determinant_is_the_dissipation_of_a_period(seed: int) -> None:
    """Liouville: det Φ = exp(−∫ tr(M⁻¹C) dt), whatever the stages."""
    bases, period = random_case(seed), 5.0
    found = np.linalg.det(monodromy(bases, [0.5, 2.0, 3.0], [(1, 2), (0, 1), (2, 0)], period))
    expected = np.exp(-np.trace(np.linalg.solve(bases.mass, bases.damping)) * period)
    assert found == pytest.approx(expected, rel=1e-10)


def test_determinant_of_the_truck() -> None:
    bases, period = truck(), TWO_PI / (3 * 940 * np.pi / 30)
    phi = monodromy(bases, np.array([0.1, 0.4, 0.55, 0.8]) * period, [[2], [1], [0], [1]], period)
    expected = -np.trace(np.linalg.solve(bases.mass, bases.damping)) * period
    assert np.linalg.slogdet(phi)[1] == pytest.approx(expected, abs=1e-10)


def test_differences_of_the_flow() -> None:
    """Neighbouring motions integrated from kink to kink, two connections at once: no tangent is in the reference."""
    bases, period = random_case(3), 6.0
    W, state = np.asarray(bases.weights), bases.coordinates
    laws = (Stages((-0.3, 0.5), (3.0, 1.0, 5.0)), Stages((-0.1, 0.1), (3.0, 0.0, 3.0)))
    loads = {0: np.array([0.0, 0.5, 0.0]), 1: np.array([1.0, 0.0, 0.3j])}
    case = Case(bases.mass, bases.damping, bases.stiffness, W, laws, loads)
    start = np.array([0.4, -0.2, 0.3, 0.1, 0.5, -0.4])
    samples = flow(case, TWO_PI / period, start, period, samples=30000)[1]
    numbers = bases.stage(samples[:, :3] @ W.T)
    last = np.flatnonzero(np.any(np.diff(numbers, axis=0), axis=1))
    assert len(last) >= 4
    times = [0.0, *crossing_times(samples, W, bases, last, period / 30000)]
    phi = monodromy(bases, times, numbers[[0, *(last + 1)]], period)
    for step in 1e-5 * np.eye(6):
        ends = [flow(case, TWO_PI / period, start + sign * step, period)[0][:, 0] for sign in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / 2.0
        expected = state.state(difference[:3], difference[3:])
        np.testing.assert_allclose(phi @ state.state(step[:3], step[3:]), expected, atol=1e-11 * np.abs(phi).max())


def crossing_times(
    samples: np.ndarray, W: np.ndarray, bases: StageBases, last: np.ndarray, width: float
) -> list[float]:
    """Times at which a connection passes an edge, by interpolation between close samples."""
    times = []
    for i in last:
        for e, law in enumerate(bases.laws):
            for edge in law.edges:
                before, after = (float(W[e] @ samples[k, :3] - edge) for k in (i, i + 1))
                if before * after < 0.0:
                    times.append(width * (i + before / (before - after)))
    return times


# --- rigid modes -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("damper", "removed"), [(0.0, 2), (3.0, 1)])
def test_rigid_multipliers_are_left_out_and_no_others(damper: float, removed: int) -> None:
    bases, period = truck(grounded=False, damper=damper), 0.02
    times, stages = [0.002, 0.008, 0.011, 0.016], [(2,), (1,), (0,), (1,)]
    assert bases.coordinates.removed == removed
    assert bases.coordinates.size == 24 - removed
    found = multipliers(bases, [times], [stages], period)[0]
    full = ordered(np.linalg.eigvals(full_product(bases, times, stages, period)))
    # a double multiplier of a full matrix is blurred by the square root of rounding; without it, it is exact
    distance = [np.abs(full - value).min() for value in found]
    assert max(distance) < 1e-7
    if damper:  # the speed of the whole decays through the damper at the vehicle
        assert np.abs(found - np.exp(-damper * period / np.asarray(bases.mass).trace())).min() < 1e-6
    else:
        assert np.abs(found).max() < 1.0 - 1e-4


def test_two_parts_that_are_free_of_each_other() -> None:
    """Two pairs of discs, a damper to ground on the first only: three multipliers +1 go, the damped speed stays."""
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    K, C = np.kron(np.eye(2), pair), np.diag([0.5, 0.0, 0.0, 0.0])
    rigid = np.kron(np.eye(2), [[1.0], [1.0]])
    state = coordinates(np.diag([1.0, 2.0, 3.0, 4.0]), C, K, [[-1.0, 1.0, 0.0, 0.0]], rigid)
    assert (state.size, state.removed) == (5, 3)
    full = np.block([[np.zeros((4, 4)), np.eye(4)], [-K / [[1], [2], [3], [4]], -C / [[1], [2], [3], [4]]]])
    expected = np.sort_complex(np.linalg.eigvals(full))
    for value in np.linalg.eigvals(state.matrix):
        assert np.abs(expected - value).min() < 1e-7


def test_a_rigid_vector_that_loads_a_spring_is_refused() -> None:
    with pytest.raises(ModelError, match="must not load any spring"):
        coordinates(np.eye(2), np.zeros((2, 2)), [[1.0, -1.0], [-1.0, 1.5]], [[-1.0, 1.0]], [[1.0], [1.0]])


def test_massless_coordinates_are_refused() -> None:
    with pytest.raises(ModelError, match="positive definite"):
        coordinates(np.diag([1.0, 0.0]), np.zeros((2, 2)), np.eye(2), [[-1.0, 1.0]])


# --- nearly defective stages -----------------------------------------------------------------------------------------


def test_free_flight_takes_the_exponential() -> None:
    """Mass 1 between stops k = 100 at ±1: flight [[1, τ], [0, 1]] and half a swing of contact, ω = 10."""
    bases = StageBases([[1.0]], [[0.0]], [[0.0]], [[1.0]], [[0.0, 1.0, 1.0, 100.0, -1.0, -1.0, 100.0]])
    assert bases.basis((1,)).plain and not bases.basis((2,)).plain
    flight, contact = np.array([[1.0, 2.0], [0.0, 1.0]]), np.array([[0.0, 0.1], [-10.0, 0.0]])
    quarter = np.pi / 20.0
    phi = monodromy(bases, [0.0, quarter, quarter + 2.0], [(2,), (1,), (0,)], 2 * quarter + 2.0)
    state = bases.coordinates
    scale = np.diag([1.0 / state.scale[0], 1.0]) * state.shapes[0, 0]
    np.testing.assert_allclose(scale @ phi @ np.linalg.inv(scale), contact @ flight @ contact, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("offset", [0.0, 1e-12, 1e-9, 1e-6, 1e-3])
def test_close_to_critical_damping(offset: float) -> None:
    """Either route near the border is exact: x = (1 + t) e^{−t} at critical damping."""
    damping, t = 2.0 * (1.0 + offset), 1.7
    bases = StageBases([[1.0]], [[damping]], [[1.0]], [[1.0]], [[0.0]])
    assert bases.basis((0,)).plain == (offset < 1e-9)
    root = np.sqrt((1.0 + offset) ** 2 - 1.0)
    growth = np.sinh(root * t) / root if root else t
    expected = np.exp(-(1.0 + offset) * t) * (np.cosh(root * t) + (1.0 + offset) * growth)
    assert monodromy(bases, [], [[0]], t)[0, 0] == pytest.approx(expected, abs=1e-11)


# --- batches and input -----------------------------------------------------------------------------------------------


def test_a_batch_is_its_points() -> None:
    bases, rng = truck(), np.random.default_rng(0)
    periods = rng.uniform(0.01, 0.03, 7)
    times = [np.sort(rng.uniform(0, p, n)) for p, n in zip(periods, [0, 2, 4, 2, 0, 4, 2], strict=True)]
    stages = [[[1]], *([[[2], [1], [0], [1]][: len(t)] or [[2]] for t in times[1:]])]
    found = multipliers(bases, times, stages, periods)
    assert np.all(np.diff(np.abs(found)) <= 1e-15)
    for i, period in enumerate(periods):
        expected = ordered(np.linalg.eigvals(monodromy(bases, times[i], stages[i], period)))
        np.testing.assert_allclose(np.abs(found[i]), np.abs(expected), atol=1e-11)


def test_crossings_out_of_order_are_refused() -> None:
    with pytest.raises(ModelError, match="ascend"):
        monodromy(random_case(0), [2.0, 1.0], [(0, 0), (1, 1)], 3.0)
    with pytest.raises(ModelError, match="ascend"):
        monodromy(random_case(0), [1.0], [(0, 0), (1, 1)], 3.0)


# --- sampled laws ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("q", [0.5, 2.0])
def test_mathieu_boundaries(q: float) -> None:
    """x'' + (a − 2q cos 2t) x = 0 has a multiplier ±1, trace ±2, at the characteristic numbers a_n and b_n."""
    t = np.pi * np.arange(256) / 256
    oscillator = coordinates([[1.0]], [[0.0]], [[3.0]], [[1.0]])
    for n in range(3):
        for a in [mathieu_a(n, q), *([mathieu_b(n, q)] if n else [])]:
            deviation = (a - 2.0 * q * np.cos(2.0 * t) - 3.0)[:, None]
            found = monodromy_sampled(oscillator, deviation, np.zeros((256, 1)), np.pi)
            assert np.trace(found.matrix) == pytest.approx(2.0 * (-1) ** n, abs=1e-9)
            assert np.linalg.det(found.matrix) == pytest.approx(1.0, abs=1e-12)


def smooth_reference(bases: StageBases, period: float) -> tuple[np.ndarray, object]:
    state = bases.coordinates
    angle, rate = state.angle_rows, state.rate_rows

    def deviations(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        tau = TWO_PI * np.asarray(t)[..., None] / period
        shift = np.array([0.0, 1.0])
        return np.cos(tau + shift) + 0.5 * np.sin(2 * tau), 0.1 + 0.2 * np.cos(tau - shift)

    def derivative(t: float, flat: np.ndarray) -> np.ndarray:
        z, (dk, dc) = flat.reshape(state.size, -1), deviations(np.array(t))
        return (state.matrix @ z - rate.T @ (dk[:, None] * (angle @ z) + dc[:, None] * (rate @ z))).ravel()

    one = np.eye(state.size).ravel()
    end = solve_ivp(derivative, (0.0, period), one, method="DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    return end.reshape(state.size, -1), deviations


def test_sampled_laws_against_integration_with_growing_numbers_of_samples() -> None:
    bases, period = random_case(1), 8.0
    expected, deviations = smooth_reference(bases, period)
    errors = []
    for samples in (64, 128, 256, 512):
        found = monodromy_sampled(bases.coordinates, *deviations(np.arange(samples) * period / samples), period)
        errors.append(np.abs(found.matrix - expected).max())
        assert errors[-1] < found.error
    assert errors[-1] < 1e-9
    assert errors[0] / errors[1] > 14.0  # at least the fourth order


def test_finely_sampled_stages_come_near_the_exact_product() -> None:
    bases, period = truck(), TWO_PI / (3 * 940 * np.pi / 30)
    times, stages = np.array([0.1, 0.4, 0.55, 0.8]) * period, [[2], [1], [0], [1]]
    expected = monodromy(bases, times, stages, period)
    t = (np.arange(4096)) * period / 4096
    slopes = bases.laws[0].slopes[np.array([1, 2, 1, 0, 1])[np.searchsorted(times, t)]]
    found = monodromy_sampled(bases.coordinates, (slopes - bases.reference)[:, None], np.zeros((4096, 1)), period)
    error = np.abs(found.matrix - expected).max()
    assert error < found.error < 1e-3


def test_samples_must_be_a_multiple_of_four() -> None:
    with pytest.raises(ModelError, match="multiple of four"):
        monodromy_sampled(random_case(0).coordinates, np.zeros((6, 2)), np.zeros((6, 2)), 1.0)


# --- laws that remember ---


def monodromy_of_washer(half_width: float, samples: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Of a disc on a spring of 3 with a washer that slips at 0.1 rad, swung over a ``half_width`` with ω = 1.7; and
    the flow of the disc where the washer sticks, by its closed form."""
    washer, period, damping = Jenkins(0.2, 2.0), TWO_PI / 1.7, 0.3
    tau = TWO_PI * np.arange(samples) / samples
    state = coordinates([[1.0]], [[damping]], [[3.0]], [[1.0]])
    found = monodromy_remembering(
        state,
        [(washer.address, washer.packed)],
        np.ones(1),
        np.zeros(1),
        half_width * np.cos(tau)[None],
        -1.7 * half_width * np.sin(tau)[None],
        period,
    )
    return found, expm(period * np.array([[0.0, 1.0], [-3.0 - washer.stiffness, -damping]]))


def test_a_washer_that_sticks_is_a_spring_and_keeps_what_it_was_given() -> None:
    """Two multipliers of 1 kgm² on 3 + 2 Nm/rad, and one of one: how far the washer has slipped before stays."""
    for samples in (16, 64):
        found, stuck = monodromy_of_washer(0.04, samples)
        expected = [*np.linalg.eigvals(stuck), 1.0]
        step = TWO_PI / 1.7 / samples  # the washer's torque is a ramp over each step
        np.testing.assert_allclose(ordered(np.linalg.eigvals(found)), ordered(np.array(expected)), atol=0.5 * step**2)


def test_a_washer_that_slips_forgets() -> None:
    """However its memory is disturbed, after a cycle that slips both ways it is what the motion makes of it."""
    found, _ = monodromy_of_washer(0.4)
    values = np.abs(ordered(np.linalg.eigvals(found)))
    assert values[1] > 0.1 and values[2] < 1e-12


@pytest.mark.parametrize(("damping", "order", "least"), [(0.0, 2, 1e-3), (0.5, 1, 0.02)])
def test_bristles_beside_smooth_laws_against_integration(damping: float, order: int, least: float) -> None:
    """ż = u − σ0 |u| z/g(u), a cubic spring and smooth friction, linearised by hand and integrated."""
    bristles, cubic, omega = LuGre(20.0, damping, 1.0, 1.6, 0.5), Polynomial((2.0, 0.0, 5.0)), 2.3
    W, size = np.array([[-1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), np.array([0.2, 0.3, 0.1])
    rubbing, period = Coulomb(0.4, 0.5), TWO_PI / 2.3
    state = coordinates(np.diag([1.0, 0.5]), 0.2 * np.eye(2), np.diag([3.0, 1.0]), W)

    def motion(tau: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Rates change their sign at samples, where the bristles' law has a kink."""
        return np.multiply.outer(size, np.cos(tau)), np.multiply.outer(-omega * size, np.sin(tau))

    def bend(u: float, z: float) -> tuple[float, float, float]:
        """ż and its derivatives by u and z."""
        raised = 0.6 * np.exp(-((u / 0.5) ** 2))
        g, slope = 1.0 + raised, -2.0 * u / 0.25 * raised
        return u - 20.0 * abs(u) * z / g, 1.0 - 20.0 * z * (np.sign(u) * g - abs(u) * slope) / g**2, -20.0 * abs(u) / g

    def derivative(t: float, y: np.ndarray) -> np.ndarray:
        (_, x, _), (u, _, v) = motion(omega * t)
        flow, by_rate, by_memory = bend(float(u), y[0])
        d = y[1:].reshape(state.size + 1, -1)
        angle, rate = state.angle_rows @ d[:-1], state.rate_rows @ d[:-1]
        d_flow = by_rate * rate[0] + by_memory * d[-1]
        drag = 0.4 * 0.25 / (v**2 + 0.25) ** 1.5
        torque = np.array([20.0 * d[-1] + damping * d_flow, (2.0 + 15.0 * x**2) * angle[1], drag * rate[2]])
        moved = state.matrix @ d[:-1] - state.rate_rows.T @ torque
        return np.concatenate([[flow], np.vstack([moved, d_flow]).ravel()])

    end = np.zeros(1)
    for _ in range(3):  # the bristles' own motion settles
        start = np.concatenate([end[:1], np.eye(state.size + 1).ravel()])
        for half in (0.0, 0.5 * period):
            span = (half, half + 0.5 * period)
            start = end = solve_ivp(derivative, span, start, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    expected, errors = end[1:].reshape(state.size + 1, -1), []
    laws = [(law.address, law.packed) for law in (bristles, cubic, rubbing)]
    for samples in (256, 512, 1024):
        given = motion(TWO_PI * np.arange(samples) / samples)
        found = monodromy_remembering(state, laws, np.array([1.0, 0.0, 0.0]), np.zeros(3), *given, period)
        errors.append(np.abs(found - expected).max())
    assert errors[-1] < least
    assert np.log2(errors[0] / errors[-1]) / 2.0 > order - 0.1
