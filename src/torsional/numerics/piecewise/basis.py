"""Coordinates and stages of M q̈ + C q̇ + K q + Σ_e w_e f_e(w_e · q) = u(t) with piecewise-linear f_e.

    f(φ) = k0 φ + Σ_i s_i Δk_i max(0, s_i (φ − g_i))          in stage j: k_j φ + o_j

Rigid modes load no spring and leave the equations of the others alone, so they are taken out by their structure and
never looked for among eigenvalues: z = (σ y, ẏ, ρ̇) with y along the elastic modes of a mean stiffness, mass-orthogonal
to the rigid ones, and ρ̇ the speeds of those rigid modes that a damper acts on.  σ, the modes' frequencies, makes every
entry of z the root of an energy, which balances the matrices of all stages.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.null_space import null_vectors, transformed

ILL_CONDITIONED = 1e5  # eigenvectors beyond this condition number lose five digits: a matrix exponential does not
SLOWEST = 1e-6  # elastic modes slower than this share of the fastest are scaled as if they were that fast


@dataclass(frozen=True)
class Coordinates:
    """States z = (σ y, ẏ, ρ̇) without what is rigid, and the matrix of ż = A z.

    ``shapes`` (N, elastic) and ``rigid`` (N, damped rigid): θ = shapes y + rigid ρ; ``scale`` σ [rad/s]; ``matrix`` A
    [1/s]; ``weights`` (m, elastic): connections' angles by y; ``removed``: multipliers +1 that are left out.
    """

    shapes: Array
    rigid: Array
    scale: Array
    matrix: Array
    weights: Array
    momentum: Array
    removed: int

    @property
    def size(self) -> int:
        """Entries of the state."""
        return len(self.matrix)

    @property
    def angle_rows(self) -> Array:
        """Rows (m, size): connections' angles [rad] = rows · z."""
        rows = np.zeros((len(self.weights), self.size))
        rows[:, : len(self.scale)] = self.weights / self.scale
        return rows

    @property
    def rate_rows(self) -> Array:
        """Rows (m, size): connections' angular rates [rad/s] = rows · z; transposed, how a torque moves the state."""
        rows = np.zeros((len(self.weights), self.size))
        rows[:, len(self.scale) : 2 * len(self.scale)] = self.weights
        return rows

    def state(self, angles: ArrayLike, rates: ArrayLike) -> Array:
        """State z of angles and rates (…, N); their rigid part is left out, but for speeds that a damper acts on."""
        y, rho = self.momentum[: len(self.scale)], self.momentum
        return np.concatenate([np.asarray(angles) @ y.T * self.scale, np.asarray(rates) @ rho.T], axis=-1)

    def angles(self, state: ArrayLike) -> Array:
        """Angles (…, N) [rad] of a state, their rigid part zero."""
        return np.asarray(np.asarray(state)[..., : len(self.scale)] / self.scale @ self.shapes.T)

    def rates(self, state: ArrayLike) -> Array:
        """Rates (…, N) [rad/s] of a state, without rigid speeds that no damper acts on."""
        return np.asarray(np.asarray(state)[..., len(self.scale) :] @ np.hstack([self.shapes, self.rigid]).T)

    def acceleration(self, load: ArrayLike) -> Array:
        """Contribution (…, size) to ż of torques (…, N) on the coordinates."""
        moving = np.asarray(load) @ np.hstack([self.shapes, self.rigid])
        return np.concatenate([np.zeros((*moving.shape[:-1], len(self.scale))), moving], axis=-1)


def _checked_rigid(rigid: ArrayLike | None, stiffness: Array, weights: Array) -> Array:
    vectors = np.zeros((len(stiffness), 0)) if rigid is None else np.asarray(rigid, dtype=float)
    if np.any(transformed(np.vstack([stiffness, weights]), vectors)):
        raise ModelError("a rigid mode must not load any spring", remedy="take the null vectors of all elastic rows")
    return vectors


def _split_rigid(root: Array, vectors: Array, damping: Array) -> tuple[Array, Array, Array]:
    """Orthonormal bases of mass-weighted angles: rigid and undamped, rigid and damped, all others."""
    count = vectors.shape[1]
    free = null_vectors(transformed(damping, vectors)) if count else np.zeros((0, 0))
    basis = np.linalg.qr(root.T @ vectors, mode="complete")[0]
    within = np.linalg.qr(basis[:, :count].T @ (root.T @ vectors @ free), mode="complete")[0]
    rigid = basis[:, :count] @ within
    return rigid[:, : free.shape[1]], rigid[:, free.shape[1] :], basis[:, count:]


def _scale(squares: Array) -> Array:
    omega = np.sqrt(np.maximum(squares, 0.0))
    fastest = omega.max(initial=0.0) or 1.0
    return np.asarray(np.where(omega > SLOWEST * fastest, omega, fastest))


def coordinates(
    mass: ArrayLike, damping: ArrayLike, stiffness: ArrayLike, weights: ArrayLike, rigid: ArrayLike | None = None
) -> Coordinates:
    """State coordinates of M q̈ + C q̇ + K q = 0 with its rigid modes taken out.

    ``mass``, ``damping``, ``stiffness`` (N, N), a mean stiffness of the laws included; ``weights`` (m, N) of the
    connections with laws; ``rigid`` (N, r): `null_vectors` of the weights of everything elastic, laws included.
    Raises ModelError where a rigid vector loads a spring, or the mass is not positive definite.

    >>> two = coordinates(np.eye(2), np.zeros((2, 2)), [[1.0, -1.0], [-1.0, 1.0]], [[-1.0, 1.0]], [[1.0], [1.0]])
    >>> two.size, two.removed, float(two.scale[0].round(6))
    (2, 2, 1.414214)
    """
    M, C, K, W = (np.atleast_2d(np.asarray(a, dtype=float)) for a in (mass, damping, stiffness, weights))
    try:
        root = np.linalg.cholesky(M)
    except np.linalg.LinAlgError:
        raise ModelError("the mass matrix must be positive definite", remedy="condense massless nodes first") from None
    vectors = _checked_rigid(rigid, K, W)
    free, damped, others = (np.asarray(np.linalg.solve(root.T, b), dtype=float) for b in _split_rigid(root, vectors, C))
    squares, modes = np.linalg.eigh(others.T @ K @ others)
    shapes, scale = others @ modes, _scale(squares)
    moving, count = np.hstack([shapes, damped]), len(scale)
    A = np.zeros((count + moving.shape[1],) * 2)
    A[:count, count : 2 * count] = np.diag(scale)
    A[count : 2 * count, :count] = -shapes.T @ K @ shapes / scale
    A[count:, count:] = -moving.T @ C @ moving
    removed = vectors.shape[1] + free.shape[1]
    return Coordinates(shapes, damped, scale, A, W @ shapes, moving.T @ M, removed)


@dataclass(frozen=True)
class Segments:
    """The stages of one law, from left to right: ``edges`` (j − 1) [rad], ``slopes`` k_j, ``offsets`` o_j [Nm]."""

    edges: Array
    slopes: Array
    offsets: Array


def _law_segments(parameters: ArrayLike) -> Segments:
    """Stages of a law given as k0 and rows of (gap, side, change of stiffness).

    >>> _law_segments([1.0, 1.0, 1.0, 1.0])
    Segments(edges=array([1.]), slopes=array([1., 2.]), offsets=array([ 0., -1.]))
    """
    values = np.asarray(parameters, dtype=float)
    gaps, sides, changes = values[1:].reshape(-1, 3).T
    edges = np.unique(gaps)
    middles = np.concatenate([edges[:1] - 1.0, 0.5 * (edges[1:] + edges[:-1]), edges[-1:] + 1.0])
    inside = middles if edges.size else np.zeros(1)
    engaged = np.where(sides * (inside[:, None] - gaps) > 0.0, changes, 0.0)
    return Segments(edges, values[0] + engaged.sum(axis=1), 0.0 - engaged @ gaps)


@dataclass(frozen=True)
class Basis:
    """Real basis of one combination of stages: A = V B V⁻¹, B of 1×1 blocks α and 2×2 blocks [[α, β], [−β, α]].

    ``decay`` α and ``turn`` β (size,) [1/s]: β > 0 stands at the first of a pair, −β at the second, 0 alone.
    ``plain``: the eigenvectors are too close to each other; V is one and a matrix exponential takes the place of B.
    """

    matrix: Array
    vectors: Array
    inverse: Array
    decay: Array
    turn: Array
    plain: bool


def _basis(matrix: Array) -> Basis:
    values, shapes = np.linalg.eig(matrix)
    # an eigenvector's phase is free; with real and imaginary part orthogonal a pair is conditioned best
    shapes = shapes * np.exp(-0.5j * np.angle(np.einsum("ij,ij->j", shapes, shapes)))
    vectors, first = shapes.real.copy(), np.flatnonzero(values.imag > 0.0)
    vectors[:, first + 1] = shapes.imag[:, first]
    vectors = np.ascontiguousarray(vectors)
    if np.linalg.cond(vectors) > ILL_CONDITIONED:
        one = np.eye(len(matrix))
        return Basis(matrix, one, one, np.zeros(len(matrix)), np.zeros(len(matrix)), True)
    return Basis(matrix, vectors, np.linalg.inv(vectors), values.real.copy(), values.imag.copy(), False)


def _mean_slope(law: Segments) -> float:
    stiff = np.sort(law.slopes[law.slopes > 0.0])
    return float(stiff[len(stiff) // 2]) if stiff.size else 0.0


@dataclass(frozen=True)
class StageBases:
    """The linear systems of a piecewise-linear one: one for each combination of stages, made once when first asked for.

    M, C, K as in `coordinates` but without the laws' stiffness; ``laws``: parameters (k0, then gap, side, change) of
    each connection in ``weights``.  A combination is one stage number a connection, counted from the left.  Its
    eigenvectors serve unless their condition number exceeds `ILL_CONDITIONED` (free flight without damping, critical
    damping), where a matrix exponential does.  Nothing here hangs on the speed of the excitation.

    >>> bases = StageBases([[1.0]], [[0.04]], [[0.0]], [[1.0]], [[1.0, 1.0, 1.0, 1.0]])
    >>> [round(float(abs(bases.basis((stage,)).turn[0])), 6) for stage in (0, 1)]
    [0.9998, 1.414072]
    """

    mass: ArrayLike
    damping: ArrayLike
    stiffness: ArrayLike
    weights: ArrayLike
    parameters: Sequence[ArrayLike]
    rigid: ArrayLike | None = None
    coordinates: Coordinates = field(init=False)
    laws: tuple[Segments, ...] = field(init=False)
    reference: Array = field(init=False)
    _bases: dict[tuple[int, ...], Basis] = field(init=False, default_factory=dict)
    _transitions: dict[tuple[tuple[int, ...], tuple[int, ...]], Array] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        weights = np.atleast_2d(np.asarray(self.weights, dtype=float))
        laws = tuple(_law_segments(values) for values in self.parameters)
        if len(weights) != len(laws):
            raise ModelError("every connection needs one law", found=f"{len(weights)} and {len(laws)}")
        reference = np.array([_mean_slope(law) for law in laws])
        stiffness = np.atleast_2d(np.asarray(self.stiffness, dtype=float)) + (weights.T * reference) @ weights
        state = coordinates(self.mass, self.damping, stiffness, weights, self.rigid)
        for name, value in (("coordinates", state), ("laws", laws), ("reference", reference)):
            object.__setattr__(self, name, value)

    def stage(self, angles: ArrayLike) -> IntArray:
        """Stage numbers (…, m) of the connections at their angles (…, m) [rad]."""
        given = np.asarray(angles, dtype=float)
        columns = [np.searchsorted(law.edges, given[..., e]) for e, law in enumerate(self.laws)]
        return np.stack(columns, axis=-1).astype(np.int64)

    def matrix(self, stages: Sequence[int]) -> Array:
        """Matrix A (size, size) [1/s] of ż = A z + … in a combination of stages."""
        state = self.coordinates
        slopes = np.array([law.slopes[j] for law, j in zip(self.laws, stages, strict=True)])
        return np.asarray(state.matrix - (state.rate_rows.T * (slopes - self.reference)) @ state.angle_rows)

    def basis(self, stages: Sequence[int]) -> Basis:
        """Eigenbasis of a combination of stages, kept for the next time."""
        key = tuple(int(j) for j in stages)
        if key not in self._bases:
            self._bases[key] = _basis(self.matrix(key))
        return self._bases[key]

    def transition(self, before: Sequence[int], after: Sequence[int]) -> Array:
        """V_after⁻¹ V_before: from the eigenbasis of one combination of stages to that of the next."""
        key = (tuple(int(j) for j in before), tuple(int(j) for j in after))
        if key not in self._transitions:
            self._transitions[key] = np.ascontiguousarray(self.basis(after).inverse @ self.basis(before).vectors)
        return self._transitions[key]
