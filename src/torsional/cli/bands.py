"""`torsional bands`: where the figures of a sweep lie for most of its designs, beside those of the unchanged model."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from torsional.cli.answers import Answer, deliver
from torsional.cli.failures import complain
from torsional.cli.jobs import RESULTS
from torsional.cli.outputs import checked
from torsional.cli.sweep import asked_of, chosen_workers, tell_failures, worked_through
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.model import Model
from torsional.studies.sweeps.bands import NOMINAL, bands
from torsional.studies.sweeps.plan import Plan
from torsional.studies.sweeps.work import Answer as Answered

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_ROWS = 24
"""More are for files."""


def run(
    plan: Path,
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
    asked, at, found = worked_through(plan, folder, resume, workers, quiet or as_json)
    told, request = asked_of(asked, at, found, outputs, as_json, quiet)
    data = bands(found.whole(), _nominal(asked, request.model))
    deliver(Answer("bands", tables_of(data), told, data, picture=lambda: _picture(data)), request)
    tell_failures(found)


def _nominal(plan: Plan, model: Model) -> Answered | None:
    """The answer of the unchanged model; None, with a warning, where it has none."""
    try:
        return plan.work.run(model)
    except ModelError as error:
        complain(f"the unchanged model has no answer, and bands stand alone: {error}", kind="warning")
        return None


def tables_of(data: xr.Dataset) -> list[Table]:
    """For every figure the percentiles and the unchanged model's, of curves where each is highest."""
    return [_table(data, str(name)) for name in data.data_vars if not str(name).endswith(NOMINAL)]


def _table(data: xr.Dataset, name: str) -> Table:
    values, along = data[name], data[name].attrs["along"]
    columns = {f"{p:g} %": values.sel(percentile=p, drop=True) for p in data.percentile.values}
    if f"{name}{NOMINAL}" in data:
        columns["nominal"] = data[f"{name}{NOMINAL}"]
    if along:
        columns = {head: column.max(along) for head, column in columns.items()}
    dims = [str(dim) for dim in values.dims if dim not in ("percentile", along)]
    told = xr.Dataset(columns).stack(row=dims) if dims else xr.Dataset(columns).expand_dims("row")
    quantity = str(values.attrs.get("quantity", "number"))
    labels = [told[dim].values.tolist() for dim in dims]
    rows = zip(*labels, *(told[head].values.tolist() for head in columns), strict=True)
    heads = [*(Column(dim, str(data[dim].attrs.get("quantity", ""))) for dim in dims)]
    title = f"{name}, each curve at its highest over {along}" if along else name
    listed = [list(row) for row in rows]
    return Table(title, [*heads, *(Column(head, quantity) for head in columns)], listed[:MOST_ROWS])


def _picture(data: xr.Dataset) -> Figure:
    from torsional.plots import plot_bands

    return plot_bands(data)
