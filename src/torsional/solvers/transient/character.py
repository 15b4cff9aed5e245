"""What a long run is: periodic, of several periods, quasi-periodic or chaotic, told from its stroboscopic points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.stepping.stroboscopic import gap_between

REGULAR = 0.01
"""Largest exponent a period that counts as none; what 300 periods of a quasi-periodic motion leave is below it."""
THIN = 1.3
"""Largest dimension of stroboscopic points that lie on a closed curve."""
EVEN = 0.1
"""Share of the mean step by which the steps of a drift differ at most."""
FEWEST = 200
"""Points below which a dimension means nothing."""
CLOSE, FAR = 0.01, 0.1
"""Shares of all pairs of points between whose distances the dimension is measured."""


@dataclass(frozen=True)
class Character:
    """``kind`` in one word or two, ``periods`` of the drive after which it repeats itself (0: never), what is ``left``
    of the last difference over the motion's size, largest ``exponent`` a period and ``dimension`` of the points (nan:
    not asked)."""

    kind: str
    periods: int
    left: float
    exponent: float = float("nan")
    dimension: float = float("nan")

    @property
    def words(self) -> str:
        """The same as a sentence."""
        told = {
            "periodic": "periodic with the drive",
            "multiple": f"periodic, repeats itself after {self.periods} periods of the drive",
            "quasi-periodic": "quasi-periodic: never repeats itself, yet neighbouring motions stay together",
            "chaotic": f"chaotic: neighbouring motions part by a factor of {np.exp(self.exponent):.3g} a period",
            "drifting": f"drifts: it moves on evenly by {self.left:.1e} of itself a period, as a part does that creeps",
            "unsettled": f"not settled yet: {self.left:.1e} of the motion changes from period to period",
        }
        return told[self.kind]


def restless(points: Array, size: float, longest: int) -> float:
    """The largest difference of the last ``longest`` points from those one period before, over the motion's size."""
    return float(gap_between(points, size, longest, 1)) if len(points) > longest else np.inf


def drifts(points: Array, longest: int) -> bool:
    """Whether the last ``longest`` points follow each other in even steps along a line.

    >>> drifts(np.arange(20.0)[:, None], 8), drifts(np.sin(np.arange(20.0))[:, None], 8)
    (True, False)
    """
    steps = np.diff(points[-longest - 1 :], axis=0)
    mean = steps.mean(axis=0)
    return bool(np.linalg.norm(steps - mean, axis=1).max() < EVEN * np.linalg.norm(mean))


def dimension(points: Array) -> float:
    """Correlation dimension of ``points`` (count, states): 0 for a few points, 1 for a closed curve, more for chaos.

    Slope of the logarithm of the share of pairs within a distance over that of the distance, between the shares of one
    and ten per cent; Grassberger and Procaccia (Physica D 9 (1983) 189).

    >>> alpha = 2 * np.pi * 0.618034 * np.arange(1500)
    >>> round(dimension(np.stack([np.cos(alpha), np.sin(alpha)], axis=1)), 1)
    1.0
    """
    count = len(points)
    if count < FEWEST:
        return float("nan")
    square = np.square(points).sum(axis=1)
    apart = square[:, None] + square[None] - 2 * points @ points.T
    distance = np.sqrt(np.maximum(apart[np.triu_indices(count, 1)], 0.0))
    if not distance.max() > 0:
        return 0.0
    near, far = np.quantile(distance, [CLOSE, FAR])
    if near <= 1e-9 * distance.max():
        return 0.0
    return float(np.log(FAR / CLOSE) / np.log(far / near))


def named(periods: int, left: float, exponent: float, spread: float, falling: bool) -> Character:
    """The character from how it repeats itself, the largest exponent a period and the dimension; ``falling``: the
    difference was still getting smaller at the end."""
    if periods:
        kind = "periodic" if periods == 1 else "multiple"
        return Character(kind, periods, left, exponent, spread)
    if exponent > REGULAR:
        return Character("chaotic", 0, left, exponent, spread)
    if falling or exponent < -REGULAR or spread > THIN:
        return Character("unsettled", 0, left, exponent, spread)
    return Character("quasi-periodic", 0, left, exponent, spread)
