"""Periodic profiles and levels over time laid end to end, as `torsional.numerics.motion.data.Driven` holds them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray

TURN = 2.0 * np.pi


def periodic_profile(values: ArrayLike) -> Array:
    """Coefficients (n, 4), as in `Driven.profile`, of the periodic cubic spline through n ≥ 3 evenly spaced samples.

    The samples span one period without its end: sample i lies at i/n of it.  Raises ModelError for too few or values
    that are not finite.

    >>> periodic_profile([1.0, 1.0, 1.0]).tolist()[0]
    [1.0, 0.0, 0.0, 0.0]
    """
    y = np.asarray(values, dtype=float)
    if y.ndim != 1 or y.size < 3 or not np.isfinite(y).all():
        raise ModelError("a profile needs finite samples", found=f"shape {y.shape}", allowed="three or more in a row")
    after = np.roll(y, -1)
    bend = np.fft.rfft(6.0 * ((after - y) - (y - np.roll(y, 1))))
    m = np.fft.irfft(bend / (4.0 + 2.0 * np.cos(TURN * np.arange(bend.size) / y.size)), y.size)
    ahead = np.roll(m, -1)
    return np.stack([y, after - y - (2.0 * m + ahead) / 6.0, 0.5 * m, (ahead - m) / 6.0], axis=1)


def packed_profiles(profiles: Sequence[tuple[ArrayLike, float]]) -> tuple[IntArray, Array, Array]:
    """``profile_start``, ``profile``, ``period`` of `Driven` from samples and periods in turns of 2π, by pairs.

    >>> start, table, period = packed_profiles([([0.0, 1.0, 0.0, -1.0], 2.0), ([1.0, 0.0, 0.0], 1.0)])
    >>> start.tolist(), table.shape, period.tolist()
    ([0, 4, 7], (7, 4), [2.0, 1.0])
    """
    tables = [periodic_profile(values) for values, _ in profiles]
    periods = np.array([period for _, period in profiles], dtype=float)
    if not (np.isfinite(periods) & (periods > 0.0)).all():
        raise ModelError("a profile's period must be positive", found=str(periods.tolist()))
    start = np.cumsum([0, *(len(table) for table in tables)]).astype(np.int64)
    return start, np.concatenate([np.zeros((0, 4)), *tables]), periods


def packed_levels(levels: Sequence[tuple[ArrayLike, ArrayLike]]) -> tuple[IntArray, Array, Array]:
    """``level_start``, ``level_time``, ``level_value`` of `Driven` from knots: times [s] and values, one pair a level.

    Raises ModelError where times fall, or their number is not that of the values.

    >>> packed_levels([(0.0, 5.0), ([0.0, 1.0], [0.0, 2.0])])[0].tolist()
    [0, 1, 3]
    """
    times = [np.atleast_1d(np.asarray(time, dtype=float)) for time, _ in levels]
    values = [np.atleast_1d(np.asarray(value, dtype=float)) for _, value in levels]
    for time, value in zip(times, values, strict=True):
        rising = time.shape == value.shape and time.size > 0 and bool((np.diff(time) >= 0.0).all())
        if not rising or not np.isfinite([time, value]).all():
            raise ModelError("a level needs rising times and a finite value at each", found=f"{time} and {value}")
    start = np.cumsum([0, *(time.size for time in times)]).astype(np.int64)
    return start, np.concatenate([np.zeros(0), *times]), np.concatenate([np.zeros(0), *values])
