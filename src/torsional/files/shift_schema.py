"""What the file of a gear shift may hold: what happens when, from the old gear to the new one."""

from __future__ import annotations

import itertools
from typing import ClassVar, Literal

from pydantic import Field, model_validator

from torsional import units
from torsional.errors import ModelError
from torsional.files.scenario_blocks import ClutchLinings, GearName, Moment, Scenario, Time, TorqueOrZero, usual
from torsional.files.schema.fields import Block, Speed, Torque

AT_ONCE = 1e-9
"""Time [s] within which two moments are one."""


class ShiftClutch(ClutchLinings):
    """Linings that open and close again."""

    opens: Moment = Field(0.4, description="when the linings are let off")
    opens_within: Time = Field(0.1, description="until they carry nothing")
    engages: Moment = Field(1.2, description="when pressing begins")
    within: Time = Field(0.3, description="until the linings are fully pressed")


class Synchronising(Block):
    """Neutral: cones rub the gearbox input to the speed of the new gear, which is engaged at the end."""

    begins: Moment = Field(0.55, description="when the old gear is out")
    within: Time = Field(0.25, description="until the new gear is in")
    torque: Torque | None = Field(
        None, description="of the cones, at the gearbox input; default: as much as takes 0.6 of the time"
    )


class GearShift(Scenario):
    """Torque off, clutch open, old gear out, input synchronised, new gear in, clutch closed, torque on."""

    title: ClassVar[str] = "Gear shift"
    scenario: Literal["gear_shift"]
    duration: Time = 2.5
    from_gear: GearName = Field("", description="default: the last but one")
    to_gear: GearName = Field("", description="default: the last one")
    speed: Speed | None = Field(None, description="of the engine, in the old gear; default: 4/7 up its range")
    before: TorqueOrZero | None = Field(None, description="mean engine torque in the old gear; default: that after")
    torque_off: Moment = Field(0.2, description="when it begins to fall to none")
    off_within: Time = Field(0.2, description="time that this takes")
    synchroniser: Synchronising = Field(default_factory=usual(Synchronising))
    clutch: ShiftClutch = Field(default_factory=usual(ShiftClutch))
    torque: TorqueOrZero | None = Field(
        None, description="mean engine torque in the new gear; default: 0.4 of full load"
    )
    torque_from: Moment = Field(1.5, description="when the engine begins to pull again")
    torque_within: Time = Field(0.3, description="time that this takes")
    road_load: Torque | None = Field(None, description="resistance, at the node that takes up the load")

    def moments(self) -> list[tuple[str, float]]:
        """The beginnings of all that happens."""
        return [(path, begin) for path, begin, _ in self._course()]

    def _course(self) -> list[tuple[str, float, float]]:
        """Key path, beginning and end [s] of what happens, in its order."""
        clutch, cones = self.clutch, self.synchroniser
        return [
            ("torque_off", self.torque_off, self.torque_off + self.off_within),
            ("clutch.opens", clutch.opens, clutch.opens + clutch.opens_within),
            ("synchroniser.begins", cones.begins, cones.begins + cones.within),
            ("clutch.engages", clutch.engages, clutch.engages),
            ("torque_from", self.torque_from, self.torque_from),
        ]

    @model_validator(mode="after")
    def _one_after_the_other(self) -> GearShift:
        course = self._course()
        for (first, _, end), (path, begin, _) in itertools.pairwise(course):
            if begin < end - AT_ONCE:
                over = {
                    "torque_off": "the engine still pulls",
                    "clutch.opens": "the clutch is not open yet",
                    "synchroniser.begins": "the new gear is not in yet",
                    "clutch.engages": "the clutch is still open",
                }[first]
                found, allowed = units.show(begin, "time"), f"{units.show(end, 'time')} and later"
                raise ModelError(
                    over, where=path, found=found, allowed=allowed, remedy="begin later, or take less time"
                )
        return self
