"""Text tables as loggers and spreadsheets write them: units, decimals, missing values, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from torsional import ModelError
from torsional.measurements import read_measurement


def read(folder: Path, text: str | bytes, name: str = "run.csv") -> xr.Dataset:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_measurement(path)


def refused(folder: Path, text: str | bytes, name: str = "run.csv") -> str:
    with pytest.raises(ModelError) as caught:
        read(folder, text, name)
    told = str(caught.value)
    assert told.startswith(str(folder / name)) and "\n" not in told
    return told.removeprefix(f"{folder / name}: ")


def test_columns_are_channels_with_units_and_sampling(tmp_path: Path) -> None:
    data = read(tmp_path, "# rig 3\ntime [ms],n_mot [1/min],M (left) [Nm]\n0,1500,-2.5\n2,1501,nan\n4,1502,1e3\n")
    assert data.time.values.tolist() == [0.0, 0.002, 0.004]
    assert (data.time.attrs["units"], data.time.attrs["sampling"], data.time.attrs["sampling_rate"]) == (
        "s",
        "even",
        500,
    )
    assert (data.n_mot.dims, data.n_mot.dtype, data.n_mot.attrs["units"]) == (("time",), np.float64, "1/min")
    np.testing.assert_array_equal(data["M (left)"], [-2.5, np.nan, 1000.0])
    assert (data.attrs["format"], data.attrs["source"]) == ("CSV", "run.csv")


@pytest.mark.parametrize(
    "text",
    [
        "time [s];a [Nm]\r\n0,5;1,25\r\n1,5;-2\r\n",
        "\ufefftime [s]\ta [Nm]\n0.5\t1.25\n1.5\t-2\n",
        'time [s],a [Nm]\n"0,5","1,25"\n"1.5","-2"\n',
        "Time;a\ns;Nm\n0.5; 1.25\n1.5;-2\n",
        "sep=;\nDevice: rig 3\nDate; 2026-11-23\n\ntime;a\ns;Nm\n0,5;1,25\n1,5;-2\n",
    ],
    ids=["decimal commas", "tabs and a byte order mark", "quoted cells", "units below the names", "lines above"],
)
def test_dialects(tmp_path: Path, text: str) -> None:
    data = read(tmp_path, text)
    assert data.time.values.tolist() == [0.5, 1.5]
    assert data.a.values.tolist() == [1.25, -2.0]
    assert data.a.attrs["units"] == "Nm"


def test_two_rasters_and_events_in_one_table(tmp_path: Path) -> None:
    data = read(tmp_path, "time [s],a [V],time_2 [s],b,time of tacho [s]\n0,1,0,5,0.3\n1,2,,,0.7\n2,,,,0.8\n")
    assert data.a.dims == ("time",) and data.b.dims == ("time_2",) and data.tacho.dims == ("time_3",)
    np.testing.assert_array_equal(data.a, [1.0, 2.0, np.nan])
    assert data.tacho.values.tolist() == data.time_3.values.tolist() == [0.3, 0.7, 0.8]
    assert data.tacho.attrs["kind"] == "pulses" and data.time_3.attrs["sampling"] == "uneven"


def test_a_raster_that_loggers_round_is_even_and_one_with_a_gap_is_not(tmp_path: Path) -> None:
    times = np.round(np.arange(3000) / 3000.0, 7)
    data = read(tmp_path, "time [s],a\n" + "".join(f"{t:.7f},0\n" for t in times))
    assert data.time.attrs["sampling_rate"] == pytest.approx(3000.0, rel=1e-6)
    gap = read(tmp_path, "time [s],a\n" + "".join(f"{t:.7f},0\n" for t in np.delete(times, 7)))
    assert gap.time.attrs == {"units": "s", "sampling": "uneven"}


def test_channels_of_one_name_and_of_a_rasters_name_are_told_apart(tmp_path: Path) -> None:
    data = read(tmp_path, "t [s],a,a,<b>&'x'/../y\n0,1,2,3\n1,1,2,3\n")
    assert list(data.data_vars) == ["a", "a (2)", "<b>&'x'/../y"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "the file is empty"),
        ("time [s],a\n", "the table has no row below its header; found 'time [s],a'"),
        ("0,1\n1,2\n", "the table has no header with names; found '0,1'"),
        ("a [V],b [V]\n0,1\n1,2\n", "no column holds the time; found 'a', 'b'; name a column named 'time [s]'"),
        ("time [s],a\n0,1\n1\n", "line 3: 2 cells are wanted; found 1 cells in '1'"),
        ("time [s],a\n0,1,5\n1,2,5\n", "line 2: 2 cells are wanted; found 3 cells in '0,1,5'; decimals take a point"),
        ("time [s],a\n0,=1+1\n1,2\n", "line 2, column 'a': a plain number is wanted; found '=1+1'; write values"),
        ("time [s],a\n0,1\n1,two\n", "line 3, column 'a': a plain number is wanted; found 'two'"),
        ("time [s],a\n0,1e999\n1,2\n", "line 2, column 'a': a number this large is not read; found '1e999'"),
        ("time [s],a\n0,1\n2,1\n1,1\n", "time of 'a': must increase from sample to sample; found 1.0 after 2.0 at"),
        ("time [s],a\n0,1\n1,1\n1,1\n", "time of 'a': must increase from sample to sample; found 1.0 after 1.0 at"),
        ("time [s],a\n0,1\n,1\n2,1\n", "time of 'a': a finite number is wanted; found nan at sample 2"),
        ("time [s],a\n0,\n1,nan\n", "no channel of the file has a value; found 1 channels of NaN alone"),
        ("time [kg],a\n0,1\n1,1\n", "column 'time': this is no unit of time; found 'kg'; allowed: s, ms, min, h"),
        ("time [s],a\n0,1\n1,2\n".encode("utf-16"), "the file is not UTF-8 but probably UTF-16; save it as UTF-8"),
        (b"time [s],a\n0,1\0\n", "line 2: the file holds a control character; found a NUL byte"),
        (b"time [s],\xb5\n0,1\n", "line 1: the file is not UTF-8 text; found byte 0xb5 at offset 9"),
        (b"\x80\x05\x95garbage", "this is no measurement file; found a Python pickle"),
        (b"PK\x03\x04workbook", "this is no measurement file; found an archive or a workbook; allowed: .mf4"),
    ],
)
def test_what_is_wrong_is_told_in_one_sentence(tmp_path: Path, text: str | bytes, told: str) -> None:
    assert refused(tmp_path, text).startswith(told)


def test_folders_and_files_that_are_not_there(tmp_path: Path) -> None:
    (tmp_path / "rig.csv").write_text("time [s],a\n0,1\n")
    with pytest.raises(ModelError, match="this is a folder, not a file; name the file in it"):
        read_measurement(tmp_path)
    with pytest.raises(ModelError, match=r"there is no such file; did you mean 'rig\.csv'"):
        read_measurement(tmp_path / "rigg.csv")
