"""`torsional check`: what a model file holds, how it stands under load, what looks wrong, its first modes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount
from torsional.cli.failures import complain
from torsional.cli.modes import in_gear
from torsional.cli.outputs import text_writer, written
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.exchange.documents import yaml_of
from torsional.files import warnings_of
from torsional.files.expand import vars_of
from torsional.model import Model
from torsional.quantities import named_modes
from torsional.solvers.equilibrium import OperatingPoint
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point
from torsional.system import System
from torsional.units import show

SHOWN_MODES = 6
USUAL_FIRST = (0.5, 2000.0)
"""First elastic mode [Hz] below or above which a unit is probably wrong."""

Document = dict[str, Any]


def run(request: Request, gear: str, torque: str, expand: bool) -> None:
    """Answer the command."""
    if expand:
        _expand(request)
        return
    model = request.model
    engaged, mean = inputs.one_gear(model, gear), inputs.torque(model, torque)
    document = _checked_model(model, engaged, mean)
    head = told_settings(request, gear=engaged, torque=amount(mean, "torque"))
    deliver(Answer("check", _tables(document, engaged, mean), {**head, **document}), request)
    if not (request.quiet or request.as_json):
        for warning in document["warnings"]:
            complain(warning, kind="warning")


def _checked_model(model: Model, gear: str, torque: float) -> Document:
    """Everything that is told of a model in one gear under a mean torque [Nm]."""
    system, point = at_operating_point(model, torque, gear)
    springs, elastic = list(standing(model, point)), list(_first_modes(model, system, inputs.speed(model, "")))
    warnings = [*warnings_of(model), *_doubts(elastic, torque, springs)]
    if not (system.connections.damping.any() or system.connections.loss_factor.any()):
        warnings.append("no part has any damping: at a resonance the response has no bound")
    return {"summary": summary(model, gear), "equilibrium": springs, "modes": elastic, "warnings": warnings}


def _expand(request: Request) -> None:
    if request.as_json:
        raise ModelError("the expanded model is YAML", where="--expand", remedy="leave --json out")
    text = yaml_of(request.model)
    if request.outputs:
        written({path: text_writer(text) for path in request.outputs})
    elif not request.quiet:
        print(text, end="")


def summary(model: Model, gear: str) -> Document:
    """What the file holds."""
    powertrain, operation, marks = model.powertrain(gear), model.operation, model.landmarks
    engine = model.engine
    told: Document = {
        "absorber": model.absorber.kind if model.absorber else None,
        "components": len(powertrain.components),
        "nodes": list(powertrain.nodes),
        "gears": {name: each.ratio for name, each in model.gears.items()},
        "idle": amount(operation.idle, "speed"),
        "speed": amount(list(operation.speed), "speed"),
        "landmarks": {key: value for key, value in vars_of(marks).items() if value},
    }
    if engine is not None:
        told["cylinders"] = engine.layout.cylinders
        told["displacement"] = amount(engine.displacement, "volume")
        told["full_load_peak"] = None if engine.full_load is None else amount(model.full_load_peak(), "torque")
    return told


def standing(model: Model, point: OperatingPoint) -> Iterator[Document]:
    """Every spring with a law, and the clutch, under the mean torque: twist, stage, distance to the stop ahead."""
    marks = (*model.landmarks.springs, model.landmarks.clutch)
    for i, (name, law) in enumerate(zip(point.names, point.laws, strict=True)):
        if law is not None or name in marks:
            left = point.distance_to_stop(name)
            yield {
                "connection": name,
                "torque": amount(float(point.torque[i]), "torque"),
                "travel": amount(float(point.angle[i]), "relative_angle"),
                "stiffness": amount(float(point.stiffness[i]), "stiffness"),
                "stage": point.stage(name),
                "to_stop": amount(None if math.isnan(left) else left, "relative_angle"),
            }


def _first_modes(model: Model, system: System, speed: float) -> Iterator[Document]:
    """The first elastic modes about the mean twist at a mean ``speed`` [rad/s], which tunes pendulums, by name."""
    found = modal(system, speed)
    names = named_modes(found, model.mode_groups)
    elastic = np.flatnonzero(found.frequency.values > 0)[:SHOWN_MODES]
    for i in elastic:
        yield {"name": names[i], "frequency": amount(float(found.frequency[i]), "frequency")}


def _doubts(elastic: Sequence[Document], torque: float, springs: Sequence[Document]) -> Iterator[str]:
    """Sentences about what the solved model shows."""
    low, high = USUAL_FIRST
    for mode in elastic[:1]:
        first = mode["frequency"]["value"]
        if not low <= first <= high:
            usual = f"unusual for a powertrain ({low:g} to {high:g} Hz)"
            yield f"the first elastic mode lies at {first:.4g} Hz, {usual}: check the units"
    for spring in springs:
        if spring["stage"] == "stop":
            yield f"{spring['connection']}: the mean torque of {show(torque, 'torque')} presses it onto its stop"


def _tables(document: Document, gear: str, torque: float) -> list[Table]:
    columns = [Column("connection"), Column("torque", "torque"), Column("travel", "relative_angle")]
    columns += [Column("stiffness", "stiffness"), Column("stage"), Column("to the stop", "relative_angle")]
    elastic = [Column("name"), Column("frequency", "frequency")]
    return [
        Table("Model", [Column("what"), Column("value")], list(_told(document["summary"]))),
        Table(f"Equilibrium at {show(torque, 'torque')}{in_gear(gear)}", columns, _rows(document["equilibrium"])),
        Table("First elastic modes there", elastic, _rows(document["modes"])),
    ]


def _rows(documents: Sequence[Document]) -> list[list[object]]:
    return [[_bare(value) for value in row.values()] for row in documents]


def _bare(value: Any) -> Any:
    return value["value"] if isinstance(value, dict) else value


def _told(told: Document) -> Iterator[list[object]]:
    """The summary in words."""
    for key, value in told.items():
        if value not in (None, {}, []):
            yield [key.replace("_", " "), _words(key, value)]


def _words(key: str, value: Any) -> str:
    quantity = {"idle": "speed", "speed": "speed", "displacement": "volume", "full_load_peak": "torque"}.get(key)
    if quantity:
        numbers = _bare(value)
        return " to ".join(show(x, quantity) for x in (numbers if isinstance(numbers, list) else [numbers]))
    if key == "gears":
        return ", ".join(f"{name}: {ratio:g}" for name, ratio in value.items())
    if key == "landmarks":
        places = {name: [each] if isinstance(each, str) else each for name, each in value.items()}
        return "; ".join(f"{name} {', '.join(each)}" for name, each in places.items())
    return f"{len(value)}: {', '.join(value)}" if isinstance(value, list) else str(value)
