"""Designs: what the page sends of a model, and the models they stand for.

A design is the text of a model file, the files it names, and what was changed since.  Nothing is read from the disk:
a name that a design gives can only be that of a file it brings along.
"""

from __future__ import annotations

import copy
import io
import json
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Annotated, Any

from pydantic import Field, ValidationError

from torsional.errors import ModelError
from torsional.files.edit import parsed_edit, put
from torsional.files.faults import translated
from torsional.files.load import files_named, model_from_tree, rebuilt, with_contents
from torsional.files.opening import TABLE_BYTES
from torsional.files.reader import MODEL_BYTES, Tree, parse_tree, visible
from torsional.files.schema.fields import Block
from torsional.model import Model
from torsional.units import quoted

KEPT = 64
"""Models that a process keeps, those asked for longest ago go first."""
CHANGES = 500
Files = tuple[tuple[str, str], ...]


class Design(Block):
    """A model file's ``text``, the ``files`` it names by their names, and ``changes`` {key path: value}.

    A value is what a user types ("12 kNm/rad"), a number, a block or a list; null removes the key.
    """

    text: Annotated[str, Field(max_length=MODEL_BYTES)]
    files: Annotated[dict[str, Annotated[str, Field(max_length=TABLE_BYTES)]], Field(max_length=8)] = Field({})
    changes: Annotated[dict[str, Any], Field(max_length=CHANGES)] = Field({})

    @property
    def base(self) -> tuple[str, Files]:
        """What stays while values are changed."""
        return self.text, tuple(sorted(self.files.items()))


def design_of(data: object) -> Design:
    """The design that a message holds; ModelError, its ``where`` beginning with ``design``, for anything else."""
    try:
        return Design.model_validate(data)
    except ValidationError as error:
        raise translated(error, Tree({})).located(prefix="design") from None


def model_of(design: Design) -> Model:
    """The model of a design; ModelError with the key path of whatever it could not have."""
    told = json.dumps(design.changes)  # in their order: a block that comes later takes the place of its values
    return _kept(*design.base, told, lambda: _changed(design))


def changed_document(design: Design) -> dict[str, Any]:
    """The document of a design's file with its changes, files beside their names."""
    document = copy.deepcopy(dict(_parsed(*design.base).document))
    for path, value in design.changes.items():
        put(document, *_edit(path, value))
    return dict(with_contents(Tree(document), _among(dict(design.files))).data)


def saved(design: Design) -> str:
    """The model file's text with the changes in it; comments, order and spelling of all else stay."""
    if not design.changes:
        return design.text
    edits = [_edit(path, value) for path, value in design.changes.items()]
    wanted = parse_tree(design.text).data
    for path, value in edits:
        put(wanted, path, value)
    text = "" if design.text.lstrip().startswith("{") else _edited(design.text, edits)
    if not text or parse_tree(text).data != wanted:  # JSON, or a spelling that the writer does not keep
        text = json.dumps(wanted, indent=2, ensure_ascii=False)
    return text


def missing(design: Design) -> tuple[str, ...]:
    """The files that a design's text names and that it does not bring along."""
    return tuple(name for name in files_named(parse_tree(design.text).data) if name not in design.files)


def _texts(value: Any) -> Iterator[str]:
    """All texts of a value, keys of its blocks too."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for item in [*value, *value.values()] if isinstance(value, dict) else value:
            yield from _texts(item)


def _edit(path: str, value: Any) -> tuple[str, Any]:
    """A change as the command line reads it; ModelError for characters that no model file may hold."""
    for text in _texts(value):
        visible(text, path)
    if not isinstance(value, str):
        return path, value
    if not value.strip():
        raise ModelError("a value is wanted", where=path, found="nothing", remedy="type one, or undo")
    return parsed_edit(f"{path}={value}")


@lru_cache(maxsize=KEPT)
def _parsed(text: str, files: Files) -> Model:
    """The model as it was loaded."""
    return model_from_tree(with_contents(parse_tree(text), _among(dict(files))))


_MODELS: OrderedDict[tuple[str, Files, str], Model] = OrderedDict()
_LATEST: dict[tuple[str, Files], Model] = {}


def _kept(text: str, files: Files, changes: str, build: Callable[[], Model]) -> Model:
    key = (text, files, changes)
    if key not in _MODELS:
        _MODELS[key] = build()
        if len(_MODELS) > KEPT:
            _MODELS.popitem(last=False)
    _MODELS.move_to_end(key)
    return _MODELS[key]


def _changed(design: Design) -> Model:
    """The model built anew; an engine that the latest model of the same file has already is taken over."""
    before = _LATEST.get(design.base) or _parsed(*design.base)
    model = rebuilt(before, changed_document(design))
    if len(_LATEST) > KEPT:
        _LATEST.clear()
    _LATEST[design.base] = model
    return model


def _among(files: Mapping[str, str]) -> Callable[[str], str]:
    """Reads a file that was brought along."""

    def read(name: str) -> str:
        if name not in files:
            remedy = "open it together with the model file"
            raise ModelError("the file was not brought along", found=quoted(name), remedy=remedy)
        return files[name]

    return read


def _edited(text: str, edits: list[tuple[str, Any]]) -> str:
    """The text after its values were set, by a writer that keeps comments."""
    from ruamel.yaml import YAML

    yaml, written = YAML(typ="rt"), io.StringIO()
    yaml.preserve_quotes, yaml.width = True, 4096
    document = yaml.load(text)
    for path, value in edits:
        put(document, path, value)
    yaml.dump(document, written)
    return written.getvalue()
