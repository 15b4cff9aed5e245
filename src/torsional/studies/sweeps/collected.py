"""The answers of a sweep, taken from its chunks: whole in memory, or written to a file chunk by chunk."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional import __version__
from torsional.results import SCHEMA, save_results
from torsional.studies.sweeps.designs import Designs
from torsional.studies.sweeps.work import FAILED, STATUS, UNEVEN

PICKED = 2_000_000
"""Numbers of which a median is taken."""
Chunk = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Collected:
    """Answers of ``designs`` in ``count`` chunks of ``size``, as ``get`` finds them: None where one is not there.

    The shape of the first answer is the shape of all; answers of another one are failures.
    """

    designs: Designs
    size: int
    count: int
    get: Callable[[int], Chunk | None]

    def _chunks(self) -> Iterator[tuple[slice, Chunk, Mapping[str, Any]]]:
        """Which designs, their chunk, and what it tells in words."""
        for number in range(self.count):
            chunk = self.get(number)
            if chunk is not None:
                start = number * self.size
                yield slice(start, start + chunk["status"].size), chunk, json.loads(chunk["told"].tobytes())

    @cached_property
    def _first(self) -> str:
        """The shape of the first answer, as text."""
        nothing = '{"coordinates": {}, "variables": {}}'
        return next((told["shapes"][0] for _, _, told in self._chunks() if told["shapes"]), nothing)

    @cached_property
    def _shape(self) -> Mapping[str, Any]:
        found: Mapping[str, Any] = json.loads(self._first)
        return found

    def _answers(self, told: Mapping[str, Any], chunk: Chunk) -> dict[str, np.ndarray]:
        """The variables of a chunk, no number where there is no answer of the first shape."""
        count, variables = chunk["status"].size, self._shape["variables"]
        if told["shapes"] == [self._first] and (chunk["kind"] == 0).all():
            return {name: chunk[f"answer.0.{name}"] for name in variables}
        found = {name: _none((count, *size), kind) for name, (_, size, kind, _) in variables.items()}
        for number, shape in enumerate(told["shapes"]):
            for name, values in found.items() if shape == self._first else ():
                values[chunk["kind"] == number] = chunk[f"answer.{number}.{name}"]
        return found

    def _uneven(self, told: Mapping[str, Any], chunk: Chunk) -> np.ndarray:
        """Which designs have an answer of another shape."""
        others = [number for number, shape in enumerate(told["shapes"]) if shape != self._first]
        return np.isin(chunk["kind"], others)

    @property
    def counts(self) -> dict[str, int]:
        """How many designs became what."""
        status = self.states[0]
        return {word.partition(":")[0]: int((status == n).sum()) for n, word in enumerate(STATUS)}

    @cached_property
    def states(self) -> tuple[np.ndarray, np.ndarray]:
        """Status and reason of every design."""
        status, reasons = np.zeros(len(self.designs), np.int8), np.full(len(self.designs), "", dtype=object)
        for part, chunk, told in self._chunks():
            status[part] = chunk["status"]
            for number, reason in told["reasons"].items():
                reasons[int(number)] = reason
            uneven = self._uneven(told, chunk)
            status[part][uneven], reasons[part][uneven] = FAILED, UNEVEN
        return status, reasons

    def whole(self) -> xr.Dataset:
        """All in memory."""
        variables = self._shape["variables"]
        values = {n: _none((len(self.designs), *size), kind) for n, (_, size, kind, _) in variables.items()}
        for part, chunk, told in self._chunks():
            for name, some in self._answers(told, chunk).items():
                values[name][part] = some
        return self._dataset(values)

    def write(self, path: Path) -> None:
        """All into a netCDF file, a chunk at a time: what `save_results` of the whole writes."""
        variables = self._shape["variables"]
        if any(np.dtype(kind).kind in "cb" for _, _, kind, _ in variables.values()):  # what netCDF has no kind for
            save_results(self.whole(), path)
            return
        import h5netcdf

        save_results(self._dataset({}), path)
        with h5netcdf.File(path, "a") as file:
            for name, (dims, size, kind, attrs) in variables.items():
                for dimension, length in zip(dims, size, strict=True):
                    if dimension not in file.dimensions:
                        file.dimensions[dimension] = length
                gap = _fill(kind) if np.dtype(kind).kind == "f" else None
                made = file.create_variable(name, (*self._axes, *dims), np.dtype(kind), fillvalue=gap)
                for key, value in attrs.items():
                    made.attrs[key] = value
            for part, chunk, told in self._chunks():
                for name, some in self._answers(told, chunk).items():
                    _put(file[name], some, part.start, tuple(self._axes.values()))

    def quantity(self, variable: str) -> str:
        """What a variable is."""
        return str(self._shape["variables"][variable][3].get("quantity", "number"))

    def ranges(self) -> dict[str, tuple[float, float, float]]:
        """Least, median and largest number of every variable; the median of two millions of them, picked evenly."""
        ends: dict[str, tuple[float, float]] = {}
        picked: dict[str, list[np.ndarray]] = {}
        for part, chunk, told in self._chunks():
            for name, values in self._answers(told, chunk).items():
                each = values[0].size if len(values) else 1
                step = max(1, len(self.designs) * each // PICKED)
                flat = values.ravel()
                numbers = flat[np.isfinite(flat)] if values.dtype.kind == "f" else flat
                if numbers.size:
                    low, high = ends.get(name, (np.inf, -np.inf))
                    ends[name] = min(low, float(numbers.min())), max(high, float(numbers.max()))
                    picked.setdefault(name, []).append(flat[-(part.start * each) % step :: step])
        found = {}
        for name, (low, high) in ends.items():
            some = np.concatenate(picked[name])
            found[name] = (low, float(np.median(some[np.isfinite(some)])), high)
        return found

    @property
    def _axes(self) -> dict[str, int]:
        """The dimensions of the designs: of a grid one a parameter."""
        if self.designs.method != "grid":
            return {"design": len(self.designs)}
        return {name: len(axis.levels) for name, axis in self.designs.axes.items()}

    def _dataset(self, values: Mapping[str, np.ndarray]) -> xr.Dataset:
        """Some variables along the designs, with what became of each."""
        (status, reasons), axes = self.states, self._axes
        shape, front = tuple(axes.values()), tuple(axes)
        dims = {name: (*front, *own) for name, (own, _, _, _) in self._shape["variables"].items()}
        attrs = {name: told for name, (_, _, _, told) in self._shape["variables"].items()}
        data = {n: (dims[n], v.reshape(*shape, *v.shape[1:]), attrs[n]) for n, v in values.items()}
        told = {"flag_values": list(range(len(STATUS))), "flag_meanings": "; ".join(STATUS)}
        flags = {"status": (front, status.reshape(shape), told), "reason": (front, reasons.reshape(shape))}
        found = xr.Dataset({**data, **flags}, self._labels())
        counts = {f"designs {word}": count for word, count in self.counts.items()}
        head = {"analysis": "sweep", "torsional_version": __version__, "schema": SCHEMA}
        return found.assign_attrs(**head, sampling=json.dumps(self.designs.told), **counts)

    def _labels(self) -> dict[str, Any]:
        """Coordinates: those of the answers, and the designs' values."""
        found = {name: (dims, marks, attrs) for name, (dims, marks, attrs) in self._shape["coordinates"].items()}
        if self.designs.method == "grid":
            return found | {name: (name, _marks(axis.levels)) for name, axis in self.designs.axes.items()}
        columns = self.designs.columns(0, len(self.designs))
        return found | {name: ("design", _marks(column)) for name, column in columns.items()}


def _put(variable: Any, values: np.ndarray, start: int, shape: tuple[int, ...], at: tuple[int, ...] = ()) -> None:
    """Rows from ``start`` on of a grid's flat order into their places, in as few pieces as there are borders."""
    if len(shape) == 1:
        variable[(*at, slice(start, start + len(values)))] = values
        return
    inner = prod(shape[1:])
    while len(values):
        row, within = divmod(start, inner)
        rows = 0 if within else len(values) // inner
        count = rows * inner or min(inner - within, len(values))
        if rows:
            own = values[:count].reshape(rows, *shape[1:], *values.shape[1:])
            variable[(*at, slice(row, row + rows))] = own
        else:
            _put(variable, values[:count], within, shape[1:], (*at, row))
        values, start = values[count:], start + count


def _none(size: Sequence[int], kind: str) -> np.ndarray:
    """No answers yet: no numbers, or zeros of whole ones."""
    dtype = np.dtype(kind)
    return np.full(size, _fill(kind), dtype)


def _fill(kind: str) -> Any:
    dtype = np.dtype(kind)
    return dtype.type(np.nan) if dtype.kind in "fc" else np.zeros((), dtype)[()]


def _marks(values: Any) -> np.ndarray:
    if isinstance(values, np.ndarray):
        return values
    listed = list(values)
    plain = all(isinstance(value, int | float | str | bool) for value in listed)
    same = len({isinstance(value, str) for value in listed}) == 1
    return np.array(listed if plain and same else [json.dumps(value) for value in listed])
