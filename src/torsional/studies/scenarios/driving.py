"""In gear: pedal, clutch, brake and road."""

from __future__ import annotations

from typing import Any

from torsional.errors import ModelError
from torsional.files.scenario_blocks import Scenario, SpeedGovernor
from torsional.files.scenario_schema import ClutchEngagement, Stall, TipIn, TipOut, TractionLoss
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.operating import mean_state
from torsional.solvers.transient.acting import Drive
from torsional.studies.scenarios import lines, sizes
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.schedule import cylinders, fuel_cut, heat_for, pulse, ramp, speed_governor
from torsional.system import assemble
from torsional.units import show

LOWEST, LOW, MIDDLE = 1.0 / 7.0, 2.0 / 7.0, 4.0 / 7.0
"""Shares of the way up the operating range at which an engine runs where no speed is given."""
LOCKING = 0.5
"""Grip over the brake's torque where none is given: the wheels lock."""
CUT_WIDTH = 3.0
"""Speed [rad/s] over which an engine that stalls stops burning."""
ROLLING = 0.006
"""Rolling resistance of a truck's tyres over its weight, where no road load is given."""


def tip(block: TipIn | TipOut, model: Model) -> Plan:
    """Mean torque that changes in gear; the vehicle takes up what there was before."""
    speed = sizes.speed(model, block.speed, LOW)
    gear = lines.gear_of(model, block.gear)
    rising = block.scenario == "tip_in"
    before = sizes.torque(model, block.before, 0.0 if rising else 0.6, "before")
    after = sizes.torque(model, block.after, 0.6 if rising else 0.0, "after")
    _ordered(rising, before, after)
    within_stop(model, gear, before=before, after=after)
    most, shares = heat_for(model, speed, [before, after])
    times, values = ramp(block.at, block.within, *shares)
    motor = cylinders(model, speed, most, (times, values))
    wanted = ramp(block.at, block.within, before, after)
    return Plan(
        **in_gear(block, model, lines.line_of(model, gear), gear),
        nodes=(model.landmarks.input,) if model.landmarks.input else (),
        drives=(motor,),
        speed=speed,
        start="vibrating",
        hold=lines.load_of(model),
        shown={"mean engine torque": (wanted, "torque")},
    )


def clutch_engagement(block: ClutchEngagement, model: Model) -> Plan:
    """The governor holds the engine's speed while the linings drag the vehicle along."""
    speed = sizes.speed(model, block.speed, LOW)
    gear = lines.gear_of(model, block.gear, 0)
    if block.vehicle_at > speed:
        told = {"found": show(block.vehicle_at, "speed"), "allowed": f"up to {show(speed, 'speed')}"}
        raise ModelError("the engine must be the faster", where="vehicle_at", **told)
    torque = sizes.torque(model, block.torque, 0.3, "torque")
    within_stop(model, gear, torque=torque)
    line, flywheel, capacity = lines.with_linings(lines.line_of(model, gear), model, block.clutch)
    load = lines.load_of(model)
    line = lines.resisted(line, load, sizes.at_wheels(model, block.road_load, ROLLING, "road_load"))
    drives = _kept_at(model, speed, torque)
    pressed = ramp(block.clutch.engages, block.clutch.within, 0.0, 1.0)
    return Plan(
        **in_gear(block, model, line, gear, lines.LININGS),
        nodes=tuple(node for node in (model.landmarks.input, load) if node),
        drives=drives,
        speed=speed,
        lag=speed - block.vehicle_at,
        lagging=lines.behind(line, lines.LININGS, flywheel),
        levels={"clutch": pressed},
        shown={"clutch capacity": (_times(pressed, capacity), "torque")},
    )


def _kept_at(model: Model, speed: float, torque: float) -> tuple[Drive, ...]:
    """Engine and governor of a speed; without torque the heat is that of no load, whatever the speed does."""
    most, (none, _) = heat_for(model, speed, [0.0, torque])
    if not torque:
        return (cylinders(model, speed, most, ((0.0,), (none,))),)
    governor = SpeedGovernor.model_validate({"torque": torque, "droop": 0.1 * speed})
    return cylinders(model, speed, most, ((0.0,), (0.0,))), speed_governor(governor, lines.crank_of(model), speed)


def stall(block: Stall, model: Model) -> Plan:
    """A brake on the wheels, the engine burning until it is too slow."""
    speed = sizes.speed(model, block.speed, LOWEST)
    gear = lines.gear_of(model, block.gear)
    torque = sizes.torque(model, block.torque, 0.25, "torque")
    within_stop(model, gear, torque=torque)
    brake = sizes.at_wheels(model, block.brake, 0.2, "brake")
    road = lines.gripping(lines.line_of(model, gear), block.tyres, block.grip or LOCKING * brake)
    line = lines.braked(road, block.node, brake)
    most, (share,) = heat_for(model, speed, [torque])
    crank = lines.crank_of(model)
    drives = (
        cylinders(model, speed, most, ((0.0,), (share,))),
        fuel_cut(crank, block.fuel_off or 0.5 * model.operation.idle, CUT_WIDTH),
    )
    pressed = ramp(block.at, block.within, 0.0, 1.0)
    return Plan(
        **in_gear(block, model, line, gear),
        nodes=(_turning(line, block.tyres), lines.load_of(model)),
        drives=drives,
        speed=speed,
        start="vibrating",
        hold=lines.load_of(model),
        stuck=(lines.ROAD,),
        levels={"brake": pressed},
        shown={"brake": (_times(pressed, brake), "torque")},
    )


def traction_loss(block: TractionLoss, model: Model) -> Plan:
    """Wheels that spin on a slippery stretch and meet dry road again."""
    speed = sizes.speed(model, block.speed, LOW)
    gear = lines.gear_of(model, block.gear, len(model.gear_names) // 2)
    torque = sizes.torque(model, block.torque, 0.6, "torque")
    within_stop(model, gear, torque=torque)
    held = sizes.at_wheels(model, block.grip, 0.3, "grip")
    line = lines.gripping(lines.line_of(model, gear), block.tyres, held, "grip")
    most, (share,) = heat_for(model, speed, [torque])
    grip = pulse(block.lost, block.found - block.lost, block.slippery, 1.0)
    return Plan(
        **in_gear(block, model, line, gear),
        nodes=(_turning(line, block.tyres), lines.load_of(model)),
        drives=(cylinders(model, speed, most, ((0.0,), (share,))),),
        speed=speed,
        start="vibrating",
        hold=lines.load_of(model),
        stuck=(lines.ROAD,),
        levels={"grip": grip},
        shown={"grip": (grip, "ratio")},
    )


def within_stop(model: Model, gear: str, **torques: float) -> None:
    """Refuse mean engine torques at which an absorber spring rests on its stop; the names are those of the keys."""
    system = assemble(model.powertrain(gear))
    if not system.elements:
        return
    for key, torque in torques.items():
        point = mean_state(model, system, torque)
        for spring in model.landmarks.springs:
            if point.stage(spring) == "stop":
                law = point.laws[point.names.index(spring)]
                most = float(law.torque(max(getattr(law, "stops", (0.0,))))) if law is not None else 0.0
                share = torque / float(point.torque[point.names.index(spring)])
                told = {"found": show(torque, "torque"), "allowed": f"up to {show(most * share, 'torque')}"}
                remedy = f"ask for less, or give {spring} a later stop"
                raise ModelError(f"'{spring}' would rest on its stop", where=key, **told, remedy=remedy)


def _turning(line: Powertrain, tyres: str) -> str:
    """The node on the rim's side of the tyres."""
    return str(line[tyres].b)


def _ordered(rising: bool, before: float, after: float) -> None:
    if not (after > before if rising else after < before):
        allowed = f"{'more' if rising else 'less'} than before, {show(before, 'torque')}"
        told = {"found": show(after, "torque"), "allowed": allowed}
        other = "tip_out" if rising else "tip_in"
        raise ModelError("the torque changes the other way", where="after", **told, remedy=f"or choose {other}")


def _times(knots: Any, factor: float) -> Any:
    return knots[0], tuple(factor * value for value in knots[1])


def in_gear(block: Scenario, model: Model, line: Powertrain, gear: str, *watched: str) -> dict[str, Any]:
    """What a plan in gear takes from scenario and model."""
    marks = model.landmarks
    return {
        "title": f"{block.title}: {block.name or model.name}" + (f", gear {gear}" if gear else ""),
        "line": line,
        "duration": block.duration,
        "step": block.step,
        "crank": lines.crank_of(model),
        "springs": tuple(name for name in marks.springs if name in line.components),
        "watched": tuple(name for name in watched or (marks.clutch,) if name in line.components),
        "gear": gear,
        "inner": lines.inner_parts(model),
    }
