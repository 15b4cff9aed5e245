"""Results of analyses as channels: a signal for each node or element, an order curve for each order."""

from __future__ import annotations

import itertools
from collections.abc import Hashable, Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.recording import ANALYSIS, Channel, Found, Raster, bounded, recording
from torsional.results import load_results

AXES = ("time", "crank_angle", "speed", "frequency")
"""Dimensions that channels run along, the first that a variable has."""
MOST = 20_000
"""Channels of one result."""


def read(path: Path) -> Found:
    """The channels of a result file."""
    return channels_of(load_results(path))


def as_measurement(data: xr.Dataset) -> xr.Dataset:
    """A result as a measurement, or the measurement that it is already."""
    plain = all(len(values.dims) == 1 and values.dtype.kind in "fc" for values in data.data_vars.values())
    if data.attrs.get("analysis") == ANALYSIS and plain and set(data.coords) <= set(data.dims):
        return data
    found = channels_of(data)
    return recording(found, str(data.attrs.get("model", data.attrs.get("source", ""))))


def channels_of(data: xr.Dataset) -> Found:
    """The channels of a result: its signals, and the coordinates that run along them; what lies over no axis is left
    out, such as the state at the end.  Raises ModelError for a result without any axis."""
    channels: list[Channel] = []
    left_out: list[str] = []
    for axis in AXES[1:]:  # a run-down has its speeds from the highest down
        data = data.sortby(axis) if axis in data.dims else data
    rasters = {axis: _raster(data, axis) for axis in AXES if axis in data.dims}
    if not rasters and data.attrs.get("analysis") != ANALYSIS:
        remedy = "results over time, crank angle, speed or frequency are written"
        raise ModelError("the result runs along no axis", found=", ".join(map(str, data.dims)), remedy=remedy)
    for name, values in {**data.data_vars, **_along(data)}.items():
        axis = _axis(values)
        if not axis or values.dtype.kind not in "biufc":
            left_out.append(str(name))
            continue
        _refuse_many(values, axis, str(name), len(channels))
        raster = rasters.setdefault(axis, _raster(data, axis))
        channels += _signals(str(name), values, axis, raster)
    return Found(channels, f"result: {data.attrs.get('analysis', 'of unknown kind')}", _start(data), left_out)


def _start(data: xr.Dataset) -> str:
    return str(data.attrs.get("start", ""))


def _along(data: xr.Dataset) -> dict[Hashable, xr.DataArray]:
    """Coordinates beside the dimensions that run along an axis, as the speed in a run-up does."""
    return {name: c for name, c in data.coords.items() if name not in data.dims and _axis(c)}


def _axis(values: xr.DataArray) -> str:
    """The dimension that a variable runs along; of a measurement's own rasters, ``time_2`` and so on, its only one."""
    named = next((axis for axis in AXES if axis in values.dims), "")
    if named or len(values.dims) != 1:
        return named
    own = str(values.dims[0])
    return own if _kind(own) in AXES or "sampling" in _attrs(values) else ""


def _kind(axis: str) -> str:
    """What a numbered axis is: ``time`` of ``time_2``."""
    return axis.rstrip("0123456789").rstrip("_")


def _attrs(values: xr.DataArray) -> dict[str, object]:
    dim = values.dims[0]
    return dict(values.coords[dim].attrs) if dim in values.coords else {}


def _raster(data: xr.Dataset, axis: str) -> Raster:
    values = np.asarray(data[axis].values, dtype=float)
    return Raster(values, _kind(axis), str(data[axis].attrs.get("units", "")))


def _refuse_many(values: xr.DataArray, axis: str, name: str, before: int) -> None:
    count = values.size // max(values.sizes[axis], 1)
    if before + count > MOST:
        remedy = "choose nodes, elements and orders with .sel(...) first"
        raise ModelError("the result has too many signals", where=name, allowed=f"at most {MOST}", remedy=remedy)
    bounded(values.size)


def _signals(name: str, values: xr.DataArray, axis: str, raster: Raster) -> Iterator[Channel]:
    """A channel for each place of a variable."""
    rest = [str(dim) for dim in values.dims if dim != axis]
    across = values.transpose(*rest, axis)
    told = {"units": _unit(values), "long_name": str(values.attrs.get("long_name", "")), "group": name if rest else ""}
    numbers = across.values.astype(complex if values.dtype.kind == "c" else float)
    for place in itertools.product(*(range(values.sizes[dim]) for dim in rest)):
        labels = {dim: _label(values, dim, i) for dim, i in zip(rest, place, strict=True)}
        words = [f"order {told}" if dim == "order" else told for dim, told in labels.items()]
        attrs = _attributes(values, labels)
        yield Channel(" ".join([name, *words]), numbers[place], raster, **told, attrs=attrs)


def _unit(values: xr.DataArray) -> str:
    return str(values.attrs.get("units", ""))


def _label(values: xr.DataArray, dim: str, number: int) -> str:
    if dim not in values.coords:
        return f"{dim} {number + 1}"
    label = values.coords[dim].values[number]
    return f"{label:g}" if isinstance(label, float | int | np.number) else str(label)


def _attributes(values: xr.DataArray, labels: dict[str, str]) -> dict[str, str | float]:
    told: dict[str, str | float] = {key: values.attrs[key] for key in ("quantity", "kind") if key in values.attrs}
    told |= {key: labels[key] for key in ("node", "element") if key in labels}
    return told | ({"order": float(labels["order"])} if "order" in labels else {})
