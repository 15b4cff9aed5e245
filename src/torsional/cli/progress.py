"""Progress on stderr, in a terminal alone."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from torsional.cli.tables import styled

WINDOW, KEPT = 60.0, 4
"""A rate is taken over the latest minute [s], or over so many steps where these take longer."""


class Pace:
    """How many ``things`` are done, how many a second, and the time left, as a text that is right whenever it is read.

    >>> now = iter([0.0, 10.0, 15.0])
    >>> pace = Pace("designs", lambda: next(now))
    >>> pace.moved(1000, 5000), pace.moved(2000, 5000), str(pace)
    (None, None, '2000 of 5000 designs, 100 a second, 25 s left')
    """

    def __init__(self, things: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._things, self._clock = things, clock
        self._steps: deque[tuple[float, int]] = deque()
        self._total = 0

    def moved(self, done: int, total: int) -> None:
        """Note how many are done now."""
        now = self._clock()
        self._steps.append((now, done))
        self._total = total
        while len(self._steps) > KEPT and now - self._steps[1][0] > WINDOW:
            self._steps.popleft()

    @property
    def rate(self) -> float:
        """Things a second, 0 before the second step: what was there at the start was done by others."""
        (begun, first), (latest, done) = self._steps[0], self._steps[-1]
        return (done - first) / (latest - begun) if latest > begun else 0.0

    def __str__(self) -> str:
        if not self._steps:
            return ""
        latest, done = self._steps[-1]
        told = f"{done} of {self._total} {self._things}"
        if not self.rate:
            return told
        left = (self._total - done) / self.rate - (self._clock() - latest)
        return f"{told}, {paced(self.rate)}, {lasting(max(left, 0.0))} left"


def paced(rate: float) -> str:
    """A rate in words, by the second, minute or hour.

    >>> paced(118.3), paced(0.5), paced(0.004)
    ('118 a second', '30 a minute', '14.4 an hour')
    """
    per = ((1.0, "a second"), (60.0, "a minute"), (3600.0, "an hour"))
    seconds, words = next((each for each in per if rate * each[0] >= 1), per[-1])
    return f"{round(rate * seconds) if rate * seconds >= 99.5 else format(rate * seconds, '.3g')} {words}"


def lasting(seconds: float) -> str:
    """A time in words, in its two largest units.

    >>> lasting(50.2), lasting(75), lasting(11100), lasting(187200), lasting(59.7)
    ('50 s', '1 min 15 s', '3 h 5 min', '2 d 4 h', '1 min')
    """
    left, parts = round(seconds), []
    for size, unit in ((86400, "d"), (3600, "h"), (60, "min"), (1, "s")):
        count, left = divmod(left, size)
        parts.append((count, unit))
    first = next((n for n, (count, _) in enumerate(parts) if count), len(parts) - 1)
    told = [f"{count} {unit}" for n, (count, unit) in enumerate(parts[first : first + 2]) if count or not n]
    return " ".join(told)


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
    from rich.progress import BarColumn, Progress, TextColumn

    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[pace]}")
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        pace = Pace(things)
        number = bar.add_task(task, total=None, pace=pace)

        def moved(done: int, total: int) -> None:
            pace.moved(done, total)
            bar.update(number, completed=done, total=total)

        yield moved
