"""Periodic profiles and levels over time laid end to end, as `torsional.numerics.motion.data.Driven` holds them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.laws import Law, packed
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.sparse_factor import places
from torsional.numerics.motion.data import Connected, HingeRows, Laws, Rows

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


Load = tuple[float, int, float, Sequence[tuple[int, float]]]
"""Constant, level, what follows Ω², shares of the torques of connections."""


def packed_connections(
    rows: Rows,
    constants: Sequence[Sequence[float]],
    hinges: Sequence[Sequence[Sequence[float]]],
    laws: Sequence[Law | None],
    loads: Sequence[Load | None],
) -> Connected:
    """Connections as arrays: of each its five constants, its hinges (gap, side, Δk, τ), its law and that one's load."""
    own, start, address, remembers = packed(laws)
    of, shares, table, weights = np.flatnonzero(address), [], [], []
    for e in of.tolist():
        load, law = loads[e], laws[e]
        constant, level, squared, listed = load or (0.0, -1, 0.0, ())
        place = -1 if load is None or law is None else start[e] + law.load_place
        shared = len(shares), len(shares) + len(listed)
        table.append((e, address[e], remembers[e], start[e], start[e + 1], place, level, *shared))
        shares += listed
        weights.append((constant, squared))
    return Connected(
        rows,
        np.array(constants, dtype=float).reshape(-1, 5).T.copy(),
        HingeRows(
            places(e for e, each in enumerate(hinges) for _ in each),
            np.array([hinge for each in hinges for hinge in each], dtype=float).reshape(-1, 4).T.copy(),
        ),
        Laws(
            np.array(table, dtype=np.int64).reshape(-1, 9).T.copy(),
            own,
            np.array(weights, dtype=float).reshape(-1, 2).T.copy(),
            places(e for e, _ in shares),
            np.array([share for _, share in shares], dtype=float),
        ),
    )
