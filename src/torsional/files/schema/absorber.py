"""The absorber block: what stands between crankshaft and clutch."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from torsional.errors import ModelError
from torsional.files.schema.fields import (
    Block,
    Damping,
    Inertia,
    InertiaOrNone,
    Length,
    Mass,
    Node,
    Number,
    Quantity,
    Speed,
    Stiffness,
    Torque,
)
from torsional.files.schema.springs import DampedSpring, Friction, Spring, check_spring

Order = Annotated[float, Quantity("engine_order", above=0)]
GearQuotient = Annotated[float, Quantity("ratio", above=0)]
SpringRate = Annotated[float, Quantity("spring_rate", above=0)]
Time = Annotated[float, Quantity("time", least=0)]
Whole = Annotated[int, Field(ge=1, le=100)]
Clearance = Annotated[float | list[float], Quantity("relative_angle", least=0, shape="one or list")]
Path = Literal["circular", "cycloid", "epicycloid", "tautochrone"]


class RollersBlock(Block):
    """Rollers of a bifilar pendulum, all of them together."""

    mass: Mass
    inertia: Inertia = Field(description="spin inertia")
    radius: Length
    distance: Length = Field(description="of their centres from the axis")


class PendulumFields(Block):
    """A centrifugal pendulum, all its masses together."""

    mass: Mass
    distance: Length = Field(description="of the pendulums' centre from the axis")
    order: Order = Field(description="order its path is tuned to, rollers left out")
    damping: Damping = 0.0
    path: Path = "circular"
    rollers: RollersBlock | None = None
    count: Whole = Field(1, description="pendulums that share the mass and, in time, move each on its own")
    stop: Length | None = Field(None, description="way along the path to its end stops")
    stop_stiffness: SpringRate = Field(1e7, description="of a stop, along the path")
    stop_time: Time = Field(1e-5, description="contact time of a stop, its damping over its stiffness")


class PendulumBlock(PendulumFields):
    """A centrifugal pendulum on one of the absorber's bodies."""

    carrier: Node | None = Field(None, description="body that carries it; the output body where none is named")


class AbsorberBlock(Block):
    """What every absorber may have."""

    pendulum: PendulumBlock | None = Field(None, description="centrifugal pendulum on one of the bodies")


class SingleMassFlywheel(AbsorberBlock):
    """A rigid flywheel."""

    type: Literal["single_mass_flywheel"]
    inertia: Inertia = Field(description="flywheel with clutch cover")


class DualMassFlywheel(AbsorberBlock, DampedSpring):
    """Two flywheels with springs between them."""

    type: Literal["dual_mass_flywheel"]
    primary_inertia: Inertia = Field(description="engine side")
    secondary_inertia: Inertia = Field(description="clutch side, with clutch cover")


class TunedAbsorber(Block):
    """An inertia on a spring, tuned to one frequency."""

    inertia: InertiaOrNone
    stiffness: Stiffness | None = Field(None, description="of its spring, unless tuned_to is given")
    tuned_to: Speed | None = Field(
        None, description="engine speed at which its order is cancelled, instead of stiffness"
    )
    order: Order | None = Field(None, description="engine order that tuned_to refers to")
    damping: Damping = 0.0

    @model_validator(mode="after")
    def _one_way_only(self) -> TunedAbsorber:
        if (self.stiffness is None) == (self.tuned_to is None):
            found = "neither" if self.tuned_to is None else "both"
            raise ModelError("a tuned absorber has a stiffness or tuned_to", found=found, allowed="one of the two")
        if (self.order is None) != (self.tuned_to is None):
            remedy = "e.g. tuned_to: 650 rpm with order: 3"
            raise ModelError("tuned_to and order belong together", where="order", remedy=remedy)
        return self


class TunedDualMassFlywheel(AbsorberBlock, Spring, Friction):
    """A dual mass flywheel with a tuned absorber on an intermediate flange or on the secondary flywheel."""

    type: Literal["dual_mass_flywheel_with_tuned_absorber"]
    on: Literal["flange", "secondary"] = Field(description="body that carries the tuned absorber")
    primary_inertia: Inertia
    secondary_inertia: Inertia
    flange_inertia: Inertia | None = Field(None, description="with on: flange")
    primary_springs: Spring | None = Field(None, description="primary to flange, with on: flange")
    secondary_springs: Spring | None = Field(None, description="flange to secondary, with on: flange")
    damping: Damping = Field(0.0, description="viscous, beside the springs (beside both rows on a flange)")
    tva: TunedAbsorber

    @model_validator(mode="after")
    def _consistent(self) -> TunedDualMassFlywheel:
        wanted = {"flange_inertia", "primary_springs", "secondary_springs"}
        given = {key for key in wanted if getattr(self, key) is not None}
        wrong = given if self.on == "secondary" else wanted - given
        if wrong:
            key = sorted(wrong)[0]
            problem = f"goes with on: flange, not with on: {self.on}" if given else "is missing, with on: flange"
            raise ModelError(f"the key '{key}' {problem}", where=key if given else "")
        if self.on == "secondary":
            check_spring(self)
        elif self.stiffness is not None or self.stages:
            remedy = "write them into primary_springs and secondary_springs"
            raise ModelError("with on: flange there are two rows of springs", where="stiffness", remedy=remedy)
        elif self.friction_torque:
            remedy = "write it as a component of type friction_washer, between the bodies that rub"
            raise ModelError("with on: flange there are two rows of springs", where="friction_torque", remedy=remedy)
        return self


class PowerSplit(AbsorberBlock, DampedSpring):
    """Springs and planetary gears side by side."""

    type: Literal["power_split"]
    primary_inertia: Inertia = Field(description="body 1, engine side")
    secondary_inertia: Inertia = Field(description="body 2, behind the springs")
    planet_inertia: InertiaOrNone = Field(description="body 3, spin inertia of all planets")
    output_inertia: Inertia = Field(description="body 4, clutch side")
    planet_ratio: Number = Field(description="g: planets turn with (1 − g) θ1 + g θ2")
    gear_quotient: GearQuotient = Field(description="r = (θ4 − θ1)/(θ2 − θ1), between 0 and 1")


class SwitchBlock(Block):
    """Another planet inertia above a mean engine speed."""

    above: Speed = Field(description="engine speed above which the other inertia acts")
    inertia: InertiaOrNone
    hysteresis: Annotated[float, Quantity("speed", least=0)] = Field(0.0, description="how far below it goes back")


class PlanetaryDualMassFlywheel(AbsorberBlock, DampedSpring):
    """A dual mass flywheel whose planet wheels spin with the travel."""

    type: Literal["planetary_dual_mass_flywheel"]
    primary_inertia: Inertia
    secondary_inertia: Inertia
    planet_inertia: InertiaOrNone = Field(description="spin inertia of all planets")
    planet_ratio: Number = Field(description="g: planets turn with (1 − g) θ1 + g θ2")
    switch: SwitchBlock | None = None


class CoilSpringBlock(Block):
    """A coil spring; of an arc spring the lengths are those along its arc."""

    rate: SpringRate = Field(description="of the whole spring")
    free_length: Length
    solid_length: Length = Field(description="with its coils touching")
    mass: Annotated[float, Quantity("mass", least=0)] = 0.0


class GuideFrictionBlock(Block):
    """LuGre friction of what slides in a channel, per newton of the load that presses it."""

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


class StraightSpringFlywheel(SpringFlywheelFields):
    """A dual mass flywheel with rows of straight springs and sliding shoes between them."""

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


class ArcSpringFlywheel(SpringFlywheelFields):
    """A dual mass flywheel with arc springs that slide in their channels."""

    type: Literal["arc_spring_flywheel"]
    segments: Whole = Field(8, description="of each arc spring, at least 6")
    end_mass: Annotated[float, Quantity("mass", least=0)] = Field(0.0, description="cap at each end of an arc spring")
    inner_friction: GuideFrictionBlock | None = Field(
        None, description="between the springs; as on the guide if left out"
    )


Absorber = Annotated[
    SingleMassFlywheel
    | DualMassFlywheel
    | TunedDualMassFlywheel
    | PowerSplit
    | PlanetaryDualMassFlywheel
    | StraightSpringFlywheel
    | ArcSpringFlywheel,
    Field(discriminator="type"),
]
