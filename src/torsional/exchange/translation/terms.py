"""Terms: what an expression has become in C."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.exchange.translation.kinds import BOOL, DOUBLE, INT, NOTHING, Kind


class UntranslatableError(ModelError):
    """A compiled function says what no C is written for."""


@dataclass(frozen=True)
class Term:
    """The ``text`` of a value in C and its ``kind``; ``known``: what it is already in Python, a function or a class.

    ``parts``: the terms that a tuple is written of.
    """

    text: str
    kind: Kind
    known: Any = None
    parts: tuple[Term, ...] = ()


def number(value: Any) -> Term:
    """A number as it is written in C, every digit kept.

    >>> number(0.1).text, number(-math.inf).text, number(3).text
    ('0.1', '(-INFINITY)', '3')
    """
    if isinstance(value, bool | np.bool_):
        return Term(str(int(value)), BOOL, bool(value))
    if isinstance(value, int | np.integer | IntEnum):
        text = str(int(value)) if abs(int(value)) < 2**31 else f"INT64_C({int(value)})"
        return Term(text if value >= 0 else f"({text})", INT, int(value))
    value = float(value)
    text = "NAN" if math.isnan(value) else "INFINITY" if math.isinf(value) else repr(abs(value))
    return Term(f"(-{text})" if math.copysign(1.0, value) < 0 else text, DOUBLE, value)


def of_python(value: Any) -> Term:
    """What a name of Python stands for: a number, or something that is there while it is translated alone."""
    if isinstance(value, bool | np.bool_ | int | np.integer | float | np.floating):
        return number(value)
    return Term("", NOTHING, value)
