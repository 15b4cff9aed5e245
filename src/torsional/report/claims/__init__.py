"""The report on the thesis's claims: what each says, what was found, how far the verdict can be trusted."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from torsional.errors import ModelError

if TYPE_CHECKING:
    from torsional.model import Model
    from torsional.studies.asking import Asked

__all__ = ["write_claims"]


def write_claims(asked: Asked, truck: Model, path: str | Path) -> Path:
    """Write one self-contained HTML page to ``path`` about claims asked of a ``truck`` with each of the absorbers.

    Raises ModelError for a path that is no .html file.
    """
    from torsional.report.claims.sections import sections
    from torsional.report.page import html_page

    target = Path(path)
    if target.suffix.lower() not in (".html", ".htm"):
        raise ModelError(
            "a report is an HTML page", where="path", found=repr(str(target)), allowed="a name ending in .html"
        )
    lead = f"What a thesis says of absorbers in heavy-duty truck powertrains, judged on: {truck.name}"
    target.write_text(
        html_page("Claims of the thesis", truck.name, lead, sections(asked), [(truck.name, truck.hash)]),
        encoding="utf-8",
    )
    return target
