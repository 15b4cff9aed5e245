"""The two spellings of a model file, YAML 1.2 and JSON, as one stream of tokens with their lines."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError
from ruamel.yaml.events import (
    DocumentStartEvent,
    Event,
    MappingEndEvent,
    MappingStartEvent,
    ScalarEvent,
    SequenceEndEvent,
    SequenceStartEvent,
)
from ruamel.yaml.scanner import Scanner

from torsional.errors import ModelError
from torsional.units import quoted

DEPTH = 30
_JSON_TOKEN = re.compile(r'[\[\]{}]|"(?:[^"\\]|\\.)*"|[-+.0-9a-zA-Z]+|\n')
_REMEDIES = {
    "'\\t'": "indent with blanks, not tabs",
    "mapping values": "a key stands alone on its line, and a text with ': ' in it needs quotes",
    "block end": "check the indentation: keys of one block begin in the same column",
    "quoted scalar": "close the quotes",
    "flow": "close the brackets and put commas between the values",
}


@dataclass(frozen=True, slots=True)
class Token:
    """A beginning, an end or a scalar: ``plain`` is unquoted and may become a number, ``text`` never does."""

    kind: Literal["map", "list", "end", "plain", "text"]
    line: int
    text: str = ""


class _Scanner(Scanner):
    """The scanner without tags, anchors and aliases, refused at once: scanning a long row of '!' is quadratic."""

    def fetch_tag(self) -> None:
        self._refuse("YAML tags ('!') are not read", "remove the tag, or quote a text that begins with '!'")

    def fetch_anchor(self) -> None:
        self._refuse("YAML anchors ('&') are not read", "write the value out, or quote a text that begins with '&'")

    def fetch_alias(self) -> None:
        self._refuse("YAML aliases ('*') are not read", "write the value out, or quote a text that begins with '*'")

    def _refuse(self, problem: str, remedy: str) -> None:
        found = re.split(r"[\s\0,\[\]{}]", self.reader.prefix(40), maxsplit=1)[0]
        raise ModelError(problem, where=f"line {self.reader.line + 1}", found=quoted(found), remedy=remedy)


def yaml_tokens(text: str) -> Iterator[Token]:
    yaml = YAML(typ="safe", pure=True)
    yaml.version = (1, 2)
    yaml.Scanner = _Scanner
    documents = 0
    try:
        for event in yaml.parse(text):
            documents += isinstance(event, DocumentStartEvent)
            _refuse_document(event, documents)
            token = _token(event)
            if token:
                yield token
    except MarkedYAMLError as error:
        raise _syntax_error(error, text) from None


def _token(event: Event) -> Token | None:
    line = event.start_mark.line + 1
    if isinstance(event, ScalarEvent):
        return Token("plain" if event.style is None or event.style == "" else "text", line, event.value)
    if isinstance(event, MappingStartEvent):
        return Token("map", line)
    if isinstance(event, SequenceStartEvent):
        return Token("list", line)
    return Token("end", line) if isinstance(event, MappingEndEvent | SequenceEndEvent) else None


def _refuse_document(event: Event, documents: int) -> None:
    if not isinstance(event, DocumentStartEvent):
        return
    where = f"line {event.start_mark.line + 1}"
    if documents > 1:
        raise ModelError("a second document begins here ('---')", where=where, allowed="one model a file")
    if event.tags or (event.version and tuple(event.version) != (1, 2)):
        raise ModelError("only the directive '%YAML 1.2' is read", where=where, remedy="remove the line with '%'")


def _syntax_error(error: MarkedYAMLError, text: str) -> ModelError:
    mark = error.problem_mark or error.context_mark
    rows = text.splitlines() or [""]
    row = min(mark.line, len(rows) - 1) if mark else 0
    told = " ".join(part for part in (error.context, error.problem) if part)
    told += f" (begun on line {error.context_mark.line + 1})" if error.context_mark else ""
    remedy = next((cure for sign, cure in _REMEDIES.items() if sign in told), "")
    found = quoted(rows[row].strip())
    return ModelError(f"this is not YAML: {told}", where=f"line {row + 1}", found=found, remedy=remedy)


def json_tokens(text: str) -> Iterator[Token]:
    """Tokens of a JSON text; the standard library checks the grammar first, so that walking it needs no checks."""
    try:
        json.loads(text, parse_int=str, parse_float=str, parse_constant=str)
    except json.JSONDecodeError as error:
        raise ModelError(f"this is not JSON: {error.msg}", where=f"line {error.lineno}, column {error.colno}") from None
    except RecursionError:
        raise ModelError("the file is nested too deeply", allowed=f"at most {DEPTH} levels") from None
    line = 1
    for found in _JSON_TOKEN.finditer(text):
        word = found[0]
        line += word == "\n"
        if word[0] == '"':
            yield Token("text", line, json.loads(word))
        elif word != "\n":
            yield {"{": Token("map", line), "[": Token("list", line)}.get(word) or _word(word, line)


def _word(word: str, line: int) -> Token:
    if word in ("NaN", "Infinity", "-Infinity"):
        raise ModelError("a finite number is wanted", where=f"line {line}", found=quoted(word))
    return Token("end", line) if word in "]}" else Token("plain", line, word)
