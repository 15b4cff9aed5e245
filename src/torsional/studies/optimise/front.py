"""What is best among designs: the Pareto front, its ends and its knee."""

from __future__ import annotations

import numpy as np

from torsional.numerics.arrays import Array, IntArray

SAME = 1e-4
"""Over their size, by what objectives are equal: searches from several starts end at one design more than once."""


def front(goals: Array) -> IntArray:
    """Places of the designs (designs, objectives) that no other one betters, by rising first objective; equals once.

    >>> front(np.array([[1.0, 3.0], [2.0, 2.0], [2.0, 3.0], [0.0, 4.0], [2.0, 2.0]])).tolist()
    [3, 0, 1]
    """
    order = np.lexsort(goals.T[::-1])
    kept: list[int] = []
    for place in order:
        mine = goals[kept]
        if not (mine <= goals[place] + SAME * abs(goals[place])).all(axis=1).any():
            kept.append(int(place))
    return np.array(kept, dtype=np.int64)


def knee(goals: Array) -> int:
    """Place of the knee of a front (designs, objectives): least sum of objectives scaled from the front's best, 0, to
    its worst, 1.

    On two objectives that is the point farthest from the line through both ends (Das, Struct. Optim. 18 (1999) 107); a
    front that bulges the other way has its knee at an end.

    >>> knee(np.array([[0.0, 1.0], [0.2, 0.3], [1.0, 0.0]]))
    1
    """
    span = np.ptp(goals, axis=0)
    scaled = (goals - goals.min(axis=0)) / np.where(span > 0, span, 1.0)
    return int(scaled.sum(axis=1).argmin())
