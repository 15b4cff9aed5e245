"""Steady motions in time one after the other, each begun where the last one ended."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine import Excitation
from torsional.engine.orders import HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import of_model
from torsional.solvers.periodic.machine import checked_engine, common_orders
from torsional.solvers.transient.batch_results import row_dataset
from torsional.solvers.transient.batches import Asked, Batch
from torsional.solvers.transient.drives import OrderTorques
from torsional.solvers.transient.honesty import said
from torsional.solvers.transient.problem import Drives
from torsional.solvers.transient.steady import steady_state
from torsional.system import System, assemble

SCALARS = ("kind", "status", "periods", "exponent", "method_share")
PARTS = 2
"""Orders of a sweep are multiples of the base order over this."""


@checked
def steady_sweep(
    system: System,
    drives: Excitation | Callable[[float], Drives],
    values: ArrayLike,
    *,
    directions: Sequence[str] = ("up", "down"),
    **settings: Any,
) -> xr.Dataset:
    """`steady_state` over ``values``, up and then down again, each run begun where the one before it ended.

    ``drives``: an `Excitation` over speeds, whose values are speeds [rad/s], or a function from a value to the drives.
    Where the ways up and down differ several motions coexist.  ``settings`` are those of `steady_state`.
    Dimensions (direction, value, order, node or element); ``kind``, ``status``, ``periods``, ``exponent`` (direction,
    value) and the coordinate ``speed``.  Raises ModelError for values that do not rise.

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.laws import Polynomial
    >>> from torsional.powertrain import Powertrain
    >>> law = Polynomial((1.0, 0.0, 0.1))
    >>> duffing = assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law, damping=0.05)}))
    >>> drive = Excitation(("disc",), [1], 1.0, [[0.18]])
    >>> found = steady_sweep(duffing, drive, [1.0, 1.1, 1.2, 1.3], step=0.05, tolerance=1e-4)
    >>> abs(found.twist.sel(order=1, element="spring")).values[:, 2].round(1).tolist()  # bent over: it is late to fall
    [2.5, 0.4]
    """
    grid = np.atleast_1d(np.asarray(values, dtype=float))
    if (np.diff(grid) <= 0).any():
        raise ModelError("values of a sweep rise", where="values")
    if not directions or any(name not in ("up", "down") for name in directions):
        raise ModelError("unknown direction", where="directions", found=", ".join(directions), allowed="up, down")
    start: object = settings.pop("start", "vibrating")
    ways = []
    for way in directions:
        points = []
        for value in grid if way == "up" else grid[::-1]:
            points.append(_point(system, drives, float(value), start, settings))
            start = points[-1]
        found = points if way == "up" else points[::-1]
        ways.append(xr.concat([_told(point) for point in found], "value", **_JOIN))
    together = xr.concat(ways, "direction", **_JOIN)
    return together.assign_coords(direction=list(directions), value=grid).assign_attrs(analysis="sweep in time")


_JOIN: dict[str, Any] = {
    "data_vars": "all",
    "coords": "different",
    "compat": "equals",
    "combine_attrs": "drop_conflicts",
}


def _point(
    system: System,
    drives: Excitation | Callable[[float], Drives],
    value: float,
    start: object,
    settings: dict[str, Any],
) -> xr.Dataset:
    """One steady motion."""
    own = {"parts": PARTS, **settings}
    if isinstance(drives, Excitation):
        return steady_state(system, drives, speed=value, start=start, **own)
    return steady_state(system, drives(value), start=start, **own)


def _told(point: xr.Dataset) -> xr.Dataset:
    """A point with what is said of it as variables."""
    return point.assign({name: ((), point.attrs[name]) for name in SCALARS} | {"notes": ((), said(point.attrs))})


@checked
def engine_drive(
    model: Model,
    speed: float,
    torque: float,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
) -> Excitation:
    """The engine's orders at one ``speed`` [rad/s] and mean ``torque`` [Nm] on the throws of a ``model``, in multiples
    of the order that its cylinders have in common, or of ``base_order``.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> drive = engine_drive(truck, 1000 * torsional.RPM, 2000.0, highest_order=6.0)
    >>> drive.orders.tolist(), round(float(drive.torque[..., 0].real.sum()), 6)
    ([0.0, 3.0, 6.0], 2000.0)
    """
    engine = checked_engine(model)
    orders = common_orders(model, speed, torque, highest_order, base_order)
    return engine.excitation(model.landmarks.throws, speed, torque, orders)


@checked
def steady_map(
    model: Model,
    speeds: ArrayLike,
    torques: ArrayLike,
    gears: Sequence[str | int] | None = None,
    *,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Steady motions in time of a ``model`` over ``gears`` (default: all), mean engine ``torques`` [Nm] and ``speeds``
    [rad/s].

    Absorbers that have details are taken in detail.  Along the speeds each run begins where the one before it ended,
    at the first with the linear response.  Dimensions (gear, mean_torque, speed, order, node or element), beside
    them ``kind``, ``status`` and ``periods``, and of the steps ``method_share`` and ``notes``, see `transient`.

    All speeds of a torque are settled in one compiled loop, the torques side by side on the processors at hand.  A
    point that the loop does not see repeat itself is settled by `steady_state`, as its ``status`` says; where the line
    or its drives are not made for the loop all points are, and the attribute ``one_by_one`` says why.
    Raises ModelError for a model without an engine.
    """
    names = model.chosen_gears(gears)
    at, loads = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (speeds, torques))
    rows = []
    for name in names:
        drives = [[engine_drive(model, speed, torque, highest_order, base_order) for speed in at] for torque in loads]
        rows.append(xr.concat(settled_rows(model, name, at, drives, **settings), "torque_value", **_JOIN))
    found = xr.concat(rows, "gear", **_JOIN).rename(value="speed_value")
    found = found.drop_vars("speed", errors="ignore").rename(speed_value="speed", torque_value="mean_torque")
    found = found.assign_coords(gear=names, mean_torque=loads, speed=at)
    return of_model(found.assign_attrs(analysis="steady map in time"), model)


def settled_rows(
    model: Model, gear: str, speeds: Array, drives: Sequence[Sequence[Excitation | OrderTorques]], **settings: Any
) -> list[xr.Dataset]:
    """Rows of such a map in one ``gear``, each over ``value``, the ``speeds`` [rad/s], with a drive for every speed."""
    system = assemble(model.detailed().powertrain(gear))
    return _rows(system, speeds, drives, {"hold": model.landmarks.load, "parts": PARTS, **settings})


def _rows(
    system: System, speeds: Array, drives: Sequence[Sequence[Excitation | OrderTorques]], settings: dict[str, Any]
) -> list[xr.Dataset]:
    """The rows of one gear: in one compiled loop, or point by point where that cannot be."""
    reason = "settings of its own"
    if settings.keys() <= {part.name for part in fields(Asked)}:
        batch = Batch(system, drives, Asked(**settings))
        reason = batch.refusal
        if not reason:
            return [row_dataset(row) for row in batch.settled()]
    found = [_along(system, speeds, row, settings) for row in drives]
    return [row.assign_attrs(one_by_one=reason) for row in found]


def _along(
    system: System, speeds: Array, drives: Sequence[Excitation | OrderTorques], settings: dict[str, Any]
) -> xr.Dataset:
    """One row of the map, point by point."""
    at = dict(zip(speeds.tolist(), drives, strict=True))
    return steady_sweep(system, at.__getitem__, speeds, directions=("up",), **settings).isel(direction=0, drop=True)
