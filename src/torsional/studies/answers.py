"""What the claims ask again and again: order responses at the gearbox input, modes by gear, where a curve is lowest.

Amplitudes are those of one order, half peak-to-peak.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.solvers.harmonic import harmonic_response, node_angles, order_response
from torsional.solvers.modal import modal, natural_frequencies
from torsional.solvers.operating import at_operating_point
from torsional.studies.concepts import Scale
from torsional.studies.trucks import reached
from torsional.system import System
from torsional.units import RPM

Curves: TypeAlias = Mapping[str, ArrayLike]
LOAD = 0.6
"""Mean torque of linear comparisons over the peak of the full-load curve."""
INPUT = "mean torque 60 % of the peak, top gear; firing order's acceleration at the gearbox input, half peak-to-peak"
"""Condition of most comparisons of amplitudes."""
STEP = 10 * RPM
"""Step of speed grids [rad/s]."""


def speeds(model: Model, step: float = STEP) -> Array:
    """Mean speeds of the operating range [rad/s]."""
    low, high = model.operation.speed
    return np.linspace(low, high, round((high - low) / step) + 1)


def by_idle(model: Model, speed: ArrayLike) -> Any:
    """A speed chosen for the shipped truck, moved with a truck's idle; on the shipped truck itself the same bits.

    >>> from torsional.studies.trucks import Trucks
    >>> by_idle(Trucks.shipped().dmf, 900.0)
    900.0
    """
    return Scale.of(model).idle * speed  # type: ignore[operator]


def by_peak(model: Model, torque: ArrayLike) -> Any:
    """A torque, or a stiffness, chosen for the shipped truck, moved with the peak of a truck's full-load curve; on the
    shipped truck itself the same bits.

    >>> from torsional.studies.trucks import Trucks
    >>> by_peak(Trucks.shipped().dmf, 1000.0)
    1000.0
    """
    return Scale.of(model).torque * torque  # type: ignore[operator]


def mean_torque(model: Model) -> float:
    """The mean torque of linear comparisons [Nm]."""
    return LOAD * model.full_load_peak()


def main_order(model: Model) -> float:
    """The firing order: half the number of cylinders."""
    return model.running_engine.layout.cylinders / 2


def responded(
    model: Model,
    speed: Array,
    torque: ArrayLike | None = None,
    gear: str | None = None,
    orders: ArrayLike | None = None,
) -> xr.Dataset:
    """Order response over ``speed`` under a mean torque (one, or one a speed), linear about the first of them.

    ``orders``: the firing order alone unless given.
    """
    return harmonic_response(*_loaded(model, speed, torque, gear, orders))


@lru_cache(maxsize=16)
def linear_system(model: Model, torque: float, gear: str | None = None) -> System:
    """The linear system about a mean torque [Nm]; kept, as searches ask it point by point."""
    return at_operating_point(model, torque, gear)[0]


def _loaded(
    model: Model, speed: Array, torque: ArrayLike | None, gear: str | None, orders: ArrayLike | None = None
) -> tuple[System, Excitation]:
    """The linear system and what the engine does to it."""
    means = np.broadcast_to(mean_torque(model) if torque is None else np.asarray(torque, dtype=float), speed.shape)
    system = linear_system(model, float(means[0]), gear)
    asked = [main_order(model)] if orders is None else orders
    nodes: Sequence[str] = model.landmarks.throws
    if len(nodes) == 1:  # a lumped engine
        nodes = nodes[0]
    return system, model.running_engine.excitation(nodes, speed, means, asked)


def at_input(model: Model, speed: Array, torque: ArrayLike | None = None, gear: str | None = None) -> Array:
    """Amplitude of the firing order's acceleration at the gearbox input [rad/s²], half peak-to-peak, over speed."""
    system, drive = _loaded(model, speed, torque, gear)
    angle = order_angles(system, drive, model.landmarks.input)
    return np.asarray(np.abs((main_order(model) * speed) ** 2 * angle))


def order_angles(system: System, drive: Excitation, node: str) -> ComplexArray:
    """Angle of a node [rad], complex 0-peak, over the speeds of an excitation by one order."""
    *_, q = order_response(system, drive)
    return np.asarray(node_angles(system, q)[:, system.node_index(node)])


@lru_cache(maxsize=16)
def input_shaft(model: Model) -> str:
    """The connection that brings torque to the gearbox input from the engine's side."""
    powertrain, node = model.powertrain(), model.landmarks.input
    for name in (stamp.name for stamp in powertrain.stamps if node in stamp.weights):
        cut = reached(powertrain, [node], [name])
        if not cut & set(model.landmarks.throws):
            return name
    raise ModelError("no single connection brings the torque to the input", where=node)


def modes(model: Model, gear: str | None = None) -> xr.Dataset:
    """Undamped elastic modes about the mean torque, with the ``order_speed`` [rad/s] of the firing order."""
    system = linear_system(model, mean_torque(model), gear)
    found = modal(system)
    found = found.isel(mode=np.flatnonzero(found.frequency.values > 0))
    return found.assign(order_speed=("mode", 2 * np.pi * found.frequency.values / main_order(model)))


def tracked(model: Model, gear: str, place: int) -> float:
    """Order speed [rpm] of the elastic mode with a number; modes of a chain do not cross when one spring changes."""
    omega = natural_frequencies(linear_system(model, mean_torque(model), gear))
    return float(omega[omega > 0][place]) / main_order(model) / RPM


def mode_of(found: xr.Dataset, *elements: str) -> int:
    """Place of the mode with the largest share of elastic energy in some connections."""
    return int(found.elastic_share.sel(element=list(elements)).sum("element").values.argmax())


def by_gear(model: Model, *elements: str) -> tuple[Array, Array, list[str]]:
    """Of the mode that lives in ``elements``, for every gear: order speed [rpm], their energy share, the largest one's
    name."""
    rpm, share, dominant = [], [], []
    for gear in model.gear_names:
        found = modes(model, gear)
        place = mode_of(found, *elements)
        energy = found.elastic_share.isel(mode=place)
        rpm.append(float(found.order_speed[place]) / RPM)
        share.append(float(energy.sel(element=list(elements)).sum()))
        dominant.append(str(energy.element.values[int(energy.values.argmax())]))
    return np.array(rpm), np.array(share), dominant


def lowest(curve: Callable[[Array], Array], grid: Array) -> float:
    """Where a curve is lowest: the lowest grid point, then Brent's bounded search between its neighbours."""
    best = int(np.argmin(curve(grid)))
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]

    def at(x: float) -> float:
        return float(curve(np.array([x]))[0])

    return float(minimize_scalar(at, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * high}).x)


def falling(values: ArrayLike) -> bool:
    """Whether values fall strictly along the first axis."""
    return bool(np.all(np.diff(np.asarray(values), axis=0) < 0))


def rising(values: ArrayLike) -> bool:
    """Whether values rise strictly along the first axis."""
    return bool(np.all(np.diff(np.asarray(values), axis=0) > 0))


def floats(values: ArrayLike) -> tuple[float, ...]:
    """An array as figures."""
    return tuple(float(value) for value in np.ravel(np.asarray(values)))


def span(speed: Array) -> str:
    """The ends of a set of speeds [rad/s] in words."""
    low, high = speed.min() / RPM, speed.max() / RPM
    return f"{low:.0f} rpm" if low == high else f"{low:.0f}–{high:.0f} rpm"
