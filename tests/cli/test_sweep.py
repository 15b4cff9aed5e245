"""`torsional sweep`: works, keeps, goes on, says what failed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.studies.test_sweep_plan import ROOT, planned

import torsional as tv
from torsional.studies.sweeps.plan import load_plan
from torsional.studies.sweeps.sweep import Pieces

Run = Callable[..., Any]


def test_it_works_keeps_and_goes_on(torsional: Run, tmp_path: Path) -> None:
    path = str(planned(tmp_path))
    told = torsional("sweep", path, "-o", "found.nc", "-o", "found.csv")
    assert told.code == 0 and "plan: 6 designs" in told.out and "rpm" in told.out
    assert "written: found.nc" in told.err
    kept = tv.load_results("found.nc")
    assert kept.frequency.sizes["clutch.stiffness"] == 3
    told = torsional("sweep", path)
    assert told.code == 2 and "holds pieces of a sweep" in told.err and "--resume" in told.err
    told = torsional("sweep", path, "--status")
    assert told.code == 0 and "6 of 6 designs are worked out (100.0 %)" in told.out
    min((tmp_path / "plan.sweep" / "chunks").iterdir()).unlink()
    told = torsional("sweep", path, "--status")
    assert told.code == 0 and "2 of 6 designs are worked out (33.3 %)" in told.out
    told = torsional("sweep", path, "--resume", "--json")
    document = json.loads(told.out)
    assert told.code == 0 and document["designs"]["ok"] == 6
    assert document["result"]["variables"]["frequency"]["values"] == kept.frequency.values.tolist()


def test_failing_designs_have_an_exit_code_of_their_own(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace("[1.0,", "[-1.0, 1.0,"), encoding="utf-8")
    told = torsional("sweep", str(path), "-o", "found.csv")
    assert told.code == 3 and Path("found.csv").exists() and "refused" in told.out
    assert "3 of 9 designs have no answer" in told.err and "3 × absorber.primary_inertia" in told.err


def test_a_bad_plan_leaves_no_folder(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path, "{analysis: mods}")
    told = torsional("sweep", str(path))
    assert told.code == 2 and told.err.startswith("error: ") and not (tmp_path / "plan.sweep").exists()
    told = torsional("sweep", str(planned(tmp_path)), "--status")
    assert told.code == 2 and "there is no such folder" in told.err and not (tmp_path / "plan.sweep").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="groups of processes are sent signals otherwise there")
def test_ctrl_c_keeps_what_was_worked_out(tmp_path: Path) -> None:
    path = planned(tmp_path, "{analysis: map, torques: 13}")
    text = path.read_text(encoding="utf-8").replace("points: 3", "points: 400")
    path.write_text(text.replace("processes: 1", "processes: 2"), encoding="utf-8")
    command = subprocess.Popen(
        [sys.executable, "-m", "torsional", "sweep", str(path)],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline and len(list(tmp_path.glob("plan.sweep/chunks/0*"))) < 3:
        time.sleep(0.05)
    os.killpg(command.pid, signal.SIGINT)
    _, said = command.communicate(timeout=20)
    assert command.returncode == 130 and "are kept in" in said and "--resume goes on" in said
    assert "Traceback" not in said
    plan = load_plan(path)
    pieces = Pieces.of(plan.work, tmp_path / "plan.sweep", plan.chunk)
    assert 3 <= pieces.count - len(pieces.store.missing(pieces.count)) < pieces.count
