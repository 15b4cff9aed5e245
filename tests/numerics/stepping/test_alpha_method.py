"""The generalised-α family: what it damps at ωh = 1 and at infinity, and where members coincide."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.numerics.stepping.alpha_method import AlphaMethod


@pytest.mark.parametrize(
    ("rho", "left"), [(0.9, 0.9999422589), (0.8, 0.9994746140), (0.5, 0.9893127860), (0.0, 0.9065633333), (1.0, 1.0)]
)
def test_what_a_step_leaves(rho: float, left: float) -> None:
    method = AlphaMethod.chung_hulbert(rho)
    assert float(method.spectral_radius_at(1.0)) == pytest.approx(left, abs=5e-11)
    assert float(method.spectral_radius_at(1e6)) == pytest.approx(rho, abs=3e-4)  # a threefold root


def test_members_that_coincide() -> None:
    left, right = AlphaMethod.hht(0.5), AlphaMethod.chung_hulbert(0.5)
    np.testing.assert_allclose(
        [left.alpha_m, left.alpha_f, left.beta, left.gamma], [right.alpha_m, right.alpha_f, right.beta, right.gamma]
    )
    assert AlphaMethod.hht(1.0) == AlphaMethod.bossak(1.0) == AlphaMethod.newmark()


@pytest.mark.parametrize("member", [AlphaMethod.hht, AlphaMethod.bossak])
def test_fastest_motion_is_damped_as_told(member) -> None:  # type: ignore[no-untyped-def]
    for rho in (0.5, 0.7, 0.95):
        assert float(member(rho).spectral_radius_at(1e7)) == pytest.approx(rho, abs=1e-4)


def test_radius_keeps_the_shape() -> None:
    found = AlphaMethod.newmark().spectral_radius_at([[0.1, 1.0, 30.0]])
    np.testing.assert_allclose(found, np.ones((1, 3)), atol=1e-13)


@pytest.mark.parametrize(
    ("member", "rho"),
    [("chung_hulbert", -0.1), ("chung_hulbert", 1.1), ("chung_hulbert", float("nan")), ("hht", 0.4), ("bossak", 2.0)],
)
def test_radii_that_no_member_has(member: str, rho: float) -> None:
    with pytest.raises(ModelError, match="spectral_radius: no such time step"):
        getattr(AlphaMethod, member)(rho)
