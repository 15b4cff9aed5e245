"""Generations of designs, worked on by processes and kept piece by piece, so that a search can be begun again."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.studies.crew import NOWHERE, Crew, Lost
from torsional.studies.optimise.task import Task
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.designs import table
from torsional.studies.sweeps.store import Store, digest, written
from torsional.studies.sweeps.sweep import ASIDE
from torsional.studies.sweeps.work import CRASHES, FAILED, MANY, OK

PIECES = 4
"""Pieces that a generation is cut into, whatever the number of processes."""
Columns = Mapping[str, Sequence[Any]]


@dataclass(frozen=True)
class Answers:
    """What came of some designs: ``figures`` by criterion (designs,), NaN where there is none, and their quantities;
    ``status`` (designs,) and ``reasons`` as sweeps have them."""

    figures: Mapping[str, Array]
    quantities: Mapping[str, str]
    status: IntArray
    reasons: tuple[str, ...]

    @property
    def answered(self) -> Any:
        """Which designs have all figures."""
        known = np.array([np.isfinite(v) for v in self.figures.values()]).reshape(-1, self.status.size)
        return (self.status == OK) & known.all(axis=0)


class Job(Protocol):
    """Something that a process of a search does, and keeps in the store under its own number."""

    def worked(self, at: Bench) -> None:
        """Do it with what the process has."""


@dataclass(frozen=True)
class Piece:
    """Some designs of a generation under the number of their chunk, those ``aside`` not to be tried."""

    number: int
    columns: Columns
    aside: frozenset[int] = frozenset()

    @property
    def key(self) -> np.ndarray:
        """What tells these designs from others, as bytes."""
        return keyed({name: list(values) for name, values in self.columns.items()})

    def worked(self, at: Bench) -> None:
        """Ask the designs."""
        work = at.task.work_on(table(self.columns), at.batch if at.designs >= MANY else None)
        at.store.put(self.number, work.stretch(0, _length(self), self.aside) | {"designs": self.key})


@dataclass
class Generations:
    """The designs of a search, worked on by a ``crew`` and kept in a ``store``.

    ``moved`` is told how many designs are done.
    """

    task: Task
    store: Store
    crew: Crew[Any, None]
    moved: Callable[[int], None]
    done: int = 0
    found: list[tuple[Columns, Answers]] = field(default_factory=list)

    def answers(self, number: int, columns: Columns) -> Answers:
        """What came of the designs of generation ``number``, worked out where it is not kept."""
        pieces = self._cut(number, columns)
        missing = [piece for piece in pieces if self._kept(piece) is None]
        self._moved(sum(map(_length, pieces)) - sum(map(_length, missing)))
        while missing:
            again = []
            for piece, told in self.crew.results(missing):
                if isinstance(told, Lost):
                    again.append(self._lost(piece, told))
                else:
                    self._moved(_length(piece))
            missing = again
        chunks = [self._kept(piece) for piece in pieces]
        answers = answers_of([chunk for chunk in chunks if chunk is not None])
        self.found.append((columns, answers))
        return answers

    def _moved(self, designs: int) -> None:
        self.done += designs
        self.moved(self.done)

    def _cut(self, number: int, columns: Columns) -> list[Piece]:
        count = len(next(iter(columns.values())))
        size = -(-count // PIECES)
        starts = range(0, count, size)
        cut = [{name: list(values[at : at + size]) for name, values in columns.items()} for at in starts]
        return [self._told(Piece(number * PIECES + place, each)) for place, each in enumerate(cut)]

    def _told(self, piece: Piece) -> Piece:
        """The piece with what has ended processes set aside."""
        crashes = self._crashes().items()
        known = {at: times for (number, at), times in crashes if number == piece.number}
        aside = frozenset(at for at, times in known.items() if times >= CRASHES)
        if NOWHERE in aside:
            remedy = "guard the script's main part by if __name__ == '__main__', or ask with one process"
            raise ModelError("no process can work on the optimisation", where="processes", remedy=remedy)
        return Piece(piece.number, piece.columns, aside)

    def _kept(self, piece: Piece) -> dict[str, np.ndarray] | None:
        """The chunk of these designs; one of other designs, of another release of pymoo, is none."""
        chunk = self.store.get(piece.number)
        return chunk if chunk is not None and np.array_equal(chunk["designs"], piece.key) else None

    def _lost(self, piece: Piece, lost: Lost) -> Piece:
        crashes = self._crashes() + Counter([(piece.number, lost.mark)])
        told = [[number, at, times] for (number, at), times in crashes.items()]
        written(self.store.folder / ASIDE, json.dumps(told).encode())
        return self._told(piece)

    def _crashes(self) -> Counter[tuple[int, int]]:
        try:
            told = json.loads((self.store.folder / ASIDE).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return Counter()
        return Counter({(number, at): times for number, at, times in told})


def keyed(values: Any) -> np.ndarray:
    """What tells plain values from others, as bytes."""
    return np.frombuffer(digest(values).encode(), np.uint8)


def _length(piece: Piece) -> int:
    return len(next(iter(piece.columns.values())))


def answers_of(chunks: Sequence[Mapping[str, np.ndarray]]) -> Answers:
    """Chunks of single figures, one after the other; an answer without one of the names of the first is a failure."""
    told = [json.loads(chunk["told"].tobytes()) for chunk in chunks]
    shapes = [json.loads(shape)["variables"] for each in told for shape in each["shapes"]]
    names = {name: about[3].get("quantity", "number") for name, about in (shapes[0] if shapes else {}).items()}
    for shape in shapes:
        _refuse_arrays(shape)
    status = np.concatenate([chunk["status"] for chunk in chunks]).astype(np.int64)
    figures = {name: np.full(status.size, np.nan) for name in names}
    reasons = [""] * status.size
    start = 0
    for chunk, each in zip(chunks, told, strict=True):
        for number, reason in each["reasons"].items():
            reasons[start + int(number)] = reason
        for kind in range(len(each["shapes"])):
            at = start + np.flatnonzero(chunk["kind"] == kind)
            for name in names:
                if f"answer.{kind}.{name}" in chunk:
                    figures[name][at] = chunk[f"answer.{kind}.{name}"].real
        start += len(chunk["status"])
    for place in np.flatnonzero((status == OK) & np.any([np.isnan(v) for v in figures.values()] or [False], axis=0)):
        status[place], reasons[place] = FAILED, "a criterion is no number"
    return Answers(figures, names, status, tuple(reasons))


def _refuse_arrays(shape: Mapping[str, Any]) -> None:
    for name, (dims, size, _, _) in shape.items():
        if size:
            found = " × ".join(f"{n} {dim}" for dim, n in zip(dims, size, strict=True))
            remedy = "take one figure of it: run {analysis: criteria, …}"
            raise ModelError("an objective is a single figure", where=name, found=found, remedy=remedy)


@dataclass
class Bench:
    """What a process of a search works with; many ``designs`` that differ in numbers are asked together."""

    task: Task
    store: Store
    designs: int

    @cached_property
    def batch(self) -> Batch | None:
        """All designs that there may be, where they can be asked together."""
        return self.task.batch()


_HERE: list[Bench] = []


def prepare(task: Task, store: Store, designs: int) -> None:
    """What a process has to know."""
    _HERE[:] = [Bench(task, store, designs)]


def made(job: Job) -> None:
    """Do a job and keep what comes of it."""
    job.worked(_HERE[0])
