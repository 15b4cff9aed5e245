"""A word while functions are compiled: to whoever looks, once, and to nobody else."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from torsional.numerics import compiling
from torsional.numerics.compiling import WORD, Watch

OURS, THEIRS = "torsional.numerics.modes.lanes", "torsionally.else"

COMPILE = """
from torsional.numerics import compiling
compiling.PATIENCE = -1.0
import numpy as np
from torsional.laws import Hinges
law = Hinges(1.0, (1.0,), (1.0,), (1.0,))
law.march(np.linspace(-1.0, 1.0, 5000), 1.0)
law.torque(np.linspace(-1.0, 1.0, 5000))
"""
"""Loops over a law, and no patience: what takes a minute elsewhere takes a second here."""


def compiled(module: str) -> Any:
    def some() -> None: ...

    some.__module__ = module
    return SimpleNamespace(data={"dispatcher": SimpleNamespace(py_func=some)})


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    now = [100.0]
    monkeypatch.setattr(compiling.time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(compiling, "watched", lambda: True)
    yield now


def test_patience_is_of_all_compilations_together(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    watch, one = Watch(), compiled(OURS)
    for _ in range(2):  # a second each, and as long in between
        watch.on_start(one)
        clock[0] += 1.0
        watch.on_end(one)
        clock[0] += 1.0
    assert watch.spent == 2.0 and capsys.readouterr().err == ""
    watch.on_start(one)
    assert capsys.readouterr().err == WORD + "\n"
    watch.on_start(one)  # within it
    clock[0] += 1.0
    watch.on_end(one)
    watch.on_end(one)
    watch.on_start(one)
    assert watch.spent == 3.0 and capsys.readouterr().err == ""  # time within is counted once, the word is said once


def test_functions_of_others_are_none_of_ours(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    watch, theirs, ours = Watch(), compiled(THEIRS), compiled(OURS)
    watch.on_start(theirs)
    clock[0] += 60.0
    watch.on_start(ours)
    clock[0] += 1.0
    watch.on_end(ours)
    watch.on_end(theirs)
    assert watch.spent == 1.0 and capsys.readouterr().err == ""


def test_silence(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    watch, one = Watch(), compiled(OURS)
    watch.on_start(one)
    clock[0] += 60.0
    with watch.silent(), watch.silent(False):
        watch.on_start(one)
    assert capsys.readouterr().err == ""
    with watch.silent(False):
        watch.on_start(one)
    assert capsys.readouterr().err == WORD + "\n"


@pytest.mark.parametrize("asked", [True, False])
def test_a_notebook_is_watched_where_somebody_could_be_asked(monkeypatch: pytest.MonkeyPatch, asked: bool) -> None:
    """Pages of documentation are run by nobody: a line on stderr there would come and go with the cache."""
    assert not compiling.watched()
    shell = SimpleNamespace(kernel=SimpleNamespace(_allow_stdin=asked))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    assert compiling.watched() is asked


@pytest.mark.parametrize("stream", [None, "closed"])
def test_nobody_sees_a_stream_that_is_not_there(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, stream: str | None
) -> None:
    with (tmp_path / "closed").open("w") as file:
        pass
    monkeypatch.setattr(sys, "stderr", stream and file)
    assert not compiling.watched()


def test_a_terminal_is_told_once_of_what_is_not_on_disk_and_a_pipe_nothing(tmp_path: Path) -> None:
    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    assert seen(COMPILE, **kept) == WORD
    assert seen(COMPILE, **kept) == ""  # from disk
    fresh = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "others")}
    piped = subprocess.run([sys.executable, "-c", COMPILE], capture_output=True, env=fresh, check=True)
    assert (piped.stdout, piped.stderr) == (b"", b"")
    assert list((tmp_path / "others").rglob("*.nbc"))  # though it compiled


def seen(code: str, **environment: str) -> str:
    """What a process says to a terminal."""
    ours, theirs = pytest.importorskip("pty").openpty()
    done = subprocess.run(
        [sys.executable, "-c", code], stdin=theirs, stdout=theirs, stderr=theirs, env=os.environ | environment
    )
    os.close(theirs)
    told = b""
    try:
        while part := os.read(ours, 4096):
            told += part
    except OSError:  # what Linux calls the end
        pass
    os.close(ours)
    assert done.returncode == 0, told
    return told.decode().strip()
