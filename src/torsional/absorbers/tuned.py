"""Dual mass flywheel with a tuned vibration absorber (TVA) on its flange or on its secondary flywheel."""

from __future__ import annotations

from torsional.absorbers.base import Absorber
from torsional.absorbers.dual_mass import dual_mass_flywheel
from torsional.arguments import checked
from torsional.components import Component, Coupling, Inertia, Shaft
from torsional.laws import Law


def tuned_stiffness(inertia: float, frequency: float) -> float:
    """Stiffness [Nm/rad] that tunes an absorber ``inertia`` [kgm²] to an angular ``frequency`` [rad/s]: k = J ω².

    >>> round(tuned_stiffness(0.15, 100000.0**0.5), 6)
    15000.0
    """
    return inertia * frequency**2


def _absorber(carrier: str, inertia: float, stiffness: float, damping: float) -> dict[str, Component]:
    """The ring and its spring; an inertia of zero is no absorber at all."""
    if inertia == 0:
        return {}
    return {"tva": Inertia(inertia), "tva_spring": Shaft(carrier, "tva", stiffness, damping)}


@checked
def tuned_flange_flywheel(
    primary_inertia: float,
    flange_inertia: float,
    secondary_inertia: float,
    primary_law: Law,
    secondary_law: Law,
    *,
    tva_inertia: float,
    tva_stiffness: float,
    damping: float = 0.0,
    tva_damping: float = 0.0,
) -> Absorber:
    """J1 –k1– Jm –k2– J2 with the absorber Ja on the intermediate flange m by ka [Nm/rad].

    Inertias [kgm²]; ``damping`` [Nms/rad] beside both springs, ``tva_damping`` [Nms/rad] beside the absorber's.

    Notch at ω_t² = ka/Ja; with heavy flywheels and a light flange the added resonance lies below it, at about
    ω_t sqrt((k1 + k2)/(k1 + k2 + ka)) (Wramner, Chalmers, 2020, Paper D).

    >>> from torsional.laws import Hinges
    >>> a = tuned_flange_flywheel(1.8, 0.05, 1.2, Hinges(30e3), Hinges(30e3), tva_inertia=0.15, tva_stiffness=15e3)
    >>> a.springs
    ('primary_springs', 'secondary_springs')
    """
    components: dict[str, Component] = {
        "primary": Inertia(primary_inertia),
        "primary_springs": Coupling("flange", "primary", primary_law, damping),
        "flange": Inertia(flange_inertia),
        "secondary_springs": Coupling("secondary", "flange", secondary_law, damping),
        "secondary": Inertia(secondary_inertia),
        **_absorber("flange", tva_inertia, tva_stiffness, tva_damping),
    }
    springs, nodes = ("primary_springs", "secondary_springs"), ("primary", "flange", "secondary")
    return Absorber("dual mass flywheel with flange absorber", components, "primary", "secondary", springs, nodes)


@checked
def tuned_secondary_flywheel(
    primary_inertia: float,
    secondary_inertia: float,
    law: Law,
    *,
    tva_inertia: float,
    tva_stiffness: float,
    damping: float = 0.0,
    tva_damping: float = 0.0,
) -> Absorber:
    """The absorber on the secondary flywheel instead: its added resonance lies above, near ω_t sqrt(1 + Ja/J2).

    Inertias [kgm²], ``tva_stiffness`` [Nm/rad], dampings [Nms/rad] (Wramner, Chalmers, 2020, Paper D).

    >>> from torsional.laws import Hinges
    >>> a = tuned_secondary_flywheel(1.2, 1.0, Hinges(13e3), tva_inertia=0.2, tva_stiffness=8e3)
    >>> sorted(a.components)
    ['dmf', 'primary', 'secondary', 'tva', 'tva_spring']
    """
    plain = dual_mass_flywheel(primary_inertia, secondary_inertia, law, damping)
    ring = _absorber("secondary", tva_inertia, tva_stiffness, tva_damping)
    return plain.joined(ring, kind="dual mass flywheel with secondary absorber")
