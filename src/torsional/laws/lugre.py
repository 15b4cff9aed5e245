"""LuGre friction: bristles that bend, slide and have a Stribeck curve."""
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
from torsional.laws.base import Law, Told, plain
from torsional.laws.checks import breakaway_above_sliding
from torsional.numerics.arrays import Array

LOAD = 6
"""Place of the normal load N among the parameters of `LuGre`: the one that may change while the law is at work."""

_SERIES = 0.5
_TERMS = 14


@register_jitable
def stribeck(rate: float, sliding: float, breakaway: float, width: float) -> tuple[float, float]:
    """g(u) = g_c + (g_s − g_c) exp(−(u/u_s)²) and its derivative: friction between breakaway g_s and sliding g_c.

    >>> stribeck(0.0, 1.0, 1.5, 0.001)[0]
    1.5
    """
    u = rate / width
    raised = (breakaway - sliding) * math.exp(-u * u)
    return sliding + raised, -2.0 * u / width * raised


@register_jitable
def fading(x: float) -> tuple[float, float, float]:
    """e^−x, φ1(x) = (1 − e^−x)/x and dφ1/dx, for x ≥ 0; by their series where x is small.

    >>> fading(0.0)
    (1.0, 1.0, -0.5)
    """
    left = math.exp(-x)
    if x >= _SERIES:
        mean = (1.0 - left) / x
        return left, mean, (left - mean) / x
    mean, slope, term = 1.0, 0.0, 1.0  # φ1 = Σ (−x)^n/(n+1)!
    for n in range(1, _TERMS):
        slope += -n * term / (n + 1)
        term *= -x / (n + 1)
        mean += term
    return left, mean, slope


@register_jitable
def _forgetting(parameters: Array, rate: float) -> tuple[float, float]:
    """a = σ0 |u|/g(u) [1/s], at which the bristles forget how they are bent, ż = u − a z; and its derivative by u."""
    curve, d_curve = stribeck(rate, parameters[3], parameters[4], parameters[5])
    a = parameters[0] * abs(rate) / curve
    return a, (math.copysign(parameters[0], rate) - a * d_curve) / curve if rate != 0.0 else 0.0


@numba.njit(cache=True, error_model="numpy")
def lugre_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """The state after a step h with rate u and z before it: parameters σ0, σ1, σ2, g_c, g_s, u_s, N, c_v.

    x = h a, z⁺ = e^−x z + h φ1(x) u, ż⁺ = e^−x (u − a z), f = N (σ0 z⁺ + σ1 ż⁺ + σ2 u) + c_v u.
    """
    s0, s1, s2, load = parameters[0], parameters[1], parameters[2], parameters[LOAD]
    a, d_a = _forgetting(parameters, rate)
    left, mean, d_mean = fading(a * step)
    flow = rate - a * memory
    bent = left * memory + step * mean * rate
    d_bent = step * (mean + d_a * (step * d_mean * rate - left * memory))
    d_flow = left * (1.0 - d_a * (memory + step * flow))
    torque = load * (s0 * bent + s1 * left * flow + s2 * rate) + parameters[7] * rate
    d_rate = load * (s0 * d_bent + s1 * d_flow + s2) + parameters[7]
    along = 1.0 if step == 0.0 else 0.0
    return torque, load * s0 * along, d_rate, load * left * (s0 - s1 * a), bent, along, d_bent, left


@numba.njit(cache=True, error_model="numpy")
def lugre_flow(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """ż = u − a z."""
    return plain(rate - _forgetting(parameters, rate)[0] * memory, 0.0, 0.0)


@dataclass(frozen=True)
@checked_fields
class LuGre(Law):
    """Friction of bristles: ż = u − σ0 |u| z/g(u), f = N (σ0 z + σ1 ż + σ2 u) + c_v u.

    Per unit of ``normal_load`` N (one number without unit, default 1): ``bristle_stiffness`` σ0 [Nm/rad],
    ``bristle_damping`` σ1 [Nms/rad], ``sliding_torque`` g_c [Nm], ``breakaway_torque`` g_s ≥ g_c [Nm], reached by
    g(u) = g_c + (g_s − g_c) exp(−(u/u_s)²) with ``stribeck_rate`` u_s [rad/s], ``viscous_damping`` σ2 [Nms/rad].
    ``grease_damping`` c_v [Nms/rad] does not depend on N.  The memory is the bristles' deflection z [rad].  After
    Canudas de Wit, Olsson, Åström, Lischinsky (IEEE Trans. Autom. Control 40 (1995) 419).  Raises ModelError for
    values that are negative, or zero where the law divides by them, and for g_s < g_c.

    >>> law = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)
    >>> round(float(law.steady(0.001)), 10)
    1.1843397206
    """

    bristle_stiffness: float
    bristle_damping: float
    sliding_torque: float
    breakaway_torque: float
    stribeck_rate: float
    viscous_damping: float = 0.0
    normal_load: float = 1.0
    grease_damping: float = 0.0

    kernel: ClassVar[Callable[..., Told]] = lugre_torque
    flow: ClassVar[Callable[..., Told] | None] = lugre_flow
    remembers: ClassVar[bool] = True
    carries_mean_torque: ClassVar[bool] = False
    departs: ClassVar[str] = "slips, where the linear response lets it stick"
    load_place: ClassVar[int] = LOAD

    def __post_init__(self) -> None:
        positive(self.bristle_stiffness, "bristle_stiffness", "stiffness")
        positive(self.sliding_torque, "sliding_torque", "torque")
        positive(self.stribeck_rate, "stribeck_rate", "angular_velocity")
        for name in ("bristle_damping", "viscous_damping", "grease_damping"):
            not_negative(getattr(self, name), name, "damping")
        not_negative(self.normal_load, "normal_load", "number")
        breakaway_above_sliding(self.sliding_torque, self.breakaway_torque)

    @property
    def parameters(self) -> Array:
        """σ0, σ1, σ2, g_c, g_s, u_s, N, c_v."""
        bristles = (self.bristle_stiffness, self.bristle_damping, self.viscous_damping)
        curve = (self.sliding_torque, self.breakaway_torque, self.stribeck_rate)
        return np.array([*bristles, *curve, self.normal_load, self.grease_damping], dtype=float)

    def steady(self, rate: ArrayLike) -> Array:
        """Torque [Nm] at a constant rate u [rad/s] that has lasted: N (g(u) sgn u + σ2 u) + c_v u."""
        u = np.asarray(rate, dtype=float)
        shape = (self.sliding_torque, self.breakaway_torque, self.stribeck_rate)
        curve = [stribeck(v, *shape)[0] for v in u.ravel().tolist()]
        dry = np.sign(u) * np.reshape(curve, u.shape)
        return np.asarray(self.normal_load * (dry + self.viscous_damping * u) + self.grease_damping * u)

    def coefficient(self, rate: ArrayLike, step: ArrayLike) -> Array:
        """∂f/∂u [Nms/rad] with the rate in a(u) and x held, N (σ0 h φ1 + σ1 e^−x + σ2) + c_v: positive for every u, h.

        A time step that solves for u holds it so: the torque is then a straight line in u, and rises.
        """
        u, h = np.broadcast_arrays(np.asarray(rate, dtype=float), np.asarray(step, dtype=float))
        s0, s1, s2 = self.bristle_stiffness, self.bristle_damping, self.viscous_damping
        out, parameters = np.empty(u.shape), self.parameters
        for i in np.ndindex(u.shape):
            left, mean, _ = fading(_forgetting(parameters, float(u[i]))[0] * float(h[i]))
            out[i] = self.normal_load * (s0 * float(h[i]) * mean + s1 * left + s2) + self.grease_damping
        return out

    def stage_name(self, angle: float) -> str:
        """Under a steady torque it has come to rest."""
        return "sticks"

    def changes_within(self, low: ArrayLike, high: ArrayLike) -> Array:
        """Whether a swing between two angles [rad] makes the bristles slide: half of it is more than g_c/σ0."""
        half = 0.5 * (np.asarray(high, dtype=float) - np.asarray(low, dtype=float))
        return np.asarray(half * self.bristle_stiffness > self.sliding_torque)
