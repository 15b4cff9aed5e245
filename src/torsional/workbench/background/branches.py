"""Branches of periodic motion over speed, stable and unstable, with the linear response beside them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.quantities import acceleration, swing
from torsional.quantities.branches import bifurcation_points, coexisting, pieces
from torsional.solvers.periodic import model_response
from torsional.solvers.run_up import run_up_response
from torsional.units import show
from torsional.workbench.background.asking import Found, Long, Name, Progress, Range, span_of
from torsional.workbench.fields import words
from torsional.workbench.views.asking import Answer, Number, main_order, reached

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BETWEEN, LINEAR = 201, 300
"""Speeds at which every branch has a point beside those of the solver, and those of the linear response."""


class Branches(Long):
    """All periodic motions over a range of speed, at full load or one mean torque, seen at one place.

    ``place``: a node (its acceleration) or a connection (its torque); default: the first connection with a law.
    """

    torque: Number | Literal["full_load"] = "full_load"
    speed: Range | None = None
    place: Name = ""
    orders: Annotated[list[Annotated[float, Field(gt=0, le=48)]], Field(max_length=8)] | None = None
    isolated: bool = False

    def found(self, model: Model, progress: Progress) -> Found:
        """Lines by branch and stability; values 0-peak, "swing" half peak-to-peak."""
        gear = model.gear_name(self.gear)
        low, high = span_of(self.speed, model.operation.speed, "settings.speed")
        torque = None if self.torque == "full_load" else self.torque
        progress(0, 2, "following branches of periodic motion")
        at = np.linspace(low, high, BETWEEN)
        data = model_response(model, (low, high), torque, gear, at=at, isolated=self.isolated)
        place, signal = self._signal(data)
        orders = self._orders(data)
        progress(1, 2, "linear response")
        content = {
            "gear": gear,
            "torque": self.torque,
            "place": place,
            "label": words(place),
            "quantity": str(signal.attrs["quantity"]),
            "orders": orders,
            "lines": list(_lines(data, signal, orders)),
            "points": list(_points(data, signal, orders)),
            "coexisting": [{"speed": span, "branches": here} for span, here in coexisting(data)],
            "linear": _linear(model, gear, place, torque, (low, high), orders),
        }
        loaded = "full load" if torque is None else f"mean torque {show(torque, 'torque')}"
        heading = f"{model.name}{f', gear {gear}' if gear else ''}, {loaded}"
        return Found(content, lambda: _picture(data, place, orders, heading), _table(data, place))

    def _signal(self, data: xr.Dataset) -> tuple[str, xr.DataArray]:
        """The place, and its complex orders along the points."""
        place = self.place or str(json.loads(data.attrs["laws"])[0])
        if place in data.element.values:
            return place, data.torque.sel(element=place)
        if place in data.node.values:
            return place, acceleration(data.angle.sel(node=place))
        known = [*map(str, data.element.values), *map(str, data.node.values)]
        raise ModelError(f"there is no place '{place}'", where="settings.place", remedy=nearest(place, known))

    def _orders(self, data: xr.Dataset) -> list[float]:
        """Those asked for, or the main order and half of it where some branch has that."""
        known, main = data.order.values, float(data.attrs["main_order"])
        found = [n for n in (self.orders or (main, main / 2)) if n in known]
        if not found:
            allowed = ", ".join(f"{n:g}" for n in known[known > 0])
            raise ModelError("no branch has this order", where="settings.orders", allowed=allowed)
        return found


def _values(signal: xr.DataArray, orders: list[float]) -> dict[str, np.ndarray]:
    """Amplitudes by order, and the swing of all orders together."""
    by_order = {f"{n:g}": np.abs(signal.sel(order=n).values) for n in orders}
    return {**by_order, "swing": swing(signal).values}


def _lines(data: xr.Dataset, signal: xr.DataArray, orders: list[float]) -> Iterator[Answer]:
    """A line for each part of a branch that is stable or unstable throughout."""
    values = _values(signal, orders)
    main = float(data.attrs["main_order"])
    for piece in pieces(data):
        base = float(data.base_order.values[piece.branch])
        yield {
            "branch": piece.branch,
            "kind": str(data.kind.values[piece.branch]),
            "period": max(1, round(main / base)) if base > 0 else 1,
            "stable": np.full(len(piece.points), float(piece.stable)),
            "speed": data.speed.values[piece.points],
            "value": {name: all_[piece.points] for name, all_ in values.items()},
        }


def _points(data: xr.Dataset, signal: xr.DataArray, orders: list[float]) -> Iterator[Answer]:
    """Folds and bifurcations, each on its branch."""
    values = _values(signal, orders)
    for number, point in enumerate(bifurcation_points(data)):
        yield {
            "kind": str(data.bifurcation_type.values[number]),
            "speed": float(data.bifurcation_speed.values[number]),
            "branch": int(data.on_branch.values[number]),
            "value": {name: float(all_[point]) for name, all_ in values.items()},
        }


def _linear(
    model: Model, gear: str, place: str, torque: float | None, span: tuple[float, float], orders: list[float]
) -> Answer:
    """The linear response over the same speeds, springs as stiff as under the mean torque."""
    speeds = np.linspace(*span, LINEAR)
    speeds = reached(model, speeds) if torque is None else speeds
    mean = model.full_load(speeds) if torque is None else np.full(len(speeds), torque)
    known = [n for n in orders if main_order(model)]
    found = run_up_response(model, speeds, mean, gear, sorted(known))
    node = place in found.node.values
    signal = acceleration(found.angle.sel(node=place)) if node else found.torque.sel(element=place)
    return {"speed": speeds, "value": {f"{n:g}": np.abs(signal.sel(order=n).values) for n in known}}


def _picture(data: xr.Dataset, place: str, orders: list[float], heading: str) -> Figure:
    from torsional.plots import plot_periodic

    elements = [place] if place in data.element.values else []
    nodes = [] if elements else [place]
    return plot_periodic(data, [*orders, "swing"], elements=elements, nodes=nodes, heading=heading)


def _table(data: xr.Dataset, place: str) -> xr.Dataset:
    """Along the points: what is looked at, with its stability."""
    if place in data.element.values:
        return data[["torque", "twist", "stable"]].sel(element=[place])
    return data[["angle", "stable"]].sel(node=[place])
