"""What a scenario file may hold: one block of keys for each kind of event, with units and defaults."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, TypeAlias

from pydantic import Field, model_validator

from torsional import units
from torsional.errors import ModelError
from torsional.files.scenario_blocks import (
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
from torsional.files.shift_schema import GearShift


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
    duration: Time = 3.5
    speed: Speed | None = Field(None, description="before; default: idle")
    fuel_off: Moment = 0.2

    def moments(self) -> list[tuple[str, float]]:
        """The end of combustion."""
        return [("fuel_off", self.fuel_off)]


class _Tip(Scenario):
    """A change of engine torque in gear; the vehicle is free to change its speed."""

    duration: Time = 2.0
    gear: GearName = Field("", description="default: the last one")
    speed: Speed | None = Field(None, description="of the engine before; default: 2/7 up its range")
    before: AnyTorque | None = Field(None, description="mean engine torque before; default: none")
    after: AnyTorque | None = Field(None, description="mean engine torque after; default: 0.6 of full load")
    at: Moment = Field(0.3, description="when it changes")
    within: Time = Field(0.05, description="time that the change takes")

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of the change."""
        return [("at", self.at)]


class TipIn(_Tip):
    """The driver steps on the pedal in gear; the vehicle is free to gain speed."""

    title: ClassVar[str] = "Tip-in"
    scenario: Literal["tip_in"]


class TipOut(_Tip):
    """The driver leaves the pedal in gear."""

    title: ClassVar[str] = "Tip-out"
    scenario: Literal["tip_out"]
    before: AnyTorque | None = Field(None, description="mean engine torque before; default: 0.6 of full load")
    after: AnyTorque | None = Field(None, description="mean engine torque after; default: none")


class ClutchEngagement(Scenario):
    """The clutch closes between a running engine and a vehicle that stands or rolls."""

    title: ClassVar[str] = "Clutch engagement"
    scenario: Literal["clutch_engagement"]
    duration: Time = 3.0
    gear: GearName = Field("", description="default: the first one")
    speed: Speed | None = Field(None, description="of the engine before; default: 2/7 up its range")
    vehicle_at: SpeedOrZero = Field(0.0, description="speed of the gearbox input at which the vehicle rolls")
    torque: TorqueOrZero | None = Field(
        None, description="mean engine torque at most, asked for by the governor; 0: none; default: 0.3 of full load"
    )
    road_load: Torque | None = Field(None, description="resistance, at the node that takes up the load")
    clutch: ClutchLinings = Field(default_factory=usual(ClutchLinings, within=1.0))

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of the engagement."""
        return [("clutch.engages", self.clutch.engages)]


class Stall(Scenario):
    """The wheels lock on a slippery road in gear with the clutch closed, and the engine stalls."""

    title: ClassVar[str] = "Stall"
    scenario: Literal["stall"]
    duration: Time = 2.0
    gear: GearName = Field("", description="default: the last one")
    speed: Speed | None = Field(None, description="of the engine before; default: 1/7 up its range")
    torque: Torque | None = Field(
        None, description="mean engine torque, up to the end of combustion; default: a quarter of full load"
    )
    brake: Torque | None = Field(None, description="at the braked node; default: 0.2 of the weight at the wheels")
    node: Node = Field("wheels", description="that is braked")
    tyres: str = Field("tyres", description="connection between wheels and vehicle", max_length=64)
    grip: Torque | None = Field(
        None, description="torque that the wheels hold; default: half the brake, so that they lock"
    )
    at: Moment = Field(0.2, description="when braking begins")
    within: Time = Field(0.15, description="until the brake is fully on")
    fuel_off: Speed | None = Field(
        None, description="engine speed under which nothing burns any more; default: half of idle"
    )

    def moments(self) -> list[tuple[str, float]]:
        """The beginning of braking."""
        return [("at", self.at)]


class TractionLoss(Scenario):
    """Driven wheels lose their grip under torque and find it again."""

    title: ClassVar[str] = "Loss of traction"
    scenario: Literal["traction_loss"]
    duration: Time = 2.0
    gear: GearName = Field("", description="default: the middle one")
    speed: Speed | None = Field(None, description="of the engine before; default: 2/7 up its range")
    torque: Torque | None = Field(None, description="mean engine torque; default: 0.6 of full load")
    tyres: str = Field("tyres", description="connection between wheels and vehicle", max_length=64)
    grip: Torque | None = Field(
        None, description="torque that the driven wheels hold on dry road; default: 0.3 of the weight at the wheels"
    )
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
    pulse: AnyTorque | None = Field(None, description="torque; default: a fifth of full load")
    node: str = Field("", description="on which it acts; default: the crankshaft", max_length=64)
    at: Moment = 1.0
    length: Time = Field(0.02, description="of the pulse")

    def moments(self) -> list[tuple[str, float]]:
        """The pulse."""
        return [("at", self.at)]


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
AnyScenario: TypeAlias = Annotated[
    EngineStart | EngineStop | TipIn | TipOut | ClutchEngagement | GearShift | Stall | TractionLoss | IdlePulse,
    Field(discriminator="scenario"),
]
"""What a scenario file may be."""
