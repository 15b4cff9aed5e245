"""Damaged and hostile files: one ModelError in one sentence, or a Dataset; never another error, a warning, a flood."""

from __future__ import annotations

import struct
import time
import tracemalloc
import zlib
from pathlib import Path

import h5py
import numpy as np
import pyarrow
import pyarrow.parquet
import pytest
import scipy.io
import xarray as xr
from tests.measurements.mdf_by_hand import unsorted
from tests.measurements.recordings import rig
from tests.measurements.test_other_programs import newer_matlab, quiet_module

from torsional import ModelError
from torsional.measurements import read_measurement, write_measurement

KINDS = [".csv", ".uff", ".mat", ".parquet", ".mf4", "packed.mf4", "turns.mf4", "packed.mat", "newer.mat"]
HEAD = 3000
"""Bytes in front, where the structure of most formats stands; half of the changes are made there."""


def sound(folder: Path, kind: str) -> Path:
    """A whole file of a kind."""
    data, path = rig(), folder / f"sound{kind}"
    if kind == "turns.mf4":
        path.write_bytes(unsorted([(0.01 * i, 100 * i) for i in range(40)], [(0.1 * i, 1.5 * i) for i in range(7)]))
        return path
    if kind == "newer.mat":
        signals = {
            "time": data.time.values,
            "n": data.n_mot.values,
            "s/time": data.time_2.values,
            "s/T": data["T oil"].values,
        }
        return newer_matlab(path, **signals, note="rig")
    if kind == "packed.mat":
        held = scipy.io.loadmat(write_measurement(data, folder / "plain.mat"))
        scipy.io.savemat(path, {k: v for k, v in held.items() if not k.startswith("__")}, do_compression=True)
        return path
    if kind == "packed.mf4":
        with quiet_module("asammdf").MDF(write_measurement(data, folder / "plain.mf4")) as file:
            file.save(path, compression=2)
        return path
    return write_measurement(data, path)


def mutant(data: bytes, chance: np.random.Generator) -> bytes:
    """The bytes cut somewhere, or with a few of them changed."""
    if chance.random() < 0.3:
        return data[: chance.integers(len(data))]
    changed = bytearray(data)
    for _ in range(chance.integers(1, 6)):
        at = chance.integers(min(HEAD, len(data)) if chance.random() < 0.5 else len(data))
        changed[at] = chance.integers(256) if chance.random() < 0.5 else changed[at] ^ (1 << chance.integers(8))
    return bytes(changed)


def tried(path: Path) -> str:
    """What reading a file said; "" where it is read."""
    try:
        data = read_measurement(path)
    except ModelError as error:
        assert str(error).startswith(f"{path}: ") and str(error).isprintable(), str(error)
        return str(error)
    assert isinstance(data, xr.Dataset) and all(values.dtype.kind in "fc" for values in data.data_vars.values())
    return ""


def attacked(folder: Path, kind: str, count: int, seed: int, capfd: pytest.CaptureFixture[str]) -> int:
    """How many of many mutants are refused; none prints anything or takes long."""
    data = sound(folder, kind).read_bytes()
    path, chance, refused = folder / f"mutant{kind}", np.random.default_rng(seed), 0
    capfd.readouterr()
    for _ in range(count):
        path.write_bytes(mutant(data, chance))
        before = time.process_time()
        refused += bool(tried(path))
        assert time.process_time() - before < 1.0
    assert capfd.readouterr() == ("", "")
    return refused


@pytest.mark.parametrize("kind", KINDS)
def test_mutants_are_told_or_read(tmp_path: Path, kind: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert attacked(tmp_path, kind, 200, 1, capfd) > 50


@pytest.mark.full
@pytest.mark.parametrize("kind", KINDS)
def test_many_mutants_are_told_or_read(tmp_path: Path, kind: str, capfd: pytest.CaptureFixture[str]) -> None:
    assert attacked(tmp_path, kind, 10_000, 2, capfd) > 2000


# --- files that swell, and other malice ---


def refused_cheaply(path: Path) -> str:
    """What is said of a file, for which no more than 100 MB are taken."""
    tracemalloc.start()
    before = time.process_time()
    said = tried(path)
    assert time.process_time() - before < 10.0
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100e6, peak
    return said.removeprefix(f"{path}: ")


def test_a_matlab_variable_that_claims_more_than_it_has(tmp_path: Path) -> None:
    path = tmp_path / "run.mat"
    scipy.io.savemat(path, {"time": np.arange(5.0), "n": np.arange(5.0)})
    data = bytearray(path.read_bytes())
    at = data.index(struct.pack("<II2i", 5, 8, 1, 5))
    data[at + 8 : at + 16] = struct.pack("<2i", 2**15, 2**16)
    path.write_bytes(data)
    assert refused_cheaply(path).startswith("the recording is too large; found over 1600000000 bytes unpacked")
    data[at + 8 : at + 16] = struct.pack("<2i", 1, 6)
    path.write_bytes(data)
    assert refused_cheaply(path).startswith("'time': a variable is damaged; found 40 bytes of type 9 for 6 values")


def test_a_matlab_variable_that_unpacks_to_gigabytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("torsional.measurements.mat_elements.UNPACKED", 10_000_000)
    monkeypatch.setattr(
        "torsional.measurements.mat_elements._Budget.__init__", lambda self: setattr(self, "left", 10**7)
    )
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
    bomb = zlib.compress(bytes(200_000_000), 1)
    (tmp_path / "run.mat").write_bytes(head + struct.pack("<II", 15, len(bomb)) + bomb)
    assert "the recording is too large" in refused_cheaply(tmp_path / "run.mat")


def test_a_packed_block_of_mdf_that_swells(tmp_path: Path) -> None:
    """A block announces a few bytes and unpacks to half a gigabyte, or announces a gigabyte."""
    path = sound(tmp_path, "packed.mf4")
    data = path.read_bytes()
    at = data.index(b"##DZ")
    size, packed = struct.unpack_from("<QQ", data, at + 32)
    bomb = zlib.compress(bytes(200_000_000), 1)
    block = data[at : at + 40] + struct.pack("<Q", len(bomb)) + bomb
    block = block[:8] + struct.pack("<Q", len(block)) + block[16:]
    link = data.index(struct.pack("<Q", at))
    grown = data + bytes(-len(data) % 8)
    path.write_bytes(grown[:link] + struct.pack("<Q", len(grown)) + grown[link + 8 :] + block)
    assert f"a compressed block is damaged; found over {size} bytes" in refused_cheaply(path)
    path.write_bytes(data[: at + 32] + struct.pack("<Q", 10**9) + data[at + 40 :])
    assert "a compressed block is damaged; found 1000000000 bytes" in refused_cheaply(path)
    assert packed < size


def test_mdf_blocks_in_a_circle_and_formulas_that_are_none(tmp_path: Path) -> None:
    asammdf, path = quiet_module("asammdf"), tmp_path / "run.mf4"
    signal = asammdf.Signal(np.arange(5.0), np.arange(5.0), name="n", conversion={"formula": "X1 * 2 + 1"})
    with asammdf.MDF(version="4.10") as file:
        file.append([signal, asammdf.Signal(np.arange(5.0), np.arange(5.0), name="m")], common_timebase=True)
        file.save(path)
    assert read_measurement(path).n.values.tolist() == [1.0, 3.0, 5.0, 7.0, 9.0]
    data = path.read_bytes()
    path.write_bytes(data.replace(b"X1 * 2 + 1", b"X1.real+ 1"))
    assert "a conversion is no formula; found 'X1.real+ 1'" in refused_cheaply(path)
    channel = data.rindex(b"##CN")
    first = data.index(b"##CN")
    path.write_bytes(data[: channel + 24] + struct.pack("<Q", first) + data[channel + 32 :])
    assert "blocks refer to each other in a circle; found CN" in refused_cheaply(path)
    path.write_bytes(data.replace(b"<HDcomment", b"<!DOCTYPE "))
    assert "a comment declares entities, which are not read" in refused_cheaply(path)


def test_newer_matlab_files_of_empty_chunks(tmp_path: Path) -> None:
    path = newer_matlab(tmp_path / "run.mat", time=np.arange(5.0))
    with h5py.File(path, "r+") as file:
        file.create_dataset("n", (1, 10**12), "f8", chunks=(1, 10**6), compression="gzip")
    assert refused_cheaply(path).startswith("the recording is too large; found 1 000 000 000 000 numbers")


def test_parquet_of_one_number_repeated(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A few bytes that stand for millions of rows."""
    monkeypatch.setattr("torsional.measurements.recording.VALUES", 1_000_000)
    table = pyarrow.table({"time": np.zeros(5_000_000)})
    pyarrow.parquet.write_table(table, tmp_path / "run.parquet", compression="zstd")
    assert (tmp_path / "run.parquet").stat().st_size < 50_000
    assert refused_cheaply(tmp_path / "run.parquet").startswith("the recording is too large; found 5 000 000 numbers")


def test_matlab_objects_and_cells_are_left_alone(tmp_path: Path) -> None:
    cells = np.empty((1, 2), dtype=object)
    cells[0, 0], cells[0, 1] = np.arange(3.0), "text"
    scipy.io.savemat(tmp_path / "run.mat", {"time": np.arange(5.0), "n": np.arange(5.0), "cells": cells})
    data = read_measurement(tmp_path / "run.mat")
    assert (list(data.data_vars), data.attrs["left_out"]) == (["n"], "cells")


def test_pickles_and_zips_by_the_name_of_a_measurement_are_not_opened(tmp_path: Path) -> None:
    for name, head in (("a.mat", b"\x80\x05\x95"), ("b.mf4", b"PK\x03\x04"), ("c.parquet", b"\x93NUMPY\x01")):
        (tmp_path / name).write_bytes(head + bytes(200))
        assert "but this is no " in tried(tmp_path / name)
    (tmp_path / "d.parquet").write_bytes((sound(tmp_path, ".uff")).read_bytes())
    assert "the name ends in .parquet, but this is no Parquet file; found UFF 58; name it .uff" in tried(
        tmp_path / "d.parquet"
    )
