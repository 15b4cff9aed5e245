"""What public functions and classes are given, held against their own annotations: one check that teaches, for all."""

from __future__ import annotations

import dataclasses
import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any, ParamSpec, TypeVar, get_type_hints

from torsional.arguments.annotations import ARRAYS, fits
from torsional.arguments.refusal import refuse
from torsional.arguments.speeds import refuse_strange

__all__ = ["checked", "checked_fields"]

P = ParamSpec("P")
R = TypeVar("R")
C = TypeVar("C")


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which refuses what its annotations do not allow, NaN and empty arrays by a ModelError that teaches.

    So it does a speed that is far beyond its ``model`` and would be an ordinary one in rpm.

    >>> @checked
    ... def twice(value: float) -> float:
    ...     return 2 * value
    >>> twice("2 Nm")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    torsional.errors.ModelError: twice(value): a finite number is wanted; found '2 Nm' (str); numbers are in SI ...
    """

    told = function.__qualname__.rpartition("<locals>.")[2].removesuffix(".__init__")

    @functools.wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> R:
        signature, hints = _described(function)
        try:
            given = signature.bind(*args, **kwargs).arguments
        except TypeError:  # Python's own words name what is missing or unknown
            return function(*args, **kwargs)
        for name, value in given.items():
            _check(told, signature.parameters[name], hints.get(name, Any), value)
        refuse_strange(told, given)
        return function(*args, **kwargs)

    return called


def checked_fields(kind: type[C]) -> type[C]:
    """A class that is to become a dataclass: its fields are refused as `checked` refuses arguments, by their names.

    They are looked at before the class's own ``__post_init__``.

    >>> @dataclasses.dataclass(frozen=True)
    ... @checked_fields
    ... class Disc:
    ...     inertia: float
    >>> Disc("2 kgm²")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    torsional.errors.ModelError: inertia: a finite number is wanted; found '2 kgm²' (str); numbers are in SI ...
    """
    own = getattr(kind, "__post_init__", None)

    def look(self: Any) -> None:
        for name, hint, default in _fields(self.__class__):
            value = getattr(self, name)
            if value is not default and not fits(value, hint, default):
                refuse(name, hint, value)
        if own is not None:
            own(self)

    kind.__post_init__ = look  # type: ignore[attr-defined]
    return kind


@functools.cache
def _fields(kind: Any) -> tuple[tuple[str, Any, Any], ...]:
    """The fields of a dataclass: their names, annotations and defaults."""
    hints = get_type_hints(kind, localns=ARRAYS)
    fields = dataclasses.fields(kind)
    # lists may be empty: whether they are too short is for the class to say, which knows what they are
    return tuple((each.name, hints[each.name], () if _missing(each) else each.default) for each in fields)


def _missing(field: Any) -> bool:
    return field.default is dataclasses.MISSING


@functools.cache
def _described(function: Callable[..., object]) -> tuple[inspect.Signature, Mapping[str, Any]]:
    """A function's parameters and what they are annotated with, looked up when it is first called."""
    return inspect.signature(function), get_type_hints(function, localns=ARRAYS)


def _check(name: str, parameter: inspect.Parameter, hint: Any, value: Any) -> None:
    if parameter.kind is parameter.VAR_KEYWORD or value is parameter.default:
        return
    for each in value if parameter.kind is parameter.VAR_POSITIONAL else [value]:
        if not fits(each, hint, parameter.default):
            refuse(f"{name}({parameter.name})", hint, each)
