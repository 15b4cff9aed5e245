"""Dual mass flywheel with a tuned absorber."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from torsional.absorbers import Absorber, tuned_flange_flywheel, tuned_secondary_flywheel, tuned_stiffness
from torsional.errors import ModelError
from torsional.files.schema.absorbers.base import AbsorberBlock
from torsional.files.schema.fields import Block, Damping, Inertia, InertiaOrNone, Order, Speed, Stiffness
from torsional.files.schema.springs import Friction, Spring, check_spring


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

    def spring(self) -> float:
        """Its stiffness [Nm/rad], given or tuned."""
        return self.stiffness or tuned_stiffness(self.inertia, (self.tuned_to or 0.0) * (self.order or 0.0))


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

    def concept(self) -> Absorber:
        """The tuned absorber on the flange between two rows of springs, or on the secondary flywheel."""
        tva = {"tva_inertia": self.tva.inertia, "tva_stiffness": self.tva.spring(), "tva_damping": self.tva.damping}
        first, last = self.primary_inertia, self.secondary_inertia
        if self.flange_inertia is None:
            return tuned_secondary_flywheel(first, last, self.law(), damping=self.damping, **tva)
        front, rear = (row.law() for row in (self.primary_springs, self.secondary_springs) if row)
        return tuned_flange_flywheel(first, self.flange_inertia, last, front, rear, damping=self.damping, **tva)
