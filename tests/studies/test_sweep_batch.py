"""Designs asked together give what each alone gives, and only those that can be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional
from torsional.files.edit import changed
from torsional.model import Model
from torsional.studies.sweeps import sampled, sweep
from torsional.studies.sweeps import work as working
from torsional.studies.sweeps.analyses import MapRun, ModesRun, ResponseRun
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.designs import Axis, Designs, grid, table
from torsional.studies.sweeps.work import MANY, Work

RESPONSE = ResponseRun.model_validate({"analysis": "response", "speed": [70.0, 200.0, 13.0], "orders": [1.5, 3.0]})
MAP = MapRun.model_validate({"analysis": "map", "gears": ["1", "12"], "speed": [70.0, 200.0, 26.0], "torques": 3})
MODES = ModesRun.model_validate({"analysis": "modes", "count": 5})
TWO = MAP.model_copy(update={"orders": [3.0, 6.0]})
OVER = {"absorber.stiffness": (3e3, 20e3), "absorber.primary_inertia": (0.8, 1.8), "absorber.damping": (5.0, 60.0)}


def model(name: str) -> Model:
    return torsional.load_model(f"examples/{name}.yaml")


def together(build: Model, designs: Designs, run: Any, chunk: int = 90) -> xr.Dataset:
    assert Work(build, designs, run)._batch is not None
    return sweep(build, designs, run, chunk=chunk)


def one_by_one(build: Model, designs: Designs, run: Any, monkeypatch: pytest.MonkeyPatch) -> xr.Dataset:
    with monkeypatch.context() as patch:
        patch.setattr(working, "MANY", 10**9)
        return sweep(build, designs, run)


def assert_alike(found: xr.Dataset, expected: xr.Dataset) -> None:
    assert found.coords.keys() == expected.coords.keys() and found.attrs == expected.attrs
    for name, values in expected.data_vars.items():
        assert found[name].dims == values.dims and found[name].attrs == values.attrs
        if values.dtype.kind == "f":
            np.testing.assert_allclose(found[name], values, rtol=1e-9, atol=1e-13 * float(abs(values).max()))
        else:
            np.testing.assert_array_equal(found[name], values)


@pytest.mark.parametrize("run", [MODES, RESPONSE, MAP, TWO], ids=["modes", "response", "map", "map of two orders"])
def test_designs_together_are_designs_one_by_one(run: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Soft springs meet their stops at full load, at torques that differ from design to design."""
    truck, designs = model("truck_dmf"), sampled("sobol", OVER, MANY, seed=3)
    found = together(truck, designs, run)
    assert_alike(found, one_by_one(truck, designs, run, monkeypatch))
    xr.testing.assert_identical(found, together(truck, designs, run, chunk=MANY))


@pytest.mark.parametrize(
    ("name", "over"),
    [
        ("truck_psva", {"absorber.planet_inertia": (0.05, 0.2), "absorber.stiffness": (8e3, 2e4)}),
        ("truck_dmf_tva", {"absorber.tva.order": (1.2, 1.8), "clutch.damping": (20.0, 40.0)}),
        ("truck_dmf_pendulum", {"absorber.secondary_inertia": (0.6, 1.2), "absorber.pendulum.mass": (0.5, 1.5)}),
        ("truck_dmf_two_stage", {"absorber.stages.1.stiffness": (2e4, 4e4), "gearbox.stiffness.3": (2e5, 4e5)}),
        ("passenger_car_dmf", {"driveline.tyre_stiffness": (1e4, 3e4)}),
    ],
)
def test_every_absorber_can_be_asked_so(name: str, over: dict[str, Any]) -> None:
    """A few designs of each by both ways."""
    machine, designs = model(name), sampled("sobol", over, 4)
    batch = Batch.of(machine, designs)
    assert batch is not None and RESPONSE.possible(batch)
    run = RESPONSE.model_copy(update={"orders": [2.0], "speed": None})
    found = run.many(batch, designs.columns(0, 4))
    for design, values in enumerate(designs.rows(0, 4)):
        alone = run(changed(machine, values)).acceleration
        np.testing.assert_allclose(found.acceleration[design], alone, rtol=1e-9, atol=1e-12 * float(alone.max()))


@pytest.mark.parametrize(
    ("name", "over"),
    [
        ("truck_dmf", {"driveline.final_drive_ratio": (2.5, 3.5)}),  # other weights
        ("truck_dmf", {"engine.bore": (0.12, 0.13)}),  # another engine
        ("truck_planetary_dmf", {"absorber.stiffness": (1e4, 2e4)}),  # an inertia that speed switches
        ("truck_dmf_arc_spring", {"absorber.friction.sliding_coefficient": (0.05, 0.1)}),  # a law without hinges
        ("truck_dmf_two_stage", {"absorber.stages.0.stiffness": (5e3, 1e4), "absorber.stages.0.up_to": (5e2, 1e3)}),
    ],
)
def test_what_does_not_follow_is_not_guessed(name: str, over: dict[str, Any]) -> None:
    batch = Batch.of(model(name), sampled("sobol", over, 4))
    assert batch is None or not RESPONSE.possible(batch)


def test_designs_that_cannot_be_are_refused_as_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """Among many that can; a value that is no number as well."""
    truck = model("truck_dmf")
    levels = [*np.linspace(1e4, 2e4, MANY).tolist(), -1.0, "stiff", float("nan")]
    designs = grid({"clutch.stiffness": levels})
    found = together(truck, designs, RESPONSE)
    assert found.status.values.tolist() == [0] * MANY + [1] * 3
    expected = one_by_one(truck, designs, RESPONSE, monkeypatch)
    assert found.reason.values.tolist() == expected.reason.values.tolist()
    assert_alike(found, expected)


def test_a_design_outside_of_what_is_proven_is_built_alone() -> None:
    """Falling stages and values out of reach are left to the model's own checks."""
    truck = model("truck_dmf")
    batch = Batch.of(truck, table({"clutch.stiffness": [1e4, 2e4, 0.0, True, 3e4]}))
    assert batch is not None
    assert RESPONSE.covers(batch, {"clutch.stiffness": [1e4, 2e4, 0.0, True, 3e4, 4e4]}).tolist() == [
        True, True, False, False, True, False,
    ]  # fmt: skip


def test_few_designs_are_not_worth_it() -> None:
    designs = Designs({"clutch.stiffness": Axis(low=1e4, high=2e4)}, MANY - 1, "sobol")
    assert Work(model("truck_dmf"), designs, RESPONSE)._batch is None


def test_an_array_library_answers_alike() -> None:
    truck, designs = model("truck_dmf"), sampled("sobol", OVER, MANY, seed=3)
    assert_alike(together(truck, designs, TWO.model_copy(update={"backend": "numpy"})), together(truck, designs, TWO))


def test_what_is_refused_for_all_is_told_of_each() -> None:
    """Speeds that the full-load curve does not reach."""
    run = RESPONSE.model_copy(update={"speed": (20.0, 40.0, 5.0)})
    found = together(model("truck_dmf"), sampled("sobol", OVER, MANY), run)
    assert (found.status == 1).all() and "does not reach this speed" in str(found.reason.values[0])
