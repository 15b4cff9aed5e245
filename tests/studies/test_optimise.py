"""Optimisation: known fronts are found, the same bits however the work is cut and begun again, gradients are exact."""

from __future__ import annotations

import dataclasses
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.studies.optimise import Limit, Method, optimise
from torsional.studies.optimise.front import front, knee
from torsional.studies.optimise.gradients import Around, points_of
from torsional.studies.optimise.lines import Built
from torsional.studies.optimise.optimise import optimised
from torsional.studies.optimise.plan import load_optimisation
from torsional.studies.optimise.presets import PRESETS, absorber_task, criteria_of, preset, stiff_tuned
from torsional.studies.optimise.refine import Refinement
from torsional.studies.optimise.result import role
from torsional.studies.optimise.task import Task, share_of
from torsional.studies.sweeps import Axis
from torsional.studies.sweeps.criteria import CriteriaRun
from torsional.studies.trucks import Trucks

ROOT = Path(__file__).parents[2]
TRUCKS = Trucks.shipped()
BOX = {"x": (0.0, 1.0), "y": (0.0, 1.0)}


class Made:
    """Stands for a model: the two numbers of a design."""

    def __init__(self, x: float, y: float) -> None:
        self.x, self.y = x, y


def made(x: float, y: float) -> Any:
    if x > 0.95:
        raise ModelError("this design cannot be", where="x", found=f"{x:g}")
    return Made(x, y)


def asked(design: Any) -> dict[str, float]:
    """Zitzler, Deb and Thiele's first problem in two variables: the front is y = 0, second = 1 − sqrt(first)."""
    g = 1 + 9 * design.y
    return {"first": design.x, "second": g * (1 - np.sqrt(design.x / g)), "third": design.x * design.y}


def found(**options: Any) -> xr.Dataset:
    settings: dict[str, Any] = {"method": Method(24, 25, 3), "between": -1, **options}
    return optimise(made, BOX, asked, ["first", "second"], **settings)


def test_the_front_of_a_known_problem_is_found() -> None:
    data = found()
    on = data.isel(design=np.flatnonzero(data.on_front.values))
    assert on.sizes["design"] >= 20
    off = abs(on.second - (1 - np.sqrt(on["first"])))
    assert float(off.median()) < 0.02 and float(off.max()) < 0.1
    assert float(on["first"].min()) < 0.02 and float(on["first"].max()) > 0.8
    middle = role(data, "knee")
    assert middle is not None and float(middle["first"]) == pytest.approx(0.25, abs=0.08)  # least x + 1 − sqrt(x)


def test_designs_that_cannot_be_are_accounted_for_and_never_best() -> None:
    data = found()
    refused = data.x > 0.95
    assert int(refused.sum()) > 0
    assert (data.status.values == refused.values).all() and (data.reason.values[refused] != "").all()
    assert np.isnan(data["first"].values[refused]).all() and not data.on_front.values[refused].any()
    assert data.attrs["designs refused"] == int(refused.sum())


def test_limits_are_kept() -> None:
    data = found(limits={"second": Limit(most=0.5), "first": Limit(least=0.4)})
    on = data.isel(design=np.flatnonzero(data.on_front.values))
    assert float(on.second.max()) <= 0.5 and float(on["first"].min()) >= 0.4
    assert not data.within.values[data["first"].values < 0.4].any()
    none = found(limits={"second": Limit(most=-1.0)}, method=Method(8, 2))
    assert not none.on_front.any() and "No design keeps all limits" in none.attrs["findings"]


def test_one_objective_and_three() -> None:
    one = optimise(made, BOX, asked, ["second"], method=Method(20, 40), between=-1)
    best = role(one, "best second")
    assert best is not None and float(best.x) == pytest.approx(0.95, abs=0.01)
    assert float(best.y) == pytest.approx(0.0, abs=0.01)
    large = optimise(made, BOX, asked, ["third"], maximised=["third"], method=Method(20, 40), between=-1)
    best = role(large, "best third")
    assert best is not None and float(best.third) == pytest.approx(0.95, abs=0.02)
    three = optimise(made, BOX, asked, ["first", "second", "third"], method=Method(20, 10), between=-1)
    assert role(three, "best third") is not None and role(three, "knee") is not None


@pytest.mark.full
def test_gradients_find_the_way_into_limits_that_a_short_search_misses() -> None:
    """Ends of the front as a search of 3000 designs and its refinement gave them: 118.09 and 31.06 rad/s²."""
    task = preset("best-pendulum", TRUCKS, {"space": "2.5 kgm²"}).task
    found = optimised(task, Method(16, 3), 0)
    within = found.within.values
    assert not within[: 1 + 16 * 3].any() and within[1 + 16 * 3 :].all()
    assert float(found.low_speed[within].min()) == pytest.approx(118.09, rel=1e-3)
    assert float(found.high_speed[within].min()) == pytest.approx(31.06, rel=1e-3)


def test_pendulums_are_tuned_above_their_order_and_keep_to_a_mass() -> None:
    task = preset("best-pendulum", TRUCKS, {"mass": "5 kg"}).task
    assert isinstance(task.build, Model)
    pendulum: Any = task.build.components["pendulum"]
    assert pendulum.order == pytest.approx(1.02 * 3) and task.axes["absorber.pendulum.mass"].high == 5.0
    exact = preset("best-pendulum", TRUCKS, {"tuning": "1"}).task
    assert isinstance(exact.build, Model)
    assert exact.axes["absorber.pendulum.mass"].high == pytest.approx(1.5 * pendulum.mass)
    ask = CriteriaRun.of(task.run, ["low_speed"])  # type: ignore[arg-type]
    assert float(ask(exact.build).low_speed) < 0.8 * float(ask(task.build).low_speed)
    with pytest.raises(ModelError, match="cannot be so light; found 1 kg"):
        preset("best-pendulum", TRUCKS, {"mass": "1 kg"})


def test_one_seed_gives_one_result() -> None:
    alone = found(method=Method(8, 3, 7))
    xr.testing.assert_identical(alone, found(method=Method(8, 3, 7)))
    assert not np.array_equal(alone.x.values, found(method=Method(8, 3, 8)).x.values)


@pytest.mark.full
def test_one_seed_gives_one_result_whatever_the_number_of_processes() -> None:
    xr.testing.assert_identical(found(method=Method(8, 3, 7)), found(method=Method(8, 3, 7), processes=2))


def test_what_is_kept_is_not_worked_out_again(tmp_path: Path) -> None:
    folder, settings = tmp_path / "kept", {"method": Method(8, 5, 7)}
    whole = found(**settings, folder=folder)
    chunks = sorted((folder / "chunks").iterdir())
    assert len(chunks) == 5 * 4
    for lost in chunks[1::3]:
        lost.unlink()
    chunks[2].write_bytes(chunks[2].read_bytes()[:-1] + b"?")
    times = {path: path.stat().st_mtime_ns for path in (chunks[0], chunks[3])}
    xr.testing.assert_identical(whole, found(**settings, folder=folder))
    assert times == {path: path.stat().st_mtime_ns for path in times}
    with pytest.raises(ModelError, match="another plan"):
        found(method=Method(8, 5, 6), folder=folder)


SCRIPT = """
import sys
import time
from torsional.studies.optimise import Method
from tests.studies import test_optimise as t


def slow(design):
    time.sleep(0.01)
    return t.asked(design)


if __name__ == "__main__":
    t.optimise(t.made, t.BOX, slow, ["first", "second"], method=Method(8, 6, 5), between=-1, folder=sys.argv[1])
"""


@pytest.mark.full
def test_a_search_that_was_killed_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    around = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "src"), str(ROOT)])}
    folder = tmp_path / "kept"
    first = subprocess.Popen([sys.executable, str(script), str(folder)], env=around)
    latest = time.monotonic() + 60
    while len(list((folder / "chunks").glob("*.chunk"))) < 6 and time.monotonic() < latest:
        time.sleep(0.01)
    first.send_signal(signal.SIGKILL)
    first.wait()
    begun = len(list((folder / "chunks").glob("*.chunk")))
    assert 6 <= begun < 24
    undisturbed = tmp_path / "undisturbed"
    for at in (folder, undisturbed):
        subprocess.run([sys.executable, str(script), str(at)], env=around, check=True)
    both = [{p.name: p.read_bytes() for p in (at / "chunks").iterdir()} for at in (folder, undisturbed)]
    assert both[0] == both[1] and len(both[0]) == 24


def test_what_cannot_be_optimised_is_refused() -> None:
    with pytest.raises(ModelError, match=r"no such criterion.*did you mean 'second'"):
        optimise(made, BOX, asked, ["secnd"], method=Method(4, 1))
    with pytest.raises(ModelError, match="single figure"):
        optimise(
            made, BOX, lambda design: xr.Dataset({"first": ("order", np.zeros(2))}), ["first"], method=Method(4, 1)
        )
    with pytest.raises(ModelError, match="ends of a parameter must rise"):
        optimise(made, {"x": (1.0, 0.0)}, asked, ["first"])
    with pytest.raises(ModelError, match="cannot be given this function"):
        optimise(made, BOX, lambda design: {"first": 1.0}, ["first"], processes=2)


def test_fronts_and_knees() -> None:
    rng = np.random.default_rng(1)
    goals = rng.random((200, 3))
    on = front(goals)
    for place, mine in enumerate(goals):
        bettered = ((goals <= mine).all(axis=1) & (goals < mine).any(axis=1)).any()
        assert bettered != (place in on)
    assert knee(np.array([[0.0, 10.0], [1.0, 5.0], [2.0, 0.0]])) == 0  # a straight front has none


def test_values_have_their_places_on_axes() -> None:
    for axis, value in ((Axis(low=2.0, high=8.0), 5.0), (Axis(low=2.0, high=8.0, log=True), 4.0), (Axis((1, 2)), 2)):
        share = share_of(axis, value)
        assert share is not None and axis.at(np.array([share]))[0] == pytest.approx(value)
    assert share_of(Axis(low=2.0, high=8.0), 9.0) == pytest.approx(7 / 6)


# --- gradients ---


def concept(name: str) -> Task:
    model = stiff_tuned(TRUCKS.tva) if name == "tva" else TRUCKS.models[name]
    own = {
        "dmf": ("absorber.stiffness", "absorber.secondary_inertia", "clutch.damping"),
        "psva": ("absorber.gear_quotient", "absorber.planet_inertia"),
        "tva": ("absorber.tva.stiffness", "absorber.primary_springs.stiffness"),
        "pendulum": ("absorber.pendulum.mass", "absorber.stiffness"),
    }[name]
    return absorber_task(model, dict.fromkeys(own, (0.5, 1.5)), {})


@pytest.mark.parametrize(
    ("name", "together"),
    [("dmf", False), ("dmf", True), ("psva", False), ("tva", True), ("pendulum", True)],
)
def test_derivatives_of_criteria_at_points_are_exact(name: str, together: bool) -> None:
    """Against differences of the figure at the same operating points; by built models, and by numbers of a batch."""
    task = concept(name)
    batch = task.batch() if together else None
    assert (batch is not None) == together
    refinement = Refinement(task, {"low_speed": 1.0, "high_speed": 1.0}, batch)
    assert set(task.limits) - {"space"} <= set(refinement.active)
    start = task.nominal_share
    assert start is not None
    for each in refinement.active.values():
        each.look(refinement.alone(start))
    exact, others = refinement.at(start)
    truth = task.run(task.build)  # type: ignore[operator, arg-type]
    for each, (values, _) in exact.items():
        assert float(values.max()) == pytest.approx(float(truth[each]), rel=1e-9)
    for place in range(len(start)):
        step = np.zeros(len(start))
        step[place] = 1e-4
        (high, _), (low, _) = (refinement.at(start + d * step) for d in (1, -1))
        for each, (_, slopes) in exact.items():
            known = (high[each][0] - low[each][0]) / 2e-4
            scale = max(np.abs(slopes).max(), 1e-3 * np.abs(exact[each][0]).max())
            assert np.abs(slopes[:, place] - known).max() < 1e-5 * scale, (each, place)
    assert set(others) == {"space"}


def test_gradients_make_a_design_better_and_keep_its_limits() -> None:
    task = concept("dmf")
    start = task.nominal_share
    assert start is not None
    better = Refinement(task, {"low_speed": 1.0}, task.batch()).refined(start)
    models = [changed(task.build, {n: v[0] for n, v in task.columns(share[None]).items()}) for share in (start, better)]  # type: ignore[arg-type]
    before, after = (task.run(model) for model in models)
    assert float(after["low_speed"]) < 0.9 * float(before["low_speed"])  # type: ignore[arg-type]
    for name, limit in task.limits.items():
        assert limit.beyond(np.array(float(after[name]))) <= 0  # type: ignore[arg-type]


def test_designs_beyond_limits_are_worse_than_any_within() -> None:
    """A softer flywheel is better and swings farther: better designs beyond the limit order themselves by how far."""
    task = concept("dmf")
    start = task.nominal_share
    assert start is not None
    lowered = (np.arange(start.size) == list(task.axes).index("absorber.stiffness")).astype(float)
    soft, softer = start - 0.2 * lowered, start - 0.4 * lowered
    designs = (start, soft, softer)
    told = [figures(task, shares, "low_speed", "travel") for shares in designs]
    travel = [each["travel"] for each in told]
    assert told[2]["low_speed"] < told[0]["low_speed"] and travel == sorted(travel)
    tight = dataclasses.replace(task, limits={"travel": Limit(most=0.5 * (travel[0] + travel[1]))})
    refinement = Refinement(tight, {"low_speed": 1.0}, tight.batch())
    aims = [refinement._aim(shares) for shares in designs]
    assert aims[0] == pytest.approx(told[0]["low_speed"], rel=1e-9) and refinement.within(start)
    assert aims[0] < aims[1] < aims[2] < np.inf


def figures(task: Task, shares: Any, *names: str) -> dict[str, float]:
    """Some criteria of a design."""
    values = {name: column[0] for name, column in task.columns(shares[None]).items()}
    run = task.run.of(names)  # type: ignore[union-attr]
    return {name: float(value) for name, value in run(changed(task.build, values)).items()}  # type: ignore[arg-type]


def test_what_has_no_exact_gradients_says_so() -> None:
    task = Task(made, {"x": Axis(low=0.0, high=1.0)}, asked, ("first",))  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="models of files"):
        Refinement(task, {"first": 1.0})
    data = found(between=3, method=Method(4, 1))
    assert "Not refined by gradients" in data.attrs["findings"]
    run = criteria_of(TRUCKS.dmf)
    assert points_of(run, "space", TRUCKS.dmf) == []
    assert Around(TRUCKS.dmf, Built(TRUCKS.dmf), {}).values(points_of(run, "travel", TRUCKS.dmf)[0])[1].shape[1] == 0


# --- plans and presets ---

PLAN = """
torsional_optimise: 1
model: {model}
over:
  - {{parameter: absorber.stiffness, low: 8 kNm/rad, high: 20 kNm/rad, spacing: logarithmic}}
  - {{parameter: clutch.damping, low: 15, high: 60}}
run:
  analysis: criteria
  ask:
    worst: {{analysis: envelope, gears: ["12"], loads: [1.0], step: 200 rpm}}
    whole: {{analysis: inertia}}
  criteria:
    low_speed: {{of: worst, figure: acceleration_swing, select: {{speed: "600:1000 rpm"}}}}
    high_speed: {{of: worst, figure: acceleration_swing, select: {{speed: "1000:2000 rpm"}}}}
    travel: {{of: worst, figure: twist}}
    space: {{of: whole, figure: inertia}}
objectives: [low_speed, high_speed]
constraints:
  space: {{most: "2.5 kgm²"}}
  travel: {{most: 16 deg}}
method: {{population: 6, generations: 2, seed: 4}}
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.yaml"
    path.write_text(PLAN.format(model=ROOT / "examples" / "truck_dmf.yaml"), encoding="utf-8")
    return path


def test_a_plan_is_read(plan: Path) -> None:
    asked = load_optimisation(plan)
    assert asked.task.limits["space"] == Limit(most=2.5)
    assert asked.task.limits["travel"].most == pytest.approx(np.deg2rad(16))
    assert asked.method == Method(6, 2, 4)
    assert asked.task.nominal_values == {"absorber.stiffness": 13e3, "clutch.damping": 30.0}


BAD = [
    ("objectives: [low_speed", "objectives: [lw_speed", ["objectives", "'lw_speed'", "did you mean 'low_speed'?"]),
    ("space: {most", "spce: {most", ["constraints", "'spce'", "did you mean 'space'?"]),
    ("most: 16 deg", "most: 16 Nm", ["constraints.travel.most", "Nm is a torque, and an angle is wanted"]),
    ("absorber.stiffness", "absorber.stifness", ["over.0.low", "stifness", "did you mean"]),
    ("torsional_optimise: 1", "torsional_sweep: 1", ["'torsional_optimise' is missing", "torsional sweep"]),
    ("population: 6", "population: 2", ["method.population"]),
    ("analysis: criteria", "analysis: modes", ["run"]),
]


@pytest.mark.parametrize(("old", "new", "told"), BAD, ids=[new for _, new, _ in BAD])
def test_bad_plans_teach(plan: Path, old: str, new: str, told: list[str]) -> None:
    plan.write_text(plan.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ModelError) as caught:
        load_optimisation(plan)
    assert [part for part in told if part not in str(caught.value)] == []


@pytest.mark.parametrize("name", list(PRESETS))
def test_presets_are_tasks_on_any_truck(name: str) -> None:
    car = Trucks.of(tv.load_model(ROOT / "examples" / "passenger_car_dmf.yaml"))
    for trucks in (TRUCKS, car):
        task = preset(name, trucks).task
        assert isinstance(task.run, CriteriaRun)
        nominal = task.nominal_share
        values = task.nominal_values
        assert values is not None and set(values) == set(task.axes)
        if isinstance(task.build, Model):
            assert nominal is not None
            answered = task.run(task.build)
            assert all(np.isfinite(float(answered[each])) for each in task.wanted)
            assert float(answered["space"]) <= task.limits["space"].most


def test_presets_take_limits_with_units() -> None:
    task = preset("best-psva", TRUCKS, {"space": "2.8 kgm²", "travel": "20 deg"}).task
    assert task.limits["space"].most == 2.8 and task.limits["travel"].most == pytest.approx(np.deg2rad(20))
    with pytest.raises(ModelError, match=r"--power.*--space, --travel"):
        preset("best-psva", TRUCKS, {"power": "1 kW"})
    with pytest.raises(ModelError, match="did you mean 'best-psva'"):
        preset("best-psv", TRUCKS)


def test_a_preset_runs_on_a_tiny_budget() -> None:
    from torsional.studies.optimise.optimise import optimised

    task = preset("best-dmf", TRUCKS).task
    data = optimised(task, Method(4, 1), between=-1)
    assert data.sizes["design"] == 5 and (data.status == 0).all()
    own = role(data, "nominal")
    assert own is not None and float(own["low_speed"]) == pytest.approx(986.64381, rel=1e-6)
    assert json.loads(data.attrs["objectives"]) == ["low_speed", "high_speed"]
