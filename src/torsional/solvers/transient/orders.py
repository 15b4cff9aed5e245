"""Orders and root mean squares of runs in time, over the angle that the crank has turned."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import CYCLE
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import QUANTITIES

SAMPLES = 16
"""Samples a period of the highest order, after resampling on even crank angles."""
WINDOWS = ("none", "hann")


@checked
def order_tracking(
    signal: xr.DataArray,
    crank_angle: xr.DataArray,
    orders: ArrayLike,
    *,
    cycles: int = 1,
    window: str = "none",
    overlap: float = 0.0,
) -> xr.DataArray:
    """Orders of a ``signal`` over ``time`` in successive windows of whole ``cycles`` of 720°, complex 0-peak.

    The signal is resampled on even angles of ``crank_angle`` [rad] (of a run: ``run.crank_angle``; or the angle of a
    node), by a cubic spline: a run-up does not smear its orders.  ``orders`` are multiples of 0.5/cycles.  ``window``
    "hann" keeps neighbouring orders of fast run-ups apart, and takes two cycles or more; ``overlap`` is the share that
    windows have in common.  Dimension ``time`` becomes the middle of each window, ``order`` comes last.
    Raises ModelError for other orders, and for a signal of less than one window.

    x(α) = Re Σ_n X_n exp(i n α), X_n = 2/(4π c) ∫ x exp(−i n α) dα over c cycles; Brandt, Noise and Vibration Analysis,
    Wiley 2011, ch. 12.

    >>> t = np.linspace(0.0, 1.0, 4001)
    >>> alpha = xr.DataArray(60.0 * t + 20.0 * t**2, dims="time", coords={"time": t})
    >>> found = order_tracking(0.3 * np.cos(3 * alpha), alpha, [1.5, 3.0])
    >>> abs(found).isel(time=2).values.round(6).tolist()
    [0.0, 0.3]
    """
    order = _checked(np.atleast_1d(np.asarray(orders, dtype=float)), cycles, window)
    turned = np.asarray(crank_angle.values, dtype=float)
    if not turned.size or turned.max() == turned.min():
        remedy = "the frame stands: use the crank's own angle, crank_angle_of(run, node)"
        raise ModelError("the crank does not turn", where="crank_angle", remedy=remedy)
    if (np.diff(turned) <= 0).any():
        remedy = "use the mean angle, run.crank_angle, or the stretch of time in which it turns"
        raise ModelError("the crank stands or turns back", where="crank_angle", remedy=remedy)
    span, count = CYCLE * cycles, samples_a_window(float(order.max()), cycles)
    first = np.ceil(turned[0] / CYCLE - 1e-9) * CYCLE
    starts = np.arange(first, turned[-1] - span + 1e-9 * span, span * (1.0 - overlap))
    if not starts.size:
        found = f"{(turned[-1] - turned[0]) / CYCLE:.2f} cycles of 720°"
        raise ModelError("the run is shorter than one window", where="time", found=found, allowed=f"{cycles} and more")
    from scipy.interpolate import CubicSpline  # imported where used: half of the analyses need none

    values = signal.transpose("time", ...)
    shares: Array = np.asarray(np.arange(count) * (span / count), dtype=float)
    sampled = CubicSpline(turned, values.values, axis=0)(np.add.outer(starts, shares))
    turns = _kernel(order, shares, window)
    picked = np.tensordot(sampled, turns, axes=(1, 0))
    picked *= np.exp(-1j * np.multiply.outer(starts, order)).reshape(len(starts), *[1] * (picked.ndim - 2), -1)
    middle = np.interp(starts + 0.5 * span, turned, np.asarray(signal.time.values, dtype=float))
    rest = [str(dim) for dim in values.dims[1:]]
    coords = {dim: values[dim] for dim in rest if dim in values.coords} | {"time": middle, "order": order}
    attrs = {**signal.attrs, "amplitude": "complex 0-peak"}
    return xr.DataArray(picked, dims=("time", *rest, "order"), coords=coords, name=signal.name, attrs=attrs)


def samples_a_window(highest: float, cycles: int) -> int:
    """Even angles in a window of so many cycles of 720° whose highest order this is."""
    return max(int(np.ceil(highest * 2 * cycles * SAMPLES)), 64)


def _checked(order: Array, cycles: int, window: str) -> Array:
    if cycles < 1 or window not in WINDOWS or (window == "hann" and cycles < 2):
        allowed = "whole cycles from 1 (none) or 2 (hann) on"
        raise ModelError("no such window", where="window", found=f"{window}, {cycles} cycles", allowed=allowed)
    parts = order * 2 * cycles
    wrong = np.abs(parts - np.round(parts)) > 1e-9
    if wrong.any() or (order < 0).any():
        allowed = f"multiples of {0.5 / cycles:g}"
        remedy = "more cycles tell finer orders apart"
        raise ModelError(
            "the window does not hold whole periods of the order",
            where="orders",
            found=f"{order[wrong | (order < 0)][0]:g}",
            allowed=allowed,
            remedy=remedy,
        )
    return order


def _kernel(order: Array, angle: Array, window: str) -> ComplexArray:
    """Weights (samples, orders) that pick out the orders."""
    shape = np.ones(len(angle)) if window == "none" else 1.0 - np.cos(2 * np.pi * np.arange(len(angle)) / len(angle))
    turns = np.exp(-1j * np.multiply.outer(angle, order)) * (shape / shape.sum())[:, None]
    return np.asarray(turns * np.where(order > 0, 2.0, 1.0))


@checked
def windowed_rms(signal: xr.DataArray, window: float) -> xr.DataArray:
    """Root mean square of a ``signal`` about its own mean in successive windows [s], at the middle of each.

    >>> t = np.arange(1000) / 1000
    >>> wave = xr.DataArray(2.0 + np.sin(2 * np.pi * 50 * t), dims="time", coords={"time": t})
    >>> windowed_rms(wave, 0.5).values.round(6).tolist()
    [0.707107, 0.707107]
    """
    time = np.asarray(signal.time.values, dtype=float)
    step = float(time[1] - time[0])
    count = round(window / step)
    if not 2 <= count <= len(time):
        allowed = f"{2 * step:g} to {len(time) * step:g} s"
        raise ModelError("no such window", where="window", found=f"{window:g} s", allowed=allowed)
    values = signal.transpose("time", ...)
    windows = len(time) // count
    blocks = values.values[: windows * count].reshape(windows, count, *values.shape[1:])
    middle = time[: windows * count].reshape(windows, count).mean(axis=1)
    coords = {str(d): values[d] for d in values.dims[1:] if d in values.coords} | {"time": middle}
    attrs = {**signal.attrs, "amplitude": "root mean square about the mean"}
    return xr.DataArray(blocks.std(axis=1), dims=values.dims, coords=coords, name=signal.name, attrs=attrs)


@checked
def crank_angle_of(run: xr.Dataset, node: str) -> xr.DataArray:
    """The angle [rad] that a node has turned by itself, over its mean speed ratio: the crank angle of a run-up by the
    engine's own torque.

    >>> t = np.array([0.0, 0.5, 1.0])
    >>> turned = xr.DataArray([[0.0], [1.0], [4.0]], coords={"time": t, "node": ["crank"]})
    >>> turned = turned.assign_coords(speed_ratio=("node", [2.0]))
    >>> crank_angle_of(xr.Dataset({"angle": turned, "crank_angle": ("time", 60.0 * t)}), "crank").values.tolist()
    [0.0, 30.5, 62.0]
    """
    ratio = float(run.speed_ratio.sel(node=node))
    found: xr.DataArray = run.crank_angle + run.angle.sel(node=node, drop=True) / ratio
    entry = QUANTITIES["crank_angle"]
    return found.assign_attrs(units=entry.unit, long_name=entry.long_name, quantity="crank_angle")
