"""Signals brought from their times to even crank angles: computed order tracking."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.engine.orders import CYCLE
from torsional.errors import ModelError
from torsional.measurements.rotation import crank_angle_at, time_at
from torsional.measurements.signals import is_even, named, raster, refuse_other
from torsional.numerics.arrays import Array

PER_PERIOD = 12
"""Samples a period of the highest order from which a cubic spline meets it to 1.1e-4; fewer are made more before."""
BAND = 2.56
"""Samples a period of the highest order that a record must have: Nyquist's two, and room for a filter's flank."""
REACH = 16
"""Samples that the finer raster's filter looks at on either side."""
EDGE = REACH + 2
"""Samples at either end that the filters spoil."""
FILTER = ("kaiser", 8.0)
ORDERS = 16
"""Even angles a period of the highest order, as order tracking has them."""
MOST = 40_000_000
"""Samples of one channel on the finest raster of angles."""
TURN = 2 * np.pi


def spline_error(per_period: float) -> float:
    """By what share a cubic spline through even samples, so many a period, makes a sine smaller.

    1 − sinc⁴(1/n) · 3/(2 + cos(2π/n)); Unser, Splines: a perfect fit for signal and image processing, IEEE Signal
    Processing Magazine 16 (1999), no. 6, 22.

    >>> [round(spline_error(n), 5) for n in (5, 10, 12)]
    [0.00494, 0.00024, 0.00011]
    """
    x = 1.0 / per_period
    return float(1.0 - np.sinc(x) ** 4 * 3.0 / (2.0 + np.cos(TURN * x)))


@checked
def resampled(
    signal: xr.DataArray, rotation: xr.Dataset, per_turn: int, *, span: tuple[float, float] | None = None
) -> xr.DataArray:
    """A ``signal`` over time at even crank angles of a mean ``rotation``, so many ``per_turn``.

    A cubic spline goes through the record (Fyfe and Munck, Analysis of computed order tracking, Mechanical Systems and
    Signal Processing 11 (1997) 187).  Where that has less than twelve samples a period of order ``per_turn``/16, it is
    first brought to a finer raster by a band-limited filter.  What lies above order ``per_turn``/2 is filtered off,
    lest it be folded below.  Attribute ``interpolation_error``: by what share order ``per_turn``/16 may come out
    smaller at the highest speed.  Dimension ``crank_angle`` [rad], beginning with a multiple of 720°, within ``span``
    [rad] where that is given; coordinate ``time``.  Raises ModelError for a record with less than 2.56 samples a
    period of order ``per_turn``/16, and for one that holds no whole cycle.

    >>> import torsional as tv
    >>> t = np.arange(0.0, 4.0, 1e-3)
    >>> alpha = 60.0 * t + 20.0 * t**2
    >>> turning = tv.mean_rotation(tv.shaft_from_encoder(xr.DataArray(alpha, {"time": t}, attrs={"units": "rad"})))
    >>> found = resampled(xr.DataArray(np.cos(3 * alpha), {"time": t}), turning, 96)
    >>> bool(abs(found - np.cos(3 * found.crank_angle)).max() < 1e-3)
    True
    """
    refuse_other(rotation, "crank_angle", "rotation", "mean_rotation")
    time, values = raster(signal)
    low, high = common_span(rotation, [time], per_turn) if span is None else span
    name, order = named(signal), per_turn / ORDERS
    even = "teeth" in signal.attrs or is_even(time)
    time, values = _at_rate(time, values, _per_period(time, rotation, order, name), even)
    fine = _fineness(time, rotation, per_turn, high - low)
    first, last = (int(np.ceil(low / TURN * per_turn - 1e-9)), int(np.floor(high / TURN * per_turn + 1e-9)))
    at = np.asarray(np.arange((first - EDGE) * fine, (last + EDGE) * fine + 1) * (TURN / (per_turn * fine)))
    found = _thinned(_through(time, values, time_at(rotation, at)), fine)[EDGE : EDGE + last - first + 1]
    grid = np.asarray(np.arange(first, last + 1) * (TURN / per_turn))
    told = {key: value for key, value in signal.attrs.items() if key != "teeth"}
    told["interpolation_error"] = spline_error(_per_period(time, rotation, order, name))
    coordinates = {"crank_angle": grid, "time": ("crank_angle", time_at(rotation, grid))}
    return xr.DataArray(found, coordinates, ("crank_angle",), signal.name, told)


def common_span(rotation: xr.Dataset, times: Sequence[Array], per_turn: int) -> tuple[float, float]:
    """The crank angles [rad], from a multiple of 720° on, for which the rotation and all the times are known."""
    period = TURN * ORDERS / (per_turn * float(rotation.speed.max()))
    spoilt = [EDGE * max(float(np.median(np.diff(time))), period / PER_PERIOD) for time in times]
    begin = max([float(rotation.time[0]), *(float(time[0]) + off for time, off in zip(times, spoilt, strict=True))])
    end = min([float(rotation.time[-1]), *(float(time[-1]) - off for time, off in zip(times, spoilt, strict=True))])
    room = EDGE * TURN / per_turn
    low, high = crank_angle_at(rotation, np.array([begin, max(begin, end)]))
    first = float(np.ceil((low + room) / CYCLE - 1e-9) * CYCLE)
    if not high - room - first >= CYCLE:
        found = f"{(high - low) / CYCLE:.2f} cycles of 720° from {begin:.5g} to {end:.5g} s"
        raise ModelError("what was recorded together holds no whole cycle", where="time", found=found)
    return first, float(high - room)


def _angles_between(time: Array, rotation: xr.Dataset) -> tuple[float, float]:
    """How far [rad] the crank turns between samples where they are closest, and where they are farthest apart.

    Samples even in time are farthest apart at the highest speed, teeth are as far at any.
    """
    inside = time[(time >= float(rotation.time[0])) & (time <= float(rotation.time[-1]))]
    if inside.size < 2:
        raise ModelError("channel and rotation have no time in common", where="time", found=f"{inside.size} samples")
    near, far = np.quantile(np.diff(crank_angle_at(rotation, inside)), [0.01, 0.99])
    return float(near), float(far)


def highest_order(rotation: xr.Dataset, times: Sequence[Array]) -> float:
    """The highest order of which all records have samples enough."""
    return min(TURN / (BAND * _angles_between(time, rotation)[1]) for time in times)


def _per_period(time: Array, rotation: xr.Dataset, order: float, name: str) -> float:
    """Samples a period of an order where they are fewest; ModelError for too few."""
    turn = TURN / _angles_between(time, rotation)[1]
    if turn < BAND * order:
        told = f"{turn:.4g} samples a turn where they are fewest"
        remedy = f"lower orders, up to {turn / BAND:.3g}"
        allowed = f"{BAND * order:.4g} and more for order {order:g}"
        raise ModelError("the channel is sampled too seldom", where=name, found=told, allowed=allowed, remedy=remedy)
    return turn / order


def _at_rate(time: Array, values: Array, per_period: float, even: bool) -> tuple[Array, Array]:
    """The record with twelve samples a period of the highest order, or up to twice as many.

    Tones far above the orders go with the samples that are too many, and most of the work with them.
    """
    if even and per_period > 2 * PER_PERIOD:
        coarser = int(per_period / PER_PERIOD)
        return time[::coarser], _thinned(values, coarser)
    if even and per_period < PER_PERIOD:
        finer = int(np.ceil(PER_PERIOD / per_period))
        return _refined(time, finer), _refined(values, finer)
    return time, values


def _fineness(time: Array, rotation: xr.Dataset, per_turn: int, span: float) -> int:
    """How many times finer angles are first to be, so that nothing in the record is folded where it turns slowest."""
    wanted = TURN / (_angles_between(time, rotation)[0] * per_turn)
    return int(np.clip(np.ceil(wanted), 1, max(MOST // (per_turn * span / TURN), 1)))


def _refined(values: Array, finer: int) -> Array:
    """So many times the samples: a windowed sinc through the given ones, whose weights sum to one at each new place.

    A plain low-pass has sums that differ from place to place, which a record's mean would be heard by.
    """
    from scipy.signal import resample_poly
    from scipy.signal.windows import get_window

    if finer == 1:
        return values
    reach = np.arange(-REACH * finer, REACH * finer + 1)
    weights = np.sinc(reach / finer) * get_window(FILTER, reach.size, fftbins=False)
    for place in range(finer):
        weights[place::finer] /= weights[place::finer].sum() * finer
    ends = values[0], (values[-1] - values[0]) / max(values.size - 1, 1)
    line = ends[0] + ends[1] * np.arange(values.size)
    found = resample_poly(values - line, finer, 1, window=weights)
    return np.asarray(found + ends[0] + ends[1] / finer * np.arange(found.size))


def _thinned(values: Array, fine: int) -> Array:
    from scipy.signal import resample_poly

    return values if fine == 1 else np.asarray(resample_poly(values, 1, fine, window=FILTER, padtype="line"))


def _through(time: Array, values: Array, at: Array) -> Array:
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(time, values)(at))
