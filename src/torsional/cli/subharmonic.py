"""`torsional subharmonic`: the speeds and mean torques at which a model vibrates at half its engine's order."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.modes import in_gear
from torsional.cli.periodic import laws_of
from torsional.cli.places import chosen_places
from torsional.cli.progress import progress
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities.region import stretches
from torsional.studies.subharmonic import full_load_curve, sought_region, within
from torsional.units import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS, TORQUES = 71, 26


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    points: str,
    node: str,
    element: str,
) -> None:
    """Answer the command."""
    machine = request.model
    engaged = inputs.one_gear(machine, gear)
    many, few = (inputs.whole(points, "--points", 2, usual=usual) for usual in (SPEEDS, TORQUES))
    speeds = _several(inputs.speeds(machine, speed, many), "--speed")
    torques = _several(inputs.torques(machine, torque, few), "--torque")
    laws_of(machine, engaged)
    if node or element:
        chosen_places(machine, engaged, [node] if node else None, [element] if element else None)
    inputs.affordable(len(speeds) * len(torques), 16)
    with progress("mean torques", request.quiet or request.as_json) as moved:
        data = sought_region(
            machine,
            speeds,
            torques,
            engaged or None,
            closely=not (speed or torque),
            element=element,
            node=node,
            progress=moved,
        )
    settings = {"gear": engaged, "element": data.attrs["element"], "node": data.attrs["node"]}
    document = told_settings(request, **settings, order=data.attrs["order"])
    title = f"Order {float(data.attrs['order']):g}{in_gear(engaged)}"
    answer = Answer("subharmonic", tables(data, title), document, data, picture=lambda: _picture(data, machine, title))
    deliver(answer, request)


def _several(values: Array, option: str) -> Array:
    """At least two values, so that there is a region to look at."""
    if len(values) < 2:
        remedy = "write a range, as 600:1200rpm, or ask `torsional periodic` at one of them"
        raise ModelError("a region needs a range", where=option, remedy=remedy)
    return values


def tables(data: xr.Dataset, title: str) -> list[Table]:
    """The region within full load: its extent and largest amplitudes, then torque by torque."""
    inside = within(data)
    if not bool((inside.amplitude > 0).any()):
        return [_nothing(data, title)]
    return [_summary(inside, title), _by_torque(inside, data, title)]


def _nothing(data: xr.Dataset, title: str) -> Table:
    above = bool((data.amplitude > 0).any())
    told = "none within full load, though there is some above it" if above else "none found"
    rows = [["stable motion of this order", told], ["grid", _grid(data)]]
    return Table(f"{title}: no sub-harmonic vibration", [Column("what"), Column("value")], rows)


def _grid(data: xr.Dataset) -> str:
    return " × ".join(f"{data.sizes[dim]} {dim.removeprefix('mean_')}s" for dim in ("mean_torque", "speed"))


def _summary(inside: xr.Dataset, title: str) -> Table:
    columns = [Column("largest"), Column("of"), Column("0-peak"), Column("speed", "speed"), Column("torque", "torque")]
    columns.insert(3, Column("unit"))
    rows = []
    for name, place in (("amplitude", "element"), ("twist_amplitude", "element"), ("acceleration", "node")):
        size = inside[name].transpose("mean_torque", "speed")
        row, column = np.unravel_index(int(np.argmax(size.values)), size.shape)
        entry = QUANTITIES[str(size.attrs["quantity"])]
        shown = Column("", entry.name).cell(float(size[row, column]))
        kind = {"amplitude": "torque", "twist_amplitude": "twist"}.get(name, name)
        at = [float(inside.speed[column]), float(inside.mean_torque[row])]
        rows.append([kind, inside.attrs[place], shown, entry.shown, *at])
    return Table(f"{title}: largest stable sub-harmonic vibration within full load", columns, rows)


def _by_torque(inside: xr.Dataset, data: xr.Dataset, title: str) -> Table:
    columns = [Column("mean torque", "torque"), Column("from", "speed"), Column("to", "speed")]
    columns += [Column(f"torque of {data.attrs['element']} 0-peak", "torque"), Column("at", "speed")]
    columns += [
        Column(f"acceleration of {data.attrs['node']} 0-peak", "acceleration"),
        Column("several stable motions"),
    ]
    return Table(f"{title}: speeds with sub-harmonic vibration at each mean torque", columns, list(_rows(inside)))


def _rows(inside: xr.Dataset) -> Iterator[list[object]]:
    """One row for each run of neighbouring speeds at each torque."""
    for row, torque in enumerate(inside.mean_torque.values):
        for columns, low, high in stretches(inside, row):
            here = inside.isel(mean_torque=row, speed=columns)
            size, several = here.amplitude, "yes" if bool((here.stable_solutions > 1).any()) else ""
            at = int(np.argmax(size.values))
            largest = [float(size[at]), float(here.speed[at]), float(here.acceleration.max())]
            yield [float(torque), low, high, *largest, several]


def _picture(data: xr.Dataset, model: Model, title: str) -> Figure:
    from torsional.plots import panels, plot_region
    from torsional.plots.style import figure_of

    curve = full_load_curve(model, float(data.speed[0]), float(data.speed[-1]))
    drawn = panels(1, 2, (7.0, 4.8))
    for axes, shown in zip(drawn, ("amplitude", "acceleration"), strict=True):
        plot_region(data, shown, full_load=curve, title=title, axes=axes)
    return figure_of(drawn[0])
