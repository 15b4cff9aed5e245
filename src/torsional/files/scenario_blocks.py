"""What scenarios are made of: starter, governor, linings, and what all of them hold."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, TypeVar

from pydantic import BeforeValidator, Field, model_validator

from torsional import units
from torsional.errors import ModelError
from torsional.files.schema.fields import Block, Inertia, Quantity, Speed, Stiffness, Torque, only_version
from torsional.units import RPM

VERSION = 1

Time = Annotated[float, Quantity("time", above=0)]
Moment = Annotated[float, Quantity("time", least=0)]
AnyTorque = Annotated[float, Quantity("torque")]
TorqueOrZero = Annotated[float, Quantity("torque", least=0)]
SpeedOrZero = Annotated[float, Quantity("speed", least=0)]
Share = Annotated[float, Quantity("ratio", least=0)]


def _version(value: object) -> object:
    return only_version(value, VERSION, "torsional_scenario")


def _gear(value: object) -> object:
    """A gear by number is meant by its name."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


Version = Annotated[int, BeforeValidator(_version)]
GearName = Annotated[str, BeforeValidator(_gear), Field(max_length=64)]


class Starter(Block):
    """A starter motor on the crankshaft, one-way: its torque falls in a straight line with the crank's speed."""

    torque: Torque | None = Field(None, description="at standstill, at the crankshaft; default: half of full load")
    speed: Speed = Field(250 * RPM, description="of the crank, at which it gives no more")
    release: Speed | None = Field(
        None, description="of the crank, once reached it is off; default: half way from its own speed to idle"
    )
    until: Time = Field(1.2, description="when it is switched off at the latest")


class SpeedGovernor(Block):
    """What keeps the engine at a speed: heat of combustion as a share of that for the most torque it may ask for."""

    speed: Speed | None = Field(None, description="wanted; default: the model's idle speed")
    torque: Torque | None = Field(None, description="mean torque at most; default: 0.4 of full load")
    droop: Speed = Field(150 * RPM, description="by which the speed must fall for that torque")
    reset: Time = Field(1.0, description="time after which a lasting error has doubled its effect")


class ClutchLinings(Block):
    """Linings that slip: their capacity grows from nought to full while the clutch is engaged."""

    capacity: Torque | None = Field(None, description="carried sliding, fully pressed; default: 1.4 times full load")
    breakaway: Share = Field(1.1, description="torque that it carries sticking over that")
    engages: Moment = Field(0.2, description="when pressing begins")
    within: Time = Field(0.5, description="until the linings are fully pressed")
    lining_inertia: Inertia | None = Field(
        None, description="of linings and carrier plate, ahead of the damper; default: a third of the disc's"
    )
    stiffness: Stiffness | None = Field(
        None, description="of the linings while they stick; default: their capacity at 1/300 rad"
    )


B = TypeVar("B", bound=Block)


def usual(block: type[B], **values: object) -> Callable[[], B]:
    """A block with its defaults but for some values."""
    return lambda: block.model_validate(values)


class Scenario(Block):
    """What every scenario holds."""

    title: ClassVar[str] = ""
    torsional_scenario: Version
    scenario: str
    name: str = Field("", max_length=200)
    duration: Time = 2.0
    step: Time | None = Field(None, description="of time; default: chosen from the line's modes")
    model: dict[str, Any] = Field(default_factory=dict, description="values of the model file to be changed")

    @model_validator(mode="after")
    def _in_time(self) -> Scenario:
        for path, moment in self.moments():
            if moment >= self.duration:
                found, allowed = units.show(moment, "time"), f"before the end, {units.show(self.duration, 'time')}"
                raise ModelError("nothing would be seen of it", where=path, found=found, allowed=allowed)
        if self.step is not None and self.step > self.duration / 100:
            allowed = f"at most a hundredth of the duration, {units.show(self.duration / 100, 'time')}"
            raise ModelError(
                "the step is too large", where="step", found=units.show(self.step, "time"), allowed=allowed
            )
        return self

    def moments(self) -> list[tuple[str, float]]:
        """Key path and time [s] of what must happen within the duration."""
        return []

    @property
    def gears(self) -> tuple[str, ...]:
        """The gears that are named; none is the model's last."""
        return tuple(filter(None, (getattr(self, key, "") for key in ("gear", "from_gear", "to_gear"))))
