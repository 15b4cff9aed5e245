"""The angle at which a rising law carries a torque."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array

ITERATIONS = 100
WIDEST = 40
"""Doublings of a microradian that an angle may take."""


def inverted(left: Callable[[Array], tuple[Array, Array]], torque: Array) -> Array:
    """Angles [rad] at which nothing is ``left`` of torques [Nm] (…): Newton's method in a bracket.

    ``left`` tells, at angles (…), what is not carried of each torque, and the slope of what is.

    >>> inverted(lambda angle: (5.0 - 1e3 * angle, np.full_like(angle, 1e3)), np.array([5.0])).tolist()
    [0.005]
    """
    low, high = _bracket(lambda angle: left(angle)[0], torque)
    angle = 0.5 * (low + high)
    for _ in range(ITERATIONS):
        rest, slope = left(angle)
        low, high = np.where(rest > 0, angle, low), np.where(rest < 0, angle, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = angle + rest / slope
        new = np.where((low < newton) & (newton < high), newton, 0.5 * (low + high))
        new = np.where(rest == 0, angle, new)
        if np.all(np.abs(new - angle) <= 1e-14 * np.abs(angle) + 1e-18):
            return new
        angle = new
    return angle


def _bracket(rest: Callable[[Array], Array], torque: Array) -> tuple[Array, Array]:
    """Angles on either side of those at which nothing is left of each torque, doubled until they are."""
    low, high = np.full_like(torque, -1e-6), np.full_like(torque, 1e-6)
    for _ in range(WIDEST):
        short, beyond = rest(high) > 0, rest(low) < 0
        if not (short | beyond).any():
            return low, high
        low, high = np.where(beyond, 2 * low, low), np.where(short, 2 * high, high)
    found = f"{torque[short | beyond].flat[0]:g} Nm"
    raise ModelError("no angle found that carries the mean torque", found=found)
