"""What makes a sweep the same sweep: its plan as plain values, and the code that works on it."""

from __future__ import annotations

import contextlib
import hashlib
import inspect
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional import __version__
from torsional.model import Model
from torsional.studies.sweeps.store import digest
from torsional.studies.sweeps.work import Work


def plan_of(work: Work) -> dict[str, Any]:
    """What the sweep is, as plain values: the same for the same sweep."""
    build = work.build.hash if isinstance(work.build, Model) else _source(work.build)
    axes = {
        name: list(axis.levels) or {"low": axis.low, "high": axis.high, "log": axis.log}
        for name, axis in work.designs.axes.items()
    }
    designs = {"method": work.designs.method, "count": len(work.designs), "seed": work.designs.seed, "axes": axes}
    return {"torsional_sweep": 1, "build": build, "designs": designs, "run": _source(work.run)}


def _source(function: Any) -> str:
    """A function by its name, its text and the data it takes from around it; an analysis of a plan by its settings."""
    if hasattr(function, "settings"):
        return digest([type(function).__name__, function.settings])
    if isinstance(function, partial):
        return digest([_source(function.func), _data(function.args), _data(function.keywords)])
    name = f"{getattr(function, '__module__', '')}.{getattr(function, '__qualname__', repr(type(function)))}"
    with contextlib.suppress(OSError, TypeError, ValueError):
        around = inspect.getclosurevars(function)
        taken = [around.globals, around.nonlocals, function.__defaults__ or (), function.__kwdefaults__ or {}]
        return f"{name} {digest([inspect.getsource(function), *map(_data, taken)])[:16]}"
    return name


def _data(value: Any) -> Any:
    """What a value is, for the hash: plain data and arrays by what they hold, a model by its hash, all else by name."""
    if isinstance(value, np.ndarray):
        return [str(value.dtype), value.shape, hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()]
    if isinstance(value, Mapping):
        return {str(key): _data(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_data(item) for item in value]
    if isinstance(value, set | frozenset):
        return sorted(map(repr, value))
    if isinstance(value, xr.DataArray | xr.Dataset):
        return _data(value.to_dict())
    if isinstance(value, Model):
        return value.hash
    if is_dataclass(value) and not isinstance(value, type):
        return [type(value).__qualname__, {each.name: _data(getattr(value, each.name)) for each in fields(value)}]
    plain = value is None or isinstance(value, str | int | float | complex | bytes | np.generic)
    return repr(value) if plain else getattr(value, "__qualname__", type(value).__qualname__)


@cache
def code() -> str:
    """The version of this package and a hash of all its sources: other code may answer otherwise."""
    told = hashlib.sha256(__version__.encode())
    for source in _sources():
        told.update(source.read_bytes())
    return told.hexdigest()


def _sources() -> Iterator[Path]:
    yield from sorted(Path(__file__).parents[2].rglob("*.py"))
