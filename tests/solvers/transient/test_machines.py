"""Whole machines in time: cylinders on the crank's own angle, governors, friction, stops, maps."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Contacts, Law, LuGre, Table
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.transient import (
    CylinderTorques,
    Governor,
    MotionState,
    TorqueHistory,
    engine_drive,
    steady_map,
    steady_state,
    transient,
)
from torsional.solvers.transient.marching import LEDGER
from torsional.system import System, assemble
from torsional.units import RPM

SPEED, TORQUE = 900 * RPM, 1200.0
ORDERS = [0.0, 1.5, 3.0, 4.5, 6.0]


@cache
def truck() -> tuple[Model, System]:
    model = load_model("examples/truck_dmf_two_stage.yaml")
    return model, assemble(model.powertrain())


def governor() -> Governor:
    """Keeps the vehicle at its speed."""
    _, system = truck()
    ratio = float(system.speed_ratio[system.node_index("vehicle")])
    return Governor("vehicle", SPEED * ratio, acts_on="vehicle", proportional=2e4, integral=2e4)


def twist(found: xr.Dataset) -> np.ndarray:
    return np.asarray(abs(found.twist.sel(element="dmf", order=ORDERS)).values)


def unbalanced(found: xr.Dataset) -> float:
    """What the ledger leaves over [J]."""
    share = (found.energy - found.energy.isel(time=0)).sel(share=list(LEDGER))
    left = share.sel(share=["kinetic", "strain"]).sum("share") - share.sel(share="sources")
    left = left + share.sel(share=["dampers", "contacts", "friction"]).sum("share") - share.sel(share="method")
    return float(abs(left).max())


# --- the engine ---


def test_cylinders_without_feedback_are_the_engines_orders() -> None:
    model, system = truck()
    orders = steady_state(system, engine_drive(model, SPEED, TORQUE, 60.0, 0.5), hold="vehicle", parts=1)
    given = CylinderTorques.of(model, SPEED, TORQUE, feedback=False, reciprocating="half-share")
    cylinders = steady_state(system, given, speed=SPEED, hold="vehicle", parts=1)
    np.testing.assert_allclose(twist(cylinders), twist(orders), atol=2e-6)


@pytest.mark.parametrize("reciprocating", ["half-share", "exact"])
def test_feedback_changes_the_engine_a_little_once_its_speed_is_kept(reciprocating: str) -> None:
    model, system = truck()
    plain = steady_state(system, engine_drive(model, SPEED, TORQUE, 36.0, 0.5), hold="vehicle", parts=1)
    given = CylinderTorques.of(model, SPEED, TORQUE, reciprocating=reciprocating)
    found = steady_state(system, [given, governor()], speed=SPEED, hold="vehicle", parts=1)
    assert found.attrs["kind"] == "periodic"
    change = np.abs(twist(found) - twist(plain))[1:].max() / twist(plain)[1:].max()
    assert 0.005 < change < 0.15


def test_more_combustion_speeds_the_vehicle_up() -> None:
    model, system = truck()
    given = CylinderTorques.of(model, SPEED, TORQUE, level=(0.5, 0.5, 1.0), level_times=(0.0, 0.5, 0.5))
    found = transient(system, given, 3.5, speed=SPEED, hold="vehicle", output=1e-3)
    assert model.engine is not None
    extra = 0.5 * (TORQUE - float(model.engine.motored_torque(SPEED)))
    ratio = float(system.speed_ratio[system.node_index("vehicle")])
    expected = extra * 3.0 / float(system.M.sum()) * ratio
    vehicle = found.angular_velocity.sel(node="vehicle")
    gained = float(vehicle.sel(time=slice(3.2, 3.5)).mean() - vehicle.sel(time=slice(0.0, 0.4)).mean())
    assert gained == pytest.approx(expected * (3.35 - 0.5) / 3.0, rel=0.03)
    assert unbalanced(found) < 1e-10 * float(abs(found.energy.sel(share="sources").diff("time")).sum())


# --- two integrators ---


@pytest.mark.parametrize("friction", [False, True])
def test_implicit_and_explicit_steps_agree(friction: bool) -> None:
    washer = LuGre(2e5, 200.0, 15.0, 20.0, 0.05)
    parts = {"a": Inertia(1.8), "b": Inertia(1.2), "s": Coupling("b", "a", Contacts.lash(0.004, 2e4, 1e-3))}
    system = assemble(Powertrain(parts | ({"w": Coupling("b", "a", washer)} if friction else {})))
    drive = Excitation(("a",), [0.0, 1.0], 60.0, [[40.0, 120.0]])
    start = MotionState.at_rest(system).moved(np.array([0.01, 0.0]), np.array([0.5, 0.0]))
    implicit, explicit = (
        transient(system, drive, 0.2, start, hold="b", output=1e-3, **given)  # type: ignore[arg-type]
        for given in ({"step": 1e-5, "spectral_radius": 1.0}, {"step": 1e-3, "method": "explicit", "tolerance": 1e-9})
    )
    for name, tolerance in (("twist", 2e-4), ("torque", 2e-3)):
        size = float(abs(explicit[name]).max())
        np.testing.assert_allclose(implicit[name].values, explicit[name].values, atol=tolerance * size)
    if friction:
        assert implicit.friction.values.tolist() == ["w"]
        np.testing.assert_allclose(implicit.memory.values, explicit.memory.values, atol=2e-3 * 20.0 / 2e5)


# --- friction and stops ---


def test_friction_goes_on_from_what_it_remembers() -> None:
    washer = LuGre(1e5, 100.0, 30.0, 40.0, 0.05)
    parts = {"a": Inertia(1.8), "b": Inertia(1.2), "s": Shaft("b", "a", 5e3), "w": Coupling("b", "a", washer)}
    system = assemble(Powertrain(parts))
    drive = Excitation(("a",), [1.0], 60.0, [[100.0]])
    whole = transient(system, drive, 0.2, "rest", step=2e-5)
    first = transient(system, drive, 0.1, "rest", step=2e-5)
    assert abs(float(first.end_memory.max())) > 1e-5
    second = transient(system, drive, 0.1, first, step=2e-5)
    size = float(abs(whole.memory).max())
    assert float(second.memory[-1, 0]) == pytest.approx(float(whole.memory[-1, 0]), abs=1e-3 * size)
    assert float(whole.energy.sel(share="friction")[-1]) > 0.5
    assert unbalanced(whole) < 1e-10 * float(whole.energy.sel(share="friction")[-1])


def stops(stiffness: float = 1e8) -> tuple[System, MotionState]:
    """A small mass that flies between two elastic stops, a curve: those that are hinges are guarded."""
    most = 0.01 * stiffness
    law: Law = Table(((-0.02, -most), (-0.01, 0.0), (0.0, 0.0), (0.01, 0.0), (0.02, most)))
    system = assemble(Powertrain({"m": Inertia(0.003), "stops": Coupling("ground", "m", law)}))
    return system, MotionState.at_rest(system).moved(0.0, np.array([1.0]))


def test_a_step_that_makes_energy_is_halved_and_told() -> None:
    system, start = stops()
    found = transient(system, (), 0.02, start, speed=0.0, step=2e-4, method="newmark")
    assert found.attrs["refined"].startswith("step halved to")
    energy = found.energy.sel(share=["kinetic", "strain"]).sum("share") / 0.0015
    assert float(energy.max()) < 1.01 and -0.05 < found.attrs["method_share"] < 0.01


def test_a_run_that_cannot_be_believed_is_refused() -> None:
    system, start = stops(1e18)
    with pytest.raises(ModelError, match="no step was small enough") as told:
        transient(system, (), 1.0, start, speed=0.0, step=1e-3)
    assert "contact time" in str(told.value) and "step of" in str(told.value)


# --- maps ---


def test_a_map_over_torque_and_speed() -> None:
    model, system = truck()
    speeds, torques = np.array([800.0, 880.0]) * RPM, [1000.0, 1200.0]
    found = steady_map(model, speeds, torques, ["12"], highest_order=18.0, step=2e-4)
    assert found.twist.dims == ("gear", "mean_torque", "speed", "order", "element")
    assert found.periods.values[0].tolist() == [[2, 2], [1, 2]]
    alone = steady_state(system, engine_drive(model, speeds[1], 1000.0), hold="vehicle", parts=2, step=2e-4)
    row = found.isel(gear=0).sel(mean_torque=1000.0, speed=speeds[1])
    np.testing.assert_allclose(twist(row), twist(alone), atol=1e-6)


def test_a_knock_is_over_and_the_motion_comes_back() -> None:
    model, system = truck()
    knock = TorqueHistory("gearbox_input", (0.0, 1.0, 1.0, 1.05, 1.05), (0.0, 0.0, 900.0, 900.0, 0.0))
    drive = engine_drive(model, 1200 * RPM, TORQUE)
    start = steady_state(system, drive, hold="vehicle")
    found = transient(system, [drive, knock], 6.0, start, hold="vehicle", output=1e-3)
    swing = found.torque.sel(element="gearbox")
    before, during, after = (swing.sel(time=slice(*span)) for span in ((0, 0.9), (1.0, 1.5), (5.5, 6.0)))
    assert float(during.max()) > float(before.max()) + 200.0
    assert float(after.std()) == pytest.approx(float(before.std()), rel=0.02)
