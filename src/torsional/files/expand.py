"""A model written out as components alone: what its blocks stand for."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, get_args

from torsional.arguments import checked
from torsional.components import Component
from torsional.errors import ModelError
from torsional.files.schema.document import VERSION
from torsional.files.schema.making import kinds
from torsional.files.schema.parts import PartBlock
from torsional.laws import Jenkins, Law
from torsional.model import Gear, Model
from torsional.stamps import SpeedSwitch

_TYPES: dict[Any, str] = {}
for _kind in kinds(PartBlock):  # of two for one component the first is the plain one
    _TYPES.setdefault(_kind.makes, get_args(_kind.model_fields["type"].annotation)[0])


@checked
def expanded(model: Model) -> dict[str, Any]:
    """A model as a document of components, in SI, that makes the same matrices when it is read as a model file.

    The engine stays a block, since it is no part of the line but what excites it.  ModelError for an engine or a
    component that did not come from a model file and that the file format does not know.

    >>> from torsional.components import Inertia
    >>> from torsional.model import Landmarks, Model
    >>> expanded(Model("disc", {"disc": Inertia(2.0)}, Landmarks()))["components"]
    {'disc': {'type': 'inertia', 'inertia': 2.0}}
    """
    document: dict[str, Any] = {"torsional": VERSION, "name": model.name}
    document |= {key: model.document[key] for key in ("description", "engine") if key in model.document}
    if model.engine is not None and "engine" not in document:
        raise ModelError("the engine did not come from a model file", where="engine", remedy="replace it by None first")
    document["components"] = _written(model.components)
    document |= {"gears": {name: _gear(gear) for name, gear in model.gears.items()}} if model.gears else {}
    document["operation"] = _operation(model)
    landmarks = {key: _plain(value) for key, value in vars_of(model.landmarks).items() if value}
    return document | ({"landmarks": landmarks} if landmarks else {})


def vars_of(value: Any) -> dict[str, Any]:
    """The fields of a dataclass, as they stand."""
    return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}


def _gear(gear: Gear) -> dict[str, Any]:
    return {"ratio": gear.ratio, "components": _written(gear.components)}


def _operation(model: Model) -> dict[str, Any]:
    operation = model.operation
    torque = "full_load" if operation.torque is None else list(operation.torque)
    return {"idle": operation.idle, "speed": list(operation.speed), "torque": torque}


def _written(parts: Mapping[str, Component]) -> dict[str, Any]:
    return {name: _component_document(part, name) for name, part in parts.items()}


def _component_document(part: Component, name: str = "") -> dict[str, Any]:
    """A component as the model file writes it: its type and what differs from the defaults."""
    kind: Any = type(part)
    if kind not in _TYPES:
        raise ModelError("the file format has no such component", where=name, found=kind.__name__)
    given: dict[str, Any] = {"type": _TYPES[kind]}
    for field in dataclasses.fields(kind):
        value = getattr(part, field.name)
        if value != field.default:
            given |= _law(value, name) if isinstance(value, Law) else {field.name: _plain(value)}
    return given


def _plain(value: Any) -> Any:
    """Numbers, texts, lists and mappings only."""
    if isinstance(value, SpeedSwitch):
        return {"above": value.speed, "inertia": value.inertia, "hysteresis": value.hysteresis}
    if dataclasses.is_dataclass(value):
        return {key: _plain(item) for key, item in vars_of(value).items()}
    return [_plain(item) for item in value] if isinstance(value, tuple) else value


def _law(law: Law, name: str) -> dict[str, Any]:
    """Friction as a washer, a spring without hinges by its stiffness, any other law hinge by hinge."""
    if isinstance(law, Jenkins):
        return {"type": "friction_washer", "friction_torque": law.limit_torque, "friction_stiffness": law.stiffness}
    rows = law.straight
    if rows is None:
        raise ModelError("the file format has no such law", where=name, found=type(law).__name__)
    if not rows.gap.size:
        return {"stiffness": rows.stiffness}
    columns = zip(rows.gap.tolist(), rows.side.tolist(), rows.change.tolist(), strict=True)
    changes = [{"angle": gap, "side": int(side), "change": change} for gap, side, change in columns]
    stops = {"stops": list(law.stops)} if law.stops else {}
    return {"hinges": {"stiffness": rows.stiffness, "changes": changes, **stops}}
