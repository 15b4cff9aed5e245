"""Mean speed over time: the frame that the deviations are counted from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked, checked_fields
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.solvers.transient.profiles import Level, level_of


@dataclass(frozen=True)
@checked_fields
class SpeedProfile:
    """Mean engine speed [rad/s], linear between ``times`` [s] and constant beyond.

    Deviations are counted from it.  Where it changes, an ideal drive is meant: the acceleration of the frame itself
    takes no torque.  For a run-up by the engine's own torque keep it constant and let the deviation grow.
    Raises ModelError for times that do not rise.

    >>> SpeedProfile.ramp(60.0, 160.0, 10.0).at(2.5)
    array(85.)
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("times", "speeds"):
            object.__setattr__(self, name, tuple(float(v) for v in np.atleast_1d(getattr(self, name))))
        level_of(self.times, self.speeds, "speed")

    @classmethod
    @checked
    def constant(cls, speed: float) -> SpeedProfile:
        """One speed [rad/s]."""
        return cls((0.0,), (float(speed),))

    @classmethod
    @checked
    def ramp(cls, start: float, end: float, duration: float, begin: float = 0.0) -> SpeedProfile:
        """From one speed [rad/s] to another within ``duration`` [s], beginning at ``begin`` [s]."""
        if not duration > 0:
            raise ModelError("a ramp takes some time", where="duration", found=f"{duration:g} s")
        return cls((begin, begin + duration), (start, end))

    @property
    def level(self) -> Level:
        """The same as knots."""
        return Level(np.array(self.times), np.array(self.speeds))

    @property
    def range(self) -> tuple[float, float]:
        """Lowest and highest speed [rad/s]."""
        return min(self.speeds), max(self.speeds)

    def at(self, time: ArrayLike) -> Array:
        """Speed [rad/s] at times [s]."""
        return self.level.at(time)

    @cached_property
    def _knots(self) -> Array:
        """Angles [rad] turned at the knots, from the first one on."""
        knots = self.level
        return np.append(0.0, np.cumsum(np.diff(knots.time) * 0.5 * (knots.value[1:] + knots.value[:-1])))

    def angle(self, time: ArrayLike) -> Array:
        """Angle [rad] turned since the time zero, ∫ Ω dt, exactly.

        >>> SpeedProfile.ramp(60.0, 160.0, 10.0).angle(10.0)
        array(1100.)
        """
        return np.asarray(self._since(np.asarray(time, dtype=float)) - self._since(np.zeros(())))

    def _since(self, t: Array) -> Array:
        """Angle turned since the first knot."""
        knots = self.level
        piece = np.clip(np.searchsorted(knots.time, t, "right") - 1, 0, len(knots.time) - 1)
        return np.asarray(self._knots[piece] + (t - knots.time[piece]) * 0.5 * (self.at(t) + knots.value[piece]))

    def crossings(self, speeds: Array) -> Array:
        """Times [s] of the knots and of all passages of some ``speeds`` [rad/s] between them, rising."""
        knots, found = self.level, [np.array(self.times)]
        for i in range(len(knots.time) - 1):
            low, high = knots.value[i : i + 2]
            if low != high:
                share = (speeds - low) / (high - low)
                found.append(knots.time[i] + share[(share > 0) & (share < 1)] * (knots.time[i + 1] - knots.time[i]))
        return np.unique(np.concatenate(found))


def as_speed(speed: float | SpeedProfile) -> SpeedProfile:
    """A speed [rad/s] as a profile."""
    return speed if isinstance(speed, SpeedProfile) else SpeedProfile.constant(speed)
