"""Friction without memory that falls from breakaway to sliding: Stribeck's curve, smoothed at rest."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numba
import numpy as np

from torsional.arguments import checked_fields
from torsional.checks import not_negative, positive
from torsional.errors import ModelError
from torsional.laws.base import Law, Told, plain
from torsional.laws.checks import breakaway_above_sliding
from torsional.laws.lugre import stribeck
from torsional.numerics.arrays import Array

LOAD = 4
"""Place of the normal load N among the parameters of `Stribeck`."""


@numba.njit(cache=True, error_model="numpy")
def stribeck_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f(u) = N g(u) u/√(u² + u0²) + c_v u; parameters are g_c, g_s, u_s, u0, N, c_v."""
    curve, d_curve = stribeck(rate, parameters[0], parameters[1], parameters[2])
    load, width, length = parameters[4], parameters[3], math.hypot(rate, parameters[3])
    way, d_way = rate / length, (width / length) ** 2 / length
    drag = load * (d_curve * way + curve * d_way) + parameters[5]
    return plain(load * curve * way + parameters[5] * rate, 0.0, drag)


@dataclass(frozen=True)
@checked_fields
class Stribeck(Law):
    """Friction without memory, f(u) = N g(u) u/√(u² + u0²) + c_v u with g(u) = g_c + (g_s − g_c) exp(−(u/u_s)²).

    Per unit of ``normal_load`` N: ``sliding_torque`` g_c and ``breakaway_torque`` g_s ≥ g_c [Nm], with
    ``stribeck_rate`` u_s [rad/s]; ``grease_damping`` c_v [Nms/rad] does not depend on N.  Below the
    ``regularisation_rate`` u0 [rad/s] it is the damper N g_s/u0 and creeps where real friction sticks (`LuGre` and
    `Karnopp` stick); at u0 = u_s/100 the largest torque is within 1.5 % of breakaway.  After R. Stribeck, Z. VDI 46
    (1902) 1341.  Raises ModelError for values that are negative, or zero where the law divides by them, for g_s < g_c
    and u0 > u_s.

    >>> Stribeck(1.0, 1.5, stribeck_rate=0.1, regularisation_rate=1e-3).torque(0.0, [-10.0, 0.1]).round(4).tolist()
    [-1.0, 1.1839]
    """

    sliding_torque: float
    breakaway_torque: float
    stribeck_rate: float
    regularisation_rate: float
    normal_load: float = 1.0
    grease_damping: float = 0.0

    kernel: ClassVar[Callable[..., Told]] = stribeck_torque
    carries_mean_torque: ClassVar[bool] = False
    load_place: ClassVar[int] = LOAD

    def __post_init__(self) -> None:
        not_negative(self.sliding_torque, "sliding_torque", "torque")
        breakaway_above_sliding(self.sliding_torque, self.breakaway_torque)
        for name in ("stribeck_rate", "regularisation_rate"):
            positive(getattr(self, name), name, "angular_velocity")
        not_negative(self.normal_load, "normal_load", "number")
        not_negative(self.grease_damping, "grease_damping", "damping")
        if self.regularisation_rate > self.stribeck_rate:
            found, allowed = f"{self.regularisation_rate:g} rad/s", f"at most the Stribeck rate, {self.stribeck_rate:g}"
            problem = "the curve would be smoothed away"
            raise ModelError(problem, where="regularisation_rate", found=found, allowed=allowed)

    @property
    def parameters(self) -> Array:
        """g_c, g_s, u_s, u0, N, c_v."""
        curve = (self.sliding_torque, self.breakaway_torque, self.stribeck_rate, self.regularisation_rate)
        return np.array([*curve, self.normal_load, self.grease_damping], dtype=float)

    def stage_name(self, angle: float) -> str:
        """At rest a rubbing part creeps."""
        return "friction"
