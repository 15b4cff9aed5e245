"""One ledger a run; it is printed and saved when the last benchmark is done."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

from ledger import Entry, Floor, Ledger, Machine  # noqa: E402

RESULTS = HERE.parent / ".benchmarks" / "results.json"
LEDGER = Ledger()


def pytest_configure(config: pytest.Config) -> None:
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        raise pytest.UsageError("one thread a process is compared: run `make bench`, or set OPENBLAS_NUM_THREADS=1")


@pytest.fixture
def timed(benchmark):
    """Time ``work`` (median of several rounds, after one that warms the caches) and enter it in the ledger."""

    def enter(work, *, task: str, contender: str, cases: int, rounds: int = 7, note: str = ""):
        benchmark.group = task
        result = benchmark.pedantic(work, rounds=rounds, warmup_rounds=1)
        LEDGER.entries.append(Entry(task, contender, benchmark.stats.stats.median, cases, note))
        return result

    return enter


@pytest.fixture
def enter_time():
    """Enter a time measured by the benchmark itself in the ledger."""

    def enter(task: str, contender: str, seconds: float, note: str = "") -> None:
        LEDGER.entries.append(Entry(task, contender, seconds, 1, note))

    return enter


@pytest.fixture(scope="session")
def declared():
    """Name a piece of work and, where it was counted, its floor."""

    def declare(task: str, title: str, floor: Floor | None = None) -> None:
        LEDGER.titles[task] = title
        if floor is not None:
            LEDGER.floors[task] = floor

    return declare


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if not LEDGER.entries:
        return
    machine = Machine.measured()
    LEDGER.save(RESULTS, machine)
    terminalreporter.write_line(LEDGER.table(machine))
    terminalreporter.write_line(f"saved as {RESULTS.relative_to(HERE.parent)}")
