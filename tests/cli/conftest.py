"""The command line as tests call it, in this process and in one of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.shipped import ROOT

import torsional as package
from torsional.cli import main


@dataclass(frozen=True)
class Told:
    """What a run of the command said."""

    code: int
    out: str
    err: str


Run = Callable[..., Told]


@pytest.fixture
def truck() -> str:
    return str(ROOT / "examples" / "truck_dmf.yaml")


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def torsional(capsys: pytest.CaptureFixture[str]) -> Run:
    def run(*arguments: object) -> Told:
        code = main([str(argument) for argument in arguments])
        return Told(code, *capsys.readouterr())

    return run


@pytest.fixture
def process() -> Run:
    """The command in a process of its own, its streams piped, without this process's settings of Python."""

    def run(*arguments: object, code: str = "", **environment: str) -> Told:
        own = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "NO_COLOR"))}
        own["PYTHONPATH"] = str(Path(package.__file__).parents[1])  # the one tested, wherever another is installed
        line = [sys.executable, "-c", code or "import sys; from torsional.cli import main; sys.exit(main())"]
        done = subprocess.run(
            [*line, *map(str, arguments)], capture_output=True, env={**own, **environment}, timeout=600
        )
        return Told(done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8"))

    return run
