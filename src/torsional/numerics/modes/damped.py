"""Damped modes: (λ² M + λ C + K) φ = 0 with all three matrices given by their factors.

Solved in the coordinates of the undamped modes, where M is one and K is diag(ω²).  Rigid motions are taken out by
structure, so that their zeros are exact and never a defective pair that rounding splits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.linear.null_space import null_vectors
from torsional.numerics.modes.undamped import modes


class DampedModes(NamedTuple):
    """Damped modes in ascending order of |λ|: a conjugate pair is one entry (Im λ > 0), real roots are one entry each.

    ``eigenvalues`` λ (modes,) [1/s], ``shapes`` (nodes, modes), complex with φᴴ M φ = 1 and the largest entry real and
    positive, ``omega`` = |λ| [rad/s] and ``damping_ratio`` = −Re λ / |λ|, zero for a rigid mode.
    """

    eigenvalues: ComplexArray
    shapes: ComplexArray
    omega: Array
    damping_ratio: Array


def damped_modes(
    elastic_weights: ArrayLike,
    stiffness: ArrayLike,
    damping_weights: ArrayLike,
    damping: ArrayLike,
    mass_weights: ArrayLike,
    inertia: ArrayLike,
) -> DampedModes:
    """Damped modes of (λ² M + λ C + K) φ = 0, with M = Vᵀ diag(J) V, C = Dᵀ diag(c) D and K = Wᵀ diag(k) W.

    ``elastic_weights`` W (rows, nodes), ``stiffness`` k (rows,) [Nm/rad], ``damping_weights`` D (rows, nodes),
    ``damping`` c (rows,) [Nms/rad], ``mass_weights`` V (masses, nodes), ``inertia`` J (masses,) [kg m²].  Rigid
    modes that nothing damps appear once, with λ = 0; one that a damper to ground holds has λ = 0 and a real root.
    Raises ModelError as ``modes`` does.  Source: Tisseur and Meerbergen, SIAM Review 43 (2001) 235,
    doi 10.1137/S0036144500381988.

    A disc of 1 kg m² on 100 Nm/rad and 4 Nms/rad to ground: ω = 10 rad/s, damping ratio 0.2.

    >>> found = damped_modes([[1.0]], [100.0], [[1.0]], [4.0], [[1.0]], [1.0])
    >>> found.omega, found.damping_ratio
    (array([10.]), array([0.2]))
    """
    omega, shapes = modes(elastic_weights, stiffness, mass_weights, inertia)
    weights, c = np.atleast_2d(np.asarray(damping_weights, dtype=float)), np.asarray(damping, dtype=float)
    elastic = np.asarray(elastic_weights, dtype=float)[np.asarray(stiffness, dtype=float) > 0.0]
    free = null_vectors(np.vstack([elastic, weights[c != 0.0]])).shape[1]
    rigid = int(np.count_nonzero(omega == 0.0))
    shapes = _undamped_first(shapes, np.sqrt(np.abs(c))[:, np.newaxis] * (weights @ shapes[:, :rigid]))
    modal = weights @ shapes[:, free:]
    values, vectors = _solve(omega[free:], modal.T @ (c[:, np.newaxis] * modal), rigid - free)
    eigenvalues = np.concatenate([np.zeros(free, complex), values])
    padded = np.zeros((len(omega), len(eigenvalues)), complex)
    padded[:free, :free] = np.eye(free)
    padded[free:, free:] = vectors
    return _presented(eigenvalues, shapes.astype(complex) @ padded)


def _undamped_first(shapes: Array, slip: Array) -> Array:
    """Turn the rigid modes among themselves so that those whose dampers do not ``slip`` (rows, rigid) come first."""
    rigid = slip.shape[1]
    turn = np.linalg.svd(slip, full_matrices=True)[2][::-1].T
    return np.hstack([shapes[:, :rigid] @ turn, shapes[:, rigid:]])


def _solve(omega: Array, damping: Array, held: int) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues and modal coordinates; the first ``held`` modes have no stiffness but damping.

    States are the velocities and ω times the elastic positions, so ``[[-C, -diag ω], [diag ω, 0]]`` is evenly scaled.
    A mode without stiffness needs no position: its λ = 0 is known beforehand.
    """
    count = len(omega)
    coupling = np.diag(omega)[:, held:]
    state = np.block([[-damping, -coupling], [coupling.T, np.zeros((count - held, count - held))]])
    found, vectors = np.linalg.eig(state)
    kept = found.imag >= 0.0
    q = vectors[:count, kept].astype(complex)
    q /= np.linalg.norm(q, axis=0)
    values = _rayleigh(found[kept].astype(complex), q, omega, damping)
    return np.concatenate([np.zeros(held, complex), values]), np.hstack([np.eye(count, held), q])


def _rayleigh(values: ComplexArray, q: ComplexArray, omega: Array, damping: Array) -> ComplexArray:
    """One step of the symmetric Rayleigh quotient: gives slow modes their own relative accuracy.

    The root of (qᵀq) λ² + (qᵀCq) λ + qᵀω²q nearest to the value found.  Near a critically damped pair, where the two
    roots meet, the step would gain nothing and is left out.
    """
    a, b = np.sum(q * q, axis=0), np.einsum("ij,ik,kj->j", q, damping, q)
    c = np.sum((omega[:, np.newaxis] * q) ** 2, axis=0)
    slope = 2.0 * a * values + b
    step = (a * values * values + b * values + c) / np.where(slope == 0.0, 1.0, slope)
    refined = np.where(np.abs(step) < 1e-6 * np.abs(values), values - step, values)
    return np.where(values.imag == 0.0, refined.real, refined)


def _presented(eigenvalues: ComplexArray, shapes: ComplexArray) -> DampedModes:
    order = np.lexsort((eigenvalues.imag, np.abs(eigenvalues)))
    eigenvalues, shapes = eigenvalues[order] + 0.0, shapes[:, order]
    size = np.abs(shapes)
    largest = np.argmax(size >= (1.0 - 1e-6) * size.max(axis=0), axis=0)
    peak = shapes[largest, np.arange(len(order))]
    omega = np.abs(eigenvalues)
    ratio = np.where(omega > 0.0, (0.0 - eigenvalues.real) / np.where(omega > 0.0, omega, 1.0), 0.0)
    return DampedModes(eigenvalues, shapes * (np.abs(peak) / peak), omega, ratio)
