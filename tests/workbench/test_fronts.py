"""Fronts: what a finished search or sweep holds, design by design."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import torsional
from torsional.errors import ModelError
from torsional.results import labelled, save_results
from torsional.studies.optimise.optimise import optimise
from torsional.studies.optimise.task import Limit, Method
from torsional.workbench.fronts import MOST, front_of


@pytest.fixture(scope="module")
def searched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small search, saved."""
    truck = torsional.load_model("examples/truck_dmf.yaml")

    def figures(model: torsional.Model) -> dict[str, float]:
        clutch, dmf = model.components["clutch"].law.stiffness, model.components["dmf"].law.stiffness
        return {"soft": clutch + dmf, "stiff": 1e9 / (clutch * dmf)}

    ends = {"clutch.stiffness": (12e3, 40e3), "absorber.stiffness": (8e3, 20e3)}
    limits = {"soft": Limit(most=50e3)}
    found = optimise(truck, ends, figures, ["soft", "stiff"], limits=limits, method=Method(8, 3))
    path = tmp_path_factory.mktemp("front") / "small.nc"
    save_results(found, path)
    return path


def test_a_search_is_told_design_by_design(searched: Path) -> None:
    found, data = front_of(searched), torsional.load_results(searched)
    assert [p["path"] for p in found["parameters"]] == ["clutch.stiffness", "absorber.stiffness"]
    assert {c["name"] for c in found["criteria"] if c["objective"]} == {"soft", "stiff"}
    assert (found["parameters"][0]["values"] == data["clutch.stiffness"].values).all()
    soft = next(c for c in found["criteria"] if c["name"] == "soft")
    assert (soft["values"] == data.soft.values).all() and soft["better"] == "less"
    assert [soft["limits"], found["criteria"][1 - found["criteria"].index(soft)]["limits"]] == [[None, 50e3], None]
    assert found["on_front"].sum() == data.on_front.values.sum() > 1 and found["role"][0] == "nominal"


def test_a_grid_is_laid_out_flat(tmp_path: Path) -> None:
    grid, a, b = np.arange(6.0).reshape(2, 3), "absorber.stiffness", "clutch.stiffness"
    parts = {"swing": ((a, b), grid, "torque"), "many": ((a, b, "order"), np.ones((2, 3, 2)), "torque")}
    data = labelled(
        parts,
        {a: ([1.0, 2.0], "stiffness"), b: ([3.0, 4.0, 5.0], "stiffness"), "order": ([1.0, 2.0], "")},
        analysis="sweep",
    )
    save_results(data, tmp_path / "grid.nc")
    found = front_of(tmp_path / "grid.nc")
    assert [c["name"] for c in found["criteria"]] == ["swing"] and found["on_front"] is None
    (swing,), (first, second) = found["criteria"], found["parameters"]
    assert swing["values"].tolist() == [0, 1, 2, 3, 4, 5] and first["values"].tolist() == [1, 1, 1, 2, 2, 2]
    assert second["values"].tolist() == [3, 4, 5, 3, 4, 5]


def test_of_very_many_designs_the_front_stays(tmp_path: Path) -> None:
    count = 3 * MOST
    best = np.arange(count) % 20011 == 7
    data = labelled({"f": (("design",), np.arange(count, dtype=float), "torque")}, {}, analysis="optimisation")
    data = data.assign(on_front=("design", best))
    save_results(data, tmp_path / "many.nc")
    found = front_of(tmp_path / "many.nc")
    assert found["on_front"].sum() == best.sum() and found["designs"] < MOST + 10 < found["all"] == count


def test_what_holds_no_designs_is_refused(tmp_path: Path) -> None:
    truck = torsional.load_model("examples/truck_dmf.yaml")
    save_results(torsional.campbell(truck), tmp_path / "c.nc")
    with pytest.raises(ModelError, match="holds no designs"):
        front_of(tmp_path / "c.nc")
    with pytest.raises(ModelError, match="this is not a result file"):
        front_of(tmp_path / "absent.nc")
