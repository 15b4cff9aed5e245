"""Output files appear whole or not at all."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from torsional.cli.outputs import checked, text_writer, written
from torsional.errors import ModelError


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("failure", [KeyboardInterrupt(), ValueError("no")])
def test_a_failure_on_the_way_leaves_the_old_files(tmp_path: Path, failure: BaseException) -> None:
    first, second = tmp_path / "a.csv", tmp_path / "b.csv"
    second.write_text("old", encoding="utf-8")

    def fail(path: Path) -> None:
        path.write_text("half", encoding="utf-8")
        path.with_name("more").write_text("half", encoding="utf-8")
        raise failure

    with pytest.raises(type(failure)):
        written({first: text_writer("new"), second: fail})
    assert names(tmp_path) == ["b.csv"]
    assert second.read_text(encoding="utf-8") == "old"


def test_a_stop_between_the_making_of_the_draft_folder_and_its_use_leaves_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make = os.mkdir

    def stopped(path: str, *words: object, **more: object) -> None:
        make(path, *words, **more)  # type: ignore[arg-type]
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "mkdir", stopped)
    with pytest.raises(KeyboardInterrupt):
        written({tmp_path / "a.csv": text_writer("new")})
    assert names(tmp_path) == []


def test_a_full_disk_is_told_with_the_file(tmp_path: Path) -> None:
    def fail(path: Path) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(ModelError, match=r"a\.csv: the file cannot be written; found No space left on device"):
        written({tmp_path / "a.csv": fail})
    assert names(tmp_path) == []


def test_files_are_replaced_with_their_permissions(tmp_path: Path) -> None:
    target = tmp_path / "a.csv"
    target.write_text("old", encoding="utf-8")
    target.chmod(0o640)
    written({target: text_writer("new\n")})
    assert target.read_bytes() == b"new\n"
    if os.name != "nt":
        assert stat.S_IMODE(target.stat().st_mode) == 0o640
    assert names(tmp_path) == ["a.csv"]


@pytest.mark.skipif(os.name == "nt", reason="links need a right there")
def test_a_link_stays_and_its_target_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "kept").mkdir()
    target, link = tmp_path / "kept" / "a.csv", tmp_path / "latest.csv"
    target.write_text("old", encoding="utf-8")
    link.symlink_to(target)
    written({link: text_writer("new")})
    assert link.is_symlink()
    assert target.read_text(encoding="utf-8") == "new"


def test_suffixes_are_read_whatever_their_case(tmp_path: Path) -> None:
    path = tmp_path / "A.CSV"
    assert checked([path], (".csv",)) == [path]


def test_a_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out.nc").mkdir()
    with pytest.raises(ModelError, match="this is a folder"):
        checked([tmp_path / "out.nc"], (".nc",))
