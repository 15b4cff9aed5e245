"""Dry friction against its curves, closed forms and another integrator."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from torsional.components import Coupling, Damper, Inertia, Shaft
from torsional.errors import ModelError
from torsional.laws import Coulomb, Jenkins, LuGre
from torsional.laws.lugre import fading, stribeck
from torsional.numerics.callbacks import law_at
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.system import assemble

BRISTLES = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)


def loop_area(angle: Any, torque: Any) -> float:
    """∮ T dφ of a closed history, by trapezoids."""
    return float((0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)).sum())


# --- Coulomb ---


def test_coulomb_is_odd_bounded_and_as_near_as_told() -> None:
    law, rates = Coulomb(80.0, regularisation_rate=0.02), np.linspace(-5.0, 5.0, 101)
    torque = law.torque(0.3, rates)
    assert torque == pytest.approx(-torque[::-1]) and abs(torque).max() < 80.0
    assert float(law.torque(0.0, 0.2)) == pytest.approx(80.0 * 10 / 101**0.5, rel=1e-12)
    assert float(law.torque(0.0, 0.2)) / 80.0 > 0.995
    assert float(law.evaluate(0.0)[2]) == pytest.approx(80.0 / 0.02)


# --- Jenkins ---


@given(
    st.floats(0.0, 200.0, allow_subnormal=False).filter(lambda x: x == 0 or x > 1e-9),
    st.floats(1e3, 1e6),
    st.floats(1.01, 50.0),
    st.floats(1e-4, 10.0),
)
def test_jenkins_loop_has_its_area(limit: float, stiffness: float, reach: float, step: float) -> None:
    """4 F (A − F/k) on triangles whose corners and slip points are sampled, whatever the pace."""
    slip = limit / stiffness
    half = max(reach * slip, 1e-6)
    corners = [0.0, half, half - 2 * slip, -half, -half + 2 * slip, half]
    torque, memory = Jenkins(limit, stiffness).march(corners, step)
    area = loop_area(np.array(corners[1:]), torque[1:])
    assert area == pytest.approx(4 * limit * (half - slip), rel=1e-9, abs=1e-12 * limit)
    assert abs(memory).max() <= slip * (1 + 1e-15)


def test_jenkins_sticks_without_loss() -> None:
    angle = 0.0019 * np.sin(np.linspace(0, 4 * np.pi, 400))
    torque, _ = Jenkins(50.0, 25e3).march(angle, 1e-3)
    assert torque == pytest.approx(25e3 * angle, abs=1e-9)


def test_washer_beside_a_spring_carries_no_mean_torque() -> None:
    """The spring's twist, the stuck washer's stiffness, and no share of the torque, on either way to equilibrium."""
    line = {
        "engine": Inertia(1.0),
        "spring": Shaft("disc", "engine", 1e4, damping=3.0),
        "washer": Coupling("disc", "engine", Jenkins(60.0, 3e4)),
        "disc": Inertia(2.0),
        "drag": Damper("disc", damping=1.0),
    }
    bypassed = {**line, "bypass": Shaft("disc", "engine", 3e4)}
    for parts, stiffness in ((line, 1e4), (bypassed, 4e4)):
        system = assemble(Powertrain(parts))
        point = equilibrium(system, {"engine": 200.0}, hold="disc")
        washer = point.names.index("washer")
        assert point.torque[washer] == 0.0 and point.torque.sum() == pytest.approx(200.0)
        assert point.angle[washer] == pytest.approx(200.0 / stiffness)
        assert (point.stiffness[washer], point.stage("washer")) == (3e4, "sticks")
        linear = linearize(system, point)
        assert np.abs(linear.K).max() == pytest.approx(stiffness + 3e4)
        assert linear.connections.damping.tolist() == system.connections.damping.tolist()


def test_friction_alone_carries_nothing() -> None:
    line = {"engine": Inertia(1.0), "washer": Coupling("disc", "engine", Jenkins(60.0, 3e4)), "disc": Inertia(2.0)}
    point = equilibrium(assemble(Powertrain(line)), {"engine": 0.0}, hold="disc")
    assert (point.torque.tolist(), point.angle.tolist(), point.stiffness.tolist()) == ([0.0], [0.0], [3e4])
    with pytest.raises(ModelError, match="no spring carries"):
        equilibrium(assemble(Powertrain(line)), {"engine": 10.0}, hold="disc")


# --- LuGre ---


@given(st.floats(1e-7, 0.1), st.sampled_from([1.0, -1.0]), st.floats(0.1, 4.0), st.floats(0.0, 2.0))
def test_lasting_sliding_meets_the_curve(rate: float, way: float, load: float, grease: float) -> None:
    """At a constant rate, over the ways that the bristles need to bend forty times."""
    law = LuGre(1e5, 316.0, 1.0, 1.5, 0.001, viscous_damping=0.4, normal_load=load, grease_damping=grease)
    angles = way * np.linspace(0.0, 40 * 1.5 / 1e5, 1000)
    torque, _ = law.march(angles, (angles[1] - angles[0]) / (way * rate))
    assert torque[-1] == pytest.approx(float(law.steady(way * rate)), rel=1e-6)


def test_steady_value() -> None:
    assert float(BRISTLES.steady(0.001)) == pytest.approx(1.1843397206, abs=5e-11)


@given(st.floats(0.0, 60.0))
def test_fading_beside_its_definition(x: float) -> None:
    left, mean, slope = fading(x)
    assert left == pytest.approx(np.exp(-x), rel=1e-15)
    if x > 0:
        assert mean == pytest.approx(-np.expm1(-x) / x, rel=4e-15)
    nodes, weights = np.polynomial.legendre.leggauss(80)  # φ1 = ∫ e^(−x t) dt over 0 … 1
    t, w = 0.5 * (nodes + 1), 0.5 * weights
    assert mean == pytest.approx((w * np.exp(-x * t)).sum(), rel=1e-13)
    assert slope == pytest.approx(-(w * t * np.exp(-x * t)).sum(), rel=1e-13)


@given(st.floats(-5.0, 5.0), st.floats(0.0, 1.0), st.floats(-1.5e-5, 1.5e-5))
def test_coefficient_is_positive_and_that_of_the_torque(rate: float, step: float, bent: float) -> None:
    coefficient = float(BRISTLES.coefficient(rate, step))
    assert coefficient > 0
    s0, s1, s2 = 1e5, 1e5**0.5, 0.4
    a = s0 * abs(rate) / stribeck(rate, 1.0, 1.5, 0.001)[0]
    left = fading(a * step)[0]
    rest = (s0 - s1 * a) * left * bent
    assert coefficient == pytest.approx(s0 * step * fading(a * step)[1] + s1 * left + s2, rel=1e-12)
    torque = float(BRISTLES.evaluate(0.0, rate, bent, step)[0])
    assert torque == pytest.approx(rest + coefficient * rate, rel=1e-9, abs=1e-9)


@given(st.floats(1e-7, 3e-3), st.floats(0.01, 30.0), st.floats(0.0, 0.7), st.floats(0.0, 6.3), st.integers(50, 2000))
def test_a_cycle_creates_no_energy(size: float, pace: float, second: float, phase: float, samples: int) -> None:
    """Two periods of two harmonics; over the second, once the bristles run in a cycle, work is lost or none."""
    time = np.arange(2 * samples + 1) / samples
    angle = size * (np.sin(2 * np.pi * time) + second * np.sin(4 * np.pi * time + phase))
    torque, memory = BRISTLES.march(angle, 1 / (pace * samples))
    rate, last = np.diff(angle), slice(samples + 1, 2 * samples + 1)
    work = (torque[1:] * rate)[samples:]
    stored = 0.5 * 1e5 * (memory[2 * samples] ** 2 - memory[samples] ** 2)
    assert work.sum() - stored >= -1e-12 * abs(work).sum()
    assert memory[last].any()


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def pulled(address: int, parameters: Any, step: float, count: int) -> Any:
    """Positions of a unit mass on friction, pulled at 0.1 by a spring of 2: implicit steps, Newton's method."""
    torque = law_at(address)
    x, v, memory = 0.0, 0.0, 0.0
    positions = np.empty(count)
    for i in range(count):
        new = v
        for _ in range(50):
            told = torque(parameters, 0.0, new, memory, step)
            spring = 2.0 * (0.1 * (i + 1) * step - x - step * new)
            change = (new - v - step * (spring - told[0])) / (1.0 + step * (2.0 * step + told[2]))
            new -= change
            if abs(change) < 1e-16:
                break
        memory = torque(parameters, 0.0, new, memory, step)[4]
        v, x = new, x + step * new
        positions[i] = x
    return positions


def stick_slip_period(step: float) -> float:
    """Time between the last two slips of forty seconds."""
    positions = pulled(BRISTLES.address, BRISTLES.parameters, step, int(40 / step))
    rate = np.diff(positions) / step
    starts = np.flatnonzero((rate[1:] > 0.05) & (rate[:-1] <= 0.05)) * step
    return float(starts[-1] - starts[-2])


def test_stick_slip_period() -> None:
    assert stick_slip_period(2e-5) == pytest.approx(6.363, abs=1e-3)


def test_stick_slip_as_an_integrator_of_its_own_finds_it() -> None:
    """The law's differential form, ż from its own definition, by an implicit Runge–Kutta method."""
    from scipy.integrate import solve_ivp

    def flow(t: float, y: Any) -> Any:
        x, v, z = y
        curve = 1.0 + 0.5 * np.exp(-((v / 0.001) ** 2))
        bending = v - 1e5 * abs(v) / curve * z
        return [v, 2.0 * (0.1 * t - x) - (1e5 * z + 1e5**0.5 * bending + 0.4 * v), bending]

    def slips(t: float, y: Any) -> float:
        return float(y[1] - 0.05)

    slips.direction = 1.0  # type: ignore[attr-defined]
    found = solve_ivp(flow, (0.0, 40.0), [0.0, 0.0, 0.0], method="Radau", rtol=1e-7, atol=1e-12, events=slips)
    times = found.t_events[0]
    assert times[-1] - times[-2] == pytest.approx(6.363, abs=1e-3)
    assert stick_slip_period(2e-5) == pytest.approx(times[-1] - times[-2], abs=5e-4)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Jenkins(-1.0, 1.0), "limit_torque: must not be negative"),
        (lambda: Jenkins(1.0, 0.0), "stiffness: must be positive"),
        (lambda: Coulomb(1.0, 0.0), "regularisation_rate: must be positive"),
        (lambda: LuGre(1e5, 1.0, 2.0, 1.0, 0.1), "breakaway_torque: must not be below sliding"),
        (lambda: LuGre(1e5, 1.0, 2.0, 2.0, float("nan")), "stribeck_rate: a finite number is wanted; found nan"),
        (lambda: LuGre(1e5, -1.0, 2.0, 2.0, 0.1), "bristle_damping: must not be negative"),
    ],
)
def test_values_refused(make: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        make()


def test_bristles_slide_in_swings_that_bend_them_further_than_they_hold() -> None:
    """Sliding begins at g_c/σ0 = 1e-5 rad to either side, whatever presses them and wherever the swing lies."""
    for load in (1.0, 3.0):
        law = LuGre(1e5, 300.0, 1.0, 1.5, 0.001, normal_load=load)
        swings = np.array([0.9e-5, 1.1e-5])
        assert law.changes_within(0.2 - swings, 0.2 + swings).tolist() == [False, True]
