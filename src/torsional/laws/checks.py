"""Checks of the values of laws; the messages name the field."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array


def breakaway_above_sliding(sliding: float, breakaway: float) -> None:
    """Refuse a breakaway torque that is below the sliding torque."""
    if not sliding <= breakaway < math.inf:
        allowed = f"at least the sliding torque, {sliding:g} Nm"
        raise ModelError(
            "must not be below sliding", where="breakaway_torque", found=f"{breakaway:g} Nm", allowed=allowed
        )


def rising_points(points: Sequence[tuple[float, float]]) -> tuple[Array, Array]:
    """Angles [rad] and torques [Nm] of two or more points; refused unless the angles rise and no torque falls."""
    rows = np.asarray(points, dtype=float)
    if rows.ndim != 2 or rows.shape[0] < 2 or rows.shape[1] != 2 or not np.isfinite(rows).all():
        found = f"{len(points)} of them"
        raise ModelError("two points or more are wanted, each an angle and a torque", where="points", found=found)
    angles, torques = rows.T
    for i in np.flatnonzero((np.diff(angles) <= 0) | (np.diff(torques) < 0))[:1]:
        found = f"({angles[i + 1]:g} rad, {torques[i + 1]:g} Nm) after ({angles[i]:g} rad, {torques[i]:g} Nm)"
        problem = "points are listed with rising angles, and torques that do not fall"
        raise ModelError(problem, where="points", found=found)
    return angles, torques
