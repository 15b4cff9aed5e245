"""What an engineer reads off a sub-harmonic map: its boundaries as curves, the speeds between them at one torque."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.numerics.arrays import Array

FINE = 20
"""Points of a curve drawn for each step between two that were computed."""


def boundary_curves(found: xr.Dataset) -> Iterator[tuple[str, Array]]:
    """Kind and points (points, 2) of speed [rad/s] and mean torque [Nm] of each boundary, closely, through those found.

    Runs of one kind on the same curve follow each other without a gap.
    """
    if "boundary_point" not in found.sizes:
        return
    points = np.stack([found.boundary_speed.values, found.boundary_mean_torque.values], axis=1)
    curves, kinds = found.boundary_curve.values, found.boundary_kind.values
    start = 0
    for (curve, kind), run in groupby(zip(curves, kinds, strict=True)):
        end = start + len(list(run))
        first = start - 1 if start and curves[start - 1] == curve else start
        yield str(kind), smooth(points[first:end])
        start = end


def smooth(points: Array) -> Array:
    """A cubic spline over the chord length through points (points, 2); two points, or one, as they are.

    >>> smooth(np.array([[0.0, 0.0], [1.0, 1.0]])).tolist()
    [[0.0, 0.0], [1.0, 1.0]]
    """
    from scipy.interpolate import CubicSpline  # imported where used: most analyses do without

    size = np.ptp(points, axis=0)
    steps = np.linalg.norm(np.diff(points, axis=0) / np.where(size > 0, size, 1.0), axis=1)
    kept = points[np.append(True, steps > 0)]
    if len(kept) < 3:
        return points
    length = np.append(0.0, np.cumsum(steps[steps > 0]))
    closely = np.interp(np.arange(FINE * (len(kept) - 1) + 1) / FINE, np.arange(len(kept)), length)
    return np.asarray(CubicSpline(length, kept)(closely))


def crossings(found: xr.Dataset, torque: float) -> Array:
    """Speeds [rad/s] at which boundaries pass one mean ``torque`` [Nm]."""
    met = [np.zeros(0)]
    for _, curve in boundary_curves(found):
        x, y = curve[:, 0], curve[:, 1] - torque
        at = np.flatnonzero((y[1:] >= 0) != (y[:-1] >= 0))
        met.append(x[at] - y[at] * (x[at + 1] - x[at]) / (y[at + 1] - y[at]))
    return np.concatenate(met)


@checked
def stretches(found: xr.Dataset, row: int) -> Iterator[tuple[slice, float, float]]:
    """Neighbouring speeds with sub-harmonic vibration at one torque, and the speeds [rad/s] between which it lies.

    It ends where a boundary passes between two speeds of the map, else at the outermost speed.
    """
    speed, met = found.speed.values, crossings(found, float(found.mean_torque[row]))
    for first, last in runs(found.amplitude.transpose("mean_torque", "speed").values[row] > 0):
        before, after = speed[max(first - 1, 0)], speed[min(last + 1, len(speed) - 1)]
        below = met[(met >= before) & (met <= speed[first])]
        above = met[(met >= speed[last]) & (met <= after)]
        low = float(below.max()) if below.size else float(speed[first])
        high = float(above.min()) if above.size else float(speed[last])
        yield slice(first, last + 1), low, high


def runs(there: Array) -> list[tuple[int, int]]:
    """First and last index of each run of true values.

    >>> runs(np.array([False, True, True, False, True]))
    [(1, 2), (4, 4)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], there, [False]]).astype(int)))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
