"""Time steps against exact motion: contacts, clearances, orders of convergence, marches cut in pieces, refusals."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.numerics.stepping.stepping_models import Link, Push, equations, sine

from torsional.errors import ModelError
from torsional.laws import LuGre
from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import Equations
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Count, March, Settings, Status, begin, march
from torsional.numerics.stepping.plan import prepare

MEMBERS = {
    "newmark": AlphaMethod.newmark(),
    **{f"chung_hulbert_{rho:g}": AlphaMethod.chung_hulbert(rho) for rho in (1.0, 0.9, 0.8, 0.5, 0.0)},
    **{f"hht_{rho:g}": AlphaMethod.hht(rho) for rho in (0.9, 0.5)},
    **{f"bossak_{rho:g}": AlphaMethod.bossak(rho) for rho in (0.8, 0.0)},
}
FREE = Settings(guard=False)


def marched(of: Equations, q: object, v: object, end: float, steps: int, method: AlphaMethod, **more: object) -> March:
    """From the start to ``end`` in ``steps`` steps."""
    plan = prepare(of)
    return march(plan, method, end / steps, steps, begin(plan, q, v), **more)  # type: ignore[arg-type]


def order_of(errors: Array) -> float:
    """Order of convergence from errors at steps that are halved."""
    return float(np.log2(errors[:-1] / errors[1:]).mean())


def wall(gap: float, stiffness: float, time: float = 0.0, side: float = 1.0) -> tuple[float, float, float, float]:
    return gap * side, side, stiffness, time


# --- exact motion ---


def test_a_mass_meets_a_wall_and_leaves() -> None:
    found = marched(
        equations([1.0], [Link([1.0], hinges=[wall(0.1, 100.0)])]), 0.0, 1.0, 1.0, 100_000, MEMBERS["newmark"]
    )
    closed = found.records.torque[:, 0] > 0.0
    assert closed.sum() * 1e-5 == pytest.approx(np.pi / 10, abs=2e-5)
    assert found.records.v[-1, 0] == pytest.approx(-1.0, abs=1e-7)
    assert found.records.q[-1, 0] == pytest.approx(0.1 - (1.0 - 0.1 - np.pi / 10), abs=1e-7)


def test_the_period_of_a_clearance() -> None:
    both = [wall(1.0, 100.0), wall(1.0, 100.0, side=-1.0)]
    period = 1.0283185307
    found = marched(equations([1.0], [Link([1.0], hinges=both)]), 2.0, 0.0, 3 * period, 300_000, MEMBERS["newmark"])
    at = found.records.q[100_000::100_000, 0]
    np.testing.assert_allclose(at, 2.0, atol=1e-6)
    np.testing.assert_allclose(found.records.v[100_000::100_000, 0], 0.0, atol=3e-6)


def test_restitution_of_a_damped_stop() -> None:
    m, k, c, v0 = 0.5, 1e4, 10.0, 10.0
    omega, zeta = np.sqrt(k / m), c / (2 * np.sqrt(k * m))
    fast = omega * np.sqrt(1 - zeta**2)
    held = marched(equations([m], [Link([1.0], k, c)]), 0.0, v0, np.pi / fast, 20_000, MEMBERS["newmark"])
    assert -held.records.v[-1, 0] / v0 == pytest.approx(0.8003536403, abs=1e-8)

    def torque(t: float) -> float:  # of the spring that cannot pull, over e^−ζωt
        return float(k * np.sin(fast * t) + c * (fast * np.cos(fast * t) - zeta * omega * np.sin(fast * t)))

    leaves = brentq(torque, 0.5 * np.pi / fast, np.pi / fast, xtol=1e-15)
    speed = np.exp(-zeta * omega * leaves) * (np.cos(fast * leaves) - zeta * omega / fast * np.sin(fast * leaves))
    stop = equations([m], [Link([1.0], hinges=[wall(0.0, k, c / k)])])
    found = marched(stop, 0.0, v0, 0.03, 60_000, MEMBERS["newmark"])
    assert found.records.v[-1, 0] / v0 == pytest.approx(speed, abs=1e-6)


@pytest.mark.parametrize("name", ["newmark", "chung_hulbert_0.8"])
def test_a_forced_oscillator_with_one_sided_spring_after_150_periods(name: str) -> None:
    push = Push([1.0], samples=sine(np.pi / 2, 1024), multiple=2.0)
    of = equations([1.0], [Link([1.0], 1.0, 0.1, hinges=[wall(0.0, 8.0)])], [push])
    found = marched(of, 0.0, 0.0, 150 * np.pi, 150 * 2000, MEMBERS[name], stride=150 * 2000)
    ends = found.records.q[-1, 0], found.records.v[-1, 0]
    np.testing.assert_allclose(ends, (-0.8611948799, 0.1000478798), atol=2e-5)


# --- orders ---


def smooth_chain() -> Equations:
    links = [Link([1.0, -1.0, 0.0], 400.0, 0.4), Link([0.0, 1.0, -1.0], 900.0, 0.2), Link([0.0, 0.0, 1.0], 50.0, 1.0)]
    return equations([1.0, 0.5, 2.0], links, [Push([1.0, 0.0, 0.0], samples=sine(), multiple=7.0)])


@pytest.mark.parametrize("name", MEMBERS)
def test_second_order_in_smooth_motion(name: str) -> None:
    start = [0.1, -0.05, 0.02], [0.0, 1.0, 0.0]
    exact = marched(smooth_chain(), *start, 1.0, 64_000, MEMBERS["newmark"]).records.q[-1]
    errors = [
        np.abs(marched(smooth_chain(), *start, 1.0, n, MEMBERS[name]).records.q[-1] - exact).max()
        for n in (500, 1000, 2000)
    ]
    assert order_of(np.array(errors)) >= 1.9


def rattling() -> Equations:
    hinges = [wall(0.05, 4e3, 1e-3), wall(0.05, 4e3, 1e-3, side=-1.0)]
    links = [Link([1.0, -1.0], 20.0, 0.1, hinges=hinges), Link([0.0, 1.0], 100.0, 0.5, hinges=[wall(0.1, 500.0)])]
    return equations([0.3, 1.0], links, [Push([1.0, 0.0], level=((0.0,), (20.0,)), samples=sine(0.3), multiple=9.0)])


@pytest.mark.parametrize("name", MEMBERS)
def test_second_order_with_contacts(name: str) -> None:
    """The error wavers with where in a step a contact falls: its fall over a factor of sixteen in the step counts."""
    exact = marched(rattling(), 0.0, 0.0, 1.0, 512_000, MEMBERS["newmark"], settings=FREE, stride=5120).records.q
    steps = (2000, 4000, 8000, 16000, 32000)
    runs = [marched(rattling(), 0.0, 0.0, 1.0, n, MEMBERS[name], settings=FREE, stride=n // 100) for n in steps]
    assert (runs[0].records.torque[:, 0] != 0).any() and runs[0].count(Count.FACTORS) > 20
    errors = np.array([np.abs(run.records.q - exact).max() for run in runs])
    assert order_of(errors) >= 1.9


# --- marches in pieces ---


def pressed() -> Equations:
    """Bristles that other springs press: their normal load changes with every step."""
    law = LuGre(1e3, 3.0, 2.0, breakaway_torque=3.0, stribeck_rate=0.1)
    links = [Link([1.0, -1.0], 400.0, 0.4), Link([0.0, 1.0], 50.0, 1.0)]
    links += [Link([1.0, -1.0], law=law, load=(0.2, 0.0, [(0, 0.05)]))]
    return equations([1.0, 0.5], links, [Push([1.0, 0.0], level=((0.0,), (20.0,)), samples=sine(0.2), multiple=9.0)])


@pytest.mark.parametrize("of", [rattling, pressed])
def test_pieces_give_the_same_bits(of: Callable[[], Equations]) -> None:
    plan, method = prepare(of()), MEMBERS["chung_hulbert_0.8"]
    for settings in (Settings(), Settings(rungs=4, angle_error=1e-8)):
        whole = march(plan, method, 1e-3, 300, begin(plan, 0.0, 0.0), settings=settings)
        state, parts = begin(plan, 0.0, 0.0), []
        for count in (1, 99, 0, 200):
            part = march(plan, method, 1e-3, count, state, settings=settings, at=range(1, count + 1))
            state, parts = part.state, [*parts, part.records]
        for name in ("time", "q", "v", "acceleration", "torque", "load", "ledger"):
            pieces = np.concatenate([getattr(part, name) for part in parts])
            assert np.array_equal(getattr(whole.records, name)[1:], pieces), name
        assert whole.count(Count.STEPS) == state.counts[Count.STEPS]


def test_a_state_is_not_changed_by_a_march() -> None:
    plan = prepare(rattling())
    state = begin(plan, 0.0, 0.0)
    before = state.copied()
    march(plan, MEMBERS["newmark"], 1e-3, 50, state)
    assert all(np.array_equal(a, b) for a, b in zip(state, before, strict=True))


# --- steps that follow the error ---


def test_the_error_chooses_the_step() -> None:
    exact = marched(rattling(), 0.0, 0.0, 1.0, 256_000, MEMBERS["newmark"], settings=FREE, stride=2560).records.q
    errors, counts = [], []
    for allowed in (1e-6, 1e-8):
        settings = Settings(guard=False, rungs=12, angle_error=allowed)
        found = marched(rattling(), 0.0, 0.0, 1.0, 100, MEMBERS["chung_hulbert_0.9"], settings=settings)
        assert found.status == Status.DONE and found.count(Count.REJECTED) > 0
        np.testing.assert_allclose(found.records.time, np.linspace(0, 1, 101), rtol=1e-14)
        errors.append(np.abs(found.records.q - exact).max())
        counts.append(found.count(Count.STEPS))
    assert errors[0] < 2e-3 and errors[1] < errors[0] / 10
    assert counts[0] < counts[1] < 60_000


# --- refusals ---


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"step": 0.0}, "must be positive"),
        ({"step": float("nan")}, "must be positive"),
        ({"steps": -1}, "rise from 0"),
        ({"at": [3, 2]}, "rise from 0"),
        ({"at": [11]}, "beyond the last"),
    ],
)
def test_marches_that_make_no_sense(arguments: dict[str, object], told: str) -> None:
    plan = prepare(smooth_chain())
    asked = {"step": 1e-3, "steps": 10} | arguments
    with pytest.raises(ModelError, match=told):
        march(plan, MEMBERS["newmark"], state=begin(plan, 0.0, 0.0), **asked)  # type: ignore[arg-type]


def test_starts_and_systems_that_make_no_sense() -> None:
    plan = prepare(smooth_chain())
    with pytest.raises(ModelError, match="q: does not fit"):
        begin(plan, np.zeros(2), 0.0)
    with pytest.raises(ModelError, match="v: does not fit"):
        begin(plan, 0.0, np.nan)
    with pytest.raises(ModelError, match="inertia: a number is not finite"):
        prepare(equations([np.nan], [Link([1.0], 1.0)]))


def test_what_blows_up_is_told() -> None:
    negative = equations([1.0], [Link([1.0], -1e9)])
    assert marched(negative, 0.1, 0.0, 1.0, 1000, MEMBERS["newmark"]).status == Status.INDEFINITE
