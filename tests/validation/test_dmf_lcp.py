"""DMF-LCP-1: the figures of the reference by SciPy, then what this project's integrators make of it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.validation import dmf_lcp
from tests.validation.dmf_lcp import INERTIA, NODES, REFERENCE, RPM, observed

from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.motion.data import DAMPER, SPRING, Equations, Rows
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Status, begin, march
from torsional.numerics.stepping.plan import prepare

TABLE = np.array(REFERENCE)
TIMES, FIGURES = TABLE[:, 0], TABLE[:, 1:]


def states(count: int) -> np.ndarray:
    """States in which springs of all kinds are closed."""
    rng = np.random.default_rng(5)
    angle = rng.standard_normal((count, NODES)) * np.geomspace(0.005, 2.0, count)[:, None]
    return np.hstack([angle, rng.standard_normal((count, NODES))])


def test_the_reference_by_an_explicit_integrator() -> None:
    found = solve_ivp(
        dmf_lcp.right_hand_side,
        (0.0, TIMES[-1]),
        np.zeros(2 * NODES),
        method="DOP853",
        t_eval=TIMES,
        rtol=1e-12,
        atol=1e-13,
    )
    figures = observed(found.y.T)
    np.testing.assert_allclose(figures[:, :3], FIGURES[:, :3], rtol=0, atol=1e-12)
    np.testing.assert_allclose(figures[:, 3], FIGURES[:, 3], rtol=0, atol=1e-6)


def test_the_explicit_march() -> None:
    """Another integrator on the arrays of the contract, whose sine is made of cubics."""
    rest, times = np.zeros(NODES), np.append(0.0, TIMES)
    found = explicit_march(dmf_lcp.equations(), times, rest, rest, tolerance=1e-11)
    figures = observed(np.hstack([found.angles, found.rates]))[1:]
    np.testing.assert_allclose(figures[:, :3], FIGURES[:, :3], rtol=0, atol=1e-11)
    np.testing.assert_allclose(figures[:, 3], FIGURES[:, 3], rtol=0, atol=1e-6)


# 1/h [1/s], then what the reference's figures may be off: the relative angle and the primary's of their largest, the
# shoe's of its largest, the clutch torque's of its largest
STEPS = [(10_000, 5e-5, 2.5e-5, 2e-3, 8e-5), (160_000, 3e-7, 1.5e-7, 1e-5, 6e-7)]


@pytest.mark.parametrize("pace, twist, primary, shoe, clutch", STEPS)
def test_steps_come_to_the_reference(pace: int, twist: float, primary: float, shoe: float, clutch: float) -> None:
    figures, span = stepped(pace)
    error = np.abs(figures[np.round(TIMES * 1000).astype(int)] - FIGURES).max(axis=0) / span
    assert (error <= [twist, primary, shoe, clutch]).all(), error


def test_steps_are_of_second_order() -> None:
    """Corners included: over four halvings the error of every figure falls as the square of the step, nearly."""
    finest = stepped(320_000)[0]
    coarse, fine = (np.abs(stepped(pace)[0] - finest).max(axis=0) for pace in (10_000, 80_000))
    assert (np.log2(coarse / fine) / 3 > 1.7).all()


def stepped(pace: int) -> tuple[np.ndarray, np.ndarray]:
    """What the reference lists every millisecond of 0.1 s by steps of 1/pace [s], and its largest sizes."""
    plan = prepare(dmf_lcp.equations())
    start, count = begin(plan, np.zeros(NODES), np.zeros(NODES)), round(pace * TIMES[-1])
    found = march(plan, AlphaMethod.chung_hulbert(0.9), 1.0 / pace, count, start, stride=pace // 1000)
    assert found.status == Status.DONE
    figures = observed(np.hstack([found.records.q, found.records.v]))
    return figures, np.abs(figures).max(axis=0)


def test_the_jacobian_is_that_of_the_rates() -> None:
    direction = np.random.default_rng(6).standard_normal(2 * NODES)
    step = 1e-7
    for state in states(6):
        ahead, behind = (dmf_lcp.right_hand_side(0.0, state + sign * step * direction) for sign in (1, -1))
        exact = dmf_lcp.jacobian(0.0, state) @ direction
        np.testing.assert_allclose(exact, (ahead - behind) / (2 * step), rtol=0, atol=1e-6 * np.abs(exact).max())


def test_the_arrays_say_the_same() -> None:
    """Torques by the formulas of the arrays, summed in NumPy, against the rates that the reference was made with."""
    flywheel = dmf_lcp.Flywheel(speed_from=700 * RPM, speed_to=1900 * RPM, span=0.7, mean=250.0)
    arrays = flywheel.equations()
    closed = np.zeros(arrays.connected.hinges.of.size, dtype=bool)
    for t, state in zip(np.linspace(0.0, 0.7, 40), states(40), strict=True):
        angle, rate = state[:NODES], state[NODES:]
        held, engaged = _held(arrays, angle, rate)
        found = (_driven(arrays, t) - held) / INERTIA
        expected = flywheel.right_hand_side(t, state)[NODES:]
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10 * (1 + np.abs(expected).max()))
        closed |= engaged
    assert closed.all()


def _held(arrays: Equations, angle: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Torques of the connections on the coordinates, and which hinges are closed."""
    on = arrays.connected
    w = _dense(on.rows)
    of_hinge, (gap, side, change, time) = on.hinges
    beyond = side * (w @ angle)[of_hinge] - side * gap + time * side * (w @ rate)[of_hinge]
    hinges = side * np.maximum(0.0, change * beyond)
    springs = on.constants[SPRING] * (w @ angle) + on.constants[DAMPER] * (w @ rate)
    torque = springs + np.bincount(of_hinge, hinges, len(w))
    return w.T @ torque, beyond > 0


def _driven(arrays: Equations, t: float) -> np.ndarray:
    driven, (low, high), end = arrays.driven, arrays.frame_value, arrays.frame_time[1]
    turned = driven.multiple[0] * (low * t + (high - low) * t * t / (2 * end)) + driven.phase[0]
    pieces = driven.profile_start[1]
    piece, share = divmod(turned / (2 * np.pi * driven.period[0]) % 1.0 * pieces, 1.0)
    torque = np.polynomial.polynomial.polyval(share, driven.profile[int(piece)])
    return np.array([torque, driven.level_value[0]]) @ _dense(driven.rows)


def _dense(rows: Rows) -> np.ndarray:
    table = np.zeros((rows.start.size - 1, NODES))
    table[np.repeat(np.arange(len(table)), np.diff(rows.start)), rows.column] = rows.weight
    return table
