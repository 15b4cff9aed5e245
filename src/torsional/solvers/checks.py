"""What linear analyses ask of a system."""

from __future__ import annotations

from torsional.errors import ModelError
from torsional.system import System


def linear(system: System) -> None:
    """Refuse a system that still has laws in it."""
    names = [name for name, _, _ in system.elements]
    if names:
        raise ModelError(
            "the system is nonlinear",
            where=names[0],
            remedy="linearize(system, equilibrium(...)) gives the linear system about an operating point",
        )
