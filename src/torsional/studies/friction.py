"""A friction washer in the clutch: the answer of a line with it over speed, and the friction that a limit needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

from torsional.components import Coupling
from torsional.errors import ModelError, nearest
from torsional.laws import Jenkins
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.periodic.branches import Branch
from torsional.solvers.periodic.states import states
from torsional.studies.answers import by_idle, main_order, mean_torque, mode_of, modes
from torsional.studies.motions import over_speed
from torsional.studies.strongest import crest
from torsional.studies.trucks import joined, replaced
from torsional.units import RPM

WASHER = "clutch_friction"
STICKING = 1e5
"""Stiffness of a washer that sticks [Nm/rad], four times the shipped clutch damper's."""
AROUND, ABOUT = (600 * RPM, 1000 * RPM), (0.92, 1.3)
"""Speeds among which the clutch's resonance of the shipped truck is sought, and the least window over the clutch mode's
order speed."""
ORDERS = 9.0
"""Highest order: the third and its next multiples."""


@lru_cache(maxsize=8)
def clutch_speed(model: Model) -> float:
    """Order speed [rad/s] of the mode that lives in the clutch; raises ModelError where that lies beyond the range."""
    found = modes(model)
    speed = float(found.order_speed[mode_of(found, model.landmarks.clutch)])
    if speed > model.operation.speed[1]:
        told = {"found": f"clutch mode met at {speed / RPM:.0f} rpm", "remedy": "give the clutch a damper with springs"}
        problem = "no resonance in the range twists the clutch, so its friction limits none"
        raise ModelError(problem, where="clutch", **told)
    return speed


def around(model: Model) -> tuple[float, float]:
    """Speeds [rad/s] among which the resonance of a truck is sought: they follow idle, and hold the clutch mode."""
    low, high = (share * clutch_speed(model) for share in ABOUT)
    return float(min(by_idle(model, AROUND[0]), low)), float(max(by_idle(model, AROUND[1]), high))


def washed(model: Model, torque: float, viscous: float = 1.0, sticking: float = STICKING) -> Model:
    """A copy with a friction washer [Nm] beside the clutch damper, whose viscous damping is multiplied."""
    name = model.landmarks.clutch
    clutch: Any = model.components[name]
    model = replaced(model, name, damping=viscous * clutch.damping)
    return model if not torque else joined(model, **{WASHER: Coupling(clutch.a, clutch.b, Jenkins(torque, sticking))})


@dataclass(frozen=True)
class Curve:
    """Amplitude [rad/s²] of the firing order at the input and the washer's mean power [W] over speed [rad/s]."""

    speed: Array
    amplitude: Array
    power: Array

    @property
    def peak(self) -> tuple[float, float]:
        """The largest amplitude and its speed, between the points by a parabola."""
        top = int(np.clip(self.amplitude.argmax(), 1, self.speed.size - 2))
        three = slice(top - 1, top + 2)
        at = crest(self.speed[three], self.amplitude[three])
        at = float(np.clip(at, *self.speed[[top - 1, top + 1]]))
        return float(np.polyval(np.polyfit(self.speed[three] - at, self.amplitude[three], 2), 0.0)), at

    def at(self, speed: float, values: Array) -> float:
        """A value between the points."""
        return float(np.interp(speed, self.speed, values))


def curve(model: Model, branch: Branch, element: str = WASHER) -> Curve:
    """Amplitude and power, of the ``element`` that rubs, along a branch."""
    told, system, speed = states(branch.problem, branch.scaled), branch.problem.setting.split.system, branch.values
    place = round(main_order(model) / branch.base_order)
    input_angle = told.angle[:, place, system.node_index(model.landmarks.input)]
    names = system.connections.names
    if element not in names:
        raise ModelError("the clutch has no such friction", where=element, remedy=nearest(element, names))
    washer = names.index(element)
    omega = np.multiply.outer(speed, branch.base_order * np.arange(told.twist.shape[1]))
    rate = 1j * omega * told.twist[:, :, washer]
    power = 0.5 * (told.torque[:, :, washer] * rate.conj()).real.sum(axis=1)
    return Curve(speed, np.abs(input_angle) * (main_order(model) * speed) ** 2, power)


def answered(model: Model, speed: tuple[float, float], element: str = WASHER) -> Curve:
    """The answer over a range of speed [rad/s], pieced together of all branches by rising speed.

    A washer that sticks holds any mean torque, so that branches may end where it comes to stick; the vibration is the
    same on the one that goes on.  Raises ModelError where no branch reaches an end of the range.
    """
    explorer = over_speed(model, speed, mean_torque(model), depth=0, highest_order=ORDERS)
    parts = [curve(model, branch, element) for branch in explorer.branches]
    at = np.concatenate([part.speed for part in parts])
    rise = np.argsort(at)
    if at[rise[0]] > speed[0] * 1.001 or at[rise[-1]] < speed[1] * 0.999:
        found = f"{at.min() / RPM:.0f} to {at.max() / RPM:.0f} rpm"
        raise ModelError("the motions do not span the range", where="speed", found=found)
    return Curve(
        at[rise],
        np.concatenate([part.amplitude for part in parts])[rise],
        np.concatenate([part.power for part in parts])[rise],
    )


def least_torque(excess: Callable[[float], float], low: float, high: float) -> float:
    """The friction torque [Nm] between two at which ``excess``, an amplitude over its limit, comes to zero.

    0 where the low one is enough already, infinite where the high one is not.
    """
    if excess(low) <= 0:
        return 0.0
    return float(brentq(excess, low, high, xtol=0.05)) if excess(high) < 0 else float("inf")
