"""What a public function was called with, held against its own annotations: one check that teaches, for all of them."""

from __future__ import annotations

import functools
import inspect
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from numbers import Integral
from os import PathLike
from typing import Any, ParamSpec, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.units import QUANTITIES, convert, quoted

P = ParamSpec("P")
R = TypeVar("R")

FAR_ABOVE = 2.5
"""Beyond this many times a model's highest speed, one that would be ordinary in rpm was meant in rpm."""

_MADE = {
    ("System", "Model"): "assemble(model.powertrain(gear)) makes the System of one gear",
    ("System", "Powertrain"): "assemble(powertrain) makes its System",
    ("Model", "System"): "pass the Model that the System was made of; load_model(path) reads one",
    ("Model", "Powertrain"): "a Powertrain has no engine and no landmarks; load_model(path) reads a whole Model",
    ("Model", "str"): "load_model(path) reads a model file",
    ("Model", "dict"): "write it as a model file, .yaml or .json, and read that by load_model(path)",
    ("Powertrain", "Model"): "model.powertrain(gear) makes the Powertrain of one gear",
    ("Powertrain", "System"): "this is assembled already: use it as it is",
    ("Powertrain", "dict"): "Powertrain(parts) makes one of named parts",
}
_DRIVES = "drives are an Excitation, OrderTorques, CylinderTorques, TorqueHistory, Governor, or a list of them"
_READ = "numbers are in SI units and radians; torsional.units.read makes one of a text and its quantity"
_PLAIN: Mapping[Any, str] = {
    float: "a finite number",
    int: "a whole number",
    bool: "True or False",
    Any: "a value",
    str: "a text",
    Callable: "a function",
    PathLike: "a path",
}


class Numbers:
    """What stands for ``ArrayLike`` here: a number, or numbers in an array or a list."""


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

    @functools.wraps(function)
    def called(*args: P.args, **kwargs: P.kwargs) -> R:
        signature, hints = _described(function)
        try:
            given = signature.bind(*args, **kwargs).arguments
        except TypeError:  # Python's own words name what is missing or unknown
            return function(*args, **kwargs)
        for name, value in given.items():
            _check(function.__name__, signature.parameters[name], hints.get(name, Any), value)
        _refuse_strange(function.__name__, given)
        return function(*args, **kwargs)

    return called


@functools.cache
def _described(function: Callable[..., object]) -> tuple[inspect.Signature, Mapping[str, Any]]:
    """A function's parameters and what they are annotated with, looked up when it is first called."""
    arrays = {"ArrayLike": Numbers, "Array": Numbers}
    return inspect.signature(function), get_type_hints(function, localns=arrays)


def _check(name: str, parameter: inspect.Parameter, hint: Any, value: Any) -> None:
    if parameter.kind is parameter.VAR_KEYWORD or value is parameter.default:
        return
    for each in value if parameter.kind is parameter.VAR_POSITIONAL else [value]:
        if not _fits(each, hint, parameter.default):
            _refuse(f"{name}({parameter.name})", hint, each)


def _fits(value: Any, hint: Any, default: object = None) -> bool:
    """Whether a value is what an annotation says; what it does not tell apart is allowed."""
    kind, inner = _parts(hint)
    if kind is Union:
        return any(_fits(value, one, default) for one in inner)
    may_be_empty = isinstance(default, tuple) and not default
    if kind is Numbers or (kind in (tuple, Sequence) and inner[0] is float):
        size = len(inner) if kind is tuple else None
        return _numbers(value, may_be_empty) and (
            kind is Numbers or (np.ndim(value) == 1 and size in (None, len(value)))
        )
    if kind in (tuple, Sequence):
        named = get_args(inner[0]) == (str, int) and not may_be_empty  # gears, by name or number: none is no choice
        return _several(value) and (len(value) > 0 or not named) and all(_fits(each, inner[0]) for each in value)
    if kind is Mapping:
        return isinstance(value, Mapping) and all(_fits(each, inner[1]) for each in value.values())
    if kind is float:
        return _number(value) and bool(np.isfinite(value) or value == default)
    if kind is int:
        return isinstance(value, Integral) and not isinstance(value, bool)
    if kind is bool:
        return isinstance(value, bool | np.bool_)
    return callable(value) if kind is Callable else _is(value, kind)


def _parts(hint: Any) -> tuple[Any, tuple[Any, ...]]:
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


def _numbers(value: Any, empty: bool) -> bool:
    """Whether these are finite numbers: at least one, or it may be ``empty``."""
    try:
        array = np.asarray(value)
    except ValueError:  # lists of different lengths
        return False
    return empty if not array.size else array.dtype.kind in "iuf" and bool(np.isfinite(array).all())


def _several(value: object) -> bool:
    return not isinstance(value, str | Mapping) and hasattr(value, "__len__") and hasattr(value, "__iter__")


def _refuse(where: str, hint: Any, value: object) -> None:
    told = list(dict.fromkeys(_words(hint)))
    wanted = " or ".join([", ".join(told[:-1]), told[-1]] if len(told) > 1 else told)
    raise ModelError(f"{wanted} is wanted", where=where, found=_found(value), remedy=_remedy(hint, value))


def _words(hint: Any) -> Iterator[str]:
    """What an annotation allows, in words; None, which is a default, is left out."""
    kind, inner = _parts(hint)
    if kind is Union:
        for one in inner:
            yield from _words(one)
    elif kind is Numbers:
        yield from ("a finite number", "an array of them")
    elif kind in (tuple, Sequence):
        size = f"{len(inner)} values" if kind is tuple else "a list"
        yield f"{size}, each {' or '.join(_words(inner[0]))}"
    elif kind is Mapping:
        yield f"a mapping from names to {' or '.join(_words(inner[1]))}"
    elif kind is not types.NoneType:
        yield _PLAIN.get(kind) or _article(getattr(kind, "__name__", str(kind)))


def _article(noun: str) -> str:
    return ("an " if noun[0] in "AEIOUaeiou" else "a ") + noun


def _found(value: object) -> str:
    """A value in a few words: what is plain by itself, anything else by its kind."""
    name = type(value).__name__
    if value is None or isinstance(value, float):
        return str(value)
    if isinstance(value, str | int | PathLike | list | tuple | np.ndarray):
        return f"{quoted(value)} ({name})"
    return _article(name)


def _kinds(hint: Any) -> Iterator[Any]:
    """The kinds of an annotation one by one."""
    kind, inner = _parts(hint)
    if kind is not Union:
        yield kind
    for one in inner if kind is Union else ():
        yield from _kinds(one)


def _remedy(hint: Any, value: object) -> str:
    kinds = list(_kinds(hint))
    wanted = [getattr(kind, "__name__", "") for kind in kinds]
    found = "str" if isinstance(value, PathLike) else type(value).__name__
    for name in wanted:
        if (name, found) in _MADE:
            return _MADE[name, found]
    if "Drive" in wanted:
        return _DRIVES
    inner = [get_args(one)[0] for one in (hint, *get_args(hint)) if _parts(one)[0] is Sequence]
    if inner and isinstance(value, list) and value:
        return _remedy(inner[0], value[0])
    if isinstance(value, str):
        return _READ if float in kinds or Numbers in kinds else f"write [{quoted(value)}]" if Sequence in kinds else ""
    return ""


def _refuse_strange(name: str, given: Mapping[str, Any]) -> None:
    """Refuse speeds and sweeps that a model does not have, but would if they were in rpm or degrees."""
    for parameter in ("speed", "speeds", "sweep") if "model" in given else ():
        values = given.get(parameter)
        if values is None or not _numbers(values, empty=False):
            continue
        quantity = QUANTITIES["relative_angle" if parameter == "sweep" else "speed"]
        least, most, where = float(np.min(values)), float(np.max(values)), f"{name}({parameter})"
        if quantity.name == "speed" and least < 0:
            raise ModelError("an engine does not turn backwards", where=where, found=f"{least:g} rad/s")
        limit = FAR_ABOVE * (_highest_speed(given["model"]) if quantity.name == "speed" else quantity.high)
        shown = convert(1.0, quantity.shown, quantity.unit)
        ordinary = shown * least > _lowest_speed(given["model"]) / FAR_ABOVE or quantity.name != "speed"
        if ordinary and shown * most <= limit < most:
            meant = f"{most:g} {quantity.shown}"
            remedy = f"if {quantity.shown} was meant, write torsional.units.read('{meant}', '{quantity.name}')"
            told = f"this is far above {limit:.4g} {quantity.unit}, beyond which no such model goes"
            raise ModelError(told, where=where, found=f"{most:g} {quantity.unit}", remedy=remedy)


def _highest_speed(model: Any) -> float:
    """The highest speed [rad/s] that a model says of itself; infinite where it says nothing."""
    engine = getattr(model, "engine", None)
    told = [float(np.max(engine.full_load.speeds))] if engine is not None and engine.full_load is not None else []
    if "operation" in getattr(model, "document", ()):
        told.append(float(model.operation.speed[1]))
    return max(told, default=np.inf)


def _lowest_speed(model: Any) -> float:
    """The lowest speed [rad/s] at which a model runs."""
    return float(model.operation.speed[0])
