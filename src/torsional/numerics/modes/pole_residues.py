"""Receptances between a few directions as a sum over poles, one eigenproblem a design.

    (s² M + s C + K)⁻¹ = Σ_k φ_k φ_kᵀ / (a_k (s − λ_k)),   a_k = φ_kᵀ (2 λ_k M + C) φ_k

for symmetric M, C, K with as many poles as twice the coordinates (Tisseur and Meerbergen, SIAM Review 43 (2001) 235,
doi 10.1137/S0036144500381988).  Rigid motions have no share in relative angles and are left out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.modes.damped import damped_modes


class PoleResidues(NamedTuple):
    """Poles λ (K,) [1/s] and shapes (K, N) whose outer products over (s − λ_k) add up to the receptance."""

    poles: ComplexArray
    shapes: ComplexArray

    def receptance(self, s: complex, left: Array, right: Array) -> ComplexArray:
        """left Z(s)⁻¹ rightᵀ for rows of directions (m, N) and (l, N)."""
        return np.asarray(((left @ self.shapes.T) / (s - self.poles)) @ (right @ self.shapes.T).T)


def pole_residues(
    weights: ArrayLike, stiffness: ArrayLike, damping: ArrayLike, mass_weights: ArrayLike, inertia: ArrayLike
) -> PoleResidues:
    """Poles and shapes of a system given by its factors: ``weights`` (connections, N) with ``stiffness`` [Nm/rad] and
    ``damping`` [Nms/rad], ``mass_weights`` (masses, N) with ``inertia`` [kgm²].

    One disc of 1 kgm² on 4 Nm/rad answers 1 Nm at rest with a quarter of a radian:

    >>> one = pole_residues([[1.0]], [4.0], [0.1], [[1.0]], [1.0])
    >>> complex(one.receptance(0.0, np.eye(1), np.eye(1))[0, 0]).real.__round__(12)
    0.25
    """
    w, v = np.asarray(weights, dtype=float), np.asarray(mass_weights, dtype=float)
    c, inertias = np.asarray(damping, dtype=float), np.asarray(inertia, dtype=float)
    found = damped_modes(w, stiffness, w, c, v, inertias)
    kept = np.abs(found.eigenvalues) > 0.0
    poles, shapes = found.eigenvalues[kept], found.shapes[:, kept].T
    twin = poles.imag != 0.0
    poles, shapes = np.concatenate([poles, poles[twin].conj()]), np.concatenate([shapes, shapes[twin].conj()])
    norm = 2.0 * poles * ((shapes @ v.T) ** 2 @ inertias) + (shapes @ w.T) ** 2 @ c
    with np.errstate(divide="ignore", invalid="ignore"):
        return PoleResidues(poles, shapes / np.sqrt(norm)[:, None])
