"""What a request holds: JSON read strictly, its depth and size bounded, then held against what is asked for."""

from __future__ import annotations

import json
import math
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from torsional.errors import ModelError
from torsional.workbench.refusals import RefusedError, faults, refused

DEPTH, VALUES = 32, 200_000
NAME = 200
"""Letters of a name."""

Short = Annotated[str, Field(max_length=NAME)]
Message = TypeVar("Message", bound="Body")


class Body(BaseModel):
    """A request's keys: all known, none converted."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, hide_input_in_errors=True)


class Variant(Body):
    """A design by the name that it has on the page."""

    name: Short
    design: dict[str, Any]


class Asked(Body):
    """A design and what is asked of it, by views."""

    design: dict[str, Any]
    ask: list[dict[Short, Any]] = Field(min_length=1, max_length=8)


class Opened(Body):
    """A model file to open, and the files beside it."""

    text: str
    files: dict[str, str] = Field(default_factory=dict)


class Saved(Body):
    """A design to write as a model file."""

    design: dict[str, Any]


class Exported(Body):
    """A view to write as a picture or a table: of one design, or of several side by side."""

    ask: dict[Short, Any]
    format: Literal["png", "svg", "csv"]
    design: dict[str, Any] | None = None
    variants: list[Variant] = Field(default_factory=list, max_length=4)
    dark: bool = False


class Reported(Body):
    """Designs to write a report about, the first against the others."""

    variants: list[Variant] = Field(min_length=1, max_length=4)


class Commanded(Body):
    """A job to do in the background."""

    session: str = Field(min_length=8, max_length=64)
    design: dict[str, Any]
    kind: Literal["branches", "region", "scenario"]
    settings: dict[Short, Any] = Field(default_factory=dict)


def parsed(data: bytes) -> Any:
    """A JSON text as values; RefusedError (400) for what is not strict JSON, deep or of very many values.

    >>> parsed(b'{"speed": [600, 2000.5]}')
    {'speed': [600, 2000.5]}
    """
    try:
        found = json.loads(data.decode("utf-8"), parse_constant=_no_number, object_pairs_hook=_once)
    except (ValueError, RecursionError) as error:
        reason = "it is nested too deeply" if isinstance(error, RecursionError) else str(error)[:NAME]
        raise refused(400, "the request is not strict JSON", found=reason) from None
    _measured(found)
    return found


def read(kind: type[Message], document: Any) -> Message:
    """The values as a body of a kind; RefusedError (400) with the key for whatever is not of it."""
    try:
        return kind.model_validate(document)
    except ValidationError as error:
        raise RefusedError(400, [text for each in error.errors()[:8] for text in _fault(each)]) from None


def _fault(error: Any) -> list[dict[str, str]]:
    where = ".".join(map(str, error["loc"]))[:NAME]
    return faults(ModelError("the request is not as it should be", where=where, found=str(error["msg"])[:NAME]))


def _no_number(name: str) -> float:
    raise ValueError(f"{name} is no number")


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    held = dict(pairs)
    if len(held) < len(pairs):
        raise ValueError("a key stands twice")
    return held


def _writable(text: str) -> bool:
    """Whether a text can be written as UTF-8."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _measured(document: Any) -> None:
    """Walk through all values, one after the other: what is deep costs no stack."""
    waiting, count = [(document, 0)], 0
    while waiting:
        value, depth = waiting.pop()
        count += 1
        if count > VALUES:
            raise refused(400, "the request holds too many values", allowed=f"at most {VALUES}")
        if isinstance(value, str) and not _writable(value):
            raise refused(400, "the request holds half a character", found=ascii(value)[:NAME])
        if isinstance(value, float) and not math.isfinite(value):
            raise refused(400, "the request holds a number that is too large")
        if isinstance(value, dict | list):
            if depth == DEPTH:
                raise refused(400, "the request is nested too deeply", allowed=f"at most {DEPTH} levels")
            items = [*value, *value.values()] if isinstance(value, dict) else value
            waiting.extend((item, depth + 1) for item in items)
