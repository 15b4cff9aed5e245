"""Engine orders of a four-stroke cycle: exact multiples of one half, on a grid without a repeated end point."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from torsional.errors import ModelError

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.int_]
BoolArray = NDArray[np.bool_]

CYCLE = 4.0 * np.pi
"""Crank angle of one four-stroke cycle [rad]."""

SAMPLES = 1440
"""Samples of one cycle: every half degree, 720° itself left out (it is 0° again)."""

LAST_SAMPLED_ORDER = SAMPLES / 8
"""Highest order given out: four samples and more a period, so that aliases stay below the series' own tail."""

HALF_ORDERS = np.arange(0.5, 12.5, 0.5)
"""Orders of analyses in the frequency domain where none are asked for."""

HIGHEST_ORDER = 18.0
"""Highest order of steady motions where none is asked for; those of a stage's torque fall with its square."""


def crank_angle_grid(samples: int = SAMPLES) -> FloatArray:
    """Crank angles of one cycle [rad], evenly spaced, without the end point.

    >>> bool(crank_angle_grid(4)[-1] == 3 * np.pi)
    True
    """
    return np.asarray(CYCLE * np.arange(samples) / samples)


def checked_orders(orders: ArrayLike) -> FloatArray:
    """The orders as a 1-D array, each an exact multiple of 0.5.

    Raises ModelError for an order that a four-stroke engine cannot have: negative, not a multiple of one half, above
    ``LAST_SAMPLED_ORDER``, given twice.
    """
    found = np.atleast_1d(np.asarray(orders, dtype=float))
    if found.ndim != 1 or found.size == 0:
        raise ModelError("a list of orders is needed", where="orders", found=f"an array of shape {found.shape}")
    twice = np.round(2.0 * found)
    wrong = ~np.isfinite(found) | (np.abs(2.0 * found - twice) > 1e-9) | (found < 0) | (found > LAST_SAMPLED_ORDER)
    if wrong.any():
        raise ModelError(
            "a four-stroke engine has the orders 0, 0.5, 1, 1.5 …",
            where="orders",
            found=f"{found[wrong][0]:g}",
            allowed=f"multiples of 0.5 from 0 to {LAST_SAMPLED_ORDER:g}",
        )
    if np.unique(twice).size < twice.size:
        raise ModelError("an order is given twice", where="orders", found=", ".join(f"{n:g}" for n in found))
    return np.asarray(twice / 2.0)


def half_order_series(samples: ArrayLike) -> ComplexArray:
    """Complex 0-peak harmonics of samples over one cycle, last axis, entry i being order i/2.

    x(θ) = Re Σ_n X_n exp(i n θ), n = 0, 0.5, 1 …; the samples are those of ``crank_angle_grid``: with the end point
    repeated the orders would come out as 0.499, 0.998 …

    >>> bool(abs(half_order_series(3 * np.cos(1.5 * crank_angle_grid() + 0.2))[3] - 3 * np.exp(0.2j)) < 1e-13)
    True
    """
    values = np.asarray(samples, dtype=float)
    series = np.fft.rfft(values, axis=-1) * (2.0 / values.shape[-1])
    series[..., 0] /= 2.0
    return np.asarray(series)


def picked(series: ComplexArray, orders: Sequence[float] | FloatArray) -> ComplexArray:
    """The columns of a half-order series that belong to the (checked) orders."""
    return np.asarray(series[..., np.round(2.0 * np.asarray(orders)).astype(int)])


def periodic_spline(knots: FloatArray, rows: FloatArray) -> CubicSpline:
    """Cubic spline over one cycle through ``rows`` (series, samples), whose first sample also closes it."""
    from scipy.interpolate import CubicSpline  # imported where used: order analyses do without scipy

    return CubicSpline(knots, np.column_stack([rows, rows[:, 0]]), axis=1, bc_type="periodic")
