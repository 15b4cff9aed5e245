"""Modes counted without solving for them: an independent word on how many lie below a frequency."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import ldl


def count_below(
    sigma: float, elastic_weights: ArrayLike, stiffness: ArrayLike, mass_weights: ArrayLike, inertia: ArrayLike
) -> int:
    """Number of modes below the angular frequency ``sigma`` > 0 [rad/s] by Sylvester's law of inertia, without solving.

    The negative pivots of K − σ² M are counted on [[−σ 1, diag(√k) W], [Wᵀ diag(√k), −σ M]], of which it is the Schur
    complement: that form resolves frequencies (not their squares) to rounding.  Weights and values as in ``modes``,
    one design.  Source: Parlett, The Symmetric Eigenvalue Problem (1998), § 3.3.

    >>> count_below(100.0, [[-1.0, 1.0]], [12e3], np.eye(2), [1.8, 1.2])
    1
    """
    v = np.asarray(mass_weights, dtype=float)
    mass = v.T @ (np.asarray(inertia, dtype=float)[:, np.newaxis] * v)
    scale = 1.0 / np.sqrt(np.diagonal(mass))
    elastic = np.sqrt(stiffness)[:, np.newaxis] * np.asarray(elastic_weights, dtype=float) * scale
    rows = len(elastic)
    pencil = np.block([[-sigma * np.eye(rows), elastic], [elastic.T, -sigma * scale[:, np.newaxis] * mass * scale]])
    pivots = np.linalg.eigvalsh(ldl(pencil)[1])
    return int(np.count_nonzero(pivots < 0.0)) - rows
