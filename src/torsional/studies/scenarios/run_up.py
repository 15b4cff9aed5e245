"""A model in gear at one speed or running up, driven by its cylinders, the speed given as by an ideal drive."""

from __future__ import annotations

import math

import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.solvers.transient.drives import Governor
from torsional.solvers.transient.run import Progress
from torsional.solvers.transient.speed_profile import SpeedProfile, as_speed
from torsional.studies.scenarios import lines
from torsional.studies.scenarios.driving import within_stop
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import run_plan
from torsional.system import assemble
from torsional.units import show

SLOWLY = 1.0
"""How fast a mean speed that is off comes back [1/s]."""


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
    vibration, the mean torque is taken up where the model's load is.  What the vibration loses in dampers
    a slow drive at the load makes good, see `_made_good`.  Raises ModelError for a torque that rests on a stop, and for
    a duration or a step that is none.

    Dataset of `transient` with what `torsional.studies.scenarios.figures.read_off` adds.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> run = run_up(truck, 1000 * torsional.RPM, 1000.0, 0.1)
    >>> round(float(run.torque_highest.sel(element="dmf")))  # Nm
    1156
    """
    for name, value in (("duration", duration), ("step", step)):
        if value is not None and not 0 < value < math.inf:
            raise ModelError("must be a positive time", where=name, found=show(value, "time"))
    within_stop(model, gear, torque=torque)
    turning = as_speed(speed)
    marks = model.landmarks
    line, load = lines.line_of(model, gear), lines.load_of(model)
    plan = Plan(
        title="",
        line=line,
        drives=(CylinderTorques.of(model, sum(turning.range) / 2, torque), _made_good(line, turning, load)),
        speed=turning,
        duration=duration,
        crank=lines.crank_of(model),
        springs=tuple(name for name in marks.springs if name in line.components),
        start="vibrating",
        hold=load,
        watched=tuple(name for name in (marks.clutch,) if name in line.components),
        step=step,
        gear=gear,
        following=math.inf,
        inner=lines.inner_parts(model),
    )
    return run_plan(plan, progress)


def _made_good(line: Powertrain, speed: SpeedProfile, node: str) -> Governor:
    """The ideal drive at a ``node``: the speed of a ``line`` stays what it shall be [rad/s] in the mean.

    Constant mean torques do not keep it: what a vibration loses in dampers is taken from the rotation, which slows down
    by power/(J Ω).  T = 2 J ω e + J ω² ∫ e dt, so slow that it leaves vibrations alone.
    """
    system = assemble(line)
    ratio = float(system.speed_ratio[system.node_index(node)])
    inertia, rate = float(system.M.sum()) / ratio**2, SLOWLY
    wanted = SpeedProfile(speed.times, tuple(ratio * each for each in speed.speeds))
    return Governor(node, wanted, acts_on=node, proportional=2 * inertia * rate, integral=inertia * rate**2)
