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
)
from torsional.files.schema.springs import DampedSpring, Friction, Spring, check_spring

Order = Annotated[float, Quantity("engine_order", above=0)]
GearQuotient = Annotated[float, Quantity("ratio", above=0)]
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


Absorber = Annotated[
    SingleMassFlywheel | DualMassFlywheel | TunedDualMassFlywheel | PowerSplit | PlanetaryDualMassFlywheel,
    Field(discriminator="type"),
]
