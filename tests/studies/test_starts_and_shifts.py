"""G2 and G3: engine starts through the resonance, clutches engaged at once, against plain mechanics."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.files.scenario import load_scenario
from torsional.solvers.harmonic import harmonic_response
from torsional.studies.claims import Outcome
from torsional.studies.claims.engagement import SETTINGS, STOPS, TIMES, rolling, stopped_at
from torsional.studies.claims.start_up import DAMPINGS, STARTERS, passed, sprung
from torsional.studies.claims.trucks import Trucks, hinged
from torsional.studies.claims.trucks import sprung as linearised
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.running import run_plan
from torsional.system import assemble


def test_g2_three_of_four_help(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["G2"].finding.figures
    for name in ("time from 200 to 600 rpm", "damping"):
        assert (np.diff(np.array(figures[f"largest angle [deg], {name}"], dtype=float)) < 0).all(), name
    starter = figures["largest angle [deg], starter speed"]
    assert isinstance(starter, tuple) and len(starter) == len(STARTERS)
    assert float(starter[-1]) < 0.95 * float(starter[0])
    softer = np.array(figures["largest angle [deg], stiffness"], dtype=float)
    share = np.array(figures["over the angle of a stop at the same torque [-], stiffness"], dtype=float)
    assert (np.diff(softer) > 0).all()
    assert (np.diff(share) < 0).all()
    assert "larger angles" in outcomes["G2"].finding.reason
    assert len(figures["damping [Nms/rad]"]) == len(DAMPINGS)  # type: ignore[arg-type]


def test_g2_a_stop_at_the_same_torque(trucks: Trucks) -> None:
    for rate in (13e3, 6e3):
        law = hinged(sprung(trucks.dmf, rate), "dmf")
        assert float(law.torque(max(law.stops))) == pytest.approx(3500.0)
        assert float(law.tangent(0.0)) == rate


def test_g2_the_slower_the_closer_to_the_steady_resonance(trucks: Trucks) -> None:
    """Passed slowly the peak tends to that of the linear steady response at the worst speed, and never exceeds it."""
    model = trucks.dmf
    linear = planned(load_scenario("engine_stop"), linearised(model, "dmf", 13e3)).line
    assert model.engine is not None
    speeds = np.linspace(200, 600, 201) * np.pi / 30
    load = model.engine.excitation(model.landmarks.throws, speeds, 300.0, np.array([3.0]))
    angle = harmonic_response(assemble(linear), load).angle.isel(order=0)
    third = np.rad2deg(float(abs(angle.sel(node="primary") - angle.sel(node="secondary")).max()))
    slow = passed(model, 3.2)
    # the drive that holds the speed damps a little, other orders add a little
    assert 0.85 * third < slow < 1.02 * third


def test_g3_energy_decides_whether_the_stop_is_met(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["G3"].finding.figures
    assert figures["engaged within [s]"] == TIMES
    at_once = [float(figures[f"stop at {stop:g} Nm: peak torque of the DMF [Nm]"][0]) for stop in STOPS]  # type: ignore[index,arg-type]
    assert at_once[0] > 2 * STOPS[0]
    assert at_once[-1] < STOPS[-1]
    unmet = [figures[f"stop at {stop:g} Nm: peak torque of the DMF [Nm]"][-1] for stop in STOPS]  # type: ignore[index]
    assert np.ptp(np.array(unmet, dtype=float)) == pytest.approx(0.0, abs=1e-6)  # a stop that is not met does nothing
    law = hinged(stopped_at(trucks.dmf, 2500.0), "dmf")
    assert float(law.torque(max(law.stops))) == pytest.approx(2500.0)


def test_g3_momentum_of_the_shift(trucks: Trucks) -> None:
    """Engine and vehicle meet at the speed that their momentum says, the vehicle being a hundred times as heavy."""
    model = trucks.dmf
    settings = [*SETTINGS, rolling(model), "clutch.within=0.1 s", "road_load=1 Nm"]
    plan = planned(load_scenario("clutch_engagement", settings), model)
    assert plan.speed - plan.lag == pytest.approx(1400 * np.pi / 30 * 1.63 / 2.70)  # type: ignore[operator]
    run = run_plan(plan)
    system = assemble(plan.line)
    slow = np.array([node in plan.lagging for node in system.coordinates])
    inertia = system.M.sum(axis=1)
    common = float((inertia * (plan.speed - slow * plan.lag)).sum() / inertia.sum())  # type: ignore[operator]
    late = run.angular_velocity.sel(node="primary", time=slice(0.8, None)).mean()
    assert float(late) == pytest.approx(common, rel=0.02)
