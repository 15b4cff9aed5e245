"""Frictionless torque–angle curves of springs and contacts in series and side by side, as straight lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from torsional.laws import Hinges
from torsional.numerics.arrays import Array

_SAME = 1e-12
"""Angles [rad] that differ by less are one."""


class Rising(NamedTuple):
    """A curve of rising torque from its first point on: no torque before, ``slope`` [Nm/rad] beyond the last.

    ``angle`` [rad] and ``torque`` [Nm] of the points; the first torque is zero.
    """

    angle: Array
    torque: Array
    slope: float

    def at_angle(self, angle: Array) -> Array:
        """Torque [Nm] at angles [rad]."""
        beyond = np.maximum(angle - self.angle[-1], 0.0)
        return np.asarray(np.interp(angle, self.angle, self.torque) + self.slope * beyond)

    def at_torque(self, torque: Array) -> Array:
        """Angle [rad] at torques [Nm] of zero and above."""
        beyond = np.maximum(torque - self.torque[-1], 0.0)
        return np.asarray(np.interp(torque, self.torque, self.angle) + beyond / self.slope)

    def moved(self, angle: float) -> Rising:
        """The curve later by an angle [rad]."""
        return self._replace(angle=self.angle + angle)


def pressed(gaps: Sequence[float], stiffnesses: Sequence[float]) -> Rising:
    """One-sided springs between the same two bodies: gaps [rad] and stiffnesses [Nm/rad].

    >>> pressed([0.1, 0.0], [3.0, 1.0]).at_angle(np.array([0.05, 0.2])).round(12).tolist()
    [0.05, 0.5]
    """
    order = np.argsort(gaps)
    gap, stiffness = np.asarray(gaps, dtype=float)[order], np.asarray(stiffnesses, dtype=float)[order]
    torque = np.concatenate([[0.0], np.cumsum(np.cumsum(stiffness[:-1]) * np.diff(gap))])
    return Rising(gap, torque, float(stiffness.sum()))


def in_series(curves: Sequence[Rising]) -> Rising:
    """Curves one behind the other: the torque is the same and the angles add up.

    >>> in_series([pressed([0.1], [2.0]), pressed([0.2], [2.0])]).at_torque(np.array([0.0, 1.0])).round(12).tolist()
    [0.3, 1.3]
    """
    torque = np.unique(np.concatenate([curve.torque for curve in curves]))
    angle = np.sum([curve.at_torque(torque) for curve in curves], axis=0)
    return Rising(angle, torque, 1.0 / sum(1.0 / curve.slope for curve in curves))


def side_by_side(curves: Sequence[Rising]) -> Rising:
    """Curves beside one another: the angle is the same and the torques add up.

    >>> side_by_side([pressed([0.1], [2.0]), pressed([0.2], [2.0])]).at_angle(np.array([0.3])).round(12).tolist()
    [0.6]
    """
    angle = np.unique(np.concatenate([curve.angle for curve in curves]))
    torque = np.sum([curve.at_angle(angle) for curve in curves], axis=0)
    return Rising(angle, torque, sum(curve.slope for curve in curves))


def against_stop(curve: Rising, gap: float, stiffness: float) -> Rising:
    """What a curve still carries beside a stop on its other side, which holds it back below −``gap`` [rad].

    A row built in with preload rests on both tabs: its torque is felt once it has left the one behind.
    """
    if curve.angle[0] >= -gap:
        return curve
    angle = np.unique([*curve.angle, -gap])
    torque = curve.at_angle(angle) - stiffness * np.maximum(-angle - gap, 0.0)
    held = int(np.flatnonzero(torque < 0)[-1])
    if held == len(angle) - 1:
        start = angle[-1] - torque[-1] / curve.slope
        return Rising(np.array([start]), np.zeros(1), curve.slope)
    share = torque[held] / (torque[held] - torque[held + 1])
    start = angle[held] + share * (angle[held + 1] - angle[held])
    return Rising(np.append(start, angle[held + 1 :]), np.append(0.0, torque[held + 1 :]), curve.slope)


def both_ways(drive: Rising, coast: Rising, stops: tuple[float, float]) -> Hinges:
    """A law from the curve of each direction, neither of which may begin before the angle zero; ``stops`` [rad]."""
    hinges = [(side * gap, side, change) for side, curve in ((1.0, drive), (-1.0, coast)) for gap, change in _of(curve)]
    gaps, sides, changes = zip(*hinges, strict=True)
    return Hinges(0.0, gaps, sides, changes, stops)


def _of(curve: Rising) -> list[tuple[float, float]]:
    """Angles at which the stiffness changes, and by how much."""
    joined = np.append(True, np.diff(curve.angle) > _SAME)
    angle, torque = curve.angle[joined], curve.torque[joined]
    slopes = np.append(np.diff(torque) / np.diff(angle), curve.slope)
    changes = np.diff(slopes, prepend=0.0)
    kept = np.abs(changes) > _SAME * np.abs(slopes).max()
    return [(float(a), float(c)) for a, c in zip(angle[kept], changes[kept], strict=True)]
