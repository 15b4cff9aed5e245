"""Whether stroboscopic points repeat themselves, in compiled code: as `solvers.transient.character` asks it."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.uncounted import uncounted

APART = 30.0
"""How much better a motion repeats itself after its own period than after fewer."""
NOTHING = 1e-3
"""Share of the tolerance below which a difference is taken for none."""


@uncounted()
def gap_between(points: Array, size: float, longest: int, k: int) -> float:
    """Largest distance of the last ``longest`` points (periods, states) from those k before, over the ``size``."""
    if size == 0.0:
        return 0.0
    most, count = 0.0, points.shape[0]
    for p in range(count - longest, count):
        total = 0.0
        for i in range(points.shape[1]):
            total += (points[p, i] - points[p - k, i]) ** 2
        if not total <= most:
            most = total
    return math.sqrt(most) / size


@uncounted()
def _to_come(points: Array, size: float, longest: int, k: int) -> float:
    """Distance to where the points go if the one from k before falls on by the same ratio; infinite if it does not."""
    count = points.shape[0]
    if count < 2 * longest + k:
        return np.inf
    now, before = gap_between(points, size, longest, k), gap_between(points[: count - longest], size, longest, k)
    return now / (1.0 - (now / before) ** (k / longest)) if now < before else np.inf


@uncounted()
def repeats(points: Array, size: float, longest: int, tolerance: float) -> tuple[int, float]:
    """The fewest periods after which ``points`` (periods, states) repeat themselves, or 0, and what is left of the
    difference over the motion's ``size``.

    The last ``longest`` points must all agree with those k before them, and much better than with those of fewer
    periods before; and so must those still to come if the difference goes on to fall as it does.  What dies away
    slowly, alternating or in a spiral, is near itself after some turns, but has far to go.

    >>> repeats(np.array([[1.0], [2.0]] * 8), 1.0, 4, 1e-9)
    (2, 0.0)
    """
    best = np.inf
    for k in range(1, longest + 1):
        if points.shape[0] < longest + k:
            break
        left = gap_between(points, size, longest, k)
        near = left <= min(tolerance, best / APART)
        certain = k == 1 or left <= NOTHING * tolerance
        if near and (certain or _to_come(points, size, longest, k) <= best / APART):
            return k, left
        best = min(best, left)
    return 0, best
