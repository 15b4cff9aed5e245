"""Mean pressure lost to friction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import within
from torsional.engine.orders import FloatArray


@dataclass(frozen=True)
@checked_fields
class ChenFlynn:
    """Friction mean effective pressure that grows with peak pressure and piston speed.

        FMEP = constant + peak_pressure_factor p_max + linear s + quadratic s²,  s the mean piston speed [m/s]

    ``constant`` [Pa], ``peak_pressure_factor`` [-], ``linear`` [Pa s/m], ``quadratic`` [Pa s²/m²].  The form is that of
    S. K. Chen and P. F. Flynn, SAE 650733 (1965), doi 10.4271/650733, with the square term that later users added; the
    defaults are our own choice for a heavy diesel with its auxiliaries, to be replaced by a motoring test where there
    is one.  Raises ModelError for a negative or absurd coefficient.

    >>> round(float(ChenFlynn().pressure(180e5, 6.0)) / 1e5, 3)  # bar
    1.82
    """

    constant: float = 0.4e5
    peak_pressure_factor: float = 0.005
    linear: float = 0.08e5
    quadratic: float = 0.0011e5

    def __post_init__(self) -> None:
        within(self.constant, 0.0, 1e6, "constant", "pressure")
        within(self.peak_pressure_factor, 0.0, 0.05, "peak_pressure_factor", "number")
        within(self.linear, 0.0, 1e6, "linear", "Pa s/m")
        within(self.quadratic, 0.0, 1e6, "quadratic", "Pa s²/m²")

    def base(self, piston_speed: ArrayLike) -> FloatArray:
        """The part that does not depend on the cylinder pressure [Pa]."""
        s = np.asarray(piston_speed, dtype=float)
        return np.asarray(self.constant + self.linear * s + self.quadratic * s * s)

    def pressure(self, peak_pressure: ArrayLike, piston_speed: ArrayLike) -> FloatArray:
        """Friction mean effective pressure [Pa] of peak pressure [Pa] and mean piston speed [m/s], broadcast."""
        return np.asarray(self.base(piston_speed) + self.peak_pressure_factor * np.asarray(peak_pressure, dtype=float))
