"""In gear: pedal, clutch, shift, brake and road."""

from __future__ import annotations

from typing import Any

from torsional.components import Vehicle
from torsional.errors import ModelError
from torsional.files.scenario_blocks import Scenario, SpeedGovernor
from torsional.files.scenario_schema import ClutchEngagement, GearShift, Stall, TipIn, TipOut, TractionLoss
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.studies.scenarios import lines
from torsional.studies.scenarios.plan import Plan
from torsional.studies.scenarios.schedule import cylinders, fuel_cut, heat_for, pulse, ramp, speed_governor
from torsional.units import show

LOCKING = 0.5
"""Grip over the brake's torque where none is given: the wheels lock."""
CUT_WIDTH = 3.0
"""Speed [rad/s] over which an engine that stalls stops burning."""
ROLLING, GRAVITY = 0.006, 9.81
"""Rolling resistance of a truck's tyres over its weight, where no road load is given."""


def tip(block: TipIn | TipOut, model: Model) -> Plan:
    """Mean torque that changes in gear; the vehicle takes up what there was before."""
    gear = lines.gear_of(model, block.gear)
    within_stop(model, gear, before=block.before, after=block.after)
    most, shares = heat_for(model, block.speed, [block.before, block.after])
    times, values = ramp(block.at, block.within, *shares)
    motor = cylinders(model, block.speed, most, (times, values))
    wanted = ramp(block.at, block.within, block.before, block.after)
    return Plan(
        **_in_gear(block, model, lines.line_of(model, gear), gear),
        nodes=(model.landmarks.input,) if model.landmarks.input else (),
        drives=(motor,),
        speed=block.speed,
        start="vibrating",
        hold=lines.load_of(model),
        shown={"mean engine torque": (wanted, "torque")},
    )


def clutch_engagement(block: ClutchEngagement, model: Model) -> Plan:
    """The governor holds the engine's speed while the linings drag the vehicle along."""
    gear = lines.gear_of(model, block.gear, 0)
    if block.vehicle_at > block.speed:
        told = {"found": show(block.vehicle_at, "speed"), "allowed": f"up to {show(block.speed, 'speed')}"}
        raise ModelError("the engine must be the faster", where="vehicle_at", **told)
    within_stop(model, gear, torque=block.torque)
    line, flywheel = lines.with_linings(lines.line_of(model, gear), model, block.clutch)
    load = lines.load_of(model)
    line = lines.resisted(line, load, block.road_load or _road_load(model))
    most, _ = heat_for(model, block.speed, [block.torque])
    governor = SpeedGovernor.model_validate({"torque": block.torque, "droop": 0.1 * block.speed})
    drives = (
        cylinders(model, block.speed, most, ((0.0,), (0.0,))),
        speed_governor(governor, lines.crank_of(model), block.speed),
    )
    pressed = ramp(block.clutch.engages, block.clutch.within, 0.0, 1.0)
    return Plan(
        **_in_gear(block, model, line, gear, lines.LININGS),
        nodes=(model.landmarks.input,) if model.landmarks.input else (),
        drives=drives,
        speed=block.speed,
        lag=block.speed - block.vehicle_at,
        lagging=lines.behind(line, lines.LININGS, flywheel),
        levels={"clutch": pressed},
        shown={"clutch capacity": (_times(pressed, block.clutch.capacity), "torque")},
    )


def gear_shift(block: GearShift, model: Model) -> Plan:
    """The vehicle rolls as fast as in the old gear; the clutch brings the engine to the new gear's speed."""
    old = lines.gear_of(model, block.from_gear, -2, "from_gear")
    new = lines.gear_of(model, block.to_gear, -1, "to_gear")
    if old == new:
        raise ModelError("the gear stays the same", where="to_gear", found=f"'{new}'", remedy="name another one")
    within_stop(model, new, torque=block.torque)
    line, flywheel = lines.with_linings(lines.line_of(model, new), model, block.clutch)
    rolling = block.speed * model.gears[new].ratio / model.gears[old].ratio
    most, shares = heat_for(model, block.speed, [0.0, block.torque])
    pulls = ramp(block.torque_from, 0.1, *shares)
    pressed = ramp(block.clutch.engages, block.clutch.within, 0.0, 1.0)
    return Plan(
        **_in_gear(block, model, line, new, lines.LININGS),
        nodes=(model.landmarks.input,) if model.landmarks.input else (),
        drives=(cylinders(model, block.speed, most, pulls),),
        speed=block.speed,
        lag=block.speed - rolling,
        lagging=lines.behind(line, lines.LININGS, flywheel),
        levels={"clutch": pressed},
        shown={
            "clutch capacity": (_times(pressed, block.clutch.capacity), "torque"),
            "mean engine torque": (ramp(block.torque_from, 0.1, 0.0, block.torque), "torque"),
        },
    )


def stall(block: Stall, model: Model) -> Plan:
    """A brake on the wheels, the engine burning until it is too slow."""
    gear = lines.gear_of(model, block.gear)
    within_stop(model, gear, torque=block.torque)
    road = lines.gripping(lines.line_of(model, gear), block.tyres, block.grip or LOCKING * block.brake)
    line = lines.braked(road, block.node, block.brake)
    most, (share,) = heat_for(model, block.speed, [block.torque])
    crank = lines.crank_of(model)
    drives = (cylinders(model, block.speed, most, ((0.0,), (share,))), fuel_cut(crank, block.fuel_off, CUT_WIDTH))
    pressed = ramp(block.at, block.within, 0.0, 1.0)
    return Plan(
        **_in_gear(block, model, line, gear),
        nodes=(_turning(line, block.tyres), lines.load_of(model)),
        drives=drives,
        speed=block.speed,
        start="vibrating",
        hold=lines.load_of(model),
        stuck=(lines.ROAD,),
        levels={"brake": pressed},
        shown={"brake": (_times(pressed, block.brake), "torque")},
    )


def traction_loss(block: TractionLoss, model: Model) -> Plan:
    """Wheels that spin on a slippery stretch and meet dry road again."""
    gear = lines.gear_of(model, block.gear, len(model.gear_names) // 2)
    within_stop(model, gear, torque=block.torque)
    line = lines.gripping(lines.line_of(model, gear), block.tyres, block.grip, "grip")
    most, (share,) = heat_for(model, block.speed, [block.torque])
    grip = pulse(block.lost, block.found - block.lost, block.slippery, 1.0)
    return Plan(
        **_in_gear(block, model, line, gear),
        nodes=(_turning(line, block.tyres), lines.load_of(model)),
        drives=(cylinders(model, block.speed, most, ((0.0,), (share,))),),
        speed=block.speed,
        start="vibrating",
        hold=lines.load_of(model),
        stuck=(lines.ROAD,),
        levels={"grip": grip},
        shown={"grip": (grip, "ratio")},
    )


def within_stop(model: Model, gear: str, **torques: float) -> None:
    """Refuse mean engine torques at which an absorber spring rests on its stop; the names are those of the keys."""
    from torsional.solvers.operating import operated

    for key, torque in torques.items():
        _, point = operated(model, torque, gear or None)
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


def _road_load(model: Model) -> float:
    """Rolling resistance of the vehicle at its wheels [Nm]."""
    vehicle = next((part for part in model.components.values() if isinstance(part, Vehicle)), None)
    if vehicle is None:
        raise ModelError("the resistance of the road is not known", where="road_load", remedy="give road_load in Nm")
    return ROLLING * vehicle.mass * GRAVITY * vehicle.rolling_radius


def _times(knots: Any, factor: float) -> Any:
    return knots[0], tuple(factor * value for value in knots[1])


def _in_gear(block: Scenario, model: Model, line: Powertrain, gear: str, *watched: str) -> dict[str, Any]:
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
    }
