"""Receptance coupling against the elimination of the whole system."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from torsional.numerics.elimination.coupling import CoupledPlan
from torsional.numerics.elimination.plan import EliminationPlan

NODES, DESIGNS, CASES = 9, 70, 11


def system(seed: int, loops: int) -> tuple[np.ndarray, np.ndarray]:
    """Weights of a random tree with some loops and one connection of three nodes, and of masses on every node."""
    random = np.random.default_rng(seed)
    rows = []
    for node in range(1, NODES):
        row = np.zeros(NODES)
        row[[node, random.integers(node)]] = 1.0, -1.0
        rows.append(row)
    for _ in range(loops):
        row = np.zeros(NODES)
        row[random.choice(NODES, 2, replace=False)] = 1.0, -1.0
        rows.append(row)
    three = np.zeros(NODES)
    three[random.choice(NODES, 3, replace=False)] = 1.0, 2.0, -3.0
    return np.array([*rows, three]), np.eye(NODES)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), loops=st.integers(0, 3), count=st.integers(1, 3))
def test_coupled_designs_respond_as_whole_ones(seed: int, loops: int, count: int) -> None:
    """Loads and outputs inside and outside of what varies; values of the shared part that differ from case to case."""
    random = np.random.default_rng(seed + 1)
    weights, masses = system(seed, loops)
    varied = random.choice(len(weights) - 1, count, replace=False)
    heavy = random.choice(NODES, count, replace=False)
    plan = CoupledPlan.build(weights, masses, varied.tolist(), heavy.tolist())
    omega = np.sort(random.uniform(20.0, 300.0, CASES))
    speed = np.full(CASES, 50.0)
    base = {"k": 1e4 * random.uniform(0.2, 5.0, (CASES, len(weights))), "c": random.uniform(1.0, 20.0, len(weights))}
    eta, lift, inertia = np.full(len(weights), 0.02), np.full(len(weights), 0.01), random.uniform(0.1, 2.0, NODES)
    nodes, outputs = [0, 4], [2, 7]
    loads = random.normal(size=(CASES, 2)) + 1j * random.normal(size=(CASES, 2))
    rest = plan.rest((base["k"], eta, base["c"], lift), inertia, (omega, speed), nodes, loads, outputs)
    k = np.repeat(base["k"][:1], DESIGNS, axis=0)
    k[:, plan.connections] *= random.uniform(0.3, 3.0, (DESIGNS, plan.connections.size))
    J = inertia * random.uniform(0.3, 3.0, (DESIGNS, NODES))
    rows = (k[:, plan.connections], *(table[None, plan.connections] for table in (eta, base["c"], lift)))
    found, flagged = plan.solve(rest, rows, J[:, plan.masses])
    some, _ = plan.solve(rest.at(np.array([3, 8])), rows, J[:, plan.masses])
    np.testing.assert_array_equal(some, found[..., [3, 8]])
    whole = EliminationPlan.build(weights, masses)
    for case in range(CASES):
        own, bodies = np.repeat(base["k"][case : case + 1], DESIGNS, axis=0), np.repeat(inertia[None], DESIGNS, axis=0)
        own[:, plan.connections], bodies[:, plan.masses] = k[:, plan.connections], J[:, plan.masses]
        at = slice(case, case + 1)
        x, _ = whole.solve(own, eta, base["c"], lift, bodies, omega[at], speed[at], nodes, loads[at, None, :], outputs)
        sound = ~flagged[:, case]
        scale = abs(x).max(axis=(1, 2, 3))[sound]
        assert (abs(found[sound, :, case] - x[sound, 0, 0]).max(axis=1) < 1e-10 * scale).all()
    assert flagged.mean() < 0.1


def test_a_case_has_the_same_bits_alone() -> None:
    weights, masses = system(3, 1)
    plan = CoupledPlan.build(weights, masses, [2], [5])
    omega, speed = np.linspace(10.0, 200.0, 7), np.zeros(7)
    ones, nothing = np.full(len(weights), 1e4), np.zeros(len(weights))
    rest = plan.rest((ones, nothing, ones * 1e-3, nothing), np.ones(NODES), (omega, speed), [0], np.ones((7, 1)), [1])
    stiffness = np.linspace(5e3, 5e4, 301)[:, None] * np.ones(plan.connections.size)
    others = (nothing, 1e-3 * ones, nothing)
    values = (stiffness, *(table[None, plan.connections] for table in others))
    every, _ = plan.solve(rest, values, np.ones((1, 1)))
    for design in (0, 63, 300):
        alone, _ = plan.solve(rest, (stiffness[design : design + 1], *values[1:]), np.ones((1, 1)))
        np.testing.assert_array_equal(alone[0], every[design])


def test_a_resonance_of_the_shared_part_is_flagged() -> None:
    """Two discs on a spring, met exactly where the second, alone, resonates against the first held still."""
    plan = CoupledPlan.build(np.array([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]]), np.eye(3), [0], [0])
    values = (np.array([1.0, 4.0]), *(np.zeros(2) for _ in range(3)))
    omega = np.array([1.3, 2.0])
    rest = plan.rest(values, np.ones(3), (omega, np.zeros(2)), [0], np.ones((2, 1)), [0])
    assert rest.sound.tolist() == [True, False]
    _, flagged = plan.solve(rest, tuple(v[None, :1] for v in values), np.ones((1, 1)))
    assert flagged.tolist() == [[False, True]]
