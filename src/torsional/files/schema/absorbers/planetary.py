"""Planetary dual mass flywheel."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from torsional.absorbers import Absorber, planetary_dual_mass_flywheel
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.attached import SwitchBlock
from torsional.files.schema.fields import Inertia, InertiaOrNone, Number
from torsional.files.schema.springs import DampedSpring


class PlanetaryDualMassFlywheel(AbsorberBlock, DampedSpring):
    """A dual mass flywheel whose planet wheels spin with the travel."""

    type: Literal["planetary_dual_mass_flywheel"]
    primary_inertia: Inertia
    secondary_inertia: Inertia
    planet_inertia: InertiaOrNone = Field(description="spin inertia of all planets")
    planet_ratio: Number = Field(description="g: planets turn with (1 − g) θ1 + g θ2")
    switch: SwitchBlock | None = None

    def concept(self) -> Absorber:
        """Two flywheels, springs and the planets' spin."""
        return planetary_dual_mass_flywheel(
            self.primary_inertia,
            self.secondary_inertia,
            self.planet_inertia,
            self.law(),
            planet_ratio=self.planet_ratio,
            damping=self.damping,
            switch=self.switch.made() if self.switch else None,
        )
