"""What spring flywheels are made of: coil springs, and the friction of what slides in their channels."""

from __future__ import annotations

from dataclasses import dataclass

from torsional import checks
from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.laws import LuGre

SAME = 1e-12
"""Angles [rad] and shares that differ by less are one."""


@dataclass(frozen=True)
@checked_fields
class CoilSpring:
    """A coil spring: ``rate`` [N/m], ``free_length`` and ``solid_length`` (coils touching) [m], ``mass`` [kg].

    Springs inside one another that begin at the same length count as one, their rates added.  Of an arc spring the
    lengths are those along its arc, and the rate is that of the whole spring.  Raises ModelError unless free is longer
    than solid.

    >>> CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02).travel
    0.01
    """

    rate: float
    free_length: float
    solid_length: float
    mass: float = 0.0

    def __post_init__(self) -> None:
        checks.positive(self.rate, "rate", "spring_rate")
        checks.positive(self.free_length, "free_length", "length")
        checks.positive(self.solid_length, "solid_length", "length")
        checks.not_negative(self.mass, "mass", "mass")
        if self.solid_length >= self.free_length:
            found, allowed = f"{1e3 * self.solid_length:g} mm", f"below free_length, {1e3 * self.free_length:g} mm"
            raise ModelError("solid at its free length", where="solid_length", found=found, allowed=allowed)

    @property
    def travel(self) -> float:
        """The way [m] from free to solid."""
        return round(self.free_length - self.solid_length, 15)


@dataclass(frozen=True)
@checked_fields
class GuideFriction:
    """Friction of shoes or coils on their guide, by LuGre's law per newton of the load that presses them.

    ``sliding_coefficient`` µ_c, ``static_coefficient`` µ_s (default µ_c), between them the Stribeck curve of width
    ``stribeck_velocity`` [m/s]; ``presliding`` [m]: elastic way before it slides; ``bristle_time`` [s]: damping of the
    bristles over their stiffness; ``viscous_coefficient`` [s/m]: what µ gains per m/s.  With µ_s > µ_c the law cannot
    give off energy as long as viscous_coefficient ≥ bristle_time (µ_s − µ_c)/presliding (Barahanov and Ortega,
    IEEE Trans. Autom. Control 45 (2000) 830).

    >>> GuideFriction(0.08).law(0.15).sliding_torque
    0.012
    """

    sliding_coefficient: float
    static_coefficient: float | None = None
    stribeck_velocity: float = 0.02
    presliding: float = 5e-5
    bristle_time: float = 2e-5
    viscous_coefficient: float = 0.01

    def __post_init__(self) -> None:
        checks.positive(self.sliding_coefficient, "sliding_coefficient", "friction_coefficient")
        checks.positive(self.stribeck_velocity, "stribeck_velocity", "velocity")
        checks.positive(self.presliding, "presliding", "length")
        checks.not_negative(self.bristle_time, "bristle_time", "time")
        checks.not_negative(self.viscous_coefficient, "viscous_coefficient", "number")
        if checks.number(self.static, "static_coefficient") < self.sliding_coefficient:
            found, allowed = f"{self.static:g}", f"at least the sliding coefficient, {self.sliding_coefficient:g}"
            raise ModelError("must not be below sliding", where="static_coefficient", found=found, allowed=allowed)
        least = self.bristle_time * (self.static - self.sliding_coefficient) / self.presliding
        if self.viscous_coefficient < least * (1 - SAME):
            raise ModelError(
                "with these values friction would give off energy",
                where="viscous_coefficient",
                found=f"{self.viscous_coefficient:g} s/m",
                allowed=f">= {least:g} s/m",
                remedy="or a shorter bristle_time",
            )

    @property
    def static(self) -> float:
        """The coefficient µ_s at which it breaks loose."""
        return self.sliding_coefficient if self.static_coefficient is None else self.static_coefficient

    def law(self, radius: float) -> LuGre:
        """The law of torque over angle at a ``radius`` R [m], per newton.

        σ0 = µ_c R²/presliding, σ1 = σ0 bristle_time, g = µ R, u_s = v_s/R, σ2 = viscous_coefficient R².
        """
        bristles = self.sliding_coefficient * radius**2 / self.presliding
        return LuGre(
            bristles,
            bristles * self.bristle_time,
            self.sliding_coefficient * radius,
            self.static * radius,
            self.stribeck_velocity / radius,
            self.viscous_coefficient * radius**2,
        )
