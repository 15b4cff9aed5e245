"""A crew of workers behind a dask scheduler, here or elsewhere: chunks come back as bytes, the driver keeps them.

Workers may come, die and be replaced at any time.  A task that workers died of, as often as the scheduler allows, is
cut down to its chunk, and that, with nothing else under way that could be to blame, to its designs one by one.
"""

from __future__ import annotations

import contextlib
import queue
import statistics
import time
import uuid
import warnings
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from torsional import __version__
from torsional.errors import ModelError
from torsional.studies.crew import NOWHERE, Lost
from torsional.studies.sweeps.clients import joined, library
from torsional.studies.sweeps.identity import code
from torsional.studies.sweeps.remote import DONE, OTHER, UNKNOWN, Reply, answered, source
from torsional.studies.sweeps.work import CRASHES

if TYPE_CHECKING:
    from torsional.studies.sweeps.sweep import Pieces
    from torsional.studies.sweeps.workers import Workers

ENOUGH = 1.0  # [s] of work in a task, beside which its way there and back is nothing
RECENT = 16  # chunks whose cost is remembered
BESIDE = 2  # tasks a worker, so that none waits
LOOK = 0.5  # [s] between looks at who is there
COMING = 60.0  # [s] for an answer that is done to come
LONELY = 30.0  # [s] without any worker before that is told
KEPT = "what was worked out is kept in the folder: --resume, or the same call, goes on"


@dataclass(frozen=True)
class _Task:
    """Chunks, or one ``design``."""

    numbers: tuple[int, ...]
    design: int = NOWHERE


class ClusterCrew:
    """Workers that make chunks of a sweep; designs that ``aside`` tells are not tried."""

    def __init__(self, pieces: Pieces, workers: Workers, aside: Callable[[], Collection[int]]) -> None:
        self._pieces, self._workers, self._aside = pieces, workers, aside
        self._key = f"{pieces.store.key}-{uuid.uuid4().hex}"
        self._ended = contextlib.ExitStack()
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._out: dict[str, tuple[_Task, Any]] = {}
        self._costs: deque[float] = deque(maxlen=RECENT)
        self._given = self._deaths = 0
        self._client: Any = None
        self._here: dict[str, int] = {}
        self._looked, self._seen = 0.0, time.monotonic()

    def __enter__(self) -> ClusterCrew:
        with self._ended:
            self._client = self._ended.enter_context(joined(self._workers))
            self._payload = _sent(self._pieces)
            self._address = str(self._client.scheduler.address)
            self._ended = self._ended.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        with self._ended, contextlib.suppress(Exception):
            self._client.cancel([future for _, future in self._out.values()])

    def results(self, numbers: Iterable[int]) -> Iterator[tuple[int, bytes | Lost]]:
        """The chunks as bytes, each as it is done; `Lost` for each design of one that workers died of."""
        waiting, doubtful, suspected = deque(numbers), deque[int](), list[int]()
        while waiting or doubtful or self._out:
            self._busied(waiting, doubtful)
            for task, told in self._news():
                if told is not None:
                    yield from self._chunks(task, told)
                elif len(task.numbers) > 1:
                    doubtful.extend(task.numbers)
                else:
                    suspected.extend(task.numbers)
        for number in suspected:
            yield from self._examined(number)

    def _chunks(self, task: _Task, told: Reply) -> Iterator[tuple[int, bytes]]:
        self._costs.extend(told.seconds)
        yield from zip(task.numbers, told.found, strict=True)

    def _examined(self, number: int) -> Iterator[tuple[int, bytes | Lost]]:
        """What came of a chunk that workers died of, with nothing else under way: designs they die of, or the chunk."""
        left = [design for design in self._pieces.designs(number) if design not in self._aside()]
        guilty = [design for design in left if self._alone(_Task((number,), design)) is None]
        yield from ((number, Lost(design, None, CRASHES)) for design in guilty)
        if not guilty:
            task = _Task((number,))
            told = self._alone(task)
            yield from self._chunks(task, told) if told else [(number, Lost(NOWHERE, None, CRASHES))]

    def _alone(self, task: _Task) -> Reply | None:
        """The answer of a task with nothing else under way; None where it ended too many workers."""
        ended = self._deaths
        while self._deaths < ended + CRASHES:
            self._submit(task)
            told = next(told for told in self._awaited())
            if told is not None:
                return told
        return None

    def _awaited(self) -> Iterator[Reply | None]:
        while True:
            yield from (told for _, told in self._news())

    def _busied(self, waiting: deque[int], doubtful: deque[int]) -> None:
        """Keep every worker busy: chunks that are not in doubt together, as many as take long enough."""
        self._look()
        while len(self._out) < BESIDE * max(1, len(self._here)) and (waiting or doubtful):
            if doubtful:
                self._submit(_Task((doubtful.popleft(),)))
                continue
            together = max(1, round(ENOUGH / statistics.median(self._costs) + 0.5)) if self._costs else 1
            self._submit(_Task(tuple(waiting.popleft() for _ in range(min(together, len(waiting))))))

    def _submit(self, task: _Task, unaware: bool = False) -> None:
        """Ask a task; with the sweep itself, where a worker was ``unaware`` of it.

        No worker is preferred: should it die, the scheduler would wait for it to come back.
        """
        self._given += 1
        key = f"torsional-{self._key}-{self._given}"
        aside, payload = sorted(self._aside()), self._payload if unaware else b""
        asked = code(), self._key, task.numbers, aside, task.design, payload
        with self._connected(), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Sending large graph")
            future = self._client.submit(answered, *asked, key=key, pure=False)
        self._out[key] = task, future
        future.add_done_callback(self._done.put)

    def _news(self) -> Iterator[tuple[_Task, Reply | None]]:
        """Tasks that are done, each with its answer, None where workers died of it; none after a while without."""
        try:
            future = self._done.get(timeout=LOOK)
        except queue.Empty:
            self._look()
            return
        try:
            told = self._told(future)
        except TimeoutError:  # its worker died with the answer: it is worked out again
            future.add_done_callback(self._done.put)
            return
        task, _ = self._out.pop(future.key)
        if told is not None and told.kind == UNKNOWN:
            self._submit(task, unaware=True)
            return
        yield task, told

    def _told(self, future: Any) -> Reply | None:
        """The answer of a task; None where workers died of it.

        Raises ModelError for what none can answer, and TimeoutError for an answer that is done and does not come.
        """
        from distributed import KilledWorker
        from distributed.comm.core import CommClosedError

        try:
            told: Reply = future.result(COMING)
        except KilledWorker as error:
            self._deaths += error.allowed_failures + 1
            return None
        except TimeoutError:
            raise
        except Exception as error:  # what the libraries there say, or that the connection is lost
            if future.cancelled() or isinstance(error, CommClosedError):
                raise self._gone() from None
            self._look(LOOK)
            raise _unbegun(self._address, error) from None
        if told.kind in (DONE, UNKNOWN):
            return told
        raise _refusal(told)

    def _look(self, since: float = 0.0) -> None:
        """See who is there, from time to time (``since``: as if that were longer ago), and say so where nobody is."""
        now = time.monotonic()
        if now - self._looked + since < LOOK:
            return
        self._looked = now
        if self._client.status != "running":
            raise self._gone()
        with self._connected():
            self._here = dict(self._client.nthreads())
        if self._here:
            self._seen = now
        elif now - self._seen > LONELY:
            self._seen = float("inf")
            warnings.warn(f"{self._address} has no worker; waiting for one", stacklevel=2)

    @contextlib.contextmanager
    def _connected(self) -> Iterator[None]:
        """What a lost connection raises, as a ModelError."""
        from concurrent.futures import CancelledError

        try:
            yield
        except (OSError, CancelledError, RuntimeError) as error:
            raise self._gone(str(error).split("\n")[0]) from None

    def _gone(self, found: str = "") -> ModelError:
        return ModelError("the scheduler has gone", where=self._address, found=found, remedy=KEPT)


def _sent(pieces: Pieces) -> bytes:
    """The sweep as bytes: functions of scripts and those without a name by what they do, others by their name."""
    texts = {name: source(getattr(pieces.work, name)) for name in ("build", "run")}
    try:
        return bytes(library("cloudpickle").dumps((texts, pieces)))
    except Exception as error:  # whatever the objects that a function takes from around it say
        found = f"{type(error).__name__}: {error}"
        problem = "workers cannot be sent these functions"
        remedy = "take nothing from around them that is open or locked"
        raise ModelError(problem, where="sweep", found=found, remedy=remedy) from None


def _unbegun(address: str, error: Exception) -> ModelError:
    problem, remedy = "workers there cannot begin", f"install torsional {__version__} for scheduler and workers"
    found = f"{type(error).__name__}: {error}".split("\n")[0]
    return ModelError(problem, where=address, found=found, remedy=remedy)


def _refusal(told: Reply) -> ModelError:
    if told.kind == OTHER:
        version, theirs = told.found
        found = f"torsional {version} with code {theirs[:12]} there, {__version__} with {code()[:12]} here"
        remedy = "install the same there; other code may answer otherwise"
        return ModelError("a worker has other code than this one", where=told.address, found=found, remedy=remedy)
    remedy = "install there what they need, or define them in the script itself"
    problem = "a worker cannot read the functions it is sent"
    return ModelError(problem, where=told.address, found=told.found[0], remedy=remedy)
