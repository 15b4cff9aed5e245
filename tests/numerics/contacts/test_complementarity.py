"""Contacts as a linear complementarity problem against enumeration, Lemke's method and exact motion."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from quantecon.optimize import lcp_lemke

from torsional.errors import ModelError
from torsional.numerics.contacts.complementarity import solve_contacts, violation
from torsional.numerics.contacts.step import OneSided, Step, step_problem

Array = np.ndarray


def random_contacts(seed: int, count: int, coordinates: int, decades: float = 2.0) -> tuple[Array, Array]:
    """M = positive diagonal times WᵀA⁻¹W plus positive diagonal, as steps make it; not symmetric, often redundant."""
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(coordinates, coordinates))
    directions = rng.choice([-1.0, 0.0, 1.0], size=(coordinates, count))
    flexible = directions.T @ np.linalg.solve(half @ half.T + 0.1 * np.eye(coordinates), directions)
    share = 10.0 ** rng.uniform(-0.5 * decades, 0.5 * decades, count)
    return share[:, None] * flexible + np.diag(10.0 ** rng.uniform(-decades, 0.0, count)), rng.normal(size=count)


def general(seed: int, count: int) -> tuple[Array, Array]:
    """A P-matrix that is far from symmetric: positive definite part plus a large skew one."""
    rng = np.random.default_rng(seed)
    part, turn = rng.normal(size=(2, count, count))
    return part @ part.T / count + 0.05 * np.eye(count) + 3.0 * (turn - turn.T), rng.normal(size=count)


def enumerated(matrix: Array, offset: Array) -> Array:
    """The solution by trying every set of closed contacts."""
    best, found = np.inf, np.zeros(len(offset))
    for closed in product([False, True], repeat=len(offset)):
        c, force = np.array(closed), np.zeros(len(offset))
        force[c] = np.linalg.solve(matrix[np.ix_(c, c)], -offset[c])
        miss = -min(force.min(), (offset + matrix @ force).min())
        if miss < best:
            best, found = miss, force
    return found


def lemke(matrix: Array, offset: Array) -> Array:
    """quantecon's Lemke, of the problem scaled to ones on the diagonal; refined once by its own basis."""
    d = 1.0 / np.sqrt(np.diag(matrix))
    scaled, right = d[:, None] * matrix * d, d * offset
    answer = lcp_lemke(scaled, right)
    assert answer.success
    closed, force = answer.z > right + scaled @ answer.z, np.zeros(len(offset))
    force[closed] = np.linalg.solve(scaled[np.ix_(closed, closed)], -right[closed])
    np.testing.assert_allclose(force, answer.z, atol=1e-7 * np.abs(force).max())
    return d * force


def agree(matrix: Array, offset: Array, expected: Array) -> None:
    """To 1e-12 of the largest force, in scaled units."""
    found = solve_contacts(matrix, offset).force
    size = np.sqrt(np.diag(matrix))
    np.testing.assert_allclose(size * found, size * expected, rtol=0.0, atol=1e-12 * (size * expected).max(initial=1.0))
    assert violation(matrix, offset, found) < 1e-12


@pytest.mark.parametrize("count", [1, 2, 3, 5, 8])
def test_enumeration_of_every_set_of_contacts(count: int) -> None:
    for seed in range(12):
        agree(*random_contacts(seed, count, 4), enumerated(*random_contacts(seed, count, 4)))
        agree(*general(seed, count), enumerated(*general(seed, count)))


@pytest.mark.parametrize(("count", "coordinates"), [(10, 12), (34, 18), (60, 18)])
def test_lemke(count: int, coordinates: int) -> None:
    for seed in range(20):
        agree(*random_contacts(seed, count, coordinates), lemke(*random_contacts(seed, count, coordinates)))
        agree(*general(seed, count), lemke(*general(seed, count)))


def test_stiffness_over_many_decades() -> None:
    """Springs of 1e4 to 1e8 on inertias of 1e-3 to 10: the scale is sqrt(k), the certificate tells."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        stiffness = 10.0 ** rng.uniform(4.0, 8.0, 30)
        directions = rng.choice([-1.0, 0.0, 1.0], size=(12, 30))
        bodies = np.diag(10.0 ** rng.uniform(-3.0, 1.0, 12))
        matrix = 1e-9 * directions.T @ np.linalg.solve(bodies, directions) + np.diag(1.0 / stiffness)
        offset = 1e-3 * rng.normal(size=30)
        found = solve_contacts(matrix, offset, scale=np.sqrt(stiffness))
        assert violation(matrix, offset, found.force, np.sqrt(stiffness)) < 1e-12
        np.testing.assert_allclose(found.force, lemke(matrix, offset), rtol=0, atol=1e-12 * found.force.max())


def test_redundant_and_degenerate_contacts() -> None:
    """Every contact three times, with gaps of exactly zero, loads of exactly zero and forces of exactly zero."""
    for seed in range(40):
        rng = np.random.default_rng(seed)
        directions = np.repeat(rng.integers(-1, 2, size=(6, 9)).astype(float), 3, axis=1)
        matrix = directions.T @ directions + np.diag(np.full(27, 2.0 ** -rng.integers(0, 20)))
        force = np.where(rng.random(27) < 0.3, rng.integers(1, 4, 27), 0.0)
        gap = np.where((rng.random(27) < 0.5) & (force == 0.0), rng.integers(0, 2, 27), 0.0)
        offset = gap - matrix @ force  # w = 0 and λ = 0 at once wherever both are
        found = solve_contacts(matrix, offset)
        np.testing.assert_allclose(found.force, force, rtol=0, atol=1e-9)
        assert violation(matrix, offset, found.force) < 1e-13
    assert solve_contacts(matrix, np.zeros(27)).force.tolist() == [0.0] * 27


def test_one_at_a_time_where_blocks_go_in_circles() -> None:
    """Sets that change as blocks return to where they were for some of these; Murty's rule ends them."""
    singles = []
    for seed in range(300):
        matrix, offset = general(seed, 7)
        found = solve_contacts(matrix, offset)
        singles.append(found.single)
        assert violation(matrix, offset, found.force) < 1e-13
    assert max(singles) > 0 and np.median(singles) == 0.0


def test_a_warm_start_takes_one_pass() -> None:
    matrix, offset = random_contacts(3, 34, 18)
    cold = solve_contacts(matrix, offset)
    warm = solve_contacts(matrix, offset * (1.0 + 1e-9), closed=cold.closed)
    assert cold.passes > 1 and warm.passes == 1 and warm.closed.tolist() == cold.closed.tolist()


def test_the_certificate_sees_every_kind_of_fault() -> None:
    matrix, offset = random_contacts(5, 8, 4)
    force = solve_contacts(matrix, offset).force
    pushing, idle = int(np.argmax(force)), int(np.argmin(force))
    assert force[idle] == 0.0 < force[pushing]
    for place, change in ((pushing, 1e-6), (pushing, -1e-6), (idle, 1e-6), (idle, -1e-6)):
        wrong = force.copy()
        wrong[place] += change
        assert violation(matrix, offset, wrong) > 1e-9


def test_what_is_no_problem_of_contacts_is_refused() -> None:
    assert solve_contacts(np.zeros((0, 0)), []).force.size == 0
    for matrix, offset in (([[1.0, 0.0]], [1.0]), ([[1.0]], [np.nan])):
        with pytest.raises(ModelError, match="finite square matrix"):
            solve_contacts(matrix, offset)
    with pytest.raises(ModelError, match="positive diagonal"):
        solve_contacts([[0.0]], [-1.0])
    with pytest.raises(ModelError, match="no solution"):
        solve_contacts([[1.0, 1.0], [1.0, 1.0]], [-1.0, -1.0], closed=[1, 1])


# --- the step --------------------------------------------------------------------------------------------------------


def chung_hulbert(h: float, rho: float) -> Step:
    m, f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    return Step(h, m, f, 0.5 - m + f, 0.25 * (1 - m + f) ** 2)


def stepped(step: Step, steps: int, contact_time: float = 0.0) -> tuple[Array, Array]:
    """A mass of 1 that flies with v = −1 at a spring of 100, 0.1 away."""
    one, zero = np.eye(1), np.zeros(1)
    wall = OneSided(one, np.array([0.1]), np.array([100.0]), np.array([contact_time]))
    q, v, a, force = zero, -np.ones(1), zero, zero
    for _ in range(steps):
        problem = step_problem((one, 0 * one, 0 * one), wall, (q, v, a, force), (zero, zero), step)
        force = problem.solve(force > 0.0).force
        q, v, a = problem.end(force)
        np.testing.assert_allclose(force, wall.force(q, v), atol=1e-12)
    return q, v


@pytest.mark.parametrize("rho", [1.0, 0.8, 0.0])
def test_steps_converge_to_a_contact_of_pi_tenths(rho: float) -> None:
    """Exact: back at −0.1 after 0.1 + π/10 s with v = 1; the error falls with the square of the step."""
    end = 0.1 + 0.1 * np.pi + 0.2
    miss = [abs(stepped(chung_hulbert(end / n, rho), n)[0][0] - 0.1) for n in (100, 200, 400, 800)]
    assert miss[-1] < 1e-5
    assert np.log2(miss[0] / miss[-1]) / 3.0 > 1.7


def test_the_steps_matrix_is_one_of_contacts_whatever_the_step() -> None:
    """Every principal minor of M_lcp is positive from h = 1e-7 to 1 s, contacts given twice included."""
    rng = np.random.default_rng(1)
    half = rng.normal(size=(3, 3))
    system = (np.diag([0.003, 1.0, 20.0]), 2.0 * half @ half.T, 1e4 * half @ half.T)
    directions = np.repeat(rng.choice([-1.0, 1.0], size=(3, 3)), 2, axis=1)
    wall = OneSided(directions, rng.normal(size=6), 10.0 ** rng.uniform(4, 8, 6), 10.0 ** rng.uniform(-6, -3, 6))
    state = (*rng.normal(size=(3, 3)), np.zeros(6))
    for h in 10.0 ** np.arange(-7.0, 1.0):
        problem = step_problem(system, wall, state, (np.zeros(3), np.ones(3)), chung_hulbert(h, 0.8))
        scaled = problem.scale[:, None] * problem.matrix * problem.scale
        for closed in product([False, True], repeat=6):
            c = np.array(closed)
            assert not c.any() or np.linalg.det(scaled[np.ix_(c, c)]) > 0.0
        solved = problem.solve()
        assert violation(problem.matrix, problem.offset, solved.force, problem.scale) < 1e-10
        q, v, _ = problem.end(solved.force)
        np.testing.assert_allclose(wall.force(q, v), solved.force, rtol=1e-6, atol=1e-6 * solved.force.max())
