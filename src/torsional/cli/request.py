"""What every analysis is asked: of which model, and where the answer goes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from torsional.cli.outputs import checked
from torsional.files import changed, load_model
from torsional.model import Model


@dataclass(frozen=True, eq=False)
class Wanted:
    """Where an answer goes: ``outputs`` that may be written, and what is printed."""

    outputs: Sequence[Path]
    as_json: bool
    quiet: bool


@dataclass(frozen=True, eq=False)
class Request:
    """The ``model`` read from ``path`` with its ``changes``; ``outputs`` that may be written; what is printed."""

    model: Model
    path: Path
    changes: Sequence[str]
    outputs: Sequence[Path]
    as_json: bool
    quiet: bool


def requested(
    model: Path,
    changes: Sequence[str] | None,
    output: Sequence[Path] | None,
    as_json: bool,
    quiet: bool,
    suffixes: Sequence[str],
) -> Request:
    """Read the model and refuse outputs that cannot be; ModelError for either."""
    outputs = checked(output, suffixes, [model])
    read = opened(model, changes)
    checked(outputs, suffixes, files_of(model, read.document))
    return Request(read, model, changes or (), outputs, as_json, quiet)


def opened(path: Path, changes: Sequence[str] | None = None) -> Model:
    """The model of a file, with the changes of ``--set``."""
    model = load_model(path)
    return changed(model, *changes) if changes else model


def files_of(path: Path, document: object = None) -> list[Path]:
    """The model file, and the files beside it that it names: none of them may be written over."""
    return [path, *(path.parent / name for name in _names(document))]


def _names(value: object) -> Iterator[str]:
    if isinstance(value, dict | list):
        for item in value.values() if isinstance(value, dict) else value:
            yield from _names(item)
    elif isinstance(value, str) and 0 < len(value) < 200 and "\n" not in value:
        yield value
