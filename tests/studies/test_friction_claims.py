"""A5, A9: the washer in the clutch, beside energy balances, linear answers and a march in time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from scipy.linalg import expm

from torsional.laws import Jenkins
from torsional.solvers.periodic.states import states
from torsional.studies.answers import at_input, mean_torque
from torsional.studies.base import Outcome
from torsional.studies.claims.friction import SWEEP, needed
from torsional.studies.friction import AROUND, STICKING, WASHER, answered, washed
from torsional.studies.motions import over_speed
from torsional.studies.trucks import Trucks
from torsional.system import assemble
from torsional.units import RPM


def test_hardly_any_friction_is_linear(trucks: Trucks) -> None:
    found = answered(washed(trucks.smf, 0.1), AROUND)
    linear = at_input(trucks.smf, found.speed[::7])
    assert found.amplitude[::7] == pytest.approx(linear, rel=1e-3)


def test_stuck_friction_is_a_spring(trucks: Trucks) -> None:
    """At 1500 rpm a washer of 150 Nm never slips with a dual mass flywheel: what is left is its stiffness."""
    found = answered(washed(trucks.dmf, 150.0), (900 * RPM, 1500 * RPM))
    stuck = washed(trucks.dmf, 1e9)
    at = np.array([1500 * RPM])
    assert found.at(at[0], found.amplitude) == pytest.approx(at_input(stuck, at)[0], rel=1e-3)
    assert abs(found.at(at[0], found.power)) < 1e-6


def test_power_is_the_area_of_the_loop(trucks: Trucks) -> None:
    """4 F (A − F/k) a cycle, three cycles a turn of the crank; the twist is nearly that of order 3 alone."""
    torque = 90.0
    explorer = over_speed(washed(trucks.smf, torque), (640 * RPM, 670 * RPM), mean_torque(trucks.smf), depth=0)
    branch = explorer.branches[0]
    told = states(branch.problem, branch.scaled)
    place = explorer.setting.split.system.connections.names.index(WASHER)
    twist = np.abs(told.twist[:, 1, place])
    top = int(twist.argmax())
    found = answered(washed(trucks.smf, torque), (640 * RPM, 670 * RPM))
    loop = 4 * torque * (twist[top] - torque / STICKING) * 3 * branch.values[top] / (2 * np.pi)
    assert found.at(branch.values[top], found.power) == pytest.approx(loop, rel=0.01)


@pytest.mark.parametrize("torque", [120.0])
def test_a5_beside_a_march_in_time(trucks: Trucks, torque: float) -> None:
    """The washer's law step by step, the rest by its exact exponential; third order at the input near resonance."""
    speed, model = 665 * RPM, trucks.smf
    system = assemble(model.powertrain())
    count, steps, periods = len(system.M), 1000, 150
    inverse, step = np.linalg.inv(system.M), 2 * np.pi / (3 * speed) / steps
    zero = np.zeros((count, count))
    A = np.block([[zero, np.eye(count)], [-inverse @ system.K, -inverse @ system.C]])
    wide = expm(step * np.block([[A, np.vstack([zero, inverse])], [np.zeros((count, 3 * count))]]))
    grown, pushed = wide[: 2 * count, : 2 * count], wide[: 2 * count, 2 * count :]
    onto = np.array([system.T[system.node_index(node)] for node in model.landmarks.throws])
    orders = np.array([3.0, 6.0, 9.0])
    load = onto.T @ model.engine.harmonics(speed, mean_torque(model), orders)
    middles = (np.arange(steps) + 0.5) * step * speed
    forces = pushed @ (load @ np.exp(1j * np.outer(orders, middles))).real
    weights = system.T[system.node_index("flywheel")] - system.T[system.node_index("clutch_disc")]
    rub, turn = pushed @ weights, np.concatenate([np.zeros(count), weights])
    z, memory, kept = np.zeros(2 * count), 0.0, np.empty((steps, 2 * count))
    for _ in range(periods):
        for i in range(steps):
            kept[i] = z
            memory = float(np.clip(memory + turn @ z * step, -torque / STICKING, torque / STICKING))
            z = grown @ z + forces[:, i] - rub * (STICKING * memory)
    angle = kept[:, :count] @ system.T[system.node_index("gearbox_input")]
    third = abs(np.exp(-1j * 3 * speed * step * np.arange(steps)) @ angle) * 2 / steps * (3 * speed) ** 2
    found = answered(washed(model, torque), (660 * RPM, 670 * RPM))
    assert third == pytest.approx(found.at(speed, found.amplitude), rel=5e-3)


def test_a5_figures(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["A5"].finding.figures
    bare, far = figures["without washer: largest, and at 1500 rpm [rad/s²]"]
    assert figures["largest amplitude [rad/s²]"][0] < bare and figures["amplitude at 1500 rpm [rad/s²]"][0] > far
    assert figures["friction torque [Nm]"] == tuple(SWEEP)


def test_a9_the_needed_torque_meets_the_limit(trucks: Trucks) -> None:
    torque = needed(trucks.dmf, 1500.0, 0.2)
    assert torque == pytest.approx(40.3, abs=0.2)
    assert answered(washed(trucks.dmf, torque, 0.2), AROUND).peak[0] == pytest.approx(1500.0, rel=1e-3)
    assert needed(trucks.dmf, 2500.0, 0.2) == 0.0
    assert needed(trucks.smf, 1200.0, 0.2) == np.inf


def test_the_law_of_the_washer(trucks: Trucks) -> None:
    washer = washed(trucks.smf, 60.0, 0.2)
    assert washer.components[WASHER].law == Jenkins(60.0, STICKING)
    assert washer.components["clutch"].damping == pytest.approx(6.0)
    assert WASHER not in washed(trucks.smf, 0.0).components
