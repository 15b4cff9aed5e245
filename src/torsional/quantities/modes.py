"""Modes of a model at an operating point, by name, each with the damped mode that goes with it."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.quantities import named_modes, order_speed
from torsional.solvers.modal import damped_modes, modal
from torsional.solvers.operating import at_operating_point


def modes_of(model: Model, gear: str, torque: float, speed: float, order: float | None) -> xr.Dataset:
    """What `modal` finds, with names, the damped modes next to it, and the speed at which the order meets each mode."""
    system, _ = at_operating_point(model, torque, gear)
    found, damped = modal(system, speed), damped_modes(system, speed)
    partner = _paired(found, damped)
    result = found.assign(
        name=("mode", np.array(named_modes(found, model.mode_groups))),
        damped_frequency=("mode", damped.frequency.values[partner], damped.frequency.attrs),
        damped_ratio=("mode", damped.damping_ratio.values[partner], damped.damping_ratio.attrs),
    )
    return result if order is None else result.assign(order_speed=order_speed(found.frequency, order))


def _paired(undamped: xr.Dataset, damped: xr.Dataset) -> list[int]:
    """For each undamped mode the damped one most like it in shape and frequency; damping may add modes and swap some.

    The likeness of shapes is the modal assurance criterion (Allemang and Brown, Proc. 1st IMAC, 1982, 110).
    """
    a, b = (_unit(modes["shape"].values) for modes in (undamped, damped))
    low, high = (pick.outer(undamped.frequency.values, damped.frequency.values) for pick in (np.minimum, np.maximum))
    alike = np.abs(a @ b.T) ** 2 * np.where(high > 0, low / np.where(high > 0, high, 1.0), 1.0)
    partner = [0] * len(a)
    for _ in partner:
        row, column = np.unravel_index(alike.argmax(), alike.shape)
        partner[int(row)] = int(column)
        alike[row], alike[:, column] = -1.0, np.where(alike[:, column] < 0, -1.0, -0.5)
    return partner


def _unit(shapes: np.ndarray) -> np.ndarray:
    return np.asarray(shapes / np.linalg.norm(shapes, axis=1, keepdims=True))
