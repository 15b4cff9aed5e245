"""What can be edited of a model: every value of its file with quantity, unit, limits and words, off its schema."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from torsional.files.load import validated
from torsional.files.reader import Tree
from torsional.files.schema.fields import Quantity, quantity_of
from torsional.model import Model
from torsional.units import QUANTITIES

Kind = Literal["quantity", "number", "choice", "text", "switch"]
_UNEDITED = ("torsional", "text", "type")
_LISTED = 24
_BOUNDS = {"ge": "least", "le": "most", "gt": "above", "lt": "below"}


@dataclass(frozen=True)
class Field:
    """One value of a model file: its key ``path``, what it is called, ``text`` as it stands in the file.

    ``value`` in SI; ``least``, ``most`` (inclusive), ``above``, ``below`` (exclusive) bound it, None where nothing
    does; ``given`` says whether the file holds it, or its default holds.
    """

    path: str
    label: str
    section: str
    kind: Kind
    text: str
    given: bool
    help: str
    value: float | None = None
    quantity: str | None = None
    unit: str = ""
    least: float | None = None
    most: float | None = None
    above: float | None = None
    below: float | None = None
    choices: tuple[str, ...] = ()


def groups_of(model: Model) -> list[dict[str, Any]]:
    """The values of a model's file, a group for each of its blocks: {path, label, fields}."""
    told = [{"path": "name", "label": "Model", "fields": [dict(vars(_title(model)))]}]
    for path, label, fields in _groups(model):
        told += [{"path": path, "label": label, "fields": [dict(vars(field)) for field in fields]}] if fields else []
    return told


def fields_of(model: Model) -> list[Field]:
    """All values of a model's file that can be edited one by one."""
    return [field for _, _, fields in _groups(model) for field in fields]


def _groups(model: Model) -> Iterator[tuple[str, str, list[Field]]]:
    file = validated(Tree(dict(model.document)))
    for key in type(file).model_fields:
        for path, label, block in _blocks(key, getattr(file, key)):
            yield path, label, list(_of_block(block, at_path(model.document, path), path, ""))


def _title(model: Model) -> Field:
    return Field("name", "name", "", "text", model.name, True, "what the model is called")


def _blocks(key: str, value: Any) -> Iterator[tuple[str, str, BaseModel]]:
    """The blocks that stand under a key of the file with their paths and titles: one, or one a component."""
    if isinstance(value, BaseModel):
        yield key, words(key).capitalize(), value
    if isinstance(value, Mapping):
        for name, item in value.items():
            if isinstance(item, BaseModel):
                yield f"{key}.{name}", f"{words(name)} ({words(key.removesuffix('s'))})", item


def _of_block(block: BaseModel, given: Any, path: str, section: str) -> Iterator[Field]:
    held = given if isinstance(given, Mapping) else {}
    for key, info in type(block).model_fields.items():
        if key not in _UNEDITED:
            yield from _of_value(getattr(block, key), held.get(key), f"{path}.{key}", words(key), section, info)


def _of_value(value: Any, raw: Any, path: str, label: str, section: str, info: FieldInfo) -> Iterator[Field]:
    """One field, or those of what the value is made of."""
    inside = ", ".join(filter(None, (section, label)))
    if isinstance(value, BaseModel):
        yield from _of_block(value, raw, path, inside)
    elif isinstance(value, Mapping):
        for name, item in value.items():
            yield from _of_value(item, at_path(raw, name), f"{path}.{name}", f"{label} {words(name)}", section, info)
    elif isinstance(value, list) and any(isinstance(item, BaseModel) for item in value):
        for number, item in enumerate(value):
            yield from _of_block(item, at_path(raw, str(number)), f"{path}.{number}", f"{inside} {number + 1}")
    elif isinstance(value, list) and quantity_of(info) and isinstance(raw, list) and len(value) <= _LISTED:
        for number, item in enumerate(value):
            yield from _of_value(item, raw[number], f"{path}.{number}", f"{label} {number + 1}", section, info)
    else:
        yield _field(value, raw, path, label, section, info)


def _field(value: Any, raw: Any, path: str, label: str, section: str, info: FieldInfo) -> Field:
    quantity = quantity_of(info)
    number = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
    kind: Kind = "text" if isinstance(value, list | tuple | str) else "quantity" if quantity else "number"
    choices = _choices(info.annotation)
    if quantity and quantity.shape in ("range", "list", "list or names") and number is None:
        kind = "text"
    elif choices or isinstance(value, bool):
        kind = "choice" if choices else "switch"
    elif value is None and not quantity and int not in _types(info.annotation):
        kind = "text"
    entry = QUANTITIES[quantity.name] if quantity else None
    return Field(
        path=path,
        label=label,
        section=section,
        kind=kind,
        text=_written(raw if raw is not None else value),
        given=raw is not None,
        help=info.description or (entry.long_name if entry else ""),
        value=number,
        quantity=quantity.name if quantity else None,
        unit=entry.unit.strip("-") if entry else "",
        choices=choices,
        **_bounds(quantity, info),
    )


def _bounds(quantity: Quantity | None, info: FieldInfo) -> dict[str, float]:
    if quantity:
        return {key: b for key, b in (("above", quantity.above), ("least", quantity.least)) if b is not None}
    parts = [*info.metadata, *(part for kind in _types(info.annotation) for part in getattr(kind, "__metadata__", ()))]
    flat = [each for part in parts for each in (part.metadata if isinstance(part, FieldInfo) else (part,))]
    found = {told: getattr(part, key) for part in flat for key, told in _BOUNDS.items() if hasattr(part, key)}
    return {key: float(bound) for key, bound in found.items() if isinstance(bound, int | float)}


def _types(annotation: Any) -> tuple[Any, ...]:
    """The alternatives of an annotation, those inside Annotated too."""
    inner = get_args(annotation) if get_origin(annotation) is not None else ()
    return (annotation, *(found for part in inner for found in _types(part)))


def _choices(annotation: Any) -> tuple[str, ...]:
    literal = next((part for part in _types(annotation) if get_origin(part) is Literal), None)
    return tuple(str(choice) for choice in get_args(literal)) if literal else ()


def _written(value: Any) -> str:
    """A value as the model file has it."""
    if value is None:
        return ""
    if isinstance(value, Mapping) and "file" in value:
        return str(value["file"])
    if isinstance(value, str):
        return value
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return json.dumps(list(value) if isinstance(value, tuple) else value, ensure_ascii=False, default=str)


def at_path(document: Any, path: str) -> Any:
    """What stands at a key path of a document; None where nothing does."""
    for step in path.split("."):
        if isinstance(document, Mapping):
            document = document.get(step)
        elif isinstance(document, list) and step.isdigit() and int(step) < len(document):
            document = document[int(step)]
        else:
            return None
    return document


def words(name: str) -> str:
    """A name as words: gearbox_input is gearbox input."""
    return name.replace("_", " ")
