"""Stribeck's and Karnopp's friction: curves, energy, exact motions; loops of every law."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numba
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from torsional.errors import ModelError
from torsional.laws import Contacts, Coulomb, Hinges, Jenkins, Karnopp, LuGre, Stribeck, hysteresis_loop
from torsional.numerics.callbacks import law_at

BAND = Karnopp(1.0, 1.5, stick_rate=1e-3, bristle_stiffness=1e5, normal_load=2.0, grease_damping=0.3)

DAMPED = Karnopp(1.0, 1.5, stick_rate=1e-3, bristle_stiffness=1e5, bristle_damping=300.0, grease_damping=0.3)


# --- curves ---


def test_stribeck_is_odd_and_meets_its_curve_away_from_rest() -> None:
    law = Stribeck(1.0, 1.5, 0.1, 1e-3, normal_load=2.0, grease_damping=0.3)
    rates = np.linspace(-1.0, 1.0, 401)
    torque = law.torque(0.4, rates)
    np.testing.assert_allclose(torque, -torque[::-1], atol=1e-14)
    fast = np.abs(rates) >= 0.02
    curve = 2.0 * (1.0 + 0.5 * np.exp(-((rates / 0.1) ** 2))) * np.sign(rates) + 0.3 * rates
    np.testing.assert_allclose(torque[fast], curve[fast], rtol=2e-3)
    assert float(law.evaluate(0.0)[2]) == pytest.approx(2.0 * 1.5 / 1e-3 + 0.3)
    exact = LuGre(1e5, 300.0, 1.0, 1.5, 0.001, 0.4)
    assert float(exact.steady(0.001)) == pytest.approx(1.1843397206, abs=5e-11)
    fine = Stribeck(1.0, 1.5, 0.001, 1e-8, grease_damping=0.4)  # the same curve without memory
    assert float(fine.torque(0.0, 0.001)) == pytest.approx(1.1843397206, abs=1e-9)


@given(st.floats(1e-6, 0.1), st.sampled_from([1.0, -1.0]))
def test_karnopp_slides_at_its_curve(rate: float, way: float) -> None:
    angles = way * np.linspace(0.0, 1e-4, 50)  # three times what the bristle bends
    torque, _ = BAND.march(angles, (angles[1] - angles[0]) / (way * rate))
    assert torque[-1] == pytest.approx(float(BAND.steady(way * rate)), rel=1e-9)


def test_karnopp_sticks_breaks_away_and_slides() -> None:
    slow, fast = 1e-4, 1.0
    assert BAND.steady([slow, fast, -fast]) == pytest.approx([3.0 + 0.3e-4, 2.3, -2.3])
    torque, memory = BAND.march(np.array([0.0, 2e-5, 1e-5, 0.0]), 1.0)  # below 3 Nm: a spring
    assert torque == pytest.approx([0.0, 2.0 + 0.3 * 2e-5, 1.0 - 0.3e-5, -0.3e-5])
    assert memory == pytest.approx([0.0, 2e-5, 1e-5, 0.0])
    assert BAND.changes_within([-2.9e-5, -3.1e-5], [2.9e-5, 3.1e-5]).tolist() == [False, True]
    assert BAND.loaded(0.0).evaluate(0.0, 1.0, 1e-5, 0.1)[0] == pytest.approx(0.3)


# --- energy ---

BOUND = {
    "karnopp": (BAND, 0.5 * 1e5),
    "damped": (DAMPED, 0.5 * 1e5),
    "jenkins": (Jenkins(2.0, 1e5), 0.5 * 1e5),
    "lugre": (LuGre(1e5, 1e5**0.5, 1.0, 1.5, 1e-3, viscous_damping=0.4), 0.5 * 1e5),
    "stribeck": (Stribeck(1.0, 1.5, 0.1, 1e-3, grease_damping=0.3), 0.0),
    "coulomb": (Coulomb(2.0, 1e-3), 0.0),
}


@pytest.mark.parametrize("name", BOUND)
@given(st.floats(1e-7, 3e-3), st.floats(0.01, 30.0), st.floats(0.0, 0.7), st.floats(0.0, 6.3), st.integers(50, 2000))
def test_a_cycle_creates_no_energy(
    name: str, size: float, pace: float, second: float, phase: float, samples: int
) -> None:
    """Over the second period of two harmonics; what the bristle keeps of it is given back."""
    law, half = BOUND[name]
    time = np.arange(2 * samples + 1) / samples
    angle = size * (np.sin(2 * np.pi * time) + second * np.sin(4 * np.pi * time + phase))
    torque, memory = law.march(angle, 1 / (pace * samples))
    work = (torque[1:] * np.diff(angle))[samples:]
    stored = half * (memory[2 * samples] ** 2 - memory[samples] ** 2)
    assert work.sum() - stored >= -1e-12 * abs(work).sum()


@given(st.lists(st.tuples(st.floats(-0.1, 0.1), st.floats(0.0, 3.0)), min_size=5, max_size=40), st.floats(1e-5, 1.0))
def test_karnopp_takes_energy_in_every_step_whatever_its_load_does(moves: list[Any], step: float) -> None:
    kernel: Any = Karnopp.kernel
    memory = 0.0
    for rate, load in moves:
        told = kernel.py_func(DAMPED.loaded(load).parameters, 0.0, rate, memory, step)
        gained = 0.5e5 * (told[4] ** 2 - memory**2)
        scale = abs(told[0] * rate * step) + 0.5e5 * (told[4] ** 2 + memory**2)
        assert told[0] * rate * step - gained >= -1e-14 * scale
        memory = told[4]


# --- loops ---


def test_loops_have_their_closed_forms() -> None:
    washer = hysteresis_loop(Jenkins(50.0, 25e3), 0.01, centre=0.3)
    assert washer.loss == pytest.approx(4 * 50.0 * (0.01 - 0.002), rel=2e-6)
    assert washer.angle[0] == pytest.approx(0.3) and washer.torque[0] == pytest.approx(washer.torque[-1])
    band = Karnopp(50.0, 50.0, 1e-3, 25e3)  # without a fall from breakaway it is the washer
    assert hysteresis_loop(band, 0.01).loss == pytest.approx(washer.loss, rel=1e-12)
    assert hysteresis_loop(Jenkins(50.0, 25e3), 0.0019).loss == pytest.approx(0.0, abs=1e-12)
    viscous = Stribeck(0.0, 0.0, 1.0, 0.1, grease_damping=2.0)
    assert hysteresis_loop(viscous, 0.1, frequency=3.0).loss == pytest.approx(np.pi * 2.0 * 6 * np.pi * 0.01, rel=1e-5)
    dry = hysteresis_loop(Coulomb(5.0, 1e-6), 0.1, frequency=1.0)
    assert dry.loss == pytest.approx(4 * 5.0 * 0.1, rel=1e-3)
    spring = hysteresis_loop(Hinges.staged([(100.0, 1e3)], lash=0.02, stop_stiffness=1e5), 0.3)
    assert spring.loss == pytest.approx(0.0, abs=1e-9 * 100)
    with pytest.raises(ModelError, match="amplitude"):
        hysteresis_loop(BAND, 0.0)


def test_a_contact_loses_what_its_damper_takes() -> None:
    """k τ ∮ φ̇ dφ over the time it presses, by quadrature at the exact rate."""
    law = Contacts((0.05,), (1.0,), (1e4,), (2e-3,))
    t = np.linspace(0.0, 1.0, 400001)
    angle, rate = 0.1 * np.sin(2 * np.pi * t), 0.2 * np.pi * np.cos(2 * np.pi * t)
    power = np.asarray(law.torque(angle, rate)) * rate
    assert hysteresis_loop(law, 0.1, samples=20000).loss == pytest.approx(float(power[:-1].mean()), rel=1e-3)


# --- Den Hartog's oscillator under dry friction ---

EXACT = {(0.8, 0.3): 2.62610488, (1.2, 0.3): 2.07238427}


def closed_form(beta: float, ratio: float) -> float:
    """k x0/P of the motion that never stops."""
    v = 1 / (1 - beta**2)
    u = math.sin(math.pi / beta) / (beta * (1 + math.cos(math.pi / beta)))
    return math.sqrt(v**2 - (ratio * u) ** 2)


def by_pieces(beta: float, ratio: float, turns: int) -> float:
    """m = k = P = 1: closed form from one reversal to the next, each found to rounding; the last amplitude."""
    t, x, v, way = 0.0, 3.0, 0.0, -1.0
    forced = 1 / (1 - beta**2)
    for _ in range(turns):
        offset = x - forced * math.cos(beta * t) + way * ratio
        swing = v + forced * beta * math.sin(beta * t)

        def rate(s: float, t: float = t, a: float = offset, b: float = swing) -> float:
            return -a * math.sin(s) + b * math.cos(s) - forced * beta * math.sin(beta * (t + s))

        grid = np.linspace(1e-6, 4 * np.pi, 4000)
        first = next((a, b) for a, b in pairwise(grid.tolist()) if rate(a) * rate(b) <= 0)
        s = float(brentq(rate, *first, xtol=1e-15))
        x = offset * math.cos(s) + swing * math.sin(s) + forced * math.cos(beta * (t + s)) - way * ratio
        t, v = t + s, 0.0
        way = math.copysign(1.0, math.cos(beta * t) - x)  # it goes on where force and spring push it
        assert abs(math.cos(beta * t) - x) > ratio  # it does not stop
    return abs(x)


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def marched(address: int, parameters: Any, beta: float, step: float, cycles: int) -> float:
    """The largest deflection in the last cycle, by implicit midpoint steps with the law at the mean rate."""
    torque = law_at(address)
    x, v, memory, t, largest = 0.0, 0.0, 0.0, 0.0, 0.0
    period = 2 * math.pi / beta
    while t < cycles * period:
        force = math.cos(beta * (t + 0.5 * step))
        mean = v
        for _ in range(60):
            told = torque(parameters, 0.0, mean, memory, step)
            rest = 2.0 * (mean - v) / step + x + 0.5 * step * mean + told[0] - force
            change = rest / (2.0 / step + 0.5 * step + max(told[2], 0.0))
            mean -= change
            if abs(change) < 1e-14:
                break
        memory = torque(parameters, 0.0, mean, memory, step)[4]
        x, v, t = x + step * mean, 2.0 * mean - v, t + step
        if t > (cycles - 1) * period:
            largest = max(largest, abs(x))
    return largest


@pytest.mark.parametrize(("beta", "ratio"), EXACT)
def test_den_hartog(beta: float, ratio: float) -> None:
    assert closed_form(beta, ratio) == pytest.approx(EXACT[beta, ratio], abs=5e-9)
    assert by_pieces(beta, ratio, 400) == pytest.approx(EXACT[beta, ratio], abs=5e-9)


@pytest.mark.parametrize(("beta", "ratio"), EXACT)
def test_den_hartog_with_smoothed_friction(beta: float, ratio: float) -> None:
    for law in (Coulomb(ratio, 1e-3), Stribeck(ratio, ratio, 1e-2, 1e-3)):
        found = marched(law.address, law.parameters, beta, 5e-4, 60)
        assert found == pytest.approx(EXACT[beta, ratio], rel=6e-5)


@pytest.mark.parametrize(("beta", "ratio"), EXACT)
def test_den_hartog_with_bristles(beta: float, ratio: float) -> None:
    """A bristle turns over 2F/k at every reversal, which takes a time and an amplitude that fall with √k."""
    for make in (lambda k: Jenkins(ratio, k), lambda k: Karnopp(ratio, ratio, 1e-5, k)):
        soft, stiff = (marched(make(k).address, make(k).parameters, beta, 2.5e-4, 60) for k in (1e3, 1e4))
        missing = stiff / EXACT[beta, ratio] - 1
        assert 5e-4 < abs(missing) < 3e-3
        assert (soft / EXACT[beta, ratio] - 1) / missing == pytest.approx(10**0.5, rel=0.05)
        assert stiff + (stiff - soft) / (10**0.5 - 1) == pytest.approx(EXACT[beta, ratio], rel=2e-4)


# --- stick-slip ---


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def slips(address: int, parameters: Any, step: float, count: int) -> Any:
    """When a unit mass on friction, pulled at 0.1 by a spring of 2, breaks away: explicit steps."""
    torque = law_at(address)
    x, v, memory = 0.0, 0.0, 0.0
    found = [0.0]
    for i in range(count):
        told = torque(parameters, 0.0, v, memory, step)
        memory, before = told[4], v
        v += step * (2.0 * (0.1 * i * step - x) - told[0])
        x += step * v
        if before <= 0.05 < v:
            found.append(i * step)
    return np.array(found)


def test_karnopps_stick_slip_tends_to_the_exact_one() -> None:
    """Sticks until 1.5, slides at 1: 2 Δ/(k v) of rest and 2/ω (π − atan(ω Δ/(k v))) of sliding, Δ = 0.5.

    Leaving the band takes a time that falls with √D.
    """
    omega = 2**0.5
    exact = 5.0 + 2 / omega * (np.pi - np.arctan(omega * 0.5 / 0.2))
    assert exact == pytest.approx(7.611259, abs=1e-6)
    periods = []
    for band in (1e-3, 1e-4):
        law = Karnopp(1.0, 1.5, band, 1e5, 1e5**0.5)
        periods.append(float(np.diff(slips(law.address, law.parameters, 2e-5, 1_500_000))[-1]))
    wide, narrow = (period / exact - 1 for period in periods)
    assert 0 < narrow < 0.01 and wide / narrow == pytest.approx(10**0.5, rel=0.03)
    assert periods[1] - (periods[0] - periods[1]) / (10**0.5 - 1) == pytest.approx(exact, rel=5e-4)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Stribeck(2.0, 1.0, 1.0, 0.1), "breakaway_torque: must not be below"),
        (lambda: Stribeck(1.0, 1.5, 0.1, 0.2), "regularisation_rate: the curve would be smoothed away"),
        (lambda: Stribeck(1.0, 1.5, 0.0, 0.2), "stribeck_rate: must be positive"),
        (lambda: Stribeck(1.0, 1.5, 1.0, 0.1, grease_damping=-1.0), "grease_damping: must not be negative"),
        (lambda: Karnopp(1.0, float("inf"), 0.1, 1.0), "breakaway_torque"),
        (lambda: Karnopp(1.0, 1.5, 0.0, 1.0), "stick_rate: must be positive"),
        (lambda: Karnopp(1.0, 1.5, 0.1, float("nan")), "bristle_stiffness: a finite number is wanted; found nan"),
        (lambda: Karnopp(1.0, 1.5, 0.1, 1.0, normal_load=-1.0), "normal_load: must not be negative"),
    ],
)
def test_refused(make: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        make()
