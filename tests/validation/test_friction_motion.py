"""The implicit time step with friction and contacts against exact motions, from a powertrain to the march."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Contacts, Coulomb, Jenkins, Karnopp, Law, LuGre
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Status, begin, march
from torsional.numerics.stepping.plan import prepare
from torsional.powertrain import Powertrain
from torsional.solvers.transient.drives import OrderTorques
from torsional.solvers.transient.problem import Problem
from torsional.system import assemble

METHOD = AlphaMethod.chung_hulbert(0.9)
BRISTLES = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)


def marched(problem: Problem, rates: list[float], step: float, steps: int) -> Any:
    """The march from angles of zero, and the coordinate of the disc."""
    plan = prepare(problem.equations)
    found = march(plan, METHOD, step, steps, begin(plan, np.zeros(len(rates)), rates))
    assert found.status == Status.DONE
    return found.records, problem.system.coordinates.index("disc")


# --- Den Hartog's oscillator under dry friction ---

EXACT = {(0.8, 0.3): 2.62610488, (1.2, 0.3): 2.07238427}


def amplitude(law: Law, beta: float) -> float:
    """k x0/P of the last of a hundred cycles."""
    parts = {"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 1.0), "rub": Coupling("ground", "disc", law)}
    drive = OrderTorques(Excitation(("disc",), [1.0], beta, [[1.0]]))
    a_cycle = round(2 * math.pi / beta / 1e-3)
    problem = Problem.of(assemble(Powertrain(parts)), (drive,), beta)
    records, disc = marched(problem, [0.0], 2 * math.pi / beta / a_cycle, 100 * a_cycle)
    return float(np.abs(records.q[-a_cycle:, disc]).max())


@pytest.mark.parametrize(("beta", "ratio"), EXACT)
def test_den_hartog(beta: float, ratio: float) -> None:
    """Friction smoothed at a thousandth of the rate; a bristle's difference falls with √k and is taken out by two."""
    exact = EXACT[beta, ratio]
    assert amplitude(Coulomb(ratio, 1e-3), beta) == pytest.approx(exact, rel=1e-4)
    soft, stiff = (amplitude(Jenkins(ratio, k), beta) for k in (1e3, 1e4))
    assert stiff + (stiff - soft) / (10**0.5 - 1) == pytest.approx(exact, rel=3e-5)
    assert amplitude(Karnopp(ratio, ratio, 1e-5, 1e4), beta) == pytest.approx(stiff, rel=1e-9)


# --- a unit mass pulled at 0.1 by a spring of 2 ---


def slips(law: Law, step: float, end: float) -> Any:
    """Times at which it breaks away; the frame turns with what pulls, so the friction sees the whole speed."""
    parts = {
        "disc": Inertia(1.0),
        "pull": Inertia(1e9),
        "spring": Shaft("disc", "pull", 2.0),
        "rub": Coupling("ground", "disc", law, whole_speed=True),
    }
    system = assemble(Powertrain(parts, reference="pull"))
    start = [-0.1 if node == "disc" else 0.0 for node in system.coordinates]
    records, disc = marched(Problem.of(system, (), 0.1), start, step, round(end / step))
    rate = records.v[:, disc] + 0.1
    return records.time[1:][(rate[1:] > 0.05) & (rate[:-1] <= 0.05)]


def test_stick_slip_of_bristles() -> None:
    assert np.diff(slips(BRISTLES, 2e-4, 30.0))[-1] == pytest.approx(6.363, abs=1e-3)


def test_stick_slip_of_karnopp() -> None:
    """Sticks until 1.5, slides at 1; what it takes to leave the band falls with √D."""
    omega = 2**0.5
    exact = 5.0 + 2 / omega * (np.pi - np.arctan(omega * 0.5 / 0.2))
    wide, narrow = (float(np.diff(slips(Karnopp(1.0, 1.5, d, 1e5, 1e5**0.5), 2e-4, 40.0))[-1]) for d in (1e-3, 1e-4))
    assert narrow == pytest.approx(exact, rel=0.01)
    assert narrow - (wide - narrow) / (10**0.5 - 1) == pytest.approx(exact, rel=1e-3)


# --- contacts ---


def thrown(law: Law, speed: float, end: float, inertia: float) -> Any:
    """A free disc thrown at a contact from rest in the frame; its rates."""
    parts = {"disc": Inertia(inertia), "wall": Inertia(1e12), "stop": Coupling("wall", "disc", law)}
    system = assemble(Powertrain(parts, reference="wall"))
    start = [speed if node == "disc" else 0.0 for node in system.coordinates]
    records, disc = marched(Problem.of(system, (), 100.0), start, 1e-5, round(end / 1e-5))
    return records.v[:, disc]


def test_impacts() -> None:
    """Elastic, k = 100: it leaves as it came.  Damped, k = 1e4, τ = 1e-3 s: it keeps 0.8003536403."""
    assert thrown(Contacts((0.1,), (1.0,), (100.0,), (0.0,)), 1.0, 0.6, 1.0)[-1] == pytest.approx(-1.0, rel=1e-8)
    damped = thrown(Contacts((0.1,), (1.0,), (1e4,), (1e-3,)), 10.0, 0.05, 0.5)
    assert damped[-1] == pytest.approx(-8.003536403, rel=1e-6)
