"""Starting: what help costs, and that pages and help know every command and option."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from torsional.cli.app import command
from torsional.files.starter import KINDS

Run = Callable[..., Any]
PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "command-line.md"


def commands() -> dict[str, Any]:
    """Every command as it is typed, members of groups as well; those of `study` are imported for its list alone."""
    found: dict[str, Any] = {}
    for name, each in command().commands.items():
        members = {f"{name} {member}": inner for member, inner in getattr(each, "commands", {}).items()}
        found |= members if members and name != "study" else {name: each}
    return found


COMMANDS = sorted(commands())
BARE = [name for name in COMMANDS if name != "study"]
"""Commands with options of their own."""
HEAVY = {"numpy", "numba", "scipy", "xarray", "pandas", "matplotlib", "pydantic", "rich", "jinja2", "ruamel"}


def options(name: str) -> list[str]:
    """Every long and short spelling a command takes."""
    return [spelling for p in commands()[name].params if p.param_type_name == "option" for spelling in p.opts]


@pytest.mark.parametrize(
    "arguments", [[], ["--help"], ["--version"], *([*name.split(), "--help"] for name in BARE)], ids=" ".join
)
def test_help_imports_nothing_heavy(process: Run, arguments: list[str]) -> None:
    told = process(
        *arguments, code="import sys; from torsional.cli import main; main(); print(*sys.modules, file=sys.stderr)"
    )
    assert told.out
    assert HEAVY & {name.split(".")[0] for name in told.err.split()} == set()


@pytest.mark.parametrize("name", BARE)
def test_help_lists_every_option(torsional: Run, name: str) -> None:
    told = torsional(*name.split(), "--help")
    assert told.code == 0
    assert options(name)
    assert [option for option in options(name) if not re.search(rf"(?<![\w-]){option}(?![\w-])", told.out)] == []
    assert torsional(*name.split(), "-h").out == told.out


def test_no_option_is_left_without_a_word() -> None:
    bare = [(name, p.name) for name in COMMANDS for p in commands()[name].params if not p.help]
    assert bare == []


def test_help_of_new_names_every_kind(torsional: Run) -> None:
    assert [kind for kind in KINDS if kind not in torsional("new", "--help").out] == []


@pytest.mark.parametrize("name", COMMANDS)
def test_the_page_knows_every_command_and_option(name: str) -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert f"`torsional {name}`" in page
    missing = [
        o for o in options(name) if o not in ("--help", "-h") and not re.search(rf"`[^`]*(?<![\w-]){o}(?![\w-])", page)
    ]
    assert missing == []


def test_the_page_knows_no_other_option() -> None:
    text = PAGE.read_text(encoding="utf-8")
    known = {o for name in COMMANDS for o in options(name)} | {
        "--version",
        "--install-completion",
        "--show-completion",
        "--help",
    }
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text)) <= known


def test_completion_offers_the_commands(process: Run) -> None:
    told = process(_TORSIONAL_COMPLETE="complete_bash", COMP_WORDS="torsional m", COMP_CWORD="1")
    assert told.code == 0
    assert told.out.split() == ["modes", "map", "measurement"]
