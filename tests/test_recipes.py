"""The recipes of CONTRIBUTING.md, followed to the letter in a copy of the project."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LISTING = re.compile(r"^`((?:src|tests)/[^`]+)`:\n\n```python\n(.*?)^```$", re.M | re.S)
LINE = re.compile(r"^```python\n(from \.[^\n]+)\n```$", re.M)


def recipes() -> dict[str, str]:
    """The text of each recipe by its title."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## Recipes")[2].partition("\n## ")[0]
    titles = re.split(r"^### (.*)$", text, flags=re.M)[1:]
    return dict(zip(titles[::2], titles[1::2], strict=True))


@pytest.mark.full
@pytest.mark.parametrize("title", ["A force law", "An absorber", "An analysis"])
def test_recipe(title: str, tmp_path: Path) -> None:
    for part in ("src", "tests", "examples", "pyproject.toml", ".importlinter", "CONTRIBUTING.md"):
        place, copy = ROOT / part, tmp_path / part
        kept = shutil.ignore_patterns("__pycache__", "reference", "validation")
        shutil.copytree(place, copy, ignore=kept) if place.is_dir() else shutil.copy(place, copy)
    listings = dict(LISTING.findall(recipes()[title]))
    stub = tmp_path / "src/torsional/__init__.pyi"
    lines = LINE.findall(recipes()[title])
    for name, text in listings.items():
        assert not (tmp_path / name).exists()
        (tmp_path / name).write_text(text, encoding="utf-8")
    stub.write_text(stub.read_text(encoding="utf-8") + "".join(f"{line}\n" for line in lines), encoding="utf-8")
    assert 2 <= len(listings) + bool(lines) <= 3
    if find_spec("ruff"):
        run(tmp_path, "-m", "ruff", "check", "--no-cache", *listings)
    run(tmp_path, "-m", "pytest", "-q", *listings)


def run(folder: Path, *arguments: str) -> None:
    """A tool in the copy, which stands before the installed package."""
    ways = {**os.environ, "PYTHONPATH": str(folder / "src"), "NUMBA_CACHE_DIR": str(folder / "kept")}
    told = subprocess.run([sys.executable, *arguments], cwd=folder, env=ways, capture_output=True, text=True)
    assert told.returncode == 0, told.stdout + told.stderr
