"""`torsional new` and `torsional schema`: what a first file begins with."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from torsional.cli.outputs import checked, refuse_overwriting, text_writer, written
from torsional.errors import ModelError, nearest

FILES = {
    "model": ("files.schema.document", "ModelFile"),
    "scenario": ("files.scenario_schema", "AnyScenario"),
    "mapping": ("measurements.mapping_file", "MappingFile"),
    "sweep": ("studies.sweeps.plan", "SweepFile"),
    "optimise": ("studies.optimise.plan", "OptimiseFile"),
    "identify": ("studies.identification.plan", "IdentifyFile"),
}
"""Kinds of files with the block, or the blocks, that read them."""


def run(what: str, output: Sequence[Path] | None, kind: str = "", force: bool = False) -> None:
    """Answer the command."""
    text, suffixes = _schema(kind) if what == "schema" else _starter(kind)
    delivered(text, checked(output, suffixes), force or what != "new")


def delivered(text: str, outputs: Sequence[Path], force: bool) -> None:
    """Print a text, or write it to files, which are replaced by ``force`` only."""
    if not force:
        refuse_overwriting(outputs)
    if not outputs:
        print(text, end="")
    written({path: text_writer(text) for path in outputs})


def _schema(kind: str) -> tuple[str, Sequence[str]]:
    from torsional.files.schema.published import schema_of

    if kind not in FILES:
        raise ModelError("there is no such kind of file", found=repr(kind), remedy=nearest(kind, FILES))
    module, name = FILES[kind]
    schema = schema_of(getattr(import_module(f"torsional.{module}"), name), f"torsional {kind} file")
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n", (".json",)


def _starter(kind: str) -> tuple[str, Sequence[str]]:
    from torsional.files import starter

    return starter(kind), (".yaml", ".yml")
