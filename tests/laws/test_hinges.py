"""Hinges against direct integration and against the stages they were made from."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.laws.hinges import hinge_tangents

TWO_STAGE = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], lash=0.02, stop_stiffness=1e6)

stages = st.lists(st.tuples(st.floats(1.0, 500.0), st.floats(1e2, 1e5)), min_size=1, max_size=4).map(
    lambda rows: [(sum(t for t, _ in rows[: i + 1]), k) for i, (_, k) in enumerate(rows)]
)


def test_stages_meet_their_torques() -> None:
    first, second = 0.01 + 1000 / 8e3, 0.01 + 1000 / 8e3 + 2500 / 24e3
    assert TWO_STAGE.torque([first, second, -first]) == pytest.approx([1000, 3500, -1000], rel=1e-12)
    assert TWO_STAGE.tangent([0.0, 0.05, 0.2, 0.3, -0.3]).tolist() == [0, 8e3, 24e3, 1e6, 1e6]
    assert TWO_STAGE.stops == pytest.approx((-second, second))
    assert TWO_STAGE.stage([-0.2, -0.05, 0.0, 0.05, 0.2, 0.3]).tolist() == [-2, -1, 0, 1, 2, 3]


@given(stages, st.floats(0.0, 0.1), st.floats(-3000.0, 3000.0))
def test_angle_inverts_torque(rows: list[tuple[float, float]], lash: float, torque: float) -> None:
    law = Hinges.staged(rows, lash=lash)
    assert float(law.torque(law.angle(torque))) == pytest.approx(torque, rel=1e-9, abs=1e-6)


@given(stages, st.floats(0.0, 0.1), st.floats(-0.5, 0.5), st.floats(1e-3, 0.5))
def test_describing_function_is_the_first_fourier_coefficient(
    rows: list[tuple[float, float]], lash: float, centre: float, amplitude: float
) -> None:
    """Gauss's quadrature from crossing to crossing, between which the torque is a plain cosine."""
    law = Hinges.staged(rows, lash=lash)
    crossings = np.arccos(np.clip((np.array(law.gaps) - centre) / amplitude, -1.0, 1.0))
    edges = np.unique([0.0, *crossings, np.pi])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = 0.5 * np.diff(edges)[:, None]
    psi, weight = edges[:-1, None] + half * (nodes + 1), half * weights / np.pi
    torque = law.torque(centre + amplitude * np.cos(psi))
    mean, stiffness = law.describing_function(centre, amplitude)
    scale = max(abs(torque).max(), 1.0)
    assert float(mean) == pytest.approx((weight * torque).sum(), abs=1e-10 * scale)
    assert float(stiffness) * amplitude == pytest.approx(2 * (weight * torque * np.cos(psi)).sum(), abs=1e-10 * scale)


def test_bilinear_secant() -> None:
    law = Hinges(1.0, (0.0,), (1.0,), (2.0,))  # 1 below zero, 3 above
    assert float(law.secant(0.0, 0.5)) == pytest.approx(2.0)
    assert float(law.describing_function(0.0, 0.5)[1]) == pytest.approx(2.0)  # by symmetry of the two halves


def test_compiled_and_plain_kernel_agree() -> None:
    angles = np.linspace(-0.4, 0.4, 4001)
    plain = [Hinges.kernel.py_func(TWO_STAGE.parameters, a, 0.0, 0.0, 0.0)[:2] for a in angles]
    torque, tangent = TWO_STAGE.evaluate(angles)[:2]
    assert np.array_equal(np.array(plain).T, np.array([torque, tangent]))


def test_coast_side_of_its_own() -> None:
    law = Hinges.staged([(100.0, 1e3)], coast=[(50.0, 2e3)], stop_stiffness=1e5)
    assert law.torque([0.05, -0.01, -0.025]) == pytest.approx([50.0, -20.0, -50.0])
    assert law.stops == pytest.approx((-0.025, 0.1))


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ([], "at least one stage"),
        ([(100.0, -5.0)], "positive stiffness"),
        ([(100.0, float("nan"))], "positive stiffness"),
        ([(100.0, 1e3), (90.0, 2e3)], "rising torques"),
    ],
)
def test_stages_refused(rows: list[tuple[float, float]], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        Hinges.staged(rows)


def test_negative_slope_and_uncarried_torque_refused() -> None:
    with pytest.raises(ModelError, match="must not be negative"):
        Hinges(1e3, (0.1,), (1.0,), (-2e3,))
    with pytest.raises(ModelError, match="no angle carries"):
        Hinges(0.0, (0.1,), (1.0,), (1e3,)).angle(-5.0)


@given(seed=st.integers(0, 10_000))
def test_tangents_of_many_laws_are_those_of_each(seed: int) -> None:
    """At torques inside, on corners, in free ranges and beyond."""
    random = np.random.default_rng(seed)
    lash, stiff = float(random.choice([0.0, 0.02])), random.uniform(1e3, 1e4, (5, 2))
    laws = [Hinges.staged([(300.0, a), (900.0, b)], lash=lash, stop_stiffness=1e6) for a, b in stiff]
    torque = np.array([0.0, 300.0, 900.0, -300.0, 1e-9, 1200.0, *random.uniform(-1500.0, 1500.0, 9)])
    found = hinge_tangents(np.array([law.parameters for law in laws]), torque)
    np.testing.assert_array_equal(found, [law.tangent(law.angle(torque)) for law in laws])
