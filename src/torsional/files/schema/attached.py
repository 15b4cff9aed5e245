"""What a body may carry: centrifugal pendulums, and an inertia that is switched at a speed."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from torsional.absorbers import CentrifugalPendulum, Rollers
from torsional.files.schema.fields import (
    Damping,
    Inertia,
    InertiaOrNone,
    Length,
    Mass,
    Node,
    Order,
    Quantity,
    Speed,
    SpringRate,
    Time,
    Whole,
)
from torsional.files.schema.making import Making
from torsional.stamps import SpeedSwitch

Path = Literal["circular", "cycloid", "epicycloid", "tautochrone"]


class RollersBlock(Making):
    """Rollers of a bifilar pendulum, all of them together."""

    makes: ClassVar = Rollers

    mass: Mass
    inertia: Inertia = Field(description="spin inertia")
    radius: Length
    distance: Length = Field(description="of their centres from the axis")


class PendulumFields(Making):
    """A centrifugal pendulum, all its masses together."""

    makes: ClassVar = CentrifugalPendulum

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

    def on(self, body: str) -> CentrifugalPendulum:
        """The pendulum on the body it names, or else on this one."""
        return CentrifugalPendulum(**{"carrier": body, **self.values()})


class SwitchBlock(Making):
    """Another planet inertia above a mean engine speed."""

    above: Speed = Field(description="engine speed above which the other inertia acts")
    inertia: InertiaOrNone
    hysteresis: Annotated[float, Quantity("speed", least=0)] = Field(0.0, description="how far below it goes back")

    def made(self) -> SpeedSwitch:
        """The other inertia above a speed."""
        return SpeedSwitch(self.inertia, self.above, self.hysteresis)
