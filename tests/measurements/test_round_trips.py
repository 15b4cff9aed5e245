"""What is written is read again: values to the last bit, units, names, rasters, the start of the recording."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.measurements.recordings import START, rig

from torsional import ModelError
from torsional.measurements import read_measurement, write_measurement
from torsional.measurements.recording import Channel, Found, Raster, recording

KEPT = {
    ".mf4": {"start", "group", "comment"},
    ".uff": {"start", "group", "comment"},
    ".mat": {"start"},
    ".parquet": {"start", "group", "comment"},
    ".csv": set(),
}
"""What a format keeps beside values, units, names, rasters and which channels are events."""
ENDINGS = list(KEPT)
NEAR = 1e-15
"""By what share of the longest time an even raster of a universal file, told by start and step, is off [-]."""


def there_and_back(data: xr.Dataset, folder: Path, ending: str) -> xr.Dataset:
    return read_measurement(write_measurement(data, folder / f"run{ending}"))


@pytest.mark.parametrize("ending", ENDINGS)
def test_every_channel_comes_back_to_the_last_bit(tmp_path: Path, ending: str) -> None:
    data = rig()
    back = there_and_back(data, tmp_path, ending)
    assert list(back.data_vars) == list(data.data_vars)
    for name in data.data_vars:
        was, now = data[name], back[name]
        np.testing.assert_array_equal(now.values, was.values)
        assert (now.dtype, now.dims, now.attrs["units"]) == (was.dtype, was.dims, was.attrs["units"])
        assert now.attrs.get("kind") == was.attrs.get("kind")
        noted = {key: was.attrs[key] for key in ("group", "comment") if key in was.attrs and key in KEPT[ending]}
        assert noted == {key: now.attrs.get(key) for key in noted}
    assert (back.attrs.get("start") == START) == ("start" in KEPT[ending])


@pytest.mark.parametrize("ending", ENDINGS)
def test_rasters_come_back(tmp_path: Path, ending: str) -> None:
    data = rig()
    back = there_and_back(data, tmp_path, ending)
    for dim in data.dims:
        tolerance = NEAR * data[dim].values[-1] if ending == ".uff" else 0.0
        np.testing.assert_allclose(back[dim].values, data[dim].values, rtol=0.0, atol=tolerance)
        assert back[dim].attrs == data[dim].attrs


@pytest.mark.parametrize("ending", [".uff", ".mat", ".parquet", ".csv"])
def test_order_curves_keep_amplitude_phase_and_speed(tmp_path: Path, ending: str) -> None:
    speed = Raster(np.linspace(600.0, 2000.0, 29), "speed", "rpm")
    curve = (1.0 + np.arange(29)) * np.exp(0.3j * np.arange(29)) * 1e-3
    back = there_and_back(recording(Found([Channel("θ", curve, speed, "rad")], "made"), ""), tmp_path, ending)
    found = back["θ"].values if "θ" in back else back["θ real"].values + 1j * back["θ imaginary"].values
    np.testing.assert_array_equal(found, curve)
    np.testing.assert_array_equal(back.speed.values, speed.values)
    assert back.speed.attrs["units"] == "rpm"


def test_signals_over_speed_are_none_of_mdf(tmp_path: Path) -> None:
    speed = Raster(np.array([600.0, 700.0]), "speed", "rpm")
    data = recording(Found([Channel("T", np.array([1.0, 2.0]), speed, "Nm")], "made"), "")
    with pytest.raises(ModelError, match=r"MDF takes signals over time; found over speed; write \.uff"):
        write_measurement(data, tmp_path / "run.mf4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", ENDINGS)
def test_names_that_mean_something_elsewhere(tmp_path: Path, ending: str) -> None:
    names = [
        "=cmd|' /C calc'!A0",
        "<script>alert(1)</script>",
        "../../etc/passwd",
        'a;b,c\t"d" [Nm] (x)',
        "end",
        "α" * 40,
    ]
    time = Raster(np.array([0.0, 0.1, 0.2]))
    made = [Channel(name, np.array([1.0, 2.0, i]), time, "Nm") for i, name in enumerate(names)]
    data = recording(Found(made, "made"), "")
    back = there_and_back(data, tmp_path, ending)
    assert list(back.data_vars) == list(data.data_vars)
    assert [back[name].values[2] for name in back.data_vars] == [0, 1, 2, 3, 4, 5]
    assert [path.name for path in tmp_path.iterdir()] == [f"run{ending}"]
    if ending == ".csv":
        assert "'=cmd" in (tmp_path / "run.csv").read_text(encoding="utf-8-sig")


@pytest.mark.parametrize("rate", [44100.0, 51200.0, 1e6, 3.7, 1 / 3])
def test_universal_files_tell_any_rate_exactly(tmp_path: Path, rate: float) -> None:
    """Six digits tell a whole rate; any other raster is written value by value."""
    time = Raster(0.25 + np.arange(50_000) / rate)
    data = recording(Found([Channel("a", time.values * 0, time, "V")], "made"), "")
    back = there_and_back(data, tmp_path, ".uff")
    np.testing.assert_allclose(back.time.values, time.values, rtol=1e-15)


def test_what_cannot_be_written_leaves_what_was_there(tmp_path: Path) -> None:
    target = tmp_path / "run.csv"
    target.write_text("mine")
    time = Raster(np.array([0.0, 1.0]))
    data = recording(Found([Channel("a", np.array([1.0, np.inf]), time)], "made"), "")
    with pytest.raises(ModelError, match=r"a text table holds no infinite values; write \.parquet"):
        write_measurement(data, target)
    assert [path.name for path in tmp_path.iterdir()] == ["run.csv"] and target.read_text() == "mine"
    with pytest.raises(ModelError, match=r"this one is not known here; found '\.mf5'.*did you mean '\.mf4'"):
        write_measurement(data, tmp_path / "run.mf5")
    with pytest.raises(ModelError, match=r"run\.uff: the file cannot be written \(No such file or directory\)"):
        write_measurement(data, tmp_path / "gone" / "run.uff")


def test_reading_takes_little_more_memory_than_the_file(tmp_path: Path) -> None:
    time = Raster(np.arange(200_000) / 1e4)
    data = recording(Found([Channel(f"c{i}", time.values + i, time, "V") for i in range(5)], "made"), "")
    path = write_measurement(data, tmp_path / "run.uff")
    tracemalloc.start()
    read_measurement(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 6 * path.stat().st_size
