"""Compiled code on disk goes once any source has changed, and stays while none has."""

from __future__ import annotations

from pathlib import Path

from torsional.numerics.outdated import discard_outdated


def kept(package: Path) -> list[str]:
    return sorted(file.name for file in package.rglob("*.nb[ic]"))


def test_code_is_thrown_away_with_any_source_it_may_come_from(tmp_path: Path) -> None:
    for folder in ("numerics/stepping", "laws"):  # at any depth
        (tmp_path / folder / "__pycache__").mkdir(parents=True)
        (tmp_path / folder / "callee.py").write_text("one")

    def compiled() -> None:
        for folder in ("numerics/stepping", "laws"):
            (tmp_path / folder / "__pycache__" / "caller.f-1.py311.nbi").write_text("old")
            (tmp_path / folder / "__pycache__" / "caller.f-1.py311.1.nbc").write_text("old")

    folders = ("numerics", "laws")
    compiled()
    assert discard_outdated(tmp_path, folders) == 4 and kept(tmp_path) == []  # nothing says what it was made from
    compiled()
    assert discard_outdated(tmp_path, folders) == 0 and len(kept(tmp_path)) == 4
    (tmp_path / "laws" / "callee.py").write_text("two")
    assert discard_outdated(tmp_path, folders) == 4 and kept(tmp_path) == []
    compiled()
    (tmp_path / "laws" / "new.py").write_text("")
    assert discard_outdated(tmp_path, folders) == 4


def test_a_folder_that_cannot_be_written_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "numerics").mkdir()
    (tmp_path / "numerics" / "__pycache__").write_text("no folder")
    assert discard_outdated(tmp_path, ("numerics",)) == 0
