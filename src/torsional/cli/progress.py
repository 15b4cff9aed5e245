"""Progress on stderr, in a terminal alone."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from torsional.cli.tables import styled


@contextmanager
def progress(task: str, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """A function (done, total) that moves a bar; it does nothing where stderr is no terminal or ``quiet`` is set."""
    if quiet or not styled(sys.stderr):
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        number = bar.add_task(task, total=None)
        yield lambda done, total: bar.update(number, completed=done, total=total)


@contextmanager
def waiting(task: str, quiet: bool) -> Iterator[None]:
    """Something that moves while a work goes on whose steps are not counted."""
    with progress(task, quiet):
        yield


@contextmanager
def running(task: str, quiet: bool) -> Iterator[Callable[[float, float, float], None]]:
    """A function (time, end, speed) that tells how far a run in time is, and how much faster than life it goes."""
    if quiet or not styled(sys.stderr):
        yield lambda time, end, speed: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[told]}")
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        number = bar.add_task(task, total=None, told="")

        def moved(time: float, end: float, speed: float) -> None:
            told = f"{max(time, 0.0):.2f} of {end:g} s, {speed:.2g} × real time"
            bar.update(number, completed=time, total=end, told=told)

        yield moved


@contextmanager
def counting(task: str, things: str, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """A function (done, total) that tells how many ``things`` are done, how many a second, and the time left."""
    if quiet or not styled(sys.stderr):
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    rate = TextColumn("{task.fields[rate]}")
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), rate, TimeRemainingColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        number = bar.add_task(task, total=None, rate="")

        def moved(done: int, total: int) -> None:
            speed = bar.tasks[number].speed
            bar.update(number, completed=done, total=total, rate=f"{speed:.3g} {things}/s" if speed else "")

        yield moved
