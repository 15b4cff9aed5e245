"""Kinds of values that translated functions handle, and what they are called in C."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from torsional.errors import ModelError


@dataclass(frozen=True)
class Kind:
    """A kind of value by its ``name`` in C."""

    name: str


BOOL, INT, DOUBLE, NOTHING = Kind("bool"), Kind("int64_t"), Kind("double"), Kind("void")
LAW = Kind("law_function")
"""A law's kernel."""
NUMBERS = (BOOL, INT, DOUBLE)
"""Numbers, each of which holds all values of those before it."""


@dataclass(frozen=True)
class Block(Kind):
    """An array, contiguous, of ``item`` and as many ``dims``; ``f2`` in C is one of doubles with two."""

    item: Kind = DOUBLE
    dims: int = 1


@dataclass(frozen=True)
class Group(Kind):
    """A tuple, its ``fields`` by name; one without names of its own has _0, _1, …"""

    fields: tuple[tuple[str, Kind], ...] = field(default=())
    named: bool = False

    def kind_of(self, place: str) -> Kind | None:
        """The kind of one field; None where there is none."""
        return dict(self.fields).get(place)


def block(item: Kind, dims: int) -> Block:
    """An array of numbers.

    >>> block(DOUBLE, 2).name
    'f2'
    """
    return Block(("f" if item is DOUBLE else "i") + str(dims), item, dims)


def tuple_of(kinds: Sequence[Kind]) -> Group:
    """A tuple without names.

    >>> tuple_of([DOUBLE, INT]).name
    'tuple_d_i'
    """
    short = {DOUBLE: "d", INT: "i", BOOL: "b"}
    name = "tuple_" + "_".join(short.get(kind, kind.name) for kind in kinds)
    return Group(name, tuple((f"_{i}", kind) for i, kind in enumerate(kinds)))


def kind_of(value: Any) -> Kind:
    """The kind of a value that a function is to be translated for; ModelError for what has none."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        return block(DOUBLE if value.dtype.kind == "f" else INT, value.ndim)
    if isinstance(value, bool | np.bool_):
        return BOOL
    if isinstance(value, int | np.integer):
        return INT
    if isinstance(value, float | np.floating):
        return DOUBLE
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        kinds = tuple((name, kind_of(getattr(value, name))) for name in value._fields)
        return Group(type(value).__name__, kinds, True)
    if isinstance(value, tuple):
        return tuple_of([kind_of(part) for part in value])
    raise ModelError("no C is written for a value of this kind", found=type(value).__name__)


def wider(a: Kind, b: Kind) -> Kind | None:
    """The kind that holds the values of both; None where there is none.

    >>> wider(INT, DOUBLE).name
    'double'
    """
    if a == b:
        return a
    if a in NUMBERS and b in NUMBERS:
        return NUMBERS[max(NUMBERS.index(a), NUMBERS.index(b))]
    if isinstance(a, Group) and isinstance(b, Group) and not a.named and len(a.fields) == len(b.fields):
        parts = [wider(x, y) for (_, x), (_, y) in zip(a.fields, b.fields, strict=True)]
        found = [part for part in parts if part is not None]
        return tuple_of(found) if len(found) == len(parts) else None
    return None
