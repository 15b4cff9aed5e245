"""Undamped modes against published cases, closed forms and 50-digit arithmetic."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.numerics.modes.counting import count_below

from torsional.errors import ModelError
from torsional.numerics.linear.null_space import eliminate, transformed
from torsional.numerics.modes import jacobi
from torsional.numerics.modes.undamped import Modes, modes

HERTZ = 2.0 * np.pi
seeds = st.integers(0, 2**32 - 1)


def chain(count: int) -> np.ndarray:
    return np.diff(np.eye(count), axis=0)


def chain_modes(inertia: list[float], stiffness: list[float]) -> Modes:
    return modes(chain(len(inertia)), stiffness, np.eye(len(inertia)), inertia)


# --- published cases -------------------------------------------------------------------------------------------------


def test_two_discs() -> None:
    """openTorsion test set; closed form ω² = k (1/J1 + 1/J2)."""
    omega = chain_modes([211.4, 8.3], [9.775e6]).omega
    assert omega[0] == 0.0
    assert omega[1] == pytest.approx(np.sqrt(9.775e6 * (1 / 211.4 + 1 / 8.3)), rel=1e-15)
    assert round(omega[1] / HERTZ, 1) == 176.1


def test_holzer_table() -> None:
    """Thomson, Theory of Vibration, Table 12.4-1."""
    np.testing.assert_allclose(chain_modes([5, 11, 22], [1e5, 2e5]).omega[1:], [123.665800, 202.658349], atol=5e-7)


def test_friswell_engine() -> None:
    """Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines, Example 9.7.1."""
    omega = chain_modes([3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05], [12e3, 12e3, 14e3, 10e3]).omega
    np.testing.assert_allclose(omega[1:] / HERTZ, [81.21, 141.21, 378.95, 536.36], atol=5e-3)


def test_friswell_gears_one_to_one() -> None:
    """Ibid.: a machine and its gear drive two discs through an equal gear; the gears are one coordinate."""
    rows = [[-1, 1, 0, 0], [0, -1, 1, 0], [0, -1, 0, 1]]
    omega = modes(rows, [1e4, 5e3, 5e3], np.eye(4), [400e-6, 50e-6, 700e-6, 700e-6]).omega
    np.testing.assert_allclose(omega[1:] / HERTZ, [425.4, 634.1, 3247.2], atol=0.05)


def test_tube_with_consistent_mass() -> None:
    """Ibid., Example 9.9: five and fifty elements; element mass J/6 [[2, 1], [1, 2]] as a mean and a difference."""
    expected = {5: [1.9417, 4.0719, 6.5437, 9.1547], 50: [1.9106, 3.8232, 5.7394, 7.6613]}
    polar = np.pi / 32 * (0.78**4 - 0.65**4)
    for count, hertz in expected.items():
        length = 800.0 / count
        mean, ends = (np.eye(count + 1)[1:] + np.eye(count + 1)[:-1]) / 2, np.eye(count + 1)[[0, -1]]
        inertia = np.r_[np.full(count, 8000 * polar * length), np.full(count, 8000 * polar * length / 12), 200.0, 10.0]
        weights = np.vstack([mean, chain(count + 1), ends])
        omega = modes(chain(count + 1), np.full(count, 75e9 * polar / length), weights, inertia).omega
        np.testing.assert_allclose(omega[1:5] / HERTZ, hertz, atol=5e-5)


def test_six_cylinder_diesel_to_all_digits() -> None:
    """Data of Mendes, Meirelles and Zampieri, IMechE K 222 (2008) 155, doi 10.1243/14644193JMBD126."""
    inertia = [0.0170, 0.0090, 0.0467, 0.0327, 0.0467, 0.0467, 0.0327, 0.0487, 2.0750]
    stiffness = 1e6 * np.array([1.106, 1.631, 1.253, 1.253, 1.678, 1.253, 1.253, 1.976])
    hertz = [216.5836, 592.7405, 984.9230, 1171.0174, 1415.9950, 1660.0439, 1794.3876, 2993.4736]
    np.testing.assert_allclose(chain_modes(inertia, list(stiffness)).omega[1:] / HERTZ, hertz, atol=5e-5)


def test_rubber_damper() -> None:
    """Closed form: free ω² = k (1/J1 + 1/J2) with mode [1, −J1/J2]; hub fixed ω² = k/J2."""
    free = chain_modes([0.10, 0.20], [1000.0])
    assert free.omega[1] / HERTZ == pytest.approx(19.492420030841906, rel=1e-15)
    np.testing.assert_allclose(free.shapes[:, 1] / free.shapes[0, 1], [1.0, -0.5], rtol=1e-15)
    assert modes([[1.0]], [1000.0], [[1.0]], [0.20]).omega[0] / HERTZ == pytest.approx(11.253953951963826, rel=1e-15)


def test_dual_mass_flywheel_pair() -> None:
    """Closed form; the modal sum must give the response per Nm at 30 Hz, rigid mode included."""
    omega, shapes = chain_modes([1.8, 1.2], [12e3])
    assert omega[1] / HERTZ == pytest.approx(20.54681480, abs=5e-9)
    response = shapes @ (shapes[0] / (omega**2 - (HERTZ * 30.0) ** 2))
    np.testing.assert_allclose(response, [-2.11618759e-5, 8.28883610e-6], rtol=1e-8)


def test_power_split_vibration_absorber() -> None:
    """Two ideal gear constraints, hence a mass matrix with a full block: θ3 = (1−g)θ1 + gθ2, θ4 = (1−r)θ1 + rθ2.

    Expected: the 3 × 3 matrices written out by hand and solved in 40-digit arithmetic.
    """
    g, r = 2.5, 0.6
    rows = [{2: -1.0, 0: 1 - g, 1: g}, {3: -1.0, 0: 1 - r, 1: r}]
    transform = eliminate(rows, nodes=5).transform
    elastic = transformed([[-1, 1, 0, 0, 0], [0, 0, 0, -1, 1]], transform)
    omega = modes(elastic, [20e3, 60e3], transform, [1.8, 0.5, 0.02, 1.2, 8.0]).omega
    assert omega[0] == 0.0
    np.testing.assert_allclose(omega[1:] / HERTZ, [21.3016010963, 34.0479811608], rtol=1e-11)


def test_dual_mass_flywheel_with_tuned_absorber() -> None:
    """J1 –30e3– Jm –30e3– J2 –60e3– J5 with Ja = 0.15 on Jm by 15e3: a tree, not a chain."""
    rows = np.zeros((4, 5))
    for row, (a, b) in zip(rows, [(0, 1), (1, 2), (2, 3), (1, 4)], strict=True):
        row[a], row[b] = -1.0, 1.0
    omega = modes(rows, [30e3, 30e3, 60e3, 15e3], np.eye(5), [1.8, 0.05, 1.2, 8.0, 0.15]).omega
    np.testing.assert_allclose(omega[1:] / HERTZ, [14.2024806, 40.1208472, 47.7352941, 197.358413], atol=5e-7)


# --- random models ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Network:
    """Discs, shafts (b may be None: ground), gear pairs θb = ratio θa and planetary sets θc = (1−g)θa + gθb."""

    inertia: np.ndarray
    stiffness: np.ndarray
    shafts: list[tuple[int, int | None]]
    gears: dict[int, tuple[int, float]] = field(default_factory=dict)
    planets: dict[int, tuple[int, int, float]] = field(default_factory=dict)

    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        nodes = len(self.inertia)
        rows = [{a: ratio, b: -1.0} for b, (a, ratio) in self.gears.items()]
        rows += [{a: 1.0 - g, b: g, c: -1.0} for c, (a, b, g) in self.planets.items()]
        transform = eliminate(rows, nodes).transform
        elastic = np.zeros((len(self.shafts), nodes))
        for row, (a, b) in zip(elastic, self.shafts, strict=True):
            row[a] -= 1.0
            if b is not None:
                row[b] += 1.0
        return transformed(elastic, transform), self.stiffness, transform, self.inertia

    def modes(self) -> Modes:
        return modes(*self.arrays())


def random_network(seed: int, planets: bool = True) -> Network:
    """Trees and loops of 2–40 nodes, ratios 0.1–20, J 1e-4–1e4, k 10–1e9."""
    rng = np.random.default_rng(seed)
    nodes, reach = int(rng.integers(2, 41)), int(rng.choice([1, 3, 40]))
    shafts, gears, sets = [], {}, {}
    for b in range(1, nodes):
        a = int(rng.integers(max(0, b - reach), b))
        kind = rng.random()
        if planets and kind < 0.08 and b > 1:
            other = int(rng.choice([node for node in range(b) if node != a]))
            sets[b] = (a, other, float(10.0 ** rng.uniform(-1, 1.3)))
        elif kind < 0.25:
            gears[b] = (a, float(10.0 ** rng.uniform(-1, np.log10(20))))
        else:
            shafts.append((a, b))
    for _ in range(int(rng.choice([0, 0, 1, 3]))):
        a, b = (int(node) for node in rng.choice(nodes, 2, replace=False))
        shafts.append((a, b))
    if rng.random() < 0.3:
        shafts.append((int(rng.integers(nodes)), None))
    stiffness = 10.0 ** rng.uniform(1, 9, len(shafts))
    return Network(10.0 ** rng.uniform(-4, 4, nodes), stiffness, shafts, gears, sets)


def exact_modes(network: Network) -> tuple[np.ndarray, np.ndarray]:
    """All angular frequencies and node angles (nodes, modes) in 50 digits; nothing is shared with the library."""
    with mp.workdps(50):
        free = [i for i in range(len(network.inertia)) if i not in network.gears and i not in network.planets]
        rows: list[mp.matrix] = []
        for node in range(len(network.inertia)):
            if node in network.gears:
                a, ratio = network.gears[node]
                rows.append(rows[a] * mp.mpf(ratio))
            elif node in network.planets:
                a, b, g = network.planets[node]
                rows.append(rows[a] * mp.mpf(1.0 - g) + rows[b] * mp.mpf(g))
            else:
                rows.append(mp.matrix([[1 if other == node else 0 for other in free]]))
        mass, stiff = mp.zeros(len(free)), mp.zeros(len(free))
        for row, value in zip(rows, network.inertia, strict=True):
            mass += mp.mpf(value) * row.T * row
        for (a, b), value in zip(network.shafts, network.stiffness, strict=True):
            row = -rows[a] if b is None else rows[b] - rows[a]
            stiff += mp.mpf(value) * row.T * row
        root = mp.inverse(mp.cholesky(mass))
        reduced = root * stiff * root.T
        squares, vectors = mp.eigsy((reduced + reduced.T) / 2)
        zero = max(max(squares), mp.mpf(1)) * mp.mpf(10) ** -36
        omega = np.array([float(mp.sqrt(value)) if value > zero else 0.0 for value in squares])
        angles = np.array([[float((row * root.T * vectors[:, j])[0]) for j in range(len(free))] for row in rows])
        return omega, angles


def assert_exact(seed: int) -> None:
    """Frequencies to 1e-12; unit vectors in mass coordinates to 1e-12 over the relative gap to the next frequency."""
    network = random_network(seed)
    omega, shapes = network.modes()
    expected, angles = exact_modes(network)
    assert np.array_equal(omega == 0.0, expected == 0.0)
    np.testing.assert_allclose(omega, expected, rtol=1e-12)
    weight = np.sqrt(network.inertia)[:, None]
    found, right = weight * (network.arrays()[2] @ shapes), weight * angles
    for j in np.flatnonzero(omega):
        others = np.delete(omega, j)
        gap = np.min(np.abs(others - omega[j]) / (others + omega[j]), initial=1.0)
        error = min(np.linalg.norm(found[:, j] - sign * right[:, j]) for sign in (1.0, -1.0))
        assert error <= 1e-12 / gap


@pytest.mark.parametrize("seed", range(20))
def test_against_fifty_digits(seed: int) -> None:
    assert_exact(seed)


@pytest.mark.full
@pytest.mark.parametrize("seed", range(20, 220))
def test_against_fifty_digits_at_length(seed: int) -> None:
    assert_exact(seed)


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_shapes_are_orthonormal_in_mass(seed: int) -> None:
    network = random_network(seed)
    _, _, mass, inertia = network.arrays()
    momentum = np.sqrt(inertia)[:, None] * (mass @ network.modes().shapes)
    np.testing.assert_allclose(momentum.T @ momentum, np.eye(mass.shape[1]), atol=1e-12)


# --- invariants ------------------------------------------------------------------------------------------------------


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_zero_modes_are_the_connected_parts(seed: int) -> None:
    """Two copies side by side have twice the rigid modes, and exactly zero frequencies."""
    elastic, stiffness, mass, inertia = random_network(seed).arrays()
    once = modes(elastic, stiffness, mass, inertia).omega
    pair = np.eye(2)
    twice = modes(np.kron(pair, elastic), np.tile(stiffness, 2), np.kron(pair, mass), np.tile(inertia, 2)).omega
    assert np.count_nonzero(twice == 0.0) == 2 * np.count_nonzero(once == 0.0)
    np.testing.assert_allclose(twice, np.repeat(once, 2), rtol=1e-12)


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_referring_a_subtree_through_a_gear_changes_nothing(seed: int) -> None:
    """J and k behind a gear of ratio r, divided by r², in front of none."""
    rng = np.random.default_rng(seed)
    network = random_network(seed, planets=False)
    plain = replace(network, gears={}, shafts=[(i, i + 1) for i in range(len(network.inertia) - 1)])
    nodes, ratio = len(plain.inertia), float(10.0 ** rng.uniform(-1, 1.3))
    stiffness, cut = 10.0 ** rng.uniform(1, 9, nodes - 1), int(rng.integers(nodes))
    plain = replace(plain, stiffness=stiffness)
    inertia = np.insert(plain.inertia, cut, 1e-3)  # node cut + 1 becomes the second gear of the pair
    shafts = [(i + (i > cut), i + 1 + (i >= cut)) for i in range(nodes - 1)]
    shafts = [(a + 1 if a == cut else a, b) for a, b in shafts]
    referred_inertia = inertia.copy()
    scale = np.where(np.arange(nodes + 1) > cut, ratio**2, 1.0)
    referred_inertia *= scale
    referred = np.delete(referred_inertia, cut + 1)
    referred[cut] += referred_inertia[cut + 1]
    behind = np.array([a > cut for a, _ in shafts])
    geared = Network(inertia, stiffness, shafts, gears={cut + 1: (cut, ratio)})
    single = Network(referred, np.where(behind, stiffness * ratio**2, stiffness), plain.shafts)
    np.testing.assert_allclose(geared.modes().omega, single.modes().omega, rtol=1e-12)


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_signs_order_and_units_change_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    elastic, stiffness, mass, inertia = random_network(seed).arrays()
    omega, shapes = modes(elastic, stiffness, mass, inertia)
    nodes = mass.shape[1]
    order, sign = rng.permutation(nodes), rng.choice([-1.0, 1.0], nodes)
    rows = rng.permutation(len(stiffness))
    moved = modes((elastic * sign)[rows][:, order], stiffness[rows], (mass * sign)[:, order], inertia)
    np.testing.assert_allclose(moved.omega, omega, rtol=1e-12)
    unit, second = 10.0 ** rng.uniform(-7, 7), 60.0
    other = modes(elastic, stiffness * unit, mass, inertia * unit * second**2)
    np.testing.assert_allclose(other.omega, omega / second, rtol=1e-12)
    assert np.count_nonzero(other.omega == 0.0) == np.count_nonzero(omega == 0.0)
    assert np.all(np.abs(shapes).max(axis=0) <= shapes.max(axis=0) * (1.0 + 2e-6))


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_stiffness_never_lowers_and_inertia_never_raises_a_frequency(seed: int) -> None:
    rng = np.random.default_rng(seed)
    elastic, stiffness, mass, inertia = random_network(seed).arrays()
    omega = modes(elastic, stiffness, mass, inertia).omega
    stiffer, heavier = stiffness.copy(), inertia.copy()
    if len(stiffness):
        stiffer[rng.integers(len(stiffness))] *= 10.0 ** rng.uniform(0, 4)
    heavier[rng.integers(len(inertia))] *= 10.0 ** rng.uniform(0, 4)
    rounding = 1e-13 * omega
    assert np.all(modes(elastic, stiffer, mass, inertia).omega >= omega - rounding)
    assert np.all(modes(elastic, stiffness, mass, heavier).omega <= omega + rounding)


@given(seeds)
@settings(deadline=None, max_examples=40)
def test_negative_pivots_count_the_modes_below(seed: int) -> None:
    arrays = random_network(seed).arrays()
    omega = modes(*arrays).omega
    for below, (low, high) in enumerate(pairwise(omega), start=1):
        if high > low * (1.0 + 1e-3) and high > 1e-7 * omega[-1]:
            assert count_below((low + high) / 2.0, *arrays) == below
    if omega[-1] > 0.0:
        assert count_below(1.1 * omega[-1], *arrays) == len(omega)


@pytest.mark.parametrize("graded, most", [(True, 5), (False, 8)])
def test_few_sweeps_make_rows_orthogonal(monkeypatch: pytest.MonkeyPatch, graded: bool, most: int) -> None:
    """Twelve rows, from 1 down to 5e-4 as the factors before them grade them, or parallel but for a thousandth."""
    monkeypatch.setattr(jacobi, "SWEEPS", most)
    for seed in range(3):
        rows = np.random.default_rng(seed).normal(size=(12, 12))
        rows = rows * 0.5 ** np.arange(12)[:, None] if graded else rows[:1] + 1e-3 * rows
        turned = rows[:, :, None].copy()
        squares = jacobi.orthogonalize_rows.py_func(turned)[:, 0]
        gram = turned[:, :, 0] @ turned[:, :, 0].T / np.sqrt(np.outer(squares, squares))
        np.testing.assert_allclose(gram, np.eye(12), rtol=0, atol=1e-13)
        assert np.sort(squares) == pytest.approx(np.linalg.svd(rows, compute_uv=False)[::-1] ** 2, rel=1e-9)


# --- batches and edges -----------------------------------------------------------------------------------------------


def test_a_batch_is_bit_identical_to_its_designs() -> None:
    elastic, stiffness, mass, inertia = random_network(3).arrays()
    rng = np.random.default_rng(0)
    k = stiffness * rng.uniform(0.5, 2.0, (37, len(stiffness)))
    J = inertia * rng.uniform(0.5, 2.0, (37, len(inertia)))
    batch = modes(elastic, k, mass, J)
    assert batch.omega.shape == (37, mass.shape[1]) and batch.shapes.shape == (37, mass.shape[1], mass.shape[1])
    for design in range(37):
        one = modes(elastic, k[design], mass, J[design])
        np.testing.assert_array_equal(one.omega, batch.omega[design])
        np.testing.assert_array_equal(one.shapes, batch.shapes[design])


def test_weights_of_their_own_for_every_gear() -> None:
    """Five ratios of one gear pair; stiffness is shared."""
    rows, masses, expected = [], [], []
    for ratio in (0.7, 1.0, 3.5, 9.2, 14.9):
        network = Network(np.array([1.2, 0.3, 0.2, 15.0]), np.array([2e4, 9e3]), [(0, 1), (2, 3)], {2: (1, ratio)})
        elastic, stiffness, mass, inertia = network.arrays()
        rows.append(elastic), masses.append(mass), expected.append(network.modes())
    found = modes(np.array(rows), stiffness, np.array(masses), inertia)
    for design, one in enumerate(expected):
        np.testing.assert_array_equal(found.omega[design], one.omega)
        np.testing.assert_array_equal(found.shapes[design], one.shapes)


def test_a_stiffness_of_zero_takes_the_shaft_out() -> None:
    k = np.array([[1e3, 1e3], [0.0, 1e3], [0.0, 0.0], [1e3, 0.0]])
    found = modes(chain(3), k, np.eye(3), [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(np.count_nonzero(found.omega == 0.0, axis=1), [1, 2, 3, 2])
    assert found.omega[1, 2] == pytest.approx(np.sqrt(1e3 * (1 / 2 + 1 / 3)), rel=1e-15)
    assert found.omega[3, 2] == pytest.approx(np.sqrt(1e3 * (1 / 1 + 1 / 2)), rel=1e-15)


def test_rigid_mode_of_plain_shafts_is_one_angle() -> None:
    shapes = chain_modes([0.1, 2.0, 30.0], [1e3, 1e7]).shapes
    np.testing.assert_allclose(shapes[:, 0], 1.0 / np.sqrt(32.1), rtol=1e-15)
    assert shapes[0, 0] == shapes[1, 0] == shapes[2, 0]


def test_one_free_disc() -> None:
    omega, shapes = modes(np.zeros((0, 1)), [], [[1.0]], [4.0])
    np.testing.assert_array_equal(omega, [0.0])
    np.testing.assert_array_equal(shapes, [[0.5]])


def test_eigenvalues_sixteen_decades_apart() -> None:
    """Three discs, stiffnesses 1e9 and 1e-7: the slow mode is that of two bodies, known in closed form to 1e-16."""
    omega = chain_modes([1.0, 2.0, 3.0], [1e9, 1e-7]).omega
    assert omega[1] == pytest.approx(np.sqrt(1e-7 * (1 / 3.0 + 1 / 3.0)), rel=1e-15)
    assert omega[2] == pytest.approx(np.sqrt(1e9 * (1 / 1.0 + 1 / 2.0)), rel=1e-15)


def test_a_coordinate_without_inertia_is_refused_by_its_index() -> None:
    with pytest.raises(ModelError, match=r"coordinates \[1\]: no inertia moves with this motion"):
        chain_modes([1.0, 0.0, 2.0], [1.0, 1.0])


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_bad_values_are_refused_with_their_place(bad: float) -> None:
    with pytest.raises(ModelError, match=r"stiffness\[1, 0\]"):
        modes(chain(2), [[1.0], [bad]], np.eye(2), [1.0, 1.0])
    with pytest.raises(ModelError, match=r"inertia\[0, 1\]"):
        modes(chain(2), [1.0], np.eye(2), [1.0, bad])
