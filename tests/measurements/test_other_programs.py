"""Files as other programs read and write them: asammdf, pyuff, SciPy, h5py, pandas and pyarrow, asked themselves."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas
import pytest
import scipy.io
from tests.measurements.mdf_by_hand import unsorted
from tests.measurements.recordings import rig

from torsional import ModelError
from torsional.measurements import read_measurement, write_measurement

TIME = np.arange(50) / 1000.0
WAVE = np.sin(TIME)


def quiet_module(name: str) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip(name)


# --- they read what is written here ---


def test_asammdf_reads_channels_units_and_groups(tmp_path: Path) -> None:
    asammdf, data = quiet_module("asammdf"), rig()
    with asammdf.MDF(write_measurement(data, tmp_path / "run.mf4")) as file:
        assert file.version == "4.10"
        for name in data.data_vars:
            signal = file.get(str(name))
            np.testing.assert_array_equal(signal.samples, data[name].values)
            np.testing.assert_array_equal(signal.timestamps, data[data[name].dims[0]].values)
            assert signal.unit == data[name].attrs["units"]
        assert file.groups[file.whereis("n_mot")[0][0]].channel_group.acq_name == "engine"
        assert file.get("n_mot").comment == "crank, 60-2 teeth"


def test_pyuff_reads_functions_and_units(tmp_path: Path) -> None:
    pyuff, data = quiet_module("pyuff"), rig()
    sets = pyuff.UFF(str(write_measurement(data, tmp_path / "run.uff"))).read_sets()
    assert [(each["type"], each["func_type"], each["binary"]) for each in sets] == [(58, 1, 1)] * 4
    for each, (name, values) in zip(sets, data.data_vars.items(), strict=True):
        assert each["id1"].strip() == name
        np.testing.assert_array_equal(each["data"], values.values)
        np.testing.assert_allclose(each["x"], values[values.dims[0]].values, rtol=1e-12, atol=1e-15)
        assert each["ordinate_axis_units_lab"].strip() == values.attrs["units"]
        assert each["abscissa_axis_units_lab"].strip() == "s"


def test_scipy_reads_vectors_and_their_units(tmp_path: Path) -> None:
    data = rig()
    found = scipy.io.loadmat(write_measurement(data, tmp_path / "run.mat"), squeeze_me=True)
    np.testing.assert_array_equal(found["n_mot"], data.n_mot.values)
    np.testing.assert_array_equal(found["time"], data.time.values)
    np.testing.assert_array_equal(found["M_gbx"], data["M_gbx µ²"].values)
    assert found["units"]["n_mot"].item() == "1/min" and found["names"]["M_gbx"].item() == "M_gbx µ²"


def test_pandas_reads_tables(tmp_path: Path) -> None:
    data = rig()
    text = pandas.read_csv(write_measurement(data, tmp_path / "run.csv"))
    np.testing.assert_allclose(text["n_mot [1/min]"], data.n_mot.values, rtol=1e-15)
    whole = pandas.read_parquet(write_measurement(data, tmp_path / "run.parquet"))
    np.testing.assert_array_equal(whole["M_gbx µ²"], data["M_gbx µ²"].values)
    np.testing.assert_array_equal(whole["time"], data.time.values)


# --- what they write is read here ---


def test_mdf_with_conversions_bits_and_texts(tmp_path: Path) -> None:
    asammdf = quiet_module("asammdf")
    linear = {"a": 0.25, "b": -40.0}
    signals = [
        asammdf.Signal(np.arange(50, dtype="u2"), TIME, name="oil", unit="°C", conversion=linear),
        asammdf.Signal(np.arange(50, dtype="i1"), TIME, name="small", unit="-"),
        asammdf.Signal(WAVE.astype("f4"), TIME, name="wave", unit="Nm"),
        asammdf.Signal(np.arange(50) % 2 == 0, TIME, name="switch"),
        asammdf.Signal(np.array([b"on", b"off"] * 25), TIME, name="words", encoding="utf-8"),
    ]
    with asammdf.MDF(version="4.10") as file:
        file.append(signals, acq_name="ECU", common_timebase=True)
        file.append(asammdf.Signal(WAVE, TIME + 1.0, name="wave", unit="V"), acq_name="rig")
        file.save(tmp_path / "plain.mf4")
        file.save(tmp_path / "packed.mf4", compression=2)
    for name in ("plain.mf4", "packed.mf4"):
        data = read_measurement(tmp_path / name)
        np.testing.assert_array_equal(data.oil, 0.25 * np.arange(50) - 40.0)
        np.testing.assert_array_equal(data.small, np.arange(50))
        np.testing.assert_array_equal(data.wave, WAVE.astype("f4").astype(float))
        np.testing.assert_array_equal(data["wave (rig)"], WAVE)
        np.testing.assert_array_equal(data.switch, np.arange(50) % 2 == 0)
        assert data.oil.attrs["units"] == "°C" and data["wave (rig)"].dims == ("time_2",)
        assert data.attrs["left_out"] == "words" and data.oil.attrs["group"] == "ECU"


def test_mdf_written_byte_by_byte_with_records_that_alternate(tmp_path: Path) -> None:
    fast = [(0.01 * i, 100 * i) for i in range(40)]
    slow = [(0.1 * i, -1.5 * i) for i in range(7)]
    (tmp_path / "run.mf4").write_bytes(unsorted(fast, slow))
    data = read_measurement(tmp_path / "run.mf4")
    np.testing.assert_array_equal(np.column_stack([data.time, data.level]), fast)
    np.testing.assert_array_equal(np.column_stack([data.time_2, data["T"]]), slow)
    assert (data.level.attrs["units"], data["T"].attrs["group"]) == ("mm", "slow")
    assert data.attrs["start"].startswith("2023-11-14T23:13:20")


def test_mdf_samples_that_are_marked_invalid_are_missing(tmp_path: Path) -> None:
    asammdf = quiet_module("asammdf")
    bad = np.arange(50) % 7 == 3
    signal = asammdf.Signal(WAVE, TIME, name="wave", unit="Nm", invalidation_bits=bad)
    with asammdf.MDF(version="4.10") as file:
        file.append([signal, asammdf.Signal(WAVE, TIME, name="whole")], common_timebase=True)
        file.save(tmp_path / "run.mf4")
    data = read_measurement(tmp_path / "run.mf4")
    np.testing.assert_array_equal(np.isnan(data.wave), bad)
    np.testing.assert_array_equal(data.whole, WAVE)


def test_mdf_of_the_third_version_says_what_to_do(tmp_path: Path) -> None:
    asammdf = quiet_module("asammdf")
    with asammdf.MDF(version="3.30") as file:
        file.append(asammdf.Signal(WAVE, TIME, name="wave"))
        file.save(tmp_path / "run.mdf")
    told = r"this version of MDF is not read; found version 3\.30; allowed: 4\.00 to 4\.20; convert"
    with pytest.raises(ModelError, match=told):
        read_measurement(tmp_path / "run.mdf")


@pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")  # of pyuff
@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.parametrize("even", [0, 1])
@pytest.mark.parametrize("spectrum", [False, True])
def test_universal_files_of_pyuff(tmp_path: Path, binary: int, even: int, spectrum: bool) -> None:
    """In text twelve digits of values and six of uneven times; in binary to the last bit."""
    pyuff, path = quiet_module("pyuff"), tmp_path / "run.uff"
    values = WAVE * 1234.5678 + (1j * TIME if spectrum else 0.0)
    told = {"rsp_ent_name": "eng", "rsp_node": 12, "rsp_dir": -3, "ref_ent_name": "NONE", "ref_node": 0, "ref_dir": 0}
    told |= {"id1": "wave", "ordinate_axis_units_lab": "m/s^2", "abscissa_axis_units_lab": "Hz" if spectrum else "s"}
    kinds = {"abscissa_spec_data_type": 18 if spectrum else 17, "ordinate_spec_data_type": 12}
    kinds |= {"orddenom_spec_data_type": 0, "abscissa_spacing": even, "func_type": 4 if spectrum else 1}
    pyuff.UFF(str(path)).write_sets([pyuff.prepare_58(binary=binary, x=TIME, data=values, **told, **kinds)], "add")
    data = read_measurement(path)
    np.testing.assert_allclose(data.wave, values, rtol=0 if binary else 2e-12, atol=0 if binary else 1e-8)
    np.testing.assert_allclose(data[data.wave.dims[0]], TIME, rtol=1e-15 if even else 1e-5)
    assert data.wave.dims == ("frequency" if spectrum else "time",)
    assert data.wave.attrs["units"] == "m/s^2" and data.wave.attrs["group"] == "eng 12:-Z"


def test_universal_files_whose_values_look_like_an_end(tmp_path: Path) -> None:
    """The eight bytes of this number are a line of four blanks and -1, by which datasets end."""
    path = tmp_path / "run.uff"
    data = rig()
    trap = np.frombuffer(b"\n    -1\n", "<f8")[0]
    data.n_mot.values[100:103] = trap
    np.testing.assert_array_equal(read_measurement(write_measurement(data, path)).n_mot, data.n_mot)


def test_matlab_structures_matrices_and_rates(tmp_path: Path) -> None:
    inner = {"time": TIME, "speed": WAVE[:, None], "note": "rig"}
    scipy.io.savemat(tmp_path / "run.mat", {"ECU": inner, "time": TIME * 2, "n": np.arange(50), "c": np.eye(2, 50)})
    data = read_measurement(tmp_path / "run.mat")
    np.testing.assert_array_equal(data.speed, WAVE)
    assert data.speed.attrs["group"] == "ECU" and data.n.dims != data.speed.dims
    np.testing.assert_array_equal(data["c[2]"], np.eye(2, 50)[1])
    assert data.attrs["left_out"] == "ECU.note"
    scipy.io.savemat(tmp_path / "rate.mat", {"Fs": 200.0, "y": WAVE}, do_compression=True)
    assert read_measurement(tmp_path / "rate.mat").time.attrs["sampling_rate"] == 200.0
    scipy.io.savemat(tmp_path / "table.mat", {"data": np.column_stack([TIME, WAVE, -WAVE])})
    table = read_measurement(tmp_path / "table.mat")
    np.testing.assert_array_equal(table.time, TIME)
    np.testing.assert_array_equal(table["data[3]"], -WAVE)


def test_matlab_exports_of_testlab(tmp_path: Path) -> None:
    record = {
        "x_values": {"start_value": 0.5, "increment": 1e-3, "number_of_values": 50.0, "quantity": {"label": "s"}},
        "y_values": {"values": WAVE[:, None], "quantity": {"label": "g"}},
        "function_record": {"name": "gearbox:+Z"},
    }
    scipy.io.savemat(tmp_path / "run.mat", {"Signal_0": record})
    data = read_measurement(tmp_path / "run.mat")
    np.testing.assert_array_equal(data["gearbox:+Z"], WAVE)
    assert (data["gearbox:+Z"].attrs["units"], data.time.values[0]) == ("g", 0.5)


def test_matlab_vectors_without_times_say_what_is_wanted(tmp_path: Path) -> None:
    scipy.io.savemat(tmp_path / "run.mat", {"time": TIME, "n": np.arange(49)})
    told = r"'n': no times belong to the channel; found 49 values; times of length 50; add a vector 'time' that is as"
    with pytest.raises(ModelError, match=told):
        read_measurement(tmp_path / "run.mat")


def newer_matlab(path: Path, **variables: Any) -> Path:
    """A file as MATLAB 7.3 writes it."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in variables.items():
            group, _, _ = name.rpartition("/")
            if group:
                file.require_group(group).attrs["MATLAB_class"] = np.bytes_("struct")
            held = np.array([[ord(letter)] for letter in values], "u2") if isinstance(values, str) else values
            item = file.create_dataset(name, data=held if isinstance(values, str) else np.atleast_2d(held))
            item.attrs["MATLAB_class"] = np.bytes_("char" if isinstance(values, str) else "double")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
    return path


def test_newer_matlab_files(tmp_path: Path) -> None:
    pairs = np.zeros(50, [("real", "f8"), ("imag", "f8")])
    pairs["real"], pairs["imag"] = WAVE, 2.0
    path = newer_matlab(
        tmp_path / "run.mat", time=TIME, n=WAVE, z=pairs, note="rig 3", **{"s/time": TIME * 2, "s/x": WAVE}
    )
    data = read_measurement(path)
    np.testing.assert_array_equal(data.n, WAVE)
    np.testing.assert_array_equal(data.z, WAVE + 2j)
    np.testing.assert_array_equal(data.time_2 if data.x.dims == ("time_2",) else data.time, TIME * 2)
    assert (data.attrs["format"], data.attrs["left_out"]) == ("MATLAB 7.3", "note")


def test_links_out_of_a_file_are_not_followed(tmp_path: Path) -> None:
    secret = newer_matlab(tmp_path / "secret.mat", time=TIME, n=WAVE)
    path = newer_matlab(tmp_path / "run.mat", time=TIME, n=WAVE)
    with h5py.File(path, "r+") as file:
        file["stolen"] = h5py.ExternalLink(str(secret), "/n")
        file.create_dataset("beside", (1, 50), "f8", external=[(str(secret), 0, 400)])
        file["soft"] = h5py.SoftLink("/n")
    data = read_measurement(path)
    assert list(data.data_vars) == ["n"] and data.attrs["left_out"] == "beside, soft, stolen"


def test_parquet_of_pandas(tmp_path: Path) -> None:
    quiet_module("pyarrow")
    frame = pandas.DataFrame({"n [rpm]": np.arange(50), "word": ["a"] * 50}, index=pandas.Index(TIME, name="time"))
    frame.to_parquet(tmp_path / "run.parquet")
    with pytest.raises(ModelError, match="no column holds the time"):
        read_measurement(write_without_time(tmp_path))
    data = read_measurement(tmp_path / "run.parquet")
    np.testing.assert_array_equal(data.n, np.arange(50.0))
    assert (data.n.attrs["units"], data.attrs["left_out"]) == ("rpm", "word")
    dates = pandas.date_range("2026-11-23", periods=50, freq="10ms")
    pandas.DataFrame({"n": np.arange(50.0), "time": dates}).to_parquet(tmp_path / "dates.parquet")
    assert read_measurement(tmp_path / "dates.parquet").time.attrs["sampling_rate"] == 100.0


def write_without_time(folder: Path) -> Path:
    pandas.DataFrame({"a": [1.0, 2.0], "b": [3.0, 4.0]}).to_parquet(folder / "none.parquet", index=False)
    return folder / "none.parquet"


@pytest.mark.parametrize(("name", "ending", "what"), [("asammdf", ".mf4", "MDF"), ("pyarrow", ".parquet", "Parquet")])
def test_without_the_extra_it_is_said_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, ending: str, what: str
) -> None:
    path = write_measurement(rig(), tmp_path / f"run{ending}")
    import_module = __import__("importlib").import_module

    def without(wanted: str) -> Any:
        if wanted.partition(".")[0] == name:
            raise ImportError(wanted)
        return import_module(wanted)

    monkeypatch.setattr("torsional.measurements.formats.import_module", without)
    told = rf"{what} needs the library {name}, which is not installed; pip install 'torsional\[measurement\]'"
    with pytest.raises(ModelError, match=told):
        read_measurement(path)
    with pytest.raises(ModelError, match=told):
        write_measurement(rig(), path)
