"""The findings of the schema as errors that teach: key path with line, what was found, what is allowed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from pydantic import ValidationError

from torsional.errors import ModelError, nearest
from torsional.files.reader import Tree
from torsional.units import quoted

SHOWN = 5
_WANTED = {
    "model_type": "a block of keys is wanted",
    "model_attributes_type": "a block of keys is wanted",
    "dict_type": "a block of keys is wanted",
    "list_type": "a list is wanted",
    "string_type": "a text is wanted",
    "int_type": "a whole number is wanted",
    "bool_type": "true or false is wanted",
    "float_type": "a number is wanted",
}
_BOUNDS = {
    "greater_than_equal": ("is too small", ">=", "ge"),
    "less_than_equal": ("is too large", "<=", "le"),
    "string_too_short": ("the text is too short", "characters >=", "min_length"),
    "string_too_long": ("the text is too long", "characters <=", "max_length"),
    "too_short": ("there are too few", "number >=", "min_length"),
    "too_long": ("there are too many", "number <=", "max_length"),
}


class SchemaError(ModelError):
    """Several findings at once; its own parts are those of the first."""

    def __init__(self, errors: Sequence[ModelError], file: str = "") -> None:
        first = errors[0]
        super().__init__(
            first.problem, where=first.where, found=first.found, allowed=first.allowed, remedy=first.remedy, file=file
        )
        self.errors = tuple(errors)

    def __str__(self) -> str:
        head = f"{self.file}: " if self.file else ""
        lines = [f"  {error}" for error in self.errors[:SHOWN]]
        more = len(self.errors) - SHOWN
        lines += [f"  and {more} more"] if more > 0 else []
        return "\n".join([f"{head}{len(self.errors)} things are not right", *lines])

    def located(self, *, file: str = "", prefix: str = "") -> ModelError:
        """The same findings with the file named and the key paths prefixed."""
        return SchemaError([error.located(prefix=prefix) for error in self.errors], file or self.file)


def placed(error: ModelError, tree: Tree) -> ModelError:
    """The error with file and line."""
    told = {"found": error.found, "allowed": error.allowed, "remedy": error.remedy}
    return ModelError(error.problem, where=tree.place(error.where), file=tree.file, **told)


@contextmanager
def told_of(tree: Tree) -> Iterator[None]:
    """What is found wrong with the file of a tree is told with its name and lines; other files keep theirs."""
    try:
        yield
    except ValidationError as error:
        raise translated(error, tree) from None
    except ModelError as error:
        raise error if error.file else placed(error, tree) from None


def translated(error: ValidationError, tree: Tree) -> ModelError:
    """The schema's findings, one ModelError or several in one."""
    found = [_one(dict(detail), tree) for detail in error.errors(include_url=False)]
    return found[0].located(file=tree.file) if len(found) == 1 else SchemaError(found, tree.file)


def _one(detail: dict[str, Any], tree: Tree) -> ModelError:
    path = _path(detail["loc"], tree.data)
    inner = detail.get("ctx", {}).get("error")
    if isinstance(inner, ModelError):
        where = ".".join(part for part in (path, inner.where) if part)
        return ModelError(
            inner.problem, where=tree.place(where), found=inner.found, allowed=inner.allowed, remedy=inner.remedy
        )
    return _sentence(detail, path, tree)


def _sentence(detail: dict[str, Any], path: str, tree: Tree) -> ModelError:
    kind, context = str(detail["type"]), detail.get("ctx", {})
    if kind in ("union_tag_not_found", "union_tag_invalid"):
        return _untold(detail, path, tree)
    found = quoted(detail["input"])
    if kind == "literal_error":
        return ModelError(
            "is none of the choices", where=tree.place(path), found=found, allowed=_listed(context["expected"])
        )
    if kind in _BOUNDS:
        problem, sign, key = _BOUNDS[kind]
        return ModelError(problem, where=tree.place(path), found=found, allowed=f"{sign} {context[key]}")
    problem = _WANTED.get(kind, str(detail["msg"])[:1].lower() + str(detail["msg"])[1:])
    return ModelError(problem, where=tree.place(path), found=found)


def _untold(detail: dict[str, Any], path: str, tree: Tree) -> ModelError:
    """The key that says which of several blocks is meant is missing, or names none of them."""
    context: dict[str, Any] = detail["ctx"]
    key = str(context["discriminator"]).strip("'")
    known = _tags(path) if key == "type" else re.findall("'(.*?)'", str(context.get("expected_tags", "")))
    if detail["type"] == "union_tag_not_found":
        return ModelError(f"the key '{key}' is missing", where=tree.place(path), allowed=", ".join(known))
    tag = str(context["tag"])[:64]
    told = {"found": quoted(tag), "remedy": nearest(tag, known)}
    return ModelError(f"there is no such {key}", where=tree.place(f"{path}.{key}"), **told)


def _listed(expected: object) -> str:
    return str(expected).replace("'", "")


def _tags(path: str) -> list[str]:
    from torsional.files.schema.absorbers import AbsorberBlock
    from torsional.files.schema.making import tags
    from torsional.files.schema.parts import PartBlock

    return tags(AbsorberBlock if path == "absorber" else PartBlock)


def _path(location: Sequence[int | str], data: Any) -> str:
    """The key path of a finding: the location without the type names that choose among blocks."""
    parts: list[str] = []
    chosen = False
    for step in location:
        key = _chooses(parts)
        if not chosen and key and isinstance(data, dict) and data.get(key) == step:
            chosen = True
            continue
        if step == "[key]":
            break
        parts.append(str(step))
        chosen = False
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            data = None
    return ".".join(parts)


def _chooses(parts: Sequence[str]) -> str:
    """The key by which the block at this path is one of several; none where it is the only kind."""
    if parts == ["run"] or (len(parts) == 3 and parts[:2] == ["run", "ask"]):  # of plans
        return "analysis"
    return "type" if parts == ["absorber"] or (len(parts) in (2, 4) and parts[-2] == "components") else ""
