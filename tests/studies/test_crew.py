"""Processes side by side: what they inherit, how they end, what one of them dies of."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from tests.signals import listening

from torsional.errors import ModelError
from torsional.studies.crew import NOWHERE, Crew, Lost, marked

ROOT = Path(__file__).parents[2]


def ready() -> None:
    """Nothing to prepare."""


def ended(number: int) -> int:
    """A process that dies of a number, as one that the system kills."""
    marked(10 * number)
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def refused(number: int) -> int:
    """A task that is refused."""
    raise ModelError("no such number", found=str(number))


def threads(_: int) -> str:
    """How many threads a process may have."""
    return os.environ["OPENBLAS_NUM_THREADS"]


def dozing(path: str) -> None:
    """Says that it has begun, and works for long."""
    Path(path).touch()
    time.sleep(4.0 if path.endswith("short") else 60.0)


def killed() -> None:
    """What ends the process that reads it."""
    os.kill(os.getpid(), signal.SIGKILL)


class Deadly:
    """Ends the process that is given it, before it has read what lies behind."""

    def __reduce__(self) -> tuple[object, tuple[()]]:
        return killed, ()


def unready(*_: object) -> None:
    """Never reached."""


SCRIPT = """
import sys
from tests.studies.test_crew import dozing, ready
from torsional.studies.crew import Crew

if __name__ == "__main__":
    with Crew(dozing, ready, (), 2) as crew:
        for _ in crew.results(sys.argv[1:]):
            pass
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal there")
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system kills in another way")
def test_a_process_that_dies_while_it_begins_costs_its_task_alone() -> None:
    """What it is given is more than a pipe holds, so that whoever waits for it to be read would wait for ever."""
    with Crew(threads, unready, (Deadly(), bytes(1_000_000)), 2) as crew:
        found = dict(crew.results([1, 2, 3]))
    assert found == {number: Lost(NOWHERE, -signal.SIGKILL) for number in (1, 2, 3)}


def test_a_process_that_dies_costs_its_task_alone() -> None:
    with Crew(ended, ready, (), 2) as crew:
        found = dict(crew.results(range(6)))
        assert found.pop(3) == Lost(30, -signal.SIGKILL)
        assert found == {number: number for number in (0, 1, 2, 4, 5)}
        assert dict(crew.results([7])) == {7: 7}
    assert not multiprocessing.active_children()


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal there")
def test_a_process_that_dies_with_nothing_to_do_is_replaced() -> None:
    with Crew(ended, ready, (), 2) as crew:
        assert len(dict(crew.results([0, 1]))) == 2
        for child in multiprocessing.active_children():
            child.kill()
            child.join()
        assert dict(crew.results([4, 5])) == {4: 4, 5: 5}


def test_what_a_task_raises_is_raised_here() -> None:
    with pytest.raises(ModelError, match=r"no such number; found [45]"), Crew(refused, ready, (), 2) as crew:
        list(crew.results([4, 5]))
    assert not multiprocessing.active_children()


def test_one_process_is_this_one() -> None:
    with Crew(threading_free, ready, (), 1) as crew:
        assert list(crew.results([1])) == [(1, os.getpid())]


def threading_free(_: int) -> int:
    """The process that does it; marks are for others."""
    marked(NOWHERE)
    return os.getpid()


def test_each_has_one_thread_and_the_environment_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with Crew(threads, ready, (), 2) as crew:
        assert [told for _, told in crew.results(range(3))] == ["1"] * 3
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7" and "MKL_NUM_THREADS" not in os.environ


def begun(*paths: Path) -> subprocess.Popen[str]:
    """A script with two processes that are at work."""
    script = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, *map(str, paths)], preexec_fn=listening,
        cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    latest = time.monotonic() + 60
    while not all(path.exists() for path in paths) and time.monotonic() < latest:
        time.sleep(0.02)
    return script


@pytest.mark.skipif(sys.platform == "win32", reason="groups of processes are sent signals otherwise there")
def test_ctrl_c_ends_all_at_once_and_without_tracebacks_of_theirs(tmp_path: Path) -> None:
    script = begun(tmp_path / "one", tmp_path / "two")
    os.killpg(script.pid, signal.SIGINT)
    since = time.monotonic()
    _, told = script.communicate(timeout=50)
    assert time.monotonic() - since < 20 and told.count("Traceback") == 1
    assert told.rstrip().endswith("KeyboardInterrupt")


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal there")
def test_who_loses_the_one_that_asked_ends_by_itself_and_quietly(tmp_path: Path) -> None:
    script = begun(tmp_path / "one short", tmp_path / "two short")
    since = time.monotonic()
    script.kill()
    _, told = script.communicate(timeout=50)  # ends when they have: they hold the stream too
    assert time.monotonic() - since > 0.3 and "Traceback" not in told
