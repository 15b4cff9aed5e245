"""What a periodic response is followed over: speeds, mean torques, or a value of the model file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from torsional import units
from torsional.cli import inputs, typed
from torsional.errors import ModelError
from torsional.files import changed
from torsional.files.schema.document import json_schema

if TYPE_CHECKING:
    from torsional.model import Model

Range = tuple[float, float]


@dataclass(frozen=True)
class Span:
    """The ``low`` and ``high`` value of a parameter; ``path`` in the model file where it is one of its values.

    ``name`` "speed", "mean_torque" or the path; ``quantity`` of the nomenclature; ``speed`` [rad/s] and ``torque``
    [Nm] where they are given once, a torque of None being full load.
    """

    name: str
    quantity: str
    low: float
    high: float
    speed: float | None = None
    torque: float | None = None

    @property
    def in_file(self) -> bool:
        """Whether it is a value of the model file, in which a plain number is in SI units."""
        return self.name not in ("speed", "mean_torque")

    @property
    def told(self) -> str:
        """What stays the same, as part of a title."""
        fixed = [] if self.speed is None else [units.show(self.speed, "speed")]
        if self.name != "mean_torque":
            fixed.append("full load" if self.torque is None else f"mean torque {units.show(self.torque, 'torque')}")
        return ", ".join(fixed)

    def value(self, text: str) -> float | None:
        """A value within the span, as ``--at`` names it; None for an empty text."""
        if not text:
            return None
        read = units.read if self.in_file else typed.read
        at = read(text, self.quantity, "--at")
        if not self.low <= at <= self.high:
            allowed = f"{units.show(self.low, self.quantity)} to {units.show(self.high, self.quantity)}"
            found = units.show(at, self.quantity)
            raise ModelError("this is outside what is followed", where="--at", found=found, allowed=allowed)
        return at


def asked(model: Model, speed: str, torque: str, parameter: str) -> Span:
    """The span that was asked for; ModelError unless one thing varies and the others are given once."""
    if parameter:
        return _over_parameter(model, _single(speed, "--speed"), _single(torque, "--torque"), parameter)
    if ":" in torque:
        low, high = _pair(torque, "torque", "--torque")
        at = inputs.speed(model, _single(speed, "--speed"))
        inputs.warn_overload(model, high, [at])
        return Span("mean_torque", "torque", low, high, speed=at)
    if speed and ":" not in speed:
        remedy = "write a range as 500:1200rpm, or let --torque or --parameter have one"
        raise ModelError("nothing varies here", where="--speed", found=units.quoted(speed), remedy=remedy)
    low, high = _pair(speed, "speed", "--speed") if speed else model.operation.speed
    inputs.warn_off_range(model, [low, high])
    return Span("speed", "speed", low, high, torque=inputs.torque(model, torque, [low, high]) if torque else None)


def _over_parameter(model: Model, speed: str, torque: str, text: str) -> Span:
    path, equals, told = (part.strip() for part in text.partition("="))
    if not (path and equals and ":" in told):
        example = "absorber.stages.1.stiffness=20:60kNm/rad"
        raise ModelError(
            "a parameter is written path=range", where="--parameter", found=units.quoted(text), remedy=f"e.g. {example}"
        )
    quantity = quantity_at(model, path)
    low, high = _pair(told, quantity, f"--parameter {path}")
    for value in (low, high):
        changed(model, {path: value})  # refuses what the file could not have
    at = inputs.speed(model, speed)
    return Span(path, quantity, low, high, speed=at, torque=inputs.torque(model, torque, [at]))


def _single(text: str, option: str) -> str:
    if ":" in text:
        remedy = "give one of the two a single value"
        raise ModelError("only one thing may vary at a time", where=option, found=units.quoted(text), remedy=remedy)
    return text


def _pair(text: str, quantity: str, option: str) -> Range:
    """The ends of a range; steps are chosen by the solver, so none is taken."""
    read = units.read_range if option.startswith("--parameter") else typed.read_range
    ends = read(text, quantity, option)
    if len(ends) > 2:
        remedy = "leave the third number out"
        raise ModelError(
            "the steps along a branch are not equal", where=option, found=units.quoted(text), remedy=remedy
        )
    inputs.checked_values(ends, quantity, option, text)
    return ends[0], ends[1]


def quantity_at(model: Model, path: str) -> str:
    """The quantity of the nomenclature that a key path of a model file holds; ModelError for any other path.

    Looked up in the schema of model files, whose alternatives the model's own document settles.
    """
    schema = json_schema()
    nodes: list[Mapping[str, Any]] = [schema]
    value: object = model.document
    for step in path.split("."):
        found = [_child(node, step) for part in nodes for node in _alternatives(part, schema, value)]
        nodes = [node for node in found if node is not None]
        value = _inside(value, step)
    known = [
        node["x-quantity"] for part in nodes for node in _alternatives(part, schema, value) if "x-quantity" in node
    ]
    if not known:
        changed(model, {path: 1.0})  # says which key is wrong, and names the nearest
        raise ModelError("this holds no number that could vary", where=f"--parameter {path}")
    return str(known[0])


def _alternatives(node: Mapping[str, Any], schema: Mapping[str, Any], value: object) -> list[Mapping[str, Any]]:
    """What a schema may stand for, references followed."""
    if "$ref" in node:
        return _alternatives(schema["$defs"][node["$ref"].rsplit("/", 1)[-1]], schema, value)
    chosen = (
        node.get("discriminator", {}).get("mapping", {}).get(value.get("type") if isinstance(value, Mapping) else "")
    )
    if chosen:
        return _alternatives({"$ref": chosen}, schema, value)
    parts = [part for key in ("oneOf", "anyOf") for part in node.get(key, ())]
    return [node, *(found for part in parts for found in _alternatives(part, schema, value))]


def _child(node: Mapping[str, Any], step: str) -> Mapping[str, Any] | None:
    if step.isdigit() and "x-quantity" in node:  # one of a list of values
        return {"x-quantity": node["x-quantity"]}
    if step.isdigit() and "items" in node:
        return dict(node["items"])
    found = node.get("properties", {}).get(step)
    further = node.get("additionalProperties")
    return found if found is not None else further if isinstance(further, Mapping) else None


def _inside(value: object, step: str) -> object:
    if isinstance(value, Mapping):
        return value.get(step)
    if isinstance(value, list) and step.isdigit() and int(step) < len(value):
        return value[int(step)]
    return None
