"""The JSON Schema as editors and people read it: units in titles and examples, no null that the reader refuses."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter

from torsional import units

DRAFT = "https://json-schema.org/draft/2020-12/schema"

_TYPICAL = {
    "inertia": 1.2,
    "stiffness": 13e3,
    "damping": 20.0,
    "torque": 3500.0,
    "speed": 68.0678,
    "length": 0.131,
    "mass": 4.2,
    "pressure": 1e5,
    "mean_pressure": 1e5,
    "angle": 0.5,
    "relative_angle": 0.1,
    "shear_modulus": 80e9,
    "density": 7850.0,
}


def schema_of(kind: Any, title: str) -> dict[str, Any]:
    """The JSON Schema, draft 2020-12, of the files that a block reads, or one of several."""
    schema = TypeAdapter(kind).json_schema(mode="validation")
    return {"$schema": DRAFT, **published({**schema, "title": title})}


def published(schema: dict[str, Any]) -> dict[str, Any]:
    """A schema as pydantic writes it, made readable."""
    tidied: dict[str, Any] = _tidied(schema)
    return tidied


def _tidied(node: Any) -> Any:
    if isinstance(node, list):
        return [_tidied(item) for item in node]
    if not isinstance(node, dict):
        return node
    tidy = {key: _tidied(value) for key, value in _without_null(node).items()}
    return _measured(tidy) if "x-quantity" in tidy else tidy


def _without_null(node: dict[str, Any]) -> dict[str, Any]:
    """A key that may be left out may not be empty: null is no alternative, and no default."""
    choices = node.get("anyOf", [])
    if {"type": "null"} not in choices:
        return node
    left = [choice for choice in choices if choice != {"type": "null"}]
    rest = {key: value for key, value in node.items() if key != "anyOf" and not (key == "default" and value is None)}
    return {**left[0], **rest} if len(left) == 1 else {**rest, "anyOf": left}


def _measured(node: dict[str, Any]) -> dict[str, Any]:
    """The unit into the title, examples with and without a unit."""
    entry = units.QUANTITIES[node["x-quantity"]]
    told = dict(node)
    if entry.unit != "-" and "title" in told:
        told["title"] = f"{told['title']} [{entry.unit}]"
    if entry.unit != "-":
        told["x-unit"] = entry.unit
    if entry.name in _TYPICAL:
        value = _TYPICAL[entry.name]
        told["examples"] = [value, units.show(value, entry.name)]
    return told
