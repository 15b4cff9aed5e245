"""The claims about time steps with gap-activated springs (E1, E2), and what they are measured by."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.numerics.explicit_rates import fill_rates, places
from torsional.studies.claims import Outcome
from torsional.studies.claims.loose_springs import LooseMotion, loosened
from torsional.studies.claims.time_stepping import RADII, STEPS, largest, stepped
from torsional.studies.claims.trucks import Trucks


@pytest.fixture(scope="module")
def motion(trucks: Trucks) -> LooseMotion:
    return LooseMotion(trucks.dmf)


def test_general_integrators_get_the_same_equations(motion: LooseMotion) -> None:
    """The right-hand side of the arrays, at states in which springs are open and closed."""
    n, rng = motion.problem.equations.coordinates, np.random.default_rng(3)
    rates, jacobian = motion.rates(), motion.jacobian()
    at = places(motion.problem.equations)
    for size, t in ((1e-4, 0.0), (0.01, 0.0123), (0.3, 0.4)):
        whole = np.zeros(at.size)
        whole[:n] = motion.start.angle + size * rng.standard_normal(n)
        whole[n : 2 * n] = rng.standard_normal(n)
        whole[2 * n] = motion.speed
        expected, y = np.empty_like(whole), whole[: 2 * n].copy()
        fill_rates(motion.problem.equations, at, t, whole, expected)
        scale = np.abs(expected[: 2 * n]).max()
        np.testing.assert_allclose(rates(t, y), expected[: 2 * n], rtol=0, atol=1e-9 * scale)
        way = rng.standard_normal(2 * n)
        step = 1e-7 * size
        slope = (rates(t, y + step * way) - rates(t, y - step * way)) / (2 * step)
        np.testing.assert_allclose(jacobian(t, y) @ way, slope, rtol=0, atol=1e-5 * np.abs(slope).max())


def test_springs_are_loose_in_this_motion(motion: LooseMotion) -> None:
    """Tabs and springs let go and meet again in every period: the relative angle comes within the play."""
    play = 0.0171  # 0.98°, of the widest channel
    steady = motion.exact[len(motion.exact) // 2 :]
    assert abs(steady).min() < play < abs(steady).max()


def test_errors_of_the_steps(motion: LooseMotion) -> None:
    """Second order of the public call: an eighth of the step, a good fiftieth of the error."""
    coarse, fine = stepped(motion, 2e-4).error, stepped(motion, 2.5e-5).error
    assert 20 < coarse / fine < 100


def test_largest_step() -> None:
    errors = np.full(STEPS.size, 0.01)
    assert largest(errors) == STEPS[-1]
    errors[3] = np.inf
    assert largest(errors) == STEPS[2]


def test_a_truck_without_two_flywheels(trucks: Trucks) -> None:
    with pytest.raises(ModelError, match="no dual mass flywheel"):
        loosened(trucks.smf)


def test_e1(outcomes: Mapping[str, Outcome]) -> None:
    """Not merely quicker: the figures say by how much, at an error that is no larger."""
    figures = outcomes["E1"].finding.figures
    ratios = [value for name, value in figures.items() if "time over theirs" in name]
    assert len(ratios) == 4 and min(ratios) > 2.0
    assert 1e-5 < figures["their error [-]"] < 1e-3


def test_e2(outcomes: Mapping[str, Outcome]) -> None:
    """Undamped steps make energy at 0.5 ms; damped ones of any radius do not."""
    told = outcomes["E2"].finding.dataset
    at = list(STEPS).index(5e-4)
    assert float(told.error_100[at]) > 1.0
    assert max(float(told[f"error_{round(100 * radius)}"][at]) for radius in RADII[1:]) < 0.02


def test_e2_says_where_nothing_is_gained(outcomes: Mapping[str, Outcome]) -> None:
    """Rattling springs part trajectories whatever the step; springs that stay closed need no damping."""
    finding = outcomes["E2"].finding
    elsewhere = {name: value for name, value in finding.figures.items() if name.startswith("gain at")}
    assert len(elsewhere) == 3 and max(elsewhere.values()) < 3.0
    assert "700 rpm, 1000 Nm" in finding.reason
