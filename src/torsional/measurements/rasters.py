"""Signals of several rasters on one even raster."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from torsional.errors import ModelError
from torsional.measurements.recording import bounded
from torsional.numerics.arrays import Array

EDGE = 1e-6
"""Share of a step by which the last sample may lie beyond the end."""


def common(times: Sequence[Array], rate: float) -> Array:
    """Even times [s] at ``rate`` [Hz] from the latest start to the earliest end; ModelError where there are none.

    >>> common([np.array([0.0, 1.0]), np.array([0.25, 2.0])], 4.0).tolist()
    [0.25, 0.5, 0.75, 1.0]
    """
    start, end = max(t[0] for t in times), min(t[-1] for t in times)
    if not end > start:
        found = ", ".join(f"{t[0]:g} to {t[-1]:g} s" for t in times[:6])
        raise ModelError("the channels have no time in common", found=found, remedy="look at their delays")
    steps = (end - start) * rate
    if steps < 1:
        raise ModelError("the channels have less than one step in common", found=f"{end - start:g} s at {rate:g} Hz")
    bounded(int(min(steps, 1e15)) * len(times))
    return np.asarray(start + np.arange(int(steps + EDGE) + 1) / rate)


def brought(time: Array, values: Array, to: Array, method: str) -> Array:
    """Values at even times ``to``: ``linear`` between samples, the ``previous`` sample, or the ``mean`` of the straight
    lines over a step around each, which keeps what is faster than the raster from showing up as something slow.

    >>> brought(np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 0.0]), np.array([0.5, 1.5]), "previous").tolist()
    [0.0, 2.0]
    """
    if method == "linear":
        return np.asarray(np.interp(to, time, values))
    if method == "previous":
        return np.asarray(values[np.searchsorted(time, to, side="right") - 1])
    half = 0.5 * (to[1] - to[0])
    edges = np.clip(np.append(to - half, to[-1] + half), time[0], time[-1])
    areas = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (values[1:] + values[:-1]))])
    at = np.clip(np.searchsorted(time, edges, side="right") - 1, 0, time.size - 2)
    way = edges - time[at]
    slope = (values[at + 1] - values[at]) / (time[at + 1] - time[at])
    return np.asarray(np.diff(areas[at] + way * (values[at] + 0.5 * slope * way)) / np.diff(edges))
