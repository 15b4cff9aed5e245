"""Datasets survive a round trip through netCDF, units and complex values included."""

from pathlib import Path

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.results import dataset, load_results, save_results


def test_round_trip(tmp_path: Path) -> None:
    values = np.array([[1 + 2j, 3 - 1j]])
    made = dataset(
        {"angle": (("speed", "order"), values, "angle")},
        {"speed": ([62.8], "speed"), "order": ([1.5, 3.0], "engine_order")},
        analysis="test",
        model_hash="abc",
        settings={"orders": [1.5, 3.0]},
    )
    read = load_results(save_results(made, tmp_path / "r.nc"))
    assert read.identical(made)
    assert read.angle.attrs["units"] == "rad"
    assert read.attrs["model_hash"] == "abc"
    assert [p.name for p in tmp_path.iterdir()] == ["r.nc"]


def test_refused(tmp_path: Path) -> None:
    (tmp_path / "no.nc").write_text("not netCDF")
    with pytest.raises(ModelError, match="not a result file"):
        load_results(tmp_path / "no.nc")
    with pytest.raises(ModelError, match="saved as netCDF"):
        save_results(dataset({}, {}, analysis="x"), tmp_path / "r.csv")
