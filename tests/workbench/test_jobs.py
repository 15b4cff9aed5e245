"""Jobs in the background: bounded, stopped at once, their owner's alone, kept for a while."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.workbench.calling import soon
from tests.workbench.test_workers import until
from tests.workbench.working import job

from torsional.workbench.jobs import BYTES, KEPT, LONELY, Jobs
from torsional.workbench.refusals import RefusedError

MINE, THEIRS = "session-of-mine", "session-of-theirs"
TRUCK = {"text": "a truck"}


class Clock:
    """A clock that a test turns."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


@asynccontextmanager
async def jobs(clock: Clock | None = None) -> AsyncIterator[Jobs]:
    made = Jobs(job, clock or Clock())
    try:
        yield made
    finally:
        made.close()


async def ended(some: Jobs, name: str, session: str = MINE) -> Any:
    await until(lambda: some.state(name, session)["state"] not in ("waiting", "running"))
    return some.state(name, session)


async def begun(some: Jobs, hold: Path, session: str = MINE) -> str:
    name = some.begin(session, TRUCK, "region", {"wait": str(hold)})
    await until(hold.exists)
    return name


def refused(status: int, call: Any, *args: Any) -> str:
    with pytest.raises(RefusedError) as caught:
        call(*args)
    assert caught.value.status == status
    return str(caught.value.errors[0]["problem"])


def test_a_job_tells_how_far_it_is_and_what_it_gave(tmp_path: Path) -> None:
    async def asked() -> None:
        async with jobs() as some:
            name = await begun(some, tmp_path / "hold")
            await until(lambda: some.state(name, MINE)["done"] == 1)
            told = dict(some.state(name, MINE))
            moved = {"done": 1, "total": 3, "text": "at work on a truck"}
            assert told == {"state": "running", **moved, "errors": [], "place": 0}
            assert refused(404, some.result, name, MINE) == "the job has no such result"
            (tmp_path / "hold").unlink()
            assert (await ended(some, name))["state"] == "done"
            assert (some.result(name, MINE), some.result(name, MINE, "csv")) == (b"region", b"a table")
            assert refused(404, some.result, name, MINE, "exe") == "the job has no such result"

    soon(asked())


def test_a_job_is_its_sessions_alone(tmp_path: Path) -> None:
    async def asked() -> None:
        async with jobs() as some:
            name = await begun(some, tmp_path / "hold")
            for call in (some.state, some.result, some.cancel):
                assert refused(404, call, name, THEIRS) == "there is no such job"
                assert refused(404, call, "made-up", MINE) == "there is no such job"
            assert some.state(name, MINE)["state"] == "running"

    soon(asked())


def test_cancelling_ends_the_process_at_once(tmp_path: Path) -> None:
    async def asked() -> None:
        async with jobs() as some:
            name = await begun(some, tmp_path / "hold")
            process = some._jobs[name].process
            assert process is not None
            some.cancel(name, MINE)
            assert some.state(name, MINE)["state"] == "cancelled"
            await asyncio.to_thread(process.join, 10.0)
            assert process.exitcode == -9
            some.cancel(name, MINE)  # and forgotten
            assert refused(404, some.state, name, MINE) == "there is no such job"

    soon(asked())


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"die": 1}, "the process that worked on this has died"),
        ({"refuse": 1}, "must be positive"),
        ({"break": 1}, "this should not have happened"),
    ],
)
def test_a_job_that_fails_says_why(settings: dict[str, Any], told: str) -> None:
    async def asked() -> None:
        async with jobs() as some:
            at_end = await ended(some, some.begin(MINE, TRUCK, "branches", settings))
            assert (at_end["state"], at_end["errors"][0]["problem"]) == ("failed", told)

    soon(asked())


def test_two_run_and_eight_wait(tmp_path: Path) -> None:
    """Two of a session; the queue is first come first served, but first of sessions that have none at work."""

    async def asked() -> None:
        async with jobs() as some:
            first = [await begun(some, tmp_path / f"mine{n}") for n in range(2)]
            assert refused(429, some.begin, MINE, TRUCK, "region", {}) == "this session has its jobs at work"
            waiting = [some.begin(f"session-number-{n}", TRUCK, "region", {}) for n in range(8)]
            assert refused(429, some.begin, THEIRS, TRUCK, "region", {}) == "too many jobs are waiting"
            places = [some.state(name, f"session-number-{n}")["place"] for n, name in enumerate(waiting)]
            assert places == list(range(1, 9))
            some.cancel(first[0], MINE)
            assert (await ended(some, waiting[0], "session-number-0"))["state"] == "done"

    soon(asked())


def test_a_second_job_of_one_session_lets_others_go_first(tmp_path: Path) -> None:
    async def asked() -> None:
        async with jobs() as some:
            long = await begun(some, tmp_path / "long")
            holder = await begun(some, tmp_path / "holder", THEIRS)
            second = some.begin(MINE, TRUCK, "region", {"wait": str(tmp_path / "second")})
            other = some.begin("session-of-others", TRUCK, "region", {"wait": str(tmp_path / "other")})
            some.cancel(holder, THEIRS)
            await until((tmp_path / "other").exists)
            assert some.state(second, MINE)["state"] == "waiting"
            some.cancel(other, "session-of-others")
            await until((tmp_path / "second").exists)
            some.cancel(long, MINE)

    soon(asked())


def test_results_are_kept_for_a_while_and_within_bytes() -> None:
    async def asked() -> None:
        clock = Clock()
        async with jobs(clock) as some:
            name = some.begin(MINE, TRUCK, "region", {})
            await ended(some, name)
            clock.now = KEPT + 1
            assert refused(404, some.state, name, MINE) == "there is no such job"
            large = {"times": BYTES // 10}  # of six letters each
            names = []
            for _ in range(2):
                names.append(some.begin(MINE, TRUCK, "region", large))
                await ended(some, names[-1])
                clock.now += 1
            assert refused(404, some.state, names[0], MINE) == "there is no such job"
            assert len(some.result(names[1], MINE)) == 6 * (BYTES // 10)

    soon(asked())


def test_a_job_whose_page_is_gone_is_stopped(tmp_path: Path) -> None:
    async def asked() -> None:
        clock = Clock()
        async with jobs(clock) as some:
            name = await begun(some, tmp_path / "hold")
            clock.now = LONELY + 1
            some.tidy()
            assert some.state(name, MINE)["state"] == "cancelled"

    soon(asked())
