"""Answers written chunk by chunk are those collected whole, whatever the designs and the chunks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional
from torsional.errors import ModelError
from torsional.model import Model
from torsional.results import load_results
from torsional.studies.sweeps import grid, sampled
from torsional.studies.sweeps.designs import Designs
from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import Work

TRUCK = torsional.load_model("examples/truck_dmf.yaml")
LEVELS = {"clutch.stiffness": [1e4, 2e4, 3e4], "absorber.damping": [1.0, 2.0], "clutch.damping": [5.0, 6.0, 7.0, 8.0]}
GRID = grid(LEVELS)
SOBOL = sampled("sobol", {"clutch.stiffness": (1e4, 3e4)}, 17)


def asked(model: Model) -> xr.Dataset:
    """Figures of several sizes and kinds; some designs refused."""
    clutch = model.document["clutch"]
    if clutch["damping"] == 7.0:
        raise ModelError("not this one")
    values = clutch["stiffness"] + np.arange(6.0).reshape(2, 3)
    data = xr.Dataset({"curve": (("place", "order"), values), "gears": len(model.gears)}, {"order": [1.0, 2.0, 3.0]})
    data.curve.attrs |= {"units": "Nm/rad", "quantity": "stiffness"}
    return data


def pieces(designs: Designs, folder: Path, size: int, run: Any = asked) -> Pieces:
    made = Pieces.of(Work(TRUCK, designs, run), folder, size)
    made.worked(1, lambda done, total: None)
    return made


@pytest.mark.parametrize("size", [1, 3, 5, 8, 24])
@pytest.mark.parametrize("designs", [GRID, SOBOL], ids=["grid", "sobol"])
def test_written_by_stretches_is_written_whole(designs: Designs, size: int, tmp_path: Path) -> None:
    """Chunks that begin and end in the middle of a grid's lines."""
    found = pieces(designs, tmp_path / "sweep", size).collected()
    found.write(tmp_path / "found.nc")
    xr.testing.assert_identical(load_results(tmp_path / "found.nc"), found.whole())


def test_kinds_that_netcdf_has_not_are_written_too(tmp_path: Path) -> None:
    made = pieces(SOBOL, tmp_path / "sweep", 5, lambda model: {"turn": 1j * len(model.gears), "fine": True})
    found = made.collected()
    found.write(tmp_path / "found.nc")
    told = load_results(tmp_path / "found.nc")
    assert (told.turn == 12j).all() and told.fine.values.all()


def test_ranges_are_those_of_all_numbers(tmp_path: Path) -> None:
    """Designs without an answer count for nothing; the median of very many numbers is that of some."""
    found = pieces(GRID, tmp_path / "sweep", 5).collected()
    curve = found.whole().curve.values
    expected = (np.nanmin(curve), np.nanmedian(curve), np.nanmax(curve))
    assert found.ranges()["curve"] == pytest.approx(expected, rel=0, abs=0)
    assert found.counts == {"ok": 18, "refused": 6, "failed": 0, "crashed": 0}


def test_the_median_of_many_numbers_does_not_depend_on_the_chunks(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("torsional.studies.sweeps.collected.PICKED", 20)
    told = [pieces(GRID, tmp_path / f"{size}", size).collected().ranges()["curve"] for size in (1, 5, 24)]
    assert told[0] == told[1] == told[2]
