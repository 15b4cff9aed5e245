"""Plans in files: what they ask, and how they are refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import torsional as tv
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.quantities import acceleration, swing
from torsional.solvers.run_up import run_up_response
from torsional.studies.sweeps.plan import load_plan
from torsional.studies.sweeps.sweep import sweep
from torsional.studies.sweeps.workers import Dask, LocalCluster, Lsf, Pbs, Processes, Slurm

ROOT = Path(__file__).parents[2]
TRUCK = ROOT / "examples" / "truck_dmf.yaml"
PLAN = """
torsional_sweep: 1
model: {truck}
over:
  - {{parameter: clutch.stiffness, low: 15 kNm/rad, high: 35 kNm/rad, points: 3}}
  - {{parameter: absorber.primary_inertia, values: [1.0, "1.4 kgm²"]}}
run: {run}
chunk: 4
workers: {{kind: processes, count: 1}}
"""
MODES = "{analysis: modes, count: 3}"
WORKERS = "{kind: processes, count: 1}"


def planned(folder: Path, run: str = MODES, text: str = PLAN, **changes: str) -> Path:
    """A plan in a folder."""
    told = text.format(truck=TRUCK, run=run)
    for old, new in changes.items():
        told = told.replace(old.replace("_", " "), new)
    path = folder / "plan.yaml"
    path.write_text(told, encoding="utf-8")
    return path


def answered(path: Path) -> Any:
    """What a plan's designs answer."""
    plan = load_plan(path)
    return sweep(plan.work.build, plan.work.designs, plan.work.run)


def test_values_are_read_with_their_units(tmp_path: Path) -> None:
    plan = load_plan(planned(tmp_path))
    axes = {name: axis.levels for name, axis in plan.work.designs.axes.items()}
    assert axes == {"clutch.stiffness": (15e3, 25e3, 35e3), "absorber.primary_inertia": (1.0, 1.4)}
    assert (plan.name, plan.chunk, plan.workers) == ("plan", 4, Processes(kind="processes", count=1))


def test_modes_are_those_of_each_model(tmp_path: Path) -> None:
    found = answered(planned(tmp_path))
    model = changed(tv.load_model(TRUCK), {"clutch.stiffness": 35e3, "absorber.primary_inertia": 1.4})
    system, _ = tv.solvers.operating.at_operating_point(model, model.full_load_peak())
    frequencies = tv.modal(system).frequency.values
    here = found.sel({"clutch.stiffness": 35e3, "absorber.primary_inertia": 1.4})
    assert here.frequency.values.tolist() == frequencies[frequencies > 0][:3].tolist()
    assert here.order_speed.values == pytest.approx(2 * np.pi * here.frequency.values / 3)


def test_the_worst_of_a_map_is_that_of_run_ups(tmp_path: Path) -> None:
    """Beside it the response over speed alone, at the torque of the worst cell."""
    run_ = "{analysis: map, gears: [8, 12], speed: '600:2000:100 rpm', torques: 4, orders: [3, 6]}"
    found = answered(planned(tmp_path, run_)).isel({"clutch.stiffness": 1, "absorber.primary_inertia": 0})
    model = changed(tv.load_model(TRUCK), {"clutch.stiffness": 25e3, "absorber.primary_inertia": 1.0})
    for gear in ("8", "12"):
        cell = found.sel(gear=gear)
        speeds = np.array([float(cell.worst_speed)])
        beside = run_up_response(model, speeds, np.array([float(cell.worst_torque)]), gear, np.array([3.0, 6.0]))
        half = swing(acceleration(beside.angle.sel(node=model.landmarks.input)))
        assert float(cell.acceleration_swing) == pytest.approx(float(half.item()), rel=1e-9)


def test_response_at_full_load(tmp_path: Path) -> None:
    found = answered(planned(tmp_path, "{analysis: response, speed: '800:1000:100 rpm', orders: [3, 4.5]}"))
    assert dict(found.acceleration.sizes) == {
        "clutch.stiffness": 3, "absorber.primary_inertia": 2, "speed": 3, "order": 2
    }  # fmt: skip
    assert found.acceleration.attrs["units"] == "rad/s²" and (found.acceleration > 0).all()


def test_claims_and_scenarios_are_asked(tmp_path: Path) -> None:
    found = answered(planned(tmp_path, "{analysis: claims, ids: [A6, C1]}"))
    assert found.verdict.dims[-1] == "claim" and set(np.unique(found.verdict)) <= {0, 1, 2, 3}
    short = planned(tmp_path, "{analysis: transient, scenario: tip_in}", high="high")
    one = load_plan(short)
    model = changed(one.work.build, one.work.designs.rows(0, 1)[0])  # type: ignore[arg-type]
    answer = one.work.run(model)
    assert float(answer["torque_highest"].max()) > 0 and answer["torque_highest"].attrs["units"] == "Nm"  # type: ignore[union-attr]


def test_tables_have_units_in_their_header(tmp_path: Path) -> None:
    (tmp_path / "designs.csv").write_text(
        "clutch.stiffness [kNm/rad],absorber.primary_inertia\n20,1.0\n25,1.2\n", encoding="utf-8"
    )
    text = PLAN.replace("chunk: 4", "designs: {{method: table, file: designs.csv}}")
    plan = load_plan(planned(tmp_path, text=text))
    assert plan.work.designs.rows(0, 2) == [
        {"clutch.stiffness": 20e3, "absorber.primary_inertia": 1.0},
        {"clutch.stiffness": 25e3, "absorber.primary_inertia": 1.2},
    ]


@pytest.mark.parametrize(
    ("method", "count", "designs"), [("latin_hypercube", 9, 9), ("morris", 9, 27), ("saltelli", 16, 64)]
)
def test_a_tolerance_is_about_the_models_own_value(tmp_path: Path, method: str, count: int, designs: int) -> None:
    text = PLAN.replace("low: 15 kNm/rad, high: 35 kNm/rad, points: 3", "tolerance: 10 %")
    text = text.replace('values: [1.0, "1.4 kgm²"]', "tolerance: 0.25, spacing: logarithmic")
    path = planned(tmp_path, text=text.replace("chunk: 4", f"designs: {{{{method: {method}, count: {count}}}}}"))
    plan = load_plan(path)
    stiffness, inertia = plan.work.designs.axes.values()
    assert (stiffness.low, stiffness.high) == pytest.approx((22.5e3, 27.5e3), rel=1e-15) and not stiffness.log
    assert (inertia.low, inertia.high) == pytest.approx((0.9, 1.5), rel=1e-15) and inertia.log
    assert len(plan.work.designs) == designs


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("torsional_sweep: 1", "torsional_sweep: 2", "written for a later torsional"),
        ("torsional_sweep: 1", "torsional: 1", "the key 'torsional_sweep' is missing; is this a model file?"),
        (
            "clutch.stiffness",
            "clutch.stifness",
            r"over.0.low \(line 5\): the model refuses it: .*did you mean 'stiffness'",
        ),
        ("low: 15 kNm/rad", "low: 15 kNm", "over.0.low .*kNm"),
        ("low: 15 kNm/rad", "low: 45 kNm/rad", r"over.0 .*the ends of a parameter must rise; found 45000 to 35000"),
        ("low: 15 kNm/rad, ", "", "a parameter needs values or ends; found 'clutch.stiffness'"),
        ("low: 15 kNm/rad", "values: [1], low: 15 kNm/rad", "values or ends, not both"),
        ("absorber.primary_inertia", "clutch.stiffness", "over.1 .*named twice"),
        ("points: 3", "points: 1", "points"),
        (", points: 3", "", "the key 'points' is missing"),
        ("analysis: modes", "analysis: mods", "mods"),
        ("count: 3", "cuont: 3", "the key is unknown.*did you mean 'count'"),
        ("chunk: 4", "chunk: 0", "chunk"),
        (
            "low: 15 kNm/rad, high: 35 kNm/rad",
            "tolerance: 10",
            "over.0.tolerance .*too large; found 10.*as 0.1 or 10 %",
        ),
        ("low: 15 kNm/rad, high: 35 kNm/rad", "tolerance: -10 %", "over.0.tolerance .*must be positive"),
        ("low: 15 kNm/rad, high", "tolerance: 10 %, high", "has ends or a tolerance, not both"),
        ("values: [1.0", "tolerance: 10 %, values: [1.0", "values or ends, not both"),
        (
            "clutch.stiffness, low: 15 kNm/rad, high: 35 kNm/rad",
            "clutch.stifness, tolerance: 10 %",
            "did you mean 'stiffness'",
        ),
        (
            "clutch.stiffness, low: 15 kNm/rad, high: 35 kNm/rad",
            "gearbox.ratios, tolerance: 10 %",
            r"over.0.parameter .*about one value that the model file gives, other than 0; found 'gearbox.ratios'",
        ),
        ("chunk: 4", "designs: {method: saltelli, count: 2}", r"need more base points; found 2; allowed: >= 16"),
        ("chunk: 4", "designs: {method: sobol}", "the key 'count' is missing"),
        ("chunk: 4", "designs: {method: table}", "the key 'file' is missing"),
        ('[1.0, "1.4 kgm²"]', "[-1.0]", "the model refuses it: absorber.primary_inertia: must be positive; found -1"),
        ('[1.0, "1.4 kgm²"]', "[]", "a parameter has no values"),
        ('[1.0, "1.4 kgm²"]', "1.0", "over.1.values"),
        ("{analysis: modes, count: 3}", "{analysis: claims, ids: [Z9]}", "there is no such claim.*Z9"),
        ("{analysis: modes, count: 3}", "{analysis: transient, scenario: nosuch}", "nosuch"),
    ],
)
def test_bad_plans_are_refused(tmp_path: Path, old: str, new: str, told: str) -> None:
    path = planned(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ModelError, match=told):
        load_plan(path)


JOBS = "jobs: 8, cores: 16, memory: 32 GB"


@pytest.mark.parametrize(
    ("workers", "kind"),
    [
        ("{kind: dask, address: tcp://node-1:8786}", Dask),
        ("{kind: local_cluster}", LocalCluster),
        (f'{{kind: slurm, {JOBS}, walltime: "1-02:00:00", queue: fast, account: me, extra: [--exclusive]}}', Slurm),
        (f'{{kind: pbs, {JOBS}, walltime: "02:00:00", account: me, interface: ib0, prologue: [module load x]}}', Pbs),
        (f'{{kind: lsf, {JOBS}, walltime: "02:00", project: me}}', Lsf),
    ],
)
def test_workers_of_a_plan(tmp_path: Path, workers: str, kind: type) -> None:
    path = planned(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(WORKERS, workers), encoding="utf-8")
    assert isinstance(load_plan(path).workers, kind)


@pytest.mark.parametrize(
    ("workers", "told"),
    [
        ("{kind: slumr, jobs: 8}", "workers.*slumr"),
        ("{count: 2}", "workers.*kind"),
        ("{kind: processes, count: -1}", "workers.*count"),
        ("{kind: dask}", "workers.*address"),
        ("{kind: dask, address: node-1}", "workers.*no address of a scheduler; found 'node-1'.*tcp://host:8786"),
        ("{kind: slurm, jobs: 8, cores: 16}", "workers.*memory"),
        ("{kind: slurm, jobs: 8, cores: 16, memory: 32}", "workers.*memory"),
        ("{kind: slurm, jobs: 8, cores: 16, memory: much}", "no size of memory; found 'much'; allowed: .*16 GB"),
        (f"{{kind: slurm, {JOBS}, walltime: long}}", "no time of a job; found 'long'"),
        (f"{{kind: slurm, {JOBS}, queu: fast}}", "did you mean 'queue'"),
        (f"{{kind: lsf, {JOBS}, account: me}}", "workers.*account"),
    ],
)
def test_workers_that_cannot_be_are_refused(tmp_path: Path, workers: str, told: str) -> None:
    path = planned(tmp_path)
    path.write_text(path.read_text(encoding="utf-8").replace(WORKERS, workers), encoding="utf-8")
    with pytest.raises(ModelError, match=told):
        load_plan(path)


def test_jobs_are_asked_for_as_the_systems_want_it() -> None:
    """The scripts that dask-jobqueue would send, without a queue."""
    jobqueue = pytest.importorskip("dask_jobqueue")
    given: dict[str, Any] = {"jobs": 2, "cores": 4, "memory": "8 GB", "queue": "fast", "extra": ["--x=1"]}
    given["prologue"] = ["load y"]
    for asked, lines in (
        (Slurm(kind="slurm", account="me", walltime="02:00:00", **given), ["-p fast", "-A me", "-t 02:00:00"]),
        (Pbs(kind="pbs", account="me", walltime="02:00:00", **given), ["-q fast", "-A me", "walltime=02:00:00"]),
        (Lsf(kind="lsf", project="me", walltime="02:00", **given), ["-q fast", '-P "me"', "-W 02:00", "-n 4"]),
    ):
        job = getattr(jobqueue, asked.queueing).job_cls("tcp://127.0.0.1:1", name="w", **asked.settings)
        for line in [*lines, "--x=1", "load y", "--nworkers 4", "--nthreads 1"]:
            assert line in job.job_script()


def test_the_plans_of_the_examples_are_plans() -> None:
    folder = ROOT / "examples" / "plans"
    plan = load_plan(folder / "clutch_and_primary.yaml")
    assert len(plan.work.designs) == 15 and plan.name == "clutch stiffness and primary inertia"
    assert len(load_plan(folder / "what_matters.yaml").work.designs) == 140
    assert len(load_plan(folder / "tolerances.yaml").work.designs) == 400
