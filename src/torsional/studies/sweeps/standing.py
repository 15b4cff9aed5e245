"""How far a sweep in a folder is, read from its pieces alone: what is done, what failed, how fast it goes."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass

import numpy as np

from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import OK, STATUS

WINDOW = 1000
"""Latest pieces from whose times a rate is taken."""
PAUSE, SHARE, FEW = 5.0, 0.95, 3
"""A gap is a pause where it is so many times as long as this share of all gaps, and there are only a few like it:
pieces of many processes come in bursts."""
SHORTEST = 5.0
"""Silence [s] that is none, however quick the pieces follow each other."""


@dataclass(frozen=True)
class Standing:
    """``done`` of ``total`` designs, ``failed`` by a word for the status, ``size`` of the folder [byte].

    ``rate`` [designs/s] of the latest run of pieces without a pause, 0 where it cannot be told; ``idle`` [s] since the
    latest piece, and ``working`` whether that is no longer than between pieces before.
    """

    done: int
    total: int
    failed: dict[str, int]
    size: int
    rate: float = 0.0
    idle: float = 0.0
    working: bool = False

    @property
    def left(self) -> float:
        """Time left [s] if a driver is at work and goes on as before; NaN where that cannot be told."""
        return (self.total - self.done) / self.rate if self.rate else np.nan


def standing(pieces: Pieces, now: float | None = None) -> Standing:
    """How far the pieces are at the time ``now`` [s since 1970]; every piece is read and checked."""
    states: Counter[int] = Counter()
    times: list[tuple[float, int]] = []
    for number in range(pieces.count):
        chunk = pieces.store.get(number)
        if chunk is not None:
            states.update(chunk["status"].tolist())
            times.append((pieces.store.path(number).stat().st_mtime, pieces.length(number)))
    total, done = len(pieces.work.designs), sum(length for _, length in times)
    failed = {word.partition(":")[0]: states[n] for n, word in enumerate(STATUS) if n != OK and states[n]}
    size = sum(path.stat().st_size for path in pieces.store.folder.rglob("*") if path.is_file())
    return Standing(done, total, failed, size, *_pace(sorted(times), time.time() if now is None else now))


def _pace(times: list[tuple[float, int]], now: float) -> tuple[float, float, bool]:
    """Rate, silence and whether somebody works, of pieces' times and lengths in order."""
    latest = times[-WINDOW:]
    at = np.array([when for when, _ in latest])
    idle = max(now - float(at[-1]), 0.0) if at.size else 0.0
    if at.size < 2:
        return 0.0, idle, False
    gaps = np.diff(at)
    longest = max(PAUSE * float(np.quantile(gaps, SHARE, method="lower")), SHORTEST)
    pauses = np.flatnonzero(gaps > longest)
    begun = int(pauses[-1]) + 1 if 0 < pauses.size <= FEW else 0
    took = float(at[-1] - at[begun])
    rate = sum(length for _, length in latest[begun + 1 :]) / took if took > 0 else 0.0
    usual = max(longest, PAUSE * float(gaps[begun:].max(initial=0.0)))
    return rate, idle, rate > 0 and idle <= usual
