"""Spectra of measured signals over frequency along a run-up."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.measurements.signals import is_even, named, raster, refuse_other
from torsional.numerics.arrays import Array
from torsional.results import dataset
from torsional.units import QUANTITIES

WINDOWS = 120
"""Spectra along a record, where no overlap is given."""


@checked
def speed_spectrogram(
    signal: xr.DataArray, rotation: xr.Dataset, resolution: float, *, highest: float | None = None
) -> xr.Dataset:
    """Amplitude spectra of a ``signal`` over time along a run-up: what keeps its frequency is a line across speeds.

    Windows of Hann's shape last 1/``resolution`` [Hz] and follow each other so that 120 cover the record, overlapping
    as they must.  ``spectrum`` (speed, spectrum_frequency), 0-peak in the signal's unit, corrected for the window's
    mean of a half: a sine between two lines of the spectrum is told up to 15 % too small, and one whose frequency runs
    by more than a line within a window is smeared.  ``highest`` [Hz] cuts the spectra.  Attributes name the window, its
    amplitude correction and its noise bandwidth in lines.  A raster that is not even, such as that of teeth, is first
    brought to an even one.  Raises ModelError for a record shorter than a window.

    >>> import torsional as tv
    >>> t = np.arange(0.0, 4.0, 1e-3)
    >>> turning = tv.mean_rotation(tv.shaft_from_encoder(xr.DataArray(80 * t, {"time": t}, attrs={"units": "rad"})))
    >>> found = speed_spectrogram(xr.DataArray(0.2 * np.sin(2 * np.pi * 50 * t), {"time": t}), turning, 2.0)
    >>> round(float(found.spectrum.isel(speed=3).sel(spectrum_frequency=50.0)), 5)
    0.2
    """
    refuse_other(rotation, "crank_angle", "rotation", "mean_rotation")
    time, values = raster(signal)
    seen = (time >= float(rotation.time[0])) & (time <= float(rotation.time[-1]))
    step, values = _even(time[seen], values[seen])
    begin = float(time[seen][0]) if seen.any() else 0.0
    count = round(1.0 / (resolution * step)) if resolution > 0 else 0
    if not 16 <= count <= values.size:
        least = 1.0 / (step * values.size) if values.size else np.inf
        allowed = f"{least:.3g} to {1.0 / (16 * step):.3g} Hz"
        raise ModelError("no such window", where="resolution", found=f"{resolution:g} Hz", allowed=allowed)
    starts = np.unique(np.linspace(0, values.size - count, min(WINDOWS, values.size - count + 1)).astype(int))
    shape = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(count) / count)
    spectra = [np.fft.rfft(_without_trend(values[i : i + count]) * shape) for i in starts]
    size = np.asarray(np.abs(np.stack(spectra)) * (2.0 / shape.sum()), dtype=float)
    lines = np.asarray(np.fft.rfftfreq(count, step), dtype=float)
    kept = lines <= (lines[-1] if highest is None else highest)
    middle = begin + (starts + 0.5 * count) * step
    return _described(signal, size[:, kept], lines[kept], middle, rotation)


def _described(signal: xr.DataArray, size: Array, lines: Array, middle: Array, rotation: xr.Dataset) -> xr.Dataset:
    """The Dataset of spectra with the signal's own words."""
    quantity = str(signal.attrs.get("quantity", ""))
    known = quantity if quantity in QUANTITIES else ""
    speed = np.interp(middle, rotation.time.values, rotation.speed.values)
    data = dataset(
        {"spectrum": (("speed", "spectrum_frequency"), size, known)},
        {
            "speed": (speed, "speed"),
            "spectrum_frequency": (lines, "frequency"),
            "time": (middle, "time", "speed"),
        },
        {"spectrum": "amplitude spectrum of a signal"},
        analysis="spectrogram",
        channel=named(signal),
        window="hann",
        amplitude_correction=2.0,
        noise_bandwidth=1.5,
    )
    own = {key: signal.attrs[key] for key in ("units", "long_name") if key in signal.attrs}
    data.spectrum.attrs.update(own, amplitude="0-peak")
    return data


def _without_trend(values: Array) -> Array:
    """Values less their straight line: the window's flanks would carry a mean into the lowest lines."""
    x = np.linspace(-1.0, 1.0, values.size)
    return np.asarray(values - values.mean() - x * (x @ values) / (x @ x))


def _even(time: Array, values: Array) -> tuple[float, Array]:
    """The step of an even raster and the values on it."""
    if time.size < 2:
        return 1.0, values[:0]
    if is_even(time):
        return float((time[-1] - time[0]) / (time.size - 1)), values
    from scipy.interpolate import CubicSpline

    step = float(np.median(np.diff(time)))
    at = np.arange(time[0], time[-1], step)
    return step, np.asarray(CubicSpline(time, values)(at))
