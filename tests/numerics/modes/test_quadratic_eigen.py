"""Damped modes against closed forms, the undamped limit and a dense companion pencil."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st

from torsional.errors import ModelError
from torsional.numerics.modes.damped import DampedModes, damped_modes
from torsional.numerics.modes.undamped import modes


def chain(count: int) -> np.ndarray:
    return np.diff(np.eye(count), axis=0)


def oscillator(damping: float) -> DampedModes:
    """J = 2 kg m², k = 200 Nm/rad: ω0 = 10 rad/s, critical damping 40 Nms/rad."""
    return damped_modes([[1.0]], [200.0], [[1.0]], [damping], [[1.0]], [2.0])


def test_weak_damping_gives_one_entry_for_the_pair() -> None:
    found = oscillator(8.0)  # ζ = 0.2
    np.testing.assert_allclose(found.eigenvalues, [-2.0 + 1j * 10 * np.sqrt(0.96)], rtol=1e-15)
    np.testing.assert_allclose(found.omega, [10.0], rtol=1e-15)
    np.testing.assert_allclose(found.damping_ratio, [0.2], rtol=1e-14)


def test_overdamping_gives_two_real_roots() -> None:
    found = oscillator(50.0)  # ζ = 1.25: λ = −10 (1.25 ± 0.75)
    np.testing.assert_allclose(found.eigenvalues, [-5.0, -20.0], rtol=1e-14)
    np.testing.assert_array_equal(found.eigenvalues.imag, 0.0)
    np.testing.assert_allclose(found.damping_ratio, 1.0, rtol=1e-15)


def test_critical_damping_is_found_to_the_root_of_rounding() -> None:
    found = oscillator(40.0)
    np.testing.assert_allclose(found.eigenvalues, -10.0, rtol=1e-7)


def test_negative_damping_grows() -> None:
    """A falling friction curve, linearised."""
    found = oscillator(-8.0)
    np.testing.assert_allclose(found.eigenvalues, [2.0 + 1j * 10 * np.sqrt(0.96)], rtol=1e-15)
    np.testing.assert_allclose(found.damping_ratio, [-0.2], rtol=1e-14)


def test_without_damping_they_are_the_undamped_modes() -> None:
    inertia, stiffness = [1e-4, 3.0, 0.2, 1e4], [1e9, 10.0, 4e5]
    omega, shapes = modes(chain(4), stiffness, np.eye(4), inertia)
    found = damped_modes(chain(4), stiffness, np.zeros((0, 4)), [], np.eye(4), inertia)
    np.testing.assert_allclose(found.eigenvalues.imag, omega, rtol=1e-12)
    np.testing.assert_allclose(found.eigenvalues.real, 0.0, atol=1e-12)
    size = np.sqrt(inertia)[:, None]
    np.testing.assert_allclose(np.abs(size * found.shapes), np.abs(size * shapes), atol=1e-12)


def test_proportional_damping_has_ratios_in_closed_form() -> None:
    """C = β K on a free chain: ζ = β ω / 2, and the rigid mode stays at exactly zero, once."""
    inertia, stiffness, beta = [0.2, 1.4, 0.9, 12.0], np.array([2.4e6, 1.2e4, 8e3]), 1e-5
    omega = modes(chain(4), stiffness, np.eye(4), inertia).omega
    found = damped_modes(chain(4), stiffness, chain(4), beta * stiffness, np.eye(4), inertia)
    assert len(found.omega) == 4 and found.eigenvalues[0] == 0.0 and found.damping_ratio[0] == 0.0
    np.testing.assert_allclose(found.omega, omega, rtol=1e-13)
    np.testing.assert_allclose(found.damping_ratio[1:], 0.5 * beta * omega[1:], rtol=1e-10)


def test_a_rigid_body_held_by_a_damper() -> None:
    """J φ̈ + c φ̇ = 0: λ = 0 and λ = −c/J."""
    found = damped_modes(np.zeros((0, 1)), [], [[1.0]], [3.0], [[1.0]], [2.0])
    assert found.eigenvalues[0] == 0.0
    np.testing.assert_allclose(found.eigenvalues, [0.0, -1.5], rtol=1e-15)
    np.testing.assert_array_equal(found.damping_ratio, [0.0, 1.0])


def test_two_free_parts_joined_by_a_damper_alone() -> None:
    """They turn together freely (λ = 0), twist and stay (λ = 0) or lose their slip at c (1/J1 + 1/J2)."""
    found = damped_modes(np.zeros((0, 2)), [], chain(2), [6.0], np.eye(2), [2.0, 3.0])
    np.testing.assert_array_equal(found.eigenvalues[:2], 0.0)
    assert found.eigenvalues[2] == pytest.approx(-6.0 * (1 / 2 + 1 / 3), rel=1e-14)
    slip = found.shapes[:, 2]
    assert slip[0] / slip[1] == pytest.approx(-1.5, rel=1e-14)


def test_free_chain_with_a_damper_to_ground_keeps_an_exact_zero() -> None:
    weights = np.vstack([chain(3), [[0.0, 0.0, 1.0]]])
    found = damped_modes(chain(3), [2e5, 3e3], weights, [5.0, 20.0, 1.0], np.eye(3), [0.2, 1.4, 12.0])
    assert found.eigenvalues[0] == 0.0 and np.count_nonzero(found.eigenvalues == 0.0) == 1
    assert found.eigenvalues[1] == pytest.approx(-1.0 / 13.6, rel=2e-4)  # nearly the whole chain against the damper
    np.testing.assert_allclose(found.shapes[:, 0], 1.0 / np.sqrt(13.6), rtol=1e-14)
    assert len(found.omega) == 4


@given(st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=40)
def test_random_networks_against_the_dense_pencil(seed: int) -> None:
    """All of λ against scipy's QZ on the companion pencil; every pair solves the equation."""
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(2, 13))
    rows = np.vstack([chain(nodes), rng.choice([-1.0, 0.0, 1.0], (3, nodes)), np.eye(nodes)[:1]])
    k = np.append(10.0 ** rng.uniform(3, 6, len(rows) - 1), 500.0)
    c, J = 10.0 ** rng.uniform(0, 3, len(rows)), 10.0 ** rng.uniform(-2, 1, nodes)
    found = damped_modes(rows, k, rows, c, np.eye(nodes), J)
    K, C, M = rows.T @ np.diag(k) @ rows, rows.T @ np.diag(c) @ rows, np.diag(J)
    zero, one = np.zeros_like(M), np.eye(nodes)
    companion = scipy.linalg.eigvals(np.block([[zero, one], [-K, -C]]), np.block([[one, zero], [zero, M]]))
    expected = companion[companion.imag > -1e-9 * np.abs(companion)]
    assert len(found.eigenvalues) == len(expected)
    distance = np.abs(found.eigenvalues[:, None] - expected).min(axis=1)
    assert np.all(distance <= 1e-7 * found.omega)
    for value, shape in zip(found.eigenvalues, found.shapes.T, strict=True):
        terms = np.abs(value) ** 2 * (M @ np.abs(shape)) + np.abs(value) * (np.abs(C) @ np.abs(shape))
        residual = (value**2 * M + value * C + K) @ shape
        assert np.linalg.norm(residual) <= 1e-8 * np.linalg.norm(terms + np.abs(K) @ np.abs(shape))
    np.testing.assert_allclose(np.einsum("ij,i,ij->j", found.shapes.conj(), J, found.shapes), 1.0, rtol=1e-12)
    assert np.all(np.diff(found.omega) >= 0.0)


def test_bad_values_are_refused() -> None:
    with pytest.raises(ModelError, match="inertia"):
        damped_modes([[1.0]], [1.0], [[1.0]], [1.0], [[1.0]], [-2.0])
