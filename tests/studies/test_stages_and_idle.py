"""A12 and B6: stages over mean torque, lash at idle."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from torsional.quantities import acceleration, swing
from torsional.studies.answers import responded
from torsional.studies.base import Outcome
from torsional.studies.claims.idle import Idle
from torsional.studies.claims.stages import SPEEDS, designs, row
from torsional.studies.trucks import Trucks, hinged, sprung
from torsional.units import RPM


@pytest.fixture(scope="module")
def idle(trucks: Trucks) -> Idle:
    return Idle.of(trucks.dmf, np.deg2rad(2.0), 20.0)


@pytest.mark.parametrize(("name", "stiffness"), [("soft", 8e3), ("two-stage", 8e3), ("stiff", 24e3)])
def test_a12_low_torque_is_linear(trucks: Trucks, name: str, stiffness: float) -> None:
    """Within one stage the swing is that of a linear truck with this stage's spring."""
    loud, reach = row(designs(trucks.two_stage)[name], 500.0)
    linear = responded(sprung(trucks.two_stage, "dmf", stiffness), SPEEDS, 500.0, orders=np.arange(3.0, 19.0, 3.0))
    expected = swing(acceleration(linear.angle.sel(node="gearbox_input"))).values
    assert loud == pytest.approx(expected, rel=1e-6)
    assert (reach < 1).all()


def test_a12_travel(trucks: Trucks) -> None:
    laws = {name: hinged(model, "dmf") for name, model in designs(trucks.two_stage).items()}
    assert [max(law.stops) for law in laws.values()] == pytest.approx([1000 / 8e3 + 2500 / 24e3] * 3)
    assert [float(law.tangent(1.0)) for law in laws.values()] == pytest.approx([1e6] * 3)


def test_a12_figures(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["A12"].finding.figures
    assert figures["soft: mean torque that bottoms it [Nm]"] == pytest.approx(8e3 * (1000 / 8e3 + 2500 / 24e3))
    assert figures["two-stage: swings into its stop at"] == ("2500 Nm: 900 rpm",)
    assert figures["stiff: swings into its stop at"] == ()
    outcome = outcomes["A12"]
    assert outcome.verdict == "reproduced with a condition"
    assert "2500 Nm: 900 rpm" in outcome.finding.proviso and "1000, 1250 Nm" in outcome.finding.proviso


def test_a12_nothing_is_asked_beyond_full_load(trucks: Trucks) -> None:
    for values in row(trucks.two_stage, 2600.0):
        assert np.isnan(values).all() and values.shape == SPEEDS.shape


def test_b6_inside_the_lash_nothing_but_the_damper(idle: Idle) -> None:
    """Third order by the plain matrices, without the spring; it stays for as long as one looks."""
    system, model = idle.system, idle.model
    w, place = 3 * 600 * RPM, system.connections.names.index("dmf")
    assert system.connections.stiffness[place] == 0
    onto = np.array([system.T[system.node_index(node)] for node in model.landmarks.throws])
    load = onto.T @ model.engine.harmonics(600 * RPM, 0.0, [3.0])[:, 0]
    q = np.linalg.solve(system.K + 1j * w * system.C - w**2 * system.M, load)
    found = idle.timed.harmonics(idle.inside, 1)[:, 0]
    assert abs(found[1]) == pytest.approx(abs(system.connections.weights[place] @ q), rel=1e-6)
    assert len(idle.timed.flow(idle.inside, 200).times) == 1


def test_b6_what_follows_the_pulse_by_another_integrator(idle: Idle) -> None:
    """Three periods of the firing from the settled state bring it back; matrices, law and load written out."""
    system, model, speed = idle.system, idle.model, 600 * RPM
    state = idle.pushed(idle.inside, 250.0)
    base, count = idle.timed.bases.coordinates, len(system.M)
    onto = np.array([system.T[system.node_index(node)] for node in model.landmarks.throws])
    orders = 3.0 * np.arange(1, 7)
    load = onto.T @ model.engine.harmonics(speed, 0.0, orders)
    weights, law = system.connections.weights[system.connections.names.index("dmf")], hinged(model, "dmf")
    inverse = np.linalg.inv(system.M)

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        x = float(weights @ y[:count])
        depth = max(abs(x) - idle.lash / 2, 0.0)
        torque = 13e3 * np.sign(x) * depth
        force = (load @ np.exp(1j * orders * speed * t)).real - system.K @ y[:count] - system.C @ y[count:]
        return np.concatenate([y[count:], inverse @ (force - weights * torque)])

    start = np.concatenate([base.angles(state), base.rates(state)])
    period = 2 * np.pi / (3 * speed)
    ran = solve_ivp(rate, (0, 3 * period), start, method="LSODA", rtol=1e-8, atol=1e-10, max_step=period / 200)
    twists = weights @ ran.y[:count]
    assert float(law.torque(0.02)) == pytest.approx(13e3 * (0.02 - np.deg2rad(1.0)))
    assert weights @ ran.y[:count, -1] == pytest.approx(twists[0], abs=1e-4 * np.ptp(twists))
    assert np.ptp(twists) > 1.3 * idle.lash
    third = weights @ ran.y[:count, np.searchsorted(ran.t, period)]
    assert abs(third - twists[0]) > 0.1 * np.ptp(twists)


def test_b6_figures(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B6"].finding.figures
    assert figures["after: order of the slowest part [-]"] == 1.0
    region = [figures[f"{c} Nms/rad: lashes with sustained vibration [deg]"] for c in (20, 10, 5)]
    assert set(region[0]) < set(region[1]) < set(region[2])
