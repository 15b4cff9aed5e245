"""Tables in CSV and Parquet: columns of time, each with its channels behind it, every digit kept."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.columns import Column, table_of
from torsional.measurements.formats import library
from torsional.measurements.parquet import KEYS, START
from torsional.spreadsheet import BYTE_ORDER_MARK, neutral


def write(data: xr.Dataset, path: Path) -> None:
    """Write a table, by the ending of its name."""
    columns = table_of(data)
    if path.suffix.lower() == ".csv":
        path.write_text(BYTE_ORDER_MARK + csv_text(columns), encoding="utf-8", newline="")
    else:
        _write_parquet(columns, path, str(data.attrs.get("start", "")))


def csv_text(columns: list[Column]) -> str:
    """The columns as CSV; names that a spreadsheet would take for formulas get an apostrophe.

    >>> import numpy as np
    >>> csv_text([Column("time", "s", np.array([0.0, 0.5])), Column("=n", "rpm", np.array([1.0, np.nan]))])
    "time [s],'=n [rpm]\\r\\n0.0,1.0\\r\\n0.5,\\r\\n"
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow([neutral(_heading(column)) for column in columns])
    writer.writerows(
        ["" if math.isnan(value) else value for value in row]
        for row in zip(*(_finite(column) for column in columns), strict=True)
    )
    return text.getvalue()


def _heading(column: Column) -> str:
    return f"{column.name} [{column.units}]" if column.units or column.name.endswith(("]", ")")) else column.name


def _finite(column: Column) -> list[float]:
    values: list[float] = column.values.tolist()
    if any(map(math.isinf, values)):
        raise ModelError("a text table holds no infinite values", where=repr(column.name), remedy="write .parquet")
    return values


def _write_parquet(columns: list[Column], path: Path, start: str) -> None:
    arrow, parquet = library("pyarrow", "Parquet"), library("pyarrow.parquet", "Parquet")
    names = [column.name for column in columns]
    fields = [arrow.field(column.name, arrow.float64(), metadata=_notes(column)) for column in columns]
    about = {START: start} if start else None
    arrays = [arrow.array(column.values, from_pandas=True) for column in columns]
    table = arrow.Table.from_arrays(arrays, schema=arrow.schema(fields, metadata=about))
    assert len(set(names)) == len(names)  # a Dataset has no name twice
    parquet.write_table(table, path, write_page_checksum=True)


def _notes(column: Column) -> dict[str, str]:
    told = {key: getattr(column, key) for key in KEYS}
    return {key: text for key, text in told.items() if text or key == "units"}
