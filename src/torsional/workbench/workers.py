"""Processes that work out answers: a bounded queue served session by session, a time limit, and others for who falls.

Everything here runs in the server's event loop; a thread for each process waits at its pipe.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import os
import warnings
from collections import OrderedDict, deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from torsional.errors import ModelError
from torsional.studies.crew import Member
from torsional.workbench.refusals import RefusedError, faults, refused

WAITING, OWN = 64, 8
"""How many requests may wait altogether, and how many of one session."""
PATIENCE = 60.0
"""Time [s] that a request waits for its turn."""
BEGINNING = 600.0
"""Time [s] that a process may take to begin: it may have to compile."""
MEMORY = 4_000_000_000
"""Bytes that a process may take up."""

Task = tuple[str, tuple[Any, ...]]


@dataclass(eq=False)
class _Ticket:
    """A request that waits, and where its answer goes."""

    task: Task
    answer: asyncio.Future[Any]


class Workers:
    """``count`` processes that ``work`` at tasks, each within ``limit`` seconds.

    ``first``: a task that every process does before any other, so that what it imports and compiles is there.
    """

    def __init__(
        self,
        work: Callable[[Task], Any],
        count: int,
        limit: float,
        first: Task | None = None,
        *,
        nice: int = 0,
        patience: float = PATIENCE,
        waiting: int = WAITING,
        own: int = OWN,
    ) -> None:
        self._work, self._count, self._limit, self._first = work, count, limit, first
        self._nice, self._patience, self._most, self._own = nice, patience, waiting, own
        self._queues: OrderedDict[str, deque[_Ticket]] = OrderedDict()
        self._idle: list[Member[Task]] = []
        self._all: list[Member[Task]] = []
        self._going: set[asyncio.Task[None]] = set()
        self._threads = ThreadPoolExecutor(count, thread_name_prefix="workbench")
        self._turn = asyncio.Lock()
        self._open = False

    def begin(self) -> None:
        """Start the processes, if that has not been done."""
        if not self._open:
            self._open = True
            for _ in range(self._count):
                self._go(self._begun())

    def close(self) -> None:
        """End the processes, and whatever they are at."""
        self._open = False
        for going in self._going:
            going.cancel()
        for member in list(self._all):
            self._ended(member)
        self._threads.shutdown(wait=False, cancel_futures=True)

    async def answer(self, task: Task, session: str) -> Any:
        """What a task gives; RefusedError where it is refused, lasts too long, or too much is waiting already.

        Cancelled while it waits, it is given up; a process that is at it goes on to its end.
        """
        self.begin()
        queue = self._queues.get(session, deque())
        if len(queue) >= self._own or sum(map(len, self._queues.values())) >= self._most:
            raise refused(429, "too many requests are waiting", remedy="wait for the answers of earlier ones")
        ticket = _Ticket(task, asyncio.get_running_loop().create_future())
        queue.append(ticket)
        self._queues[session] = queue
        self._hand_out()
        try:
            return await asyncio.wait_for(ticket.answer, self._patience + self._limit)
        except TimeoutError:
            raise refused(429, "the server is at work on other things", remedy="ask again") from None
        finally:
            self._forget(session, ticket)

    def _forget(self, session: str, ticket: _Ticket) -> None:
        queue = self._queues.get(session, deque())
        with contextlib.suppress(ValueError):
            queue.remove(ticket)
        if not queue:
            self._queues.pop(session, None)

    def _hand_out(self) -> None:
        """Give idle processes what waits, one request of a session and then the next session's."""
        for dead in [member for member in self._idle if not member.process.is_alive()]:
            self._idle.remove(dead)
            self._replaced(dead)
        while self._idle and self._queues:
            session, queue = self._queues.popitem(last=False)
            ticket = queue.popleft()
            if queue:
                self._queues[session] = queue
            self._go(self._served(self._idle.pop(), ticket))

    async def _begun(self) -> None:
        """A new process, after its first task; one at a time, since two that compile the same would be in each
        other's way."""
        async with self._turn:
            member = Member[Task](self._work, prepared, (self._nice,))
            self._all.append(member)
            if self._first is not None:
                try:
                    await self._exchanged(member, self._first, BEGINNING)
                except (EOFError, OSError, TimeoutError):
                    self._ended(member)
                    await asyncio.sleep(1.0)
                    self._go(self._begun())
                    return
        self._idle.append(member)
        self._hand_out()

    async def _served(self, member: Member[Task], ticket: _Ticket) -> None:
        if ticket.answer.done():  # nobody waits for it any more
            self._free(member)
            return
        try:
            fine, found = await self._exchanged(member, ticket.task, self._limit)
        except TimeoutError:
            self._replaced(member)
            within = f"at most {self._limit:g} s"
            remedy = "ask for fewer speeds, torques or gears"
            _settled(ticket, refused(422, "this takes too long", allowed=within, remedy=remedy))
        except (EOFError, OSError):
            self._replaced(member)
            remedy = "ask again, and for less if it dies again"
            _settled(ticket, refused(422, "the process that worked on this has died", remedy=remedy))
        else:
            self._free(member)
            _settled(ticket, found if fine else _as_refusal(found))

    async def _exchanged(self, member: Member[Task], task: Task, limit: float) -> tuple[bool, Any]:
        loop = asyncio.get_running_loop()
        found: tuple[bool, Any] = await loop.run_in_executor(self._threads, _exchange, member, task, limit)
        return found

    def _free(self, member: Member[Task]) -> None:
        self._idle.append(member)
        self._hand_out()

    def _replaced(self, member: Member[Task]) -> None:
        self._ended(member)
        if self._open:
            self._go(self._begun())

    def _ended(self, member: Member[Task]) -> None:
        with contextlib.suppress(ValueError):
            self._all.remove(member)
        member.process.kill()

    def _go(self, work: Any) -> None:
        """Begin something that goes on by itself; the loop alone would forget it."""
        going = asyncio.ensure_future(work)
        self._going.add(going)
        going.add_done_callback(self._going.discard)


def _exchange(member: Member[Task], task: Task, limit: float) -> tuple[bool, Any]:
    """Ask a process and wait; EOFError or OSError where it dies of it, TimeoutError where it is not done in time."""
    member.give(task)
    if not member.pipe.poll(limit):
        raise TimeoutError
    found: tuple[bool, Any] = member.pipe.recv()
    return found


def _settled(ticket: _Ticket, found: Any) -> None:
    if ticket.answer.done():
        return
    if isinstance(found, Exception):
        ticket.answer.set_exception(found)
    else:
        ticket.answer.set_result(found)


def _as_refusal(error: Exception) -> RefusedError:
    """What a process raised, as the page is told it."""
    if isinstance(error, RefusedError):
        return error
    if isinstance(error, ModelError):
        return RefusedError(422, faults(error))
    if isinstance(error, MemoryError):
        return refused(422, "there is not enough memory for this", remedy="ask for fewer speeds, torques or gears")
    return refused(422, "this should not have happened", found=f"{type(error).__name__}: {error}"[:200])


def prepared(nice: int) -> None:
    """What a process does once: give way to others, bound its memory, leave warnings to who started it.

    Cyclic garbage is looked for seldom: a twelfth of the time of an answer.
    """
    warnings.simplefilter("ignore")
    gc.set_threshold(200_000, 20, 100)
    with contextlib.suppress(ImportError, OSError, ValueError, AttributeError):
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_DATA)
        most = MEMORY if hard == resource.RLIM_INFINITY else min(MEMORY, hard)
        resource.setrlimit(resource.RLIMIT_DATA, (most, hard))
    with contextlib.suppress(AttributeError, OSError):
        os.nice(nice)
