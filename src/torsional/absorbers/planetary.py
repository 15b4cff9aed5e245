"""Planetary dual mass flywheel: a dual mass flywheel whose planets spin with the travel."""

from __future__ import annotations

from torsional.absorbers.base import Absorber
from torsional.absorbers.dual_mass import dual_mass_flywheel
from torsional.arguments import checked
from torsional.components import PlanetSpin
from torsional.laws import Law
from torsional.stamps import SpeedSwitch


@checked
def planetary_dual_mass_flywheel(
    primary_inertia: float,
    secondary_inertia: float,
    planet_inertia: float,
    law: Law,
    *,
    planet_ratio: float,
    damping: float = 0.0,
    switch: SpeedSwitch | None = None,
) -> Absorber:
    """A power split absorber of gear quotient 1 (bodies 2 and 4 merged): ω_c² = k / (J3 g (g − 1)).

    ``switch`` gives the planets another inertia above a speed (Meingaßner et al., SAE 2014-01-2862).

    >>> from torsional.laws import Hinges
    >>> sorted(planetary_dual_mass_flywheel(1.2, 1.0, 0.1, Hinges(13e3), planet_ratio=2.0).components)
    ['dmf', 'planets', 'primary', 'secondary']
    """
    planets = PlanetSpin("primary", "secondary", planet_ratio, planet_inertia, switch)
    plain = dual_mass_flywheel(primary_inertia, secondary_inertia, law, damping)
    return plain.joined({"planets": planets}, kind="planetary dual mass flywheel")
