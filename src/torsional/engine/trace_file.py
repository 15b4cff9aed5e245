"""Tables of measured cylinder pressure: comma-separated text with units in its header."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from torsional.engine.orders import FloatArray
from torsional.errors import ModelError

ANGLES = {"deg": math.pi / 180, "°": math.pi / 180, "degca": math.pi / 180, "°ca": math.pi / 180, "rad": 1.0}
TIMES = {"s": 1.0, "ms": 1e-3}
PRESSURES = {"pa": 1.0, "hpa": 1e2, "mbar": 1e2, "kpa": 1e3, "bar": 1e5, "mpa": 1e6, "psi": 6894.757293168361}
LARGEST_FILE = 256 * 1024 * 1024


@dataclass(frozen=True, eq=False)
class PressureTable:
    """Columns of a pressure file in SI: ``angle`` [rad] or ``time`` [s] (rows,), ``pressure`` [Pa] (columns, rows)."""

    angle: FloatArray | None
    time: FloatArray | None
    pressure: FloatArray
    name: str


def read_table(source: str | Path) -> PressureTable:
    """Read a file, or text that holds a line break.

    The first line names the columns with their units in brackets, e.g. ``crank_angle [deg],pressure [bar]``; the
    separator is a comma, semicolon or tab; empty lines and lines that begin with # are passed over.  Pressure columns
    numbered at the end of their names (``pressure 3 [bar]``) are sorted by that number.
    Raises ModelError that names line and column for anything that is not such a table.
    """
    text, name = _text(source)
    lines = [
        (number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"
    ]
    if not lines:
        raise ModelError("the pressure file is empty", where=name)
    separator = max(";\t,", key=lines[0][1].count)
    header = [cell.strip() for cell in next(csv.reader([lines[0][1]], delimiter=separator))]
    abscissa, kind, columns = _columns(header, name)
    numbers = _numbers(lines[1:], separator, header, name)
    first = numbers[:, abscissa[0]] * abscissa[1]
    pressure = np.array([numbers[:, index] * scale for index, scale in columns])
    return PressureTable(first if kind == "angle" else None, first if kind == "time" else None, pressure, name)


def _text(source: str | Path) -> tuple[str, str]:
    if isinstance(source, str) and ("\n" in source or not source.strip()):
        return source.removeprefix("\ufeff"), "pressure text"
    path = Path(source)
    try:
        if path.stat().st_size > LARGEST_FILE:
            found, allowed = f"{path.stat().st_size / 2**20:.0f} MiB", f"{LARGEST_FILE / 2**20:.0f} MiB at most"
            raise ModelError("the pressure file is too large", where=str(source), found=found, allowed=allowed)
        return path.read_text(encoding="utf-8-sig"), str(source)
    except (OSError, ValueError) as error:
        if isinstance(error, ModelError):
            raise
        reason = (
            "it is not UTF-8 text"
            if isinstance(error, UnicodeError)
            else getattr(error, "strerror", None) or str(error)
        )
        raise ModelError("the pressure file cannot be read", where=str(source), found=reason) from None


def _columns(header: list[str], name: str) -> tuple[tuple[int, float], str, list[tuple[int, float]]]:
    """Column and scale of the abscissa, its kind, and column and scale of each pressure, all known by their units."""
    kinds: dict[str, list[tuple[int, float, str]]] = {"angle": [], "time": [], "pressure": []}
    for index, cell in enumerate(header):
        match = re.fullmatch(r"(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]", cell)
        unit = match.group(2).lower().replace(" ", "") if match else ""
        for kind, units in (("angle", ANGLES), ("time", TIMES), ("pressure", PRESSURES)):
            if match and unit in units:
                kinds[kind].append((index, units[unit], match.group(1)))
                break
        else:
            known = ", ".join([*ANGLES, *TIMES, "Pa", "hPa", "mbar", "kPa", "bar", "MPa", "psi"])
            remedy = "write the header as e.g. crank_angle [deg],pressure [bar]"
            raise ModelError(
                "a column has no unit that is known",
                where=name,
                found=repr(cell[:60]),
                allowed=f"[{known}]",
                remedy=remedy,
            )
    kind = "angle" if kinds["angle"] else "time"
    if len(kinds[kind]) != 1 or not kinds["pressure"]:
        found = ", ".join(header)[:200]
        allowed = "one column of crank angle or time, and one of pressure or one a cylinder"
        raise ModelError("a column is missing or given twice", where=name, found=found, allowed=allowed)
    index, scale, _ = kinds[kind][0]
    return (index, scale), kind, [(column, unit) for column, unit, _ in _by_number(kinds["pressure"], name)]


def _by_number(columns: list[tuple[int, float, str]], name: str) -> list[tuple[int, float, str]]:
    """Pressure columns in the sequence of the cylinder numbers at the end of their names, where they have any."""
    found = [re.search(r"(\d+)\s*$", label) for _, _, label in columns]
    if len(columns) == 1 or not any(found):
        return columns
    numbers = [int(match.group(1)) if match else 0 for match in found]
    if sorted(numbers) != list(range(1, len(columns) + 1)):
        listed = ", ".join(label for _, _, label in columns)
        raise ModelError("the pressure columns must be numbered 1, 2, 3 …", where=name, found=listed[:200])
    return [columns[numbers.index(number)] for number in range(1, len(columns) + 1)]


def _numbers(lines: list[tuple[int, str]], separator: str, header: list[str], name: str) -> FloatArray:
    rows = list(csv.reader(io.StringIO("\n".join(line for _, line in lines)), delimiter=separator))
    if len(rows) < 2:
        raise ModelError("the pressure file holds no numbers below its header", where=name, found=f"{len(rows)} rows")
    try:
        numbers = np.array(rows, dtype=float)
        if numbers.shape[1] == len(header) and np.isfinite(numbers).all():
            return numbers
    except ValueError:
        pass
    raise _first_fault(rows, lines, header, name)


def _first_fault(rows: list[list[str]], lines: list[tuple[int, str]], header: list[str], name: str) -> ModelError:
    """The error that names the first line and column at fault."""
    for (number, _), row in zip(lines, rows, strict=False):
        where = f"{name}, line {number}"
        if len(row) != len(header):
            allowed = f"{len(header)} columns as in the header"
            return ModelError(
                "the line has another number of columns", where=where, found=str(len(row)), allowed=allowed
            )
        for cell, label in zip(row, header, strict=True):
            if not _is_finite(cell):
                remedy = "write decimals with a point" if re.fullmatch(r"\s*[-+]?\d+,\d+\s*", cell) else ""
                remedy = "write values, not formulas" if cell.lstrip().startswith("=") else remedy
                problem = f"the value in column {label!r} is not a finite number"
                return ModelError(problem, where=where, found=repr(cell[:40]), remedy=remedy)
    return ModelError("the table cannot be read", where=name, remedy="look for quotes that are not closed")


def _is_finite(cell: str) -> bool:
    try:
        return math.isfinite(float(cell))
    except ValueError:
        return False
