"""A model in gear at one speed or running up, driven by its cylinders, the speed given as by an ideal drive."""

from __future__ import annotations

import math

import xarray as xr

from torsional.arguments import checked
from torsional.model import Model
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.solvers.transient.run import Progress
from torsional.solvers.transient.speed_profile import SpeedProfile, as_speed
from torsional.studies.scenarios import lines
from torsional.studies.scenarios.driving import within_stop
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import run_plan


@checked
def run_up(
    model: Model,
    speed: float | SpeedProfile,
    torque: float,
    duration: float,
    gear: str = "",
    *,
    step: float | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Motion of a ``model`` in a ``gear`` at a mean engine ``torque`` [Nm] over a ``duration`` [s], with its figures.

    The mean ``speed`` [rad/s] stays or follows a profile, whatever torque that takes; cylinders burn over the crank's
    own angle, their masses move exactly, friction and pressures are those at the middle speed.  It begins in steady
    vibration, the mean torque is taken up where the model's load is.  Raises ModelError for a torque that rests on a
    stop.

    Dataset of `transient` with what `torsional.studies.scenarios.figures.read_off` adds.
    """
    within_stop(model, gear, torque=torque)
    turning = as_speed(speed)
    marks = model.landmarks
    line = lines.line_of(model, gear)
    plan = Plan(
        title="",
        line=line,
        drives=(CylinderTorques.of(model, sum(turning.range) / 2, torque),),
        speed=turning,
        duration=duration,
        crank=lines.crank_of(model),
        springs=tuple(name for name in marks.springs if name in line.components),
        start="vibrating",
        hold=lines.load_of(model),
        watched=tuple(name for name in (marks.clutch,) if name in line.components),
        step=step,
        gear=gear,
        following=math.inf,
        inner=lines.inner_parts(model),
    )
    return run_plan(plan, progress)
