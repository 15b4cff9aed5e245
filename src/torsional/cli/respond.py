"""`torsional respond`: response to the engine orders over speed, its peaks by place and order."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount
from torsional.cli.failures import complain
from torsional.cli.modes import in_gear
from torsional.cli.places import chosen_places, together, without_empty
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, swing
from torsional.solvers.run_up import run_up_response
from torsional.system import assemble
from torsional.units import show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS = 141
LISTED = 4
"""Orders told for each place in the table, largest first; files hold all of them."""


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    order: Sequence[str] | None,
    orders: str,
    node: Sequence[str] | None,
    element: Sequence[str] | None,
) -> None:
    """Answer the command."""
    machine = request.model
    engaged, speeds = inputs.one_gear(machine, gear), inputs.speeds(machine, speed, SPEEDS)
    mean = np.full(len(speeds), inputs.torque(machine, torque, speeds)) if torque else machine.full_load(speeds)
    asked = inputs.orders(order, orders)
    n = HALF_ORDERS if asked is None else asked
    places = chosen_places(machine, engaged, node, element)
    inputs.affordable(len(speeds) * len(n), 4 * len(machine.powertrain(engaged).components))
    data = response(machine, engaged, speeds, mean, n, *places)
    loaded: object = amount(float(mean[0]), "torque") if torque else "full load"
    settings = {"gear": engaged, "torque": loaded, "orders": data.order.values}
    title = f"{in_gear(engaged)}, " + (show(float(mean[0]), "torque") if torque else "full load")
    _warn_unsolved(data)
    found, told = tables(data, title, chosen=asked is not None), told_settings(request, **settings)
    answer = Answer("respond", found, told, data, picture=lambda: _picture(data))
    deliver(answer, request)


def response(
    model: Model, gear: str, speeds: Array, torques: Array, orders: Array, nodes: Sequence[str], elements: Sequence[str]
) -> xr.Dataset:
    """`run_up_response` at some places, and of all orders `together` the swings over speed beside their bounds."""
    found = run_up_response(model, speeds, torques, gear, orders)
    _warn_crossed(model, gear, found)
    found = found.sel(node=list(nodes), element=list(elements))
    return without_empty(found.drop_vars(("twist", "mean_twist")).assign(together(found.angle, found.torque)))


def tables(data: xr.Dataset, title: str, chosen: bool = False) -> list[Table]:
    """Peaks of accelerations at nodes and of torques of elements; of orders ``chosen`` it is said that they are."""
    kinds = (("node", "acceleration"), ("element", "torque"))
    which = "orders chosen" if chosen else "all orders"
    return [_table(data, dim, kind, which, title) for dim, kind in kinds if dim in data.dims]


def _warn_crossed(model: Model, gear: str, found: xr.Dataset) -> None:
    """Say where a spring's swing runs across a stage, its free play or its stop, and where friction slips."""
    c = assemble(model.powertrain(gear)).connections
    for name, law in zip(c.names, c.laws, strict=True):
        if law is not None:
            mean, half = found.mean_twist.sel(element=name), swing(found.twist.sel(element=name))
            at = found.speed.values[law.changes_within(mean - half, mean + half)]
            if len(at):
                span = show(float(at[0]), "speed") + (f" to {show(float(at[-1]), 'speed')}" if len(at) > 1 else "")
                complain(f"{name} {law.departs}: {span}", kind="warning")


def _warn_unsolved(data: xr.Dataset) -> None:
    found = data.angle if "angle" in data else data.torque
    speeds = found.speed.values[np.isnan(found.values).any(axis=(1, 2))]
    if len(speeds):
        where = show(float(speeds[0]), "speed") + (f" and {len(speeds) - 1} more" if len(speeds) > 1 else "")
        remedy = "give the parts some damping, or choose other speeds"
        complain(f"an undamped mode is met at {where}, where no response is finite; {remedy}", kind="warning")


def _orders_of(data: xr.Dataset, dim: str) -> xr.DataArray:
    """Orders of the acceleration at nodes, or of the torque of elements."""
    return acceleration(data.angle) if dim == "node" else data.torque


def _table(data: xr.Dataset, dim: str, kind: str, which: str, title: str) -> Table:
    orders = _orders_of(data, dim)
    columns = [Column(dim), Column("of"), Column("peak", kind), Column("at", "speed")]
    rows: list[Sequence[object]] = []
    for place in data[dim].values:
        together = data[f"{kind}_swing"].sel({dim: place}), data[f"{kind}_bound"].sel({dim: place})
        if data.sizes["order"] > 1:  # one order alone swings by its amplitude
            rows.append([place, f"{which}, half peak-to-peak", *_peak(together[0])])
            rows.append([place, f"{which}, sum as a bound", *_peak(together[1])])
        rows += [[place, f"order {n:g}, 0-peak", *told] for n, told in strongest(orders.sel({dim: place}))]
    return Table(f"{kind.capitalize()} at its highest{title}", columns, rows)


def _peak(values: xr.DataArray) -> tuple[float, float]:
    if not np.isfinite(values.values).any():  # an undamped mode met at every speed asked for
        return np.nan, np.nan
    at = int(values.argmax("speed"))
    return float(values[at]), float(values.speed[at])


def strongest(orders: xr.DataArray) -> list[tuple[float, tuple[float, float]]]:
    """The orders with the highest peaks over speed, largest first: order, (peak, speed)."""
    peaks = [(float(n), _peak(abs(orders.sel(order=n)))) for n in orders.order.values]
    return sorted(peaks, key=lambda told: -told[1][0])[:LISTED]


def _picture(data: xr.Dataset) -> Figure:
    """The strongest orders over speed, a panel for each place."""
    from torsional.plots import panels, plot_order_cuts
    from torsional.plots.style import figure_of, readable

    dims = [dim for dim in ("node", "element") if dim in data.dims]
    places = {str(name): _orders_of(data, dim).sel({dim: name}) for dim in dims for name in data[dim].values}
    columns = 1 if len(places) == 1 else 2
    drawn = panels(-(-len(places) // columns), columns)
    for axes, (place, values) in zip(drawn, places.items(), strict=False):
        chosen = [n for n, _ in strongest(values)]
        plot_order_cuts({readable(place): values.expand_dims(gear=[""])}, "", chosen, axes=axes)
        axes.set_title(readable(place))
        axes.legend()
    for axes in drawn[len(places) :]:
        axes.remove()
    return figure_of(drawn[0])
