"""The claims about time steps with gap-activated springs (E1, E2), and what they are measured by."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.numerics.explicit.rates import fill_rates, places
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Settings, begin, march
from torsional.studies.base import Outcome
from torsional.studies.claims.longer_steps import RATTLING, STEPS, Rattle, largest
from torsional.studies.claims.loose_springs import LooseMotion, loosened
from torsional.studies.claims.time_stepping import stepped
from torsional.studies.trucks import Trucks


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
        fill_rates(motion.problem.equations.connected, at, t, whole, expected)
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
    figures, measured = outcomes["E1"].finding.figures, outcomes["E1"].finding.measured
    ratios = [value for name, value in measured.items() if "time over theirs" in name]
    assert not any("time" in name for name in figures)  # what the clock tells stands apart
    assert len(ratios) == 4 and min(ratios) > 2.0
    assert 1e-5 < figures["their error [-]"] < 1e-3


def test_e2(outcomes: Mapping[str, Outcome]) -> None:
    """Where springs rattle undamped steps of 0.5 ms are lost and damped ones four times as long are not."""
    outcome = outcomes["E2"]
    figures = outcome.finding.figures
    assert outcome.verdict == "reproduced with a condition" and "let go and meet" in outcome.finding.proviso
    for rpm, torque in RATTLING:
        at = f"at {rpm:g} rpm, {torque:g} Nm"
        assert figures[f"gain {at} [-]"] == 4.0
        assert figures[f"error {at}, spectral radius 1 [%]"][STEPS.tolist().index(5e-4)] == "lost"  # type: ignore[index]
    assert figures["gain, at 700 rpm, 1000 Nm, springs closed [-]"] == 1.0
    varied = [value for name, value in figures.items() if name.startswith(("gain, grease", "gain, play"))]
    assert len(varied) == 4 and min(varied) >= 2.0  # type: ignore[type-var,operator]


def test_e2_measures_motion_not_its_phase(trucks: Trucks) -> None:
    """Steps of half the length, whose rattling motion is another after a second, have the same RMS and order."""
    place = Rattle(trucks.dmf, 800.0, 100.0)
    assert max(place.error(step, 1.0) for step in (5e-5, 1e-4)) < 0.015
    fine, coarse = (_twist(place, step) for step in (5e-5, 1e-4))
    assert np.std(fine - coarse) > 0.015 * np.std(fine)


def _twist(place: Rattle, step: float) -> np.ndarray:
    """The flywheels' relative angle of the last second of a run."""
    motion = place.motion
    state = begin(motion.problem.plan, motion.start.angle, motion.start.speed)
    stride, count, settings = round(1e-3 / step), round(2.0 / step), Settings(guard=False, production=np.inf)
    run = march(
        motion.problem.plan, AlphaMethod.chung_hulbert(1.0), step, count, state, stride=stride, settings=settings
    )
    return motion.twist(run.records.q)[-1000:]
