"""MDF 4.10 through asammdf: a group of channels for each raster, and for each group that a channel had."""

from __future__ import annotations

import contextlib
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.formats import library
from torsional.measurements.recording import PULSES

VERSION = "4.10"


def write(data: xr.Dataset, path: Path) -> None:
    """Write every channel with its unit and comment; ModelError for channels over anything but time."""
    asammdf = library("asammdf", "MDF")
    groups: dict[tuple[str, str], list[str]] = {}
    for name, values in data.data_vars.items():
        dim = str(values.dims[0])
        if dim.rstrip("0123456789").rstrip("_") != "time":
            remedy = "write .uff, .mat, .parquet or .csv"
            raise ModelError("MDF takes signals over time", where=repr(str(name)), found=f"over {dim}", remedy=remedy)
        groups.setdefault((dim, str(values.attrs.get("group", ""))), []).append(str(name))
    with asammdf.MDF(version=VERSION) as file:
        with contextlib.suppress(ValueError, KeyError):
            file.header.start_time = datetime.fromisoformat(str(data.attrs["start"]))
        for (_, group), names in groups.items():
            signals = [signal for name in names for signal in _signals(asammdf, data[name], name)]
            file.append(signals, acq_name=group or None, comment="", common_timebase=True)
        file.save(path, overwrite=True)


def _signals(asammdf: Any, values: xr.DataArray, name: str) -> list[Any]:
    """A signal; of complex values the real and the imaginary part."""
    numbers, parts = values.values, [("", values.values)]
    if np.iscomplexobj(numbers):
        parts = [(" real", numbers.real), (" imaginary", numbers.imag)]
    times = np.asarray(values[values.dims[0]].values, dtype=float)
    comment = PULSES if values.attrs.get("kind") == PULSES else str(values.attrs.get("comment", ""))
    told = {"unit": str(values.attrs.get("units", "")), "comment": comment}
    return [
        asammdf.Signal(np.ascontiguousarray(part, dtype=float), times, name=f"{name}{what}", **told)
        for what, part in parts
    ]
