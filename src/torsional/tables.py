"""Tables in CSV, read and headed in one way: full-load curves, pressure traces, results for spreadsheets.

The first line names the columns with their units, as in ``speed [rpm],torque [Nm]``.  The separator is the comma,
semicolon or tab that it holds most of; decimals take a point.  Lines may be blank or comments after ``#``.
"""

from __future__ import annotations

import csv
import itertools
import math
import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from torsional import units
from torsional.errors import ModelError, nearest
from torsional.units import quoted

LONGEST = 500_000
"""Rows of a table of named columns."""

_HEADER = re.compile(r"([^\[\]()]+?)\s*(?:[\[(]([^\[\]()]*)[\])])?")
_FOREIGN = re.compile(r"[^0-9eE+\-.\s]")
_HEADER_COMMENT = re.compile(r"#(?!\d).*")  # but "pressure #1" is a name


class Cells(NamedTuple):
    """A table as it stands: the ``header`` and the ``rows`` cell by cell, and the ``lines`` that the rows stand in."""

    header: list[str]
    rows: list[list[str]]
    lines: list[int]


def heading(name: str, unit: str) -> str:
    """A column's name with its unit, of which a plain number has none.

    >>> heading("speed", "rad/s"), heading("mode", "-")
    ('speed [rad/s]', 'mode')
    """
    return name if unit == "-" else f"{name} [{unit}]"


def named(cell: str) -> tuple[str, str]:
    """Name and unit of a header cell; either is empty where it is none.

    >>> named("crank angle (deg)"), named("mode")
    (('crank angle', 'deg'), ('mode', ''))
    """
    matched = _HEADER.fullmatch(cell)
    return (matched[1], (matched[2] or "").strip()) if matched else ("", "")


def cells(text: str) -> Cells:
    """The cells of a table with a header and two rows at least."""
    lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    held = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and line.lstrip()[0] != "#"]
    if len(held) < 3:
        raise ModelError("a table has a header and at least two rows", found=_counted(held))
    header = _HEADER_COMMENT.sub("", held[0][1])
    separator = max(",;	", key=header.count)
    try:
        kept = [header, *(line.partition("#")[0] for _, line in held[1:])]
        rows = list(csv.reader(kept, delimiter=separator))
    except csv.Error as error:
        raise ModelError("the table cannot be read", found=str(error)) from None
    return Cells([cell.strip() for cell in rows[0]], rows[1:], [number for number, _ in held[1:]])


def _counted(held: Sequence[tuple[int, str]]) -> str:
    """The rows there are, and the line that was taken for the header."""
    rows = f"{len(held) - 1} row{'s' * (len(held) != 2)}"
    return f"{rows} below {quoted(held[0][1].strip())}" if held else "no line"


def numbers(table: Cells, names: Sequence[str]) -> NDArray[np.float64]:
    """The numbers (columns, rows) in the header's units, all finite; ModelError names line and column of the first
    that is none."""
    # float() alone would read 1_000, nan and infinity; with those letters shut out its grammar is ours
    plain = not _FOREIGN.search(" ".join(itertools.chain.from_iterable(table.rows)))
    try:
        found = np.array(table.rows, dtype=float).T
        if plain and found.shape == (len(names), len(table.rows)) and np.isfinite(found).all():
            return found
    except ValueError:
        pass
    raise _first_fault(table, names)


def _first_fault(table: Cells, names: Sequence[str]) -> ModelError:
    for row, (line, found) in enumerate(zip(table.lines, table.rows, strict=False), 1):
        where = f"row {row} (line {line})"
        if len(found) != len(names):
            remedy = "decimals take a point; columns are separated by commas" if len(found) > len(names) else ""
            told = f"{len(found)} cells in {quoted(','.join(found))}"
            return ModelError(f"{len(names)} cells are wanted", where=where, found=told, remedy=remedy)
        for cell, name in zip(found, names, strict=True):
            problem = _problem(cell)
            if problem:
                remedy = "write decimals with a point" if re.fullmatch(r"\s*[-+]?\d+,\d+\s*", cell) else ""
                remedy = "write values, not formulas" if cell.lstrip().startswith(("=", "@")) else remedy
                told = quoted(cell.strip()) if cell else "nothing"
                return ModelError(problem, where=f"{where}, column '{name}'", found=told, remedy=remedy)
    return ModelError("the table cannot be read", remedy="look for quotes that are not closed")


def _problem(cell: str) -> str:
    try:
        if _FOREIGN.search(cell):
            raise ValueError
        return "" if math.isfinite(float(cell)) else "a finite number is wanted"
    except ValueError:
        return "a plain number is wanted"


def parse_table(text: str, columns: Mapping[str, str], increasing: str = "") -> dict[str, list[float]]:
    """The named columns of a CSV text in SI, each a list of at least two finite numbers.

    ``columns`` maps a column's name to its quantity of the nomenclature.  The column named by ``increasing`` must
    increase from row to row.  ModelError names row, line and column.

    >>> parse_table("angle [deg],ratio\\n0,1\\n180,2\\n", {"ratio": "ratio", "angle": "angle"}, increasing="angle")
    {'ratio': [1.0, 2.0], 'angle': [0.0, 3.141592653589793]}
    """
    if text.count("\n") > LONGEST:
        raise ModelError("the table is too long", allowed=f"at most {LONGEST} rows")
    table = cells(text)
    factors = _factors(table.header, columns)
    found = numbers(table, list(factors))
    values = {name: (row * factors[name]).tolist() for name, row in zip(factors, found, strict=True)}
    if increasing:
        _check_increase(values[increasing], table.lines, increasing)
    return {name: values[name] for name in columns}


def _factors(header: Sequence[str], columns: Mapping[str, str]) -> dict[str, float]:
    """Column name → factor to SI, in the order of the file."""
    factors: dict[str, float] = {}
    for cell in header:
        name, factor = _column(cell, columns)
        if name in factors:
            raise ModelError("the column stands twice", where=f"column '{name}'")
        factors[name] = factor
    missing = [name for name in columns if name not in factors]
    if missing:
        raise ModelError(f"the column '{missing[0]}' is missing", where="header", found=quoted(",".join(header)))
    return factors


def _column(cell: str, columns: Mapping[str, str]) -> tuple[str, float]:
    """Name and factor of a header cell such as ``speed [rpm]``."""
    name, unit = named(cell)
    if name not in columns:
        remedy = nearest(name or cell, columns)
        raise ModelError("the column is unknown", where="header", found=quoted(cell), remedy=remedy)
    quantity = units.QUANTITIES[columns[name]]
    if not unit and quantity.kind != "number":
        example = f"'{heading(name, quantity.shown)}'"
        raise ModelError("the header names no unit", where=f"column '{name}'", remedy=f"write {example}")
    return name, units.read(f"1 {unit}", columns[name], where=f"header, column '{name}'")


def _check_increase(column: Sequence[float], lines: Sequence[int], name: str) -> None:
    for row in range(1, len(column)):
        if column[row] <= column[row - 1]:
            place = f"row {row + 1} (line {lines[row]}), column '{name}'"
            raise ModelError("the column must increase from row to row", where=place)
