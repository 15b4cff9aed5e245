"""Time steps against other ways to the same motion: an explicit integrator, the complementarity problem, a table."""

from __future__ import annotations

import numpy as np
import pytest
from tests.numerics.stepping.stepping_models import Crank, Link, Push, equations, integers, sine, table
from tests.numerics.stepping.test_stepping import MEMBERS, order_of, wall
from tests.numerics.stepping.test_stepping_energy import BRISTLES, DRIVE, turning, with_law
from tests.validation import dmf_lcp

from torsional.laws import Jenkins, Law, Stribeck
from torsional.numerics.contacts.step import OneSided, Step, step_problem
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.motion.data import DAMPER, SPRING, Equations, Governed
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Count, Settings, Status, begin, march
from torsional.numerics.stepping.plan import dense, prepare

JENKINS = Jenkins(4.0, 500.0)
GOVERNOR = Governed(
    table([[1.0, 0.0]], 2),
    table([[1.0, 0.0]], 2),
    integers([1]),
    *(np.array([value]) for value in (5.0, 30.0, -50.0, 50.0)),
    integers([0, 0]),
    integers([]),
)


def governed() -> Equations:
    links = [Link([1.0, -1.0], 400.0, 0.4), Link([0.0, 1.0], 0.0, 3.0, mean_rate=1.0)]
    return equations([1.0, 0.5], links, [DRIVE], speed=30.0, governed=GOVERNOR, levels=[((0.0,), (35.0,))])


def cranked() -> Equations:
    links = [Link([1.0, -1.0], 400.0, 0.4), Link([0.0, 1.0], 0.0, 3.0)]
    return equations([0.05, 0.5], links, [DRIVE], [Crank([1.0, 0.0], 2.0, 0.05, 0.15, 0.3, 0.001)], speed=30.0)


def flows(law: Law) -> dict[int, int]:
    """Where the rate of a law's memory is told."""
    return {law.address: law.flow_address}


SYSTEMS = {
    "stribeck": (with_law(Stribeck(2.0, 3.0, 0.1, 0.02)), {}, 1.9),
    "jenkins": (with_law(JENKINS), {"flows": flows(JENKINS)}, 1.9),
    "pressed bristles": (with_law(BRISTLES, load=(0.2, 1e-4, [(0, 0.05)])), {"flows": flows(BRISTLES)}, 1.6),
    "crank": (cranked(), {}, 1.9),
    "governor": (governed(), {}, 1.9),
    "turning": (turning(), {}, 1.9),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_an_explicit_integrator_finds_the_same_motion(name: str) -> None:
    of, told, least = SYSTEMS[name]
    n, plan, times = of.coordinates, prepare(of), np.linspace(0.0, 1.0, 101)
    exact = explicit_march(of, times, np.zeros(n), np.zeros(n), tolerance=1e-11, **told).angles
    errors = []
    for steps in (2000, 4000, 8000):
        found = march(
            plan, AlphaMethod.chung_hulbert(0.8), 1 / steps, steps, begin(plan, 0.0, 0.0), stride=steps // 100
        )
        assert found.status == Status.DONE
        errors.append(np.abs(found.records.q - exact).max())
    assert errors[-1] <= 2e-4 * np.abs(exact).max()
    assert order_of(np.array(errors)) >= least


# --- the dual mass flywheel ---


def run_up(steps: int, end: float = 0.1, method: AlphaMethod | None = None):  # type: ignore[no-untyped-def]
    plan = prepare(dmf_lcp.equations())
    rho = AlphaMethod.chung_hulbert(0.8) if method is None else method
    return march(plan, rho, end / steps, steps, begin(plan, 0.0, 0.0), stride=steps // 100)


def observed(found) -> np.ndarray:  # type: ignore[no-untyped-def]
    return dmf_lcp.observed(np.hstack([found.records.q, found.records.v]))


def test_the_flywheel_s_table() -> None:
    found = run_up(10_000)
    assert found.status == Status.DONE
    for row in dmf_lcp.REFERENCE:
        seen = observed(found)[round(row[0] / 1e-3)]
        np.testing.assert_allclose(seen, row[1:], rtol=3e-5)
    coarse = observed(run_up(1000))
    for row in dmf_lcp.REFERENCE:
        assert coarse[round(row[0] / 1e-3), 0] == pytest.approx(row[1], rel=5e-5)


def test_the_flywheel_s_order() -> None:
    exact = observed(run_up(256_000, method=AlphaMethod.newmark()))[:, 0]
    errors = [np.abs(observed(run_up(n))[:, 0] - exact).max() for n in (1000, 2000, 4000, 8000, 16_000, 32_000)]
    assert errors[0] <= 5e-5 * np.abs(exact).max()
    assert order_of(np.array(errors)) >= 1.9


def test_few_passes_and_factors() -> None:
    found = run_up(1000)
    assert found.count(Count.SOLVES) <= 1.1 * found.count(Count.STEPS)
    assert found.count(Count.FACTORS) <= 0.1 * found.count(Count.STEPS)
    assert found.count(Count.FALLBACKS) == 0


def test_the_complementarity_problem_has_the_same_solution() -> None:
    """Step by step, each from the same motion: the contact forces by block pivoting, dense."""
    of, method, h = dmf_lcp.equations(), AlphaMethod.chung_hulbert(0.8), 1e-4
    plan = prepare(of)
    found = march(plan, method, h, 400, begin(plan, 0.0, 0.0), settings=Settings(guard=False))
    c = of.connected
    w = dense(c.rows, of.coordinates)
    hinge, (gap, side, change, time) = c.hinges
    walls = OneSided(-(w[hinge] * side[:, None]).T, side * gap, change, time)
    M = np.diag(of.inertia)
    linear = M, *(w.T @ (w * c.constants[row, :, None]) for row in (DAMPER, SPRING))
    step = Step(h, method.alpha_m, method.alpha_f, method.gamma, method.beta)
    state, load, closed = (
        (np.zeros(18), np.zeros(18), found.records.acceleration[0].copy(), np.zeros(hinge.size)),
        None,
        0,
    )
    for k in range(1, 401):
        loads = tuple(source_loads(found.records.time[i]) for i in (k - 1, k))
        problem = step_problem(linear, walls, state, loads, step)
        load = problem.solve().force
        q, v, a = problem.end(load)
        state, closed = (q, v, a, load), max(closed, int((load > 0).sum()))
    assert closed >= 6
    np.testing.assert_allclose(state[0], found.records.q[-1], atol=1e-11 * np.abs(state[0]).max())
    np.testing.assert_allclose(state[1], found.records.v[-1], atol=1e-10 * np.abs(state[1]).max())


def source_loads(t: float) -> np.ndarray:
    """The flywheel's torques at a time, from its own right-hand side at rest."""
    return dmf_lcp.right_hand_side(float(t), np.zeros(36))[18:] * dmf_lcp.INERTIA


def test_a_hinge_that_softens_and_one_that_opens_under_preload() -> None:
    """A stage that ends (Δk < 0) against the explicit integrator, and a stop that is closed from the start."""
    links = [Link([1.0], 1000.0, 0.5, hinges=[(0.01, 1.0, -700.0, 0.0), wall(-0.005, 3000.0, side=-1.0)])]
    of = equations([0.4], links, [Push([1.0], level=((0.0,), (15.0,)), samples=sine(), multiple=20.0)])
    plan, times = prepare(of), np.linspace(0.0, 1.0, 101)
    exact = explicit_march(of, times, [0.0], [0.0], tolerance=1e-11).angles
    errors = []
    for steps in (5000, 10_000, 20_000, 40_000):
        found = march(plan, MEMBERS["newmark"], 1 / steps, steps, begin(plan, 0.0, 0.0), stride=steps // 100)
        assert found.count(Count.FACTORS) > 10
        errors.append(np.abs(found.records.q - exact).max() / np.abs(exact).max())
    assert errors[-1] <= 1e-5
    assert order_of(np.array(errors)) >= 1.9


# --- what is hard on the passes ---


def crowded(n: int) -> Equations:
    """Masses from a gram to a kilogram in a row, with stops between them and to both sides: contacts that are
    redundant, stiffnesses from 1e4 to 1e7."""
    links = [Link([1.0] + [0.0] * (n - 1), 10.0)]
    for row in np.eye(n)[1:] - np.eye(n)[:-1]:
        stops = [wall(0.002, 1e6), wall(0.002, 1e4, side=-1.0), wall(0.01, 1e7, 1e-5, side=-1.0)]
        links.append(Link(row.tolist(), damping=0.01, hinges=stops))
    links += [Link(row.tolist(), hinges=[wall(0.02, 1e5), wall(0.02, 1e5, side=-1.0)]) for row in np.eye(n)]
    return equations(np.geomspace(1e-3, 1.0, n).tolist(), links)


@pytest.mark.parametrize("n", [4, 12])
def test_steps_far_too_long_end_all_the_same(n: int) -> None:
    """The set of closed hinges goes round in circles for some: turning them one by one ends it."""
    of, draw, fallbacks = crowded(n), np.random.default_rng(1), 0
    plan, c = prepare(of), of.connected
    w = dense(c.rows, n)
    hinge, (gap, side, change, time) = c.hinges
    for _ in range(100):
        state = begin(plan, draw.normal(size=n) * 0.03, draw.normal(size=n) * 30.0)
        found = march(plan, MEMBERS["chung_hulbert_0.8"], 0.1, 5, state, settings=Settings(guard=False))
        assert found.status in (Status.DONE, Status.PRODUCES)
        fallbacks += found.count(Count.FALLBACKS)
        twist, rate = w @ found.records.q[-1], w @ found.records.v[-1]
        beyond = side * (twist[hinge] - gap + time * rate[hinge])
        wanted = c.constants[SPRING] * twist + c.constants[DAMPER] * rate
        np.add.at(wanted, hinge, side * change * np.maximum(0.0, beyond))
        rounding = 1e-7 * np.abs(wanted).max()  # that of a matrix whose entries span ten decades
        np.testing.assert_allclose(found.records.torque[-1], wanted, rtol=0.0, atol=rounding)
    assert fallbacks > 0


def test_too_few_passes_for_friction_are_told() -> None:
    plan = prepare(with_law(BRISTLES))
    state = begin(plan, 0.0, 0.0)
    assert march(plan, MEMBERS["newmark"], 1e-2, 100, state, settings=Settings(passes=1)).status == Status.UNSETTLED
    assert march(plan, MEMBERS["newmark"], 1e-2, 100, state).status == Status.DONE


def test_a_coordinate_without_mass_follows_the_balance() -> None:
    """Two springs in a row with nothing between them are one of half the stiffness."""
    of = equations([1.0, 0.0], [Link([1.0, -1.0], 200.0), Link([0.0, 1.0], 200.0)])
    plan = prepare(of)
    found = march(plan, AlphaMethod.chung_hulbert(0.8), 1e-4, 10_000, begin(plan, [0.1, 0.05], [0.0, 0.0]))
    np.testing.assert_allclose(found.records.q[:, 0], 0.1 * np.cos(10.0 * found.records.time), atol=1e-6)
    np.testing.assert_allclose(found.records.q[:, 1], 0.5 * found.records.q[:, 0], atol=1e-9)
