"""Strict reading of a model file into a plain tree that remembers the line of every key.

The events of the YAML parser are taken one by one and the tree is built here: tags, anchors, aliases and merges never
get as far as meaning something, and depth and size are bounded before they cost time.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from torsional.errors import ModelError
from torsional.files.opening import decoded, read_text, resolve_reference, shown
from torsional.files.scalars import resolved
from torsional.files.tokens import DEPTH, Token, json_tokens, yaml_tokens
from torsional.units import quoted

__all__ = ["Tree", "parse_tree", "read_tree", "resolve_reference"]

MODEL_BYTES = 256_000
NODES = 10_000
_KEY_LENGTH = 64
_SURROGATE = re.compile("[\ud800-\udfff]")
_INVISIBLE = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029]")


@dataclass(frozen=True, slots=True)
class Tree:
    """A model file as plain mappings, lists and scalars.

    ``lines`` maps a key path such as ``absorber.stages.0.stiffness`` to its line, counted from 1; ``file`` is the name
    to put into errors.

    >>> tree = parse_tree("absorber:\\n  stages: [8, 24]\\n")
    >>> tree.data, tree.place("absorber.stages.1"), tree.place("absorber.damping")
    ({'absorber': {'stages': [8, 24]}}, 'absorber.stages.1 (line 2)', 'absorber.damping (line 1)')
    """

    data: dict[str, Any]
    lines: dict[str, int] = field(default_factory=dict)
    file: str = ""

    def line(self, path: str) -> int | None:
        """The line of a key path, or of the nearest path above it that stands in the file."""
        while path and path not in self.lines:
            path = path.rpartition(".")[0]
        return self.lines.get(path)

    def place(self, path: str) -> str:
        """A key path with its line, for the ``where`` of an error."""
        line = self.line(path)
        return path if line is None else f"{path} (line {line})"


def read_tree(path: str | os.PathLike[str]) -> Tree:
    """The tree of a YAML 1.2 or JSON (``.json``) file of at most 256 kB, 30 levels and 10 000 values.

    ModelError, never anything else, names the file, the line or key path, what was found and what to do.
    """
    text = read_text(path, MODEL_BYTES)
    return parse_tree(text, file=shown(path), json_only=Path(path).suffix.lower() == ".json")


def parse_tree(text: str | bytes, file: str = "", json_only: bool = False) -> Tree:
    """The tree of a text in YAML 1.2, or in JSON alone; limits and errors as for a file."""
    try:
        checked = _checked_text(text)
        tokens = json_tokens(checked) if json_only else yaml_tokens(checked)
        return _tree(tokens, file)
    except ModelError as error:
        raise error.located(file=file) from None
    except Exception as error:
        # A last resort against defects of the parser: hostile bytes must end in a sentence, not in its traceback.
        raise ModelError(f"the file cannot be parsed ({type(error).__name__})", file=file) from None


def _checked_text(text: str | bytes) -> str:
    data = text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text
    if len(data) > MODEL_BYTES:
        raise ModelError("the model is too large", allowed="at most 256 000 bytes")
    return decoded(data)


def _tree(tokens: Iterator[Token], file: str) -> Tree:
    root = next(tokens, None)
    if root is None or (root.kind == "plain" and not root.text):
        raise ModelError("the file holds no model, only comments or blanks")
    if root.kind != "map":
        found = "a list" if root.kind == "list" else quoted(root.text)
        raise ModelError(
            "the file must begin with keys, such as 'torsional: 1'", where=f"line {root.line}", found=found
        )
    lines: dict[str, int] = {}
    data = _mapping(tokens, "", lines)
    next(tokens, None)
    return Tree(data, lines, file)


def _node(token: Token, tokens: Iterator[Token], path: str, lines: dict[str, int]) -> object:
    """The value that begins with ``token``; recursion is bounded by DEPTH."""
    place = f"{path} (line {token.line})"
    lines[path] = token.line
    if len(lines) > NODES:
        raise ModelError("the file holds too many values", where=f"line {token.line}", allowed=f"at most {NODES}")
    if token.kind == "plain":
        return resolved(token.text, place)
    if token.kind == "text":
        return visible(token.text, place)
    if path.count(".") >= DEPTH - 1:
        raise ModelError("the file is nested too deeply", where=f"line {token.line}", allowed=f"at most {DEPTH} levels")
    return _mapping(tokens, path, lines) if token.kind == "map" else _sequence(tokens, path, lines)


def _sequence(tokens: Iterator[Token], path: str, lines: dict[str, int]) -> list[object]:
    items: list[object] = []
    for token in tokens:
        if token.kind == "end":
            break
        items.append(_node(token, tokens, f"{path}.{len(items)}", lines))
    return items


def _mapping(tokens: Iterator[Token], path: str, lines: dict[str, int]) -> dict[str, Any]:
    held: dict[str, Any] = {}
    for token in tokens:
        if token.kind == "end":
            break
        key = _key(token, path)
        where = f"{path}.{key}" if path else key
        if key in held:
            found = f"it stands on line {lines[where]} already"
            raise ModelError("the key stands twice", where=f"{where} (line {token.line})", found=found)
        value = next(tokens)
        held[key] = _node(value, tokens, where, lines)
        lines[where] = token.line
    return held


def _key(token: Token, path: str) -> str:
    """A key as text; a number, a list, nothing or a text that would blur key paths is refused."""
    place = f"{path} (line {token.line})" if path else f"line {token.line}"
    if token.kind in ("map", "list"):
        raise ModelError("a key must be a word, not a list or a mapping", where=place)
    if token.kind == "plain" and token.text == "<<":
        raise ModelError("merge keys '<<' are not read", where=place, remedy="write the keys out")
    if token.kind == "plain" and not isinstance(resolved(token.text, place), str):
        raise ModelError("a key must be a word", where=place, found=quoted(token.text), remedy="put it in quotes")
    if not token.text.strip() or len(token.text) > _KEY_LENGTH or "." in token.text:
        rule = f"1 to {_KEY_LENGTH} characters without a dot, since key paths are written with dots"
        raise ModelError("this cannot be a key", where=place, found=quoted(token.text), allowed=rule)
    if not token.text.isprintable():
        raise ModelError("a key must be printable", where=place, found=quoted(token.text))
    return token.text


def visible(text: str, place: str) -> str:
    """A text without control characters or half characters that escapes such as \\u001b have brought in."""
    hidden = _INVISIBLE.search(text) or _SURROGATE.search(text)
    if hidden:
        raise ModelError("the text holds a control character", where=place, found=f"U+{ord(hidden[0]):04X}")
    return text
