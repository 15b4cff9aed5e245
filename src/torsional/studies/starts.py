"""Engine starts and run-ups through the resonance of an absorber, in time: the largest angle, torque, acceleration."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.scenario import load_scenario
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import Variable, labelled
from torsional.solvers.modal import modal
from torsional.solvers.transient.drives import Governor
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.studies.answers import main_order, mode_of
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import run_plan
from torsional.studies.scenarios.schedule import cylinders
from torsional.studies.trucks import hinged, replaced, stiffness
from torsional.studies.trucks import sprung as linearised
from torsional.system import assemble
from torsional.units import RPM

PHASES = 4
"""Moments of the first firing, spread over 0.1 s: what the crank happens to do then is averaged out."""
FIRING, AFTER, STEP = 0.6, 0.5, 4e-4
"""First firing [s], how long a start is followed from there on, and the time step: half of it changes no peak by more
than 0.1 %."""
LOAD, MIDDLE = 0.12, 40.0
"""Mean engine torque over the full-load peak, and the speed [rad/s] its cylinders are asked at, of run-ups by an ideal
drive."""
BEGIN, BEYOND = 0.1, 0.3
"""When those run-ups begin [s], and how long they are followed beyond idle."""
HOLDING = (10.0, 30.0)
"""Proportional [Nms/rad] and integral [Nm/rad] torque on the crankshaft that makes it follow them, of a truck whose
full-load peak is 2500 Nm."""
PEAK = 2500.0


class Peaks(NamedTuple):
    """The largest of a start: angle [deg] and torque [Nm] of the springs, acceleration behind [rad/s²]."""

    angle: float
    torque: float
    acceleration: float


def spring_of(model: Model) -> str:
    """The absorber's first springs; ModelError for a model without any, whose start passes no such resonance."""
    if not model.landmarks.springs:
        remedy = "ask for a concept with springs, such as dmf"
        raise ModelError("the absorber has no springs", where=model.name, remedy=remedy)
    return model.landmarks.springs[0]


def peaks(run: xr.Dataset, model: Model, since: float = 0.0) -> Peaks:
    """The largest values of a run from a moment [s] on."""
    run, spring = run.isel(time=run.time.values >= since), spring_of(model)
    sizes = (
        run.twist.sel(element=spring),
        run.torque.sel(element=spring),
        run.acceleration.sel(node=model.landmarks.input),
    )
    twist, torque, acceleration = (float(np.abs(values.values).max()) for values in sizes)
    return Peaks(float(np.rad2deg(twist)), torque, acceleration)


def moments() -> Array:
    """When the first cylinder burns, in each of the starts that are averaged [s]."""
    return FIRING + 0.1 * np.arange(PHASES) / PHASES


def start(model: Model, moment: float, *settings: str) -> xr.Dataset:
    """One engine start in neutral, the first cylinder burning at a moment [s]."""
    told = [f"duration={moment + AFTER:g} s", f"step={STEP:g} s", f"firing_from={moment:g} s"]
    return run_plan(planned(load_scenario("engine_start", [*told, *settings]), model))


def started(model: Model, *settings: str, burning: bool = False) -> Peaks:
    """`peaks` of an engine start, averaged over the moment of the first firing; ``burning``: from there on alone."""
    found = [peaks(start(model, float(at), *settings), model, float(at) if burning else 0.0) for at in moments()]
    return Peaks(*(float(each) for each in np.mean(found, axis=0)))


def starter(model: Model, speed: float, torque: float = 0.6) -> tuple[str, str]:
    """Settings of a starter: its speed over idle, and its torque at standstill over the full-load peak.

    The torque is so high that its speed is reached before the first firing, whichever it is.
    """
    return (
        f"starter.torque={torque * model.full_load_peak():g} Nm",
        f"starter.speed={speed * model.operation.idle / RPM:g} rpm",
    )


def run_up(model: Model, time: float) -> xr.Dataset:
    """A run-up from a third of idle to idle within a time [s] by an ideal drive, the engine burning as much in each."""
    plan: Plan = planned(load_scenario("engine_stop", [f"step={STEP / 2:g} s"]), model)
    idle, scale = model.operation.idle, model.full_load_peak() / PEAK
    speed = SpeedProfile.ramp(idle / 3, idle, time, BEGIN)
    proportional, integral = (scale * gain for gain in HOLDING)
    drive = Governor(plan.crank, speed, acts_on=plan.crank, proportional=proportional, integral=integral)
    motor = cylinders(model, MIDDLE, LOAD * model.full_load_peak(), ((0.0,), (1.0,)))
    return run_plan(dataclasses.replace(plan, drives=(motor, drive), speed=speed, duration=BEGIN + time + BEYOND))


def passed(model: Model, time: float) -> Peaks:
    """`peaks` of a run-up within a time [s]."""
    return peaks(run_up(model, time), model)


def sprung(model: Model, rate: float) -> Model:
    """A copy with one linear stage [Nm/rad] up to a stop at the same torque as before."""
    spring = spring_of(model)
    own = hinged(model, spring)
    if not own.stops:
        return linearised(model, spring, rate)
    stop = float(own.torque(max(own.stops)))
    law = Hinges.staged([(stop, rate)], stop_stiffness=float(own.tangent(2 * max(own.stops))))
    return replaced(model, spring, law=law)


def stop_angle(model: Model) -> float:
    """The angle [deg] at which the springs meet their stop; infinite without one."""
    return float(np.rad2deg(max(hinged(model, spring_of(model)).stops, default=np.inf)))


def resonance(model: Model) -> float:
    """The speed [rpm] at which the firing order meets the absorber's mode in neutral, its springs linear."""
    spring = spring_of(model)
    linear = linearised(model, spring, stiffness(model, spring))
    found = modal(assemble(planned(load_scenario("engine_start"), linear).line))
    return 60.0 * float(found.frequency[mode_of(found, spring)]) / main_order(model)


GRID = 1e-3
"""Step of the times that histories are told at [s]."""
WORDS = {"run_up": "run-up within", "starter_speed": "starter speed", "stiffness": "stiffness", "damping": "damping"}
Compared = Mapping[str, tuple[str, Sequence[float], Sequence[xr.Dataset]]]


def histories(model: Model, runs: Compared) -> xr.Dataset:
    """Angles of the springs over time in runs by what is varied: its quantity, its values and a run for each.

    ``angle_{name}`` (name, time_{name}), not a number beyond the end of a run.
    """
    spring = spring_of(model)
    variables: dict[str, Variable] = {}
    coordinates: dict[str, tuple[Array, str]] = {}
    for name, (quantity, values, found) in runs.items():
        end = max(float(run.time[-1]) for run in found)
        time = np.arange(0.0, end, GRID)
        twists = [np.interp(time, run.time, run.twist.sel(element=spring), right=np.nan) for run in found]
        variables[f"angle_{name}"] = ((name, f"time_{name}"), np.array(twists), "relative_angle")
        coordinates |= {name: (np.array(values, dtype=float), quantity), f"time_{name}": (time, "time")}
    told = labelled(variables, coordinates, analysis="starts compared", model=model.name)
    for name in runs:
        told[f"angle_{name}"].attrs["panel"] = "angle of the springs"
        told[name].attrs["words"] = WORDS.get(name, "")
    return told
