"""The work on a stretch of designs: each built and asked by itself, each failure with a status and a reason."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Protocol, TypeAlias, runtime_checkable

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.arrays import IntArray
from torsional.numerics.compiling import WATCH
from torsional.studies.crew import marked
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.designs import Designs, Values
from torsional.studies.sweeps.store import json_of
from torsional.system import BoolArray

OK, REFUSED, FAILED, CRASHED = range(4)
STATUS = ("ok", "refused: the model or the analysis cannot be", "failed: an error that nobody expected",
          "crashed: ended the process that worked on it")  # fmt: skip
"""What became of a design, by its status."""
CRASHES = 3
"""How often a design may end a process before it is set aside."""
UNEVEN = "its answer has other names, sizes or kinds than the first one"
MANY = 200
"""Designs from which on they are asked together where that can be: finding their numbers costs as much as fifty."""
AT_ONCE = 1000
"""Designs asked in one call, for the memory's sake."""
Answer: TypeAlias = xr.Dataset | Mapping[str, Any]
Run: TypeAlias = Callable[[Model], Answer]
Build: TypeAlias = Model | Callable[..., Model]


@runtime_checkable
class Together(Protocol):
    """An analysis that can ask designs together, through the numbers of their systems."""

    def possible(self, batch: Batch) -> bool:
        """Whether it can ask these designs so."""

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of some designs (designs,); the others are asked one by one."""

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The answers of designs that are covered, ``design`` in front: as those of each alone, but for rounding."""


@runtime_checkable
class ByNumbers(Protocol):
    """An analysis that asks designs one at a time, but needs the numbers of their systems alone."""

    def possible(self, batch: Batch) -> bool:
        """Whether it can ask these designs so."""

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of some designs (designs,); the others are built."""

    def each(self, batch: Batch, columns: Mapping[str, Any]) -> Callable[[int], Answer]:
        """The answer of any of the designs of ``columns`` that are covered: as those of each built but for rounding."""


@dataclass(frozen=True)
class Work:
    """What is asked of the ``designs``: each is built and run.

    ``build``: a model whose key paths the designs change, or a function of the named values that makes one; ``run``: a
    function of a model that gives a Dataset, or numbers and arrays by name, of the same shape for every design;
    ``batch``: of more designs than these, which are then asked together with them.
    """

    build: Build
    designs: Designs
    run: Run
    batch: Batch | None = None

    def stretch(self, start: int, stop: int, aside: Collection[int] = ()) -> dict[str, np.ndarray]:
        """The chunk of designs ``start`` to ``stop`` − 1; designs ``aside`` are not tried.

        ``status`` (design,); ``told``: reasons by number and the shapes of answers, as text; ``kind`` (design,): which
        of the shapes an answer has, -1 for none; ``answer.K.NAME``: the answers of kind K, one after the other.
        """
        piece = _Piece(start, stop - start)
        with WATCH.silent():
            left = self._together(piece, aside)
            known = self._by_numbers(start, stop)
            for place, values in zip(left, self._rows(start, stop, left), strict=True):
                status, reason, answer = self._tried(start + place, values, aside, known.get(place))
                piece.tell(place, status, reason)
                if answer is not None:
                    piece.take(np.array([place]), answer.expand_dims("design"))
        return piece.arrays()

    def _rows(self, start: int, stop: int, left: Sequence[int]) -> list[Values]:
        rows = self.designs.rows(start, stop) if left else []
        return [rows[place] for place in left]

    @cached_property
    def _batch(self) -> Batch | None:
        """Designs asked together or by their numbers, where the analysis can and there are enough of them."""
        if self.batch is not None:
            return self.batch
        able = isinstance(self.run, Together | ByNumbers)
        if not (isinstance(self.build, Model) and able and len(self.designs) >= MANY):
            return None
        batch = Batch.of(self.build, self.designs)
        return batch if batch is not None and self.run.possible(batch) else None  # type: ignore[attr-defined]

    def _by_numbers(self, start: int, stop: int) -> dict[int, Callable[[], Answer]]:
        """How to ask those designs of a stretch, by place, that need not be built."""
        if self._batch is None or not isinstance(self.run, ByNumbers):
            return {}
        columns = self.designs.columns(start, stop)
        fine = np.flatnonzero(self.run.covers(self._batch, columns))
        if not fine.size:
            return {}
        try:
            each = self.run.each(self._batch, _chosen(columns, fine))
        except ModelError:  # refused for every design, each with its reason
            return {}
        return {place: partial(each, design) for design, place in enumerate(fine.tolist())}

    def _together(self, piece: _Piece, aside: Collection[int]) -> list[int]:
        """Answer the designs that can be asked together; the places of those that are left."""
        every = np.arange(piece.count)
        if self._batch is None or not isinstance(self.run, Together):
            return every.tolist()
        marked(piece.start)
        columns = self.designs.columns(piece.start, piece.start + piece.count)
        fine = self.run.covers(self._batch, columns) & ~np.isin(every + piece.start, list(aside))
        chosen = [every[fine][first : first + AT_ONCE] for first in range(0, int(fine.sum()), AT_ONCE)]
        try:
            found = [self.run.many(self._batch, _chosen(columns, places)) for places in chosen]
        except ModelError:  # what the analysis refuses it refuses for every design, each with its reason
            return every.tolist()
        for places, answers in zip(chosen, found, strict=True):
            piece.take(places, answers)
        return every[~fine].tolist()

    def _tried(
        self, number: int, values: Values, aside: Collection[int], known: Callable[[], Answer] | None = None
    ) -> tuple[int, str, xr.Dataset | None]:
        """A design with its status and reason; one that is refused as it is ``known`` is built to be told why."""
        if number in aside:
            return CRASHED, f"ended {CRASHES} processes", None
        marked(number)
        try:
            if known is not None:
                with suppress(ModelError):
                    return OK, "", _figures(known())
            model = changed(self.build, dict(values)) if isinstance(self.build, Model) else self.build(**values)
            return OK, "", _figures(self.run(model))
        except ModelError as error:
            return REFUSED, str(error), None
        except Exception as error:  # one design's defect must not cost the answers of a million others
            return FAILED, f"{type(error).__name__}: {error}", None


def _chosen(columns: Mapping[str, Any], places: IntArray) -> dict[str, Any]:
    return {
        name: column[places] if isinstance(column, np.ndarray) else [column[place] for place in places]
        for name, column in columns.items()
    }


@dataclass
class _Piece:
    """What comes of a stretch of designs, in the order in which it is found."""

    start: int
    count: int

    def __post_init__(self) -> None:
        self.status, self.kind = np.zeros(self.count, np.int8), np.full(self.count, -1, np.int32)
        self.reasons: dict[int, str] = {}
        self.shapes: list[str] = []
        self.parts: list[list[tuple[IntArray, xr.Dataset]]] = []

    def tell(self, place: int, status: int, reason: str) -> None:
        """What became of one design."""
        self.status[place] = status
        if reason:
            self.reasons[self.start + place] = reason

    def take(self, places: IntArray, answers: xr.Dataset) -> None:
        """Answers of some designs, with ``design`` in front."""
        shape = json_of(shape_of(answers.isel(design=0)))
        if shape not in self.shapes:
            self.shapes.append(shape)
            self.parts.append([])
        self.kind[places] = number = self.shapes.index(shape)
        self.parts[number].append((places, answers))

    def arrays(self) -> dict[str, np.ndarray]:
        """All of it in the order of the designs."""
        text = json_of({"shapes": self.shapes, "reasons": self.reasons}).encode()
        found: dict[str, np.ndarray] = {"status": self.status, "kind": self.kind, "told": np.frombuffer(text, np.uint8)}
        for number, parts in enumerate(self.parts):
            order = np.argsort(np.concatenate([places for places, _ in parts]))
            for name in parts[0][1].data_vars:
                values = np.concatenate([answers[name].values for _, answers in parts])
                found[f"answer.{number}.{name}"] = values if (order[1:] > order[:-1]).all() else values[order]
        return found


def _figures(answer: Answer) -> xr.Dataset:
    """The numbers of an answer; what labels its dimensions with other numbers may differ from design to design."""
    data = (answer if isinstance(answer, xr.Dataset) else xr.Dataset(dict(answer))).reset_coords()
    return data[[name for name, values in data.data_vars.items() if values.dtype.kind in "fciub"]]


def shape_of(answer: xr.Dataset) -> dict[str, Any]:
    """What all answers of a sweep share: dimensions, sizes, kinds and attributes of the variables, and coordinates."""
    variables = {
        str(name): [list(map(str, v.dims)), list(v.shape), v.dtype.str, _plain(v.attrs)]
        for name, v in answer.data_vars.items()
    }
    coordinates = {
        str(name): [list(map(str, c.dims)), c.values.tolist(), _plain(c.attrs)] for name, c in answer.coords.items()
    }
    return {"variables": variables, "coordinates": coordinates}


def _plain(attrs: Mapping[Any, Any]) -> dict[str, Any]:
    return {str(k): v.item() if isinstance(v, np.generic) else v for k, v in attrs.items()}
