"""Dry friction: Coulomb's regularised law, and Jenkins' spring and slider."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import not_negative, positive
from torsional.laws.base import Law, Told, plain
from torsional.numerics.arrays import Array
from torsional.units import show


@numba.njit(cache=True, error_model="numpy")
def coulomb_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f(u) = F u / sqrt(u² + u0²); parameters are F, u0."""
    limit, width = parameters[0], parameters[1]
    length = math.hypot(rate, width)
    return plain(limit * (rate / length), 0.0, limit / length * (width / length) ** 2)


@dataclass(frozen=True)
@checked_fields
class Coulomb(Law):
    """Dry friction without memory, f(u) = F u / sqrt(u² + u0²) of the relative rate u.

    ``limit_torque`` F [Nm], reached to within 0.5 % at ten times the ``regularisation_rate`` u0 [rad/s]; below it the
    law is a viscous damper F/u0 and creeps where real friction sticks, so choose u0 well below the rates of
    interest.  After C. A. Coulomb (1785), made smooth.  Raises ModelError unless F ≥ 0 and u0 > 0.

    >>> Coulomb(50.0, regularisation_rate=0.1).torque(0.0, [-10.0, 0.0, 0.1]).round(3).tolist()
    [-49.998, 0.0, 35.355]
    """

    limit_torque: float
    regularisation_rate: float

    kernel: ClassVar[Callable[..., Told]] = coulomb_torque
    carries_mean_torque: ClassVar[bool] = False

    def __post_init__(self) -> None:
        not_negative(self.limit_torque, "limit_torque", "torque")
        positive(self.regularisation_rate, "regularisation_rate", "angular_velocity")

    @property
    def parameters(self) -> Array:
        """F, u0."""
        return np.array([self.limit_torque, self.regularisation_rate], dtype=float)

    def stage_name(self, angle: float) -> str:
        """At rest a rubbing part creeps."""
        return "friction"


@numba.njit(cache=True, error_model="numpy")
def jenkins_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f = k ζ, ζ⁺ = ζ + h u kept within ±F/k; parameters are F, k.  With h = 0 the tangent is that of sticking, k."""
    limit, stiffness = parameters[0], parameters[1]
    deflection = memory + rate * step
    if abs(deflection) * stiffness > limit:
        most = math.copysign(limit, deflection)
        still = stiffness if step == 0.0 else 0.0
        return most, still, 0.0, 0.0, most / stiffness, 0.0, 0.0, 0.0
    along = 1.0 if step == 0.0 else 0.0
    return stiffness * deflection, stiffness * along, stiffness * step, stiffness, deflection, along, step, 1.0


@numba.njit(cache=True, error_model="numpy")
def jenkins_flow(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """ζ̇ = u of a spring that sticks, 0 of one that slides on."""
    slides = parameters[1] * abs(memory) >= parameters[0] and memory * rate > 0.0
    return plain(0.0 if slides else rate, 0.0, 0.0)


@dataclass(frozen=True)
@checked_fields
class Jenkins(Law):
    """A spring in series with a dry slider: a friction washer that sticks elastically, then slips.

    ``limit_torque`` F [Nm] and ``stiffness`` k [Nm/rad]; the memory is the spring's deflection ζ, |ζ| ≤ F/k.  It
    carries no mean torque; linear analyses see it stick.  A cycle of half-width A > F/k loses 4 F (A − F/k).  After
    Jenkins (J. Appl. Mech. 29 (1962) 323).  Raises ModelError unless F ≥ 0 and k > 0.

    >>> washer = Jenkins(50.0, 25e3)
    >>> washer.march([0.0, 0.001, 0.004, 0.003], step=0.01)[0].tolist()
    [0.0, 25.0, 50.0, 25.0]
    """

    limit_torque: float
    stiffness: float

    kernel: ClassVar[Callable[..., Told]] = jenkins_torque
    flow: ClassVar[Callable[..., Told] | None] = jenkins_flow
    remembers: ClassVar[bool] = True
    carries_mean_torque: ClassVar[bool] = False
    departs: ClassVar[str] = "slips, where the linear response lets it stick"

    def __post_init__(self) -> None:
        not_negative(self.limit_torque, "limit_torque", "torque")
        positive(self.stiffness, "stiffness", "stiffness")

    @property
    def parameters(self) -> Array:
        """F, k."""
        return np.array([self.limit_torque, self.stiffness], dtype=float)

    @property
    def label(self) -> str:
        """Its stiffness and the torque it slips at."""
        return f"{show(self.stiffness, 'stiffness')}, slips at {show(self.limit_torque, 'torque')}"

    def stage_name(self, angle: float) -> str:
        """Under a steady torque it has come to rest."""
        return "sticks"

    def changes_within(self, low: ArrayLike, high: ArrayLike) -> Array:
        """Whether a swing between two angles [rad] makes it slip: half of it is more than F/k.

        >>> Jenkins(50.0, 25e3).changes_within([0.1, 0.1], [0.103, 0.105]).tolist()
        [False, True]
        """
        half = 0.5 * (np.asarray(high, dtype=float) - np.asarray(low, dtype=float))
        return np.asarray(half * self.stiffness > self.limit_torque)
