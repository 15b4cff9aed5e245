"""`torsional sensitivity` and `torsional bands`: from a plan to tables, files and pictures."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.cli.test_sweep import counted_failures, failing
from tests.studies.test_sweep_plan import ROOT

import torsional as tv
from torsional.cli.progress import Pace
from torsional.errors import ModelError
from torsional.studies.sweeps import sensitivities, sweep
from torsional.studies.sweeps.analyses import ModesRun
from torsional.studies.sweeps.plan import load_plan

Run = Callable[..., Any]
LINE = ROOT / "src" / "torsional" / "data" / "line.yaml"
PLAN = """
torsional_sweep: 1
name: rotor and shaft
model: {line}
over:
  - {{parameter: components.rotor.inertia, tolerance: 20 %}}
  - {{parameter: components.shaft.stiffness, tolerance: 5 %}}
designs: {{method: {method}}}
run: {run}
chunk: 6
workers: {{kind: processes, count: 1}}
"""
MODES = "{analysis: modes, count: 1}"


def planned(folder: Path, method: str, run: str = MODES) -> str:
    """A quick plan in a folder."""
    path = folder / "plan.yaml"
    path.write_text(PLAN.format(line=LINE, method=method, run=run), encoding="utf-8")
    return str(path)


def test_sensitivities_are_told_by_importance(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path, "saltelli, count: 16, seed: 4")
    told = torsional("sensitivity", path, "--figure", "frequency", "-o", "found.nc", "-o", "found.csv", "-o", "s.png")
    assert told.code == 0, told.err
    head, _, _, first, second = told.out.splitlines()
    assert head == "frequency, absolute value: 16 of 16 base points"
    assert first.startswith("components.rotor.inertia") and second.startswith("components.shaft.stiffness")
    kept = tv.load_results("found.nc")
    assert kept.total.values[0, 0] > 0.7 and kept.unit.values.tolist() == ["Hz"] and Path("s.png").stat().st_size > 9000
    assert "frequency" in Path("found.csv").read_text(encoding="utf-8-sig").splitlines()[1]
    again = torsional("sensitivity", path, "--json")  # nothing is left to do: no need of --resume
    document = json.loads(again.out)
    assert document["result"]["variables"]["total"]["values"][1] == kept.total.values[0].tolist()
    assert document["designs"]["ok"] == 64 and document["plan"] == "rotor and shaft"
    work = load_plan(path).work
    beside = sensitivities(sweep(work.build, work.designs, work.run), ["frequency"])
    assert beside.total.values.tobytes() == kept.total.values.tobytes()


def test_effects_in_units_and_a_picture(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path, "morris, count: 4")
    told = torsional("sensitivity", path, "-o", "m.svg")
    assert told.code == 0 and "size of effects (mu*) [Hz]" in told.out
    assert Path("m.svg").read_text(encoding="utf-8").startswith("<?xml")


def test_sensitivities_of_other_designs_are_refused_before_any_work(torsional: Run, tmp_path: Path) -> None:
    told = torsional("sensitivity", planned(tmp_path, "sobol, count: 8"))
    assert told.code == 2 and "designs.method" in told.err and not (tmp_path / "plan.sweep").exists()


def test_a_half_done_folder_is_gone_on_with_when_asked(torsional: Run, tmp_path: Path) -> None:
    path = planned(tmp_path, "morris, count: 4")
    assert torsional("sweep", path, "-q").code == 0
    min((tmp_path / "plan.sweep" / "chunks").iterdir()).unlink()
    told = torsional("sensitivity", path)
    assert told.code == 2 and "--resume goes on" in told.err
    told = torsional("sweep", path, "--status")
    assert "6 of 12 designs are worked out (50.0 %)" in told.out and "kB" in told.out
    assert torsional("sensitivity", path, "--resume", "-q").code == 0


def test_lost_trajectories_are_told(torsional: Run, tmp_path: Path) -> None:
    path = Path(planned(tmp_path, "morris, count: 30"))
    text = path.read_text(encoding="utf-8")
    levels = "components.shaft.stiffness, values: [60e3, 61e3, 62e3, -1]"
    path.write_text(text.replace("components.shaft.stiffness, tolerance: 5 %", levels), encoding="utf-8")
    told = torsional("sensitivity", str(path), "--figure", "frequency")
    assert told.code == 3 and "30 trajectories have a design without an answer and are left out" in told.err


def test_bands_beside_the_nominal_curve(torsional: Run, tmp_path: Path) -> None:
    response = "{analysis: response, speed: '600:3000:200 rpm', orders: [1, 2], torque: 300}"
    path = planned(tmp_path, "latin_hypercube, count: 40", run=response)
    path_ = Path(path)
    text = path_.read_text(encoding="utf-8").replace(str(LINE), str(ROOT / "examples" / "truck_dmf.yaml"))
    text = text.replace("components.rotor.inertia", "absorber.secondary_inertia").replace("600:3000", "600:2000")
    path_.write_text(text.replace("components.shaft.stiffness", "clutch.stiffness"), encoding="utf-8")
    told = torsional("bands", path, "-o", "b.nc", "-o", "b.csv", "-o", "b.png")
    assert told.code == 0 and "each curve at its highest over speed" in told.out and "nominal [rad/s²]" in told.out
    kept = tv.load_results("b.nc")
    assert kept.acceleration.dims == ("percentile", "speed", "order") and kept.percentile.size == 5
    low, high = kept.acceleration.sel(percentile=5.0), kept.acceleration.sel(percentile=95.0)
    inside = (low <= kept.acceleration_nominal) & (kept.acceleration_nominal <= high)
    assert float(inside.mean()) > 0.9 and kept.acceleration.attrs["amplitude"] == "0-peak"


def test_bands_where_the_unchanged_model_has_no_answer(
    torsional: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nominal, asked = tv.load_model(LINE).hash, ModesRun.__call__

    def refusing(self: ModesRun, model: tv.Model) -> Any:
        if model.hash == nominal:
            raise ModelError("not this one")
        return asked(self, model)

    monkeypatch.setattr(ModesRun, "__call__", refusing)
    told = torsional("bands", planned(tmp_path, "latin_hypercube, count: 20"))
    assert told.code == 0 and "bands stand alone: not this one" in told.err and "nominal" not in told.out


def test_bands_of_single_figures(torsional: Run, tmp_path: Path) -> None:
    told = torsional("bands", planned(tmp_path, "sobol, count: 32"), "-o", "b.png")
    assert told.code == 0 and "nominal [Hz]" in told.out and Path("b.png").exists()


# --- a part that fails ---


def test_one_design_of_a_hundred_fails_and_all_are_accounted_for(torsional: Run, tmp_path: Path) -> None:
    counted_failures(torsional, failing(tmp_path, 300), 300)


@pytest.mark.full
def test_one_of_a_hundred_of_ten_thousand(torsional: Run, tmp_path: Path) -> None:
    counted_failures(torsional, failing(tmp_path, 10_000, processes=2), 10_000)


# --- progress ---


def test_the_pace_runs_on_between_steps_and_forgets_what_was() -> None:
    now = [0.0]
    pace = Pace("designs", lambda: now[0])
    assert str(pace) == ""
    pace.moved(500, 2000)
    assert str(pace) == "500 of 2000 designs"
    for step in range(1, 11):  # slow at first
        now[0] += 100.0
        pace.moved(500 + 10 * step, 2000)
    assert str(pace) == "600 of 2000 designs, 6 a minute, 3 h 53 min left"
    now[0] += 50.0
    assert str(pace).endswith("3 h 52 min left")
    for step in range(1, 101):
        now[0] += 1.0
        pace.moved(600 + 10 * step, 2000)
    assert str(pace) == "1600 of 2000 designs, 10 a second, 40 s left"
