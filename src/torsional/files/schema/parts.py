"""Components by name: the parts of a machine that no block describes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from torsional import components
from torsional.errors import ModelError
from torsional.files.schema.attached import PendulumFields, SwitchBlock
from torsional.files.schema.fields import (
    Block,
    Damping,
    Inertia,
    InertiaOrNone,
    Length,
    LossFactor,
    Mass,
    Node,
    Number,
    Quantity,
    Ratio,
    Stiffness,
)
from torsional.files.schema.making import Making, choice
from torsional.files.schema.springs import Spring, check_spring, washer
from torsional.laws import Hinges, Jenkins


class PartBlock(Making):
    """A component by its type."""

    makes: ClassVar[Any]


class Between(PartBlock):
    """What connects node a with node b."""

    a: Node
    b: Node

    @model_validator(mode="after")
    def _distinct(self) -> Between:
        if self.a == self.b:
            problem, remedy = "the component connects a node with itself", "name two different nodes"
            raise ModelError(problem, where="b", found=repr(self.b), remedy=remedy)
        return self


class InertiaPart(PartBlock):
    """A rigid disc."""

    makes: ClassVar = components.Inertia
    type: Literal["inertia"]
    inertia: Inertia
    node: Node | None = Field(None, description="where it sits; a node of its own name where none is given")


class VehiclePart(PartBlock):
    """A translating mass at the wheel."""

    makes: ClassVar = components.Vehicle
    type: Literal["vehicle"]
    mass: Mass
    rolling_radius: Length
    node: Node | None = None


class ElasticPart(Between):
    """A torsion spring with damping."""

    stiffness: Stiffness
    damping: Damping = 0.0
    loss_factor: LossFactor = 0.0


class ShaftPart(ElasticPart):
    """A torsion spring with damping."""

    makes: ClassVar = components.Shaft
    type: Literal["shaft"]


class TyrePart(ElasticPart):
    """The same, between wheels and road."""

    makes: ClassVar = components.Tyre
    type: Literal["tyre"]


class DamperPart(PartBlock):
    """A viscous damper, absolute where b is left out."""

    makes: ClassVar = components.Damper
    type: Literal["damper"]
    a: Node
    b: Node = "ground"
    damping: Annotated[float, Quantity("damping", above=0)]


class HingeRow(Block):
    """A change of stiffness beyond an angle."""

    angle: Annotated[float, Quantity("relative_angle")]
    side: Literal[1, -1] = Field(description="1: acts above the angle, -1: below")
    change: Annotated[float, Quantity("stiffness")]


class HingesBlock(Block):
    """A piecewise-linear law hinge by hinge."""

    stiffness: Annotated[float, Quantity("stiffness")]
    changes: list[HingeRow] = Field([])
    stops: Annotated[list[float], Quantity("relative_angle", shape="list")] | None = None

    def law(self) -> Hinges:
        """The law itself."""
        rows = self.changes
        angles, changes = tuple(row.angle for row in rows), tuple(row.change for row in rows)
        return Hinges(self.stiffness, angles, tuple(float(row.side) for row in rows), changes, tuple(self.stops or ()))


class CouplingPart(Between, Spring):
    """A connection with stages, lash and stop."""

    makes: ClassVar = components.Coupling
    type: Literal["coupling"]
    damping: Damping = 0.0
    hinges: HingesBlock | None = Field(None, description="the law hinge by hinge, instead of stiffness or stages")

    @model_validator(mode="after")
    def _consistent(self) -> CouplingPart:
        if self.hinges is None:
            check_spring(self)
        elif self.model_fields_set & set(Spring.model_fields):
            raise ModelError("hinges stand for the whole law", where="hinges", remedy="remove stiffness and stages")
        return self

    def law(self) -> Hinges:
        """The law from stages or hinges."""
        return self.hinges.law() if self.hinges else super().law()

    def made(self) -> components.Coupling:
        """A coupling with this law."""
        return components.Coupling(self.a, self.b, self.law(), self.damping)


class FrictionWasherPart(Between):
    """Dry friction that sticks elastically before it slips."""

    makes: ClassVar = components.Coupling
    type: Literal["friction_washer"]
    friction_torque: Annotated[float, Quantity("torque", above=0)] = Field(description="when it slips")
    friction_stiffness: Stiffness | None = Field(
        None, description="while it sticks; where none is given, such that it sticks within ±0.1°"
    )
    damping: Damping = 0.0

    def law(self) -> Jenkins:
        """The washer's law."""
        return washer(self.friction_torque, self.friction_stiffness)

    def made(self) -> components.Coupling:
        """A coupling with this law."""
        return components.Coupling(self.a, self.b, self.law(), self.damping)


class GearPairPart(Between):
    """Two meshing gears."""

    makes: ClassVar = components.GearPair
    type: Literal["gear_pair"]
    ratio: Ratio


class PlanetaryGearPart(PartBlock):
    """An epicyclic set."""

    makes: ClassVar = components.PlanetaryGear
    type: Literal["planetary_gear"]
    sun: Node
    ring: Node
    carrier: Node
    standing_ratio: Ratio = Field(description="i0 = −z_ring/z_sun of the simple set")
    planet_inertia: InertiaOrNone = Field(0.0, description="spin inertia of all planets")
    planet_ratio: Ratio = Field(1.0, description="z_sun/z_planet")


class SuperpositionPart(PartBlock):
    """A gear train by its ratio alone: θ_node = (1 − r) θ_a + r θ_b."""

    makes: ClassVar = components.Superposition
    type: Literal["superposition"]
    node: Node
    a: Node
    b: Node
    ratio: Number


class PlanetSpinPart(Between):
    """Planet wheels that turn with (1 − g) θ_a + g θ_b."""

    makes: ClassVar = components.PlanetSpin
    type: Literal["planet_spin"]
    ratio: Number
    inertia: InertiaOrNone
    switch: SwitchBlock | None = None


class DistributedShaftPart(Between):
    """A uniform shaft in finite elements."""

    makes: ClassVar = components.DistributedShaft
    type: Literal["distributed_shaft"]
    length: Length
    outer_diameter: Length
    inner_diameter: Annotated[float, Quantity("length", least=0)] = 0.0
    elements: Annotated[int, Field(ge=1, le=300)] = 10
    shear_modulus: Annotated[float, Quantity("shear_modulus", above=0)] = 80e9
    density: Annotated[float, Quantity("density", above=0)] = 7850.0
    loss_factor: LossFactor = 0.0


class PendulumPart(PendulumFields, PartBlock):
    """A centrifugal pendulum; its node has the component's name."""

    type: Literal["centrifugal_pendulum"]
    carrier: Node


if TYPE_CHECKING:
    Part = PartBlock
else:
    Part = choice(PartBlock)
