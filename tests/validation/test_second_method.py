"""Analyses a second way: Newton's equations of the bodies integrated in time, quadrature, finite differences.

The right-hand sides are written body by body; no matrix, stamp or harmonic of the package takes part in them.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import CubicSpline

import torsional as tv

Acceleration = Callable[[float, np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def settled_rates(acceleration: Acceleration, bodies: int, period: float, samples: int) -> np.ndarray:
    """Rates over one period of the steady state, found by shooting: no transient has to die away.

    ``acceleration(t, angles, rates, forced)`` of several motions side by side, only those with ``forced`` 1 excited.
    """
    forced = np.r_[1.0, np.zeros(2 * bodies)]

    def motion(t: float, state: np.ndarray) -> np.ndarray:
        z = state.reshape(2 * bodies, -1)
        return np.vstack([z[bodies:], acceleration(t, z[:bodies], z[bodies:], forced[: z.shape[1]])]).ravel()

    tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    start = np.hstack([np.zeros((2 * bodies, 1)), np.eye(2 * bodies)])
    end = solve_ivp(motion, (0, period), start.ravel(), **tight).y[:, -1].reshape(2 * bodies, -1)
    # the whole line may stand anywhere: that direction is left out
    first = np.linalg.lstsq(np.eye(2 * bodies) - end[:, 1:], end[:, 0], rcond=1e-7)[0]
    return solve_ivp(motion, (0, period), first, t_eval=np.arange(samples) * period / samples, **tight).y[bodies:]


def half_orders(signal: np.ndarray, count: int) -> np.ndarray:
    """Complex 0-peak orders 0.5, 1, 1.5 … of samples over one cycle, on the last axis."""
    return np.fft.rfft(signal, axis=-1)[..., 1 : count + 1] * 2 / signal.shape[-1]


# --- a line with gears and bearings ---


def test_two_throws_before_a_reversing_gear() -> None:
    """Two throws with orders of any phase; a gear of ratio −2.7; dampers on the ground: amplitudes and phases."""
    inertia = {"throw1": 0.4, "throw2": 0.9, "pinion": 0.15, "wheel": 2.5, "car": 30.0}
    k, c, ratio, bearing, drag, speed = (2e5, 1.1e4, 4e4), (15.0, 25.0, 60.0), -2.7, 1.3, 5.0, 95.0
    rng = np.random.default_rng(3)
    orders = np.array([0.5, 1.5, 3.0])
    torque = 100 * (rng.normal(size=(2, 3)) + 1j * rng.normal(size=(2, 3)))

    def acceleration(t: float, angle: np.ndarray, rate: np.ndarray, forced: np.ndarray) -> np.ndarray:
        throw1, throw2, pinion, car = angle
        rate1, rate2, rate_pinion, rate_car = rate
        push = (torque * np.exp(1j * orders * speed * t)).real.sum(axis=1)[:, None] * forced
        first = k[0] * (throw2 - throw1) + c[0] * (rate2 - rate1)
        second = k[1] * (pinion - throw2) + c[1] * (rate_pinion - rate2)
        third = k[2] * (car - pinion / ratio) + c[2] * (rate_car - rate_pinion / ratio)
        # the tooth force X: J_p α = −second − X,  J_w α/i = third + i X
        geared = (third / ratio - second) / (inertia["pinion"] + inertia["wheel"] / ratio**2)
        throws = (push[0] + first) / inertia["throw1"], (push[1] - first + second - bearing * rate2) / inertia["throw2"]
        return np.array([*throws, geared, (-third - drag * rate_car) / inertia["car"]])

    rates = half_orders(settled_rates(acceleration, 4, 4 * np.pi / speed, 64), 6)[:, [0, 2, 5]]
    parts: dict[str, object] = {name: tv.Inertia(value) for name, value in inertia.items()}
    parts |= {"one": tv.Shaft("throw1", "throw2", k[0], c[0]), "two": tv.Shaft("throw2", "pinion", k[1], c[1])}
    parts |= {"gear": tv.GearPair("pinion", "wheel", ratio), "three": tv.Shaft("wheel", "car", k[2], c[2])}
    parts |= {"bearing": tv.Damper("throw2", damping=bearing), "drag": tv.Damper("car", damping=drag)}
    load = tv.Excitation(("throw1", "throw2"), orders, np.array([speed]), torque[None])
    found = tv.harmonic_response(tv.assemble(tv.Powertrain(parts)), load).angle.isel(speed=0)
    wanted = rates / (1j * orders * speed)
    assert np.abs(found.sel(node=["throw1", "throw2", "pinion", "car"]).values.T / wanted - 1).max() < 1e-9
    assert np.abs(found.sel(node="wheel").values / (wanted[2] / ratio) - 1).max() < 1e-9


# --- engine torque ---


def uneven_engine() -> tv.Engine:
    """A four-cylinder vee with offset pins, unequal cylinders and uneven firing."""
    firing = np.radians([90.0, 270.0, 90.0, 270.0])
    layout = tv.CrankLayout.vee((1, 3, 2, 4), np.radians(90.0), tuple(firing), throws=(1, 2, 1, 2))
    return tv.Engine(
        bore=0.131,
        stroke=0.158,
        rod_length=0.2675,
        reciprocating_mass=4.2,
        compression_ratio=18.1,
        pin_offset=0.004,
        layout=layout,
        heat_spread=(1.0, 0.8, 1.1, 1.05),
    )


def test_torque_of_each_throw_by_virtual_work() -> None:
    """(p − p_crankcase) dV/dα and −d(½ m v²)/dα of every cylinder from the piston's place, drawn by circles."""
    engine, speed, mean, step = uneven_engine(), 110.0, 900.0, 1e-5
    alpha = np.linspace(0, 4 * np.pi, 500, endpoint=False)
    firing = np.radians([0.0, 360.0, 90.0, 450.0])  # of cylinders 1 to 4
    radius, rod, offset = 0.079, 0.2675, 0.004

    def height(angle: np.ndarray) -> np.ndarray:
        pin = radius * np.exp(1j * (angle + np.arcsin(offset / (radius + rod))))
        return pin.real + np.sqrt(rod**2 - (pin.imag - offset) ** 2)

    pressure = engine.pressure(speed, mean, alpha)
    torque = np.zeros((2, alpha.size))
    for cylinder, (throw, at) in enumerate(zip((0, 1, 0, 1), firing, strict=True)):
        low, here, high = (height(alpha - at + turn) for turn in (-step, 0.0, step))
        fall, bend = (low - high) / (2 * step), (2 * here - low - high) / step**2
        torque[throw] += (pressure[cylinder] - 1e5) * np.pi / 4 * 0.131**2 * fall - 4.2 * fall * bend * speed**2
        peak = np.degrees(alpha[pressure[cylinder].argmax()] - at) % 720
        assert peak < 30  # each burns at its own firing
    found = engine.torque(speed, mean, alpha)
    lost = torque - found  # friction alone, the same at every angle
    assert np.ptp(lost, axis=1).max() < 1e-4 * np.ptp(found)
    assert (lost.mean(axis=1) > 5).all()
    assert found.mean(axis=1).sum() == pytest.approx(mean, rel=1e-4)


def test_engine_torque_in_time_and_by_orders() -> None:
    """The torque over crank angle drives a line in time; its harmonics drive the same line by orders."""
    engine, speed, mean = uneven_engine(), 110.0, 900.0
    inertia, drag = np.array([0.21, 0.23, 2.2, 9.0]), np.array([1.8, 1.8, 0.0, 6.0])
    k, c = np.array([3e5, 3.5e5, 4e4]), np.array([40.0, 40.0, 160.0])
    alpha = np.arange(5760) * np.pi / 1440
    wave = engine.torque(speed, mean, alpha)
    wave -= wave.mean(axis=1, keepdims=True)
    closed = np.column_stack([wave, wave[:, 0]])
    push = CubicSpline(np.append(alpha, 4 * np.pi) / speed, closed, axis=1, bc_type="periodic")

    def acceleration(t: float, angle: np.ndarray, rate: np.ndarray, forced: np.ndarray) -> np.ndarray:
        twist = k[:, None] * np.diff(angle, axis=0) + c[:, None] * np.diff(rate, axis=0)
        torque = -drag[:, None] * rate
        torque[:-1] += twist
        torque[1:] -= twist
        torque[:2] += np.outer(push(t), forced)
        return torque / inertia[:, None]

    wanted = half_orders(settled_rates(acceleration, 4, 4 * np.pi / speed, 1024), 16)
    names = ("throw1", "throw2", "flywheel", "car")
    parts: dict[str, object] = {name: tv.Inertia(j) for name, j in zip(names, inertia, strict=True)}
    parts |= {f"s{i}": tv.Shaft(names[i], names[i + 1], k[i], c[i]) for i in range(3)}
    parts |= {f"d{i}": tv.Damper(names[i], damping=drag[i]) for i in (0, 1, 3)}
    orders = np.arange(0.5, 8.5, 0.5)
    load = engine.excitation(names[:2], [speed], mean, orders)
    angle = tv.harmonic_response(tv.assemble(tv.Powertrain(parts)), load).angle.isel(speed=0).sel(node=list(names))
    found = angle.values.T * 1j * orders * speed
    assert np.abs(found - wanted).max() < 1e-6 * np.abs(wanted).max()
    assert (np.abs(found - wanted).max(axis=0) < 1e-5 * np.abs(wanted).max(axis=0)).all()


# --- laws ---

STAGES = tv.Hinges.staged(
    [(400.0, 3e3), (1500.0, 9e3)], coast=[(300.0, 2e3), (900.0, 7e3)], lash=0.05, stop_stiffness=2e5
)


def test_tangent_and_inverse_of_a_staged_law() -> None:
    """The slope by differences of the torque; the angle of a torque gives it back; no torque lies amid the lash."""
    angle = np.linspace(-0.6, 0.6, 241) + 1.3e-4
    slope = (STAGES.torque(angle + 1e-7) - STAGES.torque(angle - 1e-7)) / 2e-7
    assert STAGES.tangent(angle) == pytest.approx(slope, rel=1e-6, abs=1e-3)
    torque = np.linspace(-2000, 2500, 91)
    assert STAGES.torque(STAGES.angle(torque)) == pytest.approx(torque, abs=1e-9)
    assert float(STAGES.angle(0.0)) == 0.0


@pytest.mark.parametrize(("centre", "size"), [(0.1, 0.05), (0.0, 0.02), (0.02, 0.4), (-0.3, 0.2), (0.2, 0.25)])
def test_describing_function_by_quadrature(centre: float, size: float) -> None:
    """Mean and first harmonic of the torque under φ = centre + size cos ψ, from corner to corner."""
    corners = np.arccos(np.clip((np.array(STAGES.gaps) - centre) / size, -1, 1))
    edges = np.unique([0.0, *corners, np.pi])

    def torque(psi: float, weight: float) -> float:
        return float(STAGES.torque(centre + size * np.cos(psi))) * np.cos(psi) ** weight

    mean, first = (
        sum(quad(torque, a, b, args=(weight,), epsabs=1e-11)[0] for a, b in pairwise(edges)) / np.pi
        for weight in (0, 1)
    )
    found = STAGES.describing_function(centre, size)
    assert [float(v) for v in found] == pytest.approx([mean, 2 * first / size], rel=1e-10, abs=1e-8)


# --- what an engineer reads ---


def test_quantities_of_a_motion_drawn_in_time() -> None:
    """Acceleration, swing, irregularity, share and bound from the motion itself, finely sampled and differenced."""
    rng = np.random.default_rng(5)
    orders, speed = np.array([0.5, 1.5, 3.0, 6.0]), 90.0
    theta = 1e-3 * (rng.normal(size=4) + 1j * rng.normal(size=4)) / orders
    step = 1e-5
    t = np.arange(0, 4 * np.pi / speed, step)
    motion = sum((x * np.exp(1j * n * speed * t)).real for x, n in zip(theta, orders, strict=True))
    rate = np.gradient(motion, step)[1:-1]
    bend = np.diff(motion, 2) / step**2
    angle = xr.DataArray(theta[None], coords={"speed": [speed], "order": orders}, dims=("speed", "order"))
    assert float(tv.swing(angle)[0]) == pytest.approx(np.ptp(motion) / 2, rel=1e-3)
    assert float(tv.irregularity(angle)[0]) == pytest.approx(np.ptp(rate) / speed, rel=2e-3)
    assert float(tv.swing(tv.acceleration(angle))[0]) == pytest.approx(np.ptp(bend) / 2, rel=3e-3)
    assert float(tv.order_sum(angle)[0]) >= np.ptp(motion) / 2
    alone = (theta[2] * np.exp(3j * speed * t)).real
    assert float(tv.order_share(angle, 3.0)[0]) == pytest.approx(np.mean(alone**2) / np.mean(motion**2), rel=1e-3)


def test_modes_are_named_by_where_the_energy_is() -> None:
    """Springs in two rows count together; the largest single share decides against smaller groups."""
    share = [[0.0, 0.0, 0.0, 0.0], [0.3, 0.25, 0.4, 0.05], [0.2, 0.1, 0.6, 0.1], [0.05, 0.05, 0.1, 0.8]]
    names = ["row1", "row2", "clutch", "shaft"]
    coords = {"mode": range(4), "element": names}
    modes = xr.Dataset({"elastic_share": (("mode", "element"), share), "frequency": ("mode", [0.0, 5, 9, 20])}, coords)
    groups = {"flywheel mode": ("row1", "row2"), "clutch mode": ("clutch",)}
    assert tv.named_modes(modes, groups) == ["rigid rotation", "flywheel mode", "clutch mode", "shaft mode"]
