"""Scenario files into scenarios: read as strictly as model files, changed by key paths."""

from __future__ import annotations

import copy
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.files.edit import changed, parsed_edit, put
from torsional.files.faults import translated
from torsional.files.reader import Tree, read_tree
from torsional.files.scenario_blocks import VERSION, Scenario
from torsional.files.scenario_schema import KINDS
from torsional.model import Model
from torsional.units import quoted

SUFFIXES = (".yaml", ".yml", ".json")
EXAMPLE = "starter.speed=150rpm"


@checked
def load_scenario(source: str | os.PathLike[str], changes: Sequence[str] = ()) -> Scenario:
    """The scenario of a file, or the named kind as it is by default; ``changes`` are texts path=value.

    ModelError, and no other error, says what is wrong: file, key path with line, what was found, what is allowed.

    >>> load_scenario("engine_start", ["starter.torque=900 Nm"]).starter.torque
    900.0
    """
    if isinstance(source, str) and not Path(source).suffix and os.sep not in source:
        if source not in KINDS and not Path(source).exists():
            remedy = f"{nearest(source, KINDS)}; a file's name ends in {' or '.join(SUFFIXES)}"
            raise ModelError("there is no such scenario", found=quoted(source), remedy=remedy)
        tree = Tree({"torsional_scenario": VERSION, "scenario": source})
    else:
        tree = read_tree(source)
    return _validated(_edited(tree, changes))


def scenario_from_document(document: Mapping[str, Any], file: str = "") -> Scenario:
    """The scenario that a parsed file describes."""
    return _validated(Tree(dict(document), {}, file))


def adapted(model: Model, scenario: Scenario) -> Model:
    """The model with the values that the scenario overrides; ModelError, with the nearest key, for unknown ones."""
    edits = dict(_leaves(scenario.model))
    if not edits:
        return model
    try:
        return changed(model, edits)
    except ModelError as error:
        raise error.located(prefix="model") from None


def _edited(tree: Tree, changes: Sequence[str]) -> Tree:
    data = copy.deepcopy(tree.data)
    for edit in changes:
        path, value = parsed_edit(edit, EXAMPLE)
        put(data, path, value)
    return Tree(data, tree.lines, tree.file)


def _validated(tree: Tree) -> Scenario:
    for path, value in _leaves(tree.data):
        if value is None:
            remedy = "give it one, or remove the line"
            raise ModelError("the key has no value", where=tree.place(path), remedy=remedy, file=tree.file)
    try:
        return _block(tree).model_validate(tree.data)
    except ValidationError as error:
        raise translated(error, tree) from None


def _block(tree: Tree) -> type[Scenario]:
    """The block of the kind that the file names."""
    if "scenario" not in tree.data:
        remedy = "is this a model file?" if "torsional" in tree.data else "name one of them"
        raise ModelError("the key 'scenario' is missing", allowed=", ".join(KINDS), remedy=remedy, file=tree.file)
    kind = tree.data["scenario"]
    if not isinstance(kind, str) or kind not in KINDS:
        where, remedy = tree.place("scenario"), nearest(str(kind)[:64], KINDS)
        raise ModelError("there is no such scenario", where=where, found=quoted(kind), remedy=remedy, file=tree.file)
    return KINDS[kind]


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Key paths and values; a list is one value."""
    if not isinstance(value, Mapping):
        yield path, value
        return
    for key, item in value.items():
        yield from _leaves(item, f"{path}.{key}" if path else str(key))
