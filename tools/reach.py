"""Which tests reach which functions: recorded while the tests run, and followed into compiled code by its names.

As a pytest plugin (``-p reach``, with ``REACH_FILE`` in the environment) it records the package's Python functions
that each test ran.  Compiled code shows nothing of what it runs, and much of it (laws by address, code for vectors)
does not run without the compiler, so what the compiled functions call is read from the source: a function reaches
every compiled function, class body and module constant that it names, and what those name in turn.  That is more than
what is run, never less, but for two things that are not seen: what a test starts in another process, and what an
earlier test left in a cache.
"""

from __future__ import annotations

import ast
import cProfile
import json
import os
import threading
import time
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

COMPILING = ("njit", "uncounted", "inlined", "inner", "merged", "register_jitable", "intrinsic", "py_func", "_step")
"""Words of decorators whose functions Python's own profiler does not see."""

Place = tuple[str, str]
"""A module as its file below the sources, and the dotted name of a function, class or constant there."""


# --- pytest plugin ---


class Recorder:
    """Writes a line of JSON for each test that passed: its id, its seconds, the functions it ran as file:line."""

    def __init__(self, file: Path, sources: Path) -> None:
        self.file, self.sources = file, str(sources)
        self.ran: set[str] = set()
        self.seconds, self.passed = 0.0, True

    def watched(self, call: Any) -> Iterator[None]:
        """One phase of a test under the profiler."""
        profiles = [cProfile.Profile(subcalls=False, builtins=False)]

        def in_thread(*_: Any) -> None:
            profiles.append(cProfile.Profile(subcalls=False, builtins=False))
            profiles[-1].enable()  # in this thread, in place of what called it

        began = time.perf_counter()
        try:
            profiles[0].enable()
        except ValueError:  # another profiler is at work
            yield
            return
        threading.setprofile(in_thread)
        yield
        threading.setprofile(None)  # type: ignore[arg-type]
        profiles[0].disable()
        self.seconds += time.perf_counter() - began
        stats = (entry for profile in profiles for entry in profile.getstats())
        codes = (entry.code for entry in stats if not isinstance(entry.code, str))
        inside = ((os.path.relpath(c.co_filename, self.sources), c.co_firstlineno) for c in codes)
        self.ran |= {f"{name}:{line}" for name, line in inside if not name.startswith("..") and name.endswith(".py")}

    def write(self, test: str) -> None:
        """The line of one test; then everything is forgotten."""
        if self.passed:
            told = {"test": test, "seconds": round(self.seconds, 3), "ran": sorted(self.ran)}
            with self.file.open("a", encoding="utf-8") as out:
                out.write(json.dumps(told) + "\n")
        self.ran, self.seconds, self.passed = set(), 0.0, True


def pytest_configure(config: Any) -> None:
    """Registers the recorder where a file is named."""
    name = os.environ.get("REACH_FILE")
    if not name:
        return
    recorder = Recorder(Path(name), Path(os.environ["REACH_SOURCES"]).resolve())
    config.pluginmanager.register(_Hooks(recorder), "reach-recorder")


class _Hooks:
    def __init__(self, recorder: Recorder) -> None:
        import pytest

        self.recorder = recorder
        wrapper = pytest.hookimpl(hookwrapper=True)
        for name in ("pytest_runtest_setup", "pytest_runtest_call", "pytest_runtest_teardown"):
            setattr(self, name, wrapper(self._phase()))

    def _phase(self) -> Any:
        def phase(item: Any) -> Iterator[None]:
            yield from self.recorder.watched(item)

        return phase

    def pytest_runtest_logreport(self, report: Any) -> None:
        self.recorder.passed &= report.passed

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        self.recorder.write(nodeid)


# --- names ---


MAKES_MACHINE_CODE = ("llvmlite", "intrinsic", "piston_position", "lane_program")
"""Words of files whose plain functions end up in compiled ones."""
OF_PYTHON = ("checked", "checked_fields", "dataclass", "lru_cache", "functools.cache", "cache")
"""Decorators of functions that Python runs itself."""


class Names:
    """What the functions, classes and constants of a package name, by reading its sources below ``sources``."""

    def __init__(self, sources: Path) -> None:
        self.sources = sources
        self.trees = {
            str(path.relative_to(sources)): ast.parse(path.read_text(encoding="utf-8"))
            for path in sorted(sources.rglob("*.py"))
        }

    @cached_property
    def nodes(self) -> dict[Place, tuple[ast.AST, bool]]:
        """Every place with its syntax, and whether Python's own profiler sees it run."""
        return {place: (node, seen) for file, tree in self.trees.items() for place, node, seen in _places(file, tree)}

    @cached_property
    def at_line(self) -> dict[str, Place]:
        """Places of functions by file:line, the line of the first decorator as in a code object."""
        found = {}
        for place, (node, _) in self.nodes.items():
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                line = min([node.lineno, *(d.lineno for d in node.decorator_list)])
                found[f"{place[0]}:{line}"] = place
        return found

    @cached_property
    def _scopes(self) -> dict[str, dict[str, Place]]:
        """The place that each name of a module means."""
        scopes: dict[str, dict[str, Place]] = {file: {} for file in self.trees}
        for file, name in self.nodes:
            if "." not in name:
                scopes[file][name] = (file, name)
        for file, tree in self.trees.items():
            for node in ast.walk(tree):
                if isinstance(node, ast.ImportFrom) and node.module:
                    source = self.file_of(node.module)
                    for alias in node.names:
                        scopes[file].setdefault(alias.asname or alias.name, (source, alias.name))
        return scopes

    def file_of(self, module: str) -> str:
        """The file of a dotted module name."""
        base = module.replace(".", "/")
        return f"{base}/__init__.py" if f"{base}/__init__.py" in self.trees else f"{base}.py"

    def compiled(self, place: Place) -> bool:
        """Whether machine code of other files may hang on a place: not on Python's own functions and methods."""
        source = (self.sources / place[0]).read_text(encoding="utf-8")
        node, _ = self.nodes.get((place[0], place[1].partition(".")[0]), (None, False))
        if node is None or any(word in source for word in MAKES_MACHINE_CODE):
            return True
        if isinstance(node, ast.FunctionDef):
            return any(ast.unparse(each).partition("(")[0] not in OF_PYTHON for each in node.decorator_list)
        return not isinstance(node, ast.ClassDef)

    def resolved(self, place: Place) -> Place | None:
        """A place behind the modules that only pass its name on; None outside the package."""
        for _ in range(5):
            if place in self.nodes:
                return place
            following = self._scopes.get(place[0], {}).get(place[1])
            if following is None or following == place:
                return None
            place = following
        return None

    @cached_property
    def edges(self) -> dict[Place, set[Place]]:
        """The places not seen by a profiler that each place names."""
        return {place: self._named(place) for place in self.nodes}

    def _named(self, place: Place) -> set[Place]:
        node, _ = self.nodes[place]
        scope, found = self._scopes[place[0]], set()
        for part in _own(node):
            name = part.id if isinstance(part, ast.Name) else part.attr if isinstance(part, ast.Attribute) else None
            target = self.resolved(scope[name]) if name in scope else None
            if target is not None and target != place and not self.nodes[target][1]:
                found.add(target)
        owner = place[1].rpartition(".")[0]
        if owner and (place[0], owner) in self.nodes:  # a method reaches what stands in the body of its class
            found.add((place[0], owner))
        return found

    def reached(self, ran: Iterable[str]) -> set[Place]:
        """All that functions given as file:line reach."""
        found = {self.at_line[key] for key in ran if key in self.at_line}
        waiting = list(found)
        while waiting:
            new = self.edges[waiting.pop()] - found
            found |= new
            waiting += new
        return found

    def importers(self, file: str) -> set[str]:
        """Files that import a file, directly or through others, and itself: whose compiled code may hold some of it."""
        found, waiting = {file}, [file]
        while waiting:
            new = {other for other, used in self._imports.items() if waiting[-1] in used} - found
            waiting.pop()
            found |= new
            waiting += new
        return found

    @cached_property
    def _imports(self) -> dict[str, set[str]]:
        out: dict[str, set[str]] = {}
        for file, tree in self.trees.items():
            out[file] = set()
            for node in ast.walk(tree):
                if isinstance(node, ast.ImportFrom) and node.module:
                    out[file].add(self.file_of(node.module))
                    out[file] |= {self.file_of(f"{node.module}.{alias.name}") for alias in node.names}
                elif isinstance(node, ast.Import):
                    out[file] |= {self.file_of(alias.name) for alias in node.names}
        return out


def _places(file: str, tree: ast.Module) -> Iterator[tuple[Place, ast.AST, bool]]:
    """Functions, classes and module constants; whether a profiler sees them."""

    def below(node: ast.AST, prefix: str) -> Iterator[tuple[Place, ast.AST, bool]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
                seen = not any(word in ast.unparse(d) for d in child.decorator_list for word in COMPILING)
                yield (file, prefix + child.name), child, seen
            elif isinstance(child, ast.ClassDef):
                yield (file, prefix + child.name), child, False
                yield from below(child, f"{prefix}{child.name}.")
            elif isinstance(child, ast.If | ast.Try | ast.With):
                yield from below(child, prefix)

    yield from below(tree, "")
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        for target in targets:
            if isinstance(target, ast.Name):
                yield (file, target.id), node, False


def _own(node: ast.AST) -> Iterator[ast.AST]:
    """What a place itself names: of a class all but its methods."""
    if not isinstance(node, ast.ClassDef):
        yield from ast.walk(node)
        return
    for child in [*node.bases, *node.decorator_list, *node.body]:
        if not isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef):
            yield from ast.walk(child)
