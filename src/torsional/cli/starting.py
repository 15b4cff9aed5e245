"""`torsional new` and `torsional schema`: what a first model file begins with."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from torsional.cli.outputs import checked, refuse_overwriting, text_writer, written


def run(what: str, output: Sequence[Path] | None, kind: str = "", force: bool = False) -> None:
    """Answer the command."""
    text, suffixes = _schema() if what == "schema" else _starter(kind)
    delivered(text, checked(output, suffixes), force or what != "new")


def delivered(text: str, outputs: Sequence[Path], force: bool) -> None:
    """Print a text, or write it to files, which are replaced by ``force`` only."""
    if not force:
        refuse_overwriting(outputs)
    if not outputs:
        print(text, end="")
    written({path: text_writer(text) for path in outputs})


def _schema() -> tuple[str, Sequence[str]]:
    from torsional.files import json_schema

    return json.dumps(json_schema(), indent=1, ensure_ascii=False) + "\n", (".json",)


def _starter(kind: str) -> tuple[str, Sequence[str]]:
    from torsional.files import starter

    return starter(kind), (".yaml", ".yml")
