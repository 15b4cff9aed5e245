"""How far a sweep is, as its pieces tell: counts, failures, rate and time left."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from tests.studies.test_sweep import TRUCK, counted

from torsional.studies.sweeps import grid
from torsional.studies.sweeps.standing import standing
from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import Work

BEGUN = 1_700_000_000.0


def worked(folder: Path, at: list[float], size: int = 2) -> Pieces:
    """Pieces of 2 designs, every tenth design refused, of which some are done at times after the begin."""
    over = {"absorber.secondary_inertia": [-1.0 if n % 10 == 9 else 1.0 + n for n in range(30)]}
    pieces = Pieces.of(Work(TRUCK, grid(over), counted), folder, size)
    for number, when in enumerate(at):
        pieces.made(number)
        os.utime(pieces.store.path(number), (BEGUN + when,) * 2)
    return pieces


def test_counts_failures_and_rate(tmp_path: Path) -> None:
    at = standing(worked(tmp_path, [10.0 * n for n in range(11)]), BEGUN + 112.0)
    assert (at.done, at.total, at.failed) == (22, 30, {"refused": 2})
    assert (at.rate, at.idle, at.working) == (0.2, 12.0, True) and at.left == pytest.approx(40.0)
    assert at.size == sum(path.stat().st_size for path in tmp_path.rglob("*") if path.is_file()) > 1000


def test_a_rate_is_that_since_the_last_pause(tmp_path: Path) -> None:
    """And nobody works where nothing came for much longer than between pieces before."""
    times = [*np.arange(0.0, 5.0), *np.arange(9000.0, 9020.0, 4.0)]
    pieces = worked(tmp_path, times)
    at = standing(pieces, BEGUN + 9020.0)
    assert (at.rate, at.working) == (0.5, True)
    later = standing(pieces, BEGUN + 19000.0)
    assert not later.working and later.idle == pytest.approx(19000.0 - 9016.0)


def test_bursts_of_many_processes_are_no_pauses(tmp_path: Path) -> None:
    """Four at a time, every 100 s."""
    at = standing(worked(tmp_path, [100.0 * (n // 4) + 0.1 * (n % 4) for n in range(12)]), BEGUN + 290.0)
    assert at.working and at.rate == pytest.approx(22 / 200.3)


def test_nothing_is_known_of_one_piece_or_none(tmp_path: Path) -> None:
    none = standing(worked(tmp_path / "none", []), BEGUN)
    assert (none.done, none.rate, none.working) == (0, 0.0, False) and np.isnan(none.left)
    one = standing(worked(tmp_path / "one", [0.0]), BEGUN + 3.0)
    assert (one.done, one.rate, one.idle, one.working) == (2, 0.0, 3.0, False)
