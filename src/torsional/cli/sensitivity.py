"""`torsional sensitivity`: which parameters of a sweep move its figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli.answers import Answer, deliver
from torsional.cli.failures import complain
from torsional.cli.jobs import RESULTS
from torsional.cli.outputs import checked
from torsional.cli.sweep import asked_of, chosen_workers, tell_failures, worked_through
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.studies.sweeps.blocks import BLOCKS
from torsional.studies.sweeps.plan import Plan
from torsional.studies.sweeps.sensitivity import sensitivities

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADS = {
    "saltelli": {
        "total": "total",
        "total_confidence": "±",
        "first_order": "by itself",
        "first_order_confidence": "±",
    },
    "morris": {
        "effect_size": "size of effects (mu*)",
        "effect_size_confidence": "±",
        "effect": "mean (mu)",
        "effect_spread": "spread (sigma)",
    },
}


def run(
    plan: Path,
    figure: Sequence[str] | None,
    folder: Path | None,
    resume: bool,
    processes: int,
    cluster: str,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    outputs = checked(output, RESULTS, [plan])
    workers = chosen_workers(processes, cluster)
    asked, at, found = worked_through(plan, folder, resume, workers, quiet or as_json, _fitting)
    data = sensitivities(found.whole(), figure or None)
    if not quiet:
        _tell_dropped(data)
    told, request = asked_of(asked, at, found, outputs, as_json, quiet)
    deliver(Answer("sensitivity", tables_of(data), told, data, picture=lambda: _picture(data)), request)
    tell_failures(found)


def _fitting(plan: Plan) -> None:
    method = plan.work.designs.method
    if method not in BLOCKS:
        remedy = "write designs: {method: morris, count: 20} to screen, or {method: saltelli, count: 256}"
        problem = "sensitivities need designs of their own"
        raise ModelError(problem, where="designs.method", found=method, allowed=", ".join(BLOCKS), remedy=remedy)


def _tell_dropped(data: xr.Dataset) -> None:
    for name, complete in zip(data.figure.values, data.blocks.values, strict=True):
        if complete < data.attrs["blocks"]:
            words, lost = data.attrs["blocks_words"], data.attrs["blocks"] - complete
            told = f"{lost} of {data.attrs['blocks']} {words} have a design without an answer and are left out"
            complain(f"{name}: {told}; the indices are those of where the others lie", kind="warning")


def tables_of(data: xr.Dataset) -> list[Table]:
    """A table for each figure, the parameters that move it most first."""
    heads = HEADS[data.attrs["method"]]
    made = []
    for number in range(data.sizes["figure"]):
        here = data.isel(figure=number)
        here = here.isel(parameter=np.argsort(-here[data.attrs["importance"]].fillna(-1.0).values, kind="stable"))
        quantity = "ratio" if data.attrs["method"] == "saltelli" else str(here.quantity.item()) or "number"
        columns = [Column("parameter"), *(Column(head, quantity) for head in heads.values())]
        rows = zip(here.parameter.values.tolist(), *(here[name].values.tolist() for name in heads), strict=True)
        words = f"{here.figure.item()}" + (f", {here.reduction.item()}" if here.reduction.item() else "")
        count = f"{int(here.blocks)} of {data.attrs['blocks']} {data.attrs['blocks_words']}"
        made.append(Table(f"{words}: {count}", columns, [list(row) for row in rows]))
    return made


def _picture(data: xr.Dataset) -> Figure:
    from torsional.plots import plot_sensitivities

    return plot_sensitivities(data)
