"""The engine alone, in neutral: it starts, stops, and idles when a torque disturbs it."""

from __future__ import annotations

from typing import Any

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.files.scenario_schema import EngineStart, EngineStop, IdlePulse
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.studies.scenarios import sizes
from torsional.studies.scenarios.lines import crank_of, in_neutral, inner_parts
from torsional.studies.scenarios.plan import Plan, Release
from torsional.studies.scenarios.schedule import (
    cylinders,
    heat_for,
    idle_keeper,
    pulse,
    speed_governor,
    starter_motor,
    torque_pulse,
)
from torsional.units import show

LEAST_OVERRUN = 1.1
"""A starter's own speed times this is the least at which it is taken to be overrun by an engine that runs."""
ANGLES = 2881
"""Crank angles of one cycle at which the resting place is looked for."""


def engine_start(block: EngineStart, model: Model) -> Plan:
    """Starter from rest, heat from the first firing on, as much as the governor asks for."""
    crank, idle = crank_of(model), block.governor.speed or model.operation.idle
    most = sizes.torque(model, block.governor.torque, 0.4, "governor.torque")
    motor = cylinders(model, idle, most, ((0.0,), (0.0,)))
    starter = starter_motor(block.starter, crank, sizes.torque(model, block.starter.torque, 0.5, "starter.torque"))
    governor = speed_governor(block.governor, crank, idle, block.firing_from)
    marks = {"starter": (pulse(0.0, block.starter.until, 1.0), ""), "firing": (pulse(block.firing_from, 1e9, 1.0), "")}
    told: dict[str, Any] = {
        "drives": (motor, starter, governor),
        "shown": marks,
        "release": _release(block, model, idle),
    }
    return Plan(**_alone(block, model, in_neutral(model)), **told, speed=0.0, turned=resting(motor))


def _release(block: EngineStart, model: Model, idle: float) -> Release:
    """When the starter is off for good: beyond its own speed, which it does not reach by itself."""
    own = block.starter
    speed = max(0.5 * (own.speed + idle), LEAST_OVERRUN * own.speed) if own.release is None else own.release
    if speed <= own.speed:
        told = {"found": show(speed, "speed"), "allowed": f"more than the starter's own {show(own.speed, 'speed')}"}
        raise ModelError("the starter never gets there by itself", where="starter.release", **told)

    def off(at: float) -> Plan:
        return engine_start(block.model_copy(update={"starter": own.model_copy(update={"until": at})}), model)

    return Release(speed, own.speed, own.until, off)


def engine_stop(block: EngineStop, model: Model) -> Plan:
    """Heat for idle without load up to the moment, none from there on."""
    speed = block.speed or model.operation.idle
    motor = cylinders(model, speed, *_heat(model, speed, block.fuel_off))
    marks = {"fuel": (pulse(0.0, block.fuel_off, 1.0), "")}
    line = in_neutral(model)
    return Plan(**_alone(block, model, line), **_idling(model), drives=(motor,), speed=speed, shown=marks)


def idle_pulse(block: IdlePulse, model: Model) -> Plan:
    """Idle without load, a torque of some milliseconds on a node, and a slow governor that brings the speed back."""
    speed, line, node = block.speed or model.operation.idle, in_neutral(model), block.node or crank_of(model)
    if node not in line.nodes:
        told = {"found": f"'{node}'", "remedy": nearest(node, line.nodes)}
        raise ModelError("there is no such node in neutral", where="node", **told)
    most, (share, _) = heat_for(model, speed, [0.0, sizes.torque(model, None, 0.4, "operation.idle")])
    motor = cylinders(model, speed, most, ((0.0,), (share,)))
    back = idle_keeper(crank_of(model), speed, share)
    height = sizes.torque(model, block.pulse, 0.2, "pulse")
    pushed = torque_pulse(node, block.at, block.length, height)
    marks = {"pulse": (pulse(block.at, block.length, height), "torque")}
    return Plan(**_alone(block, model, line), **_idling(model), drives=(motor, pushed, back), speed=speed, shown=marks)


def resting(motor: CylinderTorques) -> float:
    """The crank angle [rad] at which compression leaves the engine standing: no torque, pushed back from either side.

    Friction is taken as none; of several such angles the first one after firing of cylinder 1.
    """
    angle = np.linspace(0.0, 4 * np.pi, ANGLES)
    torque = np.sum([profile.at(angle) - profile.mean for profile in motor.profiles()[0]], axis=0)
    falls = np.flatnonzero((torque[:-1] > 0) & (torque[1:] <= 0))
    if not falls.size:
        return 0.0
    i = falls[0]
    return float(angle[i] + (angle[i + 1] - angle[i]) * torque[i] / (torque[i] - torque[i + 1]))


def _heat(model: Model, speed: float, until: float) -> tuple[float, tuple[tuple[float, ...], tuple[float, ...]]]:
    """Torque and heat of an engine without load, up to a moment [s]."""
    most, (share,) = heat_for(model, speed, [0.0])
    return most, ((0.0, until, until), (share, share, 0.0))


def _idling(model: Model) -> dict[str, Any]:
    """In steady vibration; what the engine's mean torque is off nought is taken up at the crankshaft."""
    return {"start": "vibrating", "hold": crank_of(model)}


def _alone(block: EngineStart | EngineStop | IdlePulse, model: Model, line: Powertrain) -> dict[str, Any]:
    marks = model.landmarks
    return {
        "title": f"{block.title}: {block.name or model.name}",
        "line": line,
        "duration": block.duration,
        "step": block.step,
        "crank": crank_of(model),
        "springs": tuple(name for name in marks.springs if name in line.components),
        "watched": tuple(name for name in (marks.clutch,) if name in line.components),
        "nodes": tuple(node for node in (marks.input,) if node in line.nodes),
        "gear": "neutral",
        "inner": inner_parts(model),
    }
