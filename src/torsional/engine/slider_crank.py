"""Exact kinematics of a slider-crank, and the torque of its reciprocating mass."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import number, positive
from torsional.engine.orders import (
    ComplexArray,
    FloatArray,
    checked_orders,
    crank_angle_grid,
    half_order_series,
    picked,
)
from torsional.errors import ModelError
from torsional.numerics.motion.crank_kinematics import piston_position, piston_ratios


@dataclass(frozen=True)
@checked_fields
class SliderCrank:
    """A crank of radius r, a rod of length l and a pin whose line passes the crank's axis at the distance e.

    Crank angles θ [rad] are zero at the piston's top dead centre, whatever the offset; a positive offset lies on the
    side to which the crank pin leaves that point.  x(θ) [m] is the piston's way down from there, so that a pressure
    above the crankcase's gives the torque (p − p_crankcase) A x'(θ), positive in expansion.  Arrays of any shape.

        x = y_top − r cos ψ − l sqrt(1 − s²),  s = (r sin ψ − e)/l,  ψ = θ + asin(e/(r + l))

    Raises ModelError for lengths that do not make a crank that turns.  Source: geometry (see e.g. Taylor, The
    Internal-Combustion Engine in Theory and Practice, vol. 2, ch. 8).

    >>> SliderCrank(0.08, 0.32).position(np.pi).round(12).item()
    0.16
    """

    crank_radius: float
    rod_length: float
    pin_offset: float = 0.0

    def __post_init__(self) -> None:
        positive(self.crank_radius, "crank_radius", "length")
        positive(self.rod_length, "rod_length", "length")
        reach = self.crank_radius + abs(number(self.pin_offset, "pin_offset"))
        if self.rod_length <= reach:
            raise ModelError(
                "the rod is too short for the crank to turn",
                where="rod_length",
                found=f"{self.rod_length:g} m",
                allowed=f"more than crank radius plus pin offset, {reach:g} m",
            )

    @property
    def ratio(self) -> float:
        """λ = r/l [-]."""
        return self.crank_radius / self.rod_length

    @property
    def stroke(self) -> float:
        """Way between the dead centres [m]; 2 r without a pin offset."""
        r, l, e = self.crank_radius, self.rod_length, self.pin_offset
        return math.sqrt((l + r) ** 2 - e**2) - math.sqrt((l - r) ** 2 - e**2)

    @property
    def bottom_dead_centre(self) -> float:
        """Crank angle [rad] at which the piston is lowest; π without a pin offset."""
        r, l, e = self.crank_radius, self.rod_length, self.pin_offset
        return math.pi + math.asin(e / (l - r)) - math.asin(e / (r + l))

    def position(self, crank_angle: ArrayLike) -> FloatArray:
        """Way of the piston below top dead centre x(θ) [m]."""
        return np.asarray(piston_position(*self._lengths, np.asarray(crank_angle, dtype=float)))

    def velocity_ratio(self, crank_angle: ArrayLike) -> FloatArray:
        """x'(θ) = dx/dθ [m/rad]."""
        return np.asarray(piston_ratios(*self._lengths, np.asarray(crank_angle, dtype=float))[0])

    def acceleration_ratio(self, crank_angle: ArrayLike) -> FloatArray:
        """x''(θ) = d²x/dθ² [m/rad²]."""
        return np.asarray(piston_ratios(*self._lengths, np.asarray(crank_angle, dtype=float))[1])

    @property
    def _lengths(self) -> tuple[float, float, float]:
        return self.crank_radius, self.rod_length, self.pin_offset

    def inertia(self, reciprocating_mass: float, crank_angle: ArrayLike) -> FloatArray:
        """Angle-dependent inertia of the reciprocating mass m x'(θ)² [kg m²]."""
        return np.asarray(reciprocating_mass * self.velocity_ratio(crank_angle) ** 2)

    def half_share(self, reciprocating_mass: float) -> float:
        """The usual constant share of the reciprocating mass in a throw's inertia m r²/2 [kg m²]."""
        return 0.5 * reciprocating_mass * self.crank_radius**2

    def reciprocating_torque(
        self, reciprocating_mass: float, speed: ArrayLike, crank_angle: ArrayLike, acceleration: ArrayLike = 0.0
    ) -> FloatArray:
        """Torque of the reciprocating mass on the crank −m x'(x'' Ω² + x' θ̈) [Nm]; the arguments broadcast.

        ``speed`` Ω [rad/s], ``acceleration`` θ̈ [rad/s²] (zero for steady order analysis with the half-share in the
        throw's inertia).  Without θ̈ it has no mean.
        """
        first, second = self.velocity_ratio(crank_angle), self.acceleration_ratio(crank_angle)
        force = second * np.asarray(speed, dtype=float) ** 2 + first * np.asarray(acceleration, dtype=float)
        return np.asarray(-reciprocating_mass * first * force)

    def reciprocating_harmonics(self, reciprocating_mass: float, orders: ArrayLike) -> ComplexArray:
        """Complex 0-peak harmonics of the reciprocating torque divided by Ω² [kg m²], shape (orders,).

        In the classical series T = m r² Ω² Σ b_h sin hθ they are −i b_h m r² (Biezeno and Grammel, Technische
        Dynamik, vol. 2), here to rounding from the exact kinematics.

        >>> SliderCrank(1.0, 4.0).reciprocating_harmonics(1.0, [2]).imag.round(5).tolist()
        [0.50013]
        """
        torque = self.reciprocating_torque(reciprocating_mass, 1.0, crank_angle_grid())
        return picked(half_order_series(torque), checked_orders(orders))
