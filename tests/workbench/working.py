"""What processes of the tests are asked to do."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from torsional.errors import ModelError


def work(task: tuple[str, tuple[Any, ...]]) -> Any:
    """A task by its name."""
    name, asked = task
    return TASKS[name](*asked)


def echoed(value: Any) -> Any:
    """The value."""
    return value


def process(_: Any = None) -> int:
    """Who works."""
    return os.getpid()


def held(path: str) -> str:
    """Says that it has begun by a file, and goes on when that is gone."""
    Path(path).touch()
    while Path(path).exists():
        time.sleep(0.005)
    return path


def died() -> None:
    """Ends the process, as one that the system kills."""
    os.kill(os.getpid(), 9)


def refused() -> None:
    """What a user can mend."""
    raise ModelError("must be positive", where="clutch.stiffness", found="-1")


def broken() -> None:
    """A mistake of ours."""
    raise KeyError("inner name")


def greedy() -> int:
    """Wants more memory than a process has."""
    return len(bytearray(40_000_000_000))


def niceness() -> int:
    """How much the process gives way to others."""
    return os.nice(0)


TASKS: dict[str, Callable[..., Any]] = {
    each.__name__: each for each in (echoed, process, held, died, refused, broken, greedy, niceness)
}


def job(
    design: dict[str, Any], kind: str, settings: dict[str, Any], progress: Callable[[int, int, str], None]
) -> dict[str, bytes]:
    """A job of the tests: tells its progress, then waits, dies, is refused or is done."""
    progress(1, 3, f"at work on {design['text']}")
    if "wait" in settings:
        held(settings["wait"])
    if "die" in settings:
        died()
    if "refuse" in settings:
        refused()
    if "break" in settings:
        broken()
    progress(2, 3, "nearly")
    return {"frame": kind.encode() * int(settings.get("times", 1)), "csv": b"a table"}
