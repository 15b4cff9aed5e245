"""Datasets survive a round trip through netCDF, units and complex values included."""

from pathlib import Path

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.results import dataset, labelled, load_results, save_results


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
    with pytest.raises(ModelError, match=r"saved as netCDF or CSV.*in \.csv for spreadsheets"):
        save_results(dataset({}, {}, analysis="x"), tmp_path / "r.xlsx")
    with pytest.raises(ModelError, match="no variable"):
        save_results(dataset({}, {}, analysis="x"), tmp_path / "r.csv")
    assert [p.name for p in tmp_path.iterdir()] == ["no.nc"]


def test_a_table_has_its_units_in_the_headings(tmp_path: Path) -> None:
    made = labelled(
        {"angle": (("speed", "node"), np.array([[1 + 2j, 3j]]), "angle"), "swing": (("speed",), [2.5], "torque")},
        {"speed": ([20 * np.pi], "speed"), "node": (["hub", "=rim"], "")},
        analysis="test",
    )
    text = save_results(made, tmp_path / "r.csv").read_bytes().decode("utf-8-sig")
    heading, row = ([*line.split(",")] for line in text.splitlines())
    assert heading[:4] == ["speed [rad/s]", "speed [rpm]", "angle hub real [rad]", "angle hub imaginary [rad]"]
    assert heading[-1] == "swing [Nm]"
    assert [float(cell) for cell in row] == pytest.approx([20 * np.pi, 600.0, 1.0, 2.0, 0.0, 3.0, 2.5], rel=1e-15)


def test_one_quantity_is_a_table_too(tmp_path: Path) -> None:
    shaken = labelled({"a": (("order",), [4.0], "acceleration")}, {"order": ([3.0], "engine_order")}, analysis="x").a
    text = save_results(shaken, tmp_path / "r.csv").read_text(encoding="utf-8-sig")
    assert text.split() == ["order,a", "[rad/s²]", "3.0,4.0"]


def test_one_name_for_one_thing() -> None:
    speed = {"speed": ([100.0], "speed")}
    with pytest.raises(ModelError, match=r"no such name.*did you mean 'mean_twist'"):
        dataset({"mean_twists": (("speed",), [0.1], "relative_angle")}, speed, analysis="x")
    with pytest.raises(ModelError, match=r"another quantity.*found angle.*allowed: torque"):
        dataset({"torque": (("speed",), [0.1], "angle")}, speed, analysis="x")
    with pytest.raises(ModelError, match="third argument"):
        dataset({}, {"moonlight": ([0.1], "")}, analysis="x")
    with pytest.raises(ModelError, match=r"coordinate is \(values, quantity\).*speed"):
        dataset({}, {"speed": (("speed",), [100.0], "speed")}, analysis="x")  # type: ignore[dict-item]
    told = dataset({"wear": (("speed",), [0.1], "ratio")}, speed, {"wear": "share of a lining"}, analysis="x")
    assert told.wear.attrs["quantity"] == "ratio"
