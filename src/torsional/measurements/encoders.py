"""Angle and speed of a shaft from counters, encoders and speeds that are sampled in time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.measurements.shafts import TURN, shaft_dataset
from torsional.measurements.signals import factor, named, raster
from torsional.numerics.arrays import Array

TURNS = "take a stretch in which it turns"
GROUPS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32)
"""Samples that are averaged where noise takes an angle back."""


@checked
def shaft_from_counter(counter: xr.DataArray, counts: int, *, bits: int | None = None) -> xr.Dataset:
    """Angle and speed of a shaft from a sampled ``counter`` (time) with so many ``counts`` a turn, as it wraps.

    ``bits``: 8, 16, 32 …, after which it begins anew; the fewest that hold its values unless given.  Where it seldom
    moves by more than one between samples, its steps are pulses half a sample before they are seen, to one sample; else
    each sample is an angle, to one count.  Dataset as of `shaft_from_pulses`.  Raises ModelError for a shaft that
    turns back, and for one so quick that wraps cannot be told from steps.

    >>> t = np.arange(0.0, 1.0, 1e-3)
    >>> count = xr.DataArray((1024 * 20.0 * t).astype(int) % 256, {"time": t}, name="encoder")
    >>> found = shaft_from_counter(count, 1024)  # 20 turns a second
    >>> float(found.shaft_angle[-1] - found.shaft_angle[0]).__round__(1) == round(2 * np.pi * 20 * 0.999, 1)
    True
    """
    time, values = raster(counter)
    where = named(counter)
    if counts < 1:
        raise ModelError("a turn has one count at least", where="counts", found=str(counts))
    if values.size < 3 or (values != np.round(values)).any() or values.min() < 0:
        raise ModelError("a counter has whole numbers from nought on", where=where, found=f"{values.min(initial=0):g}")
    turned = _counted(values, bits, where)
    steps = np.diff(turned)
    moved = np.flatnonzero(steps)
    if moved.size < 3:
        raise ModelError("the counter does not count", where=where, found=f"{moved.size} steps")
    width, told = TURN / counts, {"name": where, "teeth": counts, "source": "counter"}
    if np.median(steps[moved]) <= 1 and moved.size < 0.9 * steps.size:
        return _stepping(time, turned * width, told)
    kept = np.concatenate([[True], steps > 0])
    return shaft_dataset(time[kept], (turned[kept] + 0.5) * width, 0.0, width, told)


def _stepping(time: Array, angle: Array, told: Mapping[str, object]) -> xr.Dataset:
    """The shaft of an angle that stands for several samples: each step was met between two of them."""
    angle = np.maximum.accumulate(angle)
    moved = np.flatnonzero(np.diff(angle))
    met = 0.5 * (time[moved] + time[moved + 1])
    return shaft_dataset(met, angle[moved + 1], float(np.median(np.diff(time))), 0.0, told)


def _counted(values: Array, bits: int | None, where: str) -> Array:
    """Counts without wraps; ModelError for a counter that goes back."""
    most = float(values.max())
    usual = next((n for n in (8, 16, 32, 64) if most < 2.0**n), 64)
    span = 2.0 ** (usual if bits is None else bits)
    if most >= span:
        raise ModelError("the counter holds more than its bits", where=where, found=f"{most:g}", allowed=f"< {span:g}")
    raw = np.diff(values)
    steps = (raw + span / 2) % span - span / 2 if (raw < 0).any() else raw
    if np.abs(steps).max() > 0.4 * span:
        remedy = "sample it more often, or name its bits"
        raise ModelError("the counter moves by nearly half its range between samples", where=where, remedy=remedy)
    steps = -steps if steps.sum() < 0 else steps
    if (steps < 0).any():
        back = float(-steps[steps < 0].sum())
        raise ModelError("the shaft turns back", where=where, found=f"{back:g} counts", remedy=TURNS)
    return np.concatenate([[values[0]], values[0] + np.cumsum(steps)])


@checked
def shaft_from_encoder(angle: xr.DataArray, *, unit: str | None = None) -> xr.Dataset:
    """Angle and speed of a shaft from a sampled ``angle`` (time) that begins anew after each turn, or does not.

    Its unit is the channel's own unless given.  An angle that stands for samples and moves by steps is taken as the
    counter that it comes from; one that noise takes back now and then is averaged over as few samples as make it rise.
    Dataset as of `shaft_from_pulses`.  Raises ModelError for another unit, and where less than two samples fall on
    0.8 of a turn.

    >>> t = np.arange(0.0, 1.0, 1e-3)
    >>> angle = xr.DataArray((360.0 * 20.0 * t) % 360.0, {"time": t}, name="encoder", attrs={"units": "deg"})
    >>> shaft_from_encoder(angle).angular_velocity.values[[0, -1]].round(6).tolist()
    [125.663706, 125.663706]
    """
    time, values = raster(angle)
    where = named(angle)
    turned = np.unwrap(values * factor(angle, "angle", unit))
    turned = -turned if turned.size and turned[-1] < turned[0] else turned
    steps = np.diff(turned)
    if steps.size < 3 or not turned[-1] - turned[0] > TURN:
        raise ModelError(
            "the shaft turns less than once",
            where=where,
            found=f"{np.ptp(turned) / TURN if turned.size else 0:.3g} turns",
        )
    if np.abs(steps).max() > 0.8 * np.pi:
        raise ModelError("the angle is sampled too seldom to be followed", where=where, remedy="sample it more often")
    told: dict[str, object] = {"name": where, "source": "encoder"}
    if (steps == 0).mean() > 0.1:
        return _stepping(time, turned, {**told, "teeth": round(TURN / float(np.median(steps[steps > 0])))})
    count = next((n for n in GROUPS if (np.diff(_means(turned, n)) > 0).all()), 0)
    if not count:
        raise ModelError("the shaft turns back", where=where, remedy=TURNS)
    told |= {"teeth": round(TURN / float(np.median(steps)) / count), "averaged": count}
    return shaft_dataset(_means(time, count), _means(turned, count), 0.0, 0.0, told)


def _means(values: Array, count: int) -> Array:
    """Means of successive groups."""
    return np.asarray(values[: values.size // count * count].reshape(-1, count).mean(axis=1))


@checked
def shaft_from_speed(speed: xr.DataArray, *, unit: str | None = None) -> xr.Dataset:
    """Angle of a shaft from its sampled ``speed`` (time): its integral, exact for the cubic spline through the samples.

    The angle counts from the first sample: phases have no place on the crank.  Unit and Dataset as of
    `shaft_from_encoder`.  Raises ModelError for a speed that is not above zero throughout.

    >>> t = np.linspace(0.0, 2.0, 50)
    >>> speed = xr.DataArray(600.0 + 300.0 * t, {"time": t}, name="n", attrs={"units": "rpm"})
    >>> round(float(shaft_from_speed(speed).shaft_angle[-1]) / (2 * np.pi), 9)  # 900 rpm for two seconds
    30.0
    """
    from scipy.interpolate import CubicSpline

    time, values = raster(speed)
    omega = values * factor(speed, "angular_velocity", unit)
    if omega.size < 4 or not (omega > 0).all():
        found = f"{int((omega <= 0).sum())} of {omega.size} samples at nought or below"
        remedy = "take a stretch of four samples and more in which it turns"
        raise ModelError("the shaft does not turn throughout", where=named(speed), found=found, remedy=remedy)
    angle = CubicSpline(time, omega).antiderivative()(time)
    per_turn = round(TURN / float(np.median(np.diff(angle))))
    return shaft_dataset(time, angle, 0.0, 0.0, {"name": named(speed), "teeth": per_turn, "source": "speed"})
