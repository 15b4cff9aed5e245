"""One time step with one-sided springs as a linear complementarity problem: its formulation and certificate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array
from torsional.numerics.contacts.complementarity import Contacts, solve_contacts


@dataclass(frozen=True)
class Step:
    """How a method of the generalised-α family steps: h [s] and its α_m, α_f, γ, β."""

    length: float
    alpha_m: float
    alpha_f: float
    gamma: float
    beta: float


@dataclass(frozen=True)
class OneSided:
    """Springs λ_i = max(0, −k_i (g_i + τ_i ġ_i)) with gaps g = g0 + Wᵀq, open where positive.

    ``directions`` W (N, n), ``gap`` g0 (n,) [rad], ``stiffness`` k (n,) [Nm/rad], ``contact_time`` τ (n,) [s].
    """

    directions: Array
    gap: Array
    stiffness: Array
    contact_time: Array

    def opening(self, q: Array, v: Array) -> Array:
        """g + τ ġ (n,) [rad]."""
        return np.asarray(self.gap + self.directions.T @ q + self.contact_time * (self.directions.T @ v))

    def force(self, q: Array, v: Array) -> Array:
        """λ (n,) [Nm]."""
        return np.asarray(np.maximum(0.0, -self.stiffness * self.opening(q, v)))


@dataclass(frozen=True)
class StepProblem:
    """0 ≤ λ⁺ ⟂ p + M λ⁺ ≥ 0 of one step, and the motion at its end for the λ⁺ that solves it.

    ``matrix`` M (n, n), ``offset`` p (n,), ``scale`` sqrt(k) (n,); ``predicted``: q, v (N,) without a⁺; ``free`` (N,):
    a⁺ without λ⁺; ``response`` (N, n): ∂a⁺/∂λ⁺.
    """

    matrix: Array
    offset: Array
    scale: Array
    predicted: tuple[Array, Array]
    free: Array
    response: Array
    step: Step

    def solve(self, closed: ArrayLike | None = None) -> Contacts:
        """The contact forces at the step's end."""
        return solve_contacts(self.matrix, self.offset, closed=closed, scale=self.scale)

    def end(self, force: Array) -> tuple[Array, Array, Array]:
        """q⁺, v⁺, a⁺ (N,) for contact forces λ⁺ (n,)."""
        a = self.free + self.response @ force
        h, (q, v) = self.step.length, self.predicted
        return q + self.step.beta * h * h * a, v + self.step.gamma * h * a, a


def step_problem(
    system: tuple[Array, Array, Array],
    contacts: OneSided,
    state: tuple[Array, Array, Array, Array],
    loads: tuple[Array, Array],
    step: Step,
) -> StepProblem:
    """The step of M q̈ + C q̇ + K q = u + W λ from (q, v, a, λ) and the loads at its begin and end (N,) [Nm].

        A a⁺ = r + (1−α_f) W λ⁺,  A = (1−α_m) M + (1−α_f)(γh C + βh² K)
        M_lcp = (1−α_f)(βh² I + γh T) WᵀA⁻¹W + diag(1/k),  p = g + τ ġ of the motion without λ⁺,  T = diag(τ)

    ``system``: M, C, K (N, N).  M_lcp is a positive diagonal times a positive semidefinite matrix plus a positive
    diagonal, hence a P-matrix for every h > 0.  Source: Chung and Hulbert, J. Appl. Mech. 60 (1993) 371, with the
    contacts at the end of the step.

    >>> one, none = np.eye(1), np.zeros(1)
    >>> wall = OneSided(one, np.array([-0.1]), np.array([100.0]), none)
    >>> newmark = Step(1e-3, 0.0, 0.0, 0.5, 0.25)
    >>> step_problem((one, 0.0 * one, 0.0 * one), wall, (none, none, none, none), (none, none), newmark).solve().force
    array([9.99975001])
    """
    (M, C, K), (q, v, a, force) = system, state
    h, m, f, W = step.length, step.alpha_m, step.alpha_f, contacts.directions
    q_next = q + h * v + (0.5 - step.beta) * h * h * a
    v_next = v + (1.0 - step.gamma) * h * a
    A = (1.0 - m) * M + (1.0 - f) * (step.gamma * h * C + step.beta * h * h * K)
    begin = loads[0] + W @ force - C @ v - K @ q
    right = f * begin - m * (M @ a) + (1.0 - f) * (loads[1] - C @ v_next - K @ q_next)
    solved = np.asarray(np.linalg.solve(A, np.column_stack([right, (1.0 - f) * W])), dtype=float)
    free, response = solved[:, 0], solved[:, 1:]
    share = step.beta * h * h + step.gamma * h * contacts.contact_time
    matrix = share[:, None] * (W.T @ response) + np.diag(1.0 / contacts.stiffness)
    offset = contacts.opening(q_next, v_next) + share * (W.T @ free)
    return StepProblem(matrix, offset, np.sqrt(contacts.stiffness), (q_next, v_next), free, response, step)
