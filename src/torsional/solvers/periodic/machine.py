"""Periodic response of a described machine under its engine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine import Engine
from torsional.engine.orders import HALF_ORDERS, HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.files import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import of_model
from torsional.solvers.operating import torque_places
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.solvers.periodic.response import Exploration, Variation, answered
from torsional.system import System, assemble

Range = tuple[float, float]

ACROSS = 1e-6
NARROW = 1e-3
SPEEDS, TORQUES = 9, 65
"""Operating points that the engine is asked for: over speed it is a parabola, over torque it has corners."""


@checked
def model_response(
    model: Model,
    speed: Range | None = None,
    torque: float | None = None,
    gear: str | int | None = None,
    *,
    at: ArrayLike = (),
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
    depth: int = 2,
    stability: bool = True,
    isolated: bool = False,
) -> xr.Dataset:
    """`periodic_response` of a ``model`` in one ``gear`` over a range of ``speed`` [rad/s] at one mean engine
    ``torque`` [Nm], or at full load where that is None.

    ``at``: speeds at which every branch that passes them gets a point.  Branches that hang together with none of those
    are sought where ``isolated``.
    Of the engine's orders those are taken that its cylinders have in common (every third of an evenly fired six), since
    on a stiff crankshaft the others cancel; with ``base_order`` 0.5 all are, and what was a bifurcation to twice the
    period is then rounded off by the small excitation at its own order.
    Raises ModelError for a model without engine, without laws, or that does not say where torque enters and leaves.
    """
    span = model.operation.speed if speed is None else (float(speed[0]), float(speed[1]))
    load = engine_load(model, span, torque, highest_order, base_order)
    asked = Exploration(
        highest_order=highest_order, base_order=base_order, depth=depth, stability=stability, isolated=isolated, at=at
    )
    return _explored(model, gear, load, span, asked)


@checked
def varied_response(
    model: Model,
    path: str,
    span: tuple[float, float],
    speed: float,
    torque: float,
    gear: str | int | None = None,
    *,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
    depth: int = 2,
    stability: bool = True,
    isolated: bool = False,
    at: ArrayLike = (),
) -> xr.Dataset:
    """`periodic_response` of a ``model`` over a value of its file, or over the mean torque, at one ``speed`` [rad/s].

    ``path`` names the value, as in ``absorber.stages.1.stiffness``, and ``span`` its range in SI units; "torque" stands
    for the mean engine torque [Nm]; ``at``: values at which every branch that passes them gets a point.  Raises
    ModelError as `model_response` does, and for a path the model does not have.
    """
    if path == "torque":
        load = engine_torque_load(model, speed, span, highest_order, base_order)
        parameter: str | Variation = "mean_torque"
    else:

        def build(value: float) -> System:
            return assemble(changed(model, {path: value}).powertrain(gear))

        near = engine_load(model, (speed * (1 - NARROW), speed * (1 + NARROW)), torque, highest_order, base_order)
        load = Load.polynomial(near.nodes, near.orders, np.array([span[0]]), near.at(speed)[None])
        parameter = Variation(path, "", build)
    asked = Exploration(
        parameter=parameter,
        speed=speed,
        highest_order=highest_order,
        base_order=base_order,
        depth=depth,
        stability=stability,
        isolated=isolated,
        at=at,
    )
    return _explored(model, gear, load, span, asked)


def _explored(model: Model, gear: str | int | None, load: Load, span: Range, asked: Exploration) -> xr.Dataset:
    """Branches of a model in a gear, its load taking up the mean torque, in the orders that the cylinders have."""
    data = system_response(model, assemble(model.powertrain(gear)), load, span, asked)
    return of_model(data, model, model.gear_name(gear))


def system_response(model: Model, system: System, load: Load, span: Range, asked: Exploration) -> xr.Dataset:
    """The same of a ``system`` that stands for a line of the model."""
    return answered(
        system,
        load,
        span,
        replace(asked, hold=model.landmarks.load, base_order=asked.base_order or load.base_order),
    )


def common_order(model: Model, speed: float, torque: float) -> float:
    """The largest order of which all torques that act on a stiff crankshaft are multiples."""
    engine = checked_engine(model)
    lumped = engine.harmonics(speed, torque, HALF_ORDERS).sum(axis=-2)
    sizes = np.abs(lumped)
    counts = HALF_ORDERS[sizes > ACROSS * sizes.max()]
    return float(np.gcd.reduce(np.round(2 * counts).astype(int))) / 2


def checked_engine(model: Model) -> Engine:
    """The engine of a model that has one and says where its torque goes."""
    engine = model.running_engine
    torque_places(model)
    return engine


def common_orders(
    model: Model, speed: float, torque: float, highest_order: float, base_order: float | None = None
) -> Array:
    """Orders from 0 to the highest, in multiples of the one that the cylinders have in common, or of ``base_order``."""
    base = common_order(model, speed, torque) if base_order is None else base_order
    if not 0 < base <= highest_order:
        found, allowed = f"{base:g} and {highest_order:g}", "0 < base_order <= highest_order"
        raise ModelError(
            "orders go up from the base order to the highest", where="orders", found=found, allowed=allowed
        )
    return np.asarray(base * np.arange(int(highest_order / base + 1e-9) + 1))


def engine_load(
    model: Model,
    speed: tuple[float, float],
    torque: float | None,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
) -> Load:
    """The engine's load over speed at one mean torque [Nm], or along full load."""
    engine = checked_engine(model)
    speeds = np.linspace(*speed, SPEEDS) if torque is not None else _knots(model, speed)
    torques = np.full(len(speeds), torque) if torque is not None else model.full_load(speeds)
    orders = common_orders(model, float(speeds.mean()), float(torques.mean()), highest_order, base_order)
    found = engine.excitation(model.landmarks.throws, speeds, torques, orders)
    return Load.over_speed(found)


def engine_torque_load(
    model: Model,
    speed: float,
    torque: Range,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
) -> Load:
    """The engine's load over mean torque [Nm] at one speed [rad/s]."""
    engine = checked_engine(model)
    torques = np.linspace(*torque, TORQUES)
    orders = common_orders(model, speed, float(torques.mean()), highest_order, base_order)
    found = engine.excitation(model.landmarks.throws, speed, torques, orders)
    return Load.through(found.nodes, orders, torques, found.torque)


def _knots(model: Model, speed: tuple[float, float]) -> Array:
    """Speeds that include the corners of the full-load curve, close to each other on both sides of them."""
    curve = model.full_load_curve
    corners = np.asarray(curve.speeds) if curve is not None else np.zeros(0)
    near = np.concatenate([corners - 0.05, corners, corners + 0.05, np.linspace(*speed, 81)])
    return np.unique(np.clip(near, *speed))


class EngineLoads:
    """The engine's loads over speed at any mean torque, each worked out once."""

    def __init__(
        self, model: Model, speed: tuple[float, float], highest_order: float, base_order: float | None = None
    ) -> None:
        self.model, self.speed, self.highest_order = model, speed, highest_order
        middle = 0.5 * sum(speed)
        self.base_order = base_order or common_order(model, middle, 0.5 * model.full_load_peak())
        self._loads: dict[float, Load] = {}
        self._problems: dict[tuple[int, float, float], HarmonicProblem] = {}

    def at(self, torque: float) -> Load:
        """The load over speed at one mean torque [Nm]."""
        if torque not in self._loads:
            self._loads[torque] = engine_load(self.model, self.speed, torque, self.highest_order, self.base_order)
        return self._loads[torque]

    def problem(self, like: HarmonicProblem, torque: float) -> HarmonicProblem:
        """The problem over speed at a mean torque, of the same base order and scales as another."""
        key = id(like.setting.split), like.base_order, torque
        if key not in self._problems:
            self._problems[key] = HarmonicProblem(replace(like.setting, load=self.at(torque)), like.base_order)
        return self._problems[key]
