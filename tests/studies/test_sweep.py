"""Sweeps: every design by itself, the same bits however the work is cut, ended and begun again."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.studies.answers import at_input, modes
from torsional.studies.sweeps import grid, sampled, sweep, table
from torsional.studies.trucks import Trucks

ROOT = Path(__file__).parents[2]
TRUCK = Trucks.shipped().dmf
SPEEDS = np.linspace(600.0, 2000.0, 8) * tv.RPM
LEVELS = {"clutch.stiffness": [20e3, 25e3, 30e3], "absorber.secondary_inertia": [0.8, 1.0]}
ENDS = {"clutch.stiffness": (15e3, 35e3), "absorber.secondary_inertia": (0.6, 1.4)}


def answered(model: Model) -> xr.Dataset:
    """Acceleration at the gearbox input over speed, and the lowest order speed."""
    found = tv.results.labelled(
        {"amplitude": (("speed",), at_input(model, SPEEDS), "acceleration")}, {"speed": (SPEEDS, "speed")}, analysis="x"
    )
    return found.assign(lowest=modes(model).order_speed.min())


def counted(model: Model) -> dict[str, Any]:
    """Quick: whole numbers and a complex one."""
    stiffness = model.components["clutch_damper"].stiffness if "clutch_damper" in model.components else 1.0
    return {"nodes": len(model.components), "turned": complex(stiffness, 1.0)}


def made(inertia: float, fail: float = 0.0) -> Model:
    """A model of named values that fails where it is told to."""
    if fail == 1.0:
        raise ValueError("told to")
    if fail == 2.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return changed(TRUCK, {"absorber.secondary_inertia": inertia})


def same(one: xr.Dataset, other: xr.Dataset) -> bool:
    """To the last bit, names and attributes too."""
    numbers = [name for name, values in one.variables.items() if values.dtype.kind != "O"]  # texts have addresses
    bits = all(one[name].values.tobytes() == other[name].values.tobytes() for name in numbers)
    return bits and one.identical(other)


def test_every_design_is_answered_as_by_itself() -> None:
    found = sweep(TRUCK, LEVELS, answered)
    assert found.amplitude.dims == ("clutch.stiffness", "absorber.secondary_inertia", "speed")
    assert found.amplitude.attrs["units"] == "rad/s²" and not found.status.values.any()
    for stiffness in LEVELS["clutch.stiffness"]:
        for inertia in LEVELS["absorber.secondary_inertia"]:
            model = changed(TRUCK, {"clutch.stiffness": stiffness, "absorber.secondary_inertia": inertia})
            here = found.sel({"clutch.stiffness": stiffness, "absorber.secondary_inertia": inertia})
            assert here.amplitude.values.tobytes() == at_input(model, SPEEDS).tobytes()
            assert float(here.lowest) == float(modes(model).order_speed.min())


def test_the_same_bits_however_it_is_cut(tmp_path: Path) -> None:
    designs = sampled("latin_hypercube", ENDS, 9, seed=2)
    whole = sweep(TRUCK, designs, answered)
    assert same(whole, sweep(TRUCK, designs, answered, chunk=4))
    assert same(whole, sweep(TRUCK, designs, answered, chunk=2, processes=2, folder=tmp_path))
    assert same(whole, sweep(TRUCK, designs, answered, chunk=2, folder=tmp_path))
    assert whole["clutch.stiffness"].dims == ("design",) and whole.amplitude.dims == ("design", "speed")


def test_what_is_there_is_not_worked_out_again(tmp_path: Path) -> None:
    """A torn chunk and a missing one are, nothing else is."""
    asked: list[float] = []

    def noted(model: Model) -> dict[str, Any]:
        asked.append(model.components["secondary"].inertia)  # type: ignore[attr-defined]
        return {"nodes": len(model.components)}

    over = {"absorber.secondary_inertia": np.linspace(0.5, 1.5, 10).tolist()}
    told: list[tuple[int, int]] = []
    whole = sweep(TRUCK, over, noted, folder=tmp_path, chunk=2, progress=lambda *at: told.append(at))
    assert told == [(n, 10) for n in range(0, 11, 2)] and len(asked) == 10
    chunks = sorted((tmp_path / "chunks").iterdir())
    chunks[1].write_bytes(chunks[1].read_bytes()[:-1])
    chunks[3].unlink()
    asked.clear()
    again = sweep(TRUCK, over, noted, folder=tmp_path, chunk=2)
    assert same(whole, again)
    assert asked == [over["absorber.secondary_inertia"][n] for n in (2, 3, 6, 7)]


def test_failures_have_a_status_and_a_reason() -> None:
    designs = table({"inertia": [1.0, -1.0, 1.2, 1.1], "fail": [0.0, 0.0, 1.0, 0.0]})
    found = sweep(made, designs, answered, chunk=2)
    assert found.status.values.tolist() == [0, 1, 2, 0]
    assert "must be positive" in str(found.reason.values[1]) or "-1" in str(found.reason.values[1])
    assert found.reason.values[2] == "ValueError: told to"
    assert np.isnan(found.amplitude.values).any(axis=1).tolist() == [False, True, True, False]
    assert (found.attrs["designs ok"], found.attrs["designs refused"], found.attrs["designs failed"]) == (2, 1, 1)


def test_a_chunk_without_any_answer_is_no_numbers() -> None:
    found = sweep(TRUCK, {"clutch.stiffness": [-1.0, -2.0, 2e4]}, answered, chunk=2)
    assert found.status.values.tolist() == [1, 1, 0]
    assert np.isnan(found.amplitude.values[:2]).all() and np.isfinite(found.amplitude.values[2]).all()
    none = sweep(TRUCK, {"clutch.stiffness": [-1.0]}, answered)
    assert set(none.data_vars) == {"status", "reason"}


def test_kinds_and_levels_are_kept() -> None:
    found = sweep(TRUCK, {"clutch.stiffness": ["20 kNm/rad", 25e3], "name": ["a", "b"]}, counted)
    assert found.nodes.dtype.kind == "i" and found.turned.dtype.kind == "c"
    assert found["name"].values.tolist() == ["a", "b"]
    assert found["clutch.stiffness"].values.tolist() == ['"20 kNm/rad"', "25000.0"]


@pytest.mark.parametrize("chunk", [1, 2, 3, 4])
def test_answers_of_another_shape_than_the_first_are_failures(chunk: int) -> None:
    """However the work is cut."""

    def uneven(model: Model) -> dict[str, Any]:
        inertia = model.components["secondary"].inertia  # type: ignore[attr-defined]
        return {"values": ("place", np.full(2 if inertia < 1 else 3, inertia))}

    found = sweep(TRUCK, {"absorber.secondary_inertia": [0.8, 1.2, 1.3, 0.9]}, uneven, chunk=chunk)
    assert found.status.values.tolist() == [0, 2, 2, 0]
    assert found["values"].values[[0, 3]].tolist() == [[0.8, 0.8], [0.9, 0.9]]
    assert np.isnan(found["values"].values[1:3]).all() and "other names, sizes or kinds" in str(found.reason.values[1])


def test_what_a_function_takes_from_around_it_belongs_to_the_sweep(tmp_path: Path) -> None:
    """The same text with another captured array is another sweep, not an old answer."""

    def asking(speeds: np.ndarray) -> Any:
        return lambda model: {"worst": at_input(model, speeds).max()}

    over = {"clutch.stiffness": [2e4]}
    first = sweep(TRUCK, over, asking(SPEEDS), folder=tmp_path)
    assert same(first, sweep(TRUCK, over, asking(SPEEDS.copy()), folder=tmp_path))
    with pytest.raises(ModelError, match="holds the sweep of another plan"):
        sweep(TRUCK, over, asking(SPEEDS[:2]), folder=tmp_path)


def test_values_and_labels_that_are_no_numbers() -> None:
    """A value that is none is a failure of its design; labels that are none and arrays in attrs are as good."""

    def labelled(model: Model) -> xr.Dataset:
        data = xr.Dataset({"size": ("place", np.ones(2))}, {"place": [1.0, np.nan]})
        data["size"].attrs["limits"] = np.zeros(2)
        return data

    found = sweep(TRUCK, {"clutch.stiffness": [2e4, float("nan"), 3e4]}, labelled, chunk=1)
    assert found.status.values.tolist() == [0, 1, 0] and found["size"].values[2].tolist() == [1.0, 1.0]


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such signal there")
def test_a_design_that_ends_processes_is_set_aside(tmp_path: Path) -> None:
    """After three; all others are answered."""
    designs = table({"inertia": [1.0, 1.1, 1.2, 0.9], "fail": [0.0, 2.0, 0.0, 0.0]})
    found = sweep(made, designs, counted, folder=tmp_path, chunk=2, processes=2)
    assert found.status.values.tolist() == [0, 3, 0, 0] and found.reason.values[1] == "ended 3 processes"
    assert json.loads((tmp_path / "crashes.json").read_text(encoding="utf-8")) == {"1": 3}


def test_a_folder_of_another_sweep_is_refused(tmp_path: Path) -> None:
    sweep(TRUCK, {"clutch.stiffness": [2e4]}, counted, folder=tmp_path)
    with pytest.raises(ModelError, match="holds the sweep of another plan"):
        sweep(TRUCK, {"clutch.stiffness": [3e4]}, counted, folder=tmp_path)
    with pytest.raises(ModelError, match="holds the sweep of another plan"):
        sweep(TRUCK, {"clutch.stiffness": [2e4]}, answered, folder=tmp_path)
    with pytest.raises(ModelError, match=r"cannot be (written|read)"):
        sweep(TRUCK, {"clutch.stiffness": [3e4]}, counted, folder=tmp_path / "plan.json" / "x")
    with pytest.raises(ModelError, match="a chunk has at least one design; found 0"):
        sweep(TRUCK, {"clutch.stiffness": [2e4]}, counted, chunk=0)
    with pytest.raises(ModelError, match=r"cannot be given this function; found .*; define it by def"):
        sweep(TRUCK, {"clutch.stiffness": [2e4]}, lambda model: {"n": 1}, processes=2)
    assert len(grid(LEVELS)) == 6
