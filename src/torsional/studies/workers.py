"""Work in processes of one thread each: spawned, ended at once by Ctrl-C, and what one of them dies of is told."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from torsional.errors import ModelError

Task = TypeVar("Task")
Result = TypeVar("Result")
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS")
PATIENCE = 10.0  # [s] for processes that were killed to be gone, on a busy machine


class Workers(Generic[Task, Result]):
    """Processes that ``prepare`` themselves once and then ``work`` at tasks; a single one is this process itself.

    Functions and what they take must be importable: scripts that use several processes guard their main part by
    ``if __name__ == "__main__"``.
    """

    def __init__(
        self,
        work: Callable[[Task], Result],
        prepare: Callable[..., None],
        given: tuple[Any, ...],
        processes: int | None,
    ) -> None:
        self.count = processes or _processors()
        self._work, self._prepare, self._given = work, prepare, given
        self._pool: ProcessPoolExecutor | None = None
        self._others = set(multiprocessing.active_children())

    def __enter__(self) -> Workers[Task, Result]:
        if self.count == 1:
            self._prepare(*self._given)
        else:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self.count, context, initializer=self._prepare, initargs=self._given)
        return self

    def results(self, tasks: Iterable[Task]) -> Iterator[Result]:
        """What comes of the tasks, as each is done; raises ModelError where a process dies."""
        if self._pool is None:
            yield from map(self._work, tasks)
            return
        with _inherited():
            futures: list[Future[Result]] = [self._pool.submit(self._work, task) for task in tasks]
        try:
            for done in as_completed(futures):
                yield done.result()
        except BrokenProcessPool:
            remedy = "ask fewer processes at a time, where memory is short"
            raise ModelError(
                "a working process ended before its work was done", where="processes", remedy=remedy
            ) from None

    def __exit__(self, kind: type[BaseException] | None, _error: object, _trace: object) -> None:
        if self._pool is None:
            return
        if kind is not None:
            _killed(set(multiprocessing.active_children()) - self._others)
        self._pool.shutdown(wait=kind is None, cancel_futures=True)


def _killed(children: set[BaseProcess]) -> None:
    """All of them, and a moment's patience for each: the pool's own thread may reap one in our place.

    A ``join`` that comes second then returns at once, before the first has noted the end.
    """
    for child in children:
        child.kill()
    latest = time.monotonic() + PATIENCE
    for child in children:
        while child.is_alive() and time.monotonic() < latest:
            child.join(0.02)


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def _inherited() -> Iterator[None]:
    """What processes that are started within it inherit: one thread each, and no ear for Ctrl-C."""
    before = {key: os.environ.get(key) for key in ONE_THREAD}
    heard = signal.getsignal(signal.SIGINT) if threading.current_thread() is threading.main_thread() else None
    if heard is not None:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.update(dict.fromkeys(ONE_THREAD, "1"))
    try:
        yield
    finally:
        for key, value in before.items():
            if value is None:
                del os.environ[key]
            else:
                os.environ[key] = value
        if heard is not None:
            signal.signal(signal.SIGINT, heard)
