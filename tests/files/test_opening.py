"""Paths that are no model file, and references that lead out of the model's folder."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from torsional.errors import ModelError
from torsional.files import opening
from torsional.files.reader import MODEL_BYTES, read_tree, resolve_reference

TRUCK = "torsional: 1\n"


class TestFiles:
    """Paths that are no model file."""

    def refused(self, path: object) -> str:
        with pytest.raises(ModelError) as caught:
            read_tree(path)  # type: ignore[arg-type]
        assert caught.value.file
        assert str(caught.value).isprintable()
        return str(caught.value)

    def test_missing_file_suggests_its_neighbour(self, tmp_path: Path) -> None:
        (tmp_path / "truck13.yaml").write_text(TRUCK, encoding="utf-8")
        assert "there is no such file; did you mean 'truck13.yaml'?" in self.refused(tmp_path / "truck31.yaml")

    def test_missing_folder(self, tmp_path: Path) -> None:
        assert "there is no such folder; found" in self.refused(tmp_path / "no" / "truck.yaml")

    def test_folder(self, tmp_path: Path) -> None:
        assert "this is a folder, not a file; name the file in it" in self.refused(tmp_path)

    def test_part_of_the_path_is_a_file(self, tmp_path: Path) -> None:
        (tmp_path / "a").write_text("", encoding="utf-8")
        assert "a part of the path is a file" in self.refused(tmp_path / "a" / "b.yaml")

    @pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
    def test_pipe_does_not_hang(self, tmp_path: Path) -> None:
        os.mkfifo(tmp_path / "pipe.yaml")
        assert "this is not a regular file; pipes, devices" in self.refused(tmp_path / "pipe.yaml")

    @pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no devices here")
    def test_endless_device(self) -> None:
        assert "this is not a regular file" in self.refused("/dev/zero")

    @pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
    def test_pipe_put_in_place_after_the_check(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        os.mkfifo(tmp_path / "pipe.yaml")
        monkeypatch.setattr(opening, "_refuse_irregular", lambda path: None)
        assert "this is not a regular file" in self.refused(tmp_path / "pipe.yaml")

    def test_no_permission(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        path = tmp_path / "truck.yaml"
        path.write_text(TRUCK, encoding="utf-8")

        def denied(*_: object) -> int:
            raise PermissionError(errno.EACCES, "Permission denied")

        monkeypatch.setattr(opening.os, "open", denied)
        assert "truck.yaml: the file may not be read; ask for permission" in self.refused(path)

    def test_failing_disk(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        path = tmp_path / "truck.yaml"
        path.write_text(TRUCK, encoding="utf-8")

        def failing(*_: object) -> int:
            raise OSError(errno.EIO, "Input/output error")

        monkeypatch.setattr(opening.os, "open", failing)
        assert "the file cannot be read (Input/output error)" in self.refused(path)

    def test_loop_of_links(self, tmp_path: Path) -> None:
        (tmp_path / "a.yaml").symlink_to(tmp_path / "a.yaml")
        assert "the path is a loop of links" in self.refused(tmp_path / "a.yaml")

    @pytest.mark.parametrize(
        "name", ["x" * 5000, "a\0b", "\udcff.yaml", "a\n\x1b[31m.yaml", "", 3, None, b"a.yaml", 1.5]
    )
    def test_impossible_names(self, name: object) -> None:
        self.refused(name)

    def test_too_large(self, tmp_path: Path) -> None:
        path = tmp_path / "truck.yaml"
        path.write_bytes(b"#" * (MODEL_BYTES + 1))
        assert "the file is too large; allowed: at most 256 000 bytes" in self.refused(path)

    def test_every_refusal_names_the_file(self, tmp_path: Path) -> None:
        path = tmp_path / "truck.yaml"
        path.write_text("a: 1\na: 2\n", encoding="utf-8")
        assert self.refused(path).startswith(f"{path}: a (line 2): the key stands twice")


class TestReferences:
    """Files that a model file refers to stay inside its folder."""

    @pytest.fixture
    def model(self, tmp_path: Path) -> Path:
        folder = tmp_path / "models"
        (folder / "data").mkdir(parents=True)
        (folder / "load.csv").write_text("1", encoding="utf-8")
        (folder / "data" / "trace.csv").write_text("1", encoding="utf-8")
        (tmp_path / "secret.csv").write_text("1", encoding="utf-8")
        return folder / "truck.yaml"

    @pytest.mark.parametrize("reference", ["load.csv", "data/trace.csv", "./data//trace.csv"])
    def test_inside(self, model: Path, reference: str) -> None:
        found = resolve_reference(model, reference)
        assert found == (model.parent / reference).resolve()

    @pytest.mark.parametrize(
        ("reference", "sentence"),
        [
            ("../secret.csv", "'..' is not followed; found '../secret.csv'; put the file beside the model file"),
            ("data/../../secret.csv", "'..' is not followed"),
            ("..\\secret.csv", "'..' is not followed"),
            ("/etc/passwd", "an absolute path or a drive is not followed"),
            ("\\\\host\\share\\x.csv", "an absolute path or a drive is not followed"),
            ("C:x.csv", "an absolute path or a drive is not followed"),
            ("data\\trace.csv", "folders are separated by '/'"),
            ("~/x.csv", "there is no such folder"),
            ("laod.csv", "there is no such file; did you mean 'load.csv'?"),
            ("data", "this is a folder, not a file"),
            (".", "this is a folder, not a file"),
            ("", "a file name is wanted; found ''"),
            ("a\0b", "a file name is wanted"),
            ("x" * 5000, "the file name is too long"),
            (3, "a file name is wanted; found 3"),
            (None, "a file name is wanted; found None"),
        ],
    )
    def test_refused(self, model: Path, reference: object, sentence: str) -> None:
        with pytest.raises(ModelError) as caught:
            resolve_reference(model, reference, where="engine.full_load")  # type: ignore[arg-type]
        assert sentence in str(caught.value)
        assert caught.value.where == "engine.full_load"

    @pytest.mark.parametrize("target", ["secret.csv", "/etc/passwd"])
    def test_links_out_of_the_folder(self, model: Path, target: str) -> None:
        (model.parent / "link.csv").symlink_to(model.parent.parent / target)
        with pytest.raises(ModelError, match="the file is a link out of the model's folder"):
            resolve_reference(model, "link.csv")

    def test_linked_folder(self, model: Path) -> None:
        (model.parent / "up").symlink_to(model.parent.parent)
        with pytest.raises(ModelError, match="the file is a link out of the model's folder"):
            resolve_reference(model, "up/secret.csv")

    def test_link_inside(self, model: Path) -> None:
        (model.parent / "link.csv").symlink_to("data/trace.csv")
        assert resolve_reference(model, "link.csv").name == "trace.csv"

    def test_loop(self, model: Path) -> None:
        (model.parent / "loop.csv").symlink_to("loop.csv")
        with pytest.raises(ModelError, match="the path is a loop of links"):
            resolve_reference(model, "loop.csv")

    def test_too_large(self, model: Path) -> None:
        with (model.parent / "big.csv").open("wb") as file:
            file.truncate(opening.TABLE_BYTES + 1)
        with pytest.raises(ModelError, match=r"big.csv: the file is too large; allowed: at most 20 MB"):
            resolve_reference(model, "big.csv")
