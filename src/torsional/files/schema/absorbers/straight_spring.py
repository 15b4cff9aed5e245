"""Dual mass flywheel with straight springs and sliding shoes."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from torsional.absorbers import StraightSprings
from torsional.files.schema.absorbers.springs import Clearance, SpringFlywheelFields
from torsional.files.schema.fields import Length, Mass, Quantity, Whole


class StraightSpringFlywheel(SpringFlywheelFields):
    """A dual mass flywheel with rows of straight springs and sliding shoes between them."""

    makes: ClassVar = StraightSprings
    type: Literal["straight_spring_flywheel"]
    springs_per_row: Whole = Field(description="of each channel, one shoe more than springs")
    shoe_mass: Mass
    end_shoe_mass: Mass
    shoe_width: Length = Field(description="along the row, from spring to spring")
    end_shoe_width: Length
    primary_clearance: Clearance | None = Field(
        None, description="of the primary's tabs at rest; all play spread evenly where none is given"
    )
    play_factors: Annotated[list[float], Quantity("ratio", above=0, shape="list")] | None = Field(
        None, description="how many times the play each channel has, as tolerances make them differ"
    )
