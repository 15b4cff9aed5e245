"""`torsional study NAME`: one of the engineers' studies on a truck."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.jobs import RESULTS
from torsional.cli.outputs import checked
from torsional.cli.progress import waiting
from torsional.cli.request import Request, files_of, opened
from torsional.cli.tables import Column, Table
from torsional.files import changed
from torsional.model import Model
from torsional.numerics.compiling import WATCH
from torsional.studies import register
from torsional.studies.trucks import Trucks

MOST_ROWS, MOST_COLUMNS = 24, 12
"""Longer curves are for files and pictures."""


def run(
    name: str,
    model: Path | None,
    given: Mapping[str, Any],
    changes: Sequence[str] | None,
    output: Sequence[Path] | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Answer the command."""
    asked, outputs = truck_of(model, changes, output, RESULTS)
    request = Request(asked, model or Path("the shipped truck"), changes or (), outputs, as_json, quiet)
    tool = register.tools()[name]
    with WATCH.silent(quiet or as_json), waiting(name, quiet or as_json):
        found = tool(trucks_of(asked), **given)
    sentences = [*found.attrs["findings"].split("\n"), f"Asked under: {found.attrs['condition']}."]
    told = told_settings(request, study=name, options=dict(given))
    deliver(
        Answer("study", tables_of(found), told, found, picture=lambda: tool.picture(found), sentences=sentences),
        request,
    )


def truck_of(
    path: Path | None, changes: Sequence[str] | None, output: Sequence[Path] | None, suffixes: Sequence[str]
) -> tuple[Model, list[Path]]:
    """The truck of a file, or the shipped one, with changes; the outputs, refused where they cannot be."""
    outputs = checked(output, suffixes, [path] if path else [])
    if path is None:
        shipped = Trucks.shipped().dmf
        return (changed(shipped, *changes) if changes else shipped), outputs
    read = opened(path, changes)
    checked(outputs, suffixes, files_of(path, read.document))
    return read, outputs


def trucks_of(truck: Model) -> Trucks:
    """The truck with each of the absorbers: the shipped ones where it is the shipped truck."""
    shipped = Trucks.shipped()
    return shipped if truck.hash == shipped.dmf.hash else Trucks.of(truck)


def tables_of(data: xr.Dataset) -> list[Table]:
    """What of a Dataset makes tables: values over one coordinate beside each other, those over two one by one."""
    over: dict[tuple[str, ...], list[str]] = {}
    for name in data.data_vars:
        over.setdefault(tuple(map(str, data[name].dims)), []).append(str(name))
    made = []
    for dims, names in over.items():
        rows = [data.sizes[dim] for dim in dims]
        if len(dims) == 1 and rows[0] <= MOST_ROWS:
            made.append(_side_by_side(data, dims[0], names))
        elif len(dims) == 2 and min(rows) <= MOST_COLUMNS and max(rows) <= MOST_ROWS:
            made += [_crossed(data[name]) for name in names]
    return made


def _side_by_side(data: xr.Dataset, dim: str, names: Sequence[str]) -> Table:
    columns = [_column(data[name]) for name in (dim, *names)]
    rows = zip(*(data[name].values.tolist() for name in (dim, *names)), strict=True)
    return Table(f"Over {_words(dim)}", columns, [list(row) for row in rows])


def _crossed(values: xr.DataArray) -> Table:
    """The longer dimension goes down."""
    down, across = sorted(map(str, values.dims), key=lambda dim: values.sizes[dim], reverse=True)
    turned, quantity = values.transpose(down, across), values.attrs.get("quantity", "")
    heads = [_column(values[across]).cell(each) for each in values[across].values.tolist()]
    columns = [_column(values[down]), *(Column(head, quantity) for head in heads)]
    rows = [[place, *row] for place, row in zip(values[down].values.tolist(), turned.values.tolist(), strict=True)]
    return Table(f"{_column(values).heading}, {_column(values[across]).heading} across", columns, rows)


def _column(values: xr.DataArray) -> Column:
    return Column(
        _words(str(values.name)), "" if values.dtype.kind in "OUSb" else values.attrs.get("quantity", "ratio")
    )


def _words(name: str) -> str:
    return name.replace("_", " ")
