"""`torsional report`: one page about a model, or about several side by side."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import json_text
from torsional.cli.outputs import checked, written
from torsional.cli.progress import progress
from torsional.cli.request import files_of, opened
from torsional.numerics.compiling import WATCH
from torsional.report import write_report


def run(
    model: Path, compare: Sequence[Path] | None, changes: Sequence[str] | None, as_json: bool, output: Path, quiet: bool
) -> None:
    """Answer the command: the changes are made in the first model alone."""
    paths = [model, *(compare or ())]
    checked([output], (".html",), paths)
    models = [opened(path, changes if i == 0 else None) for i, path in enumerate(paths)]
    checked(
        [output],
        (".html",),
        [f for path, each in zip(paths, models, strict=True) for f in files_of(path, each.document)],
    )
    with WATCH.silent(quiet or as_json), progress("analyses and pictures", quiet or as_json) as moved:
        written({output: lambda draft: write_report(models, draft, progress=moved)})
    if as_json:
        told = [
            {"name": each.name, "file": str(path), "hash": each.hash} for path, each in zip(paths, models, strict=True)
        ]
        print_json(json_text({"torsional": __version__, "command": "report", "models": told, "written": str(output)}))
    elif not quiet:
        print(f"written: {output}", file=sys.stderr)
