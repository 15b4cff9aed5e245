"""Pulse times out of a sampled tacho voltage, and the tick of the clock that pulse times were counted by."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.measurements.signals import named, raster
from torsional.numerics.arrays import Array

HYSTERESIS = 0.3
"""Of the span between the 2nd and the 98th percentile of a voltage, where none is given."""
STEEP = 0.7
"""An edge that goes through this share of the span between two samples has its time within the sample, no closer."""


@checked
def pulse_times(
    voltage: xr.DataArray, *, level: float | None = None, hysteresis: float | None = None, falling: bool = False
) -> xr.DataArray:
    """Times [s] at which a sampled tacho ``voltage`` rises (or is ``falling``) through a ``level``.

    A pulse counts where the voltage comes from below level − hysteresis/2 to above level + hysteresis/2, so that noise
    about the level makes none; its time lies on the straight line between the samples beside the level, or in the
    middle of several crossings.  The level is half-way between the 2nd and the 98th percentile, the hysteresis 30 % of
    their distance, unless given.  Attribute ``resolution`` [s]: the step of samples where edges are steeper than one,
    else 0.  Raises ModelError for a voltage that does not change, and where there are fewer than two pulses.

    >>> t = np.arange(0.0, 1.0, 1e-3)
    >>> sine = xr.DataArray(np.sin(2 * np.pi * 5 * t - 0.5), {"time": t}, name="tacho")
    >>> pulse_times(sine).values.round(5).tolist()  # 0.5/(10π) s behind every fifth of a second
    [0.01592, 0.21592, 0.41592, 0.61592, 0.81592]
    """
    time, values = raster(voltage)
    low, high = _span(values)
    if not high > low:
        found = f"{low:g} throughout" if values.size else "no samples"
        raise ModelError("the voltage does not change: there are no pulses", where=named(voltage), found=found)
    middle = 0.5 * (low + high) if level is None else level
    band = HYSTERESIS * (high - low) if hysteresis is None else hysteresis
    _refuse(voltage, middle, band, low, high)
    sign = -1.0 if falling else 1.0
    at, steep = _crossings(time, sign * (values - middle), 0.5 * band, STEEP * (high - low))
    if at.size < 2:
        remedy = "another level, or less hysteresis"
        told = f"{at.size} through {middle:g}, voltages from {values.min():g} to {values.max():g}"
        raise ModelError("there are no two pulses", where=named(voltage), found=told, remedy=remedy)
    resolution = float(np.median(np.diff(time))) if 2 * steep > at.size else 0.0
    attrs = {"units": "s", "long_name": "pulse times", "resolution": resolution}
    return xr.DataArray(at, dims="pulse", name=voltage.name, attrs=attrs)


def _span(values: Array) -> tuple[float, float]:
    """Between which voltages most of a record is, or all of it where pulses are needles."""
    for share in (2.0, 0.0):
        low, high = np.percentile(values, [share, 100 - share]) if values.size else (0.0, 0.0)
        if high > low:
            break
    return float(low), float(high)


def _refuse(voltage: xr.DataArray, level: float, band: float, low: float, high: float) -> None:
    where = named(voltage)
    if band < 0:
        raise ModelError("the hysteresis must not be negative", where=where, found=f"{band:g}")
    values = voltage.values
    if not values.min() < level < values.max():
        allowed = f"between {values.min():g} and {values.max():g}"
        raise ModelError("the level is beyond the voltage", where=where, found=f"{level:g}", allowed=allowed)


def _crossings(time: Array, values: Array, half: float, steep: float) -> tuple[Array, int]:
    """Times of rises through zero from below −half to above half, and how many of them go up by ``steep`` at once."""
    state = np.where(values > half, 1, np.where(values < -half, -1, 0)).astype(np.int8)
    told = np.flatnonzero(state)
    rises = np.flatnonzero((state[told][1:] == 1) & (state[told][:-1] == -1))
    if not rises.size:
        return np.empty(0), 0
    below, above = told[rises], told[rises + 1]
    crossing = np.flatnonzero((values[:-1] <= 0) & (values[1:] > 0))
    first, last = (crossing[np.searchsorted(crossing, ends) - off] for ends, off in ((below, 0), (above, 1)))
    at = 0.5 * (_between(time, values, first) + _between(time, values, last))
    return at, int((values[above] - values[above - 1] > steep).sum())


def _between(time: Array, values: Array, index: NDArray[np.int64]) -> Array:
    """Where the straight line from a sample to the next passes zero."""
    share = -values[index] / (values[index + 1] - values[index])
    return np.asarray(time[index] + share * (time[index + 1] - time[index]))


def clock_tick(times: Array) -> float:
    """The tick [s] of the clock that pulse times were counted by: the smallest step between lengths of intervals.

    Times that no clock has rounded have steps next to nothing; 0 where all intervals are equal.

    >>> clock_tick(np.round(np.cumsum(np.linspace(1.0, 2.0, 400)), 3)).__round__(9)
    0.001
    """
    lengths = np.unique(np.diff(times))
    steps = np.diff(lengths)
    noise = 8 * np.finfo(float).eps * float(np.abs(times).max(initial=0.0))
    steps = steps[steps > noise]
    return float(steps.min()) if steps.size else 0.0
