"""Where sub-harmonic vibration is strongest over speed and mean torque, and where it begins over the stiffness step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.periodic.branches import Branch
from torsional.studies.motions import amplitudes, doubled, doubling_margin, over_torque
from torsional.units import RPM

HIGHEST_ORDER = 12.0
"""Half orders beyond it change the largest amplitudes by less than 0.01 %."""
STEP, NEAR = 12 * RPM, 0.5 * RPM
REFINEMENTS = 3
TO = 20.0
"""How closely [Nm/rad] an onset is located."""


@dataclass(frozen=True)
class Peak:
    """A largest amplitude, and the speed [rad/s] and mean torque [Nm] at which it occurs."""

    amplitude: float
    speed: float
    torque: float


@dataclass(eq=False)
class Search:
    """Largest amplitudes of half the firing order over speed and mean torque.

    At each speed branches are followed over the mean torque, through their folds, so that motions that are isolated
    over speed are met too; over speed the largest is climbed to and taken from parabolas.  ``torques``: mean torques
    [Nm] between which it is looked for, ``first_look``: speeds [rad/s] from the highest of which it climbs where
    neither a speed near by nor one that was seen has any.
    """

    model: Model
    order: float
    torques: tuple[float, float]
    first_look: Array
    seen: dict[float, Array] = field(default_factory=dict)

    def at(self, speed: float) -> Array:
        """Largest amplitudes of the quantities (4,) and their mean torques (4,) at one speed, as (2, 4)."""
        if speed not in self.seen:
            explorer = over_torque(self.model, speed, self.torques, highest_order=HIGHEST_ORDER)
            best = np.zeros((2, 4))
            for branch in doubled(explorer):
                found = _crests(branch, amplitudes(self.model, branch, self.order))
                best = np.where(found[0] > best[0], found, best)
            self.seen[speed] = best
        return self.seen[speed]

    def peak(self, quantity: int, near: float | None = None) -> Peak:
        """The largest amplitude of one quantity, sought uphill from a speed ``near`` it."""

        def size(speed: float) -> float:
            return float(self.at(speed)[0, quantity])

        top = self._climbed(size, near)
        for _ in range(REFINEMENTS):
            speeds = sorted(self.seen)
            place = speeds.index(top)
            three = np.array(speeds[place - 1 : place + 2])
            vertex = float(crest(three, np.array([size(speed) for speed in three])))
            if np.abs(three - vertex).min() < NEAR:
                break
            top = max(top, vertex, key=size)
        amplitude, torque = self.at(top)[:, quantity]
        return Peak(float(amplitude), top, float(torque))

    def _climbed(self, size: Callable[[float], float], near: float | None) -> float:
        """A speed that is higher than those a step below and above."""
        known = sorted({*self.seen} if near is None else {*self.seen, near})
        top = max(known, key=size, default=0.0)
        if not known or not size(top):
            top = max(map(float, self.first_look), key=size)
        while max(size(top - STEP), size(top + STEP)) > size(top):
            top = max(top - STEP, top + STEP, key=size)
        return max((speed for speed in self.seen if abs(speed - top) <= STEP), key=size)


def crest(at: Array, values: Array) -> float:
    """Where the parabola through three values is highest; in the middle where they are alike.

    >>> crest(np.array([1.0, 2.0, 3.0]), np.array([0.0, 3.0, 2.0])), crest(np.array([1.0, 2.0, 3.0]), np.zeros(3))
    (2.25, 2.0)
    """
    if np.ptp(values) == 0:
        return float(at[1])
    curved, slope, _ = np.polyfit(at - at[1], values, 2)
    return float(at[1] - 0.5 * slope / curved)


def _crests(branch: Branch, values: Array) -> Array:
    """Largest values (q,) along a branch between its points, and the parameter there, as (2, q)."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(branch.scaled, axis=0), axis=1))])
    kept = np.concatenate([[True], np.diff(way) > 1e-9])
    way, values, parameter = way[kept], values[:, kept], branch.values[kept]
    if way.size < 4:
        return np.array([values.max(axis=1), parameter[values.argmax(axis=1)]])
    curve, along = CubicSpline(way, values, axis=1), CubicSpline(way, parameter)
    best = []
    for row, top in enumerate(values.argmax(axis=1)):
        fine = np.linspace(way[max(top - 1, 0)], way[min(top + 1, way.size - 1)], 201)
        heights = curve(fine)[row]
        best.append((heights.max(), along(fine[heights.argmax()])))
    return np.array(best).T


class Onset(NamedTuple):
    """The ``difference`` of the stiffnesses [Nm/rad] below which no motion doubles its period, and the ``speed``
    [rad/s] at which one does first."""

    difference: float
    speed: float


def onset(search: Callable[[float], Search], low: float, high: float) -> Onset:
    """Where doubled periods begin between two differences [Nm/rad]; ``search``: where to look, given a difference.

    Raises ModelError where none does up to ``high``; at most ``low`` where they begin below it.
    """

    @cache
    def margin(difference: float) -> tuple[float, float]:
        asked = search(difference)

        def least(speed: float) -> float:
            explorer = over_torque(asked.model, speed, asked.torques, depth=0, highest_order=HIGHEST_ORDER)
            lowest = [-_crests(b, -doubling_margin(b)[None])[0, 0] for b in explorer.branches]
            return float(min(lowest))

        step = float(np.diff(asked.first_look).mean())
        best = min(map(float, asked.first_look), key=least)
        found = minimize_scalar(least, bounds=(best - step, best + step), method="bounded", options={"xatol": NEAR})
        return float(found.fun), float(found.x)

    above = 2 * low
    while margin(above)[0] > 0:
        if above >= high:
            remedy = "ask a model with less damping beside the springs, or with a larger step"
            found = f"none up to a difference of {high / 1e3:.3g} kNm/rad"
            raise ModelError("no motion doubles its period", where="stiffness step", found=found, remedy=remedy)
        low, above = above, min(2 * above, high)
    if margin(low)[0] <= 0:
        return Onset(low, margin(low)[1])
    begins = float(brentq(lambda d: margin(d)[0], low, above, xtol=TO))
    return Onset(begins, margin(begins)[1])
