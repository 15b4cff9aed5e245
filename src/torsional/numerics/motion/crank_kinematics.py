"""Kinematics of a slider-crank as plain formulas, for arrays in Python and for single numbers in compiled code."""

from __future__ import annotations

from typing import Any

import numpy as np


def piston_position(radius: float, rod: float, offset: float, angle: Any) -> Any:
    """Way of the piston below top dead centre x(θ) [m] for lengths [m] and crank angles θ [rad], any shape.

        x = y_top − r cos ψ − l sqrt(1 − s²),  s = (r sin ψ − e)/l,  ψ = θ + asin(e/(r + l))

    >>> round(float(piston_position(0.08, 0.32, 0.0, np.pi)), 12)
    0.16
    """
    psi = angle + np.arcsin(offset / (radius + rod))
    s = (radius * np.sin(psi) - offset) / rod
    return np.sqrt((radius + rod) ** 2 - offset**2) - radius * np.cos(psi) - rod * np.sqrt(1.0 - s * s)


def piston_ratios(radius: float, rod: float, offset: float, angle: Any) -> tuple[Any, Any]:
    """x'(θ) [m/rad] and x''(θ) [m/rad²] of `piston_position`.

    >>> [round(float(v), 12) for v in piston_ratios(0.08, 0.32, 0.0, 0.0)]
    [0.0, 0.1]
    """
    psi = angle + np.arcsin(offset / (radius + rod))
    up, across = radius * np.cos(psi), radius * np.sin(psi)
    s = (across - offset) / rod
    c = np.sqrt(1.0 - s * s)
    return across + up * s / c, up - across * s / c + up * up / (rod * c**3)
