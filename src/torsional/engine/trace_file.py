"""Tables of measured cylinder pressure: columns of angle or time and of pressure, known by their units."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from torsional.engine.orders import FloatArray
from torsional.errors import ModelError
from torsional.tables import cells, named, numbers
from torsional.units import unit_factor

KINDS = ("angle", "time", "pressure")
LARGEST_FILE = 256 * 1024 * 1024


@dataclass(frozen=True, eq=False)
class PressureTable:
    """Columns of a pressure file in SI: ``angle`` [rad] or ``time`` [s] (rows,), ``pressure`` [Pa] (columns, rows)."""

    angle: FloatArray | None
    time: FloatArray | None
    pressure: FloatArray


class Column(NamedTuple):
    """A column of the file: its place, what kind of quantity it holds, the factor to SI, and its name."""

    place: int
    kind: str
    factor: float
    name: str


def pressure_table(text: str) -> PressureTable:
    """A table whose header names the columns with their units, e.g. ``crank_angle [deg],pressure [bar]``.

    Pressure columns numbered at the end of their names (``pressure 3 [bar]``) are sorted by that number.
    Raises ModelError that names line and column for anything that is not such a table.
    """
    table = cells(text)
    columns = [_column(index, cell) for index, cell in enumerate(table.header)]
    kind = "angle" if any(column.kind == "angle" for column in columns) else "time"
    along, pressures = ([column for column in columns if column.kind == one] for one in (kind, "pressure"))
    if len(along) != 1 or not pressures:
        found = ", ".join(table.header)[:200]
        allowed = "one column of crank angle or time, and one of pressure or one a cylinder"
        raise ModelError("a column is missing or given twice", where="header", found=found, allowed=allowed)
    values = numbers(table, table.header)
    first = values[along[0].place] * along[0].factor
    sequence = _by_number(pressures)
    pressure = values[[column.place for column in sequence]] * [[column.factor] for column in sequence]
    return PressureTable(first if kind == "angle" else None, first if kind == "time" else None, pressure)


def text_of(path: str | Path) -> str:
    """The text of a file that the user names; ModelError says why there is none."""
    try:
        size = Path(path).stat().st_size
        if size <= LARGEST_FILE:
            return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        unreadable = "it is not UTF-8 text" if isinstance(error, UnicodeError) else ""
        reason = unreadable or getattr(error, "strerror", None) or str(error)
        raise ModelError("the pressure file cannot be read", where=str(path), found=reason) from None
    found, allowed = f"{size / 2**20:.0f} MiB", f"{LARGEST_FILE / 2**20:.0f} MiB at most"
    raise ModelError("the pressure file is too large", where=str(path), found=found, allowed=allowed)


def _column(index: int, cell: str) -> Column:
    name, unit = named(cell)
    for kind in KINDS:
        factor = unit_factor(unit, kind)
        if factor is not None:
            return Column(index, kind, factor, name)
    allowed = "[deg], [rad], [s], [ms], [Pa], [hPa], [mbar], [kPa], [bar], [MPa], [psi]"
    remedy = "write the header as e.g. crank_angle [deg],pressure [bar]"
    problem = "a column has no unit that is known"
    raise ModelError(problem, where="header", found=repr(cell[:60]), allowed=allowed, remedy=remedy)


def _by_number(columns: Sequence[Column]) -> Sequence[Column]:
    """Pressure columns in the sequence of the cylinder numbers at the end of their names, where they have any."""
    found = [re.search(r"(\d+)\s*$", column.name) for column in columns]
    if len(columns) == 1 or not any(found):
        return columns
    ordered = [int(match.group(1)) if match else 0 for match in found]
    if sorted(ordered) != list(range(1, len(columns) + 1)):
        listed = ", ".join(column.name for column in columns)
        raise ModelError("the pressure columns must be numbered 1, 2, 3 …", where="header", found=listed[:200])
    return [columns[ordered.index(number)] for number in range(1, len(columns) + 1)]
