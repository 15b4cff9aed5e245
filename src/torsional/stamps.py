"""Stamps: what a component contributes to the equations, each along one combination w·θ of node angles.

θ: angles [rad] as deviations from the mean rotation; ``GROUND`` is an angle that never moves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.laws import Law

GROUND = "ground"
"""The reserved node that never moves."""

Weights = Mapping[str, float]


@dataclass(frozen=True, slots=True)
@checked_fields
class SpeedSwitch:
    """A second ``inertia`` [kgm²] above a mean ``speed`` [rad/s]; falling, it goes back at speed − ``hysteresis``.

    >>> SpeedSwitch(inertia=0.01, speed=100.0, hysteresis=10.0).above(95.0, rising=False)
    True
    """

    inertia: float
    speed: float
    hysteresis: float = 0.0

    def above(self, speed: float, rising: bool = True) -> bool:
        """Whether the second inertia acts at this mean speed [rad/s]."""
        return speed > (self.speed if rising else self.speed - self.hysteresis)


@dataclass(frozen=True, slots=True)
@checked_fields
class Mass:
    """Kinetic energy ½ J (w·θ̇)² with ``inertia`` J [kgm²], or that of ``switch`` above its speed.

    >>> Mass("planets", {"carrier": -1.0, "ring": 2.0}, 0.01).weights["ring"]
    2.0
    """

    name: str
    weights: Weights
    inertia: float
    switch: SpeedSwitch | None = None


@dataclass(frozen=True, slots=True)
@checked_fields
class NormalLoad:
    """The load that presses two rubbing parts together, N = max(0, constant level(t) + centrifugal Ω² + Σ share |T|).

    ``constant`` [N], times the ``level`` over time of that name where one is named (a clutch that engages; without it,
    and in frequency-domain analyses, one); ``centrifugal`` m r [kg m] times the squared speed of the node ``carrier``
    (default: the reference node); ``shares`` {connection: newtons per Nm of its |torque|}, the torques of springs,
    hinges and dampers.  In time N follows speed and torques at every instant.  A linear analysis takes it at the mean
    torque, and at each mean speed (its damping at standstill); a periodic one at one speed, see `System.loaded`.
    Raises ModelError unless all are finite and some load there is.

    >>> NormalLoad(centrifugal=0.02, shares={"arc1": 0.5}).at(100.0, {"arc1": -40.0})
    220.0
    """

    constant: float = 0.0
    centrifugal: float = 0.0
    shares: Mapping[str, float] | tuple[tuple[str, float], ...] = ()
    carrier: str = ""
    level: str = ""

    def __post_init__(self) -> None:
        shares = tuple((name, float(share)) for name, share in dict(self.shares).items())
        object.__setattr__(self, "shares", shares)
        if not any((self.constant, self.centrifugal, *(share for _, share in shares))):
            raise ModelError("the normal load is nought", where="load", remedy="give constant, centrifugal or shares")

    @property
    def share_of(self) -> dict[str, float]:
        """The shares by connection."""
        return dict(self.shares)

    @property
    def follows(self) -> bool:
        """Whether it changes in time."""
        return bool(self.centrifugal or self.shares or self.level)

    def at(self, speed: float, torque: Mapping[str, float]) -> float:
        """N [N] at a speed [rad/s] of the carrier and torques {connection: Nm}, its level one."""
        pressed = sum(share * abs(torque[name]) for name, share in self.share_of.items())
        return max(0.0, self.constant + self.centrifugal * speed**2 + pressed)


@dataclass(frozen=True, slots=True)
class Swing:
    """The path of a pendulum, whose linear stamps are a mass m c² and a centrifugal stiffness m c² n² beside.

    ``mass`` m [kg], ``distance`` c [m] from the axis, ``curvature_radius`` ρ0 [m] at rest, ``flattening`` λ of the path
    (see `torsional.numerics.motion.pendulum_path`), ``place`` [rad] on the node ``carrier`` from the top.
    """

    carrier: str
    mass: float
    distance: float
    curvature_radius: float
    flattening: float
    place: float = 0.0

    @property
    def path_end(self) -> float:
        """Arc length [m] at which the path ends, as `torsional.absorbers.pendulum.path_end` has it."""
        return math.pi * self.curvature_radius if self.flattening == 0 else self.curvature_radius / self.flattening

    @property
    def centrifugal_stiffness(self) -> float:
        """m c² n² = m c² (c/ρ0 − 1) [Nms²/rad], which the exact motion replaces."""
        return self.mass * self.distance**2 * (self.distance / self.curvature_radius - 1.0)


@dataclass(frozen=True, slots=True)
@checked_fields
class Connection:
    """Torque k (1 + iη) w·θ + c w·θ̇ + Ω² s w·θ + law(w·θ, w·θ̇) acting along w.

    ``stiffness`` k [Nm/rad], ``damping`` c [Nms/rad], ``loss_factor`` η [-] (in the frequency domain),
    ``centrifugal_stiffness`` s [Nm s²/rad] times the squared mean speed of the node ``carrier``.  ``load``: the normal
    load of a ``law`` that has one.  With ``whole_speed`` damper and law see the whole speed w·(θ̇ + mean rotation), as
    a brake or a road load does; else the deviation from the mean rotation.  In the frequency domain, where mean losses
    belong to the mean torque, such a law is left out.  ``swing``: the path of the pendulum it suspends, for motion in
    time.
    Raises ModelError for a load beside a law that takes none.

    >>> Connection("shaft", {"a": -1.0, "b": 1.0}, stiffness=12e3).stiffness
    12000.0
    """

    name: str
    weights: Weights
    stiffness: float = 0.0
    damping: float = 0.0
    loss_factor: float = 0.0
    centrifugal_stiffness: float = 0.0
    carrier: str = ""
    law: Law | None = None
    load: NormalLoad | None = None
    whole_speed: bool = False
    swing: Swing | None = None

    def __post_init__(self) -> None:
        if self.load is None:
            return
        if self.law is None or self.law.load_place < 0:
            found = "no law" if self.law is None else type(self.law).__name__
            remedy = "laws with a normal_load, such as LuGre, take one"
            raise ModelError("this law has no normal load", where=self.name, found=found, remedy=remedy)
        own = float(self.law.parameters[self.law.load_place])
        if own != 1.0:
            remedy = "leave the law's normal_load at 1 where the connection has a load"
            raise ModelError("the normal load is given twice", where=self.name, found=f"{own:g} N", remedy=remedy)


@dataclass(frozen=True, slots=True)
@checked_fields
class Constraint:
    """The rigid kinematic condition w·θ = 0.

    >>> Constraint("first gear", {"input": 1.0, "output": -2.5}).weights["output"]
    -2.5
    """

    name: str
    weights: Weights


Stamp = Mass | Connection | Constraint
