"""`torsional modes`: natural frequencies by name, with damping, speeds of the main order, and energy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.model import Model
from torsional.quantities.modes import modes_of
from torsional.units import show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NOTABLE = 0.1
"""Least share of a mode's elastic energy that is worth a word."""


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    order: str,
) -> None:
    """Answer the command."""
    machine = request.model
    names = inputs.gears(machine, gear)
    at = inputs.speed(machine, speed)
    mean = inputs.torque(machine, torque, [at] if speed else [])
    asked = inputs.orders([order] if order else None, "")
    main = float(asked[0]) if asked is not None else next(iter(machine.engine_orders()), None)
    found = [modes_of(machine, name, mean, at, main) for name in names]
    settings = {"gears": names, "torque": amount(mean, "torque"), "speed": amount(at, "speed"), "order": main}
    tables = [_table(data, name, settings) for data, name in zip(found, names, strict=True)]
    answer = Answer(
        "modes",
        tables,
        told_settings(request, **settings),
        xr.concat(found, "gear", combine_attrs="override").assign_coords(gear=names),
        picture=lambda: _picture(machine, found[-1], names[-1]),
    )
    deliver(answer, request)


def _table(data: xr.Dataset, gear: str, settings: Mapping[str, object]) -> Table:
    order = settings["order"]
    columns = [
        Column("mode", "number"),
        Column("name"),
        Column("frequency", "frequency"),
        Column("damping ratio", "damping_ratio"),
        *([Column(f"order {order:g} meets it at", "speed")] if order is not None else []),
        Column("elastic energy"),
    ]
    rows = [_row(data.isel(mode=i), int(data.mode[i]), order is not None) for i in range(data.sizes["mode"])]
    return Table(f"Modes{in_gear(gear)}, {at_torque(settings)}", columns, rows)


def _row(mode: xr.Dataset, number: int, with_order: bool) -> list[object]:
    elastic = float(mode.frequency) > 0
    met = [float(mode.order_speed) if elastic else None] if with_order else []
    ratio = float(mode.damped_ratio) if elastic else None
    return [number, str(mode.name.values), float(mode.frequency), ratio, *met, _shares(mode.elastic_share)]


def _shares(share: xr.DataArray) -> str:
    largest = np.argsort(-share.values, kind="stable")[:3]
    told = [(share.element.values[i], float(share.values[i])) for i in largest]
    return ", ".join(f"{name} {100 * value:.0f} %" for name, value in told if value >= NOTABLE)


def in_gear(gear: str) -> str:
    """The gear as part of a title; nothing for a machine without gears."""
    return f" in gear {gear}" if gear else ""


def at_torque(settings: Mapping[str, object]) -> str:
    """Mean torque and speed as part of a title."""
    mean, speed = (settings[key]["value"] for key in ("torque", "speed"))  # type: ignore[index]
    return f"mean torque {show(mean, 'torque')} at {show(speed, 'speed')}"


def _picture(model: Model, data: xr.Dataset, gear: str) -> Figure:
    from torsional.plots import plot_mode_shapes

    return plot_mode_shapes(data, model.powertrain(gear), names=[str(name) for name in data.name.values])
