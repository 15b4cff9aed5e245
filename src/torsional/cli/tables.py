"""Tables for people: plain text where it is piped or read by a file, rich where a terminal shows it."""

from __future__ import annotations

import os
import sys
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, TextIO

from torsional.cli.failures import clean
from torsional.units import QUANTITIES, show

_KEPT_WHOLE = 20
"""Cells up to this width are not broken in a narrow terminal; headings are, between words."""


@dataclass(frozen=True)
class Column:
    """A column's heading, and the quantity of its numbers or "" for text; ``unit`` other than the usual one."""

    name: str
    quantity: str = ""
    unit: str = ""

    @property
    def heading(self) -> str:
        """The name, with the unit its numbers are shown in."""
        unit = self.unit or (QUANTITIES[self.quantity].shown if self.quantity else "-")
        return self.name if unit == "-" else f"{self.name} [{unit}]"

    def cell(self, value: object) -> str:
        """A value as it is shown: SI numbers in the column's unit, nothing for NaN and None."""
        if value is None or value != value:
            return "-"
        if not self.quantity or isinstance(value, str):
            return clean(value)
        return show(float(value), self.quantity, self.unit or None).split(" ")[0]  # type: ignore[arg-type]


@dataclass(frozen=True)
class Table:
    """A title, columns, and rows of SI values."""

    title: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[object]] = ()

    def cells(self) -> list[list[str]]:
        """The rows as they are shown."""
        return [[column.cell(value) for column, value in zip(self.columns, row, strict=True)] for row in self.rows]


def plain(table: Table) -> str:
    """The table as text: numbers to the right, two blanks between columns, no ruler that a script must skip twice."""
    headings = [column.heading for column in table.columns]
    rows = table.cells()
    widths = [max(_width(row[i]) for row in [headings, *rows]) for i in range(len(headings))]
    lines = [_line(row, widths, table.columns) for row in [headings, ["-" * width for width in widths], *rows]]
    return "\n".join([clean(table.title), *lines]) + "\n"


def _line(row: Sequence[str], widths: Sequence[int], columns: Sequence[Column]) -> str:
    padded = []
    for text, width, column in zip(row, widths, columns, strict=True):
        blanks = " " * (width - _width(text))
        padded.append(blanks + text if column.quantity else text + blanks)
    return "  ".join(padded).rstrip()


def _width(text: str) -> int:
    """Places a text takes in a terminal; marks that sit on letters take none."""
    wide = sum(unicodedata.east_asian_width(letter) in "WF" for letter in text)
    return len(text) + wide - sum(map(bool, map(unicodedata.combining, text)))


def styled(stream: TextIO) -> bool:
    """Whether a stream is a terminal that wants colours."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def print_tables(tables: Sequence[Table]) -> None:
    """Print tables to stdout, a blank line between them."""
    if styled(sys.stdout):
        _print_rich(tables)
    else:
        print("\n".join(plain(table) for table in tables), end="")


def _print_rich(tables: Sequence[Table]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table as RichTable
    from rich.text import Text

    console = Console(highlight=False, safe_box=True)
    for table in tables:
        drawn = RichTable(title=Text(clean(table.title), "bold"), title_justify="left", box=box.SIMPLE_HEAD)
        rows = table.cells()
        for i, column in enumerate(table.columns):
            longest = max((_width(row[i]) for row in rows), default=0)
            side: Literal["left", "right"] = "right" if column.quantity else "left"
            drawn.add_column(Text(column.heading), justify=side, overflow="fold", min_width=min(longest, _KEPT_WHOLE))
        for row in rows:
            drawn.add_row(*(Text(cell) for cell in row))
        console.print(drawn)
