"""Which parameters measured data tell, and which combinations of them they cannot."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array

NAMED = 0.25
"""Share in a combination from which on a parameter is named with it."""
UNTOLD = 0.5
"""Standard deviation, over the scales of the parameters, from which on a combination counts as not told by the data."""


class Way(NamedTuple):
    """A combination of parameters over their scales, of length one: the ``share`` of each by name, and its standard
    ``deviation`` in those scales."""

    share: dict[str, float]
    deviation: float

    @property
    def untold(self) -> bool:
        """Whether the data leave it open."""
        return not self.deviation < UNTOLD

    @property
    def words(self) -> str:
        """The combination by the parameters' names, the largest share first: those that move together keep their sign.

        >>> Way({"stiffness": 0.7, "clearance": -0.71, "damping": 0.05}, 2.0).words
        '-0.71 clearance + 0.70 stiffness'
        """
        named = [pair for pair in self.share.items() if abs(pair[1]) >= NAMED]
        named.sort(key=lambda pair: -round(abs(pair[1]), 6))
        text = " ".join(f"{'-' if part < 0 else '+'} {abs(part):.2f} {name}" for name, part in named)
        return text[2:] if text.startswith("+") else "-" + text[2:]


def ways(rows: Array, deviations: Array, names: tuple[str, ...]) -> tuple[Way, ...]:
    """The principal combinations of parameters, the least known first, from the right singular vectors (in ``rows``) of
    the slopes over scaled parameters and the standard ``deviations`` along them.

    Å. Björck, Numerical Methods for Least Squares Problems, 1996, § 1.4.

    >>> _, strength, rows = np.linalg.svd(np.array([[1.0, 1.0], [2.0, 2.5]]))
    >>> [(way.words, way.untold) for way in ways(rows, 0.1 / strength, ("a", "b"))]
    [('0.77 a - 0.64 b', True), ('0.77 b + 0.64 a', False)]
    """
    signs = np.sign(np.round(rows.sum(axis=1), 9))
    signs = np.where(signs == 0.0, np.sign(rows[:, -1]), signs)
    told = [
        Way(dict(zip(names, (sign * row).tolist(), strict=True)), float(deviation))
        for sign, row, deviation in zip(signs, rows, deviations, strict=True)
    ]
    return tuple(sorted(told, key=lambda way: -way.deviation))
