"""Stamps: what a component contributes to the equations, each along one combination w·θ of node angles.

θ: angles [rad] as deviations from the mean rotation; ``GROUND`` is an angle that never moves.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from torsional.laws import Law

GROUND = "ground"
"""The reserved node that never moves."""

Weights = Mapping[str, float]


@dataclass(frozen=True, slots=True)
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
class Mass:
    """Kinetic energy ½ J (w·θ̇)² with ``inertia`` J [kgm²], or that of ``switch`` above its speed."""

    name: str
    weights: Weights
    inertia: float
    switch: SpeedSwitch | None = None


@dataclass(frozen=True, slots=True)
class Connection:
    """Torque k (1 + iη) w·θ + c w·θ̇ + Ω² s w·θ + law(w·θ, w·θ̇) acting along w.

    ``stiffness`` k [Nm/rad], ``damping`` c [Nms/rad], ``loss_factor`` η [-] (in the frequency domain),
    ``centrifugal_stiffness`` s [Nm s²/rad] times the squared mean speed of the node ``carrier``.
    """

    name: str
    weights: Weights
    stiffness: float = 0.0
    damping: float = 0.0
    loss_factor: float = 0.0
    centrifugal_stiffness: float = 0.0
    carrier: str = ""
    law: Law | None = None


@dataclass(frozen=True, slots=True)
class Constraint:
    """The rigid kinematic condition w·θ = 0."""

    name: str
    weights: Weights


Stamp = Mass | Connection | Constraint
