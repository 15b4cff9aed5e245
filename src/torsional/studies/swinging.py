"""A centrifugal pendulum on its exact path in time, beside the linear one: the gearbox input with it over that without
it, and how much of its path it takes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from torsional.absorbers import CentrifugalPendulum
from torsional.absorbers.pendulum import flattening
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import at_input, main_order, mean_torque, responded
from torsional.studies.settling import Stepped, reach_of
from torsional.studies.trucks import only, without

STEPS = 200
"""Steps a firing: 7.5 times as many change ratios of the firing order by less than 0.6 %, of all orders by 1.7 %."""
SHORT = 0.6
"""Linear swing over the way that is called short."""
PATIENCE = 256
"""Firings after which a motion that does not repeat itself is taken as it is."""
WANDERING = 64
"""Firings over which such a motion is looked at."""


class Swing(NamedTuple):
    """One speed [rad/s]: linear swing over the way, firing order with over without by linear analysis and in time, the
    motion of all orders (half peak-to-peak) with over without in time, largest swing in time over the way."""

    speed: float
    share: float
    linear: float
    timed: float
    whole: float
    reached: float


class Input(NamedTuple):
    """Acceleration at the gearbox input in time [rad/s²]: firing order, and all orders, half peak-to-peak; the run's
    largest twist of an asked connection [rad]."""

    order: float
    whole: float
    twist: float


def way(pendulum: CentrifugalPendulum) -> float:
    """Way along the path [m] to its cusp, ρ0/λ (a quarter turn of a circle), or to the stop before it."""
    bend = flattening(pendulum.path, pendulum.order)
    cusp = pendulum.curvature_radius * (1 / bend if bend else np.pi / 2)
    return min(cusp, pendulum.stop or np.inf)


def share_of_way(model: Model, speed: Array) -> Array:
    """Swing of the pendulum along its path, linear, over the way that it has."""
    name = only(model, CentrifugalPendulum)
    pendulum: Any = model.components[name]
    angle = responded(model, speed).angle.isel(order=0)
    swing = np.abs((angle.sel(node=name) - angle.sel(node=pendulum.carrier)).values) * pendulum.distance
    return np.asarray(swing / way(pendulum))


def swings(model: Model, speeds: Array) -> Iterator[Swing]:
    """The pendulum of a model at some speeds [rad/s], linear and in time; in top gear at the usual mean torque."""
    name = only(model, CentrifugalPendulum)
    pendulum: Any = model.components[name]
    bare = without(model, name)
    share, linear = share_of_way(model, speeds), at_input(model, speeds) / at_input(bare, speeds)
    for at, far, ratio in zip(speeds.tolist(), share.tolist(), linear.tolist(), strict=True):
        own, other = _with(model, at, f"{name}.suspension", far > SHORT), input_in_time(bare, at)
        reached = own.twist * pendulum.distance / way(pendulum)
        yield Swing(at, far, ratio, own.order / other.order, own.whole / other.whole, reached)


def _with(model: Model, speed: float, element: str, far: bool) -> Input:
    """The motion in time; not a number where a pendulum that swings ``far`` is driven through its own stop."""
    try:
        return input_in_time(model, speed, element)
    except ModelError:
        if not far:
            raise
        return Input(np.nan, np.nan, np.nan)


def input_in_time(model: Model, speed: float, element: str = "") -> Input:
    """The motion that a run by time steps from equilibrium settles on, springs and the pendulum's path as they are."""
    order, node = main_order(model), model.landmarks.input
    firing = 2 * np.pi / (order * speed)
    line = Stepped.of(model, speed, mean_torque(model), longest=firing / STEPS, patience=PATIENCE)
    found = line.settled()
    run = line.run(found, int(found.attrs["periods"]) or WANDERING)
    angle = abs(found.angle.sel(node=node, order=order).item())
    whole = float(np.ptp(run.acceleration.sel(node=node).values) / 2)
    return Input(angle * (order * speed) ** 2, whole, float(np.abs(reach_of(run, element)).max()) if element else 0.0)
