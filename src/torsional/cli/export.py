"""`torsional export`: the matrices of a model about a mean torque, for other tools."""

from __future__ import annotations

import sys
from pathlib import Path

from torsional.cli import inputs
from torsional.cli.answers import print_json, told_settings
from torsional.cli.documents import amount, json_text
from torsional.cli.outputs import Writer, text_writer, written
from torsional.cli.request import Request
from torsional.exchange.matrices import MEANING, UNITS, Matrices, csv_of, matrices, write_matrices


def run(request: Request, gear: str, torque: str, speed: str) -> None:
    """Answer the command."""
    model = request.model
    engaged, at = inputs.one_gear(model, gear), inputs.speed(model, speed)
    mean = inputs.torque(model, torque, [at] if speed else [])
    found = matrices(model, torque=mean, gear=engaged, speed=at)
    settings = {"gear": engaged, "torque": amount(mean, "torque"), "speed": amount(at, "speed")}
    text = json_text({"command": "export", **told_settings(request, **settings), **_document(found)})
    written({path: _writer(found, path, text) for path in request.outputs})
    if request.as_json:
        print_json(text)
    elif not (request.quiet or request.outputs):
        print(csv_of(found), end="")
    if not request.quiet:
        for path in request.outputs:
            print(f"written: {path}", file=sys.stderr)


def _writer(found: Matrices, path: Path, text: str) -> Writer:
    return text_writer(text) if path.suffix.lower() == ".json" else lambda draft: write_matrices(found, draft)


def _document(found: Matrices) -> dict[str, object]:
    """The matrices as rows of numbers, with what they mean."""
    values = {name: {"values": getattr(found, name).tolist(), "units": unit} for name, unit in UNITS.items()}
    return {"meaning": MEANING, "coordinates": list(found.coordinates), "nodes": list(found.nodes), "matrices": values}
