"""Designs asked by the numbers of their systems, one at a time, against designs that are built."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.studies.sweeps import grid, sampled, sweep
from torsional.studies.sweeps import work as working
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.designs import Designs
from torsional.studies.sweeps.numbers import Told, system_of
from torsional.studies.sweeps.periodic import PeriodicRun
from torsional.studies.sweeps.work import Work
from torsional.system import assemble

TWO_STAGE = tv.load_model(Path(__file__).parents[2] / "examples" / "truck_dmf_two_stage.yaml")
OVER = {
    "absorber.stages.0.stiffness": (6e3, 12e3),
    "absorber.stages.1.stiffness": (16e3, 32e3),
    "absorber.secondary_inertia": (0.6, 1.2),
    "clutch.damping": (20.0, 40.0),
}
RUN = PeriodicRun.model_validate({"analysis": "periodic", "torque": "1200 Nm", "speed": "600:1100:50 rpm"})


def asked(designs: Designs, run: Any, least: int, monkeypatch: pytest.MonkeyPatch, chunk: int = 100) -> xr.Dataset:
    """A sweep in which ``least`` designs and more are asked by their numbers."""
    with monkeypatch.context() as patch:
        patch.setattr(working, "MANY", least)
        return sweep(TWO_STAGE, designs, run, chunk=chunk)


def test_branches_by_numbers_are_those_of_models_that_are_built(monkeypatch: pytest.MonkeyPatch) -> None:
    """Folds, doublings and swings to 1e-10; numbers of a design are right to rounding, and so is what follows."""
    designs = sampled("sobol", OVER, 8, seed=2)
    built = asked(designs, RUN, 10**9, monkeypatch)
    with monkeypatch.context() as patch:
        patch.setattr(working, "changed", None)  # nothing is built
        found = asked(designs, RUN, 1, patch)
    assert not found.status.values.any() and found.doublings.max() == 2 and np.ptp(found.twist_swing.values) > 0.001
    for name, values in built.data_vars.items():
        assert found[name].attrs == values.attrs
        if values.dtype.kind == "f":
            np.testing.assert_allclose(found[name], values, rtol=1e-10, atol=0.0)
        else:
            np.testing.assert_array_equal(found[name], values)
    xr.testing.assert_identical(found, asked(designs, RUN, 1, monkeypatch, chunk=3))


@pytest.mark.parametrize("gear", ["1", "12"])
def test_a_system_by_numbers_is_the_system_that_is_assembled(gear: str) -> None:
    """Every number, the stages' hinges and stops with them."""
    designs = sampled("sobol", OVER, 4, seed=5)
    batch = Batch.of(TWO_STAGE, designs)
    assert batch is not None and batch.answers(gear)
    numbers = batch.numbers(gear, designs.columns(0, 4))
    for place, values in enumerate(designs.rows(0, 4)):
        own, other = system_of(*numbers, place), assemble(changed(TWO_STAGE, values).powertrain(gear))
        np.testing.assert_allclose(Told.of(own).numbers, Told.of(other).numbers, rtol=1e-12, atol=0.0)
        assert Told.of(own).form == Told.of(other).form
        law, built = (one.connections.laws[one.connections.names.index("dmf")] for one in (own, other))
        np.testing.assert_allclose(getattr(law, "stops", ()), getattr(built, "stops", ()), rtol=1e-12)
        np.testing.assert_allclose(own.M, other.M, rtol=1e-12)


def test_designs_that_are_not_covered_or_refused_are_built(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stiffness that cannot be has the reason of the model; an analysis that refuses a design is asked again."""
    designs = grid({"absorber.stages.1.stiffness": [16e3, 24e3, 32e3, -1.0]})
    built, found = (asked(designs, RUN, least, monkeypatch) for least in (10**9, 1))
    assert found.status.values.tolist() == [0, 0, 0, 1]
    assert found.reason.values.tolist() == built.reason.values.tolist()
    refusing = RUN.model_copy(update={"speed": (10.0, 20.0, 5.0), "torque": None})  # below the full-load curve
    built, found = (asked(designs, refusing, least, monkeypatch) for least in (10**9, 1))
    assert (found.status == 1).all() and found.reason.values.tolist() == built.reason.values.tolist()


def test_one_that_is_refused_by_numbers_is_built_to_be_told_why() -> None:
    class Refusing:
        def possible(self, batch: Batch) -> bool:
            return True

        def covers(self, batch: Batch, columns: Any) -> Any:
            return np.ones(len(next(iter(columns.values()))), dtype=bool)

        def each(self, batch: Batch, columns: Any) -> Any:
            return self._each

        def _each(self, design: int) -> Any:
            if design:
                raise ModelError("not by numbers")
            return {"figure": 1.0}

        def __call__(self, model: Model) -> Any:
            return {"figure": 2.0}

    designs = grid({"clutch.damping": [20.0, 30.0]})
    work = Work(TWO_STAGE, designs, Refusing(), Batch.of(TWO_STAGE, designs))
    assert work.stretch(0, 2)["answer.0.figure"].tolist() == [1.0, 2.0]
