"""The report: one self-contained HTML page about a model, or about several side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Model

__all__ = ["write_report"]


@checked
def write_report(
    models: Model | Sequence[Model],
    path: str | Path,
    *,
    gears: Sequence[str | int] = (),
    speeds: int = 57,
    torques: int = 26,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Path:
    """Analyse ``models``, the first against the others, and write one HTML page to ``path``.

    ``gears``: those shown in maps and mode shapes (default: the gear with the largest vibration, and the last);
    ``speeds`` and ``torques``: points of the maps.  The page asks nothing of the network and needs no script; it
    appears whole or not at all.  ``progress(done, total)`` counts steps.  Raises ModelError for a path that is no .html
    file and as the analyses do.
    """
    from torsional.report.analysis import analysed
    from torsional.report.page import rendered

    target = Path(path)
    if target.suffix.lower() not in (".html", ".htm"):
        raise ModelError(
            "a report is an HTML page", where="path", found=repr(str(target)), allowed="a name ending in .html"
        )
    listed = [models] if isinstance(models, Model) else list(models)
    if not listed:
        raise ModelError("a report needs a model", where="models")
    comparison = analysed(listed, [str(gear) for gear in gears], speeds, torques, progress)
    page = rendered(comparison)
    partial = target.with_name(f".{target.name}.partial")
    partial.write_text(page, encoding="utf-8")
    partial.replace(target)
    progress(1, 1)
    return target
