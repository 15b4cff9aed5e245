"""Dual mass flywheel with any number of stages, lash and stop."""

from __future__ import annotations

from torsional.absorbers.base import Absorber
from torsional.arguments import checked
from torsional.components import Component, Coupling, Inertia
from torsional.laws import Law


@checked
def dual_mass_flywheel(primary_inertia: float, secondary_inertia: float, law: Law, damping: float = 0.0) -> Absorber:
    """Primary and secondary flywheel [kgm²] with a spring ``law`` and viscous ``damping`` [Nms/rad] between.

    The law acts on θ_primary − θ_secondary, positive while the engine drives.

    One linear stage k alone gives ω0² = k (1/J1 + 1/J2).  Stages, lash and stop: `Hinges.staged`.

    >>> from torsional.laws import Hinges
    >>> dual_mass_flywheel(1.2, 1.0, Hinges(13e3), damping=20).components["dmf"].law.stiffness
    13000.0
    """
    components: dict[str, Component] = {
        "primary": Inertia(primary_inertia),
        "dmf": Coupling("secondary", "primary", law, damping),
        "secondary": Inertia(secondary_inertia),
    }
    return Absorber("dual mass flywheel", components, "primary", "secondary", ("dmf",), ("primary", "secondary"))
