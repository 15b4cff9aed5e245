"""`torsional import`: a table or an assembly of another tool as a model file."""

from __future__ import annotations

from pathlib import Path

from torsional.cli.outputs import checked
from torsional.cli.starting import delivered
from torsional.errors import ModelError
from torsional.exchange.documents import yaml_of
from torsional.exchange.inertia_table import read_inertia_table
from torsional.exchange.opentorsion_assembly import read_tors

READERS = {".csv": read_inertia_table, ".json": read_tors}


def run(table: Path, output: Path | None, force: bool) -> None:
    """Answer the command."""
    reader = READERS.get(table.suffix.lower())
    if reader is None:
        found, allowed = repr(table.suffix), ", ".join(READERS)
        raise ModelError(
            "the ending says what is read, and this is not known", file=str(table), found=found, allowed=allowed
        )
    outputs = checked([output] if output else None, (".yaml", ".yml"), [table])
    delivered(yaml_of(reader(table)), outputs, force)
