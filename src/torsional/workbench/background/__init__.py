"""What takes long: branches of periodic motion, the region of half orders, runs in time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from torsional.files.faults import translated
from torsional.files.reader import Tree
from torsional.workbench.background.asking import Found, Long, Progress
from torsional.workbench.background.branches import Branches
from torsional.workbench.background.region import Region
from torsional.workbench.background.scenario import ScenarioRun
from torsional.workbench.designs import design_of, model_of
from torsional.workbench.frames import encoded

KINDS: Mapping[str, type[Long]] = {"branches": Branches, "region": Region, "scenario": ScenarioRun}


def worked(design: Mapping[str, Any], kind: str, settings: Mapping[str, Any], progress: Progress) -> dict[str, bytes]:
    """What a job gives: its frame, and the same as files by their endings; ModelError for what cannot be asked."""
    try:
        asked = KINDS[kind].model_validate(dict(settings))
    except ValidationError as error:
        raise translated(error, Tree({})).located(prefix="settings") from None
    found = asked.found(model_of(design_of(design)), progress)
    return {"frame": encoded(found.content), **_files(found, progress)}


def _files(found: Found, progress: Progress) -> dict[str, bytes]:
    """Pictures and a table, drawn where the whole result is at hand."""
    from torsional.plots import save_png, save_svg
    from torsional.spreadsheet import BYTE_ORDER_MARK, csv_text

    progress(0, 0, "drawing")
    figure = found.picture()
    table = BYTE_ORDER_MARK + csv_text(found.table)
    return {"png": save_png(figure), "svg": save_svg(figure), "csv": table.encode()}
