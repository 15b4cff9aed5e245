"""`transient` by events and the certificate of its steps, on the dual mass flywheel of loose springs (DMF-LCP-1)."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.validation import dmf_lcp

from torsional.components import Coupling, Inertia
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Contacts, Coulomb, Hinges
from torsional.powertrain import Powertrain
from torsional.solvers.transient import Governor, MotionState, SpeedProfile, TorqueHistory, certified, transient
from torsional.system import System, assemble

SPEED = 900 * np.pi / 30


@pytest.fixture(scope="module")
def flywheel() -> System:
    """Its 18 bodies and 40 one-sided springs by components."""
    parts: dict[str, object] = {f"n{i}": Inertia(float(J)) for i, J in enumerate(dmf_lcp.INERTIA)}
    linear = zip(dmf_lcp.FIRST, dmf_lcp.SECOND, dmf_lcp.STIFFNESS, dmf_lcp.DAMPING, strict=True)
    for e, (a, b, k, c) in enumerate(linear):
        parts[f"l{e}"] = Coupling(f"n{a}", f"n{b}", Hinges(float(k)), damping=float(c))
    sprung = zip(dmf_lcp.PLUS, dmf_lcp.MINUS, dmf_lcp.GAP, dmf_lcp.SPRING_STIFFNESS, strict=True)
    for i, (plus, minus, gap, k) in enumerate(sprung):
        law = Contacts((-float(gap),), (-1.0,), (float(k),), (dmf_lcp.CONTACT_TIME,))
        parts[f"s{i}"] = Coupling(f"n{minus}", f"n{plus}", law)
    return assemble(Powertrain(parts))  # type: ignore[arg-type]


def driven() -> Excitation:
    torque = [[dmf_lcp.MEAN, -1j * dmf_lcp.SWING], [-dmf_lcp.MEAN, 0.0]]
    return Excitation(("n0", "n3"), [0.0, 3.0], SPEED, np.array(torque))


def run(system: System, method: str, step: float = 1e-4, **settings: object) -> xr.Dataset:
    return transient(system, driven(), 0.1, "rest", method=method, step=step, output=1e-3, **settings)  # type: ignore[arg-type]


def test_steps_and_explicit_integration_tend_to_the_exact_motion(flywheel: System) -> None:
    exact, explicit = run(flywheel, "exact"), run(flywheel, "explicit", tolerance=1e-11)
    swing = float(np.ptp(exact.angle.values))
    assert int(exact.attrs["steps"]) == 28  # events
    assert np.abs(explicit.angle - exact.angle).max() < 1e-7 * swing
    assert np.abs(explicit.torque - exact.torque).max() < 1e-5 * float(np.abs(exact.torque).max())
    assert np.abs(explicit.acceleration - exact.acceleration).max() < 1e-4 * float(np.abs(exact.acceleration).max())
    assert [dict(d.sizes) for d in (exact, explicit)] == [dict(exact.sizes)] * 2
    errors = [float(np.abs(run(flywheel, "chung_hulbert", h).angle - exact.angle).max()) for h in (4e-5, 1e-5)]
    assert errors[0] < 1e-3 * swing and errors[1] < errors[0] / 10


def test_a_step_solves_its_complementarity_problem(flywheel: System) -> None:
    done = run(flywheel, "chung_hulbert")
    told = certified(flywheel, driven(), done, 600)
    assert told.violation < 1e-9 and told.closed >= 6 and told.changes > 0 and told.steps == 600


def spring(law: object) -> System:
    return assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law)}))  # type: ignore[arg-type]


def test_free_play_by_closed_form() -> None:
    """v = 1 from the middle of 0.2, k = 100, J = 1: away for 0.1 s, π/10 s in contact, and back."""
    wall = spring(Contacts.between(-0.1, 0.1, 100.0))
    start = MotionState.at_rest(wall).moved(0.0, 1.0)
    found = transient(wall, (), 1.0, start, speed=0.0, method="exact", output=[0.1 + 0.05 * np.pi, 1.0])
    assert found.angle.values[0, 0] == pytest.approx(0.2, rel=1e-12)
    assert found.torque.values[0, 0] == pytest.approx(10.0, rel=1e-12)


@pytest.mark.parametrize(
    ("law", "drives", "speed", "said"),
    [
        (Coulomb(1.0, 0.1), (), 10.0, "no sum of hinges"),
        (Hinges(100.0), Governor("disc", 10.0, acts_on="disc", proportional=1.0), 10.0, "not governors"),
        (Hinges(100.0), TorqueHistory("disc", (0.0, 1.0), (0.0, 1.0)), 10.0, "not torques over time"),
        (Hinges(100.0), (), SpeedProfile.ramp(10.0, 20.0, 1.0), "not a speed that changes"),
    ],
)
def test_what_it_does_not_know_is_named(law: object, drives: object, speed: object, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        transient(spring(law), drives, 0.1, "rest", speed=speed, method="exact")  # type: ignore[arg-type]


def test_a_certificate_is_for_one_sided_springs_and_runs_that_go_on() -> None:
    softer = spring(Hinges(100.0, (0.1,), (1.0,), (-50.0,)))
    push = Excitation(("disc",), [0.0], 10.0, [[1.0]])
    with pytest.raises(ModelError, match="stages that soften"):
        certified(softer, push, transient(softer, push, 0.01, "rest"))
    with pytest.raises(ModelError, match="does not go on"):
        certified(softer, push, transient(softer, Excitation(("disc",), [0.0], 10.0, [[2.0]]), 0.01, "rest"))


@pytest.mark.parametrize("method", ["explicit", "exact"])
def test_a_certificate_is_for_runs_with_steps(flywheel: System, method: str) -> None:
    with pytest.raises(ModelError, match=f"no steps to go on by.*{method}"):
        certified(flywheel, driven(), run(flywheel, method))


def test_a_certificate_of_steps_that_lose_the_motion_is_refused() -> None:
    """A disc that nothing holds under T = 1e155 Nm: its energy, T² t²/2, passes the largest number at 0.1896 s."""
    system = spring(Hinges(0.0, (1e200,), (1.0,), (1.0,)))
    push = Excitation(("disc",), [0.0], 10.0, [[1e155]])
    done = transient(system, push, 0.01, "rest")
    with pytest.raises(ModelError, match=r"time 0\.1897 s: the steps lose the motion; found the motion grew beyond"):
        certified(system, push, done, 6000)
