"""The centrifugal pendulum with all its geometry: Lagrange's equations of rotor, mass and rollers, integrated in time.

Nothing of the package's stamps takes part in them; at small swings both must agree.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import torsional as tv
from torsional.absorbers.pendulum import Path, squared_distance, tuning_order

Lump = tuple[float, float, float]


def swung(
    rotor: float, lumps: list[Lump], spins: list[tuple[float, float]], speed: float, order: float, damping: float
) -> tuple[complex, complex]:
    """Orders of the rotor's angle and of the swing φ under cos(order Ω t) on the rotor, with finite geometry.

    ``lumps`` (m, a, b): masses at a + b exp(iφ) on the rotor; ``spins`` (I, s): bodies that turn at θ̇ + s φ̇.
    Lagrange: d/dt (M q̇) − ½ q̇ᵀ (∂M/∂φ) q̇ = Q.
    """
    period = 2 * np.pi / (order * speed)

    def inertia(phi: float) -> tuple[np.ndarray, np.ndarray]:
        m, by_phi = np.array([[rotor, 0.0], [0.0, 0.0]]), np.zeros((2, 2))
        for mass, a, b in lumps:
            turn = np.exp(1j * phi)
            way = np.array([1j * (a + b * turn), 1j * b * turn])  # ∂z/∂θ and ∂z/∂φ of z = (a + b e^iφ) e^iθ
            bend = np.array([-b * turn, -b * turn])
            m += mass * (way[:, None] * way.conj()).real
            by_phi += mass * (bend[:, None] * way.conj() + way[:, None] * bend.conj()).real
        for body, share in spins:
            m += body * np.outer([1.0, share], [1.0, share])
        return m, by_phi

    def motion(t: float, x: np.ndarray) -> np.ndarray:
        rate = np.array([speed + x[2], x[3]])
        m, by_phi = inertia(x[1])
        moment = np.array([np.cos(order * speed * t), -damping * x[3]]) - by_phi @ rate * x[3]
        moment[1] += 0.5 * rate @ by_phi @ rate
        return np.r_[x[2:], np.linalg.solve(m, moment)]

    def after(x: np.ndarray, at: np.ndarray | None = None) -> np.ndarray:
        return solve_ivp(motion, (0, period), x, method="DOP853", rtol=1e-10, atol=1e-13, t_eval=at).y

    x = np.zeros(4)
    for _ in range(2):  # Newton's method on the state after one period; small amplitudes are all but linear
        moved = [(after(x + 1e-6 * e)[:, -1] - after(x - 1e-6 * e)[:, -1]) / 2e-6 - e for e in np.eye(4)[1:]]
        x[1:] -= np.linalg.lstsq(np.array(moved).T, after(x)[:, -1] - x, rcond=None)[0]
    theta, phi = after(x, np.arange(32) * period / 32)[:2]
    return complex(np.fft.rfft(theta)[1] / 16), complex(np.fft.rfft(phi)[1] / 16)


ROTOR, MASS, DISTANCE, ARM = 0.5, 1.0, 0.1 * 10 / 9, 0.1 / 9
ROLLERS = {"mass": 0.3, "inertia": 4e-4, "radius": 0.012, "distance": 0.105}


def pendulum_response(pendulum: tv.CentrifugalPendulum, speed: float, order: float) -> tuple[complex, complex]:
    """Angle of the rotor and relative angle of the pendulum under one newton metre."""
    system = tv.assemble(tv.Powertrain({"rotor": tv.Inertia(ROTOR), "pendulum": pendulum}))
    angle = tv.harmonic_response(system, tv.Excitation.unit("rotor", [order], [speed])).angle.isel(speed=0, order=0)
    return complex(angle.sel(node="rotor")), complex(angle.sel(node="pendulum") - angle.sel(node="rotor"))


@pytest.mark.parametrize("order", [1.5, 3.0, 3.5, 6.0])
@pytest.mark.parametrize("rollers", [False, True])
def test_pendulum_on_its_circle(order: float, rollers: bool) -> None:
    """A point mass on a circle, alone and parallel on rollers; at small swings equal to the stamps."""
    spec = tv.Rollers(**ROLLERS) if rollers else None
    pendulum = tv.CentrifugalPendulum("rotor", MASS, DISTANCE, 3.0, damping=0.3, rollers=spec)
    lumps, spins = [(MASS, DISTANCE - ARM, ARM)], []
    if rollers:  # a roller's centre turns on half the pendulum's circle; its spin is found below
        lumps.append((ROLLERS["mass"], ROLLERS["distance"] - ARM / 2, ARM / 2))
        spins.append((ROLLERS["inertia"], roller_spin()))
    theta, phi = swung(ROTOR, lumps, spins, 100.0, order, 0.3 * (ARM / DISTANCE) ** 2)
    rotor, relative = pendulum_response(pendulum, 100.0, order)
    assert abs(rotor / theta - 1) < 1e-5
    assert abs(relative / (phi * ARM / DISTANCE) - 1) < 1e-5


def roller_spin() -> float:
    """Turns of a roller on the rotor a turn of φ, from no slip on both tracks at any φ.

    The pendulum, which does not turn on the rotor, pulls outwards: it hangs on the roller's inner point, and the
    roller's outer point leans on the rotor's track.
    """
    radius = ROLLERS["radius"]
    found = []
    for phi in (0.0, 0.3, -0.8):
        outwards = np.exp(1j * phi)
        centre = 1j * ARM / 2 * outwards  # velocities for φ̇ = 1 on a rotor at rest
        spin = -(centre / (1j * radius * outwards)).real  # the outer point stands still
        inner = centre - 1j * spin * radius * outwards
        assert inner == pytest.approx(1j * ARM * outwards, abs=1e-15)  # and the inner one goes with the pendulum
        found.append(spin)
    assert np.ptp(found) < 1e-15
    return float(found[0])


@pytest.mark.parametrize("rollers", [False, True])
def test_pendulum_stops_its_carrier_at_the_tuned_order(rollers: bool) -> None:
    """The rotor all but stands still at that order, one per cent off it does not."""
    plain = tv.CentrifugalPendulum("rotor", MASS, DISTANCE, 3.0, rollers=tv.Rollers(**ROLLERS) if rollers else None)
    order = plain.tuned_order
    lumps, spins = [(MASS, DISTANCE - ARM, ARM)], []
    if rollers:
        lumps.append((ROLLERS["mass"], ROLLERS["distance"] - ARM / 2, ARM / 2))
        spins.append((ROLLERS["inertia"], roller_spin()))
    on, off = (abs(swung(ROTOR, lumps, spins, 100.0, order * detuned, 0.0)[0]) for detuned in (1.0, 1.01))
    assert on < 1e-3 * off


def test_pendulum_behind_a_gear() -> None:
    """A rotor that runs backwards at 1.6 times the engine's speed: the pendulum feels that speed."""
    pendulum = tv.CentrifugalPendulum("rotor", MASS, DISTANCE, 2.0, damping=0.3)
    engine, gear = tv.Inertia(0.7), tv.GearPair("engine", "rotor", -1 / 1.6)
    system = tv.assemble(
        tv.Powertrain({"engine": engine, "rotor": tv.Inertia(ROTOR), "gear": gear, "pendulum": pendulum})
    )
    angle = tv.harmonic_response(system, tv.Excitation.unit("engine", [3.0], [90.0])).angle.isel(speed=0, order=0)
    arm = DISTANCE / (1 + 2.0**2)
    # referred to the rotor: its order is 3/1.6, its torque that of the engine over −1.6
    theta, _ = swung(
        ROTOR + 0.7 / 1.6**2, [(MASS, DISTANCE - arm, arm)], [], 144.0, 3 / 1.6, 0.3 * (arm / DISTANCE) ** 2
    )
    assert abs(complex(angle.sel(node="rotor")) / (theta / -1.6) - 1) < 1e-5


@pytest.mark.parametrize(
    ("path", "bend", "arc"),
    [("circular", 0.0, 0.5), ("circular", 0.0, 2.1), ("cycloid", 1.0, 0.8), ("epicycloid", 0.9**0.5, 0.9)],
)
def test_order_of_large_swings(path: Path, bend: float, arc: float) -> None:
    """A mass that slides along the curve ρ² = ρ0² − λ² s² in the field Ω² R, until it turns round."""
    rho, distance, order = 0.01, 0.1, 3.0

    def slide(_: float, state: np.ndarray) -> list[float]:
        s, rate, direction, across, out = state
        tangent = np.cos(direction), -np.sin(direction)
        return [
            rate,
            across * tangent[0] + out * tangent[1],  # Ω = 1
            rate / np.sqrt(rho**2 - (bend * s) ** 2),
            rate * tangent[0],
            rate * tangent[1],
        ]

    def turned(_: float, state: np.ndarray) -> float:
        return float(state[1])

    turned.terminal = True  # type: ignore[attr-defined]
    start = np.sqrt(distance**2 - squared_distance(path, order, distance, arc * rho))
    found = solve_ivp(slide, (0, 20), [0, start, 0, 0, distance], rtol=1e-11, atol=1e-14, events=turned)
    assert found.y[0, -1] == pytest.approx(arc * rho, rel=1e-9)
    assert tuning_order(path, order, distance, arc * rho) == pytest.approx(np.pi / 2 / found.t[-1], rel=1e-9)
