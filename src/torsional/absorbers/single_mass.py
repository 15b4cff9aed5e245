"""Single-mass flywheel."""

from __future__ import annotations

from torsional.absorbers.base import Absorber
from torsional.arguments import checked
from torsional.components import Inertia


@checked
def single_mass_flywheel(inertia: float) -> Absorber:
    """A rigid flywheel of ``inertia`` [kgm²], clutch cover included.

    >>> single_mass_flywheel(1.9).components["flywheel"].inertia
    1.9
    """
    return Absorber("single mass flywheel", {"flywheel": Inertia(inertia)}, "flywheel", "flywheel", (), ("flywheel",))
