"""Small tables in CSV: full-load curves, pressure traces, inertias over the crank angle."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping

from torsional import units
from torsional.errors import ModelError, nearest
from torsional.files.opening import TABLE_BYTES, read_text, shown
from torsional.units import quoted

_HEADER = re.compile(r"([^\[\]]+?)\s*(?:\[([^\[\]]*)\])?")
_FOREIGN = re.compile(r"[^0-9eE+\-.,\s]")
_COMMENT = re.compile(r"#[^\n]*")
_ROWS = 500_000


def read_table(
    path: str | os.PathLike[str], columns: Mapping[str, str], increasing: str = ""
) -> dict[str, list[float]]:
    """The named columns of a CSV file in SI, each a list of at least two finite numbers.

    ``columns`` maps a column's name to its quantity of the nomenclature; the header says the unit, as in
    ``speed [rpm],torque [Nm]``.  The column named by ``increasing`` must increase from row to row.  Lines may be blank
    or comments after ``#``.  ModelError names the file, row, line and column.
    """
    text = read_text(path, TABLE_BYTES)
    try:
        return parse_table(text, columns, increasing)
    except ModelError as error:
        raise error.located(file=shown(path)) from None


def parse_table(text: str, columns: Mapping[str, str], increasing: str = "") -> dict[str, list[float]]:
    """The columns of a CSV text, as for a file.

    >>> parse_table("angle [deg],ratio\\n0,1\\n180,2\\n", {"ratio": "ratio", "angle": "angle"}, increasing="angle")
    {'ratio': [1.0, 2.0], 'angle': [0.0, 3.141592653589793]}
    """
    rows = _rows(text)
    factors = _header(rows[0][1], columns)
    raw = _numbers(rows[1:], list(factors))
    table = {name: [value * factors[name] for value in column] for name, column in zip(factors, raw, strict=True)}
    _check_values(table, [line for line, _ in rows[1:]], increasing)
    return {name: table[name] for name in columns}


def _rows(text: str) -> list[tuple[int, str]]:
    """The lines that hold something, with their numbers; the first is the header."""
    if text.count("\n") > _ROWS:
        raise ModelError("the table is too long", allowed=f"at most {_ROWS} rows")
    lines = _COMMENT.sub("", text).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    rows = [(number, line) for number, line in enumerate(lines, 1) if line and not line.isspace()]
    if len(rows) < 3:
        raise ModelError("a table has a header and at least two rows", found=f"{max(len(rows) - 1, 0)} rows")
    return rows


def _header(line: str, columns: Mapping[str, str]) -> dict[str, float]:
    """Column name → factor to SI, in the order of the file."""
    if "," not in line and len(columns) > 1:
        remedy = "separate columns by commas and write decimal points"
        raise ModelError("the header names one column only", found=quoted(line.strip()), remedy=remedy)
    factors: dict[str, float] = {}
    for cell in line.split(","):
        name, factor = _column(cell.strip(), columns)
        if name in factors:
            raise ModelError("the column stands twice", where=f"column '{name}'")
        factors[name] = factor
    missing = [name for name in columns if name not in factors]
    if missing:
        raise ModelError(f"the column '{missing[0]}' is missing", where="header", found=quoted(line.strip()))
    return factors


def _column(cell: str, columns: Mapping[str, str]) -> tuple[str, float]:
    """Name and factor of a header cell such as ``speed [rpm]``."""
    matched = _HEADER.fullmatch(cell)
    if not matched or matched[1] not in columns:
        name = matched[1] if matched else cell
        raise ModelError("the column is unknown", where="header", found=quoted(cell), remedy=nearest(name, columns))
    name, unit = matched[1], matched[2]
    quantity = units.QUANTITIES[columns[name]]
    if not unit and quantity.kind != "number":
        example = f"'{name} [{quantity.shown}]'"
        raise ModelError("the header names no unit", where=f"column '{name}'", remedy=f"write {example}")
    return name, units.read(f"1 {unit or ''}", columns[name], where=f"header, column '{name}'")


def _numbers(rows: list[tuple[int, str]], names: list[str]) -> list[list[float]]:
    """The numbers column by column, in the header's units."""
    columns: list[list[float]] = [[] for _ in names]
    for row, (line, text) in enumerate(rows, 1):
        cells = text.split(",")
        if len(cells) != len(names):
            remedy = "decimals take a point; columns are separated by commas" if len(cells) > len(names) else ""
            found = f"{len(cells)} cells in {quoted(text.strip())}"
            raise ModelError(
                f"{len(names)} cells are wanted", where=f"row {row} (line {line})", found=found, remedy=remedy
            )
        try:
            values = _row(text, cells)
        except ValueError:
            raise _bad_cell(cells, names, f"row {row} (line {line})") from None
        for column, value in zip(columns, values, strict=True):
            column.append(value)
    return columns


def _row(text: str, cells: list[str]) -> list[float]:
    # float() alone would read 1_000, nan and infinity; with those letters shut out its grammar is ours
    if _FOREIGN.search(text):
        raise ValueError
    return [float(cell) for cell in cells]


def _bad_cell(cells: list[str], names: list[str], row: str) -> ModelError:
    """The error for the first cell of a row that is no number."""
    for cell, name in zip(cells, names, strict=True):
        try:
            _row(cell, [cell])
        except ValueError:
            where = f"{row}, column '{name}'"
            return ModelError(
                "a plain number is wanted", where=where, found=quoted(cell.strip()) if cell else "nothing"
            )
    raise AssertionError(f"{row} holds numbers only")


def _check_values(table: Mapping[str, list[float]], lines: list[int], increasing: str) -> None:
    for name, column in table.items():
        if not all(map(math.isfinite, column)):
            row = next(i for i, value in enumerate(column) if not math.isfinite(value))
            raise ModelError("a finite number is wanted", where=f"row {row + 1} (line {lines[row]}), column '{name}'")
    column = table.get(increasing, [])
    for row in range(1, len(column)):
        if column[row] <= column[row - 1]:
            place = f"row {row + 1} (line {lines[row]}), column '{increasing}'"
            raise ModelError("the column must increase from row to row", where=place)
