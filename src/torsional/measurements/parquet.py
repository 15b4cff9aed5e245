"""Parquet through pyarrow: columns of numbers, their units in the fields' metadata or in their names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.measurements.columns import Column, channels_of
from torsional.measurements.formats import library
from torsional.measurements.recording import Found, bounded
from torsional.measurements.table_text import name_and_unit
from torsional.numerics.arrays import Array
from torsional.units import quoted

KEYS = ("units", "group", "comment", "kind")
START = "start"
_LIMIT = 100_000_000
"""Bytes of texts, and entries of lists, in the head of a file."""


def read(path: Path) -> Found:
    """The channels of a flat table of numbers; columns of texts and lists are left out."""
    parquet = library("pyarrow.parquet", "Parquet")
    limits = {"thrift_string_size_limit": _LIMIT, "thrift_container_size_limit": _LIMIT}
    with parquet.ParquetFile(path, **limits, page_checksum_verification=True) as file:
        schema, rows = file.schema_arrow, file.metadata.num_rows
        if rows < 1 or file.metadata.num_row_groups < 1:
            raise ModelError("the table has no rows")
        fields = [schema.field(number) for number in range(len(schema.names))]
        bounded(rows * len(fields))
        kept = [field for field in fields if _readable(field.type)]
        if len({field.name for field in kept}) != len(kept):
            raise ModelError("two columns have one name", found=quoted(schema.names))
        table = file.read(columns=[field.name for field in kept], use_threads=False)
        table.validate(full=True)
        start = _text((schema.metadata or {}).get(START.encode(), b""))
        columns = [_column(field, table.column(field.name)) for field in kept]
    left_out = [field.name for field in fields if field not in kept]
    return Found(channels_of(columns) if columns else [], "Parquet", start, left_out)


def _readable(kind: Any) -> bool:
    types = library("pyarrow.types", "Parquet")
    tests = (types.is_integer, types.is_floating, types.is_boolean, types.is_decimal, types.is_timestamp)
    return any(test(kind) for test in (*tests, types.is_duration))


def _column(field: Any, values: Any) -> Column:
    told = {key: _text((field.metadata or {}).get(key.encode(), b"")) for key in KEYS}
    name, unit = (field.name, told["units"]) if field.metadata and b"units" in field.metadata else _heading(field.name)
    kind = str(field.type)
    if kind.startswith(("timestamp", "duration")):
        return Column(name, "s", _seconds(values, kind))
    numbers: Array = values.cast("float64", safe=False).to_numpy().astype(float)
    return Column(name, unit, numbers, told["group"], told["comment"], told["kind"])


def _heading(name: str) -> tuple[str, str]:
    return ("time", "s") if name == "__index_level_0__" else name_and_unit(name)


def _seconds(values: Any, kind: str) -> Array:
    """Seconds from the first of dates, or of durations."""
    unit = kind.partition("[")[2].rstrip("]").split(",")[0]
    counts = values.cast("int64").to_numpy()
    first = counts[0] if kind.startswith("timestamp") else 0
    return np.asarray((counts - first) * {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[unit])


def _text(value: bytes) -> str:
    return value.decode("utf-8", "replace")
