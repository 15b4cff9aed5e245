"""Usual sizes where a scenario gives none: shares of full load, of the vehicle's weight and of the speeds."""

from __future__ import annotations

from torsional.components import Inertia, Vehicle
from torsional.errors import ModelError
from torsional.model import Model
from torsional.units import GRAVITY

DISC, STICKING = 1.0 / 3.0, 300.0
"""Share of the clutch disc's inertia that linings have; torque that they hold over the twist [rad], over capacity."""


def torque(model: Model, given: float | None, share: float, where: str) -> float:
    """A torque [Nm]: as given, or a share of the highest full-load torque; ModelError where there is neither."""
    if given is not None:
        return given
    if share == 0.0:
        return 0.0
    if model.running_engine.full_load is None:
        problem = "the model has no full-load curve to take a usual torque from"
        raise ModelError(problem, where=where, remedy="give the key, or engine.full_load in the model file")
    return share * model.full_load_peak()


def speed(model: Model, given: float | None, share: float) -> float:
    """An engine speed [rad/s]: as given, or a share of the way up the operating range."""
    low, high = model.operation.speed
    return given if given is not None else low + share * (high - low)


def at_wheels(model: Model, given: float | None, share: float, where: str) -> float:
    """A torque [Nm] at the wheels: as given, or a share of the vehicle's weight at its rolling radius."""
    if given is not None:
        return given
    vehicle = next((part for part in model.components.values() if isinstance(part, Vehicle)), None)
    if vehicle is None:
        remedy = "give the key in Nm"
        raise ModelError("the model has no vehicle to take a usual torque from", where=where, remedy=remedy)
    return share * vehicle.mass * GRAVITY * vehicle.rolling_radius


def lining_inertia(model: Model, given: float | None, disc: str) -> float:
    """Inertia of linings [kgm²]: as given, or a share of what turns on the node of the clutch disc."""
    if given is not None:
        return given
    turning = [p.inertia for name, p in model.components.items() if isinstance(p, Inertia) and (p.node or name) == disc]
    if not turning:
        problem = "the model has no clutch disc to take the inertia of its linings from"
        raise ModelError(problem, where="clutch.lining_inertia", remedy="give the key")
    return DISC * sum(turning)
