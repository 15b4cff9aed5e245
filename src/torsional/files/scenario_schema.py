"""What a scenario file may hold: one block of keys for each kind of event, with units and defaults."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field, model_validator

from torsional import units
from torsional.errors import ModelError
from torsional.files.scenario_blocks import (
    RPM,
    AnyTorque,
    ClutchLinings,
    GearName,
    Moment,
    Scenario,
    Share,
    SpeedGovernor,
    SpeedOrZero,
    Starter,
    Time,
    TorqueOrZero,
    usual,
)
from torsional.files.schema.fields import Node, Speed, Torque


class EngineStart(Scenario):
    """Starter, first firings, governor to idle; gearbox in neutral, clutch closed."""

    title: ClassVar[str] = "Engine start"
    scenario: Literal["engine_start"]
    duration: Time = 2.0
    starter: Starter = Field(default_factory=usual(Starter))
    firing_from: Moment = Field(0.6, description="when the first cylinder burns")
    governor: SpeedGovernor = Field(default_factory=usual(SpeedGovernor))

    def moments(self) -> list[tuple[str, float]]:
        """The first firing."""
        return [("firing_from", self.firing_from)]


class EngineStop(Scenario):
    """Fuel cut at idle; compression and friction bring the engine to rest through the resonance of its flywheel."""

    title: ClassVar[str] = "Engine stop"
    scenario: Literal["engine_stop"]
    duration: Time = 2.5
    speed: Speed | None = Field(None, description="before; default: idle")
    fuel_off: Moment = 0.2

    def moments(self) -> list[tuple[str, float]]:
        """The end of combustion."""
        return [("fuel_off", self.fuel_off)]


class _Tip(Scenario):
    """A change of engine torque in gear; the vehicle is free to change its speed."""

    duration: Time = 2.0
    gear: GearName = Field("", description="default: the last one")
    speed: Speed = Field(1000 * RPM, description="of the engine before")
    before: AnyTorque = Field(0.0, description="mean engine torque before")
    after: AnyTorque = Field(1500.0, description="mean engine torque after")
    at: Moment = Field(0.3, description="when it changes")
    within: Time = Field(0.05, description="time that the change takes")

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of the change."""
        return [("at", self.at)]


class TipIn(_Tip):
    """The driver steps on the pedal in gear; the vehicle is free to gain speed."""

    title: ClassVar[str] = "Tip-in"
    scenario: Literal["tip_in"]

    @model_validator(mode="after")
    def _rises(self) -> TipIn:
        _ordered(self, self.before < self.after, "more than before", "tip_out")
        return self


class TipOut(_Tip):
    """The driver leaves the pedal in gear."""

    title: ClassVar[str] = "Tip-out"
    scenario: Literal["tip_out"]
    before: AnyTorque = Field(1500.0, description="mean engine torque before")
    after: AnyTorque = Field(0.0, description="mean engine torque after")

    @model_validator(mode="after")
    def _falls(self) -> TipOut:
        _ordered(self, self.before > self.after, "less than before", "tip_in")
        return self


class ClutchEngagement(Scenario):
    """The clutch closes between a running engine and a vehicle that stands or rolls."""

    title: ClassVar[str] = "Clutch engagement"
    scenario: Literal["clutch_engagement"]
    duration: Time = 3.0
    gear: GearName = Field("", description="default: the first one")
    speed: Speed = Field(1000 * RPM, description="of the engine before")
    vehicle_at: SpeedOrZero = Field(0.0, description="speed of the gearbox input at which the vehicle rolls")
    torque: Torque = Field(800.0, description="mean engine torque at most, asked for by the governor")
    road_load: Torque | None = Field(None, description="resistance, at the node that takes up the load")
    clutch: ClutchLinings = Field(default_factory=usual(ClutchLinings, within=1.0))

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of the engagement."""
        return [("clutch.engages", self.clutch.engages)]


class GearShift(Scenario):
    """The clutch closes after a shift: the vehicle rolls on, the engine still has the speed of the old gear."""

    title: ClassVar[str] = "Gear shift"
    scenario: Literal["gear_shift"]
    duration: Time = 1.5
    from_gear: GearName = Field("", description="default: the last but one")
    to_gear: GearName = Field("", description="default: the last one")
    speed: Speed = Field(1400 * RPM, description="of the engine, in the old gear")
    torque: TorqueOrZero = Field(1000.0, description="mean engine torque after the shift")
    torque_from: Moment = Field(0.6, description="when the engine begins to pull again")
    clutch: ClutchLinings = Field(default_factory=usual(ClutchLinings, within=0.3))

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of the engagement, and of the torque."""
        return [("clutch.engages", self.clutch.engages), ("torque_from", self.torque_from)]


class Stall(Scenario):
    """The wheels lock on a slippery road in gear with the clutch closed, and the engine stalls."""

    title: ClassVar[str] = "Stall"
    scenario: Literal["stall"]
    duration: Time = 2.0
    gear: GearName = Field("", description="default: the last one")
    speed: Speed = Field(800 * RPM, description="of the engine before")
    torque: Torque = Field(600.0, description="mean engine torque, up to the end of combustion")
    brake: Torque = Field(40e3, description="at the braked node")
    node: Node = Field("wheels", description="that is braked")
    tyres: str = Field("tyres", description="connection between wheels and vehicle", max_length=64)
    grip: Torque | None = Field(
        None, description="torque that the wheels hold; default: half the brake, so that they lock"
    )
    at: Moment = Field(0.2, description="when braking begins")
    within: Time = Field(0.15, description="until the brake is fully on")
    fuel_off: Speed = Field(300 * RPM, description="engine speed under which nothing burns any more")

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of braking."""
        return [("at", self.at)]


class TractionLoss(Scenario):
    """Driven wheels lose their grip under torque and find it again."""

    title: ClassVar[str] = "Loss of traction"
    scenario: Literal["traction_loss"]
    duration: Time = 2.0
    gear: GearName = Field("", description="default: the middle one")
    speed: Speed = Field(1000 * RPM, description="of the engine before")
    torque: Torque = Field(1500.0, description="mean engine torque")
    tyres: str = Field("tyres", description="connection between wheels and vehicle", max_length=64)
    grip: Torque = Field(60e3, description="torque that the driven wheels hold on dry road")
    slippery: Share = Field(0.15, description="share of the grip left on the slippery stretch")
    lost: Moment = Field(0.3, description="when the slippery stretch begins")
    found: Time = Field(0.7, description="when it ends")

    def moments(self) -> list[tuple[str, float]]:
        """The ends of the slippery stretch."""
        return [("lost", self.lost), ("found", self.found)]

    @model_validator(mode="after")
    def _later(self) -> TractionLoss:
        if self.found <= self.lost:
            found, allowed = units.show(self.found, "time"), f"after {units.show(self.lost, 'time')}"
            raise ModelError("grip is found before it is lost", where="found", found=found, allowed=allowed)
        return self


class IdlePulse(Scenario):
    """A torque pulse at idle in neutral: whether springs with lash keep being met afterwards."""

    title: ClassVar[str] = "Torque pulse at idle"
    scenario: Literal["idle_pulse"]
    duration: Time = 3.0
    speed: Speed | None = Field(None, description="default: idle")
    pulse: AnyTorque = 500.0
    node: str = Field("", description="on which it acts; default: the crankshaft", max_length=64)
    at: Moment = 1.0
    length: Time = Field(0.033, description="of the pulse")

    def moments(self) -> list[tuple[str, float]]:
        """The pulse."""
        return [("at", self.at)]


def _ordered(tip: _Tip, right: bool, allowed: str, other: str) -> None:
    if not right:
        before = units.show(tip.before, "torque")
        told = {"found": units.show(tip.after, "torque"), "allowed": f"{allowed}, {before}"}
        raise ModelError("the torque changes the other way", where="after", **told, remedy=f"or choose {other}")


KINDS: dict[str, type[Scenario]] = {
    "engine_start": EngineStart,
    "engine_stop": EngineStop,
    "tip_in": TipIn,
    "tip_out": TipOut,
    "clutch_engagement": ClutchEngagement,
    "gear_shift": GearShift,
    "stall": Stall,
    "traction_loss": TractionLoss,
    "idle_pulse": IdlePulse,
}
