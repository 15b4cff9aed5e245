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
ADDED = re.compile(r"^Added to `(src/[^`]+)`(?:(?!\n\n).)*:\n\n```python\n(.*?)^```$", re.M | re.S)
BEFORE = {"A command": "An analysis"}
"""What a recipe builds upon."""


def recipes() -> dict[str, str]:
    """The text of each recipe by its title."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## Recipes")[2].partition("\n## ")[0]
    titles = re.split(r"^### (.*)$", text, flags=re.M)[1:]
    return dict(zip(titles[::2], titles[1::2], strict=True))


@pytest.mark.full
@pytest.mark.parametrize("title", list(recipes()))
def test_recipe(title: str, tmp_path: Path) -> None:
    for part in ("src", "tests", "examples", "pyproject.toml", ".importlinter", "CONTRIBUTING.md"):
        place, copy = ROOT / part, tmp_path / part
        kept = shutil.ignore_patterns("__pycache__", "reference", "validation")
        shutil.copytree(place, copy, ignore=kept) if place.is_dir() else shutil.copy(place, copy)
    for earlier in (BEFORE.get(title), title):
        written, added = followed(tmp_path, recipes()[earlier]) if earlier else ([], [])
    assert 2 <= len(written) + len(added) <= 3
    sources = [name for name in (*written, *added) if name.startswith("src/") and name.endswith(".py")]
    if find_spec("ruff"):
        run(tmp_path, "-m", "ruff", "check", "--no-cache", *written, *added)
        run(tmp_path, "-m", "ruff", "format", "--check", "--no-cache", *written, *added)
    if find_spec("mypy"):
        run(tmp_path, "-m", "mypy", *sources)
    run(tmp_path, "-m", "pytest", "-q", *written)


def followed(folder: Path, recipe: str) -> tuple[list[str], list[str]]:
    """The files that a recipe writes, and those that it adds to."""
    listings, additions = dict(LISTING.findall(recipe)), dict(ADDED.findall(recipe))
    for name, text in listings.items():
        assert not (folder / name).exists()
        (folder / name).write_text(text, encoding="utf-8")
    for name, text in additions.items():
        gap = "\n\n" if name.endswith(".py") else ""
        (folder / name).write_text((folder / name).read_text(encoding="utf-8") + gap + text, encoding="utf-8")
        assert len((folder / name).read_text(encoding="utf-8").splitlines()) <= 300
    return list(listings), list(additions)


def run(folder: Path, *arguments: str) -> None:
    """A tool in the copy, which stands before the installed package."""
    ways = {**os.environ, "PYTHONPATH": str(folder / "src"), "NUMBA_CACHE_DIR": str(folder / "kept")}
    told = subprocess.run([sys.executable, *arguments], cwd=folder, env=ways, capture_output=True, text=True)
    assert told.returncode == 0, told.stdout + told.stderr
