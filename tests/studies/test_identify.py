"""Parameters found by least squares: recovery, what they are worth, and what is refused."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.studies.estimates import Identified, Measured, Unknown
from torsional.studies.identify import appraised, identified

X = np.linspace(0.0, 1.0, 400)
DECAY = [Unknown("torque", "torque", 1.0, 0.1, 20.0), Unknown("rate", "eigenvalue", 6.0, 0.0, 20.0)]


def decay(values: Mapping[str, float]) -> list[Array]:
    return [values["torque"] * np.exp(-values["rate"] * X), values["torque"] * X]


def noisy(seed: int, noise: float = 0.05) -> list[Measured]:
    draw = np.random.default_rng(seed)
    true = decay({"torque": 3.0, "rate": 2.0})
    return [Measured(f"point {i}", each + noise * draw.standard_normal(X.size), noise) for i, each in enumerate(true)]


def test_deviations_cover_the_truth() -> None:
    """Over 200 draws of the noise estimates scatter as their deviations say, and 95 % lie within two of them."""
    runs = [identified(decay, noisy(seed), DECAY) for seed in range(200)]
    z = np.array([(run.estimates - [3.0, 2.0]) / run.deviations for run in runs])
    assert np.abs(z.mean(axis=0)).max() < 0.25
    assert z.std(axis=0) == pytest.approx([1.0, 1.0], abs=0.15)
    assert 0.92 < (np.abs(z) < 1.96).mean() < 0.98
    assert np.mean([run.misfit for run in runs]) == pytest.approx(1.0, abs=0.005)


def test_deviations_and_correlation_of_a_straight_line() -> None:
    """In closed form: σ² (XᵀX)⁻¹, with the spread of the residuals for σ."""
    draw = np.random.default_rng(3)
    values = 2.0 * X + 1.0 + 0.1 * draw.standard_normal(X.size)
    unknowns = [Unknown("k", "stiffness", 0.5, -9.0, 9.0), Unknown("T", "torque", 0.3, -9.0, 9.0)]
    found = identified(lambda v: [v["k"] * X + v["T"]], [Measured("line", values, 0.1)], unknowns)
    design = np.column_stack([X, np.ones(X.size)])
    best, squares, *_ = np.linalg.lstsq(design, values, rcond=None)
    covariance = squares[0] / (X.size - 2) * np.linalg.inv(design.T @ design)
    assert found.estimates == pytest.approx(best, rel=1e-6)
    assert found.covariance == pytest.approx(covariance, rel=1e-6)
    assert found.confused(0.8) == [("T", "k", pytest.approx(float(found.correlation[0, 1])))]
    told = found.dataset()
    assert told.estimate.sel(parameter="k").item() == pytest.approx(best[0], rel=1e-6)
    assert told.unit.values.tolist() == ["Nm/rad", "Nm"] and told.misfit.sizes == {"point": 1}


def test_slopes_are_derivatives() -> None:
    here = [Unknown("torque", "torque", 3.0, 0.1, 20.0), Unknown("rate", "eigenvalue", 2.0, 0.0, 2.0)]
    found = appraised(decay, noisy(1), here)
    wave = np.exp(-2.0 * X) / 0.05
    exact = np.column_stack([np.concatenate([-3.0 * wave, -3.0 * X / 0.05]), np.append(2.0 * 3.0 * X * wave, 0.0 * X)])
    assert np.abs(found.slopes - exact).max() < 0.02 * np.abs(exact).max()
    assert found.values == {"torque": 3.0, "rate": 2.0}


def test_a_parameter_that_data_do_not_tell() -> None:
    asked = [*DECAY, Unknown("idle", "torque", 1.0, 0.0, 2.0)]
    found = appraised(decay, noisy(1), asked)
    assert np.isinf(found.deviations).tolist() == [False, False, True] and np.isnan(found.correlation[2]).all()
    without = appraised(decay, noisy(1), DECAY)
    assert found.deviations[:2] == pytest.approx(without.deviations, rel=1e-3)  # one degree of freedom less


def test_weights_choose_between_points_that_contradict() -> None:
    points = [Measured("low", np.full(50, 1.0), 0.1, weight=3.0), Measured("high", np.full(50, 2.0), 0.1)]
    found = identified(lambda v: [np.full(50, v["T"])] * 2, points, [Unknown("T", "torque", 5.0, 0.0, 9.0)])
    assert found.values["T"] == pytest.approx((9.0 * 1.0 + 2.0) / 10.0)
    assert found.misfits == pytest.approx([1.0, 9.0])


def test_several_starts_leave_a_local_minimum() -> None:
    wave = Measured("wave", np.sin(40.0 * X), 0.01)
    asked = [Unknown("frequency", "angular_frequency", 10.0, 1.0, 60.0)]

    def run(starts: int) -> Identified:
        return identified(lambda v: [np.sin(v["frequency"] * X)], [wave], asked, starts=starts, seed=1)

    assert abs(run(1).values["frequency"] - 40.0) > 5.0
    assert run(60).values["frequency"] == pytest.approx(40.0, rel=1e-4)
    assert (run(60).estimates == run(60).estimates).all()


def test_a_bound_that_holds_is_told() -> None:
    asked = [DECAY[0], Unknown("rate", "eigenvalue", 1.0, 0.0, 1.5)]
    assert identified(decay, noisy(1), asked).at_bounds() == ["rate"]
    assert identified(decay, noisy(1), DECAY).at_bounds() == []


@pytest.mark.parametrize(
    ("values", "noise", "told"),
    [
        (np.array([]), 0.1, "too few values"),
        (np.array([1.0]), 0.1, "too few values"),
        (np.array([1.0, np.nan]), 0.1, "must be finite; found 1"),
        (np.array([1.0, 2.0]), 0.0, "noise and weight"),
    ],
)
def test_bad_data_are_refused(values: Array, noise: float, told: str) -> None:
    with pytest.raises(ModelError, match=told):
        Measured("loop 1", values, noise)


def test_what_cannot_be_looked_for_is_refused() -> None:
    two = [Measured("point", np.array([1.0, 2.0]), 0.1)]
    with pytest.raises(ModelError, match="too little was measured"):
        identified(lambda v: [np.zeros(2)], two, DECAY)
    with pytest.raises(ModelError, match="something measured is wanted"):
        identified(lambda v: [], [], DECAY)
    with pytest.raises(ModelError, match="no finite value"):
        identified(lambda v: [np.full(2, np.nan)], two, DECAY[:1])
    with pytest.raises(ModelError, match="operating points differ"):
        identified(lambda v: [], two, DECAY[:1])
    with pytest.raises(ModelError, match="hold the start"):
        Unknown("rate", "eigenvalue", 3.0, 0.0, 2.0)
    with pytest.raises(ModelError, match="no scale"):
        Unknown("torque", "torque", 0.0, -1.0, 1.0)
    with pytest.raises(ModelError, match="no such quantity"):
        Unknown("torque", "force of habit", 1.0, 0.0, 2.0)
