"""Tables of a measurement, in text or Parquet: columns of time, each with the columns of the channels behind it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.recording import PULSES, Channel, Raster, pulses
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import quoted, unit_factor

_TIME = re.compile(r"(time|zeit|t|timestamps?)(?:_\d+| \d+| of .+)?", re.IGNORECASE)
_OF_EVENTS = "time of "
_AXIS = re.compile(r"(speed|frequency|order|crank_angle|angle)(?:_\d+)?")
LEFT = "a column named 'time [s]'"


@dataclass(frozen=True, eq=False)
class Column:
    """One column: name, unit as written, values with NaN where there are none, and further attributes."""

    name: str
    units: str
    values: Array
    group: str = ""
    comment: str = ""
    kind: str = ""


def is_time(name: str) -> bool:
    """Whether a column or vector by this name holds times.

    >>> is_time("Time_2"), is_time("torque")
    (True, False)
    """
    return bool(_TIME.fullmatch(name.strip()))


def seconds(values: Array, unit: str, where: str) -> Array:
    """Times in seconds from a unit of time; none written means seconds."""
    factor = unit_factor(unit, "time") if unit and unit != "-" else 1.0
    if factor is None:
        told = {"where": where, "found": quoted(unit), "allowed": "s, ms, min, h"}
        raise ModelError("this is no unit of time", **told)
    return values if factor == 1.0 else values * factor


def channels_of(columns: Sequence[Column]) -> list[Channel]:
    """The channels of a table: those behind a column of time belong to it, those before the first one as well.

    Without any time the first column must be an axis by a name that results have (speed, frequency).  Rows that have
    neither a time nor a value end a column that is shorter than others.
    """
    at = [i for i, column in enumerate(columns) if is_time(column.name)]
    if not at:
        return _over_axis(columns)
    owners = [max((j for j in at if j < i), default=at[0]) for i in range(len(columns))]
    channels: list[Channel] = []
    for j in at:
        held = [columns[i] for i in range(len(columns)) if i not in at and owners[i] == j]
        channels += _over_time(columns[j], held)
    return channels


def _over_axis(columns: Sequence[Column]) -> list[Channel]:
    first = columns[0]
    if len(columns) < 2 or not _AXIS.fullmatch(first.name):
        names = ", ".join(quoted(column.name) for column in columns[:8])
        raise ModelError("no column holds the time", found=names, remedy=f"name {LEFT}")
    raster = Raster(first.values, first.name, first.units)
    return [Channel(column.name, column.values, raster, column.units) for column in columns[1:]]


def _over_time(time: Column, held: Sequence[Column]) -> Iterator[Channel]:
    """The channels over one column of time; the times themselves where there are none: events."""
    where = f"column {quoted(time.name)}"
    ends = np.flatnonzero(~np.isnan([time.values, *(column.values for column in held)]).all(axis=0))
    count = int(ends[-1]) + 1 if ends.size else 0
    raster = Raster(seconds(time.values[:count], time.units, where))
    if not held:
        yield pulses(time.name.removeprefix(_OF_EVENTS), raster.values, time.group, time.comment)
    for column in held:
        attrs: dict[str, str | float] = {"kind": column.kind} if column.kind else {}
        told = {"units": column.units, "group": column.group, "comment": column.comment}
        yield Channel(column.name, column.values[:count], raster, **told, attrs=attrs)


def table_of(data: xr.Dataset) -> list[Column]:
    """The columns that a measurement is written as: each raster, then its channels, shorter ones filled up with NaN.

    Complex channels take two columns; the times of events stand in the column of their raster alone.
    """
    longest = max(data.sizes.values(), default=0)
    columns = []
    for dim in data.dims:
        held = {str(name): values for name, values in data.data_vars.items() if values.dims == (dim,)}
        alone = next((name for name, values in held.items() if events_alone(held, values)), "")
        axis, title = data[dim], f"{_OF_EVENTS}{alone}" if alone else str(dim)
        notes = _notes(held[alone]) if alone else {}
        columns.append(Column(title, axis.attrs.get("units", ""), _filled(axis.values, longest), **notes))
        for name, values in held.items():
            columns += [] if alone else _columns(name, values, longest)
    return columns


def events_alone(held: Mapping[str, xr.DataArray], values: xr.DataArray) -> bool:
    """Whether a channel, of those ``held`` by one raster, is the times of events that no other one shares."""
    return values.attrs.get("kind") == PULSES and len(held) == 1


def _columns(name: str, values: xr.DataArray, count: int) -> Iterator[Column]:
    told = {**_notes(values), "kind": str(values.attrs.get("kind", ""))}
    unit, numbers = str(values.attrs.get("units", "")), values.values
    if not np.iscomplexobj(numbers):
        yield Column(name, unit, _filled(numbers, count), **told)
        return
    yield Column(f"{name} real", unit, _filled(numbers.real, count), **told)
    yield Column(f"{name} imaginary", unit, _filled(numbers.imag, count), **told)


def _notes(values: xr.DataArray) -> dict[str, str]:
    return {key: str(values.attrs.get(key, "")) for key in ("group", "comment")}


def _filled(values: Array | ComplexArray, count: int) -> Array:
    filled = np.full(count, np.nan)
    filled[: values.size] = values
    return filled
