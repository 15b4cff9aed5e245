"""Figures of a model file in SI and multiplied: blocks of another size, values at key paths."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import BaseModel

from torsional.errors import ModelError
from torsional.files.load import validated
from torsional.files.reader import Tree
from torsional.files.schema import ModelFile
from torsional.files.schema.document import VERSION
from torsional.files.schema.fields import quantity_of


def scaled_absorber(block: Mapping[str, Any], factors: Mapping[str, float]) -> dict[str, Any]:
    """An absorber block in SI whose figures are multiplied by the factor of their quantity, where it has one.

    ``factors``: by names of the nomenclature.  ModelError for a block that the model file could not have.

    >>> scaled_absorber({"type": "single_mass_flywheel", "inertia": "1.9 kgm²"}, {"inertia": 2.0})
    {'type': 'single_mass_flywheel', 'inertia': 3.8}
    """
    read = validated(Tree({"torsional": VERSION, "name": "absorber", "absorber": dict(block)})).absorber
    assert read is not None  # it was given
    return _multiplied(read, lambda quantity: factors.get(quantity, 1.0))


def _multiplied(block: BaseModel, factor: Callable[[str], float]) -> dict[str, Any]:
    """The keys of a block that were given, blocks within it too."""
    told: dict[str, Any] = {}
    for key, field in type(block).model_fields.items():
        if key not in block.model_fields_set:
            continue
        value, quantity = getattr(block, key), quantity_of(field)
        if isinstance(value, BaseModel):
            told[key] = _multiplied(value, factor)
        elif quantity:
            told[key] = _times(value, factor(quantity.name))
        else:
            told[key] = (
                [_multiplied(item, factor) if isinstance(item, BaseModel) else item for item in value]
                if (isinstance(value, list))
                else value
            )
    return told


def _times(value: Any, factor: float) -> Any:
    return [factor * item for item in value] if isinstance(value, list | tuple) else factor * value


def read_document(document: Mapping[str, Any]) -> ModelFile:
    """A model's document as blocks of the schema, in SI; ModelError for whatever is not of it."""
    return validated(Tree(dict(document)))


def values_at(file: ModelFile, path: str) -> dict[str, float]:
    """The figures in SI at a key path, by their own paths: none where the file does not give it, several for a list.

    ``*`` stands for every item of a list.

    >>> disc = {"type": "inertia", "inertia": "0.2 kgm²"}
    >>> file = read_document({"torsional": 1, "name": "one disc", "components": {"disc": disc}})
    >>> values_at(file, "components.disc.inertia"), values_at(file, "clutch.stiffness")
    ({'components.disc.inertia': 0.2}, {})
    """
    found: dict[str, Any] = {"": file}
    for step in path.split("."):
        found = {f"{at}.{key}".lstrip("."): item for at, holder in found.items() for key, item in _items(holder, step)}
    leaves = [(at, value) for at, value in found.items() if value is not None]
    listed = [(f"{at}.{n}", item) for at, value in leaves if isinstance(value, list) for n, item in enumerate(value)]
    return dict([*((at, value) for at, value in leaves if isinstance(value, float)), *listed])


def quantity_at(file: ModelFile, path: str) -> str:
    """The quantity of the single figure at a key path; ModelError where there is none.

    >>> disc = {"type": "inertia", "inertia": "0.2 kgm²"}
    >>> file = read_document({"torsional": 1, "name": "one disc", "components": {"disc": disc}})
    >>> quantity_at(file, "components.disc.inertia")
    'inertia'
    """
    *steps, last = path.split(".")
    holder: Any = file
    for step in steps:
        holder = next((item for _, item in _items(holder, step)), None)
    field = type(holder).model_fields.get(last) if isinstance(holder, BaseModel) else None
    quantity = quantity_of(field) if field else None
    if quantity is None or list(values_at(file, path)) != [path]:
        raise ModelError("the model file gives no figure there", where=path)
    return quantity.name


def _items(holder: Any, step: str) -> list[tuple[str, Any]]:
    """What a block, mapping or list holds under a key: nothing where it was not given."""
    if isinstance(holder, BaseModel):
        return [(step, getattr(holder, step))] if step in holder.model_fields_set else []
    if isinstance(holder, dict):
        return [(step, holder[step])] if step in holder else []
    if isinstance(holder, list) and step == "*":
        return [(str(number), item) for number, item in enumerate(holder)]
    if isinstance(holder, list) and step.isdigit() and int(step) < len(holder):
        return [(step, holder[int(step)])]
    return []
