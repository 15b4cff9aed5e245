"""Functions in universal files (dataset 58b): heads of text, values as numbers of eight bytes.

Even rasters are told by start and step where the few digits of the format's head say them exactly; all others are
written value by value.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.uff import AXES
from torsional.measurements.uff_head import exact_step
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import RPM, quoted

TIME_RESPONSE, SPECTRUM = 1, 12
_NEAR = 1e-9
"""By what share of a step a raster may stand off the one that its head tells."""
_KINDS = {word: number for number, word in AXES.items()}


def write(data: xr.Dataset, path: Path) -> None:
    """Write every channel as one function."""
    with path.open("wb") as file:
        for name, values in data.data_vars.items():
            file.writelines(_function(str(name), values, str(data.attrs.get("start", ""))))


def _function(name: str, values: xr.DataArray, start: str) -> Iterator[bytes]:
    dim = str(values.dims[0])
    kind = _KINDS.get(dim.rstrip("0123456789").rstrip("_"), 0)
    axis, units = np.asarray(values[dim].values, dtype=float), str(values[dim].attrs.get("units", ""))
    if _KINDS.get("speed") == kind and units == "rad/s":  # the format's own unit of a speed
        axis, units = axis / RPM, "rpm"
    first, step = _told_evenly(axis)
    numbers = values.values
    body = _body(axis, numbers, even=step > 0)
    yield f"    -1\n    58b{1:6d}{2:6d}{11:12d}{len(body):12d}{0:6d}{0:6d}{0:12d}{0:12d}\n".encode()
    titles = (name, str(values.attrs.get("comment", "")), start, "", str(values.attrs.get("kind", "")))
    yield "".join(f"{_line(text, 80):<80}\n" for text in titles).encode()
    function = TIME_RESPONSE if dim.startswith("time") else SPECTRUM
    group = _line(str(values.attrs.get("group", "")), 10)
    yield f"{function:5d}{0:10d}{0:5d}{0:10d} {group:<10}{0:10d}{0:4d} {'NONE':<10}{0:10d}{0:4d}\n".encode()
    order = float(values.attrs.get("order", 0.0))
    form = f"{6 if np.iscomplexobj(numbers) else 4:10d}{numbers.size:10d}{int(step > 0):10d}"
    yield f"{form}{first if step > 0 else 0.0:13.5e}{step:13.6e}{order:13.5e}\n".encode()
    label = _line(str(values.attrs.get("long_name", name)), 20)
    for number, text, unit in ((kind, dim, units), (0, label, _unit(values)), (0, "", "")):
        yield f"{number:10d}{0:5d}{0:5d}{0:5d} {_line(text, 20):<20} {_line(unit, 20):<20}\n".encode()
    ends = (_KINDS["order"], "order", "-") if order else (0, "", "")
    yield f"{ends[0]:10d}{0:5d}{0:5d}{0:5d} {_line(ends[1], 20):<20} {_line(ends[2], 20):<20}\n".encode()
    yield body
    yield b"    -1\n"


def _unit(values: xr.DataArray) -> str:
    unit = str(values.attrs.get("units", ""))
    if len(unit) > 20:
        told = {"found": quoted(unit), "allowed": "20 letters"}
        raise ModelError("a universal file has no place for a unit this long", where=quoted(str(values.name)), **told)
    return unit


def _line(text: str, length: int) -> str:
    """A text in its place, cut where it is too long; nothing is called NONE."""
    return text[:length].rstrip() or "NONE"


def _told_evenly(axis: Array) -> tuple[float, float]:
    """Start and step as the head tells them, or a step of zero where it cannot."""
    if axis.size < 2:
        return 0.0, 0.0
    text = f"{(axis[-1] - axis[0]) / (axis.size - 1):13.6e}"
    first, step = float(f"{axis[0]:13.5e}"), exact_step(text)
    off = np.abs(axis - (first + step * np.arange(axis.size))).max()
    return (first, float(text)) if step > 0 and off <= _NEAR * step else (0.0, 0.0)


def _body(axis: Array, numbers: Array | ComplexArray, even: bool) -> bytes:
    parts = [numbers.real, numbers.imag] if np.iscomplexobj(numbers) else [numbers]
    columns = parts if even else [axis, *parts]
    return np.column_stack(columns).astype("<f8").tobytes()
