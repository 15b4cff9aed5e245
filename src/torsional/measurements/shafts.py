"""Angle and speed of a shaft from the pulses of a wheel, and by what its teeth stand off their places."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.measurements.filling import filled
from torsional.measurements.pulses import clock_tick
from torsional.measurements.rotation import deviation, mean_rotation
from torsional.measurements.signals import refuse_other, refuse_times
from torsional.measurements.teeth import numbered
from torsional.numerics.arrays import Array
from torsional.results import Variable, dataset

TURN = 2 * np.pi
MEASURED, IN_GAP, LOST = "measured", "gap", "lost"
"""What the angle of a tooth stands on: its pulse, its neighbours beside the wheel's gap, those beside a lost pulse."""
MOST_TEETH = 100_000


@checked
def shaft_from_pulses(
    times: ArrayLike,
    teeth: int,
    *,
    missing: int = 0,
    index_angle: float = 0.0,
    pitch: ArrayLike = (),
    resolution: float | None = None,
    name: str = "tacho",
) -> xr.Dataset:
    """Angle and speed of a shaft from pulse ``times`` [s] of a wheel with so many ``teeth`` a turn.

    ``missing`` teeth of each turn are its gap (2 of a 60−2 wheel, whose ``teeth`` are 60), and the first tooth behind
    it stands at ``index_angle`` [rad]; without a gap the first pulse does.  Lost pulses are counted and put in by
    band-limited interpolation, as the gap's are; pulses by fault are taken out: `numbered` tells how, and what is
    refused.  ``pitch`` [rad]: what each tooth stands off its even place, see `tooth_pitch`.  ``resolution`` [s] is the
    tick of the clock; found from the times unless given.

    ``shaft_angle`` (time) [rad]; ``angular_velocity`` (time) [rad/s] across the two intervals at a tooth, and its
    ``speed_noise``, the standard deviation that the clock makes of it; ``pulse`` (time) what a tooth stands on;
    ``extra_pulse`` the times taken out.  Times are rounded to Δt, so that each is off by Δt/√12, and

        σ_ω = ω² Δt √2/√12 / (2 δ) = ω² Δt z / (4π √6),  δ = 2π/z of z teeth;

    a single interval has twice that.

    >>> found = shaft_from_pulses(np.arange(300) / 600.0, 60)  # 600 teeth a second
    >>> float(found.angular_velocity.mean().round(9)) == round(2 * np.pi * 10, 9)
    True
    """
    at = np.asarray(times, dtype=float)
    refuse_times(at, name)
    _refuse_wheel(at, teeth, missing, name)
    found = numbered(at, teeth, missing, name)
    every, measured = filled(found.times, found.number)
    number = found.number[0] + np.arange(every.size)
    number -= teeth * int(number[0] // teeth)
    off = np.asarray(pitch, dtype=float)
    if off.size not in (0, teeth):
        raise ModelError(
            "a pitch error is wanted for each tooth", where="pitch", found=str(off.size), allowed=str(teeth)
        )
    angle = TURN * number / teeth + index_angle + (off[number % teeth] if off.size else 0.0)
    tick = clock_tick(found.times) if resolution is None else resolution
    state = np.where(measured, MEASURED, np.where(number % teeth >= teeth - missing, IN_GAP, LOST))
    told: dict[str, object] = {"name": name, "teeth": teeth, "missing": missing, "source": "pulses"}
    told["index_angle"] = index_angle
    return shaft_dataset(every, np.asarray(angle), tick, 0.0, told, state, found.extra)


@checked
def tooth_pitch(shaft: xr.Dataset, begin: float, end: float) -> Array:
    """By what each tooth stands off its even place [rad], learnt from a stretch [s] in which the shaft turns steadily.

    The mean of what the mean rotation is ahead of the even teeth, tooth by tooth.  Vibration at whole orders of
    the shaft comes back in every turn as well, and is learnt with it: take a stretch without (coasting, motored), and
    five turns or more.  Raises ModelError for less than three, and for a shaft that is not of `shaft_from_pulses`.

    >>> off = 1e-3 * np.sin(np.arange(12) ** 2)
    >>> angle = 2 * np.pi / 12 * np.arange(600) + np.resize(off, 600)
    >>> found = tooth_pitch(shaft_from_pulses(angle / 100.0, 12), 0.0, 3.0)
    >>> bool(abs(found - (off - off.mean())).max() < 2e-6)
    True
    """
    refuse_other(shaft, "shaft_angle", "shaft", "shaft_from_pulses")
    if shaft.attrs.get("source") != "pulses":
        raise ModelError("a pitch is learnt from pulses", where="shaft", found=str(shaft.attrs.get("source", "none")))
    teeth = int(shaft.attrs["teeth"])
    within = shaft.sel(time=slice(begin, end))
    off = deviation(within, mean_rotation(within, cycle=TURN))
    turned = float(np.ptp(off.crank_angle.values)) / TURN if off.size else 0.0
    if turned < 3:
        found = f"{turned:.1f} turns beyond its ends"
        raise ModelError("a pitch takes three turns at least", where="begin, end", found=found)
    number = np.rint((off.shaft_angle.values - float(shaft.attrs["index_angle"])) * teeth / TURN).astype(int)
    real = off.pulse.values == MEASURED
    sums = np.bincount(number[real] % teeth, off.values[real], minlength=teeth)
    counts = np.bincount(number[real] % teeth, minlength=teeth)
    mean = np.divide(sums, counts, out=np.zeros(teeth), where=counts > 0)
    return np.asarray(np.where(counts > 0, mean[counts > 0].mean() - mean, 0.0))


def _refuse_wheel(times: Array, teeth: int, missing: int, name: str) -> None:
    if not 1 <= teeth <= MOST_TEETH:
        raise ModelError("a wheel has teeth", where=name, found=str(teeth), allowed=f"1 to {MOST_TEETH}")
    if missing < 0 or (missing and teeth - missing < 3):
        allowed = f"0 to {max(teeth - 3, 0)} of {teeth}"
        raise ModelError("the gap leaves three teeth at least", where=name, found=str(missing), allowed=allowed)
    if times.size < 2 * max(teeth - missing, 4):
        found = f"{times.size} pulses"
        raise ModelError(f"a wheel of {teeth} teeth is to turn twice at least", where=name, found=found)


def shaft_dataset(
    time: Array,
    angle: Array,
    tick: float,
    width: float,
    told: Mapping[str, object],
    state: NDArray[np.str_] | None = None,
    extra: Array | None = None,
) -> xr.Dataset:
    """The Dataset of a shaft whose times are known to a ``tick`` [s], angles to a ``width`` [rad].

    ``told``: its name, how many ``teeth`` a turn it is seen at, and the ``source``.
    """
    ahead = np.minimum(np.arange(time.size) + 1, time.size - 1)
    behind = np.maximum(np.arange(time.size) - 1, 0)
    span, lasting = angle[ahead] - angle[behind], time[ahead] - time[behind]
    omega = span / lasting
    noise = np.hypot(omega * tick, width) * np.sqrt(2 / 12) / lasting
    found: dict[str, Variable] = {
        "shaft_angle": (("time",), angle, "angle"),
        "angular_velocity": (("time",), omega, "angular_velocity"),
        "speed_noise": (("time",), noise, "angular_velocity"),
        "pulse": (("time",), np.full(time.size, MEASURED) if state is None else state, ""),
    }
    coordinates = {"time": (time, "time"), "extra_pulse": (np.empty(0) if extra is None else extra, "time")}
    settings: dict[str, object] = {"resolution": tick, "angle_resolution": width, "missing": 0, **told}
    return dataset(found, coordinates, analysis="shaft angle", **settings)
