"""The blocks of a vehicle's powertrain: crankshaft, clutch, gearbox, driveline, vehicle."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from torsional.errors import ModelError
from torsional.files.schema.fields import (
    Block,
    Damping,
    Dampings,
    Inertia,
    Inertias,
    Length,
    Mass,
    Quantity,
    Ratio,
    Stiffness,
    Stiffnesses,
)
from torsional.files.schema.springs import DampedSpring


class CrankDamper(Block):
    """A torsional damper on the free end."""

    ring_inertia: Inertia
    hub_inertia: Inertia
    stiffness: Stiffness = Field(description="ring to hub")
    damping: Damping = Field(0.0, description="ring to hub")
    hub_stiffness: Stiffness = Field(description="hub to first throw")


class Crankshaft(Block):
    """An elastic crankshaft throw by throw, or one lumped inertia."""

    throws: Annotated[int, Field(ge=1, le=16)] | None = Field(None, description="where there is no engine to tell")
    damper: CrankDamper | None = None
    throw_inertia: Inertias | None = Field(None, description="of a throw, half its reciprocating share in")
    stiffness: Stiffnesses | None = Field(None, description="between neighbouring throws")
    damping: Dampings = Field(0.0, description="between neighbouring throws")
    flange_stiffness: Stiffness | None = Field(None, description="last throw to the absorber")
    flange_damping: Damping = Field(0.0, description="last throw to the absorber")
    absolute_damping: Dampings = Field(0.0, description="of each throw, to ground")
    lumped_inertia: Inertia | None = Field(None, description="the whole crankshaft as one rigid body, instead")

    @model_validator(mode="after")
    def _one_way_only(self) -> Crankshaft:
        elastic = ("damper", "throw_inertia", "stiffness", "damping", "absolute_damping")
        if self.lumped_inertia is not None:
            for key in elastic:
                if key in self.model_fields_set:
                    raise ModelError("a lumped crankshaft has none", where=key, remedy="remove it, or lumped_inertia")
            return self
        for key in ("throw_inertia", "stiffness", "flange_stiffness"):
            if getattr(self, key) is None and not (key == "stiffness" and self.throws == 1):
                raise ModelError(f"the key '{key}' is missing", remedy="or give lumped_inertia for a rigid crankshaft")
        return self


class Clutch(DampedSpring):
    """A closed clutch: its damper and the disc, whose hub sits on the gearbox input shaft."""

    inertia: Inertia = Field(description="clutch disc")
    hub_stiffness: Stiffness = Field(description="disc hub to gearbox input")


Ratios = Annotated[list[float] | dict[str, float], Quantity("gear_ratio", nonzero=True, shape="list or names")]


class Gearbox(Block):
    """A gearbox: input shaft, mesh at input speed, ratio, output shaft."""

    ratios: Ratios = Field(description="input speed over output speed: a list from gear 1 on, or by name")
    input_inertia: Inertia
    mesh_inertia: Inertia = Field(description="of what turns behind the shaft's elasticity, at input speed")
    output_inertia: Inertia = Field(description="at output speed")
    stiffness: Stiffnesses = Field(description="at input speed: one value, or one a gear")

    @property
    def by_name(self) -> dict[str, float]:
        """Ratio of every gear; gears in a list are called 1, 2, 3 …"""
        listed = self.ratios
        return listed if isinstance(listed, dict) else {str(n): ratio for n, ratio in enumerate(listed, 1)}


class Driveline(Block):
    """Propeller shaft, axle, half shafts, wheels and tyres; every value at its own speed."""

    propeller_shaft_stiffness: Stiffness
    propeller_shaft_damping: Damping = 0.0
    axle_inertia: Inertia = Field(description="at the propeller shaft's speed")
    final_drive_ratio: Ratio
    half_shaft_stiffness: Stiffness = Field(description="of all together, at the wheels")
    half_shaft_damping: Damping = 0.0
    wheel_inertia: Inertia = Field(description="of all driven wheels")
    tyre_stiffness: Stiffness = Field(description="of all driven tyres, torsional")
    tyre_damping: Damping = 0.0


class VehicleBlock(Block):
    """The vehicle as an inertia at the wheels, m r²."""

    mass: Mass
    rolling_radius: Length
