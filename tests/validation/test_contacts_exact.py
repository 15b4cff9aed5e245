"""One-sided springs with contact times: exact motion against closed forms and published figures, others against it."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numba
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.numerics.stepping.stepping_arrays import Connection, equations
from tests.validation import dmf_lcp

from torsional.errors import ModelError
from torsional.laws import Contacts, Law, Told, plain
from torsional.numerics.contacts.complementarity import violation
from torsional.numerics.contacts.exact import ExactContacts
from torsional.numerics.contacts.step import OneSided, Step, step_problem
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.piecewise.basis import StageBases
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import begin, march
from torsional.numerics.stepping.plan import prepare

Array = np.ndarray


def springs(directions: list[list[float]], gaps: list[float], stiffness: float, time: float = 0.0) -> OneSided:
    """Springs of one stiffness and contact time, a row of directions each."""
    count = len(gaps)
    return OneSided(np.array(directions).T, np.array(gaps), np.full(count, stiffness), np.full(count, time))


def alone(mass: float, contacts: OneSided, damping: float = 0.0, stiffness: float = 0.0) -> ExactContacts:
    return ExactContacts([[mass]], [[damping]], [[stiffness]], contacts)


# --- closed forms and published figures ------------------------------------------------------------------------------


def test_contact_of_pi_tenths() -> None:
    """m = 1, v = 1, gap 0.1, k = 100: contact of π/10 s, and back with v = −1."""
    way = alone(1.0, springs([[-1.0]], [0.1], 100.0)).run([0.0, 0.25, 1.0], [0.0], [1.0])
    np.testing.assert_allclose(way.events, [0.1, 0.1 + 0.1 * np.pi], rtol=1e-14)
    assert way.which.tolist() == [0, -1]
    np.testing.assert_allclose(way.rates[-1], [-1.0], rtol=1e-14)
    np.testing.assert_allclose(way.forces[:, 0], [0.0, 10.0 * np.sin(1.5), 0.0], rtol=1e-13)


def test_clearance_oscillator_keeps_its_period() -> None:
    """m = 1 between stops k = 100 at ±1, from 2 at rest: 4/10 (1 + π/2) = 1.0283185307 s, fifty times over."""
    period = 0.4 * (1.0 + 0.5 * np.pi)
    assert round(period, 10) == 1.0283185307
    contacts = springs([[-1.0], [1.0]], [1.0, 1.0], 100.0)
    way = alone(1.0, contacts).run(period * np.arange(51), [2.0], [0.0])
    np.testing.assert_allclose(way.angles[:, 0], 2.0, rtol=1e-13)
    np.testing.assert_allclose(way.rates[:, 0], 0.0, atol=5e-11)
    assert len(way.events) == 200


MASS, SPRING, DAMPER = 0.5, 1e4, 10.0
RATIO = 0.5 * DAMPER / np.sqrt(SPRING * MASS)
TURN = RATIO / np.sqrt(1.0 - RATIO**2)


def test_damped_stop_with_a_continuous_force() -> None:
    """m = .5, k = 1e4, c = 10, v0 = 10: exp(−πζ/sqrt(1−ζ²)) = .8003536403 is the restitution of max(0, k x + c v).

    x + τ v obeys the equation of x, and where it is zero so is the force and v its rate: the contact lasts half a
    period of the damped spring, from τ v0 before the stop, and ends with the damper still pressed.
    """
    way = alone(MASS, springs([[-1.0]], [0.1], SPRING, DAMPER / SPRING)).run([0.0, 0.1], [0.0], [10.0])
    restitution = np.exp(-np.pi * TURN)
    assert round(restitution, 10) == 0.8003536403
    assert -way.rates[-1, 0] / 10.0 == pytest.approx(restitution, rel=1e-13)
    duration = np.pi / np.sqrt(SPRING / MASS * (1.0 - RATIO**2))
    np.testing.assert_allclose(way.events, [0.009, 0.009 + duration], rtol=1e-13)


@pytest.mark.parametrize(
    ("pulls", "expected"),
    [(True, np.exp(-np.pi * TURN)), (False, np.exp(-(np.pi - 2.0 * np.arcsin(RATIO)) * TURN))],
    ids=["pulls until it opens", "opens where it would pull"],
)
def test_damped_stop_whose_damper_starts_with_the_spring(pulls: bool, expected: float) -> None:
    """With the damper at work from x = 0 on: the same .8003536403 where it may pull back to x = 0, and .8084243834
    where the contact ends at zero force (Schwager and Pöschel, Phys. Rev. E 78 (2008) 051304)."""

    def ends(t: float, y: Array) -> float:
        return float(y[0] if pulls else SPRING * y[0] + DAMPER * y[1])

    ends.terminal, ends.direction = True, -1.0  # type: ignore[attr-defined]
    way = solve_ivp(
        lambda t, y: [y[1], -(SPRING * y[0] + DAMPER * y[1]) / MASS],
        (0.0, 1.0), [1e-300, 10.0], events=ends, method="DOP853", rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    assert round(expected, 10) == (0.8003536403 if pulls else 0.8084243834)
    assert -way.y[1, -1] / 10.0 == pytest.approx(expected, rel=1e-10)


def test_one_sided_forced_oscillator() -> None:
    """x″ + 0.1 x′ + x + 8 max(x, 0) = cos 2t from rest, after 150 periods."""
    system = ExactContacts([[1.0]], [[0.1]], [[1.0]], springs([[-1.0]], [0.0], 8.0), [[0.0], [1.0]], 2.0)
    way = system.run([0.0, 150 * np.pi], [0.0], [0.0])
    np.testing.assert_allclose([way.angles[-1, 0], way.rates[-1, 0]], [-0.8611948799, 0.1000478798], atol=5e-11)


# --- Modelica's backlash ---------------------------------------------------------------------------------------------


@numba.njit(error_model="numpy")
def limited_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """Beyond the gap by x: max(0, min(2 c x, c x + d ẋ)), a damper no stronger than the spring; c, d, gap."""
    stiffness, damping, gap = parameters
    side = 1.0 if angle > 0.0 else -1.0
    beyond = side * angle - gap
    if beyond <= 0.0:
        return plain(0.0, 0.0, 0.0)
    spring, damper = stiffness * beyond, damping * side * rate
    if damper > spring:
        return plain(side * 2.0 * spring, 2.0 * stiffness, 0.0)
    if spring + damper <= 0.0:
        return plain(0.0, 0.0, 0.0)
    return plain(side * (spring + damper), stiffness, damping)


class ElastoBacklash(Law):
    """The damping law of Modelica.Mechanics.Rotational.Components.ElastoBacklash."""

    kernel: ClassVar[Callable[..., Told]] = limited_torque
    parameters = np.array([20e3, 50.0, np.pi / 8.0])


def test_elasto_backlash_of_the_modelica_standard_library() -> None:
    """Its example: J 5, c 20000, d 50, 45° in all, from 90° at rest: after 1 s φ = −.155581, ω = −7.022937.

    Its damper is limited by the spring's torque, |d φ̇| ≤ c x.
    """
    system = equations([5.0], [Connection([1.0], law=ElastoBacklash())])
    way = explicit_march(system, [0.0, 1.0], [0.5 * np.pi], [0.0], tolerance=1e-11)
    np.testing.assert_allclose([way.angles[-1, 0], way.rates[-1, 0]], [-0.155581, -7.022937], atol=5e-7)


def test_a_limited_damper_is_that_of_the_modelica_standard_library() -> None:
    """The same example by the package's own law, explicitly and by implicit steps; torques by their formula."""
    law = Contacts.lash(np.pi / 4.0, 20e3, contact_time=50.0 / 20e3, damper="limited")
    system = equations([5.0], [Connection([1.0], law=law)])
    way = explicit_march(system, [0.0, 1.0], [0.5 * np.pi], [0.0], tolerance=1e-11)
    np.testing.assert_allclose([way.angles[-1, 0], way.rates[-1, 0]], [-0.155581, -7.022937], atol=5e-7)
    plan = prepare(system)
    stepped = march(
        plan, AlphaMethod.chung_hulbert(0.8), 1e-5, 100_000, begin(plan, [0.5 * np.pi], [0.0]), stride=100_000
    )
    np.testing.assert_allclose([stepped.records.q[-1, 0], stepped.records.v[-1, 0]], [-0.155581, -7.022937], atol=2e-3)
    x = np.pi / 8.0 + 0.01
    found = law.torque([x, x, x, -x, 0.1], [1.0, 9.0, -9.0, -1.0, 50.0])
    np.testing.assert_allclose(found, [250.0, 400.0, 0.0, -250.0, 0.0], atol=1e-9)


def test_backlash_with_a_continuous_force_is_another_motion() -> None:
    """The same example with max(0, c x + d ẋ): φ = .332616, ω = −5.480434, twice; a damper that presses sooner."""
    gap = np.pi / 8.0
    exact = alone(5.0, springs([[-1.0], [1.0]], [gap, gap], 20e3, 50.0 / 20e3)).run([0.0, 1.0], [0.5 * np.pi], [0.0])
    hinges = [(gap, 1.0, 20e3, 0.0025), (-gap, -1.0, 20e3, 0.0025)]
    way = explicit_march(
        equations([5.0], [Connection([1.0], hinges=hinges)]), [0.0, 1.0], [0.5 * np.pi], [0.0], tolerance=1e-12
    )
    np.testing.assert_allclose([exact.angles[-1, 0], exact.rates[-1, 0]], [0.332616, -5.480434], atol=5e-7)
    np.testing.assert_allclose(way.states[-1, :2], [exact.angles[-1, 0], exact.rates[-1, 0]], atol=1e-9)


# --- against each other ----------------------------------------------------------------------------------------------


def test_stages_without_contact_time_are_those_of_piecewise_motion() -> None:
    """Two masses on lash and a stage that ends (a negative stiffness) under a mean load and a cosine, 20 periods."""
    mass, damping, stiffness, omega = np.diag([1.0, 2.0]), np.diag([0.4, 0.0]), np.diag([50.0, 0.0]), 25.0
    law = [0.0, 0.02, 1.0, 900.0, -0.02, -1.0, 900.0, 0.06, 1.0, -700.0]
    loads = np.array([[0.0, 30.0], [60.0, 0.0]])
    bases = StageBases(mass, damping, stiffness, [[-1.0, 1.0]], [law])
    end = PiecewiseMotion(bases, loads, omega).flow(np.zeros(bases.coordinates.size), 20)
    contacts = OneSided(
        np.array([[1.0, -1.0, 1.0], [-1.0, 1.0, -1.0]]), np.array([0.02, 0.02, 0.06]),
        np.array([900.0, 900.0, -700.0]), np.zeros(3),
    )  # fmt: skip
    way = ExactContacts(mass, damping, stiffness, contacts, loads, omega).run(
        [0.0, 40.0 * np.pi / omega], np.zeros(2), np.zeros(2)
    )
    np.testing.assert_allclose(way.angles[-1], bases.coordinates.angles(end.state), atol=1e-11)
    np.testing.assert_allclose(way.rates[-1], bases.coordinates.rates(end.state), atol=1e-10)
    np.testing.assert_allclose(way.events, end.times[1:], rtol=1e-10)


SPEED = 600 * dmf_lcp.RPM


def flywheel() -> tuple[tuple[Array, Array, Array], OneSided, ExactContacts]:
    """DMF-LCP-1 at a constant speed of 600 rpm."""
    nodes, count = dmf_lcp.NODES, dmf_lcp.GAP.size
    directions = np.zeros((nodes, count))
    directions[dmf_lcp.PLUS, np.arange(count)], directions[dmf_lcp.MINUS, np.arange(count)] = 1.0, -1.0
    rows = np.zeros((len(dmf_lcp.LINEAR), nodes))
    for row, (a, b, _, _) in zip(rows, dmf_lcp.LINEAR, strict=True):
        row[[a, b]] = 1.0, -1.0
    damping, stiffness = (rows.T * value @ rows for value in (dmf_lcp.DAMPING, dmf_lcp.STIFFNESS))
    contacts = OneSided(directions, dmf_lcp.GAP, dmf_lcp.SPRING_STIFFNESS, np.full(count, dmf_lcp.CONTACT_TIME))
    loads = np.zeros((2, nodes), complex)
    loads[0, [dmf_lcp.PRIMARY, dmf_lcp.VEHICLE]] = dmf_lcp.MEAN, -dmf_lcp.MEAN
    loads[1, dmf_lcp.PRIMARY] = -1j * dmf_lcp.SWING
    system = (np.diag(dmf_lcp.INERTIA), damping, stiffness)
    return system, contacts, ExactContacts(*system, contacts, loads, dmf_lcp.ORDER * SPEED)


def test_explicit_integrators_find_the_exact_motion_of_shoes() -> None:
    """34 contacts on 18 inertias over 0.1 s: scipy's DOP853 to 1e-12 rad, the package's explicit one to 1e-11."""
    rest, times = np.zeros(dmf_lcp.NODES), [0.0, 0.02, 0.05, 0.1]
    exact = flywheel()[2].run(times, rest, rest)
    assert len(exact.events) > 20
    run = dmf_lcp.Flywheel(SPEED, SPEED)
    outside = solve_ivp(
        run.right_hand_side,
        (0.0, 0.1),
        np.zeros(2 * dmf_lcp.NODES),
        t_eval=times,
        method="DOP853",
        rtol=1e-12,
        atol=1e-14,
    )
    np.testing.assert_allclose(outside.y[: dmf_lcp.NODES].T, exact.angles, atol=1e-12)
    inside = explicit_march(run.equations(4096), times, rest, rest, tolerance=1e-12)
    np.testing.assert_allclose(inside.angles, exact.angles, atol=1e-11)


def generalised_alpha(h: float, rho: float = 0.8) -> Step:
    """Chung and Hulbert's method of a spectral radius ρ∞."""
    m, f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    return Step(h, m, f, 0.5 - m + f, 0.25 * (1 - m + f) ** 2)


def stepped(step: Step, end: float) -> tuple[Array, float, float]:
    """Angles (samples, nodes) at every 0.5 ms by complementarity, the worst certificate and the mean passes."""
    system, contacts, _ = flywheel()
    nodes, count = dmf_lcp.NODES, round(end / step.length)
    every, kept, worst, passes = round(5e-4 / step.length), [np.zeros(dmf_lcp.NODES)], 0.0, 0
    q, v, force, closed = np.zeros(nodes), np.zeros(nodes), np.zeros(contacts.gap.size), None

    def load(t: float) -> Array:
        u = np.zeros(nodes)
        u[dmf_lcp.PRIMARY] = dmf_lcp.MEAN + dmf_lcp.SWING * np.sin(dmf_lcp.ORDER * SPEED * t)
        u[dmf_lcp.VEHICLE] = -dmf_lcp.MEAN
        return u

    a = np.linalg.solve(system[0], load(0.0))
    for i in range(count):
        t = i * step.length
        problem = step_problem(system, contacts, (q, v, a, force), (load(t), load(t + step.length)), step)
        solved = problem.solve(closed)
        force, closed, passes = solved.force, solved.closed, passes + solved.passes
        worst = max(worst, violation(problem.matrix, problem.offset, force, problem.scale))
        q, v, a = problem.end(force)
        if (i + 1) % every == 0:
            kept.append(q)
    return np.array(kept), worst, passes / count


def test_steps_by_complementarity_are_of_second_order() -> None:
    """The error of the flywheels, gearbox and vehicle against the exact motion falls with h^1.9 or faster, every step
    certified to 1e-12.  Shoes on stops ring with 18000 rad/s: they follow where h is well below 1e-5."""
    end, rest, bodies = 0.05, np.zeros(dmf_lcp.NODES), slice(dmf_lcp.FIRST_SHOE)
    exact = flywheel()[2].run(np.linspace(0.0, end, 101), rest, rest).angles
    miss = []
    for h in (5e-5, 2.5e-5, 1.25e-5):
        angles, worst, passes = stepped(generalised_alpha(h), end)
        miss.append(np.abs(angles - exact)[:, bodies].max())
        assert worst < 1e-12
        assert passes < 1.1
    assert miss[0] < 2e-5 * np.abs(exact[:, 0] - exact[:, 1]).max()
    assert np.log2(miss[0] / miss[2]) / 2.0 > 1.9


# --- refusals --------------------------------------------------------------------------------------------------------


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ModelError, match="do not fit"):
        alone(1.0, springs([[-1.0, 0.0]], [0.1], 100.0))
