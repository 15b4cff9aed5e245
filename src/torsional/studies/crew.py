"""Processes that do tasks side by side: one thread each, deaf to Ctrl-C, ended at once with us, replaced when they die.

What a process dies of (memory, a defect of compiled code, somebody's signal) costs its task alone: that comes back as
`Lost`, with the mark that the work had set last, and another process takes its place.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any, Generic, TypeVar

Task = TypeVar("Task")
Result = TypeVar("Result")
ONE_THREAD = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS")
PATIENCE = 10.0  # [s] for processes that were killed to be gone, on a busy machine
NOWHERE = -1
_MARK: Any = None


@dataclass(frozen=True)
class Lost:
    """A task whose process died: the ``mark`` it had set last, `NOWHERE` if none, its exit ``code`` (None: not known),
    and how many ``times`` that happened."""

    mark: int
    code: int | None
    times: int = 1


class Member(Generic[Task]):
    """One process, the pipe to it and the task it is at.

    It prepares itself before its first task; what comes back over the ``pipe`` is whether the work was done, and its
    result, or the error that it raised.
    """

    def __init__(self, work: Callable[[Task], Any], prepare: Callable[..., None], given: tuple[Any, ...]) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.mark = context.RawValue("q", NOWHERE)
        self.process: SpawnProcess = context.Process(
            target=_working, args=(theirs, self.mark, work, prepare), daemon=True
        )
        with inherited():
            self.process.start()
        theirs.close()
        # not as arguments: one that dies before it has read many of them would never let `start` return
        with contextlib.suppress(OSError):
            self.pipe.send(given)
        self.task: Task | None = None
        self.busy = False

    def give(self, task: Task) -> None:
        """Raises OSError where the process has died."""
        self.task, self.mark.value = task, NOWHERE
        self.pipe.send(task)
        self.busy = True

    def begin(self, task: Task) -> None:
        """Its first task; of a process that has died already the pipe tells it."""
        with contextlib.suppress(OSError):
            self.give(task)
        self.busy = True


class Crew(Generic[Task, Result]):
    """Processes that ``prepare`` themselves once and then ``work`` at tasks; a single one is this process itself.

    Functions and what they take must be importable: scripts that use several processes guard their main part by
    ``if __name__ == "__main__"``.  An error that ``work`` raises is raised here.
    """

    def __init__(
        self,
        work: Callable[[Task], Result],
        prepare: Callable[..., None],
        given: tuple[Any, ...],
        processes: int | None = None,
    ) -> None:
        self.count = processes or processors()
        self._work, self._prepare, self._given = work, prepare, given
        self._members: list[Member[Task]] = []

    def __enter__(self) -> Crew[Task, Result]:
        if self.count == 1:
            self._prepare(*self._given)
        return self

    def results(self, tasks: Iterable[Task]) -> Iterator[tuple[Task, Result | Lost]]:
        """What comes of the tasks, each as it is done."""
        if self.count == 1:
            yield from ((task, self._work(task)) for task in tasks)
            return
        waiting = iter(tasks)
        while True:
            self._busied(waiting)
            at_work = {member.pipe: member for member in self._members if member.busy}
            if not at_work:
                return
            for ready in wait(list(at_work)):
                assert isinstance(ready, Connection)
                yield self._received(at_work[ready])

    def _busied(self, waiting: Iterator[Task]) -> None:
        """Give every idle process a task, and start processes while tasks are left."""
        while len([member for member in self._members if member.busy]) < self.count:
            try:
                task = next(waiting)
            except StopIteration:
                return
            self._given_to_somebody(task)

    def _given_to_somebody(self, task: Task) -> None:
        """A process that has died while it had nothing to do takes no task, and its place is free."""
        for member in [member for member in self._members if not member.busy]:
            try:
                member.give(task)
                return
            except OSError:
                self._members.remove(member)
        self._members.append(Member(self._work, self._prepare, self._given))
        self._members[-1].begin(task)

    def _received(self, member: Member[Task]) -> tuple[Task, Result | Lost]:
        task: Any = member.task
        try:
            fine, told = member.pipe.recv()
        except (EOFError, OSError):
            self._members.remove(member)
            member.process.join(PATIENCE)
            return task, Lost(int(member.mark.value), member.process.exitcode)
        member.busy = False
        if not fine:
            raise told
        return task, told

    def __exit__(self, *_: object) -> None:
        for member in self._members:
            member.process.kill()
        latest = time.monotonic() + PATIENCE
        for member in self._members:
            member.process.join(max(0.0, latest - time.monotonic()))
            member.pipe.close()
        self._members.clear()


def marked(place: int) -> None:
    """Say, from within the work, which place it is at, for the case that it dies there."""
    if _MARK is not None:
        _MARK.value = place


def processors() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _working(
    pipe: Connection,
    mark: Any,
    work: Callable[[Any], Any],
    prepare: Callable[..., None],
) -> None:
    """What a process does: tasks until the pipe ends, or those who asked have gone."""
    global _MARK
    _MARK = mark
    prepared = False
    with contextlib.suppress(EOFError, OSError):
        given = pipe.recv()
        while True:
            task = pipe.recv()
            try:
                if not prepared:
                    prepare(*given)
                    prepared = True
                told = True, work(task)
            except Exception as error:
                told = False, error
            pipe.send(told)


@contextmanager
def inherited() -> Iterator[None]:
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
