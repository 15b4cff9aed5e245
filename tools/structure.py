"""Figures of the package's structure: ``python tools/structure.py`` prints them, ``--json`` for a comparison.

Sizes count as the tests count them: the body of a function without its docstring.  A *place of a law* is a function
that works out the torque, rate or energy of a law by itself instead of calling the law's kernel; the shapes looked for
are told in `LAWS`, and what a shape misses is not counted, so a new way to write a law wants a new shape.
"""

from __future__ import annotations

import argparse
import ast
import json
import re
import statistics
import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from reach import Names

SOURCES = Path(__file__).resolve().parent.parent / "src"

LAWS: dict[str, tuple[str, ...]] = {
    "hinge or one-sided contact": (
        r"\bsides?(?:\[i\])? \* \(?\(?(?:angle|beyond|state\.connection\[0, [^-]*) (?:- |\+ hinges\.contact)",
        r"(?:facing\[i\]|side) \* beyond\b",
        r"gap \+ .*directions\.T",
        r"shift\[e\] \+= change",
    ),
    "polynomial": (r"torque \* angle \+ parameters",),
    "curve through points": (r"3\.0 \* rise - ",),
    "Coulomb, regularised": (r"limit \* \(rate / ", r"\bhypot\(rate, width\)"),
    "Jenkins: spring and slider": (r"abs\(deflection\) \* stiffness > limit", r"\* abs\(bent\) >= values"),
    "Stribeck's curve": (r"exp\(-u \* u\)", r"exp\(-\(+rate / ", r"exp\(-np\.square\(u / "),
    "LuGre: rate of the bristles": (r"\* abs\(rate\) / curve", r"s0 \* abs\("),
    "Karnopp: what is held": (r"beyond = abs\(rate\) / band", r"2\.0 - np\.abs\(u\) / self\.stick_rate"),
    "normal load": (r"load_centrifugal\[e\]", r"loads\.centrifugal\[e\]", r"loads\[LOAD_SQUARED"),
    "crank and piston": (r"s = \(across - offset\) / rod",),
}
"""Shapes, in functions below `FLOORS`, that only a law written out has."""
FLOORS = ("numerics", "laws", "solvers", "absorbers", "components", "engine", "stamps.py", "system.py")


def sizes(names: Names) -> dict[str, object]:
    """Modules, lines, function bodies, the largest module."""
    lines = {file: (names.sources / file).read_text(encoding="utf-8").count("\n") for file in names.trees}
    bodies = sorted(body for tree in names.trees.values() for body in _bodies(tree))
    largest = max(lines, key=lambda file: lines[file])
    return {
        "modules": len(lines),
        "lines": sum(lines.values()),
        "functions": len(bodies),
        "median function body": statistics.median(bodies),
        "95th percentile function body": bodies[int(0.95 * len(bodies))],
        "largest function body": bodies[-1],
        "largest module": f"{largest}: {lines[largest]}",
    }


def _bodies(tree: ast.Module) -> Iterator[int]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body[1:] if ast.get_docstring(node) is not None else node.body
            yield (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


def circles(names: Names) -> list[list[str]]:
    """Groups of modules that import each other when they are loaded, those of type checking left out."""
    uses = {file: {u for u in _at_load(names, tree) if u in names.trees} - {file} for file, tree in names.trees.items()}
    reach = {file: _following(uses, file) for file in uses}
    groups = {frozenset(other for other in found if file in reach[other]) for file, found in reach.items()}
    return sorted(sorted(group) for group in groups if group)


def _at_load(names: Names, tree: ast.Module) -> Iterator[str]:
    waiting: list[ast.AST] = list(tree.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:  # a module of the package, or a name in one
                module = names.file_of(f"{node.module}.{alias.name}")
                yield module if module in names.trees else names.file_of(node.module)
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            waiting += node.orelse
        elif not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            waiting += ast.iter_child_nodes(node)


def _following(uses: dict[str, set[str]], file: str) -> set[str]:
    found: set[str] = set()
    waiting = list(uses[file])
    while waiting:
        new = waiting.pop()
        if new not in found:
            found.add(new)
            waiting += uses[new]
    return found


def public_names(names: Names) -> dict[str, int]:
    """Names without an underscore: those of ``torsional`` itself, of its packages, of all modules, and with members."""
    stub = names.sources / "torsional" / "__init__.pyi"
    tree = ast.parse(stub.read_text(encoding="utf-8")) if stub.is_file() else ast.Module([], [])
    offered = sum(len(node.names) for node in tree.body if isinstance(node, ast.ImportFrom))
    listed = {
        name.value
        for file, tree in names.trees.items()
        if file.endswith("__init__.py")
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.List)
        if ast.unparse(node.targets[0]) == "__all__"
        for name in node.value.elts
        if isinstance(name, ast.Constant)
    }
    shown = [name for _, name in names.nodes if not any(part.startswith("_") for part in name.split("."))]
    single = [name for name in shown if "." not in name]
    counts = (offered, len(listed), len(single), len(shown))
    return dict(zip(("of torsional", "of its packages", "of all modules", "with methods"), counts, strict=True))


def law_places(names: Names) -> dict[str, list[str]]:
    """Functions that write a law out, by law."""
    found: dict[str, list[str]] = {law: [] for law in LAWS}
    for (file, name), (node, _) in names.nodes.items():
        below = file.removeprefix("torsional/")
        if not below.startswith(FLOORS) or not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        text = ast.unparse(ast.Module(node.body[1:] if ast.get_docstring(node) else node.body, []))
        head = f"def {node.name}\n"
        for law, shapes in LAWS.items():
            if any(re.search(shape, head + text) for shape in shapes):
                found[law].append(f"{file}:{node.lineno} {name}")
    return found


def figures(sources: Path = SOURCES) -> dict[str, object]:
    """Everything that is counted."""
    names = Names(sources)
    return {
        **sizes(names),
        "import circles": circles(names),
        "public names": public_names(names),
        "places of laws": law_places(names),
    }


def main() -> None:
    """Prints the figures."""
    parser = argparse.ArgumentParser(description="figures of the package's structure")
    parser.add_argument("--json", action="store_true", help="as JSON")
    parser.add_argument("--sources", type=Path, default=SOURCES, help="folder that holds the package")
    given = parser.parse_args()
    found = figures(given.sources)
    if given.json:
        print(json.dumps(found, indent=2, ensure_ascii=False))
        return
    for what, value in found.items():
        if isinstance(value, dict):
            print(f"{what}:")
            for key, part in value.items():
                print(f"  {key}: {len(part) if isinstance(part, list) else part}")
                for line in part if isinstance(part, list) else ():
                    print(f"      {line}")
        elif isinstance(value, list):
            print(f"{what}: {len(value)}", *(f"\n  {' '.join(group)}" for group in value), sep="")
        else:
            print(f"{what}: {value}")


if __name__ == "__main__":
    main()
