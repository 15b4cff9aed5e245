"""Processes that answer: fair to sessions, bounded, replaced when they die or take too long."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.workbench.calling import soon
from tests.workbench.working import work

from torsional.workbench.refusals import RefusedError
from torsional.workbench.workers import Workers


@asynccontextmanager
async def workers(count: int = 1, limit: float = 30.0, **settings: Any) -> AsyncIterator[Workers]:
    made = Workers(work, count, limit, **settings)
    try:
        yield made
    finally:
        made.close()


async def until(true: Callable[[], bool]) -> None:
    """Wait for something that will be."""
    while not true():
        await asyncio.sleep(0.005)


async def refusal(of: Awaitable[Any]) -> RefusedError:
    with pytest.raises(RefusedError) as caught:
        await of
    return caught.value


def test_what_tasks_give_and_refuse() -> None:
    async def asked() -> None:
        async with workers(nice=3) as some:
            assert await some.answer(("echoed", ({"speed": 1.5},)), "a") == {"speed": 1.5}
            mendable = await refusal(some.answer(("refused", ()), "a"))
            assert (mendable.status, mendable.errors[0]["where"]) == (422, "clutch.stiffness")
            ours = await refusal(some.answer(("broken", ()), "a"))
            assert ours.errors[0]["text"] == "this should not have happened; found KeyError: 'inner name'"
            large = await refusal(some.answer(("greedy", ()), "a"))
            assert large.errors[0]["problem"] == "there is not enough memory for this"
            assert await some.answer(("niceness", ()), "a") == 3

    soon(asked())


def test_a_process_that_dies_at_work_is_replaced() -> None:
    async def asked() -> None:
        async with workers() as some:
            first = await some.answer(("process", ()), "a")
            told = await refusal(some.answer(("died", ()), "a"))
            assert told.errors[0]["problem"] == "the process that worked on this has died"
            assert await some.answer(("process", ()), "a") != first

    soon(asked())


def test_a_process_that_is_killed_while_idle_is_replaced_unseen() -> None:
    async def asked() -> None:
        async with workers() as some:
            first = await some.answer(("process", ()), "a")
            (member,) = some._all
            member.process.kill()
            await asyncio.to_thread(member.process.join)
            assert await some.answer(("process", ()), "a") != first

    soon(asked())


def test_what_takes_too_long_is_ended(tmp_path: Path) -> None:
    async def asked() -> None:
        async with workers(limit=0.3, first=("echoed", (0,))) as some:
            told = await refusal(some.answer(("held", (str(tmp_path / "begun"),)), "a"))
            assert (told.status, told.errors[0]["allowed"]) == (422, "at most 0.3 s")
            some._limit = 30.0  # whatever else the machine is at
            assert await some.answer(("echoed", (7,)), "a") == 7

    soon(asked())


def test_a_session_that_floods_waits_behind_itself(tmp_path: Path) -> None:
    """Eight of one session wait, a ninth is refused; another session's first request is served second."""

    async def asked() -> list[str]:
        hold, served = tmp_path / "hold", []

        async def one(session: str, number: int) -> None:
            await some.answer(("echoed", (number,)), session)
            served.append(f"{session}{number}")

        async with workers() as some:
            holding = asyncio.ensure_future(some.answer(("held", (str(hold),)), "flood"))
            await until(hold.exists)
            several = [asyncio.ensure_future(one("flood", number)) for number in range(8)]
            await asyncio.sleep(0)
            told = await refusal(some.answer(("echoed", (8,)), "flood"))
            assert (told.status, told.errors[0]["problem"]) == (429, "too many requests are waiting")
            several.append(asyncio.ensure_future(one("other", 0)))
            await asyncio.sleep(0)
            hold.unlink()
            await asyncio.gather(holding, *several)
        return served

    assert soon(asked()) == ["flood0", "other0", *(f"flood{n}" for n in range(1, 8))]


def test_what_waits_altogether_is_bounded(tmp_path: Path) -> None:
    async def asked() -> None:
        hold = tmp_path / "hold"
        async with workers(waiting=2) as some:
            holding = asyncio.ensure_future(some.answer(("held", (str(hold),)), "a"))
            await until(hold.exists)
            waiting = [asyncio.ensure_future(some.answer(("echoed", (n,)), f"s{n}")) for n in range(2)]
            await asyncio.sleep(0)
            assert (await refusal(some.answer(("echoed", (9,)), "late"))).status == 429
            hold.unlink()
            await holding
            assert await asyncio.gather(*waiting) == [0, 1]

    soon(asked())


def test_nobody_waits_for_ever(tmp_path: Path) -> None:
    async def asked() -> None:
        hold = tmp_path / "hold"
        async with workers(patience=0.2, limit=0.1) as some:
            some._limit = 30.0  # of the one that holds the process
            holding = asyncio.ensure_future(some.answer(("held", (str(hold),)), "a"))
            await until(hold.exists)
            some._limit = 0.1
            told = await refusal(some.answer(("echoed", (1,)), "b"))
            assert (told.status, told.errors[0]["problem"]) == (429, "the server is at work on other things")
            hold.unlink()
            await holding
            some._limit = 30.0
            assert await some.answer(("echoed", (2,)), "b") == 2

    soon(asked())


def test_who_gives_up_waiting_is_not_served(tmp_path: Path) -> None:
    async def asked() -> None:
        hold, trace = tmp_path / "hold", tmp_path / "trace"
        async with workers() as some:
            holding = asyncio.ensure_future(some.answer(("held", (str(hold),)), "a"))
            await until(hold.exists)
            leaving = asyncio.ensure_future(some.answer(("held", (str(trace),)), "b"))
            await asyncio.sleep(0)
            leaving.cancel()
            await asyncio.gather(leaving, return_exceptions=True)
            hold.unlink()
            await holding
            assert await some.answer(("echoed", (1,)), "b") == 1
            assert not trace.exists()

    soon(asked())


def test_two_processes_work_side_by_side(tmp_path: Path) -> None:
    async def asked() -> None:
        holds = [tmp_path / name for name in ("one", "two")]
        async with workers(2) as some:
            both = [asyncio.ensure_future(some.answer(("held", (str(hold),)), "a")) for hold in holds]
            for hold in holds:
                await until(hold.exists)
            for hold in holds:
                hold.unlink()
            assert await asyncio.gather(*both) == [str(hold) for hold in holds]

    soon(asked())


def test_closing_ends_the_processes(tmp_path: Path) -> None:
    async def asked() -> None:
        hold = tmp_path / "hold"
        async with workers() as some:
            going = asyncio.ensure_future(some.answer(("held", (str(hold),)), "a"))
            await until(hold.exists)
            (member,) = some._all
        await asyncio.to_thread(member.process.join, 10.0)
        assert member.process.exitcode == -9
        going.cancel()

    soon(asked())
