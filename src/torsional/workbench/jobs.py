"""Work in the background: a process for each job, so that it can be stopped at any moment; a bounded queue.

A job belongs to the session that asked for it, for which alone it exists.  What it gave is kept for some minutes.
"""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import secrets
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any

from torsional.errors import ModelError
from torsional.studies.crew import inherited
from torsional.workbench.refusals import ErrorText, faults, refused
from torsional.workbench.workers import prepared

RUNNING, WAITING, OWN = 2, 8, 2
"""How many jobs run at once, how many wait, and how many of one session do either."""
KEPT, BYTES = 600.0, 100_000_000
"""Time [s] for which what a job gave is kept, and bytes of all that is."""
LONELY = 120.0
"""A job for which nobody has asked for so long [s] is stopped: its page is gone."""
LONGEST = 1800.0  # [s]
NICE = 5

Progress = Callable[[int, int, str], None]
Work = Callable[[dict[str, Any], str, dict[str, Any], Progress], Mapping[str, bytes]]
"""(design, kind, settings, progress) to a frame, and to files by their endings."""
FRAME = "frame"


@dataclass(eq=False)
class _Job:
    """One job as it stands."""

    number: int
    session: str
    asked: tuple[dict[str, Any], str, dict[str, Any]]
    looked_at: float
    state: str = "waiting"
    done: int = 0
    total: int = 0
    text: str = ""
    errors: list[ErrorText] = field(default_factory=list)
    result: Mapping[str, bytes] = field(default_factory=dict)
    changed_at: float = 0.0
    process: SpawnProcess | None = None

    @property
    def ended(self) -> bool:
        return self.state not in ("waiting", "running")


class Jobs:
    """The jobs of all sessions."""

    def __init__(self, work: Work, clock: Callable[[], float] = time.monotonic) -> None:
        self._work, self._clock = work, clock
        self._jobs: dict[str, _Job] = {}
        self._threads = ThreadPoolExecutor(RUNNING, thread_name_prefix="jobs")
        self._going: set[asyncio.Task[None]] = set()
        self._count = 0

    def begin(self, session: str, design: dict[str, Any], kind: str, settings: dict[str, Any]) -> str:
        """The name of a new job; RefusedError (429) where too many are at work or wait."""
        self.tidy()
        open_ = [job for job in self._jobs.values() if not job.ended]
        if sum(job.session == session for job in open_) >= OWN:
            raise refused(429, "this session has its jobs at work", allowed=f"{OWN} at a time", remedy="cancel one")
        if len(open_) >= RUNNING + WAITING:
            raise refused(429, "too many jobs are waiting", remedy="ask again later")
        name, self._count = secrets.token_urlsafe(16), self._count + 1
        self._jobs[name] = _Job(self._count, session, (design, kind, settings), self._clock())
        self._next()
        return name

    def state(self, name: str, session: str) -> Mapping[str, object]:
        """How a job stands, and how many wait before it; RefusedError (404) for one that this session does not have."""
        self.tidy()
        job = self._of(name, session)
        told = {key: getattr(job, key) for key in ("state", "done", "total", "text", "errors")}
        return {**told, "place": sum(each.number <= job.number for each in self._waiting()) if not job.ended else 0}

    def result(self, name: str, session: str, kind: str = FRAME) -> bytes:
        """What a job gave, its frame or a file; RefusedError (404) where there is nothing."""
        job = self._of(name, session)
        if kind not in job.result:
            found = job.state if job.state != "done" else kind
            raise refused(404, "the job has no such result", found=found, allowed=", ".join(job.result))
        return job.result[kind]

    def cancel(self, name: str, session: str) -> None:
        """Stop a job at once; one that has ended already is forgotten."""
        job = self._of(name, session)
        if job.ended:
            del self._jobs[name]
        else:
            self._stop(job, "cancelled")

    def tidy(self) -> None:
        """Forget what is old or too much, and stop what nobody asks for any more."""
        now = self._clock()
        for job in self._jobs.values():
            if not job.ended and now - job.looked_at > LONELY:
                self._stop(job, "cancelled")
            elif job.state == "running" and now - job.changed_at > LONGEST:
                job.errors = faults(ModelError("the job took too long", allowed=f"{LONGEST / 60:g} min"))
                self._stop(job, "failed")
        kept = 0
        for name, job in sorted(self._jobs.items(), key=lambda item: -item[1].changed_at):
            kept += sum(map(len, job.result.values()))
            if job.ended and (now - job.changed_at > KEPT or kept > BYTES):
                del self._jobs[name]

    def close(self) -> None:
        """Stop them all."""
        for job in self._jobs.values():
            if not job.ended:
                self._stop(job, "cancelled")
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _of(self, name: str, session: str) -> _Job:
        job = self._jobs.get(name)
        if job is None or not secrets.compare_digest(job.session.encode(), session.encode()):
            raise refused(404, "there is no such job", remedy="it may have ended long ago; begin it again")
        job.looked_at = self._clock()
        return job

    def _waiting(self) -> list[_Job]:
        return [job for job in self._jobs.values() if job.state == "waiting"]

    def _next(self) -> None:
        """Start jobs while there is room: first of sessions that have none at work."""
        while len(at_work := [job for job in self._jobs.values() if job.process is not None]) < RUNNING:
            served = {job.session for job in at_work}
            waiting = sorted(self._waiting(), key=lambda job: (job.session in served, job.number))
            if not waiting:
                return
            self._start(waiting[0])

    def _start(self, job: _Job) -> None:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        job.process = context.Process(target=_working, args=(theirs,), daemon=True)
        job.state, job.changed_at = "running", self._clock()
        with inherited():
            job.process.start()
        theirs.close()
        with contextlib.suppress(OSError):
            ours.send((self._work, *job.asked))
        going = asyncio.ensure_future(self._followed(job, ours))
        self._going.add(going)
        going.add_done_callback(self._going.discard)

    async def _followed(self, job: _Job, pipe: Connection) -> None:
        """Wait for what a job tells until it ends."""
        await asyncio.get_running_loop().run_in_executor(self._threads, _listened, job, pipe)
        assert job.process is not None
        job.process.kill()
        job.process, job.changed_at = None, self._clock()
        self._next()

    def _stop(self, job: _Job, state: str) -> None:
        job.state, job.changed_at = state, self._clock()
        if job.process is not None:
            job.process.kill()


def _listened(job: _Job, pipe: Connection) -> None:
    """Note what a job tells; a process that dies without a last word has failed, unless it was stopped."""
    kind: str = "moved"
    value: Any = (0, 0, "")
    with contextlib.suppress(EOFError, OSError), pipe:
        while kind == "moved":
            job.done, job.total, job.text = value
            kind, value = pipe.recv()
    if job.state != "running":
        return
    if kind == "done":
        job.result, job.state = value, "done"
    else:
        died = faults(ModelError("the process that worked on this has died", remedy="ask again"))
        job.errors, job.state = value if kind == "failed" else died, "failed"


def _working(pipe: Connection) -> None:
    """What the process of a job does."""
    prepared(NICE)
    with contextlib.suppress(EOFError, OSError):
        work, *asked = pipe.recv()

        def moved(done: int, total: int, text: str) -> None:
            pipe.send(("moved", (done, total, text)))

        try:
            pipe.send(("done", work(*asked, moved)))
        except ModelError as error:
            pipe.send(("failed", faults(error)))
        except Exception as error:
            found = f"{type(error).__name__}: {error}"[:200]
            pipe.send(("failed", faults(ModelError("this should not have happened", found=found))))
