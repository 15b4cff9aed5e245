"""Plain scalars of YAML 1.2: which unquoted texts are numbers, booleans or nothing, and which are refused as traps."""

from __future__ import annotations

import re

from torsional.errors import ModelError
from torsional.units import quoted

_INTEGER = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_SPECIAL = re.compile(r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)")
_OTHER_BASE = re.compile(r"[-+]?0[xXoObB][0-9a-fA-F]+")
_LONGEST_NUMBER = 40
_WORDS: dict[str, bool | None] = {
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys(("null", "Null", "NULL", "~", ""), None),
}

Scalar = str | int | float | bool | None


def resolved(text: str, where: str = "") -> Scalar:
    """The value of an unquoted scalar under the core schema of YAML 1.2.

    Dates, clock times, ``no`` and ``1_000`` remain texts; ``.nan`` and ``.inf`` are floats, for the units to refuse.
    ModelError for hexadecimal and octal numbers, which readers disagree about, and for numbers longer than 40 digits.

    >>> resolved("1e4"), resolved("12:30:00"), resolved("no"), resolved("012")
    (10000.0, '12:30:00', 'no', 12)
    """
    if text in _WORDS:
        return _WORDS[text]
    if _OTHER_BASE.fullmatch(text):
        remedy = "write it in decimal, or in quotes if a text is meant"
        raise ModelError("numbers are decimal", where=where, found=quoted(text), remedy=remedy)
    if _SPECIAL.fullmatch(text):
        return float(text.replace(".", ""))
    if not _FLOAT.fullmatch(text):
        return text
    if len(text) > _LONGEST_NUMBER:
        raise ModelError("a number this long is not read", where=where, found=quoted(text), allowed="at most 40 digits")
    return int(text) if _INTEGER.fullmatch(text) else float(text)
