"""DMF12: a truck's crankshaft and driveline of twelve discs with a two-stage dual mass flywheel, excited in order 3.

The data of the periodic benchmarks, written once, NumPy alone; harmonics are multiples of order 1.5.
"""

from __future__ import annotations

import numpy as np

RPM = np.pi / 30.0
INERTIA = np.array([0.05, *[0.1] * 6, 1.5, 0.8, 0.3, 0.5, 400.0])
STIFFNESS = np.array([*[2e6] * 7, 10e3, 8e4, 3e4, 6e3])  # of the flywheel's springs, the first stage
DAMPING = np.array([*[5.0] * 7, 15.0, 10.0, 5.0, 10.0])
GROUND_STIFFNESS = 1000.0  # at the vehicle
PRIMARY, SECONDARY = 7, 8
GAP, SECOND_STAGE = 0.08, 25e3
THROWS = range(1, 7)
MEAN, THIRD = 1000.0, 2500.0  # Nm, over all throws

BASE, HARMONICS = 1.5, 9
SLOWEST, FASTEST = 600.0, 1200.0
STEP = 17.0  # rpm, at most from one point of a peer's branch to the next: about as many points as this project takes

# what five harmonic balances agree on: 0-peak order 3 at 600 rpm, and the period doublings [rpm]
AMPLITUDE = 0.0580488697
DOUBLINGS = (911.66612, 985.27543)


def matrices() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M, C, K [kgm², Nms/rad, Nm/rad], the flywheel's first stage in K."""
    difference = np.diff(np.eye(INERTIA.size), axis=0)
    K = difference.T @ np.diag(STIFFNESS) @ difference
    K[-1, -1] += GROUND_STIFFNESS
    return np.diag(INERTIA), difference.T @ np.diag(DAMPING) @ difference, K


def weights() -> np.ndarray:
    """Takes node angles to the flywheel's relative angle."""
    row = np.zeros(INERTIA.size)
    row[[PRIMARY, SECONDARY]] = 1.0, -1.0
    return row


def load() -> np.ndarray:
    """Complex torques [Nm] (harmonic, node): the mean and harmonic 2, which is order 3."""
    loads = np.zeros((HARMONICS + 1, INERTIA.size))
    loads[0, THROWS], loads[2, THROWS] = MEAN / len(THROWS), THIRD / len(THROWS)
    return loads


def excess(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Torque [Nm] and slope [Nm/rad] of the springs beyond their first stage."""
    change = SECOND_STAGE - STIFFNESS[PRIMARY]
    beyond = np.abs(angle) > GAP
    return change * np.where(beyond, angle - np.sign(angle) * GAP, 0.0), change * beyond
