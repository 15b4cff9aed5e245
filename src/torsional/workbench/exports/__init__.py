"""What the page shows as files: pictures and tables of its own figures, and the report."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from torsional.model import Model
from torsional.workbench.designs import design_of, model_of
from torsional.workbench.exports.seen import Seen
from torsional.workbench.views import ask_of

Variants = Sequence[tuple[str, dict[str, Any]]]


def exported(variants: Variants, asked: dict[str, Any], kind: str, dark: bool) -> bytes:
    """A view as "png", "svg" or "csv", of one design or of several by their names.

    The figures are those that the page was answered.  Raises ModelError as the view does, and for a view that has no
    picture.
    """
    ask = ask_of(asked)
    seen = [Seen(name, model, ask.answer(model)) for name, model in _models(variants)]
    if kind == "csv":
        from torsional.spreadsheet import BYTE_ORDER_MARK, csv_text
        from torsional.workbench.exports.tables import table

        return (BYTE_ORDER_MARK + csv_text(table(ask.view, seen))).encode()
    from torsional.plots import save_png, save_svg
    from torsional.workbench.exports.pictures import picture
    from torsional.workbench.exports.shades import darkened

    figure = picture(ask.view, seen)
    figure = darkened(figure) if dark else figure
    return save_png(figure, 150.0) if kind == "png" else save_svg(figure)


def reported(variants: Variants) -> bytes:
    """The page of `torsional report` about designs, the first against the others."""
    from torsional.report import write_report

    with tempfile.TemporaryDirectory() as folder:
        path = write_report([model for _, model in _models(variants)], Path(folder) / "report.html")
        return path.read_bytes()


def _models(variants: Variants) -> list[tuple[str, Model]]:
    return [(name, model_of(design_of(design))) for name, design in variants]
