"""The built-in cycle: compression, heat release by Wiebe functions, blow-down and gas exchange."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import number, positive, within
from torsional.engine.cylinder import Cylinder
from torsional.engine.gas import PressureShapes
from torsional.engine.orders import CYCLE, FloatArray, crank_angle_grid
from torsional.errors import ModelError

BOOST = ((0.0, 1.05e5), (5e5, 1.3e5), (10e5, 1.8e5), (15e5, 2.35e5), (20e5, 2.9e5), (25e5, 3.4e5), (30e5, 3.9e5))


@dataclass(frozen=True)
@checked_fields
class Wiebe:
    """Burnt fraction x_b(θ) = 1 − exp(−a((θ − start)/duration)^(shape + 1)), 0 before the start.

    Angles in rad, from the cylinder's firing top dead centre.  a = 6.908 burns 99.9 % within the duration.
    Source: I. Wiebe, Brennverlauf und Kreisprozess von Verbrennungsmotoren, VEB Verlag Technik (1970).
    Raises ModelError for a duration or a shape that burns nothing.

    >>> Wiebe(start=0.0, duration=1.0, shape=1.0).burnt(1.0).round(4).item()
    0.999
    """

    start: float
    duration: float
    shape: float
    efficiency: float = 6.908

    def __post_init__(self) -> None:
        within(self.start, -math.pi, math.pi, "start", "angle")
        within(self.duration, 0.01, math.pi, "duration", "angle")
        within(self.shape, 0.0, 10.0, "shape", "number")
        positive(self.efficiency, "efficiency", "number")

    def burnt(self, crank_angle: ArrayLike) -> FloatArray:
        """Burnt fraction [-], in the shape of the crank angle [rad, −2π to 2π]."""
        passed = np.maximum(np.asarray(crank_angle, dtype=float) - self.start, 0.0) / self.duration
        return np.asarray(-np.expm1(-self.efficiency * passed ** (self.shape + 1.0)))


@dataclass(frozen=True)
@checked_fields
class LoadTable:
    """A value over the brake mean effective pressure of the firing cylinders, linear between points, held outside.

    >>> float(LoadTable(((0.0, 1e5), (20e5, 3e5)))(10e5))
    200000.0
    """

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not self.points or any(len(point) != 2 for point in self.points):
            raise ModelError("pairs of mean effective pressure and value are needed", where="mean_effective_pressure")
        for point in self.points:
            number(point[0], "mean_effective_pressure")
            number(point[1], "mean_effective_pressure")
        pressures = [point[0] for point in self.points]
        if any(b <= a for a, b in pairwise(pressures)):
            found = ", ".join(f"{pressure:g}" for pressure in pressures)
            raise ModelError("the mean effective pressures must rise", where="mean_effective_pressure", found=found)

    def __call__(self, mean_effective_pressure: ArrayLike) -> FloatArray:
        """The value at each mean effective pressure [Pa]."""
        pressures, values = zip(*self.points, strict=True)
        return np.asarray(np.interp(np.asarray(mean_effective_pressure, dtype=float), pressures, values))


@dataclass(frozen=True)
@checked_fields
class CombustionCycle:
    """A turbocharged four-stroke diesel cycle in one zone; angles [rad] from firing top dead centre.

    Between intake closing and exhaust opening the pressure is the motored one, a polytrope from the intake pressure,
    plus what the heat adds: an amount dQ released at volume V' raises the pressure by (κ − 1) dQ/V', which then falls
    as V^−κ.  This is the first law for a constant κ, in closed form (Heywood, Internal Combustion Engine
    Fundamentals, sec. 9.2); heat is the net heat, wall losses already deducted:

        p = p_in (V_ic/V)^n_c + heat (κ − 1) V^−κ ∫ V^(κ−1) dx_b,   x_b = β x_premixed + (1 − β) x_main

    After exhaust opening the pressure falls exponentially over ``blowdown_angle`` to the intake pressure plus
    ``exhaust_back_pressure`` [Pa], passes to the intake pressure by a cosine over the valve overlap, and stays there.
    ``boost`` [Pa, absolute] and ``premixed_fraction`` β are numbers or tables over the brake mean effective pressure.
    The defaults are our own, with the peak pressures usual for a heavy truck diesel.

    Raises ModelError for events out of sequence or values beyond physics.

    >>> round(float(CombustionCycle().main.burnt(0.5)), 3)  # of the main heat, 0.5 rad after firing
    0.783
    """

    boost: float | LoadTable = LoadTable(BOOST)
    compression_exponent: float = 1.35
    expansion_exponent: float = 1.30
    main: Wiebe = Wiebe(start=math.radians(-3.0), duration=math.radians(70.0), shape=0.9)
    premixed: Wiebe = Wiebe(start=math.radians(-4.0), duration=math.radians(12.0), shape=1.5)
    premixed_fraction: float | LoadTable = 0.05
    intake_closing: float = math.radians(-150.0)
    exhaust_opening: float = math.radians(130.0)
    blowdown_angle: float = math.radians(18.0)
    valve_overlap: float = math.radians(40.0)
    exhaust_back_pressure: float = 0.2e5

    def __post_init__(self) -> None:
        within(self.compression_exponent, 1.1, 1.67, "compression_exponent", "number")
        within(self.expansion_exponent, 1.1, 1.67, "expansion_exponent", "number")
        within(self.blowdown_angle, 0.02, 1.0, "blowdown_angle", "angle")
        within(self.valve_overlap, 0.05, 2.0, "valve_overlap", "angle")
        within(self.exhaust_back_pressure, -1e6, 1e7, "exhaust_back_pressure", "pressure")
        half = 0.5 * self.valve_overlap
        within(self.intake_closing, half - 2 * math.pi, -0.2, "intake_closing", "angle")
        within(self.exhaust_opening, 0.2, 2 * math.pi - half, "exhaust_opening", "angle")
        for name, value, low, high in (
            ("boost", self.boost, 1e4, 2e6),
            ("premixed_fraction", self.premixed_fraction, 0, 1),
        ):
            for each in [point[1] for point in value.points] if isinstance(value, LoadTable) else [value]:
                within(each, low, high, name, "number")
        for name, wiebe in (("main", self.main), ("premixed", self.premixed)):
            if not self.intake_closing <= wiebe.start < self.exhaust_opening:
                found, allowed = f"{wiebe.start:g} rad", "after intake closing and before exhaust opening"
                raise ModelError(
                    "combustion must start while the valves are closed",
                    where=f"{name}.start",
                    found=found,
                    allowed=allowed,
                )

    def pressure_shapes(self, cylinder: Cylinder, firing_angles: FloatArray) -> PressureShapes:
        """Shapes of intake pressure, back pressure, premixed heat and main heat; all cylinders alike."""
        turned = crank_angle_grid() - self.intake_closing
        angle = np.mod(turned, CYCLE) + self.intake_closing
        order = np.argsort(angle)
        rows = np.empty((4, angle.size))
        rows[:, order] = self._shapes_in_sequence(cylinder, angle[order])
        return PressureShapes(rows, self._coefficients)

    def _shapes_in_sequence(self, cylinder: Cylinder, angle: FloatArray) -> FloatArray:
        """The four shapes along one cycle that begins with intake closing."""
        opening, zero = np.array([self.exhaust_opening]), np.zeros_like(angle)
        motored, burning = self._motored(cylinder, angle), self._burning(cylinder, angle)
        at_opening = np.array([np.interp(self.exhaust_opening, angle, row) for row in burning])
        fading = np.exp(-(np.maximum(angle - self.exhaust_opening, 0.0)) / self.blowdown_angle)
        expelled = [
            1.0 + fading * (self._motored(cylinder, opening) - 1.0),
            1.0 - fading,
            *(at_opening[:, None] * fading),
        ]
        induced = [zero + 1.0, zero, zero, zero]
        past = np.clip((angle - 2 * np.pi) / self.valve_overlap + 0.5, 0.0, 1.0)
        share = 0.5 * (1.0 + np.cos(np.pi * past))
        exchanged = share * np.array(expelled) + (1.0 - share) * np.array(induced)
        return np.where(angle <= self.exhaust_opening, np.array([motored, zero, *burning]), exchanged)

    def _motored(self, cylinder: Cylinder, angle: FloatArray) -> FloatArray:
        closing = cylinder.volume(self.intake_closing)
        return np.asarray((closing / cylinder.volume(angle)) ** self.compression_exponent)

    def _burning(self, cylinder: Cylinder, angle: FloatArray) -> FloatArray:
        """Pressure that one joule adds [Pa/J], rows premixed and main.

        The integral is taken over the burnt fraction, not over the angle: its steep start is then met exactly.
        """
        kappa, volume = self.expansion_exponent, cylinder.volume(angle)
        stored = volume ** (kappa - 1.0)
        burnt = np.array([self.premixed.burnt(angle), self.main.burnt(angle)])
        steps = 0.5 * (stored[1:] + stored[:-1]) * np.diff(burnt, axis=1)
        total = np.concatenate([np.zeros((2, 1)), np.cumsum(steps, axis=1)], axis=1)
        return np.asarray((kappa - 1.0) * total / volume**kappa)

    def _coefficients(self, mean_effective_pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        pressure = np.asarray(mean_effective_pressure, dtype=float)
        boost, beta = (
            value(pressure) if isinstance(value, LoadTable) else np.full(pressure.shape, float(value))
            for value in (self.boost, self.premixed_fraction)
        )
        none = np.zeros_like(pressure)
        unfired = np.stack([boost, none + self.exhaust_back_pressure, none, none], axis=-1)
        fired = np.stack([none, none, beta, 1.0 - beta], axis=-1)
        return unfired[:, None, :], fired[:, None, :]
