"""What the command line tells of a measured run-up: sentences about its shafts, tables of its orders, columns."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr

from torsional.cli.documents import amount
from torsional.cli.tables import Column, Table
from torsional.measurements.orders import CONVENTIONS, in_convention
from torsional.measurements.shafts import IN_GAP, LOST
from torsional.plots.tracking import Convention, shown_factor
from torsional.report.run_up import Place, RunUp
from torsional.units import RPM, show

MOST_ROWS = 24


def sentences(run_up: RunUp) -> list[str]:
    """What was found of each shaft, and what was mended."""
    return [_about(name, shaft) for name, shaft in run_up.shafts.items()]


def _about(name: str, shaft: xr.Dataset) -> str:
    speed = shaft.angular_velocity.values
    span = f"{show(float(speed.min()), 'angular_velocity')} to {show(float(speed.max()), 'angular_velocity')}"
    told = [f"{name}: {shaft.attrs['source']}, {float(np.ptp(shaft.time.values)):.4g} s, {span}"]
    states = shaft.pulse.values
    counts = {"in gaps": (states == IN_GAP).sum(), "lost": (states == LOST).sum()}
    told += [f"{count} pulses {what} put in" for what, count in counts.items() if count]
    told += [f"{shaft.sizes['extra_pulse']} too many taken out"] if shaft.sizes["extra_pulse"] else []
    noise = float(np.median(shaft.speed_noise)) / RPM
    if noise > 5e-5 * float(np.median(speed)) / RPM:
        told.append(f"clock and counts make {noise:.2g} rpm of noise from tooth to tooth")
    return "; ".join(told) + "."


def mended(run_up: RunUp) -> dict[str, dict[str, object]]:
    """The same as numbers, for documents."""
    told: dict[str, dict[str, object]] = {}
    for name, shaft in run_up.shafts.items():
        counts = {state: int((shaft.pulse.values == state).sum()) for state in (IN_GAP, LOST)}
        noise = amount(float(np.median(shaft.speed_noise)), "angular_velocity")
        own = {"source": shaft.attrs["source"], "teeth": int(shaft.attrs["teeth"]), "speed_noise": noise}
        told[name] = {**own, **counts, "extra": shaft.sizes["extra_pulse"]}
    return told


def tables(run_up: RunUp) -> list[Table]:
    """A table for each shaft and each signal: every order at its largest."""
    return [_table(place, run_up.convention) for place in run_up.places()]


def _table(place: Place, convention: Convention) -> Table:
    sizes, factor = in_convention(place.orders, convention), shown_factor(place.orders)
    heads = [Column("order", "engine_order"), Column(f"largest, {convention}", "number"), Column("at", "speed")]
    heads += [Column("phase there [deg]", "number")]
    heard = place.noise if place.noise is not None and bool((place.noise > 0).any()) else None
    heads += [Column("noise floor there", "number")] if heard is not None else []
    rows = []
    for number, n in enumerate(sizes.order.values[:MOST_ROWS]):
        at = int(sizes.values[:, number].argmax())
        phase = float(np.degrees(np.angle(place.orders.values[at, number])))
        row = [float(n), float(sizes.values[at, number]) * factor, float(sizes.speed[at]), round(phase, 1)]
        if heard is not None:
            row.append(float(heard.values[at, number]) * CONVENTIONS[convention] * factor)
        rows.append(row)
    more = sizes.sizes["order"] - MOST_ROWS
    return Table(place.title + (f"; {more} more orders are for files" if more > 0 else ""), heads, rows)


def columns(run_up: RunUp) -> xr.Dataset:
    """Sizes by the convention asked for and phases, a column each: what spreadsheets want."""
    return xr.Dataset({name: values for place in run_up.places() for name, values in _columns(place, run_up)})


def _columns(place: Place, run_up: RunUp) -> Iterator[tuple[str, xr.DataArray]]:
    sizes = in_convention(place.orders, run_up.convention)
    yield f"{place.name}, {run_up.convention}", sizes.drop_vars("node", errors="ignore")
    phase = xr.DataArray(np.degrees(np.angle(place.orders.values)), place.orders.coords, place.orders.dims)
    yield f"{place.name}, phase", phase.drop_vars("node", errors="ignore").assign_attrs(units="deg")
