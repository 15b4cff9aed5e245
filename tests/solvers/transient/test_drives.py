"""What drives a line in time: profiles, levels, the engine's cylinders, what is taken up, where runs start."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.components import Coupling, GearPair, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Hinges
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.operating import at_operating_point
from torsional.solvers.transient.acting import Acting, assembled
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.solvers.transient.drives import Governor, OrderTorques, TorqueHistory, all_acting, held
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.profiles import level_of
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import starting
from torsional.system import System, assemble

SPEED, TORQUE = 100.0, 1500.0
CONSTANT = SpeedProfile.constant(SPEED)


@pytest.fixture(scope="module")
def truck() -> Model:
    return load_model("examples/truck_dmf_two_stage.yaml")


def geared() -> System:
    parts = {"engine": Inertia(1.0), "pinion": Inertia(0.1), "wheel": Inertia(3.0), "load": Inertia(8.0)}
    line = {"shaft": Shaft("pinion", "engine", 1e4), "gear": GearPair("pinion", "wheel", 2.0)}
    return assemble(Powertrain(parts | line | {"drive": Shaft("load", "wheel", 5e4, 10.0)}))


def torque_at(acting: Acting, time: float, angle: float) -> np.ndarray:
    """Torques of the sources on the coordinates, less friction at the mean speed."""
    total = np.zeros(len(acting.sources[0].row))
    for source in acting.sources:
        value = 1.0 if source.profile is None else float(source.profile.at(source.multiple * angle + source.phase))
        total += source.row * value * (1.0 if source.level is None else float(source.level.at(time)))
    return total - sum(drag.row * drag.mean for drag in acting.drags)


# --- orders ---


def test_orders_are_the_excitation_waveform(truck: Model) -> None:
    assert truck.engine is not None
    system = assemble(truck.powertrain())
    given = truck.engine.excitation(truck.landmarks.throws, SPEED, TORQUE, np.arange(0, 18.5, 0.5))
    acting = all_acting(given, system, CONSTANT)
    rows = np.array([system.T[system.node_index(node)] for node in given.nodes])
    for angle in (0.3, 5.0, 11.9, 40.0):
        expected = given.waveform([angle])[:, 0] @ rows
        np.testing.assert_allclose(torque_at(acting, 0.0, angle), expected, atol=2e-8 * np.abs(given.torque).sum())


def test_operating_points_over_a_ramp_are_joined_by_straight_lines() -> None:
    system = geared()
    speeds = np.array([50.0, 80.0, 100.0])
    torque = np.array([[10.0, 1.0j], [40.0, 3.0], [20.0, -2.0]])[:, None, :]
    acting = OrderTorques(Excitation(("engine",), [0, 2], speeds, torque)).acting(
        system, SpeedProfile((0.0, 1.0, 3.0), (60.0, 100.0, 50.0))
    )
    for time, speed in ((0.25, 70.0), (0.5, 80.0), (1.0, 100.0), (2.0, 75.0), (9.0, 50.0)):
        mean, second = (np.interp(speed, speeds, torque[:, 0, i].real) for i in (0, 1))
        imaginary = np.interp(speed, speeds, torque[:, 0, 1].imag)
        expected = mean + second * np.cos(2.0) - imaginary * np.sin(2.0)
        assert torque_at(acting, time, 1.0)[0] == pytest.approx(expected, abs=1e-7)


def test_speeds_that_the_excitation_does_not_reach_are_refused() -> None:
    given = Excitation(("engine",), [2], [50.0, 80.0], np.ones((2, 1, 1)))
    with pytest.raises(ModelError, match="does not reach"):
        OrderTorques(given).acting(geared(), SpeedProfile.ramp(50.0, 81.0, 1.0))


# --- cylinders ---


@pytest.mark.parametrize("reciprocating", ["none", "half-share"])
def test_cylinders_are_the_engine(truck: Model, reciprocating: str) -> None:
    assert truck.engine is not None
    system = assemble(truck.powertrain())
    drive = CylinderTorques.of(truck, SPEED, TORQUE, reciprocating=reciprocating)
    acting = drive.acting(system, CONSTANT)
    angle = np.array([0.2, 1.0, 7.0, 12.0])
    torque = truck.engine.torque(SPEED, TORQUE, angle, reciprocating=reciprocating == "half-share")
    rows = np.array([system.T[system.node_index(node)] for node in truck.landmarks.throws])
    found = np.array([torque_at(acting, 0.0, a) for a in angle])
    np.testing.assert_allclose(found, torque.T @ rows, atol=1e-6 * np.abs(torque).max())


def test_level_goes_from_the_motored_engine_to_the_operating_point(truck: Model) -> None:
    assert truck.engine is not None
    system = assemble(truck.powertrain())
    drive = CylinderTorques.of(truck, SPEED, TORQUE, level=(0.0, 1.0), level_times=(0.0, 1.0))
    acting = held(drive.acting(system, CONSTANT), system, "vehicle")
    motored = float(truck.engine.motored_torque(SPEED))
    assert float(acting.sources[-1].level.at(9.0)) * 1 / 2.85 == pytest.approx(-motored, rel=1e-6)  # type: ignore[union-attr]
    mean = sum(
        source.row.sum() * source.profile.mean * (1.0 if source.level is None else float(source.level.at(0.5)))
        for source in acting.sources
        if source.profile is not None
    )
    mean -= sum(drag.row.sum() * drag.mean for drag in acting.drags)
    assert mean == pytest.approx(0.5 * (motored + TORQUE), rel=1e-6)


def test_cranks_stand_where_the_cylinders_are(truck: Model) -> None:
    assert truck.engine is not None
    system = assemble(truck.powertrain())
    acting = CylinderTorques.of(truck, SPEED, TORQUE).acting(system, CONSTANT)
    assert len(acting.cranks) == 6 and acting.cranks[4].phase == pytest.approx(-2 * np.pi / 3)
    assert acting.cranks[0].included == pytest.approx(truck.engine.crank.half_share(4.2))
    driven, _, _ = assembled(acting, len(system.coordinates))
    assert driven.crank_rows.start.tolist() == list(range(7))
    assert len(driven.profile) == 12 * 2880 + 2 * 1440  # two a throw; torque and pressure that leaks, alike in all


# --- governors, holds ---


def test_governor_needs_something_to_act_on() -> None:
    governor = Governor("engine", SPEED, proportional=2.0)
    with pytest.raises(ModelError, match="no engine to act on"):
        all_acting(governor, geared(), CONSTANT)


def test_governed_sources_are_those_that_burn(truck: Model) -> None:
    system = assemble(truck.powertrain())
    drives = [CylinderTorques.of(truck, SPEED, TORQUE, reciprocating="none"), Governor("throw1", 90.0, integral=1.0)]
    acting = all_acting(drives, system, CONSTANT)
    _, governed, _ = assembled(acting, len(system.coordinates))
    assert governed.source[:6].tolist() == [6, 7, 8, 9, 10, 11] and governed.source_start[:2].tolist() == [0, 6]
    assert governed.source[6:].tolist() == governed.leaks[:, 0].tolist() == [12, 13, 14, 15, 16, 17]


def test_hold_takes_up_what_the_ratio_makes_of_the_mean() -> None:
    system = geared()
    drives = [Excitation.unit("engine", [0.0, 2.0], SPEED), TorqueHistory("load", (0.0, 1.0), (3.0, 50.0))]
    acting = held(all_acting(drives, system, CONSTANT), system, "load")
    assert float(acting.sources[-1].level.at(5.0)) == pytest.approx(-2.0 - 3.0)  # type: ignore[union-attr]
    with pytest.raises(ModelError, match="in balance"):
        starting("equilibrium", system, all_acting(drives, system, CONSTANT), "", SPEED)


def test_levels_with_falling_times_are_refused() -> None:
    with pytest.raises(ModelError, match="must not fall"):
        level_of([0.0, 1.0, 0.5], [1.0, 2.0, 3.0], "torque")


# --- starts ---


def test_a_vibrating_start_is_the_linear_response(truck: Model) -> None:
    assert truck.engine is not None
    linear, _ = at_operating_point(truck, TORQUE)
    given = truck.engine.excitation(truck.landmarks.throws, [SPEED], [TORQUE], np.arange(0, 12.5, 0.5))
    problem = Problem.of(assemble(truck.powertrain()), given, SPEED, hold="vehicle")
    state = starting("vibrating", problem.system, problem.acting, "vehicle", SPEED)
    rates = (1j * SPEED * harmonic_response(linear, given).angle).isel(speed=0)
    expected = (rates * rates.order).sum("order").real.values
    np.testing.assert_allclose(problem.system.T @ state.speed, expected, atol=1e-9)
    assert problem.base_order == 0.5


def test_a_start_in_equilibrium_twists_every_spring_by_its_law() -> None:
    law = Hinges.staged([(100.0, 1e3), (500.0, 4e3)])
    parts = {"a": Inertia(1.0), "b": Inertia(2.0), "c": Inertia(3.0)}
    line = assemble(Powertrain(parts | {"s": Coupling("b", "a", law), "t": Shaft("c", "b", 2e3)}))
    given = Excitation(("a",), [0.0, 1.0], SPEED, np.array([[300.0, 60.0j]]))
    problem = Problem.of(line, given, None, hold="c")
    state = starting("equilibrium", line, problem.acting, "c", SPEED)
    np.testing.assert_allclose(line.connections.weights @ state.angle, [law.angle(300.0), 0.15], rtol=1e-12)
    # the torque's own rigid motion: speed Re(60i/(iΩ J)) at the time zero
    np.testing.assert_allclose(state.speed, 60.0 / (SPEED * 6.0), rtol=1e-9)


def test_what_is_no_start_is_refused() -> None:
    with pytest.raises(ModelError, match="no start"):
        starting("somewhere", geared(), Acting(), "", SPEED)
