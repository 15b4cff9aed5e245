"""Friction that sticks inside a band of slow rates and slides outside it, after Karnopp."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numba
import numpy as np
from numba.extending import register_jitable
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import not_negative, positive
from torsional.laws.base import Law, Told
from torsional.laws.checks import breakaway_above_sliding
from torsional.numerics.arrays import Array

LOAD = 5
"""Place of the normal load N among the parameters of `Karnopp`."""


@register_jitable
def most_held(rate: float, sliding: float, breakaway: float, band: float) -> tuple[float, float]:
    """The torque that friction can hold and its derivative by the rate: breakaway in the band, sliding beyond twice it.

    >>> [most_held(u, 1.0, 1.5, 0.01)[0] for u in (0.01, -0.015, 0.02)]
    [1.5, 1.25, 1.0]
    """
    beyond = abs(rate) / band - 1.0
    if beyond <= 0.0:
        return breakaway, 0.0
    if beyond >= 1.0:
        return sliding, 0.0
    return breakaway - (breakaway - sliding) * beyond, -math.copysign((breakaway - sliding) / band, rate)


@numba.njit(cache=True, error_model="numpy")
def karnopp_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f = T + c_v u, T = k ζ⁺ + d (ζ⁺ − ζ)/h with ζ⁺ = ζ + h u, or what keeps T within ±N g(u).

    Parameters are g_c, g_s, D, k, d, N, c_v.
    """
    limit, slope = most_held(rate, parameters[0], parameters[1], parameters[2])
    stiffness, damping, load, grease = parameters[3], parameters[4], parameters[LOAD], parameters[6]
    torque = stiffness * (memory + rate * step) + damping * rate
    along = 1.0 if step == 0.0 else 0.0
    if abs(torque) <= load * limit:
        drag = stiffness * step + damping + grease
        return torque + grease * rate, stiffness * along, drag, stiffness, memory + rate * step, along, step, 1.0
    side = math.copysign(load, torque)
    most, falling = side * limit, side * slope
    whole = stiffness * step + damping
    left, bent = (damping / whole, step / whole) if step > 0.0 else (1.0, 0.0)
    deflection = left * memory + bent * most
    return most + grease * rate, stiffness * along, falling + grease, 0.0, deflection, along, bent * falling, left


@dataclass(frozen=True)
@checked_fields
class Karnopp(Law):
    """Friction with a band of sticking: a stiff bristle that holds up to g(u), and slides at g(u).

    Inside the ``stick_rate`` D [rad/s] it holds the ``breakaway_torque`` g_s [Nm], from twice D on no more than the
    ``sliding_torque`` g_c [Nm]; between them g falls on a straight line, since a jump there has no place in an implicit
    step.  What sticks is ``bristle_stiffness`` k [Nm/rad] and ``bristle_damping`` d [Nms/rad]; the memory is their
    deflection ζ.  Both torques are per unit of ``normal_load`` N; k, d and ``grease_damping`` c_v [Nms/rad] are not.
    Over a step f h u ≥ Δ(k ζ²/2) for every u and h, whatever g and N do: it cannot create energy.

    Karnopp's own law (J. Dyn. Syst. Meas. Control 107 (1985) 100) holds whatever the other torques ask for while
    |u| < D.  The bristle makes that a law of its two ends.  Choose k so stiff that the twist N g_s/k is of no interest,
    d near √(k J) of the inertia that it stops, lest it rings out of the band, and D above the rate Ṫ/k at which rising
    torques bend it; an implicit step h has one solution while h N (g_s − g_c)/D is less than that inertia.  Raises
    ModelError for values that are negative, or zero where the law divides by them, and for g_s < g_c.

    >>> law = Karnopp(1.0, 1.5, stick_rate=0.01, bristle_stiffness=1e3)
    >>> [float(v) for v in law.march([0.0, 0.001, 0.002, 0.02], step=[1.0, 1.0, 1.0, 0.1])[0].round(9)]
    [0.0, 1.0, 1.5, 1.0]
    """

    sliding_torque: float
    breakaway_torque: float
    stick_rate: float
    bristle_stiffness: float
    bristle_damping: float = 0.0
    normal_load: float = 1.0
    grease_damping: float = 0.0

    kernel: ClassVar[Callable[..., Told]] = karnopp_torque
    remembers: ClassVar[bool] = True
    carries_mean_torque: ClassVar[bool] = False
    departs: ClassVar[str] = "slips, where the linear response lets it stick"
    load_place: ClassVar[int] = LOAD

    def __post_init__(self) -> None:
        not_negative(self.sliding_torque, "sliding_torque", "torque")
        breakaway_above_sliding(self.sliding_torque, self.breakaway_torque)
        positive(self.stick_rate, "stick_rate", "angular_velocity")
        positive(self.bristle_stiffness, "bristle_stiffness", "stiffness")
        not_negative(self.bristle_damping, "bristle_damping", "damping")
        not_negative(self.normal_load, "normal_load", "number")
        not_negative(self.grease_damping, "grease_damping", "damping")

    @property
    def parameters(self) -> Array:
        """g_c, g_s, D, k, d, N, c_v."""
        held = (self.sliding_torque, self.breakaway_torque, self.stick_rate)
        bristle = (self.bristle_stiffness, self.bristle_damping)
        return np.array([*held, *bristle, self.normal_load, self.grease_damping], dtype=float)

    def steady(self, rate: ArrayLike) -> Array:
        """Torque [Nm] at a constant rate u [rad/s] that has lasted: N g(u) sgn u + c_v u."""
        u = np.asarray(rate, dtype=float)
        shape = (self.sliding_torque, self.breakaway_torque, self.stick_rate)
        held = [most_held(v, *shape)[0] for v in u.ravel().tolist()]
        return np.asarray(self.normal_load * np.reshape(held, u.shape) * np.sign(u) + self.grease_damping * u)

    def stage_name(self, angle: float) -> str:
        """Under a steady torque it has come to rest."""
        return "sticks"

    def changes_within(self, low: ArrayLike, high: ArrayLike) -> Array:
        """Whether a swing between two angles [rad] makes it slip: half of it is more than N g_s/k."""
        half = 0.5 * (np.asarray(high, dtype=float) - np.asarray(low, dtype=float))
        return np.asarray(half * self.bristle_stiffness > self.normal_load * self.breakaway_torque)
