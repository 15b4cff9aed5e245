"""`torsional campbell`: the speeds at which engine orders meet the modes, gear by gear."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount
from torsional.cli.modes import in_gear
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.model import Model
from torsional.quantities import named_modes
from torsional.solvers import campbell
from torsional.units import show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS = 40


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    order: Sequence[str] | None,
    orders: str,
) -> None:
    """Answer the command."""
    machine = request.model
    gears, asked = inputs.gears(machine, gear), inputs.orders(order, orders)
    mean = inputs.torque(machine, torque)
    at = inputs.speeds(machine, speed, SPEEDS) if speed else None
    data = campbell.campbell(machine, mean, gears, at, None if asked is None else asked.tolist())
    settings = {"gears": gears, "torque": amount(mean, "torque"), "orders": data.order.values}
    tables = [_table(data.sel(gear=name), machine, name) for name in gears]
    answer = Answer(
        "campbell", tables, told_settings(request, **settings), data, picture=lambda: _picture(data, machine)
    )
    deliver(answer, request)


def _table(data: xr.Dataset, model: Model, gear: str) -> Table:
    middle = data.isel(speed=data.sizes["speed"] // 2)
    kept = np.flatnonzero(middle.frequency.values > 0)
    names = _names(middle, model)
    columns = [Column("mode", "number"), Column("name"), Column("frequency", "frequency")]
    columns += [Column(f"order {n:g} at", "speed") for n in data.order.values]
    rows = [[int(i), names[i], float(middle.frequency[i]), *map(float, data.crossing[i].values)] for i in kept]
    told = (
        f"frequencies at {show(float(middle.speed), 'speed')}, mean torque {show(data.attrs['mean_torque'], 'torque')}"
    )
    return Table(f"Speeds at which orders meet modes{in_gear(gear)}; {told}", columns, rows)


def _names(at: xr.Dataset, model: Model) -> list[str]:
    """The modes' names in one gear at one speed."""
    return named_modes(at.isel(mode=np.flatnonzero(np.isfinite(at.frequency.values))), model.mode_groups)


def _picture(data: xr.Dataset, model: Model) -> Figure:
    from torsional.plots import plot_campbell
    from torsional.plots.style import readable

    gear, last = str(data.gear.values[-1]), data.isel(gear=-1, speed=-1)  # the lines that are named, where they end
    names = {gear: [readable(name) for name in _names(last, model)]}
    return plot_campbell(data, names, speed=model.operation.speed, idle=model.operation.idle)
