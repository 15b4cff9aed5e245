"""One analysis of many designs: in memory or in a folder that can be gone back to, on any number of processes."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import tempfile
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.studies.crew import NOWHERE, Crew, Lost
from torsional.studies.sweeps.cluster import ClusterCrew
from torsional.studies.sweeps.collected import Collected
from torsional.studies.sweeps.designs import Designs, grid
from torsional.studies.sweeps.identity import code, plan_of
from torsional.studies.sweeps.store import Store, written
from torsional.studies.sweeps.work import CRASHES, Build, Run, Work
from torsional.studies.sweeps.workers import Processes, Workers
from torsional.units import quoted

CHUNK = 100
"""Designs of a chunk unless told."""
ASIDE = "crashes.json"
Progress = Callable[[int, int], None]


def sweep(
    build: Build,
    over: Designs | Mapping[str, Sequence[Any]],
    run: Run,
    *,
    folder: str | os.PathLike[str] | None = None,
    chunk: int = CHUNK,
    processes: int | None = 1,
    cluster: Workers = None,
    progress: Progress = lambda done, total: None,
) -> xr.Dataset:
    """The answers of ``run`` for every design, with the designs as a dimension, or a dimension a parameter of a grid.

    ``build``: a model whose key paths are changed, or a function of the named values that makes one; ``over``: designs,
    or levels by parameter for all their combinations; ``run``: a function of a model that gives a Dataset, or figures
    by name.  A design without an answer has NaN, a ``status`` other than 0 and a ``reason``.  With a ``folder`` all
    that was worked out is kept there in pieces of ``chunk`` designs, and the same call goes on where it was ended.
    The figures are the same whatever the number of ``processes`` (None: one a processor) and the size of a chunk, and
    on a ``cluster``: the address of a dask scheduler, a ``distributed.Client``, or settings of `workers`.

    Raises ModelError for designs that cannot be, a folder that holds another sweep or cannot be written, functions that
    several processes cannot be given, and where no process can work or a scheduler does not answer any more.

    >>> from torsional.files.load import load_model
    >>> truck = load_model("examples/truck_dmf.yaml")
    >>> found = sweep(truck, {"clutch.stiffness": [2e4, -1.0]}, lambda model: {"gears": len(model.gears)})
    >>> found.gears.values.tolist(), found.status.values.tolist()
    ([12, 0], [0, 1])
    """
    designs = over if isinstance(over, Designs) else grid(over)
    if chunk < 1:
        raise ModelError("a chunk has at least one design", where="chunk", found=str(chunk))
    if cluster is None and processes != 1:
        refuse_unsendable(build, run)
    with contextlib.ExitStack() as stack:
        at = folder or stack.enter_context(tempfile.TemporaryDirectory(prefix="torsional-"))
        pieces = Pieces.of(Work(build, designs, run), at, chunk)
        pieces.worked(processes if cluster is None else cluster, progress)
        return pieces.collected().whole()


@dataclass(frozen=True)
class Pieces:
    """A sweep cut into chunks of ``size`` designs that lie in a ``store``."""

    store: Store
    work: Work
    size: int

    @classmethod
    def of(cls, work: Work, folder: str | os.PathLike[str], size: int) -> Pieces:
        """The pieces of some work in a folder, which is made; raises ModelError where it cannot be."""
        with writing(folder):
            return cls(Store.begun(folder, plan_of(work), f"{code()} by {size}"), work, size)

    @property
    def count(self) -> int:
        """How many chunks there are."""
        return -(-len(self.work.designs) // self.size)

    def worked(self, workers: Workers, progress: Progress) -> None:
        """Work on what is missing until nothing is; raises ModelError where the folder cannot be written any more."""
        with writing(self.store.folder):
            self._worked(workers, progress)

    def _worked(self, workers: Workers, progress: Progress) -> None:
        designs, missing = len(self.work.designs), self.store.missing(self.count)
        done = designs - sum(self.length(number) for number in missing)
        progress(done, designs)
        with self._crew(workers) as crew:
            while missing:
                again: list[int] = []
                for number, told in crew.results(missing):
                    if isinstance(told, Lost):
                        self._lost(number, told)
                        again += [number] * (number not in again)
                        continue
                    if told is not None:
                        self.store.keep(number, told)
                    done += self.length(number)
                    progress(done, designs)
                missing = again

    def _crew(self, workers: Workers) -> Crew[int, None] | ClusterCrew:
        """Processes here, which keep what they make themselves, or workers of a cluster, which hand it over."""
        if isinstance(workers, Processes):
            workers = workers.count or None
        if workers is None or isinstance(workers, int):
            return Crew(_work, _prepare, (self,), workers)
        return ClusterCrew(self, workers, self.aside)

    def made(self, number: int) -> None:
        """Work on one chunk and keep it."""
        self.store.put(number, self.figures(number, self.aside()))

    def figures(self, number: int, aside: Collection[int]) -> dict[str, np.ndarray]:
        """One chunk; designs ``aside`` are not tried."""
        at = self.designs(number)
        return self.work.stretch(at.start, at.stop, aside)

    def aside(self) -> set[int]:
        """Designs that have ended processes so often that they are not tried any more."""
        return {design for design, times in self._crashes().items() if times >= CRASHES}

    def designs(self, number: int) -> range:
        """The designs of a chunk."""
        return range(number * self.size, number * self.size + self.length(number))

    def length(self, number: int) -> int:
        """How many designs a chunk has."""
        return min(self.size, len(self.work.designs) - number * self.size)

    def _lost(self, number: int, lost: Lost) -> None:
        """Note at which design a process died; a chunk that none can begin is refused."""
        at = lost.mark if lost.mark != NOWHERE else -1 - number
        crashes = self._crashes() + Counter({at: lost.times})
        written(self.store.folder / ASIDE, json.dumps(crashes).encode())
        if at < 0 and crashes[at] >= CRASHES:
            raise _unworkable(lost)

    def _crashes(self) -> Counter[int]:
        try:
            told = json.loads((self.store.folder / ASIDE).read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return Counter()
        return Counter({int(design): int(times) for design, times in told.items()})

    def collected(self) -> Collected:
        """The answers of all chunks."""
        return Collected(self.work.designs, self.size, self.count, self.store.get)


def _unworkable(lost: Lost) -> ModelError:
    remedy = "give workers more memory, or ask by smaller chunks"
    found = "each design by itself does not, but all of a chunk do"
    if lost.code is not None:
        remedy = "guard the script's main part by if __name__ == '__main__', or ask with one process"
        found = f"ended with exit code {lost.code}"
    return ModelError("the sweep ends every process that works on it", where="workers", found=found, remedy=remedy)


def refuse_unsendable(*functions: object) -> None:
    """ModelError for a function that cannot be sent to another process."""
    for each in functions:
        try:
            pickle.dumps(each)
        except (pickle.PicklingError, AttributeError, TypeError):
            remedy = "define it by def at the top of a module, or ask with processes=1"
            problem = "several processes cannot be given this function"
            raise ModelError(
                problem, where="sweep", found=getattr(each, "__name__", quoted(each)), remedy=remedy
            ) from None


@contextlib.contextmanager
def writing(folder: str | os.PathLike[str]) -> Iterator[None]:
    """What the system says against writing, as a ModelError that names the folder."""
    try:
        yield
    except OSError as error:
        remedy = "what was worked out is kept: make room, and go on with the same call"
        found = error.strerror or str(error)
        raise ModelError("the folder cannot be written", where=str(folder), found=found, remedy=remedy) from None


_HERE: dict[str, Pieces] = {}


def _prepare(pieces: Pieces) -> None:
    _HERE["pieces"] = pieces


def _work(number: int) -> None:
    _HERE["pieces"].made(number)
