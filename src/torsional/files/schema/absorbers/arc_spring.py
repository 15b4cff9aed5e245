"""Dual mass flywheel with arc springs."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from torsional.absorbers import ArcSprings
from torsional.files.schema.absorbers.springs import GuideFrictionBlock, SpringFlywheelFields
from torsional.files.schema.fields import Quantity, Whole


class ArcSpringFlywheel(SpringFlywheelFields):
    """A dual mass flywheel with arc springs that slide in their channels."""

    makes: ClassVar = ArcSprings
    type: Literal["arc_spring_flywheel"]
    segments: Whole = Field(8, description="of each arc spring, at least 6")
    end_mass: Annotated[float, Quantity("mass", least=0)] = Field(0.0, description="cap at each end of an arc spring")
    inner_friction: GuideFrictionBlock | None = Field(
        None, description="between the springs; as on the guide if left out"
    )
