"""Full-load curve: the largest mean torque over engine speed."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import not_negative, positive
from torsional.engine.orders import BoolArray, FloatArray
from torsional.errors import ModelError
from torsional.units import show_speed


@dataclass(frozen=True)
@checked_fields
class FullLoad:
    """Full-load torque [Nm] over engine speed [rad/s], linear between points, refused outside.

    Raises ModelError for speeds that do not rise, torques below zero, or fewer than two points.

    >>> float(FullLoad((60.0, 100.0), (1300.0, 2500.0))(80.0))
    1900.0
    """

    speeds: tuple[float, ...]
    torques: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("speeds", "torques"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if len(self.speeds) != len(self.torques) or len(self.speeds) < 2:
            found = f"{len(self.speeds)} speeds, {len(self.torques)} torques"
            raise ModelError("two points and more, a torque for each speed", where="full_load", found=found)
        for speed, torque in zip(self.speeds, self.torques, strict=True):
            positive(speed, "full_load", "speed")
            not_negative(torque, "full_load", "torque")
        if any(b <= a for a, b in pairwise(self.speeds)):
            found = ", ".join(f"{speed:g}" for speed in self.speeds)
            raise ModelError("the speeds must rise from point to point", where="full_load", found=f"{found} rad/s")

    def __call__(self, speed: ArrayLike) -> FloatArray:
        """Full-load torque [Nm], in the shape of the speed [rad/s]; ModelError outside the curve."""
        asked = np.asarray(speed, dtype=float)
        outside = ~self.reaches(asked)
        if outside.any():
            raise ModelError(
                "the full-load curve does not reach this speed",
                where="full_load",
                found=show_speed(float(np.atleast_1d(asked)[np.atleast_1d(outside)][0])),
                allowed=f"{show_speed(self.speeds[0])} to {show_speed(self.speeds[-1])}",
            )
        return np.asarray(np.interp(asked, self.speeds, self.torques))

    def reaches(self, speed: ArrayLike) -> BoolArray:
        """Whether the curve has the speeds [rad/s], boolean, in their shape."""
        asked = np.asarray(speed, dtype=float)
        slack = 1e-9 * self.speeds[-1]  # rpm converted to rad/s and back
        return np.asarray((asked >= self.speeds[0] - slack) & (asked <= self.speeds[-1] + slack))

    def allows(self, speed: ArrayLike, torque: ArrayLike) -> BoolArray:
        """Whether torques [Nm] at speeds [rad/s] are at or below the curve, boolean; never where it does not reach."""
        reached = self.reaches(speed)
        most = self(np.where(reached, speed, self.speeds[0]))
        return np.asarray(reached & (np.asarray(torque, dtype=float) <= most * (1.0 + 1e-12)))
