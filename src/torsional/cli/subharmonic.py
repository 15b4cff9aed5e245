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
from torsional.solvers.periodic import subharmonic_map
from torsional.studies.region import stretches
from torsional.units import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS, TORQUES = 71, 26
MARGIN = 0.15
"""Room around a region that is looked at more closely, in shares of its size."""


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    points: int | None,
    node: str,
    element: str,
) -> None:
    """Answer the command."""
    machine = request.model
    engaged = inputs.one_gear(machine, gear)
    speeds = _several(inputs.speeds(machine, speed, points or SPEEDS), "--speed")
    torques = _several(inputs.torques(machine, torque, points or TORQUES), "--torque")
    laws_of(machine, engaged)
    if node or element:
        chosen_places(machine, engaged, [node] if node else None, [element] if element else None)
    inputs.affordable(len(speeds) * len(torques), 16)

    def mapped(speeds: Array, torques: Array) -> xr.Dataset:
        with progress("mean torques", request.quiet or request.as_json) as moved:
            found = subharmonic_map(
                machine, speeds, torques, engaged or None, element=element, node=node, progress=moved
            )
        return found.assign(within_full_load=(("torque", "speed"), within_full_load(machine, speeds, torques)))

    data = mapped(speeds, torques)
    closer = region_in(data) if not (speed or torque) else None
    if closer is not None:
        data = mapped(*closer)
    settings = {"gear": engaged, "element": data.attrs["element"], "node": data.attrs["node"]}
    document = told_settings(request, **settings, order=data.attrs["order"])
    title = f"Order {float(data.attrs['order']):g}{in_gear(engaged)}"
    answer = Answer("subharmonic", tables(data, title), document, data, picture=lambda: _picture(data, machine, title))
    deliver(answer, request)


def region_in(data: xr.Dataset) -> tuple[Array, Array] | None:
    """Round speeds and mean torques over what a map has found and a margin around it; None where that is nothing."""
    axes = []
    for dim, other, unit in (("speed", "torque", np.pi / 30), ("torque", "speed", 1.0)):
        values = data[dim].values
        here = np.append(values[(data.amplitude > 0).any(other).values], data[f"boundary_{dim}"].values)
        if not here.size:
            return None
        margin = MARGIN * float(np.ptp(here)) or float(values[1] - values[0])
        low, high = max(here.min() - margin, values[0]), min(here.max() + margin, values[-1])
        axes.append(unit * round_steps(low / unit, high / unit, len(values)))
    return axes[0], axes[1]


def round_steps(low: float, high: float, count: int) -> Array:
    """About ``count`` values within two, in steps of 1, 2, 2.5 or 5 times a power of ten; the ends if those are few.

    >>> round_steps(847.0, 1412.0, 30).tolist()[:3]
    [850.0, 875.0, 900.0]
    """
    wanted = (high - low) / max(count - 1, 1)
    power = 10.0 ** np.floor(np.log10(wanted))
    step = min((f * power for f in (1, 2, 2.5, 5, 10)), key=lambda width: abs(np.log(width / wanted)))
    values = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
    return values if len(values) > 1 else np.array([low, high])


def _several(values: Array, option: str) -> Array:
    """At least two values, so that there is a region to look at."""
    if len(values) < 2:
        remedy = "write a range, as 600:1200rpm, or ask `torsional periodic` at one of them"
        raise ModelError("a region needs a range", where=option, remedy=remedy)
    return values


def within_full_load(model: Model, speeds: Array, torques: Array) -> Array:
    """Which cells (torque, speed) the engine can reach; all of them without a full-load curve."""
    if model.engine is None or model.engine.full_load is None:
        return np.ones((len(torques), len(speeds)), dtype=bool)
    return np.asarray(torques[:, None] <= model.engine.full_load(speeds) * (1 + 1e-9))


def tables(data: xr.Dataset, title: str) -> list[Table]:
    """The region within full load: its extent and largest amplitudes, then torque by torque."""
    over = [name for name, values in data.data_vars.items() if {"torque", "speed"} <= set(values.dims)]
    inside = data.assign({name: data[name].where(data.within_full_load, 0) for name in over})
    if not bool((inside.amplitude > 0).any()):
        return [_nothing(data, title)]
    return [_summary(inside, title), _by_torque(inside, data, title)]


def _nothing(data: xr.Dataset, title: str) -> Table:
    above = bool((data.amplitude > 0).any())
    told = "none within full load, though there is some above it" if above else "none found"
    rows = [["stable motion of this order", told], ["grid", _grid(data)]]
    return Table(f"{title}: no sub-harmonic vibration", [Column("what"), Column("value")], rows)


def _grid(data: xr.Dataset) -> str:
    return " × ".join(f"{data.sizes[dim]} {dim}s" for dim in ("torque", "speed"))


def _summary(inside: xr.Dataset, title: str) -> Table:
    columns = [Column("largest"), Column("of"), Column("0-peak"), Column("speed", "speed"), Column("torque", "torque")]
    columns.insert(3, Column("unit"))
    rows = []
    for name, place in (("amplitude", "element"), ("twist_amplitude", "element"), ("acceleration", "node")):
        size = inside[name].transpose("torque", "speed")
        row, column = np.unravel_index(int(np.argmax(size.values)), size.shape)
        entry = QUANTITIES[str(size.attrs["quantity"])]
        shown = Column("", entry.name).cell(float(size[row, column]))
        kind = {"amplitude": "torque", "twist_amplitude": "twist"}.get(name, name)
        at = [float(inside.speed[column]), float(inside.torque[row])]
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
    for row, torque in enumerate(inside.torque.values):
        for columns, low, high in stretches(inside, row):
            here = inside.isel(torque=row, speed=columns)
            size, several = here.amplitude, "yes" if bool((here.stable_solutions > 1).any()) else ""
            at = int(np.argmax(size.values))
            largest = [float(size[at]), float(here.speed[at]), float(here.acceleration.max())]
            yield [float(torque), low, high, *largest, several]


def _picture(data: xr.Dataset, model: Model, title: str) -> Figure:
    from torsional.plots import panels, plot_region
    from torsional.plots.style import figure_of

    drawn = panels(1, 2, (7.0, 4.8))
    for axes, shown in zip(drawn, ("amplitude", "acceleration"), strict=True):
        plot_region(data, shown, full_load=_full_load(data, model), title=title, axes=axes)
    return figure_of(drawn[0])


def _full_load(data: xr.Dataset, model: Model) -> xr.DataArray | None:
    """The full-load curve over the speeds of the map."""
    if model.engine is None or model.engine.full_load is None:
        return None
    curve = model.engine.full_load
    low, high = float(data.speed[0]), float(data.speed[-1])
    speeds = np.unique([*np.linspace(low, high, 200), *(s for s in curve.speeds if low < s < high)])
    told = {"quantity": "torque"}
    return xr.DataArray(curve(speeds), {"speed": ("speed", speeds, {"quantity": "speed"})}, "speed", attrs=told)
