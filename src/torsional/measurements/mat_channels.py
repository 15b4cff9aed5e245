"""Variables of a MATLAB file as channels: vectors with their times, fields of structures, columns of matrices.

A file of any toolbox comes as a tree: {name: array, text, or the same of a structure}.  What `torsional` writes has
structures ``units``, ``names`` and ``rasters`` beside the vectors, by their names.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.measurements.columns import is_time, seconds
from torsional.measurements.recording import PULSES, Channel, Found, Raster
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import quoted

Tree = Mapping[str, Any]
UNITS, NAMES, RASTERS, START, EVENTS = "units", "names", "rasters", "start", "events"
_NOTES = (UNITS, NAMES, RASTERS, EVENTS)
_STEPS = ("dt", "ts", "delta_t", "increment", "sampling_time", "sample_time")
_RATES = ("fs", "rate", "sampling_rate", "sample_rate", "samplerate", "frequency_sampling")
DEPTH = 6


@dataclass
class _Vectors:
    """Vectors of one structure: of times, of values; its single numbers; and what is none of them."""

    group: str
    times: dict[str, Array] = field(default_factory=dict)
    values: dict[str, Any] = field(default_factory=dict)
    scalars: dict[str, float] = field(default_factory=dict)
    others: list[str] = field(default_factory=list)


def found_in(tree: Tree, words: str) -> Found:
    """The channels of a tree; ModelError for a vector that no vector of time is as long as."""
    notes = {key: tree[key] for key in _NOTES if isinstance(tree.get(key), Mapping)}
    start = tree.get(START) if isinstance(tree.get(START), str) and notes else ""
    rest = {key: value for key, value in tree.items() if key not in notes and not (start and key == START)}
    groups = list(_groups(rest, "", 0, notes))
    channels = [channel for group in groups for channel in _channels(group, groups[0], notes)]
    channels += _recorded(tree, "", 0)
    return Found(channels, words, start or "", [name for group in groups for name in group.others])


def _groups(tree: Tree, group: str, depth: int, notes: Tree) -> Iterator[_Vectors]:
    """The vectors of a structure and of those within it."""
    if depth > DEPTH:
        raise ModelError("structures are nested too deeply", where=quoted(group), allowed=f"{DEPTH} levels")
    own = _Vectors(group)
    axes = set(notes.get(RASTERS, {}).values())
    inner = []
    for name, value in tree.items():
        if isinstance(value, Mapping):
            inner += [] if _is_recorded(value) else [(name, value)]
        elif not isinstance(value, np.ndarray) or value.dtype.kind not in "biufc" or value.ndim > 2 or not value.size:
            own.others += [f"{group}.{name}" if group else name]
        elif value.size == 1 and name not in notes.get(RASTERS, {}) and name not in axes:
            own.scalars[name.lower()] = float(value.real.ravel()[0])
        elif (is_time(name) or name in axes) and 1 in (*value.shape, value.ndim):
            own.times[name] = np.asarray(value.ravel(), dtype=float)
        else:
            own.values |= _vectors(name, value)
    yield own
    for name, value in inner:
        yield from _groups(value, f"{group}.{name}" if group else name, depth + 1, {})


def _vectors(name: str, value: Any) -> dict[str, Any]:
    """A vector by its name, or the longer columns or rows of a matrix by their numbers."""
    if value.ndim < 2 or 1 in value.shape:
        return {name: value.ravel()}
    columns = value.T if value.shape[0] >= value.shape[1] else value
    return {f"{name}[{number}]": column for number, column in enumerate(columns, 1)}


def _channels(own: _Vectors, top: _Vectors, notes: Tree) -> Iterator[Channel]:
    """The channels of a structure, each over the times that are named for it, or that are as long as it is."""
    units, names, rasters = (notes.get(key, {}) if own is top else {} for key in (UNITS, NAMES, RASTERS))
    _take_first_column(own, top)
    for name, values in own.values.items():
        raster = rasters.get(name)
        times = top.times.get(raster) if isinstance(raster, str) else _times(name, values.size, own, top)
        if times is None:
            raise _timeless(name, values.size, own, top)
        axis = _axis(raster, times, units)
        told = {"units": _text(units.get(name)), "group": own.group}
        attrs: dict[str, str | float] = {"kind": PULSES} if name in notes.get(EVENTS, {}) else {}
        yield Channel(_text(names.get(name)) or name, _double(values), axis, **told, attrs=attrs)


def _double(values: Any) -> Array | ComplexArray:
    return values.astype(np.complex128) if np.iscomplexobj(values) else values.astype(np.float64)  # type: ignore[no-any-return]


def _axis(raster: object, times: Array, units: Tree) -> Raster:
    if not isinstance(raster, str) or is_time(raster):
        return Raster(seconds(times, _text(units.get(str(raster))), str(raster)))
    return Raster(times, raster.rstrip("0123456789").rstrip("_"), _text(units.get(raster)))


def _text(value: object) -> str:
    return value if isinstance(value, str) else ""


def _take_first_column(own: _Vectors, top: _Vectors) -> None:
    """A matrix without times beside it has them in its first column."""
    if own.times or top.times or any(key in own.scalars or key in top.scalars for key in (*_STEPS, *_RATES)):
        return
    for name in [name for name in own.values if name.endswith("[1]")]:
        values = own.values[name]
        if np.isrealobj(values) and values.size > 1 and (np.diff(values) > 0).all():
            own.times[name] = own.values.pop(name).astype(float)


def _times(name: str, count: int, own: _Vectors, top: _Vectors) -> Array | None:
    known = {**top.times, **own.times}
    named = [f"{name}_time", f"time_{name}", f"t_{name}", f"{name}_t"]
    several = [known[key] for key in [*named, *own.times, *top.times] if key in known and known[key].size == count]
    if several:
        return several[0]
    for scalars in (own.scalars, top.scalars):
        for key, value in scalars.items():
            if key in (*_STEPS, *_RATES) and value > 0:
                return np.asarray(np.arange(count) * (value if key in _STEPS else 1.0 / value))
    return None


def _timeless(name: str, count: int, own: _Vectors, top: _Vectors) -> ModelError:
    lengths = sorted({times.size for times in (*own.times.values(), *top.times.values())})
    found = (
        f"{count} values; times of length {', '.join(map(str, lengths))}" if lengths else f"{count} values, no times"
    )
    where = quoted(f"{own.group}.{name}" if own.group else name)
    remedy = "add a vector 'time' that is as long, or the rate 'fs' in Hz"
    raise ModelError("no times belong to the channel", where=where, found=found, remedy=remedy)


# --- records of Simcenter Testlab: x_values and y_values ---


def _is_recorded(value: Tree) -> bool:
    x, y = value.get("x_values"), value.get("y_values")
    return isinstance(x, Mapping) and isinstance(y, Mapping) and "increment" in x and "values" in y


def _recorded(tree: Tree, group: str, depth: int) -> Iterator[Channel]:
    for name, value in tree.items():
        if isinstance(value, Mapping) and _is_recorded(value):
            yield _record(name, value, group)
        elif isinstance(value, Mapping) and depth < DEPTH:
            yield from _recorded(value, f"{group}.{name}" if group else name, depth + 1)


def _record(name: str, value: Tree, group: str) -> Channel:
    x, y = value["x_values"], value["y_values"]
    start, step = (_number(x.get(key, np.zeros(1)), f"{name}.x_values.{key}") for key in ("start_value", "increment"))
    values = y["values"]
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "biufc" or values.size != max(values.shape):
        raise ModelError("a vector of numbers is wanted", where=f"{name}.y_values.values")
    axis = np.asarray(start + step * np.arange(values.size))
    label = _text(_inside(x, "quantity").get("label")) or "s"
    raster = Raster(axis) if label == "s" else Raster(axis, "frequency" if label == "Hz" else "abscissa", label)
    units = _text(_inside(y, "quantity").get("label"))
    title = _text(_inside(value, "function_record").get("name")) or name
    return Channel(title, _double(values.ravel()), raster, units, group)


def _inside(tree: Tree, key: str) -> Tree:
    found = tree.get(key)
    return found if isinstance(found, Mapping) else {}


def _number(value: object, where: str) -> float:
    if not isinstance(value, np.ndarray) or value.size != 1 or value.dtype.kind not in "biuf":
        raise ModelError("a number is wanted", where=where)
    return float(value.ravel()[0])
