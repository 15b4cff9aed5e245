"""The claim about engine starts through the resonance of a dual mass flywheel (G2)."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from torsional.files.scenario import load_scenario
from torsional.laws import Hinges
from torsional.model import Model
from torsional.results import dataset
from torsional.solvers.transient.drives import Governor
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.studies.claims.answers import floats
from torsional.studies.claims.base import Figure, Finding, claim
from torsional.studies.claims.trucks import Trucks, hinged, replaced
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import run_plan
from torsional.studies.scenarios.schedule import cylinders
from torsional.units import RPM

PHASES = 4
"""Moments of the first firing, spread over 0.1 s: what the crank happens to do then is averaged out."""
TORQUE, MIDDLE = 300.0, 40.0
"""Mean engine torque [Nm], and the speed [rad/s] its cylinders are asked at, of the run-ups by an ideal drive."""
FROM, TO, BEGIN = 200 * RPM, 600 * RPM, 0.1
"""Ends of those run-ups [rad/s], and when they begin [s]."""
HOLDING = (10.0, 30.0)
"""Proportional [Nms/rad] and integral [Nm/rad] torque on the crankshaft that makes it follow them."""
RAMP, STARTER = "time from 200 to 600 rpm [s]", "starter speed [rpm]"
STIFFNESS, DAMPING = "stiffness [kNm/rad]", "damping [Nms/rad]"
RAMPS = (3.2, 0.8, 0.2, 0.1)
STARTERS = (150.0, 250.0, 350.0)
STIFFNESSES = (13.0, 9.0, 6.0)
DAMPINGS = (10.0, 20.0, 40.0)
STRONG = "starter.torque=1500 Nm"
"""Of a starter that reaches its speed before the first firing, whichever of the speeds asked for that is."""


CONDITION = (
    "one-stage DMF, gearbox in neutral, cylinders burning over the crank's own angle, starts averaged over the moment "
    "of the first firing; run-ups by an ideal drive, whose torque follows the speed weakly"
)


def peak(plan: Plan, model: Model) -> float:
    """The largest angle of the DMF [deg]."""
    twist = run_plan(plan).twist.sel(element=model.landmarks.springs[0])
    return float(np.rad2deg(np.abs(twist.values).max()))


def started(model: Model, *settings: str) -> float:
    """`peak` of an engine start, averaged over the moment of the first firing."""
    moments = 0.6 + 0.1 * np.arange(PHASES) / PHASES
    firing = [f"firing_from={moment:g} s" for moment in moments]
    blocks = [load_scenario("engine_start", ["duration=1.5 s", when, *settings]) for when in firing]
    return float(np.mean([peak(planned(block, model), model) for block in blocks]))


def passed(model: Model, time: float) -> float:
    """`peak` of a run-up within a time [s] by an ideal drive, the engine burning as much whatever the time."""
    plan = planned(load_scenario("engine_stop"), model)
    speed = SpeedProfile.ramp(FROM, TO, time, BEGIN)
    drive = Governor(plan.crank, speed, acts_on=plan.crank, proportional=HOLDING[0], integral=HOLDING[1])
    motor = cylinders(model, MIDDLE, TORQUE, ((0.0,), (1.0,)))
    return peak(dataclasses.replace(plan, drives=(motor, drive), speed=speed, duration=BEGIN + time + 0.3), model)


def sprung(model: Model, rate: float) -> Model:
    """A copy with one linear stage [Nm/rad] up to a stop at the same torque as before."""
    spring = model.landmarks.springs[0]
    own = hinged(model, spring)
    stop = float(own.torque(max(own.stops)))
    law = Hinges.staged([(stop, rate)], stop_stiffness=float(own.tangent(2 * max(own.stops))))
    return replaced(model, spring, law=law)


@claim(
    "G2",
    "3.3",
    "An engine start passes the resonance of the DMF with high amplitudes; faster acceleration, a higher starter "
    "speed, a lower resonance and more damping help.",
    "in time, the largest angle of the DMF falls from the first to the last value of each: time of a run-up at "
    "constant engine torque, speed of the starter, stiffness of the springs, their damping",
)
def g2(trucks: Trucks) -> Finding:
    model = trucks.dmf
    spring = model.landmarks.springs[0]
    asked: dict[str, tuple[Sequence[float], Callable[[float], float]]] = {
        RAMP: (RAMPS, lambda time: passed(model, time)),
        STARTER: (STARTERS, lambda rpm: started(model, STRONG, f"starter.speed={rpm} rpm")),
        STIFFNESS: (STIFFNESSES, lambda rate: started(sprung(model, 1e3 * rate))),
        DAMPING: (DAMPINGS, lambda damping: started(replaced(model, spring, damping=damping))),
    }
    found = {name: [ask(value) for value in values] for name, (values, ask) in asked.items()}
    figures: dict[str, Figure] = {}
    for name, (values, _) in asked.items():
        figures |= {name: tuple(values), f"largest angle [deg], {name.split(' [')[0]}": floats(found[name])}
    stops = [np.rad2deg(max(hinged(sprung(model, 1e3 * rate), spring).stops)) for rate in STIFFNESSES]
    share = np.array(found[STIFFNESS]) / stops
    figures["over the angle of a stop at the same torque [-], stiffness"] = floats(share)
    helps = {name: row[-1] < row[0] for name, row in found.items()}
    angles = {"angle": (("time",), np.deg2rad(found[RAMP]), "relative_angle")}
    drawn = dataset(angles, {"time": (np.array(RAMPS), "time")}, analysis="claim G2")
    return Finding(all(helps.values()), CONDITION, figures, _reason(helps, bool(share[-1] < share[0])), drawn)


def _reason(helps: Mapping[str, bool], further: bool) -> str:
    told = [f"the {name.split(' [')[0]} does not help" for name, helped in helps.items() if not helped]
    if not helps[STIFFNESS] and further:
        told[-1:] = [
            "softer springs lower the resonance and the peak torque but swing by larger angles; over the angle of a "
            "stop at the same torque, which a lower stiffness moves away, they do reach less far"
        ]
    return "; ".join(told)
