"""Times of teeth that gave no pulse, from their neighbours: band-limited interpolation on the even raster of teeth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from torsional.numerics.arrays import Array

BANDS = (0.2, 0.3)
"""Cycles a tooth up to which vibration is carried across a hole, of two teeth (order 12 of 60) and of one."""
NEAR = 32
"""Teeth on either side that are looked at."""
NOISE = 1e-6
"""Variance of a pulse's own error over that of the vibration."""


def filled(times: Array, number: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
    """Times [s] of all teeth from the first ``number`` to the last, and which of them were measured.

    Best linear estimate of a signal with a flat spectrum up to `BANDS` on a quadratic trend (universal kriging;
    Wackernagel, Multivariate Geostatistics, Springer 2003, ch. 38), its weights being those of the pattern of holes.

    >>> number = np.array([n for n in range(200) if n % 60 not in (58, 59)])
    >>> wave = lambda n: n + 0.3 * np.sin(0.5 * n)
    >>> found, measured = filled(wave(number), number)
    >>> bool(abs(found - wave(np.arange(200)))[~measured].max() < 1e-4)
    True
    """
    at = number - number[0]
    found = np.full(int(at[-1]) + 1, np.nan)
    found[at] = times
    measured = np.isfinite(found)
    weights: dict[tuple[bytes, int], Array] = {}
    for first, last in _holes(measured):
        low, high = max(first - NEAR, 0), min(last + NEAR, measured.size)
        known = measured[low:high]
        key = (known.tobytes(), first - low)
        if key not in weights:
            weights[key] = _weights(np.flatnonzero(known), np.arange(first - low, last - low))
        found[first:last] = weights[key] @ found[low:high][known]
    return found, measured


def _holes(measured: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Runs of teeth without a pulse: the first of each, and the one behind its last."""
    edges = np.diff(measured.astype(np.int8))
    return list(zip((np.flatnonzero(edges == -1) + 1).tolist(), (np.flatnonzero(edges == 1) + 1).tolist(), strict=True))


def _weights(known: NDArray[np.int64], wanted: NDArray[np.int64]) -> Array:
    """Weights (wanted, known) of the measured neighbours."""
    origin, band = float(wanted.mean()), BANDS[wanted.size == 1]
    trend = np.vander((known - origin) / NEAR, 3)
    size, parts = known.size, min(3, known.size)
    matrix = np.zeros((size + parts, size + parts))
    matrix[:size, :size] = np.sinc(2 * band * np.subtract.outer(known, known)) + NOISE * np.eye(size)
    matrix[:size, size:] = trend[:, 3 - parts :]
    matrix[size:, :size] = matrix[:size, size:].T
    right = np.vstack(
        [
            np.sinc(2 * band * np.subtract.outer(known, wanted)),
            np.vander((wanted - origin) / NEAR, 3)[:, 3 - parts :].T,
        ]
    )
    return np.asarray(np.linalg.solve(matrix, right)[:size].T)
