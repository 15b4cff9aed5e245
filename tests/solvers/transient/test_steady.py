"""Steady motions in time: periodic, doubled, coexisting, quasi-periodic and chaotic, against figures of others."""

from __future__ import annotations

import re

import numpy as np
import pytest

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Hinges, Law, Polynomial
from torsional.powertrain import Powertrain
from torsional.solvers.transient import TorqueHistory, engine_drive, steady_state, steady_sweep
from torsional.solvers.transient.marching import Accuracy
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.steady import stroboscope
from torsional.system import System, assemble
from torsional.units import RPM

FINE = {"step": 0.005, "spectral_radius": 1.0}


def oscillator(law: Law, damping: float) -> System:
    return assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law, damping)}))


def drive(speed: float, mean: float, amplitude: float) -> Excitation:
    return Excitation(("disc",), [0, 1], speed, [[mean, amplitude]])


# T_m, Ω, periods; mean, A1/2, A1, A3/2 by the exact piecewise solution
TWO_STAGE = [
    (1.0, 3.00, 1, 0.9715228, 0.0, 0.1309417, 0.0),
    (1.0, 2.41, 2, 0.8654713, 0.5336911, 0.2435232, 0.0076506),
    (1.2, 2.57, 2, 1.0342741, 0.4399869, 0.2102095, 0.0049593),
]


@pytest.mark.parametrize("mean, speed, periods, steady, half, first, third", TWO_STAGE)
def test_two_stage_oscillator(
    mean: float, speed: float, periods: int, steady: float, half: float, first: float, third: float
) -> None:
    law = Hinges(1.0, (1.0,), (1.0,), (1.0,))
    found = steady_state(oscillator(law, 0.04), drive(speed, mean, 1.0), tolerance=1e-6, highest_order=4, **FINE)
    assert found.attrs["periods"] == periods
    orders = abs(found.twist.sel(element="spring", order=[0.0, 0.5, 1.0, 1.5])).values
    np.testing.assert_allclose(orders, [steady, half, first, third], atol=1e-4)


def test_two_motions_of_a_duffing_oscillator_beside_each_other() -> None:
    duffing = oscillator(Polynomial((1.0, 0.0, 0.1)), 0.05)
    given = Excitation(("disc",), [1], 1.0, [[0.18]])
    found = steady_sweep(duffing, given, [1.05, 1.1, 1.15, 1.2, 1.25, 1.3], step=0.03, tolerance=1e-4, highest_order=7)
    up, down = abs(found.twist.sel(element="spring", order=1.0)).values
    # folds at 1.11570025 and 1.26960196 rad/s (NLvib example 01)
    assert (np.abs(up - down) > 0.5).tolist() == [False, False, True, True, True, False]
    assert up[4] > 2.5 and down[4] < 0.5
    assert (found.kind.values == "periodic").all()


def test_chaos_of_an_oscillator_of_ueda() -> None:
    """x″ + 0.05 x′ + x³ = 7.5 cos t, largest exponent 0.10 to 0.11 1/s (Ueda, J. Stat. Phys. 20 (1979) 181)."""
    ueda = oscillator(Polynomial((0.0, 0.0, 1.0)), 0.05)
    given = Excitation(("disc",), [1], 1.0, [[7.5]])
    found = steady_state(ueda, given, start="rest", step=0.02, spectral_radius=1.0, most_periods=200)
    assert found.attrs["kind"] == "chaotic"
    assert found.attrs["exponent"] / (2 * np.pi) == pytest.approx(0.105, abs=0.012)


def test_two_frequencies_never_repeat_themselves() -> None:
    free = assemble(Powertrain({"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 1.0)}))
    given = Excitation(("disc",), [1], 0.5 * (1 + 5**0.5), [[1.0]])
    found = steady_state(free, given, start="rest", step=0.02, spectral_radius=1.0, most_periods=200)
    assert found.attrs["kind"] == "quasi-periodic"
    assert abs(found.attrs["exponent"]) < 1e-4 and found.attrs["dimension"] == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("periods", [1, 4])
def test_neighbours_of_a_linear_motion_without_damping_keep_their_distance(periods: int) -> None:
    """Its size is an energy, which Newmark's steps keep: the exponent of the first period is zero like that of all."""
    system = assemble(Powertrain({"disc": Inertia(2.0), "spring": Shaft("ground", "disc", 50.0)}))
    problem = Problem.of(system, Excitation(("disc",), [1], 4.0, [[1.0]]), None)
    strobe = stroboscope(problem, Accuracy(0.02, "newmark"), "rest", None)
    strobe.run(2)
    assert strobe.size > 0.05 and abs(strobe.exponent(periods)) < 1e-8


def test_what_does_not_repeat_itself_drives_no_steady_motion() -> None:
    with pytest.raises(ModelError, match="repeats itself"):
        steady_state(oscillator(Polynomial((1.0,)), 0.1), TorqueHistory("disc", (0.0,), (1.0,)), speed=10.0)


def test_what_the_step_makes_of_contacts_is_not_called_the_motion() -> None:
    """Inner springs that just touch their tabs rattle there for ever with steps of 89 µs, and not with 45."""
    model = load_model("examples/truck_dmf_arc_spring.yaml")
    system = assemble(model.detailed().powertrain())
    given = engine_drive(model, 1000 * RPM, 1000.0)
    found = steady_state(system, given, hold="vehicle", most_periods=300, parts=2)
    assert found.attrs["kind"] == "periodic"
    assert found.attrs["step"] == pytest.approx(4.464e-5, rel=1e-3) and "halved" in found.attrs["refined"]


def test_a_motion_that_half_the_step_only_quietens_is_noted() -> None:
    """A steady motion and 1 % of a free vibration, which fades to e⁻³ in the 320 periods that are given."""
    system = assemble(Powertrain({"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 1.0, 0.0048)}))
    problem = Problem.of(system, Excitation(("disc",), [1], 0.5 * (1 + 5**0.5), [[1.0]]), None)
    strobe = stroboscope(problem, Accuracy(0.05, spectral_radius=1.0), "vibrating", None)
    strobe.state = strobe.state.moved(0.0, 0.01)
    strobe.run(16)
    assert strobe._by_half_the_step(0, 1.0, 8, 1e-9) == (0, 1.0)
    changes = [float(number) for number in re.findall(r"\d\.\de-\d\d", strobe.notes["unresolved"])]
    assert changes[1] == pytest.approx(changes[0] * np.exp(-3.0), rel=0.15) and "refined" not in strobe.notes


def test_a_motion_that_is_lost_is_told() -> None:
    """A spring that softens to nothing under a torque beyond what it can hold: the discs part for ever."""
    law = Polynomial((1.0, 0.0, -0.5))
    line = assemble(Powertrain({"disc": Inertia(1.0), "load": Inertia(2.0), "spring": Coupling("disc", "load", law)}))
    with pytest.raises(ModelError, match="the steps lose the motion; found the motion grew beyond all numbers"):
        steady_state(line, Excitation(("disc",), [1.0], 1.0, [[3.0]]), start="rest", step=0.05)
