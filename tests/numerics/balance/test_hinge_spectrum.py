"""Spectra of piecewise-linear laws along sums of harmonics, against integrals taken kink by kink and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from tests.solvers.periodic.machines import as_hinges, law_harmonics
from tests.validation.periodic_reference import Stages

from torsional.numerics.balance.hinge_spectrum import crossings, hinge_spectrum, motion, scan_table

LAWS = [
    Stages((-0.3, 0.4), (5.0, 1.0, 2.0)),
    Stages((-0.2, 0.2), (50.0, 0.0, 50.0)),
    Stages((0.1,), (0.0, 100.0)),
    Stages((-1.0, -0.7, -0.1, 0.25, 0.6), (9.0, 3.0, 2.0, 1.0, 4.0, 20.0)),
    Stages((0.0,), (1.0, 3.0)),
]


def spectra(law: np.ndarray, x: np.ndarray, samples: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """S_j and O_j, j ≥ 0, and the crossings (τ, hinge, rising)."""
    H = len(x) // 2
    S, O, found = np.empty(2 * H + 2, complex), np.empty(2 * H + 2, complex), np.empty((16 * H + 64, 3))
    count = hinge_spectrum(law, x, scan_table(H, samples) @ x, S, O, found)
    return S, O, found[:count]


def force(law: np.ndarray, x: np.ndarray, samples: int = 0) -> np.ndarray:
    """Complex 0-peak harmonics of the torque: the convolution of S with the motion less O."""
    H = len(x) // 2
    S, O, _ = spectra(law, x, samples)
    half = np.concatenate([x[:1], (x[1::2] + 1j * x[2::2]) / 2])
    wide = np.concatenate([half[:0:-1].conj(), half])
    both = np.concatenate([S[:0:-1].conj(), S])
    out = np.array([both[k + H + 1 : k + 3 * H + 2][::-1] @ wide for k in range(H + 1)]) - O[: H + 1]
    out[1:] *= 2
    return out


def random_motion(rng: np.random.Generator, harmonics: int, decay: float) -> np.ndarray:
    """x_0, Re X_1, Im X_1, …, which fall with the number of the harmonic."""
    size = np.arange(1, harmonics + 1.0) ** -decay
    parts = rng.normal(size=(harmonics, 2)) * size[:, None]
    return np.concatenate([[0.5 * rng.normal()], parts.ravel()])


def as_harmonics(x: np.ndarray) -> np.ndarray:
    return np.concatenate([x[:1], x[1::2] + 1j * x[2::2]])


@pytest.mark.parametrize("law", LAWS, ids=lambda law: str(law.edges))
def test_forces_of_random_motions(law: Stages) -> None:
    rng = np.random.default_rng(3)
    for harmonics in (1, 2, 5, 12, 30):
        for _ in range(10):
            x = random_motion(rng, harmonics, 3.0)
            found = force(as_hinges(law).parameters, x)
            expected = law_harmonics(law, as_harmonics(x))
            np.testing.assert_allclose(found, expected, atol=2e-13 * max(law.slopes) * np.abs(x).sum())


def test_a_motion_rougher_than_any_solution_costs_a_millionth() -> None:
    """With harmonics that fall with their square, a pair of crossings between samples may be missed."""
    rng, worst = np.random.default_rng(5), 0.0
    for _ in range(50):
        x = random_motion(rng, int(rng.integers(2, 30)), 2.0)
        time = np.linspace(0.0, 2 * np.pi, 4001)
        swing = (as_harmonics(x) @ np.exp(1j * np.outer(np.arange(len(x) // 2 + 1), time))).real
        turns = swing[1:-1][(np.diff(swing)[1:] > 0) != (np.diff(swing)[:-1] > 0)]
        gap = float(rng.choice(turns) + rng.choice([-1, 1]) * 10 ** rng.uniform(-8, -1) * np.ptp(swing))
        found = force(np.array([0.0, gap, 1.0, 1.0]), x)
        exact = law_harmonics(Stages((gap,), (0.0, 1.0)), as_harmonics(x))
        exact[0] += 0.0 if gap > 0 else -gap  # `Stages` are free of torque at angle zero, a hinge at its gap
        worst = max(worst, float(np.abs(found - exact).max() / np.ptp(swing)))
    assert worst < 1e-5


def test_tangent_spectrum() -> None:
    """S_j is the transform of the slope, whose steps are at the crossings."""
    law, rng = LAWS[3], np.random.default_rng(8)
    x = random_motion(rng, 6, 2.0)
    S, _, _ = spectra(as_hinges(law).parameters, x)
    tau = (np.arange(1 << 18) + 0.5) * 2 * np.pi / (1 << 18)
    slope = law.slopes_along((as_harmonics(x) @ np.exp(1j * np.outer(np.arange(7), tau))).real)
    expected = np.exp(-1j * np.outer(np.arange(len(S)), tau)) @ slope / len(tau)
    np.testing.assert_allclose(S, expected, atol=3e-5 * max(law.slopes))


@pytest.mark.parametrize("law", LAWS, ids=lambda law: str(law.edges))
def test_samples_only_find_the_crossings(law: Stages) -> None:
    rng = np.random.default_rng(4)
    for harmonics in (1, 4, 15):
        x = random_motion(rng, harmonics, 3.0)
        few, many = (force(as_hinges(law).parameters, x, samples) for samples in (64, 1024))
        np.testing.assert_allclose(few, many, atol=1e-13 * max(law.slopes) * np.abs(x).sum())


def cap(depth: float) -> tuple[float, float, float]:
    """Share of the period, mean and first harmonic of max(0, cos τ − 1 + depth), by series where it is shallow."""
    if depth < 1e-3:
        half = np.sqrt(2 * depth) * (1 + depth / 12 + 3 * depth**2 / 160)
        cubes = half**3 / np.pi
        return half / np.pi, cubes * (1 / 3 - half**2 / 30), cubes * (2 / 3 - half**2 * 2 / 15)
    half, gap = np.arccos(1 - depth), 1 - depth
    mean = (np.sin(half) - gap * half) / np.pi
    return half / np.pi, mean, (half + np.sin(half) * np.cos(half) - 2 * gap * np.sin(half)) / np.pi


@pytest.mark.parametrize("phase", [0.0, 0.3, 0.5, 0.731])
@pytest.mark.parametrize("depth", [1.5, 0.3, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-14, 0.0, -1e-14, -1e-9, -1e-3])
def test_grazing(depth: float, phase: float) -> None:
    """A swing that hardly touches the gap, from either side, wherever its peak lies between the samples."""
    turn = phase * 2 * np.pi / 64
    x = np.array([0.0, np.cos(turn), -np.sin(turn)])
    share, mean, first = cap(depth) if depth > 0 else (0.0, 0.0, 0.0)
    blur = 1e-15 + 3e-8 * (abs(depth) <= 1e-13)  # a peak known to 1e-16 tells the length of contact to 1e-8
    S, _, _ = spectra(np.array([0.0, 1.0 - depth, 1.0, 1.0]), x)
    assert S[0].real == pytest.approx(share, rel=1e-7 if depth > 1e-9 else 1e-2, abs=blur)
    above = force(np.array([0.0, 1.0 - depth, 1.0, 1.0]), x)
    assert above[0].real == pytest.approx(mean, rel=1e-6, abs=2e-15)
    assert abs(above[1]) == pytest.approx(first, rel=1e-6, abs=2e-15)
    # the same swing seen from below its mirror image, and the spring that is left for a moment instead of touched
    below = force(np.array([0.0, depth - 1.0, -1.0, 1.0]), -x)
    np.testing.assert_allclose(below, -above, atol=1e-15)
    S, _, _ = spectra(np.array([0.0, depth - 1.0, 1.0, 1.0]), -x)
    assert S[0].real == pytest.approx(1.0 - share, abs=1e-9 + blur)


@pytest.mark.parametrize("gap, engaged", [(0.5, 0.0), (-0.5, 1.0), (0.0, 0.0)])
def test_a_motion_at_rest(gap: float, engaged: float) -> None:
    """Without vibration a hinge is engaged or not; exactly at its gap it is not."""
    S, O, found = spectra(np.array([2.0, gap, 1.0, 3.0]), np.zeros(9))
    assert (len(found), S[0]) == (0, 2.0 + 3.0 * engaged)
    assert not S[1:].any() and not O[1:].any()


def test_crossings_lie_on_the_gap_and_alternate() -> None:
    rng = np.random.default_rng(11)
    for _ in range(50):
        x = random_motion(rng, 12, 2.0)
        gap = float(x[0] + 0.3 * rng.normal())
        places, rising = np.empty(64), np.empty(64)
        count = crossings(x, scan_table(12) @ x, gap, places, rising)
        values = [motion(x, float(tau)) for tau in places[:count]]
        assert all(abs(value - gap) < 1e-13 for value, _, _ in values)
        assert all((slope > 0) == (up > 0.5) for (_, slope, _), up in zip(values, rising, strict=False))
        order = np.argsort(places[:count] % (2 * np.pi))
        assert (np.diff(rising[:count][order]) != 0).all() and count % 2 == 0


def test_slope_and_curvature_of_a_motion() -> None:
    x = random_motion(np.random.default_rng(2), 7, 1.0)
    step = 1e-4
    value, slope, curvature = motion(x, 1.0)
    before, after = motion(x, 1.0 - step)[0], motion(x, 1.0 + step)[0]
    assert slope == pytest.approx((after - before) / (2 * step), rel=1e-5)
    assert curvature == pytest.approx((after - 2 * value + before) / step**2, rel=1e-5)
