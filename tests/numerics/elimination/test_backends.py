"""Coupled designs through array libraries against the compiled kernel."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest
from tests.numerics.elimination.test_coupling import NODES, system

from torsional.errors import ModelError
from torsional.numerics.elimination.backends import Backend, backend
from torsional.numerics.elimination.coupling import CoupledPlan

CASES, DESIGNS = 40, 30


def strict() -> Backend:
    """The standard and nothing else."""
    arrays: Any = importlib.import_module("array_api_strict")
    return Backend(arrays, lambda function: function, np.asarray)


@pytest.mark.parametrize("name", ["numpy", "strict", "jax"])
@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_an_array_library_gives_what_the_kernel_gives(name: str, seed: int) -> None:
    """Trees with a loop, loads and outputs inside and outside of what varies; to 1e-12 of each design's largest."""
    if name == "jax":
        pytest.importorskip("jax", reason="JAX is no dependency")
    random = np.random.default_rng(seed)
    weights, masses = system(seed, 1)
    weights = weights[:-1]  # no connection of three nodes
    plan = CoupledPlan.build(weights, masses, [1, 4], [2, 6])
    omega, speed = np.linspace(20.0, 300.0, CASES), np.full(CASES, 50.0)
    k, c = 1e4 * random.uniform(0.2, 5.0, len(weights)), random.uniform(5.0, 20.0, len(weights))
    eta, lift = np.full(len(weights), 0.02), np.full(len(weights), 0.01)
    loads = random.normal(size=(CASES, 2)) + 1j * random.normal(size=(CASES, 2))
    rest = plan.rest((k, eta, c, lift), np.ones(NODES), (omega, speed), [0, 4], loads, [1, 2, 7])
    own = k[plan.connections] * random.uniform(0.3, 3.0, (DESIGNS, plan.connections.size))
    values = own, *(table[None, plan.connections] for table in (eta, c, lift))
    J = random.uniform(0.3, 3.0, (DESIGNS, plan.masses.size))
    expected, flagged = plan.solve(rest, values, J)
    found, told = (strict() if name == "strict" else backend(name)).solve(plan, rest, values, J)
    scale = abs(expected).max(axis=(1, 2))
    assert (abs(found - expected).max(axis=(1, 2)) < 1e-12 * scale).all()
    np.testing.assert_array_equal(told, flagged)


def test_a_library_that_is_not_there_is_told() -> None:
    with pytest.raises(ModelError, match="there is no such array library"):
        backend("torch")
    if importlib.util.find_spec("cupy") is None:
        with pytest.raises(ModelError, match="the array library is not installed"):
            backend("cupy")
