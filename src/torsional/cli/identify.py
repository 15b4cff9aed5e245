"""`torsional identify`: parameters of a model found from what was measured, with how sure they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli.answers import Answer, deliver
from torsional.cli.jobs import RESULTS
from torsional.cli.outputs import checked
from torsional.cli.progress import counting
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.numerics.compiling import WATCH
from torsional.studies.identification.plan import load_identification
from torsional.studies.identification.result import identify
from torsional.units import show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (*RESULTS, ".html")


def run(plan: Path, as_json: bool, output: Sequence[Path] | None, quiet: bool) -> None:
    """Answer the command."""
    outputs = checked(output, SUFFIXES, [plan])
    task = load_identification(plan)
    silent = quiet or as_json
    with WATCH.silent(silent), counting(task.name, "models", silent) as moved:
        found = identify(task, moved)
    model = task.candidates[0].base
    told = {
        "model": {"name": model.name, "hash": model.hash},
        "settings": {"plan": str(plan), "starts": task.starts, "seed": task.seed, "confidence": task.level},
    }
    answer = Answer(
        "identify",
        tables_of(found),
        told,
        found,
        picture=lambda: _picture(found),
        sentences=found.attrs["findings"].split("\n"),
        page=lambda draft: _page(found, model.name, model.hash, draft),
    )
    deliver(answer, Request(model, plan, (), outputs, as_json, quiet))


def tables_of(found: xr.Dataset) -> list[Table]:
    """Parameters, models where several are compared, and points."""
    level = f"{100 * found.attrs['level']:g} %"
    columns = [Column("parameter"), Column("begun at"), Column("found"), Column(f"{level} from"), Column("to")]
    rows: list[list[object]] = []
    for place, name in enumerate(found.parameter.values):
        kind = str(found.kind.values[place])
        figures = (found[of].values[place] for of in ("begun", "estimate", "interval_low", "interval_high"))
        rows.append([str(name), *(show(float(v), kind) if np.isfinite(v) else "-" for v in figures)])
    made = [Table("Parameters", columns, rows)]
    if found.sizes["model"] > 1:
        made.append(_models(found))
    return [*made, _points(found)]


def _models(found: xr.Dataset) -> Table:
    names = {"parameters": "parameters", "misfit": "misfit", "held_misfit": "held back", "aicc": "AICc", "bic": "BIC"}
    columns = [Column("model"), *(Column(words, "number") for words in names.values())]
    least = {name: float(found[name].min()) for name in ("aicc", "bic")}
    rows = [
        [str(model), *(float(found[name].values[place]) - least.get(name, 0.0) for name in names)]
        for place, model in enumerate(found.model.values)
    ]
    return Table("Models (AICc and BIC above the least)", columns, rows)


def _points(found: xr.Dataset) -> Table:
    columns = [Column("point"), Column(""), *(Column(str(name), "number") for name in found.model.values)]
    rows = [
        [str(name), "held back" if held else "fitted", *found.point_misfit.values[:, place].tolist()]
        for place, (name, held) in enumerate(zip(found.point.values, found.held.values, strict=True))
    ]
    return Table("Residuals over the noise (RMS)", columns, rows)


def _picture(found: xr.Dataset) -> Figure:
    from torsional.plots.fit import plot_fits

    return plot_fits(found)


def _page(found: xr.Dataset, name: str, hash: str, draft: Path) -> None:
    from torsional.report.identification import write_identification

    write_identification(found, (name, hash), draft)
