"""The refusal of a value: what was wanted, what was found, and what makes the one of the other."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Union

import numpy as np

from torsional.arguments.annotations import ComplexNumbers, Numbers, parts, size
from torsional.errors import ModelError
from torsional.units import quoted

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
_SPRING = "a plain spring is Hinges(stiffness); stages are Hinges.staged([(up to, stiffness), ...])"
_DRIVES = "drives are an Excitation, OrderTorques, CylinderTorques, TorqueHistory, Governor, or a list of them"
_READ = "numbers are in SI units and radians; torsional.units.read makes one of a text and its quantity"
_PLAIN: Mapping[Any, str] = {
    float: "a finite number",
    int: "a whole number",
    bool: "True or False",
    Any: "a value",
    str: "a text",
    Callable: "a function",
    Iterable: "pairs of them",
    PathLike: "a path",
}


def refuse(where: str, hint: Any, value: object) -> None:
    told = list(dict.fromkeys(_words(hint)))
    wanted = " or ".join([", ".join(told[:-1]), told[-1]] if len(told) > 1 else told)
    raise ModelError(f"{wanted} is wanted", where=where, found=_found(value), remedy=_remedy(hint, value))


def _words(hint: Any) -> Iterator[str]:
    """What an annotation allows, in words; None, which is a default, is left out."""
    kind, inner = parts(hint)
    if kind is Union:
        for one in inner:
            yield from _words(one)
    elif kind in (Numbers, ComplexNumbers):
        yield from ("a finite number", "an array of them")
    elif kind in (tuple, Sequence):
        count = size(kind, inner)
        yield f"{f'{count} values' if count else 'a list'}, each {' or '.join(_words(inner[0]))}"
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
    kind, inner = parts(hint)
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
    if "Law" in wanted and isinstance(value, float | int):
        return _SPRING
    kind, choices = parts(hint)
    lists = [one for one in (choices if kind is Union else [hint]) if parts(one)[0] in (tuple, Sequence)]
    inner = [parts(one)[1][0] for one in lists]
    if inner and isinstance(value, list) and value:
        return _remedy(inner[0], value[0])
    if not isinstance(value, str):
        return ""
    listed = [kind for one in inner for kind in _kinds(one)]
    if str in listed:
        return f"write [{quoted(value)}]"
    return _READ if {float, Numbers, ComplexNumbers} & {*kinds, *listed} else ""
