"""Run-ups whose orders are known: pulses, counters and signals of a shaft that vibrates by them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
RPM = np.pi / 30


@dataclass(frozen=True)
class RunUp:
    """A mean speed from ``start`` [rad/s] by ``rate`` [rad/s²] for a ``duration`` [s]; ``orders`` {n: complex 0-peak
    [rad]} are the vibration of a shaft that turns ``ratio`` times as fast, each larger by ``growth`` a rad/s."""

    start: float
    rate: float
    duration: float
    orders: Mapping[float, complex] = field(default_factory=dict)
    ratio: float = 1.0
    growth: float = 0.0

    def crank_angle(self, time: Array) -> Array:
        """α(t)."""
        return np.asarray(self.start * time + 0.5 * self.rate * time**2)

    def speed(self, alpha: Array) -> Array:
        """Ω(α)."""
        return np.asarray(np.sqrt(self.start**2 + 2 * self.rate * alpha))

    def size(self, alpha: Array) -> Array:
        """By what the orders have grown."""
        return np.asarray(1.0 + self.growth * (self.speed(alpha) - self.start))

    def vibration(self, alpha: Array) -> Array:
        """φ(α) [rad]."""
        waves = [(value * np.exp(1j * n * alpha)).real for n, value in self.orders.items()]
        return np.asarray(self.size(alpha) * sum(waves, np.zeros_like(alpha)))

    def time(self, alpha: Array) -> Array:
        """t(α)."""
        return np.asarray(2 * alpha / (self.start + self.speed(alpha)))

    def passing(self, angles: Array) -> Array:
        """When the shaft stands at these angles [rad], by Newton's method with a slope from differences."""
        alpha = angles / self.ratio
        for _ in range(12):
            slope = (self.vibration(alpha + 1e-6) - self.vibration(alpha - 1e-6)) / 2e-6
            alpha = alpha - (self.ratio * alpha + self.vibration(alpha) - angles) / (self.ratio + slope)
        return self.time(alpha)

    def pulses(self, teeth: int, missing: int = 0, first: float = 0.0) -> Array:
        """Times [s] of the teeth of a wheel; those missing are the last of each turn."""
        last = self.crank_angle(np.array([self.duration]))[0] * self.ratio
        number = np.arange(int(np.ceil(first * teeth / (2 * np.pi))) + 1, int(last * teeth / (2 * np.pi)))
        return self.passing(number[number % teeth < teeth - missing] * (2 * np.pi / teeth))
