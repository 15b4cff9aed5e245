"""Dual mass flywheel."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from torsional.absorbers import Absorber, dual_mass_flywheel
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.fields import Inertia
from torsional.files.schema.springs import DampedSpring


class DualMassFlywheel(AbsorberBlock, DampedSpring):
    """Two flywheels with springs between them."""

    type: Literal["dual_mass_flywheel"]
    primary_inertia: Inertia = Field(description="engine side")
    secondary_inertia: Inertia = Field(description="clutch side, with clutch cover")

    def concept(self) -> Absorber:
        """Two flywheels and the springs' law."""
        return dual_mass_flywheel(self.primary_inertia, self.secondary_inertia, self.law(), self.damping)
