"""Changed copies of a model by key paths, as a command line or a sweep names them."""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping
from typing import Any

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.load import rebuilt
from torsional.files.reader import parse_tree
from torsional.files.scalars import resolved
from torsional.model import Model
from torsional.units import quoted

Edit = str | Mapping[str, Any]


@checked
def changed(model: Model, *edits: Edit) -> Model:
    """A copy of a model with values of its document changed and everything checked again.

    An edit is a text such as ``absorber.stages.0.stiffness=10kNm/rad`` or a mapping {path: value}; a value of null
    (None) removes the key, so that its default holds.  ModelError, with the nearest key, for a path or a value that
    the model file could not have, and for a model whose parts were changed in Python since it was loaded.

    >>> from torsional.files.load import load_model
    >>> softer = changed(load_model("examples/truck_dmf.yaml"), "absorber.stiffness=10kNm/rad")
    >>> softer.components["dmf"].law.stiffness  # Nm/rad
    10000.0
    """
    if not model.document:
        remedy = "change values of the file first, or parts by Model.replaced, joined and without"
        raise ModelError("no model file describes this model", where=model.name, remedy=remedy)
    document = copy.deepcopy(dict(model.document))
    for edit in edits:
        for path, value in [parsed_edit(edit)] if isinstance(edit, str) else edit.items():
            put(document, path, value)
    return rebuilt(model, document)


def parsed_edit(text: str, example: str = "absorber.stages.0.stiffness=10kNm/rad") -> tuple[str, Any]:
    """Path and value of a text path=value; a value in brackets is read as YAML.  ``example``: what is told where it is
    not one.

    >>> parsed_edit("clutch.stages = [{up_to: 100 Nm, stiffness: 5e3}]")
    ('clutch.stages', [{'up_to': '100 Nm', 'stiffness': 5000.0}])
    """
    path, equals, value = (part.strip() for part in text.partition("="))
    if not (equals and path and value):
        raise ModelError(
            "a change is written path=value", found=quoted(text), remedy=f"e.g. {example}; null removes a key"
        )
    if value[:1] in ("[", "{", "'", '"'):
        try:
            return path, parse_tree(f"value: {value}").data["value"]
        except ModelError as error:
            raise ModelError(error.problem, where=path, found=error.found, remedy=error.remedy) from None
    return path, resolved(value, path)


def document_paths(model: Model) -> tuple[str, ...]:
    """The key paths of all single values of a model's document, in its order; contents of files are left out."""
    return tuple(path for path, _ in _document_values(model.document))


def _document_values(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Key paths and single values of a document."""
    if not isinstance(value, Mapping | list):
        yield path, value
        return
    items = value.items() if isinstance(value, Mapping) else enumerate(value)
    for key, item in items:
        if not (key == "text" and "file" in value):
            yield from _document_values(item, f"{path}.{key}" if path else str(key))


def put(document: dict[str, Any], path: str, value: Any) -> None:
    """Set or remove one value; blocks on the way that the document leaves out are made."""
    *steps, last = path.split(".")
    if not all([*steps, last]):
        raise ModelError("a key path has no empty steps", found=quoted(path))
    holder: Any = document
    for number, step in enumerate(steps):
        if isinstance(holder, dict) and step not in holder:
            _refuse_item(steps[: number + 1], [*steps, last][number + 1])
            holder[step] = {}
        holder = holder[_key(holder, step, ".".join(steps[:number]))]
        if not isinstance(holder, dict | list):
            where = ".".join(steps[: number + 1])
            raise ModelError("this is a single value and holds no keys", where=where, found=quoted(holder))
    key = _key(holder, last, ".".join(steps))
    if value is not None:
        holder[key] = copy.deepcopy(value)
    elif isinstance(holder, list) or key in holder:
        del holder[key]


def _refuse_item(steps: list[str], item: str) -> None:
    """ModelError for an item of a list that is not there: what the others hold nobody has said."""
    if item.isdigit():
        where = ".".join(steps)
        remedy = f"write the whole list first, as {where}=[...], or name a value that is there"
        raise ModelError("the model has no such list", where=where, found=f"item {quoted(item)}", remedy=remedy)


def _key(holder: Any, step: str, path: str) -> Any:
    """A step as key of a mapping or index of a list."""
    if isinstance(holder, dict):
        return step
    if step.isascii() and step.isdigit() and int(step[:6]) < len(holder):
        return int(step[:6])
    allowed = f"0 to {len(holder) - 1}"
    raise ModelError("the list has no such item", where=path, found=quoted(step), allowed=allowed)
