"""What the page is told first: the design to begin with, units, and what can be chosen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from torsional import __version__
from torsional.errors import ModelError
from torsional.files.load import files_named, load_model
from torsional.files.opening import TABLE_BYTES, read_text
from torsional.files.reader import MODEL_BYTES, parse_tree, resolve_reference
from torsional.files.scenario_schema import KINDS
from torsional.files.starter import KINDS as STARTERS
from torsional.files.starter import starter
from torsional.model import Model
from torsional.units import QUANTITIES, convert
from torsional.workbench.absorbers import choices
from torsional.workbench.guard import BODY

FIRST = "truck"
"""The shipped model that is shown where none is named."""


def design_from(path: Path) -> tuple[dict[str, Any], Model]:
    """A model file as a design, with the files it names, and its model; ModelError for what is no model."""
    model = load_model(path)
    text = read_text(path, MODEL_BYTES)
    named = files_named(parse_tree(text, file=str(path)).data)
    files = {name: read_text(resolve_reference(path, name), TABLE_BYTES) for name in named}
    design = {"text": text, "files": files, "changes": {}}
    if sum(map(len, (text, *files.values()))) > BODY / 2:
        found = f"{sum(map(len, files.values()))} letters"
        remedy = "a curve wants some hundred lines"
        raise ModelError("the files that the model names are too large", file=str(path), found=found, remedy=remedy)
    return design, model


def example(kind: str) -> dict[str, Any]:
    """A shipped model as a design."""
    return {"text": starter(kind), "files": {}, "changes": {}}


def examples() -> dict[str, Any]:
    """The answers about shipped models, by name."""
    return {kind: {"design": example(kind), "name": f"{kind}.yaml"} for kind in STARTERS}


def start(design: Mapping[str, Any], name: str, model: Model, fronts: Sequence[str]) -> dict[str, Any]:
    """The answer to a page that begins.

    >>> from torsional.files.load import model_from_tree
    >>> told = start(example("truck"), "truck.yaml", model_from_tree(parse_tree(starter("truck"))), [])
    >>> told["units"]["speed"]["unit"], told["units"]["stiffness"]["factor"]
    ('rpm', 1000.0)
    """
    return {
        "version": __version__,
        "design": dict(design),
        "name": name,
        "units": units(),
        "fronts": [{"name": front} for front in fronts],
        "scenarios": [{"name": kind, "title": block.title} for kind, block in KINDS.items()],
        "absorbers": [{"type": kind, "label": title, "block": block} for kind, title, block in choices(model)],
        "limits": {"body": BODY},
        "examples": [{"name": kind, "title": title} for kind, title in STARTERS.items()],
    }


def units() -> dict[str, dict[str, Any]]:
    """How each quantity is shown: an SI value is ``factor`` times the shown one."""
    return {
        name: {
            "unit": entry.shown,
            "factor": 1.0 if entry.shown == entry.unit else convert(1.0, entry.shown, entry.unit),
            "label": entry.long_name,
            "symbol": entry.symbol,
        }
        for name, entry in QUANTITIES.items()
    }
