"""S1: what a user waits for at the command line; CPU time of a fresh process, the compiled code already on disk."""

from __future__ import annotations

import importlib.util
import resource
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
TRUCK = ROOT / "examples" / "truck_dmf.yaml"
COMMAND = Path(sys.executable).with_name("torsional")

TASKS = {
    "S1 help": ["--help"],
    "S1 modes": ["modes", str(TRUCK)],
    "S1 map": ["map", str(TRUCK)],
}
BARS = {"S1 help": "≤ 120 ms CPU", "S1 modes": "≤ 1 s", "S1 map": "≤ 2 s warm"}


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def _cpu(command: list[str]) -> tuple[float, float]:
    """CPU and wall time [s] of a child process that must succeed."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def _enter(benchmark, ledger, task: str, contender: str, command: list[str], note: str) -> None:
    times = []
    benchmark.group = task
    benchmark.pedantic(lambda: times.append(_cpu(command)), rounds=5, warmup_rounds=1)
    cpu, wall = (sorted(column)[len(times) // 2] for column in zip(*times, strict=True))
    ledger(task, contender, cpu, f"CPU; {wall:.2f} s on the clock; {note}".rstrip("; "))


@pytest.mark.parametrize("task", TASKS)
def test_s1_command(task, benchmark, enter_time, elsewhere):
    if not COMMAND.exists() or (len(TASKS[task]) > 1 and not TRUCK.exists()):
        pytest.skip("the command or the shipped truck is not there")
    _enter(benchmark, enter_time, task, "torsional", [str(COMMAND), *TASKS[task]], f"bar {BARS[task]}")


@pytest.mark.parametrize("module", ["torsional", "numpy", "opentorsion"])
def test_s1_import(module, benchmark, enter_time, elsewhere):
    if importlib.util.find_spec(module) is None:
        pytest.skip(f"{module} is not installed")
    _enter(benchmark, enter_time, "S1 import", module, [sys.executable, "-c", f"import {module}"], "")
