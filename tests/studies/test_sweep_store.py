"""Designs by number, and pieces on disk that are whole or not there."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from torsional.errors import ModelError
from torsional.studies.sweeps import store as storing
from torsional.studies.sweeps.designs import Axis, Designs, grid, sampled, table
from torsional.studies.sweeps.store import Store, TornError, packed, plan_in, unpacked

PLAN = {"over": {"clutch.stiffness": [1e4, 2e4]}, "seed": 3}
ENDS = {"a": (1.0, 3.0), "b": Axis(low=1.0, high=100.0, log=True), "c": Axis(("x", "y", "z"))}


@pytest.mark.parametrize(
    "designs",
    [
        grid({"a": [1, 2, 3], "b": ["soft", "stiff"], "c": [0.5, 0.25, 0.125, 0.0625]}),
        sampled("latin_hypercube", ENDS, 24, seed=7),
        sampled("sobol", ENDS, 24, seed=7),
        table({"a": list(range(24)), "b": [str(n) for n in range(24)]}),
    ],
    ids=lambda each: each.method,
)
def test_any_stretch_holds_the_same_designs(designs: Designs) -> None:
    """However a sweep is cut, a number is one design."""
    whole = designs.rows(0, 24)
    assert len(whole) == len(designs) == 24
    assert [row for start in (0, 5, 10, 15, 20) for row in designs.rows(start, min(start + 5, 24))] == whole
    assert len({tuple(row.values()) for row in whole}) == 24


def test_a_hypercube_has_one_design_in_every_slice() -> None:
    columns = sampled("latin_hypercube", ENDS, 12, seed=1).columns(0, 12)
    assert sorted(((columns["a"] - 1.0) * 6).astype(int)) == list(range(12))
    assert sorted((np.log10(columns["b"]) * 6).astype(int)) == list(range(12))
    assert sorted(columns["c"]) == ["x"] * 4 + ["y"] * 4 + ["z"] * 4


def test_sobol_points_fill_better_than_chance() -> None:
    """The mean of a product over 1024 points is off by less than a tenth of what chance leaves, sqrt(7/144/1024)."""
    columns = sampled("sobol", {"a": (0.0, 1.0), "b": (0.0, 1.0)}, 1024).columns(0, 1024)
    assert abs(float((columns["a"] * columns["b"]).mean()) - 0.25) < 0.1 * np.sqrt(7 / 144 / 1024)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: grid({"a": []}), "a: a parameter has no values"),
        (lambda: grid({}), "needs a parameter to vary"),
        (lambda: sampled("sobol", {"a": (2.0, 1.0)}, 4), "a: the ends of a parameter must rise; found 2 to 1"),
        (lambda: sampled("sobol", {"a": (1.0, float("nan"))}, 4), "needs levels, or two ends"),
        (lambda: sampled("chance", {"a": (1.0, 2.0)}, 4), "no such way to choose designs; found chance"),
        (lambda: sampled("sobol", {"a": (1.0, 2.0)}, 0), "number of designs is out of range; found 0"),
        (lambda: table({"a": [1, 2], "b": [1]}), "differ in length; found a 2, b 1"),
        (lambda: Axis(low=0.0, high=1.0, log=True), "both ends must be positive"),
        (lambda: Designs({"a": Axis(low=0.0, high=1.0)}, 3, "grid"), "a: a grid needs levels"),
    ],
)
def test_bad_designs_are_refused(make: object, told: str) -> None:
    with pytest.raises(ModelError, match=told):
        make()  # type: ignore[operator]


ARRAYS = {"amplitude": np.array([[1.5, -0.0], [np.inf, 3e-310]]), "status": np.array([0, 3], np.int8)}


def test_a_chunk_comes_back_to_the_last_bit() -> None:
    found = unpacked(packed(ARRAYS))
    assert {name: values.tobytes() for name, values in found.items()} == {k: v.tobytes() for k, v in ARRAYS.items()}
    assert {name: (values.dtype, values.shape) for name, values in found.items()} == {
        name: (values.dtype, values.shape) for name, values in ARRAYS.items()
    }
    assert packed(dict(reversed(ARRAYS.items()))) == packed(ARRAYS)


@given(st.integers(0, len(packed(ARRAYS)) * 8 - 1))
def test_any_turned_bit_is_seen(bit: int) -> None:
    data = bytearray(packed(ARRAYS))
    data[bit // 8] ^= 1 << bit % 8
    with pytest.raises(TornError):
        unpacked(bytes(data))


@given(st.integers(0, len(packed(ARRAYS)) - 1))
def test_any_cut_is_seen(length: int) -> None:
    with pytest.raises(TornError):
        unpacked(packed(ARRAYS)[:length])


def test_torn_chunks_are_asked_again(tmp_path: Path) -> None:
    store = Store.begun(tmp_path / "sweep", PLAN, "code")
    for number in range(4):
        store.put(number, ARRAYS)
    whole = store.path(1).read_bytes()
    store.path(1).write_bytes(whole[:-3])
    store.path(2).unlink()
    again = Store.begun(tmp_path / "sweep", PLAN, "code")
    assert again.missing(5) == [1, 2, 4]
    assert again.get(0) is not None and again.get(1) is None
    other = Store.begun(tmp_path / "sweep", PLAN, "other code")
    assert other.missing(4) == [0, 1, 2, 3] and again.missing(5) == [1, 2, 4]


def test_another_plan_is_refused(tmp_path: Path) -> None:
    Store.begun(tmp_path, PLAN, "code")
    assert plan_in(tmp_path) == PLAN and plan_in(tmp_path / "elsewhere") is None
    with pytest.raises(ModelError, match="holds the sweep of another plan; name another folder"):
        Store.begun(tmp_path, {**PLAN, "seed": 4}, "code")
    (tmp_path / "plan.json").write_text("{", encoding="utf-8")
    with pytest.raises(ModelError, match="cannot be read"):
        Store.begun(tmp_path, PLAN, "code")
    (tmp_path / "plan.json").write_text("[1]", encoding="utf-8")
    with pytest.raises(ModelError, match="is not one"):
        plan_in(tmp_path)


def test_a_full_disk_leaves_nothing_under_the_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither the chunk nor a draft; what was there before stays."""
    store = Store.begun(tmp_path, PLAN, "code")
    store.put(0, {"status": np.zeros(1)})

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(storing.os, "fsync", full)
    for number in (0, 1):
        with pytest.raises(OSError, match="No space left"):
            store.put(number, ARRAYS)
    monkeypatch.undo()
    assert [path.name for path in store.chunks.iterdir()] == [store.path(0).name]
    assert store.get(0) is not None and store.get(0)["status"].tolist() == [0.0]  # type: ignore[index]
