"""The generalised-α family of implicit second-order time steps, and how much of what it damps.

Of M q̈ = g(q, q̇, t) a step of h finds the accelerations that hold at its end together with auxiliary ones, a:

    M q̈⁺ = g(q⁺, v⁺, t + h),   (1 − α_m) a⁺ + α_m a = (1 − α_f) q̈⁺ + α_f q̈
    q⁺ = q + h v + h² ((½ − β) a + β a⁺),   v⁺ = v + h ((1 − γ) a + γ a⁺)

which for constant masses is the balance of forces and masses at t + (1 − α_f) h and t + (1 − α_m) h, and keeps second
order for others.  After Chung, Hulbert (J. Appl. Mech. 60 (1993) 371); Arnold, Brüls (Multibody Syst. Dyn. 18 (2007)
185).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array


@dataclass(frozen=True)
class AlphaMethod:
    """One member of the family; the constructors choose it by ρ∞, what is left of the fastest motion after a step.

    >>> AlphaMethod.newmark()
    AlphaMethod(alpha_m=0.0, alpha_f=0.0, beta=0.25, gamma=0.5)
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float

    @classmethod
    def chung_hulbert(cls, spectral_radius: float) -> AlphaMethod:
        """α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1): least damping of the slow motion for that of the fast, ρ in [0, 1].

        Raises ModelError for any other ρ.

        >>> AlphaMethod.chung_hulbert(1.0)
        AlphaMethod(alpha_m=0.5, alpha_f=0.5, beta=0.25, gamma=0.5)
        """
        rho = _within(spectral_radius, 0.0)
        return cls._second_order((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))

    @classmethod
    def hht(cls, spectral_radius: float) -> AlphaMethod:
        """α_m = 0, α_f = (1 − ρ)/(1 + ρ), ρ in [½, 1]; Hilber, Hughes, Taylor (Earthq. Eng. Struct. Dyn. 5 (1977) 283).

        Raises ModelError for any other ρ.
        """
        rho = _within(spectral_radius, 0.5)
        return cls._second_order(0.0, (1.0 - rho) / (1.0 + rho))

    @classmethod
    def bossak(cls, spectral_radius: float) -> AlphaMethod:
        """α_f = 0, α_m = (ρ − 1)/(ρ + 1), ρ in [0, 1]; Wood, Bossak, Zienkiewicz (Int. J. Numer. Meth. Eng. 15 (1980)
        1562).

        Raises ModelError for any other ρ.
        """
        rho = _within(spectral_radius, 0.0)
        return cls._second_order((rho - 1.0) / (rho + 1.0), 0.0)

    @classmethod
    def newmark(cls) -> AlphaMethod:
        """The average acceleration: nothing is damped."""
        return cls._second_order(0.0, 0.0)

    @classmethod
    def _second_order(cls, alpha_m: float, alpha_f: float) -> AlphaMethod:
        """γ = ½ − α_m + α_f and β = ¼ (1 − α_m + α_f)²."""
        ahead = alpha_f - alpha_m
        return cls(alpha_m, alpha_f, 0.25 * (1.0 + ahead) ** 2, 0.5 + ahead)

    def amplification(self, omega_h: float) -> Array:
        """(q, h v, h² a) after a step of free undamped motion by those before it (3, 3), with ωh [rad].

        >>> AlphaMethod.newmark().amplification(0.0).tolist()
        [[1.0, 1.0, 0.25], [0.0, 1.0, 0.5], [0.0, 0.0, 0.0]]
        """
        m, f, z = 1.0 - self.alpha_m, 1.0 - self.alpha_f, omega_h * omega_h
        known = np.array([[1.0, 1.0, 0.5 - self.beta], [0.0, 1.0, 1.0 - self.gamma], [0.0, 0.0, 0.0]])
        load = -z * (f * known[0] + np.array([self.alpha_f, 0.0, 0.0])) - np.array([0.0, 0.0, self.alpha_m])
        new = load / (m + f * z * self.beta)
        return np.asarray(known + np.outer([self.beta, self.gamma, 1.0], new))

    def spectral_radius_at(self, omega_h: ArrayLike) -> Array:
        """Largest modulus of the eigenvalues of `amplification` at ωh [rad]: what a step leaves of that motion.

        >>> AlphaMethod.chung_hulbert(0.9).spectral_radius_at([0.0, 1.0]).round(10).tolist()
        [1.0, 0.9999422589]
        """
        steps = np.asarray(omega_h, dtype=float)
        found = [np.abs(np.linalg.eigvals(self.amplification(float(z)))).max() for z in steps.ravel()]
        return np.array(found).reshape(steps.shape)


def _within(rho: float, least: float) -> float:
    """ρ, if it is one that the member allows."""
    value = float(rho)
    if not least <= value <= 1.0:
        found, allowed = f"{value:g}", f"{least:g} to 1"
        raise ModelError("no such time step", where="spectral_radius", found=found, allowed=allowed)
    return value
