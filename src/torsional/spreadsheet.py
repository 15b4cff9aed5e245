"""Results as tables for spreadsheets: SI values under headings that tell their units, every digit kept."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from torsional.errors import ModelError
from torsional.tables import heading
from torsional.units import RPM

if TYPE_CHECKING:
    import xarray as xr

PLACES = ("node", "element", "mass")
"""Dimensions that become columns of a table; all others run down its rows."""

BYTE_ORDER_MARK = "\ufeff"
"""In front of a text in UTF-8, without which spreadsheets read units such as rad/s² as something else."""

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def csv_text(data: xr.Dataset) -> str:
    """A Dataset as CSV: a row for each place in the grid, a column for each variable and node or element.

    A table has one grid: variables over fewer dimensions than the first one are repeated along the others, and those
    over other dimensions are left out.  Further coordinates along the rows are told as well.  Complex values take two
    columns.  Raises ModelError for a Dataset without variables.
    """
    if not data.data_vars:
        raise ModelError("there is no variable to make a table of", where=str(data.attrs.get("analysis", "result")))
    rows = tuple(str(dim) for dim in next(iter(data.data_vars.values())).dims if dim not in PLACES)
    columns = [*_coordinates(data, rows), *_variables(data, rows)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(neutral(heading) for heading, _ in columns)
    writer.writerows(map(neutral, row) for row in zip(*(values for _, values in columns), strict=True))
    return text.getvalue()


def neutral(cell: object) -> object:
    """A cell that no spreadsheet takes for a formula: a text that begins like one gets an apostrophe.

    >>> neutral("=1+1"), neutral(-1.5)
    ("'=1+1", -1.5)
    """
    if isinstance(cell, str) and cell.lstrip().startswith(_FORMULA):
        return "'" + cell
    return "" if isinstance(cell, float) and math.isnan(cell) else cell


def _coordinates(data: xr.Dataset, rows: Sequence[str]) -> Iterator[tuple[str, list[object]]]:
    grid = _grid(data, rows)
    for dim in rows:
        values = data[dim].broadcast_like(grid).transpose(*rows)
        yield _heading(dim, values), values.values.ravel().tolist()
        yield from _in_rpm(dim, values)
    for name, further in data.coords.items():
        if str(name) not in data.dims and further.dims and set(further.dims) <= set(rows):
            values = further.broadcast_like(grid).transpose(*rows)
            yield _heading(str(name), values), values.values.ravel().tolist()
            yield from _in_rpm(str(name), values)


def _in_rpm(name: str, values: xr.DataArray) -> Iterator[tuple[str, list[object]]]:
    """A second column for speeds."""
    if values.attrs.get("quantity") == "speed":
        yield f"{name} [rpm]", (values.values.ravel() / RPM).tolist()


def _grid(data: xr.Dataset, rows: Sequence[str]) -> xr.DataArray:
    """A variable over all rows that values are spread to."""
    first = next(iter(data.data_vars.values()))
    return first.isel({dim: 0 for dim in first.dims if dim in PLACES}, drop=True).transpose(*rows)


def _variables(data: xr.Dataset, rows: Sequence[str]) -> Iterator[tuple[str, list[object]]]:
    grid = _grid(data, rows)
    for name, values in data.data_vars.items():
        across = [dim for dim in values.dims if dim in PLACES]
        if len(across) > 1 or not set(values.dims) - set(across) <= set(rows):
            continue
        places = values[across[0]].values.tolist() if across else [None]
        for index, place in enumerate(places):
            column = values.isel({across[0]: index}, drop=True) if across else values
            spread = column.broadcast_like(grid).transpose(*rows)
            label = str(name) if place is None else f"{name} {place}"
            yield from _columns(label, spread)


def _columns(label: str, values: xr.DataArray) -> Iterator[tuple[str, list[object]]]:
    flat = values.values.ravel()
    if flat.dtype.kind == "c":
        yield _heading(f"{label} real", values), flat.real.tolist()
        yield _heading(f"{label} imaginary", values), flat.imag.tolist()
    else:
        yield _heading(label, values), flat.tolist()


def _heading(label: str, values: xr.DataArray) -> str:
    return heading(label, values.attrs.get("units", "-"))
