"""Maps in one compiled loop against points that are settled one by one."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.files import load_model
from torsional.model import Model
from torsional.numerics.stepping.marching import begin
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient import batches, engine_drive, steady_map, steady_sweep
from torsional.solvers.transient.batches import Asked, Batch, Row
from torsional.system import assemble
from torsional.units import RPM

VALUES = ("angle", "twist", "torque", "end_angle", "end_speed", "end_memory")


def shipped(name: str) -> Model:
    return load_model(f"examples/{name}.yaml")


def one_by_one(model: Model, speeds: np.ndarray, torque: float, **settings: object) -> xr.Dataset:
    """A row as it is found without the loop."""
    system = assemble(model.detailed().powertrain(model.top_gear))
    given = {"hold": model.landmarks.load, "parts": 2, **settings}
    found = steady_sweep(
        system, lambda speed: engine_drive(model, speed, torque, 9.0), speeds, directions=("up",), **given
    )
    return found.isel(direction=0)


def assert_same(row: xr.Dataset, alone: xr.Dataset, share: float = 1e-9) -> None:
    """Equal within rounding, far within the tolerance of settling: every word, and numbers of every variable."""
    for name in ("kind", "periods", "notes"):
        assert row[name].values.tolist() == alone[name].values.tolist()
    for name in VALUES:
        size = float(abs(alone[name]).max()) if alone[name].size else 0.0
        np.testing.assert_allclose(row[name].values, alone[name].values, rtol=0, atol=share * size)
    np.testing.assert_allclose(row.method_share, alone.method_share, rtol=0, atol=1e-12)  # of the whole energy


def test_a_map_has_what_its_points_have_by_themselves() -> None:
    model, speeds, torques = shipped("truck_dmf_two_stage"), np.array([800.0, 900.0, 1300.0]) * RPM, [1000.0, 1200.0]
    found = steady_map(model, speeds, torques, [model.top_gear], highest_order=9.0).isel(gear=0)
    assert sorted(set(found.periods.values.ravel().tolist())) == [1, 2]
    assert "one_by_one" not in found.attrs
    half = abs(found.twist.sel(order=1.5, element="dmf")).where(found.periods == 2)
    assert float(half.max()) > 0.01
    for torque in torques:
        alone = one_by_one(model, speeds, torque)
        assert_same(found.sel(mean_torque=torque), alone)
        assert found.status.sel(mean_torque=torque).values.tolist() == alone.status.values.tolist()


def test_springs_in_detail_with_friction_and_what_is_said_of_their_contacts() -> None:
    model, speeds = shipped("truck_dmf_straight_spring"), np.array([900.0, 1100.0]) * RPM
    found = steady_map(model, speeds, [1000.0], [model.top_gear], highest_order=9.0).isel(gear=0, mean_torque=0)
    assert float(abs(found.end_memory).max()) > 0 and all("guarded" in str(note) for note in found.notes.values)
    assert_same(found, one_by_one(model, speeds, 1000.0))


def test_what_the_loop_gives_up_is_settled_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    model, speeds = shipped("truck_dmf_two_stage"), np.array([900.0, 1000.0, 1100.0]) * RPM
    monkeypatch.setattr(batches, "GIVEN", 4)  # blocks: enough for the first point alone
    found = steady_map(model, speeds, [500.0], [model.top_gear], highest_order=9.0).isel(gear=0, mean_torque=0)
    assert ["by itself" in str(words) for words in found.status.values] == [False, True, True]
    assert_same(found, one_by_one(model, speeds, 500.0))


@pytest.mark.parametrize("name, reason", [("truck_dmf_pendulum", "pendulums"), ("truck_planetary_dmf", "switch")])
def test_lines_that_are_not_made_for_the_loop_say_so(name: str, reason: str) -> None:
    model, speeds = shipped(name), np.array([900.0, 1100.0]) * RPM
    found = steady_map(model, speeds, [500.0], [model.top_gear], highest_order=6.0)
    assert reason in found.attrs["one_by_one"]
    assert set(found.kind.values.ravel().tolist()) == {"periodic"}


@pytest.mark.parametrize("count, allowed, expected", [(4, "", 4), (None, "", 1), (4, "1", 1), (4, "9", 4)])
def test_rows_run_side_by_side_where_processors_are_only_counted(
    monkeypatch: pytest.MonkeyPatch, count: int | None, allowed: str, expected: int
) -> None:
    """Not every system tells which processors a process may use, and some tell nothing; one of many processes has one
    thread."""
    monkeypatch.delattr("os.sched_getaffinity", raising=False)
    monkeypatch.setattr("os.cpu_count", lambda: count)
    monkeypatch.setenv("NUMBA_NUM_THREADS", allowed)
    assert batches._processors() == expected


def test_a_row_begins_as_a_march_does() -> None:
    model, speed = shipped("truck_dmf_straight_spring"), 1000.0 * RPM
    system = assemble(model.detailed().powertrain(model.top_gear))
    drive = engine_drive(model, speed, 800.0, 9.0)
    row = Row(Batch(system, [[drive]], Asked(hold=model.landmarks.load, most_periods=1)), 0)  # no block: it only begins
    start, step = row.start, float(row.points.step[0])
    row.go()
    assert row.reached == 0
    plan = row.problems[0].plan
    memory = start.memory[plan.laws.of]
    own = begin(plan, start.angle, start.speed, memory=memory, reference=start.reference, step=step)
    for name, here, there in zip(Standing._fields, row.standing, own, strict=True):
        np.testing.assert_allclose(here, there, rtol=1e-9, atol=1e-9 * np.abs(there).max(initial=1.0), err_msg=name)
