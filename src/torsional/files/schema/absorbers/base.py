"""What every absorber of a model file has."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from torsional.absorbers import Absorber, with_friction, with_pendulum
from torsional.files.schema.attached import PendulumBlock
from torsional.files.schema.making import Making
from torsional.files.schema.springs import Friction


class AbsorberBlock(Making):
    """What every absorber may have."""

    pendulum: PendulumBlock | None = Field(None, description="centrifugal pendulum on one of the bodies")

    apart: ClassVar = ("type", "pendulum")

    def made(self) -> Absorber:
        """The absorber with its friction and its pendulum."""
        concept = self.concept()
        washer = self.washer() if isinstance(self, Friction) else None
        concept = with_friction(concept, washer) if washer else concept
        return with_pendulum(concept, self.pendulum.on(concept.output)) if self.pendulum else concept

    def concept(self) -> Absorber:
        """The absorber without what any may have."""
        absorber: Absorber = super().made()
        return absorber

    def spring_share(self) -> float:
        """The part of a mean torque that goes through the springs."""
        return 1.0
