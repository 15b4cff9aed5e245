"""This project at the same work."""

from __future__ import annotations

import chain15
import numpy as np


def powertrain():
    """Chain15 as a user writes it."""
    from torsional import Damper, Inertia, Powertrain, Shaft

    parts = {name: Inertia(float(J)) for name, J in zip(chain15.NODES, chain15.INERTIA, strict=True)}
    for i, (a, b) in enumerate(zip(chain15.NODES, chain15.NODES[1:], strict=False)):
        parts[f"{a}-{b}"] = Shaft(a, b, float(chain15.STIFFNESS[i]), float(chain15.DAMPING[i]))
    for node, damping in zip(chain15.NODES, chain15.GROUND_DAMPING, strict=True):
        if damping:
            parts[f"{node}-bearing"] = Damper(node, damping=float(damping))
    return Powertrain(parts)


def modes(inertia: np.ndarray, stiffness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues and vectors of many designs by one call of the kernel."""
    from torsional.numerics.modal_kernel import modes

    difference = chain15.matrices().difference
    omega, shapes = modes(difference, stiffness, np.eye(inertia.shape[1]), inertia)
    return omega**2, shapes
