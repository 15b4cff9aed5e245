"""The tools that measure the package itself."""

from __future__ import annotations

import ast
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType

import pytest

from tests.test_project import ROOT, loaded

SOURCE = b'''"""Two numbers."""
LIMIT = 2

def least(a: int, b: float = 1.5) -> float:
    """The lesser, 3 at most."""
    if a < b and a != 0:
        raise ValueError("below 7")
    total = -a * b
    total += min(a, LIMIT)
    return total
'''


@pytest.fixture
def tools(monkeypatch: pytest.MonkeyPatch) -> dict[str, ModuleType]:
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    return {name: loaded(ROOT / "tools" / f"{name}.py") for name in ("mutants", "reach", "private", "structure")}


def package(folder: Path, **modules: str) -> Path:
    """A small package below a folder."""
    (folder / "torsional").mkdir()
    for name, text in {"__init__": "", **modules}.items():
        (folder / "torsional" / f"{name}.py").write_text(text, encoding="utf-8")
    return folder


def test_mutants_change_one_place_and_leave_texts_alone(tools: dict[str, ModuleType]) -> None:
    found = tools["mutants"].mutants("small.py", SOURCE)
    for mutant in found:
        changed = mutant.applied(SOURCE).decode()
        assert tools["mutants"].is_change(mutant, SOURCE), mutant
        assert ast.get_docstring(ast.parse(changed)) == "Two numbers." and "3 at most" in changed
        assert "below 7" in changed or mutant.kind == "statement"
    told = {(m.place, m.line, m.kind, m.old, m.new) for m in found}
    assert ("LIMIT", 2, "constant", "2", "3") in told
    assert ("least", 4, "constant", "1.5", "(2.0 * 1.5)") in told
    assert ("least", 6, "condition", "and", "or") in told
    assert ("least", 6, "boundary", "<", "<=") in told and ("least", 6, "comparison", "<", ">") in told
    assert ("least", 7, "statement", 'raise ValueError("below 7")', "pass") in told
    assert ("least", 8, "sign", "-a", "(a)") in told and ("least", 8, "arithmetic", "*", "/") in told
    assert ("least", 9, "arguments", "a, LIMIT", "LIMIT, a") in told
    assert not [m for m in found if m.old in ("int", "float", "7", "3")]


def test_draws_are_repeatable_and_take_each_line_once(tools: dict[str, ModuleType]) -> None:
    one, again, other = (tools["mutants"].drawn([("small.py", SOURCE)], 4, seed) for seed in (1, 1, 2))
    assert one == again != other
    assert len({m.line for m in one}) == 4


COMPILED = """from numba import njit
from torsional.b import deep, CONSTANT

@njit
def inner(x): return deep(x) + CONSTANT

@njit
def apart(x): return x

def shown(x): return inner(x)
"""


def test_compiled_functions_are_reached_through_names(tools: dict[str, ModuleType], tmp_path: Path) -> None:
    deeper = "from numba import njit\nCONSTANT = 3\n\n@njit\ndef deep(x): return x\n\ndef seen(): return 1\n"
    names = tools["reach"].Names(package(tmp_path, a=COMPILED, b=deeper))
    reached = names.reached(["torsional/a.py:10"])
    assert {name for _, name in reached} == {"shown", "inner", "deep", "CONSTANT"}
    assert names.importers("torsional/b.py") == {"torsional/a.py", "torsional/b.py"}


def test_functions_that_run_in_threads_are_recorded(tools: dict[str, ModuleType], tmp_path: Path) -> None:
    before = threading.getprofile()
    recorder = tools["reach"].Recorder(tmp_path / "reach.jsonl", ROOT)
    for _ in recorder.watched(None):
        with ThreadPoolExecutor(1) as pool:
            pool.submit(package, tmp_path).result()
    if recorder.ran:  # empty where another profiler is at work
        assert f"tests/test_tools.py:{package.__code__.co_firstlineno}" in recorder.ran
    assert threading.getprofile() is before


def test_machine_code_of_whatever_imports_a_change_is_dropped(tools: dict[str, ModuleType], tmp_path: Path) -> None:
    private = tools["private"]
    (tmp_path / "job" / "tree").mkdir(parents=True)
    copy = private.Copy(tmp_path / "job")
    folder = copy.kept / private._kept_name(copy.sources / "torsional" / "laws")
    folder.mkdir(parents=True)
    for name in ("hinges.f-3.py311.nbi", "hinges.f-3.py311.1.nbc", "hinges_more.f-3.py311.nbi"):
        (folder / name).write_bytes(b"code")
    cache = copy.without({"torsional/laws/hinges.py", "torsional/system.py"})
    assert [file.name for file in cache.rglob("*.nb?")] == ["hinges_more.f-3.py311.nbi"]


def test_structure_counts_circles_and_places_of_laws(tools: dict[str, ModuleType], tmp_path: Path) -> None:
    here = package(tmp_path, a="import torsional\nfrom torsional.b import x\ny = 1\n", b="from torsional.a import y\n")
    (here / "torsional" / "laws").mkdir()
    law = "def f(u):\n    raised = exp(-u * u)\n    return raised\n"
    (here / "torsional" / "laws" / "one.py").write_text(law, encoding="utf-8")
    found = tools["structure"].figures(here)
    assert found["import circles"] == [["torsional/a.py", "torsional/b.py"]]
    assert (found["modules"], found["functions"], found["median function body"]) == (4, 1, 2)
    assert found["public names"] == {"of torsional": 0, "of its packages": 0, "of all modules": 2, "with methods": 2}
    assert found["places of laws"]["Stribeck's curve"] == ["torsional/laws/one.py:1 f"]


def test_the_package_has_no_import_circles(tools: dict[str, ModuleType]) -> None:
    assert tools["structure"].circles(tools["reach"].Names(ROOT / "src")) == []
