"""A recorded channel as two plain arrays, times and values, refused in words where it is none."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.recording import sampling
from torsional.numerics.arrays import Array
from torsional.units import QUANTITIES, quoted, unit_factor


def named(signal: xr.DataArray) -> str:
    """What the user calls a channel."""
    return str(signal.name) if signal.name is not None else "signal"


def raster(signal: xr.DataArray) -> tuple[Array, Array]:
    """Times [s] and values of a channel over one dimension, both finite, times rising; ModelError for any other."""
    if signal.ndim != 1 or signal.dims[0] not in signal.coords:
        found = f"dimensions ({', '.join(map(str, signal.dims))})"
        raise ModelError("a channel has values over one raster of times", where=named(signal), found=found)
    time = np.asarray(signal[signal.dims[0]].values, dtype=float)
    values = np.asarray(signal.values, dtype=float)
    refuse_times(time, named(signal))
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        told = f"{wrong.size} of {values.size} values, the first at {time[wrong[0]]:.6g} s"
        raise ModelError("the channel has values that are no numbers", where=named(signal), found=told)
    return time, values


def refuse_times(time: Array, name: str) -> None:
    """ModelError unless times are finite and rise from one to the next."""
    if not np.isfinite(time).all():
        raise ModelError("times that are no numbers", where=name, found=f"{int((~np.isfinite(time)).sum())} of them")
    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        at = int(back[0])
        found = f"{time[at]:.9g} s followed by {time[at + 1]:.9g} s"
        raise ModelError("times must rise from one to the next", where=name, found=found, remedy="sort the record")


def is_even(time: Array) -> bool:
    """Whether times are on an even raster."""
    return sampling(time)["sampling"] == "even"


def factor(signal: xr.DataArray, quantity: str, unit: str | None) -> float:
    """The factor to SI of a channel: of the ``unit`` given, else of its own; ModelError for a unit of another kind."""
    written = str(signal.attrs.get("units", "")) if unit is None else unit
    kind = QUANTITIES[quantity].kind
    found = unit_factor(written, kind) if written.strip() else None
    if found is None:
        told = quoted(written) if written.strip() else "no unit"
        remedy = f"say which one, as unit={QUANTITIES[quantity].shown!r}"
        raise ModelError(f"the channel needs a unit of {kind}", where=named(signal), found=told, remedy=remedy)
    return found


def refuse_other(data: xr.Dataset, variable: str, argument: str, maker: str) -> None:
    """ModelError for a Dataset that is of another kind than a function wants, with what makes one."""
    if variable not in data.variables:
        told = {"found": str(data.attrs.get("analysis", "a Dataset without it")), "remedy": f"{maker} makes one"}
        raise ModelError(f"a Dataset with '{variable}' is wanted", where=argument, **told)
