"""The claim about engine starts through the resonance of a dual mass flywheel (G2)."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from torsional.files.scenario import load_scenario
from torsional.laws import Hinges
from torsional.model import Model
from torsional.results import labelled
from torsional.solvers.modal import modal
from torsional.solvers.transient.drives import Governor
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.studies.answers import falling, floats, main_order, mode_of
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.running import run_plan
from torsional.studies.scenarios.schedule import cylinders
from torsional.studies.trucks import Trucks, hinged, replaced, stiffness
from torsional.studies.trucks import sprung as linearised
from torsional.system import assemble
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
STIFFNESSES = (13.0, 9.0, 6.0, 3.0)
DAMPINGS = (10.0, 20.0, 40.0)
FACTORS = (1.0, 2.0, 4.0)
"""Of inertias."""
STRONG = "starter.torque=1500 Nm"
"""Of a starter that reaches its speed before the first firing, whichever of the speeds asked for that is."""
FAST = (STRONG, "starter.speed=450 rpm")
"""A starter that turns faster than the resonance of softer springs: about 400 rpm against compression."""


CONDITION = (
    "one-stage DMF, gearbox in neutral, cylinders burning over the crank's own angle, starts averaged over the moment "
    "of the first firing; run-ups by an ideal drive, whose torque follows the speed weakly; other stiffnesses up to a "
    "stop at the same torque, 3500 Nm"
)
PROVISO = (
    "softer springs help by what they pass on, their peak torque and the gearbox's acceleration, and by the share of "
    "the way to a stop at the same torque; by the angle itself a lower resonance helps only where more inertia on the "
    "crankshaft lowers it, or while it falls below the starter's speed"
)


class Peaks(NamedTuple):
    """Of a start: angle [deg] and torque [Nm] of the DMF, acceleration at the gearbox input [rad/s²], the largest."""

    angle: float
    torque: float
    acceleration: float


def peaks(plan: Plan, model: Model, since: float = 0.0) -> Peaks:
    """The largest values from a moment [s] on."""
    run, spring = run_plan(plan), model.landmarks.springs[0]
    run = run.isel(time=run.time.values >= since)
    sizes = (
        run.twist.sel(element=spring),
        run.torque.sel(element=spring),
        run.acceleration.sel(node=model.landmarks.input),
    )
    twist, torque, acceleration = (float(np.abs(values.values).max()) for values in sizes)
    return Peaks(float(np.rad2deg(twist)), torque, acceleration)


def started(model: Model, *settings: str, burning: bool = False) -> Peaks:
    """`peaks` of an engine start, averaged over the moment of the first firing; ``burning``: from there on alone."""
    found = []
    for moment in 0.6 + 0.1 * np.arange(PHASES) / PHASES:
        block = load_scenario("engine_start", ["duration=1.5 s", f"firing_from={moment:g} s", *settings])
        found.append(peaks(planned(block, model), model, moment if burning else 0.0))
    return Peaks(*(float(each) for each in np.mean(found, axis=0)))


def passed(model: Model, time: float) -> Peaks:
    """`peaks` of a run-up within a time [s] by an ideal drive, the engine burning as much whatever the time."""
    plan = planned(load_scenario("engine_stop"), model)
    speed = SpeedProfile.ramp(FROM, TO, time, BEGIN)
    drive = Governor(plan.crank, speed, acts_on=plan.crank, proportional=HOLDING[0], integral=HOLDING[1])
    motor = cylinders(model, MIDDLE, TORQUE, ((0.0,), (1.0,)))
    return peaks(dataclasses.replace(plan, drives=(motor, drive), speed=speed, duration=BEGIN + time + 0.3), model)


def sprung(model: Model, rate: float) -> Model:
    """A copy with one linear stage [Nm/rad] up to a stop at the same torque as before."""
    spring = model.landmarks.springs[0]
    own = hinged(model, spring)
    stop = float(own.torque(max(own.stops)))
    law = Hinges.staged([(stop, rate)], stop_stiffness=float(own.tangent(2 * max(own.stops))))
    return replaced(model, spring, law=law)


def resonance(model: Model) -> float:
    """The speed [rpm] at which the firing order meets the DMF's mode in neutral, its springs linear."""
    spring = model.landmarks.springs[0]
    linear = linearised(model, spring, stiffness(model, spring))
    found = modal(assemble(planned(load_scenario("engine_start"), linear).line))
    return 60.0 * float(found.frequency[mode_of(found, spring)]) / main_order(model)


@claim(
    "G2",
    "3.3",
    "An engine start passes the resonance of the DMF with high amplitudes; faster acceleration, a higher starter "
    "speed, a lower resonance and more damping help.",
    "in time, the largest angle of the DMF falls from the first to the last value of each: time of a run-up at "
    "constant engine torque, speed of the starter, stiffness of the springs, their damping; where it does not, peak "
    "torque, gearbox acceleration and share of the way to the stop are told beside it",
)
def g2(trucks: Trucks) -> Finding:
    model = trucks.dmf
    spring = model.landmarks.springs[0]
    asked: dict[str, tuple[Sequence[float], Callable[[float], Peaks]]] = {
        RAMP: (RAMPS, lambda time: passed(model, time)),
        STARTER: (STARTERS, lambda rpm: started(model, STRONG, f"starter.speed={rpm} rpm")),
        STIFFNESS: (STIFFNESSES, lambda rate: started(sprung(model, 1e3 * rate))),
        DAMPING: (DAMPINGS, lambda damping: started(replaced(model, spring, damping=damping))),
    }
    found = {name: [ask(value) for value in values] for name, (values, ask) in asked.items()}
    figures: dict[str, Figure] = {}
    for name, (values, _) in asked.items():
        angles = [each.angle for each in found[name]]
        figures |= {name: tuple(values), f"largest angle [deg], {name.split(' [')[0]}": floats(angles)}
    lower = softer(model, found[STIFFNESS])
    passed_on = all(falling(np.array(values, dtype=float)) for values in lower.values())
    helps = {name: row[-1].angle < row[0].angle for name, row in found.items()}
    others = all(helped for name, helped in helps.items() if name != STIFFNESS)
    angles_by = {"angle": (("time",), np.deg2rad([each.angle for each in found[RAMP]]), "relative_angle")}
    drawn = labelled(angles_by, {"time": (np.array(RAMPS), "time")}, analysis="claim G2")
    reason = "" if all(helps.values()) else _reason(helps)
    proviso = PROVISO if others and passed_on and not helps[STIFFNESS] else ""
    good = others and (helps[STIFFNESS] or passed_on)
    return Finding(good, CONDITION, figures | lower | elsewhere(model), reason, drawn, proviso)


def softer(model: Model, found: Sequence[Peaks]) -> dict[str, Figure]:
    """Of starts with softer springs: where the resonance lies, and peaks other than the angle."""
    spring, models = model.landmarks.springs[0], [sprung(model, 1e3 * rate) for rate in STIFFNESSES]
    stops = [np.rad2deg(max(hinged(each, spring).stops)) for each in models]
    return {
        "firing order at the resonance [rpm], stiffness": floats([resonance(each) for each in models]),
        "peak torque of the DMF [Nm], stiffness": floats([each.torque for each in found]),
        "peak acceleration of the gearbox input [rad/s²], stiffness": floats([each.acceleration for each in found]),
        "over the angle of a stop at the same torque [-], stiffness": floats(
            [each.angle / stop for each, stop in zip(found, stops, strict=True)]
        ),
    }


def elsewhere(model: Model) -> dict[str, Figure]:
    """A starter faster than the resonance, a resonance lowered by inertia, and other dampings with softer springs."""
    figures: dict[str, Figure] = {
        "largest angle from the first firing on [deg], stiffness, starter near 400 rpm": floats(
            [started(sprung(model, 1e3 * rate), *FAST, burning=True).angle for rate in STIFFNESSES]
        )
    }
    for node in ("primary", "secondary"):
        own: Any = model.components[node]
        heavier = [replaced(model, node, inertia=factor * own.inertia) for factor in FACTORS]
        figures |= {
            f"firing order at the resonance [rpm], inertia of {node} times 1, 2, 4": floats(
                [resonance(each) for each in heavier]
            ),
            f"largest angle [deg], inertia of {node} times 1, 2, 4": floats([started(each).angle for each in heavier]),
        }
    for damping in (DAMPINGS[0], DAMPINGS[-1]):
        spring, ends = model.landmarks.springs[0], (STIFFNESSES[0], STIFFNESSES[-1])
        damped = [started(replaced(sprung(model, 1e3 * rate), spring, damping=damping)) for rate in ends]
        at = f"stiffness {ends[0]:g} and {ends[1]:g} kNm/rad, damping {damping:g} Nms/rad"
        figures |= {
            f"largest angle [deg], {at}": floats([each.angle for each in damped]),
            f"peak torque of the DMF [Nm], {at}": floats([each.torque for each in damped]),
        }
    return figures


def _reason(helps: Mapping[str, bool]) -> str:
    told = [f"the {name.split(' [')[0]} does not help by the angle" for name, helped in helps.items() if not helped]
    if not helps[STIFFNESS]:
        told.append(
            "the first strokes and the crank's own acceleration turn springs by a torque over their stiffness, which "
            "grows faster than the resonance's share falls; more inertia of the secondary adds to that torque"
        )
    return "; ".join(told)
