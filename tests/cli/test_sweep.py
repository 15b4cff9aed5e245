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

import numpy as np
import pytest
from tests.signals import listening
from tests.studies.test_sweep_plan import ROOT, planned

import torsional as tv
from torsional.studies.sweeps import clients
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


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--cluster", "tcp://127.0.0.1:1"], "tcp://127.0.0.1:1: no scheduler answers"),
        (["--cluster", "there"], "--cluster: this is no address of a scheduler; found 'there'; allowed: "),
        (["--cluster", "tcp://127.0.0.1:1", "--processes", "2"], "processes here or a cluster, not both"),
    ],
)
def test_clusters_that_cannot_be_are_told(
    torsional: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: list[str], told: str
) -> None:
    monkeypatch.setattr(clients, "PATIENCE", 0.2)
    found = torsional("sweep", str(planned(tmp_path)), *options)
    assert found.code == 2 and told in found.err and found.err.count("\n") == 1


def test_a_missing_library_is_told(torsional: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    found = torsional("sweep", str(planned(tmp_path)), "--cluster", "tcp://127.0.0.1:1")
    assert found.code == 2 and "pip install 'torsional[cluster]'" in found.err


def test_a_bad_plan_leaves_no_folder(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path, "{analysis: mods}")
    told = torsional("sweep", str(path))
    assert told.code == 2 and told.err.startswith("error: ") and not (tmp_path / "plan.sweep").exists()
    told = torsional("sweep", str(planned(tmp_path)), "--status")
    assert told.code == 2 and "there is no such folder" in told.err and not (tmp_path / "plan.sweep").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="groups of processes are sent signals otherwise there")
def test_ctrl_c_keeps_what_was_worked_out(tmp_path: Path) -> None:
    path = planned(tmp_path, "{analysis: map, torques: 40}")
    text = path.read_text(encoding="utf-8").replace("points: 3", "points: 90")  # too few to be asked together
    path.write_text(text.replace("count: 1", "count: 2"), encoding="utf-8")
    command = subprocess.Popen(
        [sys.executable, "-m", "torsional", "sweep", str(path)], preexec_fn=listening,
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


BAD = (("rotor", -8.0, 60e3, 5.0), ("shaft", 8.0, 0.0, 5.0), ("damping", 8.0, 60e3, -5.0))
"""What may be wrong with a design: an inertia, a stiffness, a damping."""


def failing(folder: Path, count: int, processes: int = 1) -> Path:
    """A plan of a table in which exactly one design of a hundred must fail, each for one of three reasons."""
    rotors, bad = np.linspace(4.0, 12.0, count), np.arange(37, count, 100)
    rows = [[rotor, 60e3, 5.0] for rotor in rotors]
    for place, number in enumerate(bad):
        rows[number] = [value * (1 + 0.01 * place) for value in BAD[place % 3][1:]]
    paths = "components.rotor.inertia,components.shaft.stiffness,components.coupling.damping"
    text = "\n".join([paths, *(",".join(map(repr, map(float, row))) for row in rows)])
    (folder / "designs.csv").write_text(text, encoding="utf-8")
    path = folder / "plan.yaml"
    path.write_text(
        f"torsional_sweep: 1\nmodel: {ROOT / 'src' / 'torsional' / 'data' / 'line.yaml'}\n"
        "designs: {method: table, file: designs.csv}\nrun: {analysis: modes, count: 2}\n"
        f"workers: {{kind: processes, count: {processes}}}\n", encoding="utf-8",
    )  # fmt: skip
    return path


def counted_failures(torsional: Run, path: Path, count: int) -> None:
    """All of them are accounted for by status and reason, the rest has answers, and the exit code says so."""
    told = torsional("sweep", str(path), "-o", "found.nc")
    bad = np.arange(37, count, 100)
    assert told.code == 3 and f"{bad.size} of {count} designs have no answer" in told.err
    for place, name in enumerate(("rotor.inertia", "shaft.stiffness", "coupling.damping")):
        assert f"{bad[place::3].size} × components.{name}: must" in told.err
    found = tv.load_results("found.nc")
    assert np.flatnonzero(found.status.values).tolist() == bad.tolist() and set(found.status.values[bad]) == {1}
    assert np.flatnonzero(found.reason.values != "").tolist() == bad.tolist()
    assert np.flatnonzero(np.isnan(found.frequency.values).any(axis=1)).tolist() == bad.tolist()
    counts = [found.attrs[f"designs {word}"] for word in ("ok", "refused", "failed", "crashed")]
    assert counts == [count - bad.size, bad.size, 0, 0]
    fine = np.delete(np.arange(count), bad)
    inertia = found["components.rotor.inertia"].values[fine]
    assert (np.diff(inertia) > 0).all() and (np.diff(found.frequency.values[fine, 0]) < 0).all()
    told = torsional("sweep", str(path), "--status")
    assert f"{count} of {count} designs are worked out (100.0 %); {bad.size} refused; " in told.out
