"""L1 and L3: the forced response of one chain at many frequencies, the modes of many designs.

Every contender's numbers are checked against a dense solver before its time counts.
"""

from __future__ import annotations

import chain15
import modal_floor
import numpy as np
import ours
import peers
import pytest

SOLVES = chain15.RPM.size * chain15.ORDERS.size
DESIGNS, FEW = 10_000, 1_000

CHAIN = peers.assembly()
RESPONSES = {
    "NumPy, batched solve": lambda: chain15.dense,
    "openTorsion, one call": lambda: lambda: peers.opentorsion_response(CHAIN),
    "openTorsion, a call for each speed": lambda: lambda: peers.opentorsion_by_speed(CHAIN),
    "torsional, harmonic_response": ours.public_response,
    "torsional, the elimination alone": ours.kernel_response,
}


@pytest.mark.parametrize("contender", RESPONSES)
def test_l1_response(contender, timed, declared):
    title = "15 discs, 500 speeds x 24 half orders, angles and shaft torques; a case is one complex solve"
    declared("L1", title, ours.response_floor())
    work = RESPONSES[contender]()
    result = timed(work, task="L1", contender=contender, cases=SOLVES, rounds=9)
    for found, expected in zip(result, chain15.dense(), strict=False):
        assert _apart(found, expected) < 1e-8


def _apart(found: np.ndarray, expected: np.ndarray) -> float:
    """Largest difference, relative to the largest entry of its case (last axis)."""
    scale = np.abs(expected).max(axis=-1, keepdims=True)
    return float((np.abs(found - expected) / scale).max())


MODES = {"SciPy, eigh in a loop": (peers.scipy_modes, FEW), "NumPy, batched eigh": (peers.numpy_modes, DESIGNS)}


@pytest.mark.parametrize("contender", MODES)
def test_l3_modes(contender, timed, declared):
    declared(
        "L3", "modes with vectors of designs of 15 discs, matrices given; a case is one design", modal_floor.floor()
    )
    find, count = MODES[contender]
    inertia, stiffness = chain15.designs(count)
    K = peers.stiffness_matrices(stiffness)
    values, vectors = timed(lambda: find(inertia, K), task="L3", contender=contender, cases=count, rounds=3)
    _check_modes(values, vectors, inertia, K)


def test_l3_modes_torsional(timed):
    inertia, stiffness = chain15.designs(DESIGNS)
    values, vectors = timed(
        lambda: ours.modes(inertia, stiffness), task="L3", contender="torsional, modes", cases=DESIGNS, rounds=3
    )
    _check_modes(values, vectors, inertia, peers.stiffness_matrices(stiffness))


def test_l3_modes_opentorsion(timed):
    inertia, stiffness = chain15.designs(FEW)
    chains = [peers.assembly(*design) for design in zip(inertia, stiffness, strict=True)]
    values, vectors = timed(
        lambda: peers.opentorsion_modes(chains), task="L3", contender="openTorsion, a loop", cases=FEW, rounds=3
    )
    _check_modes(values.real, vectors, inertia, peers.stiffness_matrices(stiffness))


def _check_modes(values: np.ndarray, vectors: np.ndarray, inertia: np.ndarray, K: np.ndarray) -> None:
    """Frequencies as NumPy finds them, and vectors that solve K v = λ J v; in any order."""
    expected = np.sqrt(np.abs(peers.numpy_modes(inertia, K)[0]))
    found = np.sqrt(np.abs(np.sort(values, axis=1)))
    np.testing.assert_allclose(found[:, 1:], expected[:, 1:], rtol=1e-8)
    residual = K @ vectors - inertia[:, :, None] * vectors * values[:, None, :]
    scale = np.abs(K).max() * np.abs(vectors).max(axis=1, keepdims=True)
    assert (np.abs(residual) / scale).max() < 1e-9
