"""Whether a value is what an annotation says."""

from __future__ import annotations

import functools
import math
import types
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral
from typing import Any, Union, get_args, get_origin

import numpy as np
from numpy.typing import ArrayLike


class Numbers:
    """What stands for ``ArrayLike`` here: a number, or numbers in an array or a list."""


class ComplexNumbers(Numbers):
    """The same where they may be complex."""


ARRAYS = {"ArrayLike": Numbers, "Array": Numbers, "FloatArray": Numbers, "ComplexArray": ComplexNumbers}
"""What stands for the names of arrays in annotations."""


def fits(value: Any, hint: Any, default: object = None) -> bool:
    """Whether a value is what an annotation says; what it does not tell apart is allowed."""
    if type(value) is hint and (hint is not float or math.isfinite(value)):
        return True
    kind, inner = parts(hint)
    if kind is Union:
        return any(fits(value, one, default) for one in inner)
    may_be_empty = isinstance(default, tuple) and not default
    if kind in (Numbers, ComplexNumbers):
        return numbers(value, may_be_empty, "iufc" if kind is ComplexNumbers else "iuf")
    if kind in (tuple, Sequence) and inner[0] is float:
        return numbers(value, may_be_empty) and np.ndim(value) == 1 and size(kind, inner) in (None, len(value))
    if kind is tuple and size(kind, inner):
        return _several(value) and len(value) == len(inner) and all(map(fits, value, inner))
    if kind in (tuple, Sequence):
        named = get_args(inner[0]) == (str, int) and not may_be_empty  # gears, by name or number: none is no choice
        return _several(value) and (len(value) > 0 or not named) and all(fits(each, inner[0]) for each in value)
    if kind is Mapping:
        return isinstance(value, Mapping) and all(fits(each, inner[1]) for each in value.values())
    if kind is float:
        return _number(value) and bool(np.isfinite(value) or value == default)
    if kind is int:
        return isinstance(value, Integral) and not isinstance(value, bool)
    if kind is bool:
        return isinstance(value, bool | np.bool_)
    return callable(value) if kind is Callable else _is(value, kind)


@functools.cache
def parts(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """The kind of an annotation, and what stands in its brackets or between its bars."""
    kind = get_origin(hint) or hint
    if hint == ArrayLike:  # inside another alias
        return Numbers, ()
    return Union if kind is types.UnionType else kind, get_args(hint)


def _is(value: object, kind: Any) -> bool:
    if kind is Any or not isinstance(kind, type):
        return True
    if getattr(kind, "_is_protocol", False):
        return all(hasattr(value, name) for name in vars(kind) if not name.startswith("_"))
    return isinstance(value, kind)


def _number(value: object) -> bool:
    return np.ndim(value) == 0 and np.asarray(value).dtype.kind in "iuf"  # type: ignore[arg-type]


def size(kind: Any, inner: tuple[Any, ...]) -> int | None:
    """How many values a tuple or a list holds; None: any number."""
    return None if kind is Sequence or inner[-1] is ... else len(inner)


def numbers(value: Any, empty: bool, kinds: str = "iuf") -> bool:
    """Whether these are finite numbers: at least one, or it may be ``empty``."""
    try:
        array = np.asarray(value)
    except ValueError:  # lists of different lengths
        return False
    return empty if not array.size else array.dtype.kind in kinds and bool(np.isfinite(array).all())


def _several(value: object) -> bool:
    return not isinstance(value, str | Mapping) and hasattr(value, "__len__") and hasattr(value, "__iter__")
