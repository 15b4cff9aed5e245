"""Constraint elimination and structural null spaces against graph theory and hand-solved gear trains."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from torsional.numerics.linear.null_space import CANCELLED, eliminate, null_vectors, transformed


def shafts(pairs: list[tuple[int, int]], nodes: int) -> np.ndarray:
    rows = np.zeros((len(pairs), nodes))
    for row, (a, b) in zip(rows, pairs, strict=True):
        row[b] += 1.0
        row[a] -= 1.0
    return rows


networks = st.integers(2, 40).flatmap(
    lambda n: st.tuples(
        st.just(n),
        st.lists(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)).filter(lambda p: p[0] != p[1]), max_size=60),
    )
)


@given(networks)
@settings(deadline=None, max_examples=60)
def test_rigid_modes_of_plain_shafts_are_the_connected_parts(network: tuple[int, list[tuple[int, int]]]) -> None:
    nodes, pairs = network
    vectors = null_vectors(shafts(pairs, nodes))
    start, end = [a for a, _ in pairs], [b for _, b in pairs]
    count, label = connected_components(coo_array((np.ones(len(pairs)), (start, end)), shape=(nodes, nodes)), False)
    expected = {tuple(np.where(label == part, 1.0, 0.0)) for part in range(count)}
    assert vectors.shape == (nodes, count)
    assert {tuple(vector) for vector in vectors.T} == expected  # exact ones and zeros


def test_a_spring_to_ground_leaves_no_rigid_mode() -> None:
    assert null_vectors([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, 1.0]]).shape == (3, 0)


def test_no_rows_leave_every_node_free() -> None:
    np.testing.assert_array_equal(null_vectors(np.zeros((0, 3))), np.eye(3))


def test_loop_of_gears_on_shafts_keeps_its_rigid_mode_despite_rounding() -> None:
    """Ratios 0.1 · 3 and 0.3 differ in the last bit; both paths join the same two nodes."""
    rows = [[0.1, -1.0, 0.0], [0.0, 3.0, -1.0], [0.3, 0.0, -1.0]]
    assert 0.1 * 3 != 0.3
    vectors = null_vectors(rows)
    assert vectors.shape == (3, 1)
    np.testing.assert_allclose(vectors[:, 0] / vectors[0, 0], [1.0, 0.1, 0.3], rtol=1e-15)


def test_gear_pair_makes_the_node_of_the_larger_weight_dependent() -> None:
    found = eliminate([{0: 1.0, 1: 2.5}], nodes=3)  # θ0 + 2.5 θ1 = 0
    assert found.independent == (0, 2)
    np.testing.assert_array_equal(found.transform, [[1.0, 0.0], [-0.4, 0.0], [0.0, 1.0]])
    assert found.redundant == () and found.locked == ()


def test_equal_weights_keep_the_earlier_node() -> None:
    assert eliminate([{0: 1.0, 1: -1.0}], nodes=2).independent == (0,)


def test_planetary_set_with_held_ring_is_a_fixed_ratio() -> None:
    """Willis: sun s, ring r with ratio i0 = −z_r/z_s: θs − i0 θr − (1−i0) θc = 0; ring held: θs = (1−i0) θc."""
    ratio, ground = -2.7, 3
    rows = [{0: 1.0, 1: -ratio, 2: ratio - 1.0}, {1: 1.0, ground: -1.0}]
    found = eliminate(rows, nodes=4, ground=ground)
    transform = found.transform
    assert transform.shape == (4, 1) and found.locked == () and found.redundant == ()
    assert transform[0, 0] / transform[2, 0] == pytest.approx(3.7, rel=1e-15)
    np.testing.assert_array_equal(transform[[1, ground]], 0.0)


def test_locked_planetary_set_turns_as_a_block() -> None:
    rows = [{0: -1.3, 1: 2.3, 2: -1.0}, {0: 1.0, 1: -1.0}]
    np.testing.assert_allclose(eliminate(rows, nodes=3).transform, np.ones((3, 1)), rtol=1e-15)


def test_contradictory_gear_loop_names_its_gears_and_the_nodes_it_locks() -> None:
    """Rows 1 and 3 ask for ratios 2 and 3 between the same shafts; the others are innocent."""
    rows = [{4: 1.0, 5: -1.7}, {0: 1.0, 1: -2.0}, {2: 1.0, 3: -1.1}, {0: 1.0, 1: -3.0}]
    found = eliminate(rows, nodes=6)
    assert {(loop.node, loop.rows) for loop in found.locked} == {(0, (1, 3)), (1, (1, 3))}
    np.testing.assert_array_equal(found.transform[[0, 1]], 0.0)
    assert found.redundant == ()


def test_consistent_gear_loop_is_redundant_and_names_its_gears() -> None:
    rows = [{0: 0.1, 1: -1.0}, {1: 3.0, 2: -1.0}, {3: 1.0, 4: 1.0}, {0: 0.3, 2: -1.0}]
    found = eliminate(rows, nodes=5)
    assert [loop.rows for loop in found.redundant] == [(0, 1, 3)]
    assert found.locked == () and len(found.independent) == 2


def test_two_brakes_on_one_gear_train_are_redundant_not_contradictory() -> None:
    rows = [{0: 1.0, 1: -2.0}, {0: 1.0, 2: -1.0}, {1: 1.0, 2: -1.0}]
    found = eliminate(rows, nodes=3, ground=2)
    assert found.locked == () and len(found.redundant) == 1 and found.transform.shape == (3, 0)


def test_holding_without_ground_is_reported_as_locked() -> None:
    assert eliminate([{1: 1.0}], nodes=2).locked[0].node == 1


@given(st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=60)
def test_random_gear_trains_meet_their_conditions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(3, 41))
    rows = []
    for node in range(2, nodes):
        ratio = 10.0 ** rng.uniform(-1, 1.3)
        a, b = rng.choice(node, 2, replace=False)
        kind = rng.integers(3)
        if kind < 2:
            rows.append({int(a): ratio, node: -1.0} if kind else {int(a): 1.0 - ratio, int(b): ratio, node: -1.0})
    found = eliminate(rows, nodes)
    dense = np.zeros((len(rows), nodes))
    for i, row in enumerate(rows):
        dense[i, list(row)] = list(row.values())
    size = np.abs(dense) @ np.abs(found.transform)
    assert len(found.independent) == nodes - len(rows)
    # forty planetary sets in a row cancel: one train in five hundred is 1e-13 to 7e-13 off
    assert np.all(np.abs(dense @ found.transform) <= CANCELLED * size)
    assert found.redundant == () and found.locked == ()
    np.testing.assert_array_equal(found.transform[list(found.independent)], np.eye(nodes - len(rows)))


def test_transformed_rows_cancel_exactly() -> None:
    assert transformed([[1.0, -3.0]], [[0.3], [0.1]]) == 0.0 != 0.3 - 3.0 * 0.1
