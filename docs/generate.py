"""Pages written from the package itself: the nomenclature, and one reference page a module.

Run by ``conf.py`` at every build, so that neither can fall behind the code.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
import shutil
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

import faces

PACKAGE = "torsional"


def release() -> str:
    """The installed version."""
    return version(PACKAGE)


def write_all(folder: Path) -> None:
    """Write every generated page into ``folder``, which is emptied first."""
    from torsional.cli.app import command
    from torsional.files.schema.document import json_schema
    from torsional.results import NAMES
    from torsional.units import QUANTITIES

    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "nomenclature.md").write_text(nomenclature(QUANTITIES, NAMES), encoding="utf-8")
    (folder / "command_line.md").write_text(faces.command_line_page(command()), encoding="utf-8")
    (folder / "model_file.md").write_text(faces.model_file_page(json_schema()), encoding="utf-8")
    names = list(module_names(PACKAGE))
    for name in names:
        (folder / f"{name}.md").write_text(module_page(name), encoding="utf-8")
    (folder / "modules.md").write_text(modules_page(names), encoding="utf-8")


def nomenclature(quantities: Mapping[str, Any], names: Mapping[str, Any]) -> str:
    """A page: conventions, a table of the quantities' symbols, names and units, and one of the names in results."""
    rows = [
        f"| {q.symbol} | `{name}` | {q.long_name} | {q.unit} | {q.shown if q.shown != q.unit else ''} |"
        for name, q in quantities.items()
    ]
    columns = ["| symbol | name | meaning | unit | shown in |", "| --- | --- | --- | --- | --- |"]
    head = ["# Nomenclature", "", _CONVENTIONS, "", "## Quantities", "", _ABOUT_UNITS, "", *columns]
    known = {name: quantities.get(named.quantity) for name, named in names.items()}
    signs = {name: f"{q.symbol} | {q.unit}" if q else " | " for name, q in known.items()}
    told = [f"| `{name}` | {named.meaning} | {signs[name]} |" for name, named in names.items()]
    columns = ["| name | meaning | symbol | unit |", "| --- | --- | --- | --- |"]
    return "\n".join([*head, *rows, "", "## Names in results", "", _ABOUT_NAMES, "", *columns, *told, ""])


_CONVENTIONS = r"""What lies along `order` is complex and 0-peak, half of peak-to-peak and √2 times RMS: $x(\alpha) =
\mathrm{Re} \sum_n X_n e^{\mathrm i n \alpha}$, order 0 the mean. What ends in `_swing` is half the peak-to-peak of
all orders together, phases kept, what ends in `_bound` the sum of their amplitudes; the irregularity alone is
peak-to-peak. What lies along `time` or `crank_angle` is as it is at that instant.

Orders count cycles per crankshaft revolution. The crank angle α is zero at the firing top dead centre of cylinder 1.
Angles of nodes are deviations from the mean rotation; a twist is $\varphi = \theta_b - \theta_a$, and a connection's
torque is positive with it. In the shipped groups `b` is the engine's side: both are positive while the engine
drives."""

_ABOUT_UNITS = """Every value inside is in SI units and radians; faces (command line, pictures, reports) show some in
another unit. The table is `torsional.nomenclature`, which reads the units in model files and labels results and
pictures."""

_ABOUT_NAMES = """Variables and coordinates of the Datasets that analyses return (`torsional.results.NAMES`); a name
means the same in all of them. `torque` is always a connection's, `mean_torque` the engine's mean. Without a unit:
names, counts, and what is of several quantities."""


def module_names(package: str) -> Iterator[str]:
    """Names of the public modules of a package, itself first, from the top of the alphabet down."""
    yield package
    found = importlib.import_module(package)
    for info in sorted(pkgutil.walk_packages(found.__path__, f"{package}."), key=lambda info: info.name):
        if not any(part.startswith("_") for part in info.name.split(".")):
            yield info.name


def module_page(name: str) -> str:
    """A page that has autodoc write out one module, with the names it offers from elsewhere listed by their homes."""
    offered = "\n".join(f"* {{py:obj}}`{shown} <{home}>`" for shown, home in reexported(importlib.import_module(name)))
    body = f"```{{eval-rst}}\n.. automodule:: {name}\n   :members:\n   :ignore-module-all:\n```\n"
    return f"# `{name}`\n\n{body}" + (f"\nOffered from here:\n\n{offered}\n" if offered else "")


def reexported(module: ModuleType) -> Iterator[tuple[str, str]]:
    """Public names of a module that were defined in another one of the package, with their full names there."""
    for name in getattr(module, "__all__", ()):
        thing = getattr(module, name, None)
        home = str(getattr(thing, "__module__", ""))
        if home.startswith(PACKAGE) and home != module.__name__ and hasattr(thing, "__qualname__"):
            yield name, f"{home}.{thing.__qualname__}"


def modules_page(names: Iterable[str]) -> str:
    """The table of contents of the reference."""
    listed = "\n".join(names)
    return f"# Modules\n\n```{{toctree}}\n:maxdepth: 1\n\n{listed}\n```\n"


# --- docstrings: plain text to reStructuredText ---


def process_docstring(_app: Any, _what: str, _name: str, _obj: Any, _options: Any, lines: list[str]) -> None:
    """Autodoc's hook: replace the lines of a docstring in place."""
    lines[:] = [*restructured("\n".join(lines)).splitlines(), ""]


def restructured(text: str) -> str:
    """Plain docstring text as reStructuredText.

    Indented blocks become literal, doctests and lists stay, and nothing but backticks is markup, so that |H_ij| or
    2*x_ in a formula is no mistake.
    """
    blocks = re.split(r"\n\s*\n", textwrap.dedent(text.expandtabs()).strip("\n"))
    return "\n\n".join(filter(None, map(_block, _joined(blocks))))


def _joined(blocks: Iterable[str]) -> list[str]:
    """Neighbouring indented blocks as one."""
    joined: list[str] = []
    for block in blocks:
        if joined and block.startswith(" ") and joined[-1].startswith(" "):
            joined[-1] += "\n\n" + block
        else:
            joined.append(block)
    return joined


def _block(block: str) -> str:
    first, *rest = block.split("\n")
    if first.startswith(">>>"):
        return block
    if first.startswith(" "):
        return "::\n\n" + textwrap.indent(textwrap.dedent(block), "    ")
    if re.match(r"([-*•]|\d+[.)]) ", first):
        return "\n".join(_items(block))
    if any(line.startswith(" ") for line in rest):
        return "\n".join("| " + _escaped(line.strip()) for line in block.split("\n"))
    return _escaped(block.removesuffix("::") + (":" if block.endswith("::") else ""))


def _items(block: str) -> Iterator[str]:
    """A list's items, each with its continuation lines on one line."""
    for item in re.split(r"\n(?=(?:[-*•]|\d+[.)]) )", block):
        marker, said = re.sub(r"\s*\n\s*", " ", item).split(" ", 1)
        yield f"{'*' if marker in '-*•' else marker} {_escaped(said)}"


def _escaped(text: str) -> str:
    """Escape what would be markup outside of backticks; single backticks become code as well."""
    parts = re.split(r"(``.+?``|`[^`]+`)", text, flags=re.DOTALL)
    return "".join(_code(part) if i % 2 else re.sub(r"([\\*|_`])", r"\\\1", part) for i, part in enumerate(parts))


def _code(quoted: str) -> str:
    return "``" + quoted.strip("`").replace("\n", " ") + "``"
