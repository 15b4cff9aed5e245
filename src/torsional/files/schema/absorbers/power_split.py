"""Power split absorber."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from torsional.absorbers import Absorber, power_split_absorber
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.fields import Inertia, InertiaOrNone, Number, Quantity
from torsional.files.schema.springs import DampedSpring

GearQuotient = Annotated[float, Quantity("ratio", above=0)]


class PowerSplit(AbsorberBlock, DampedSpring):
    """Springs and planetary gears side by side."""

    type: Literal["power_split"]
    primary_inertia: Inertia = Field(description="body 1, engine side")
    secondary_inertia: Inertia = Field(description="body 2, behind the springs")
    planet_inertia: InertiaOrNone = Field(description="body 3, spin inertia of all planets")
    output_inertia: Inertia = Field(description="body 4, clutch side")
    planet_ratio: Number = Field(description="g: planets turn with (1 − g) θ1 + g θ2")
    gear_quotient: GearQuotient = Field(description="r = (θ4 − θ1)/(θ2 − θ1), between 0 and 1")

    def concept(self) -> Absorber:
        """Four bodies, springs and the gears' condition."""
        return power_split_absorber(
            self.primary_inertia,
            self.secondary_inertia,
            self.planet_inertia,
            self.output_inertia,
            self.law(),
            planet_ratio=self.planet_ratio,
            gear_quotient=self.gear_quotient,
            damping=self.damping,
        )

    def spring_share(self) -> float:
        """The gears carry the rest."""
        return self.gear_quotient
