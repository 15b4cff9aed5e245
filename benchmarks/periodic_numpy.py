"""Harmonic balance in NumPy, as one writes it for a paper: samples, FFT, Newton, arc length, signs of a determinant.

Two forms of the same equations.  `Coordinates` keeps the harmonics of all twelve angles, as the textbooks do;
`Receptances` those of the flywheel's relative angle alone.
"""

from __future__ import annotations

from itertools import pairwise

import dmf12
import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

SAMPLES = 512  # their error at the kinks is then far below that of nine harmonics
TOLERANCE = 1e-9


class _Springs:
    """Cosine and sine harmonics of the torque beyond the first stage, and its Jacobian, by samples."""

    def __init__(self) -> None:
        turn = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
        orders = np.arange(1, dmf12.HARMONICS + 1)
        cosines, sines = np.cos(np.outer(turn, orders)), np.sin(np.outer(turn, orders))
        self.to_time = np.hstack([np.ones((SAMPLES, 1)), cosines, sines])
        self.to_harmonics = self.to_time.T * 2 / SAMPLES
        self.to_harmonics[0] /= 2
        zero, rate = np.zeros((orders.size, 1)), np.diag(orders)
        self.derivative = np.block([[0.0, zero.T, zero.T], [zero, 0 * rate, rate], [zero, -rate, 0 * rate]])

    def torque(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        spectrum = np.zeros(SAMPLES // 2 + 1, dtype=complex)
        count = dmf12.HARMONICS + 1
        spectrum[1:count] = (x[1:count] - 1j * x[count:]) * SAMPLES / 2
        spectrum[0] = x[0] * SAMPLES
        torque, slope = dmf12.excess(np.fft.irfft(spectrum))
        found = np.fft.rfft(torque)[:count] * 2 / SAMPLES
        found[0] /= 2
        return np.concatenate([found.real, -found.imag[1:]]), (self.to_harmonics * slope) @ self.to_time


class Coordinates:
    """(K + ω∇⊗C + ω²∇²⊗M) q + Wᵀ F(W q) = u for the harmonics q of all angles."""

    def __init__(self) -> None:
        (M, C, K), self.springs = dmf12.matrices(), _Springs()
        D = self.springs.derivative
        self.K, self.C, self.M = np.kron(np.eye(len(D)), K), np.kron(D, C), np.kron(D @ D, M)
        loads = dmf12.load()
        self.load = np.concatenate([loads.ravel(), np.zeros(loads[1:].size)])
        self.nodes, self.weights = len(K), dmf12.weights()
        self.scale = dmf12.STIFFNESS[dmf12.PRIMARY] * dmf12.GAP

    def start(self, omega: float) -> np.ndarray:
        return np.linalg.solve(self.K + omega * self.C + omega**2 * self.M, self.load)

    def twist(self, q: np.ndarray) -> np.ndarray:
        return q.reshape(-1, self.nodes) @ self.weights

    def equations(self, q: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Residual, Jacobian and derivative by ω, in torques relative to that at the end of the first stage."""
        torque, slope = self.springs.torque(self.twist(q))
        jacobian = self.K + omega * self.C + omega**2 * self.M
        residual = jacobian @ q - self.load + np.outer(torque, self.weights).ravel()
        jacobian += np.kron(slope, np.outer(self.weights, self.weights))
        return residual / self.scale, jacobian / self.scale, (self.C @ q + 2 * omega * (self.M @ q)) / self.scale


class Receptances:
    """x + G F(x) = b for the harmonics x of the relative angle, G = Wᵀ Z⁻¹ W and b = Wᵀ Z⁻¹ u of every harmonic."""

    def __init__(self) -> None:
        (self.M, self.C, self.K), self.springs = dmf12.matrices(), _Springs()
        self.orders, self.weights = np.arange(dmf12.HARMONICS + 1), dmf12.weights()
        self.columns = np.stack([np.broadcast_to(self.weights, (len(self.orders), len(self.K))), dmf12.load()], axis=2)

    def start(self, omega: float) -> np.ndarray:
        return _split(self._linear(omega)[0][:, 1])

    def twist(self, x: np.ndarray) -> np.ndarray:
        return x

    def _linear(self, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """G and b (harmonic, two), and their derivatives by ω."""
        h = self.orders[:, None, None]
        y = np.linalg.solve(self.K + 1j * h * omega * self.C - (h * omega) ** 2 * self.M, self.columns)
        change = (1j * h * self.C - 2 * h**2 * omega * self.M) @ y
        return self.weights @ y, -(np.swapaxes(y[:, :, :1], 1, 2) @ change)[:, 0]

    def equations(self, x: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        torque, slope = self.springs.torque(x)
        (G, b), (dG, db) = (part.T for part in self._linear(omega))
        G, dG = _real(G), _real(dG)
        return x + G @ torque - _split(b), np.eye(x.size) + G @ slope, dG @ torque - _split(db)


def _split(spectrum: np.ndarray) -> np.ndarray:
    """Cosine and sine parts of Re Σ c exp(iht)."""
    return np.concatenate([spectrum.real, -spectrum.imag[1:]])


def _real(factors: np.ndarray) -> np.ndarray:
    """The matrix that multiplies every harmonic by its complex factor."""
    count = factors.size
    matrix = np.diag(_split(factors) * np.r_[np.ones(count), np.zeros(count - 1)])
    i = np.arange(1, count)
    matrix[i + count - 1, i + count - 1] = factors.real[1:]
    matrix[i, i + count - 1], matrix[i + count - 1, i] = factors.imag[1:], -factors.imag[1:]
    return matrix


def branch(form: Coordinates | Receptances) -> dict[str, np.ndarray]:
    """Speeds [rpm], harmonics of the relative angle, and the period doublings [rpm], located to a thousandth."""
    unit = dmf12.RPM * dmf12.BASE  # ω of one rpm
    omega = dmf12.SLOWEST * unit
    q = _newton(form, form.start(omega), omega)
    step, points, doublings = 0.5 * dmf12.STEP * unit, [(dmf12.SLOWEST, form.twist(q))], []
    sign = tangent = None
    while points[-1][0] < dmf12.FASTEST:
        _, jacobian, by_omega = form.equations(q, omega)
        now = np.linalg.slogdet(jacobian)[0]
        if sign is not None and now != sign:
            doublings.append(_located(form, q, points[-2][0] * unit, omega) / unit)
        sign = now
        ahead = -np.linalg.solve(jacobian, by_omega)
        ahead = np.append(ahead, 1.0) / np.sqrt(1 + ahead @ ahead)
        tangent = ahead if tangent is None or ahead @ tangent > 0 else -ahead
        q, omega, step = _stepped(form, q, omega, tangent, step, dmf12.STEP * unit)
        points.append((omega / unit, form.twist(q)))
    speeds, twists = zip(*points, strict=True)
    return {"speed": np.array(speeds), "twist": np.array(twists), "doublings": np.array(doublings)}


def _stepped(form, q, omega, tangent, step, longest):
    """The next point on the plane ahead; half the step where Newton's method does not get there."""
    while True:
        y = np.append(q, omega) + step * tangent
        for iteration in range(8):
            residual, jacobian, by_omega = form.equations(y[:-1], y[-1])
            gap = np.append(residual, (y - np.append(q, omega)) @ tangent - step)
            correction = np.linalg.solve(np.block([[jacobian, by_omega[:, None]], [tangent]]), gap)
            y -= correction
            if np.abs(correction[:-1]).max() < TOLERANCE:
                return y[:-1], y[-1], min(step * (1.3 if iteration < 3 else 1.0), longest)
        step /= 2


def _newton(form, q, omega):
    for _ in range(30):
        residual, jacobian, _ = form.equations(q, omega)
        correction = np.linalg.solve(jacobian, residual)
        q = q - correction
        if np.abs(correction).max() < TOLERANCE:
            return q
    raise RuntimeError("Newton's method does not converge")


def _located(form, q, low, high):
    """Where the determinant passes zero, the motion solved for anew at each try."""

    def determinant(omega: float) -> float:
        sign, size = np.linalg.slogdet(form.equations(_newton(form, q, omega), omega)[1])
        return sign * np.exp(size - reference)

    reference = np.linalg.slogdet(form.equations(q, high)[1])[1]
    return brentq(determinant, low, high, xtol=1e-3 * dmf12.RPM * dmf12.BASE)


# --- Floquet multipliers ---


def multipliers(twist: np.ndarray, rpm: np.ndarray) -> np.ndarray:
    """Floquet multipliers (point, 24) of a branch: matrix exponentials from one end of a stage to the next."""
    M, C, K = dmf12.matrices()
    inverse, n = np.linalg.inv(M), len(M)
    weights = dmf12.weights()
    second = (dmf12.SECOND_STAGE - dmf12.STIFFNESS[dmf12.PRIMARY]) * np.outer(weights, weights)
    stages = [
        np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ C]]) for stiffness in (K, K + second)
    ]
    found = []
    for x, omega in zip(twist, rpm * dmf12.RPM * dmf12.BASE, strict=True):
        monodromy = np.eye(2 * n)
        # order 3 is harmonic 2 here: the motion of the main branch closes after half a turn of the base
        for duration, stage in _durations(x):
            monodromy = expm(stages[stage] * (duration / omega)) @ monodromy
        found.append(np.linalg.eigvals(monodromy))
    return np.array(found)


def _durations(x: np.ndarray) -> list[tuple[float, int]]:
    """Angles of the base order from crossing to crossing, and which stage holds between them, the first being 0."""
    orders = np.arange(1, dmf12.HARMONICS + 1)

    def depth(turn: float) -> float:
        wave = np.cos(orders * turn) @ x[1 : orders.size + 1] + np.sin(orders * turn) @ x[orders.size + 1 :]
        return abs(x[0] + wave) - dmf12.GAP

    grid = np.linspace(0.0, np.pi, 257)
    depths = np.array([depth(turn) for turn in grid])
    ends = [brentq(depth, grid[i], grid[i + 1], xtol=1e-13) for i in np.flatnonzero(depths[1:] * depths[:-1] < 0)]
    edges = np.array([0.0, *ends, np.pi])
    return [(high - low, int(depth(0.5 * (low + high)) > 0)) for low, high in pairwise(edges)]
