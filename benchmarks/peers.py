"""The peers at the linear work, each used as its authors mean it to be used for speed."""

from __future__ import annotations

import chain15
import numpy as np
import scipy.linalg


def assembly(inertia=chain15.INERTIA, stiffness=chain15.STIFFNESS):
    """The chain as openTorsion's ``Assembly``."""
    import opentorsion

    shafts = [
        opentorsion.Shaft(i, i + 1, k=k, c=c) for i, (k, c) in enumerate(zip(stiffness, chain15.DAMPING, strict=True))
    ]
    discs = [opentorsion.Disk(i, J, c=c) for i, (J, c) in enumerate(zip(inertia, chain15.GROUND_DAMPING, strict=True))]
    return opentorsion.Assembly(shafts, disk_elements=discs)


def opentorsion_response(chain):
    """Angles and shaft torques by ``Assembly.ss_response``, all speeds and orders handed over in one call.

    ``vibratory_torque`` leaves the damper's share of a shaft's torque out, so S and D are applied here.
    """
    omega = chain15.frequencies().ravel()
    loads = np.tile(chain15.torque(), chain15.RPM.size)
    angle, rate = chain.ss_response(loads, omega)
    torque = chain.S @ angle + chain.D @ rate
    shape = (chain15.RPM.size, chain15.ORDERS.size, -1)
    return angle.T.reshape(shape), -torque.T.reshape(shape)


def opentorsion_by_speed(chain):
    """The same as openTorsion's own examples do it: an excitation object for each speed."""
    import opentorsion

    loads, angles, torques = chain15.torque(), [], []
    for omega in chain15.frequencies():
        excitation = opentorsion.PeriodicExcitation(chain.dofs, omega)
        for throw in chain15.THROWS:
            excitation.add_sines(throw, omega, np.abs(loads[throw]), np.angle(loads[throw]))
        angle, rate = chain.ss_response(excitation.U, omega)
        angles.append(angle.T)
        torques.append(-(chain.S @ angle + chain.D @ rate).T)
    return np.array(angles), np.array(torques)


def stiffness_matrices(stiffness: np.ndarray) -> np.ndarray:
    """Stiffness matrices (design, node, node) of many chains."""
    difference = chain15.matrices().difference
    return np.einsum("si,ds,sj->dij", difference, stiffness, difference)


def scipy_modes(inertia: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues and vectors of each design by ``scipy.linalg.eigh``."""
    solved = [scipy.linalg.eigh(k, np.diag(J), check_finite=False) for k, J in zip(K, inertia, strict=True)]
    return np.array([values for values, _ in solved]), np.array([vectors for _, vectors in solved])


def numpy_modes(inertia: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same by NumPy's batched symmetric solver on J^-1/2 K J^-1/2."""
    scale = 1.0 / np.sqrt(inertia)
    values, vectors = np.linalg.eigh(scale[:, :, None] * K * scale[:, None, :])
    return values, scale[:, :, None] * vectors


def opentorsion_modes(chains) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues and vectors by ``Assembly.undamped_modal_analysis``, in the order it finds them."""
    solved = [chain.undamped_modal_analysis() for chain in chains]
    return np.array([values for values, _ in solved]), np.array([vectors for _, vectors in solved])
