"""Chain15: a truck's crankshaft, dual mass flywheel and driveline as fifteen discs in a row, gear ratios folded in.

The data of the linear benchmarks, written once, with what a dense solver makes of it as the reference.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

NODES = (
    "damper_ring",
    *(f"throw_{cylinder}" for cylinder in range(1, 7)),
    "flywheel_primary",
    "flywheel_secondary",
    "clutch_disc",
    "gearbox_input",
    "gearbox_output",
    "axle",
    "wheels",
    "vehicle",
)
INERTIA = np.array([0.20, 0.16, 0.14, 0.14, 0.14, 0.14, 0.16, 1.40, 0.90, 0.05, 0.12, 0.08, 0.06, 0.35, 12.0])
STIFFNESS = np.array([1.5e5, 2.4e6, 2.4e6, 2.4e6, 2.4e6, 2.4e6, 3.2e6, 1.2e4, 1.0e6, 6.0e4, 5.0e5, 6.0e4, 8.0e3, 2.0e3])
DAMPING = np.array([60.0, 5, 5, 5, 5, 5, 5, 30, 5, 5, 5, 5, 5, 20])
GROUND_DAMPING = np.array([0.0] + [2.0] * 6 + [0.0] * 7 + [1.0])
THROWS = np.arange(1, 7)
FIRING_ANGLE = np.radians([0.0, 480, 240, 600, 120, 360])
DUAL_MASS = 7  # the shaft from the flywheel's primary to its secondary side

ORDERS = 0.5 * np.arange(1, 25)
RPM = np.linspace(500.0, 2000.0, 500)
NATURAL_FREQUENCIES = np.array([3.5364, 17.7305, 28.4188, 86.4900, 123.9057])  # Hz, the first elastic five


@dataclass(frozen=True)
class Matrices:
    """M, C, K of the chain and ``difference``, which takes node angles to the shafts' angles b − a."""

    M: np.ndarray
    C: np.ndarray
    K: np.ndarray
    difference: np.ndarray


def matrices() -> Matrices:
    """The matrices [kgm², Nms/rad, Nm/rad] of the chain."""
    difference = np.diff(np.eye(INERTIA.size), axis=0)
    C = difference.T @ np.diag(DAMPING) @ difference + np.diag(GROUND_DAMPING)
    return Matrices(np.diag(INERTIA), C, difference.T @ np.diag(STIFFNESS) @ difference, difference)


def torque() -> np.ndarray:
    """Complex torque [Nm, 0-peak] on each node (rows) in each order (columns)."""
    amplitude = 1800.0 / (1.0 + 0.35 * ORDERS**1.5)
    loads = np.zeros((INERTIA.size, ORDERS.size), dtype=complex)
    loads[THROWS] = amplitude * np.exp(-1j * ORDERS * (0.35 + FIRING_ANGLE[:, None]))
    return loads


def frequencies(rpm: np.ndarray = RPM) -> np.ndarray:
    """Angular frequencies [rad/s], shape (speed, order)."""
    return np.multiply.outer(rpm * np.pi / 30.0, ORDERS)


def dense(rpm: np.ndarray = RPM) -> tuple[np.ndarray, np.ndarray]:
    """Angles (speed, order, node) [rad] and shaft torques (speed, order, shaft) [Nm] by NumPy's batched solver."""
    chain, omega = matrices(), frequencies(rpm)[..., None, None]
    dynamic = chain.K + 1j * omega * chain.C - omega**2 * chain.M
    loads = np.broadcast_to(torque().T[..., None], (*dynamic.shape[:-1], 1))
    angle = np.linalg.solve(dynamic, loads)[..., 0]
    return angle, (STIFFNESS + 1j * omega[..., 0] * DAMPING) * (angle @ chain.difference.T)


def designs(count: int, seed: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Inertias (count, 15) and stiffnesses (count, 14) of random variants, each value within ±30 % of the chain's."""
    random = np.random.default_rng(seed)
    inertia = INERTIA * random.uniform(0.7, 1.3, (count, INERTIA.size))
    return inertia, STIFFNESS * random.uniform(0.7, 1.3, (count, STIFFNESS.size))
