"""`torsional map`: response over speed, mean torque and gear, its worst cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.failures import complain
from torsional.cli.places import chosen_places, together, without_empty
from torsional.cli.progress import progress
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.solvers.map import response_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS, TORQUES = 57, 26


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    order: Sequence[str] | None,
    orders: str,
    node: Sequence[str] | None,
    element: Sequence[str] | None,
    worst: str,
) -> None:
    """Answer the command."""
    machine, listed = request.model, inputs.whole(worst, "--worst", 1, usual=3)
    gears, asked = inputs.gears(machine, gear), inputs.orders(order, orders)
    speeds, torques = inputs.speeds(machine, speed, SPEEDS), inputs.torques(machine, torque, TORQUES)
    nodes, elements = chosen_places(machine, gears[-1], node, element)
    n = HALF_ORDERS if asked is None else asked
    kept = len(gears) * (len(nodes) + len(elements))
    width = len(machine.powertrain(gears[-1]).nodes) + 2 * len(machine.landmarks.throws) + kept
    inputs.affordable(len(speeds) * len(torques) * len(n), width)
    with progress("gears", request.quiet or request.as_json) as moved:
        found = response_map(machine, speeds, torques, gears, n, nodes=nodes, elements=elements, progress=moved)
        data, full = reduced(found, machine), without_empty(found)
    _warn_unsolved(full)
    settings = {"gears": gears, "orders": full.order.values}
    tables = [_summary(full, machine), *_tables(data, listed)]
    answer = Answer(
        "map", tables, told_settings(request, **settings), data, full.assign(data.data_vars), lambda: _picture(data)
    )
    deliver(answer, request)


def reduced(full: xr.Dataset, model: Model) -> xr.Dataset:
    """All orders together in each cell of a `response_map`, beside the bounds; gear by gear, to spare memory."""
    parts = [_one_gear(full.isel(gear=[i]), model) for i in range(full.sizes["gear"])]
    found = xr.concat(parts, "gear", combine_attrs="override")
    kept = full[["within_full_load", "mean_twist"]].assign(unsolved=(full.status > 1).any("order"))
    return without_empty(found.merge(kept)).assign_attrs(full.attrs)


def _one_gear(full: xr.Dataset, model: Model) -> xr.Dataset:
    told = together(full.angle, full.torque)
    return xr.Dataset({name: values.transpose("gear", "mean_torque", "speed", ...) for name, values in told.items()})


def _warn_unsolved(full: xr.Dataset) -> None:
    count = int((full.status > 1).any("order").sum())
    if count:
        remedy = "give the parts some damping, or choose other speeds"
        complain(f"{count} cells meet an undamped mode and have no finite response; {remedy}", kind="warning")


def _summary(full: xr.Dataset, model: Model) -> Table:
    within = int(full.within_full_load.sum()) * full.sizes["gear"]
    rows: list[Sequence[object]] = [
        ["model", model.name],
        ["gears", ", ".join(name for name in full.gear.values if name) or "none"],
        [
            "grid",
            " × ".join(
                f"{full.sizes[dim]} {dim.removeprefix('mean_')}s" for dim in ("gear", "mean_torque", "speed", "order")
            ),
        ],
        ["cells within full load", f"{within} of {full.within_full_load.size * full.sizes['gear']}"],
    ]
    return Table("Map", [Column("what"), Column("value")], rows)


def _tables(data: xr.Dataset, count: int) -> list[Table]:
    """The cells within full load in which the swing is largest, for each place."""
    found = []
    for dim, kind in (("node", "acceleration"), ("element", "torque")):
        if dim not in data.dims:
            continue
        columns = [Column(dim), Column("gear"), Column("torque", "torque"), Column("speed", "speed")]
        columns += [Column("half p-p", kind), Column("bound", kind)]
        rows = [row for place in data[dim].values for row in _worst(data, dim, kind, place, count)]
        found.append(Table(f"{kind.capitalize()}: half peak-to-peak, worst cells within full load", columns, rows))
    return found


def _worst(data: xr.Dataset, dim: str, kind: str, place: str, count: int) -> list[list[object]]:
    swung = data[f"{kind}_swing"].sel({dim: place}).where(data.within_full_load)
    most = data[f"{kind}_bound"].sel({dim: place})
    ranked = np.argsort(-swung.fillna(-1.0).values, axis=None, kind="stable")[:count]
    rows = []
    for gear, torque, speed in zip(*np.unravel_index(ranked, swung.shape), strict=True):
        at = {"gear": int(gear), "mean_torque": int(torque), "speed": int(speed)}
        cell, limit = swung.isel(at), most.isel(at)
        if np.isfinite(float(cell)):
            rows.append(
                [place, str(cell.gear.values), float(cell.mean_torque), float(cell.speed), float(cell), float(limit)]
            )
    return rows


def _picture(data: xr.Dataset) -> Figure:
    """Half peak-to-peak over speed and torque: of every place in one gear, or of one place in every gear."""
    from torsional.plots import panels, plot_map
    from torsional.plots.maps import colour_limits
    from torsional.plots.style import figure_of, readable

    values = _pictured(data)
    columns = min(len(values), 2 if data.sizes["gear"] == 1 else 4)
    drawn = panels(-(-len(values) // columns), columns, (6.0, 4.2))
    limits = None if data.sizes["gear"] == 1 else colour_limits(*(value.values for value in values))
    for axes, value in zip(drawn, values, strict=False):
        place = value.node if "node" in value.coords else value.element
        title = readable(place.values) + (f", gear {value.gear.values}" if str(value.gear.values) else "")
        plot_map(value, within=data.within_full_load, limits=limits, title=title, axes=axes)
    for axes in drawn[len(values) :]:
        axes.remove()
    return figure_of(drawn[0])


def _pictured(data: xr.Dataset) -> list[xr.DataArray]:
    """The maps to draw; of several gears those of the last node, or of the first connection if no node is asked for."""
    nodes = [data.acceleration_swing.isel(node=i) for i in range(data.sizes.get("node", 0))]
    elements = [data.torque_swing.isel(element=i) for i in range(data.sizes.get("element", 0))]
    if data.sizes["gear"] == 1:
        return [value.isel(gear=0) for value in [*nodes, *elements]]
    chosen = nodes[-1] if nodes else elements[0]
    return [chosen.isel(gear=i) for i in range(data.sizes["gear"])]
