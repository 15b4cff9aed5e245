"""One-sided contacts with a contact time: lash, stops and springs that only push."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ClassVar

import numba
import numpy as np

from torsional.arguments import checked, checked_fields
from torsional.checks import not_negative, positive
from torsional.errors import ModelError
from torsional.laws.base import Law, Told, plain
from torsional.laws.rows import HingeRows
from torsional.numerics.arrays import Array
from torsional.numerics.hinge import depth

DAMPERS = ("held", "cut", "limited")
"""The numbers 0, 1, 2 of ``damper`` in the parameters."""


@numba.njit(cache=True, error_model="numpy")
def contacts_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f(φ, φ̇) = Σ s max(0, k (s (φ − g) + τ s φ̇)); parameters are the damper's number, then rows of (g, s, k, τ)."""
    torque, tangent, drag = 0.0, 0.0, 0.0
    for i in range(1, parameters.size, 4):
        side, stiffness, time = parameters[i + 1], parameters[i + 2], parameters[i + 3]
        beyond = depth(angle, 0.0, parameters[i], side, 0.0)
        pressed = depth(angle, rate, parameters[i], side, time)
        if parameters[0] == 2.0 and pressed > 2.0 * beyond > 0.0:
            torque += 2.0 * side * stiffness * beyond
            tangent += 2.0 * stiffness
        elif (beyond if parameters[0] == 1.0 else pressed) > 0.0 and (beyond > 0.0 or parameters[0] < 2.0):
            torque += side * stiffness * pressed
            tangent += stiffness
            drag += stiffness * time
    return plain(torque, tangent, drag)


@dataclass(frozen=True)
@checked_fields
class Contacts(Law):
    """One-sided springs, each with a damper: f(φ, φ̇) = Σ_i s_i max(0, k_i (s_i (φ − g_i) + τ_i s_i φ̇)).

    Each contact has a gap g [rad], a side s = ±1 towards which it closes, a stiffness k [Nm/rad] and a contact time
    τ = c/k [s] of its damping c.  ``stops`` names the angles [rad] that are end stops.  It never pulls, and the torque
    is continuous: the damper begins to press at the distance τ φ̇ before the gap is used up.  With ``damper`` "cut" the
    damper acts only beyond the gap, f_i = s_i k_i (s_i (φ − g_i) + τ_i s_i φ̇) there and nothing elsewhere: the torque
    then jumps at both ends of a contact, pulls before it opens, and a time step loses its order.  Both leave a mass
    that meets a free contact with the same speed, see `contact_time`.  With "limited" the damper gives no more than the
    spring, f_i = s_i max(0, min(2 k_i x, k_i (x + τ_i ẋ))) at the depth x = s_i (φ − g_i) > 0, as ElastoBacklash of the
    Modelica Standard Library has it: continuous, it never pulls, and takes less.  Raises ModelError for values that are
    not finite, k ≤ 0, τ < 0, sides other than ±1.

    >>> law = Contacts.lash(0.02, 1e5, contact_time=1e-4)
    >>> law.torque([0.0, 0.011, -0.011], [3.0, 0.0, -50.0]).round(6).tolist()
    [0.0, 100.0, -600.0]
    """

    gaps: tuple[float, ...]
    sides: tuple[float, ...]
    stiffnesses: tuple[float, ...]
    contact_times: tuple[float, ...]
    stops: tuple[float, ...] = field(default=())
    damper: str = "held"

    kernel: ClassVar[Callable[..., Told]] = contacts_torque

    def __post_init__(self) -> None:
        columns = (self.gaps, self.sides, self.stiffnesses, self.contact_times)
        if not self.gaps or len({len(column) for column in columns}) > 1:
            raise ModelError("a contact needs a gap, a side, a stiffness and a contact time", found=repr(self))
        if not np.isfinite(np.array(columns, dtype=float)).all() or any(s not in (-1.0, 1.0) for s in self.sides):
            raise ModelError("contacts need finite values and sides of +1 or -1", found=repr(self))
        for i, (stiffness, time) in enumerate(zip(self.stiffnesses, self.contact_times, strict=True)):
            positive(stiffness, f"stiffnesses.{i}", "stiffness")
            not_negative(time, f"contact_times.{i}", "time")
        if self.damper not in DAMPERS:
            raise ModelError("there is no such damper", where="damper", found=self.damper, allowed=", ".join(DAMPERS))

    @classmethod
    @checked
    def lash(cls, play: float, stiffness: float, contact_time: float = 0.0, *, damper: str = "held") -> Contacts:
        """Free play of a whole angle ``play`` [rad], half to each side, between flanks of one ``stiffness`` [Nm/rad].

        >>> Contacts.lash(0.02, 1e5).gaps
        (0.01, -0.01)
        """
        not_negative(play, "play", "relative_angle")
        half = 0.5 * float(play)
        return cls((half, -half), (1.0, -1.0), (stiffness,) * 2, (contact_time,) * 2, damper=damper)

    @classmethod
    @checked
    def between(
        cls, low: float, high: float, stiffness: float, contact_time: float = 0.0, *, damper: str = "held"
    ) -> Contacts:
        """End stops at two angles [rad]; raises ModelError unless ``low`` is below ``high``.

        >>> Contacts.between(-0.5, 0.75, 1e6).distance_to_stop(0.25, torque=1.0)
        0.5
        """
        if not low < high:
            raise ModelError("the lower stop is below the upper", where="low, high", found=f"{low:g}, {high:g} rad")
        ends = (float(high), float(low))
        return cls(ends, (1.0, -1.0), (stiffness,) * 2, (contact_time,) * 2, stops=(ends[1], ends[0]), damper=damper)

    @property
    def parameters(self) -> Array:
        """The damper's number, then (gap, side, stiffness, contact time) of every contact."""
        rows = np.array([self.gaps, self.sides, self.stiffnesses, self.contact_times], dtype=float)
        return np.concatenate([[float(DAMPERS.index(self.damper))], rows.T.ravel()])

    def hinges(self) -> HingeRows | None:
        """One hinge a contact, with its contact time; None with a damper that makes it no sum of hinges."""
        if self.damper != "held":
            return None
        columns = (self.gaps, self.sides, self.stiffnesses, self.contact_times)
        return HingeRows(0.0, *(np.array(column, dtype=float) for column in columns))

    @property
    def unguarded_stiffness(self) -> float:
        """The largest stiffness [Nm/rad] where the damper is no hinge's."""
        return 0.0 if self.damper == "held" else max(self.stiffnesses)

    @property
    def edges(self) -> Array:
        """Angles [rad] at which a contact opens or closes, at rest."""
        return np.unique(self.gaps)

    def stage_name(self, angle: float) -> str:
        """Which part an angle [rad] lies in: free play, contact, stop.

        >>> [Contacts.between(-0.5, 0.7, 1e6).stage_name(x) for x in (0.0, 0.8)]
        ['free play', 'stop']
        """
        closed = [g for g, s in zip(self.gaps, self.sides, strict=True) if s * (angle - g) > 0]
        if any(stop in closed for stop in self.stops):
            return "stop"
        return "contact" if closed else "free play"

    def distance_to_stop(self, angle: float, torque: float) -> float:
        """The way [rad] left to the stop on the side of the torque: zero in it, not a number without one."""
        way = 1.0 if torque >= 0 else -1.0
        ahead = [g for g, s in zip(self.gaps, self.sides, strict=True) if s == way and g in self.stops]
        return max(min(way * (g - angle) for g in ahead), 0.0) if ahead else float("nan")


@checked
def contact_time(restitution: float, stiffness: float, inertia: float) -> float:
    """The contact time τ [s] at which an ``inertia`` [kgm²] leaves a contact with that share of its speed.

    A half swing of the damped oscillator: e = exp(−π ζ/√(1 − ζ²)), τ = 2 ζ √(J/k).  Raises ModelError unless
    0 < e ≤ 1 and both others are positive.

    >>> round(contact_time(0.8003536403, 1e4, 0.5), 10)
    0.001
    """
    if not 0 < restitution <= 1:
        raise ModelError("restitution is a share of the speed", where="restitution", found=f"{restitution:g}")
    positive(stiffness, "stiffness", "stiffness")
    positive(inertia, "inertia", "inertia")
    lost = -math.log(restitution)
    return 2 * lost / math.hypot(math.pi, lost) * math.sqrt(inertia / stiffness)
