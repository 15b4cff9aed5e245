"""The compiled elimination against 50-digit arithmetic, closed forms and itself in other company."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from benchmarks import chain15
from tests.numerics.elimination.elimination_models import Reference, random_model, read

from torsional.errors import ModelError
from torsional.numerics.elimination.plan import EliminationPlan, Response, Status

MODELS = read()
CHAIN = EliminationPlan.build(
    np.vstack([np.diff(np.eye(15), axis=0), np.eye(15)[chain15.GROUND_DAMPING > 0]]), np.eye(15), keep_last=range(1, 7)
)
CHAIN_STIFFNESS = np.r_[chain15.STIFFNESS, np.zeros(7)]
CHAIN_DAMPING = np.r_[chain15.DAMPING, chain15.GROUND_DAMPING[chain15.GROUND_DAMPING > 0]]


def solved(model: Reference, **changes: Any) -> Response:
    plan = EliminationPlan.build(model.connection_weights, model.mass_weights)
    given = {"omega": model.omega, "speed": 0.0, "load_nodes": [model.node], "loads": [[[1.0]]], "centrifugal": None}
    values = {name: getattr(model, name) for name in ("stiffness", "loss", "damping", "inertia")}
    return plan.solve(**values | given | changes)


def chain(rpm: np.ndarray) -> Response:
    omega = chain15.frequencies(rpm).ravel()
    loads = np.broadcast_to(chain15.torque()[chain15.THROWS].T, (len(rpm), 24, 6)).reshape(-1, 1, 6)
    inertia, speed = chain15.INERTIA, np.repeat(rpm * np.pi / 30, 24)
    return CHAIN.solve(CHAIN_STIFFNESS, None, CHAIN_DAMPING, None, inertia, omega, speed, range(1, 7), loads)


def chain_inertia_free(stiffness: float, omega: float) -> np.ndarray:
    """Two rigidly joined pairs of discs, the joint of the second ``stiffness`` instead of rigid."""
    plan = EliminationPlan.build(np.diff(np.eye(3), axis=0), np.eye(3))
    return plan.solve([1e4, stiffness], None, [5.0, 0.0], None, [1.0, 0.7, 0.3], omega, 0.0, [0], [[[1.0]]]).x[0, 0, 0]


@pytest.mark.parametrize("first", range(0, len(MODELS), 20))
def test_against_fifty_digits(first: int) -> None:
    """Shafts and gears to 1e-11 of each angle, behind planetary sets to 1e-11 of the largest."""
    for model in MODELS[first : first + 20]:
        x, status = solved(model)
        size = np.abs(model.response)
        error = np.abs(x[0, 0, 0] - model.response)
        assert status[0, 0] != Status.SINGULAR
        assert np.all(error <= 1e-11 * (np.max(size) if model.planetary else size))


def test_planetary_sets_keep_small_angles_too() -> None:
    """Angles far smaller than others keep ten digits nearly always, and never fewer than seven."""
    models = [model for model in MODELS if model.planetary]
    errors = [np.max(np.abs(solved(m).x[0, 0, 0] - m.response) / np.abs(m.response)) for m in models]
    assert np.quantile(errors, 0.9) <= 1e-10
    assert max(errors) <= 1e-7


def test_benchmark_chain() -> None:
    x, status = chain(np.array([800.0, 1500.0]))
    shaft = chain15.DUAL_MASS
    omega = chain15.frequencies(np.array([800.0, 1500.0])).ravel()
    torque = (chain15.STIFFNESS[shaft] + 1j * omega * chain15.DAMPING[shaft]) * (x[0, :, 0, 8] - x[0, :, 0, 7])
    third, ninth = 5, 24 + 8  # order 3 at 800 rpm, order 4.5 at 1500 rpm
    assert not np.any(status)
    assert np.abs(torque[[third, ninth]]) == pytest.approx([461.598699, 31.135577], abs=6e-7)
    assert np.abs(x[0, [third, ninth], 0, 10]) == pytest.approx([7.744631121e-3, 5.324797673e-5], rel=2e-10)


def test_benchmark_chain_against_numpy() -> None:
    rpm = chain15.RPM[::25]
    angle, _ = chain15.dense(rpm)
    assert chain(rpm).x[0, :, 0].reshape(angle.shape) == pytest.approx(angle, rel=2e-11)


def test_same_bits_alone_and_in_company() -> None:
    """Any split of designs and frequencies, any place in a block of lanes: the same bits."""
    random = np.random.default_rng(7)
    model = max(MODELS, key=lambda m: m.planetary * len(m.inertia))
    k, J = (v * random.uniform(0.7, 1.3, (5, v.size)) for v in (model.stiffness, model.inertia))
    omega = np.sort(random.uniform(1.0, 3000.0, 77))
    loads = random.standard_normal((5, 77, 2, 1)) + 1j * random.standard_normal((5, 77, 2, 1))

    def part(d: slice, f: slice) -> np.ndarray:
        return solved(model, stiffness=k[d], inertia=J[d], omega=omega[f], loads=loads[d, f]).x

    together = part(slice(5), slice(77))
    for d, f in ((0, 0), (2, 31), (4, 76)):
        alone = part(slice(d, d + 1), slice(f, f + 1))
        assert alone.tobytes() == together[d : d + 1, f : f + 1].tobytes()
    assert part(slice(1, 4), slice(3, 70)).tobytes() == together[1:4, 3:70].tobytes()


def test_one_right_hand_side_has_the_bits_of_many() -> None:
    model = MODELS[0]
    both = solved(model, loads=[[[1.0], [2.0 - 1.0j]]]).x
    assert solved(model, loads=[[[2.0 - 1.0j]]]).x.tobytes() == both[:, :, 1:].tobytes()


@pytest.mark.parametrize("planetary", [False, True])
def test_reciprocity_and_passivity(planetary: bool) -> None:
    random = np.random.default_rng(3)
    for _ in range(15):
        model = random_model(random, planetary, damped=True)
        plan = EliminationPlan.build(model.connection_weights, model.mass_weights)
        omega, nodes = 10.0 ** random.uniform(0, 3.5, 4), range(len(model.inertia))
        values = model.stiffness, model.loss, model.damping, None, model.inertia
        G, status = plan.receptance(*values, omega, 0.0, nodes)
        size = np.sqrt(np.abs(np.einsum("dfi,dfj->dfij", *(np.diagonal(G, axis1=2, axis2=3),) * 2)))
        assert not np.any(status == Status.SINGULAR)
        assert np.all(np.abs(G - G.swapaxes(2, 3)) <= 1e-11 * size)
        mobility = np.diagonal(1j * omega[:, None, None] * G, axis1=2, axis2=3)
        assert np.all(mobility.real >= -1e-13 * np.abs(mobility))


def test_superposition() -> None:
    model = next(m for m in MODELS if len(m.inertia) > 20)
    nodes, loads = [0, 5, 11], np.array([1.0, -2.0 + 1.0j, 0.3j])
    together = solved(model, load_nodes=nodes, loads=loads[None, None]).x[0, 0, 0]
    each = solved(model, load_nodes=nodes, loads=np.diag(loads)[None]).x[0, 0]
    assert np.all(np.abs(together - each.sum(axis=0)) <= 1e-12 * np.abs(each).sum(axis=0))


def test_order_of_nodes_and_units_do_not_matter() -> None:
    random = np.random.default_rng(11)
    for model in [m for m in MODELS if not m.planetary][:20]:
        x = solved(model).x[0, 0, 0]
        places = random.permutation(len(x))
        plan = EliminationPlan.build(model.connection_weights[:, places], model.mass_weights[:, places])
        node = [int(np.flatnonzero(places == model.node)[0])]
        k, c, J = (1000.0 * v for v in (model.stiffness, model.damping, model.inertia))
        permuted = plan.solve(k, model.loss, c, None, J, model.omega, 0.0, node, [[[1000.0]]]).x[0, 0, 0]
        assert permuted == pytest.approx(x[places], rel=1e-12)


def test_outputs_and_last_nodes_change_nothing() -> None:
    model = next(m for m in MODELS if not m.planetary and len(m.inertia) > 12)
    x = solved(model).x[0, 0, 0]
    assert solved(model, outputs=[7, 2]).x[0, 0, 0] == pytest.approx(x[[7, 2]], rel=1e-14)
    plan = EliminationPlan.build(model.connection_weights, model.mass_weights, keep_last=[2, 7])
    values = model.stiffness, model.loss, model.damping, None, model.inertia
    assert plan.tape.removals[-1].node in (2, 7)
    last = plan.solve(*values, model.omega, 0.0, [model.node], [[[1.0]]]).x[0, 0, 0]
    assert last == pytest.approx(x, rel=1e-12)


def test_weights_by_design() -> None:
    """Gears differ in their ratios only: one plan serves them all."""
    ratios = np.array([0.8, 1.0, 3.7, 14.9])
    weights = np.array([[[-1.0, 1.0, 0.0], [0.0, -1 / r, 1 / r]] for r in ratios])
    masses = np.array([np.diag([1.0, 1.0, 1 / r]) for r in ratios])
    plan, k, J, omega = EliminationPlan.build(weights[0], masses[0]), [2e4, 5e3], [1.2, 0.4, 3.0], [40.0, 90.0]
    given: tuple[Any, ...] = (k, [0.02, 0.0], [5.0, 1.0], None, J, omega, 0.0, [0], [[[1.0]]])
    together = plan.solve(*given, connection_weights=weights, mass_weights=masses).x
    for d, (w, v) in enumerate(zip(weights, masses, strict=True)):
        assert np.array_equal(EliminationPlan.build(w, v).solve(*given).x[0], together[d])


def test_power_split_absorber_cancels() -> None:
    """At ω² = k / [J2 (1 − r) + J3 g (g − r)] the output of the power-split absorber stands still."""
    r, g, k, J2, J3 = 0.6, 2.5, 20e3, 0.5, 0.02
    connections = [[-1.0, 1.0, 0.0], [1 - r, r, -1.0]]  # spring 1–2, shaft 4–5 behind the planetary set
    masses = [[1.0, 0, 0], [0, 1.0, 0], [1 - g, g, 0], [1 - r, r, 0], [0, 0, 1.0]]
    omega = np.sqrt(k / (J2 * (1 - r) + J3 * g * (g - r)))
    plan = EliminationPlan.build(connections, masses)
    x, _ = plan.solve([k, 60e3], None, None, None, [1.8, J2, J3, 1.2, 8.0], omega, 0.0, [0], [[[1000.0]]])
    x1, x2, _ = x[0, 0, 0]
    assert omega / (2 * np.pi) == pytest.approx(41.4404174, abs=5e-8)
    assert x1.real == pytest.approx(-0.010510688836, abs=5e-13)
    assert abs((1 - r) * x1 + r * x2) < 1e-15


def test_stiff_dual_mass_is_a_single_mass() -> None:
    """The deviation from the rigid joint falls as 1/k."""
    omega = 60.0
    dynamic = np.array([[1e4 + 300j - omega**2, -1e4 - 300j], [-1e4 - 300j, 1e4 + 300j - omega**2]])
    rigid = np.linalg.solve(dynamic, [1.0, 0.0])
    errors = [abs(chain_inertia_free(k, omega)[1] - rigid[1]) for k in (1e6, 1e7, 1e8)]
    assert np.array(errors[:-1]) / errors[1:] == pytest.approx([10.0, 10.0], rel=5e-3)
    assert chain_inertia_free(1e15, omega)[1] == pytest.approx(rigid[1], rel=1e-11)


def test_tuned_absorber() -> None:
    """At √(k/J) an undamped absorber stops its host, which no elimination without pivoting survives."""
    k, J = 3.1e3, 0.017
    plan = EliminationPlan.build([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]], np.eye(3), keep_last=[0, 1])
    x, status = plan.solve([2e4, k], None, None, None, [1.0, 2.0, J], np.sqrt(k / J), 0.0, [1], [[[1.0]]])
    assert status[0, 0] == Status.FALLBACK
    assert abs(x[0, 0, 0, 1]) <= 1e-10 * abs(x[0, 0, 0, 2])
    assert x[0, 0, 0, 2] == pytest.approx(-1.0 / k, rel=1e-10)


def test_absorber_without_inertia_is_not_there() -> None:
    omega = np.linspace(5.0, 400.0, 30)
    with_it = EliminationPlan.build([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]], np.eye(3))
    without = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    given: tuple[Any, ...] = (omega, 0.0, [0], [[[1.0]]])
    x = with_it.solve([2e4, 1e3], None, [3.0, 1.0], None, [1.0, 2.0, 0.0], *given).x[0, :, 0]
    assert x[:, :2] == pytest.approx(without.solve([2e4], None, [3.0], None, [1.0, 2.0], *given).x[0, :, 0], rel=1e-12)


def test_equal_discs_clamped_resonance() -> None:
    """Both pivots vanish at √(k/J), the system is sound: x₁ = 0, x₂ = −1/k."""
    plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    x, status = plan.solve([100.0], None, None, None, [1.0, 1.0], 10.0, 0.0, [0], [[[1.0]]])
    assert status[0, 0] == Status.FALLBACK
    assert x[0, 0, 0] == pytest.approx([0.0, -0.01], abs=1e-17)


def test_near_resonance_is_solved_to_all_digits() -> None:
    """A millionth beside an undamped resonance: x₁ = (k − ω²J) / [ω² J (ω² J − 2k)]."""
    omega = np.sqrt(200.0) * (1 + 1e-6)
    plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    x, status = plan.solve([100.0], None, None, None, [1.0, 1.0], omega, 0.0, [0], [[[1.0]]])
    exact = (100 - np.longdouble(omega) ** 2) / (np.longdouble(omega) ** 2 * (np.longdouble(omega) ** 2 - 200))
    assert status[0, 0] == Status.FALLBACK
    assert x[0, 0, 0, 0].real == pytest.approx(float(exact), rel=1e-12)


def test_singular_cases_are_told() -> None:
    """At rest, at an undamped resonance, or with values that are not numbers; the neighbours are unharmed."""
    plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    omega = [0.0, np.sqrt(200.0), 3.0, np.nan]
    x, status = plan.solve([100.0], None, None, None, [1.0, 1.0], omega, 0.0, [0], [[[1.0]]])
    assert status[0].tolist() == [Status.SINGULAR, Status.SINGULAR, Status.OK, Status.SINGULAR]
    assert np.array_equal(np.isnan(x[0, :, 0, 0]), [True, True, False, True])


def test_static_response_of_a_held_system() -> None:
    """At ω = 0 two springs in series to the ground: 1/k₁ and 1/k₁ + 1/k₂, whatever their stiffness."""
    plan = EliminationPlan.build([[1.0, 0.0], [-1.0, 1.0]], np.eye(2))
    x, status = plan.solve([10.0, 1e9], None, None, None, [1.0, 1.0], 0.0, 0.0, [1], [[[1.0]]])
    assert status[0, 0] == Status.OK
    assert x[0, 0, 0] == pytest.approx([0.1, 0.1 + 1e-9], rel=1e-15)


def test_centrifugal_stiffness() -> None:
    """A pendulum J on s Ω² is tuned to the order √(s/J) at every speed."""
    J, order = 0.02, 2.5
    plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    speed = np.array([60.0, 120.0, 210.0])
    x, _ = plan.solve([0.0], None, None, [J * order**2], [1.5, J], order * speed, speed, [0], [[[1.0]]])
    assert np.all(np.abs(x[0, :, 0, 0]) <= 1e-13 * np.abs(x[0, :, 0, 1]))


def test_a_chain_costs_one_division_a_node() -> None:
    steps = CHAIN.tape.steps
    assert [len(own) for own in steps] == [1] * 15
    assert len(CHAIN.tape.program) == 15


def test_connected_whole_sets_stay_whole() -> None:
    """Two planetary sets on the same nodes, one stiff, one soft, in digits no spread-out form could keep."""
    connections = np.array([[3.0, -4.0, 1.0, 0.0], [1.0, 1.5, 0.0, -2.5], [-1.0, 1.0, 0.0, 0.0]])
    model = Reference(connections, np.eye(4), np.array([1e9, 10.0, 1e3]), np.zeros(3), np.zeros(3),
                      np.array([1e-4, 1.0, 1e4, 1e-3]), np.zeros(4, complex), 30.0, 3)  # fmt: skip
    from tests.numerics.elimination.elimination_models import exact

    assert solved(model).x[0, 0, 0] == pytest.approx(exact(model), rel=1e-11)


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"stiffness": [1.0, 2.0]}, "stiffness"),
        ({"inertia": [1.0]}, "inertia"),
        ({"loads": [[[1.0, 2.0]]]}, "loads"),
        ({"loads": np.ones((3, 1, 1))}, "loads"),
        ({"stiffness": [[1.0]] * 2, "inertia": [[1.0, 1.0]] * 3}, "designs"),
        ({"connection_weights": [[1.0, 1.0, 1.0]]}, "weights"),
    ],
)
def test_shapes_are_checked(changes: dict[str, Any], where: str) -> None:
    plan = EliminationPlan.build([[-1.0, 1.0]], np.eye(2))
    given = {"stiffness": [1.0], "loss": None, "damping": None, "centrifugal": None, "inertia": [1.0, 1.0]}
    given |= {"omega": [1.0, 2.0], "speed": 0.0, "load_nodes": [0], "loads": [[[1.0]]]}
    with pytest.raises(ModelError, match=where):
        plan.solve(**given | changes)


def test_weights_outside_the_plan_are_refused() -> None:
    plan = EliminationPlan.build([[-1.0, 1.0, 0.0]], np.eye(3))
    with pytest.raises(ModelError, match="zero in the plan"):
        plan.solve([1.0], None, None, None, [1.0] * 3, 1.0, 0.0, [0], [[[1.0]]], connection_weights=[[-1.0, 1.0, 0.5]])
