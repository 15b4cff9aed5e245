"""What dual mass flywheels share that are given by their springs."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import Field

from torsional.absorbers import Absorber, CoilSpring, GuideFriction, condensed_flywheel
from torsional.errors import ModelError
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.fields import (
    Damping,
    Inertia,
    Length,
    Quantity,
    SpringRate,
    Stiffness,
    Time,
    Torque,
    Whole,
)
from torsional.files.schema.making import Making

Clearance = Annotated[float | list[float], Quantity("relative_angle", least=0, shape="one or list")]


class CoilSpringBlock(Making):
    """A coil spring; of an arc spring the lengths are those along its arc."""

    makes: ClassVar = CoilSpring
    rate: SpringRate = Field(description="of the whole spring")
    free_length: Length
    solid_length: Length = Field(description="with its coils touching")
    mass: Annotated[float, Quantity("mass", least=0)] = 0.0


class GuideFrictionBlock(Making):
    """LuGre friction of what slides in a channel, per newton of the load that presses it."""

    makes: ClassVar = GuideFriction
    sliding_coefficient: Annotated[float, Quantity("friction_coefficient", above=0)]
    static_coefficient: Annotated[float, Quantity("friction_coefficient", above=0)] | None = Field(
        None, description="when it breaks loose; as sliding where none is given"
    )
    stribeck_velocity: Annotated[float, Quantity("velocity", above=0)] = Field(0.02, description="between the two")
    presliding: Annotated[float, Quantity("presliding", above=0)] = 5e-5
    bristle_time: Time = Field(2e-5, description="damping of the bristles over their stiffness")
    viscous_coefficient: Annotated[float, Quantity("number", least=0)] = Field(
        0.01, description="what the coefficient gains per m/s"
    )


class SpringFlywheelFields(AbsorberBlock):
    """What dual mass flywheels share that are given by their springs."""

    primary_inertia: Inertia = Field(description="engine side, without what slides in the channels")
    secondary_inertia: Inertia = Field(description="clutch side, with clutch cover")
    channels: Whole = Field(description="round the circle")
    radius: Length = Field(description="at which the springs' force acts")
    channel_arc: Annotated[float, Quantity("relative_angle", above=0)] = Field(
        description="of one channel, between the primary's tabs"
    )
    spring: CoilSpringBlock
    inner_spring: CoilSpringBlock | None = Field(None, description="a shorter one inside, which engages later")
    secondary_clearance: Clearance = Field(0.0, description="of the flange's tabs at rest; one value or [drive, coast]")
    stop_angle: Annotated[float, Quantity("relative_angle", above=0)] = Field(description="between the flywheels")
    stop_stiffness: Stiffness = 2e6
    tab_stiffness: Stiffness = 1e6
    bind_stiffness: Stiffness = Field(5e5, description="of solid coils")
    contact_time: Time = Field(2e-5, description="damping over stiffness of all")
    friction: GuideFrictionBlock | None = Field(None, description="on the primary's guide")
    grease_damping: Damping = Field(0.0, description="of each body in the channels")
    preloaded: bool = Field(False, description="springs longer than their channel are meant")
    rated_torque: Torque | None = Field(None, description="refused where a spring is solid before")
    damping: Damping | None = Field(
        None, description="viscous, between the flywheels, for all friction in linear and periodic analyses"
    )

    def values(self) -> dict[str, Any]:
        """The keys as a design takes them: clearances on drive and on coast."""
        given = super().values()
        return {key: _pair(key, value) if key.endswith("_clearance") else value for key, value in given.items()}

    def concept(self) -> Absorber:
        """Two flywheels and the characteristic of the design, with every body as its detail."""
        return condensed_flywheel(type(self).makes(**self.values()))


def _pair(key: str, value: float | tuple[float, ...]) -> tuple[float, ...]:
    if not isinstance(value, tuple):
        return value, value
    if len(value) != 2:
        allowed = "one value, or two, [drive, coast]"
        raise ModelError("the list has the wrong length", where=key, found=f"{len(value)} values", allowed=allowed)
    return value
