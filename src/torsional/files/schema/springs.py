"""Spring characteristics, shared by absorbers, clutches and couplings."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from torsional.errors import ModelError
from torsional.files.schema.fields import Block, Damping, Quantity, Stiffness, Torque
from torsional.laws import Hinges, Jenkins

Lash = Annotated[float, Quantity("relative_angle", least=0)]
_ENDLESS = float("inf")
STICKS_WITHIN = math.radians(0.1)
"""Elastic twist [rad] at which a friction washer of no stated stiffness slips: an engineering judgement.

Small against the degrees over which a damper works; the same for every torque, so that a weak washer is a weak spring.
"""


class Stage(Block):
    """One stage: its stiffness, and the torque up to which it acts; the last may go on without end."""

    stiffness: Stiffness = Field(description="stiffness of the stage")
    up_to: Torque | None = Field(None, description="torque at which the next stage, or the stop, begins")


class Spring(Block):
    """A spring: one stiffness, or stages with rising torques; lash and stop where there are any."""

    stiffness: Stiffness | None = Field(None, description="of a spring with a single stage")
    stages: Annotated[list[Stage], Field(min_length=1, max_length=50)] | None = Field(
        None, description="stages from the softest load on, instead of a single stiffness"
    )
    coast_stages: Annotated[list[Stage], Field(min_length=1, max_length=50)] | None = Field(
        None, description="stages for negative torque, where they differ"
    )
    lash: Lash = Field(0.0, description="whole free angle, half to each side")
    stop_torque: Torque | None = Field(None, description="torque at which a single stage meets its stop")
    stop_stiffness: Stiffness | None = Field(None, description="stiffness of the stop")

    @model_validator(mode="after")
    def _consistent(self) -> Spring:
        check_spring(self)
        return self

    def law(self) -> Hinges:
        """The piecewise-linear law."""
        plain = [(self.stop_torque or _ENDLESS, self.stiffness or 0.0)]
        drive = _pairs(self.stages) if self.stages else plain
        coast = _pairs(self.coast_stages) if self.coast_stages else None
        return Hinges.staged(drive, coast=coast, lash=self.lash, stop_stiffness=self.stop_stiffness or 0.0)


class Friction(Block):
    """A friction washer: dry friction that sticks elastically before it slips."""

    friction_torque: Annotated[float, Quantity("torque", least=0)] = Field(
        0.0, description="of a friction washer beside the springs, when it slips; none at zero"
    )
    friction_stiffness: Stiffness | None = Field(
        None, description="of the washer while it sticks; where none is given, such that it sticks within ±0.1°"
    )

    @model_validator(mode="after")
    def _rubs(self) -> Friction:
        if self.friction_stiffness is not None and "friction_torque" not in self.model_fields_set:
            remedy = "give the torque at which the washer slips"
            raise ModelError("goes with friction_torque", where="friction_stiffness", remedy=remedy)
        return self

    def washer(self) -> Jenkins | None:
        """The washer's law; None without friction."""
        return washer(self.friction_torque, self.friction_stiffness) if self.friction_torque else None


class DampedSpring(Spring, Friction):
    """A spring with a viscous damper beside it, and a friction washer where there is one."""

    damping: Damping = Field(0.0, description="viscous, beside the spring")


def washer(torque: float, stiffness: float | None) -> Jenkins:
    """A friction washer's law, of a stiffness of its own or the one by default."""
    return Jenkins(torque, stiffness or torque / STICKS_WITHIN)


def check_spring(spring: Spring) -> None:
    """One way to give the stiffness, stages with rising torques, a stop with torque and stiffness."""
    if (spring.stiffness is None) == (spring.stages is None):
        found = "neither" if spring.stages is None else "both"
        raise ModelError("a spring has a stiffness or stages", found=found, allowed="one of the two")
    if spring.coast_stages and not spring.stages:
        raise ModelError("coast_stages go with stages", where="coast_stages", remedy="write the drive side as stages")
    if spring.stages and spring.stop_torque is not None:
        remedy = "write it as up_to of the last stage"
        raise ModelError("stop_torque goes with a single stiffness", where="stop_torque", remedy=remedy)
    for key, stages in (("stages", spring.stages), ("coast_stages", spring.coast_stages)):
        _check_stages(stages or [], key, spring.stop_stiffness is not None)
    if spring.stiffness is not None and (spring.stop_torque is None) != (spring.stop_stiffness is None):
        absent = "stop_torque" if spring.stop_torque is None else "stop_stiffness"
        raise ModelError(f"a stop needs {absent} as well", where=absent)


def _pairs(stages: list[Stage]) -> list[tuple[float, float]]:
    return [(_ENDLESS if stage.up_to is None else stage.up_to, stage.stiffness) for stage in stages]


def _check_stages(stages: list[Stage], key: str, stop: bool) -> None:
    """Torques must rise from stage to stage; only the last may have none, unless a stop follows it."""
    carried = 0.0
    for number, stage in enumerate(stages):
        last = number == len(stages) - 1
        where = f"{key}.{number}.up_to"
        if stage.up_to is None and (not last or stop):
            what = "the stop" if last else "the next stage"
            raise ModelError(f"the torque at which {what} begins is missing", where=where)
        if stage.up_to is not None and stage.up_to <= carried:
            allowed = f"> {carried:g} Nm, the stage before"
            found = f"{stage.up_to:g} Nm"
            raise ModelError("stages are listed with rising torques", where=where, found=found, allowed=allowed)
        carried = stage.up_to or carried
