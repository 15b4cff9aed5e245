"""Measurements as text tables: a column a channel, headed ``name [unit]``, and columns of time.

Separators are comma, semicolon or tab; where it is no comma, decimals may take one.  What loggers write above the
header is passed over; a second line without numbers holds the units.  Empty cells are missing values.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from torsional.errors import ModelError
from torsional.files.opening import read_text
from torsional.measurements.columns import Column, channels_of
from torsional.measurements.recording import Found, bounded
from torsional.numerics.arrays import Array
from torsional.units import quoted

BYTES = 400_000_000
COLUMNS = 5000
HEADS = 200
"""Lines among which the header is looked for."""
_HEADED = re.compile(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]")
_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*")
_COMMA = re.compile(r"\d,\d|[^\d],\d|\d,[^\d]|\d,$")
_FOREIGN = re.compile(r"[^0-9eE+\-.\s]")
MISSING = frozenset({"", "nan", "NaN", "NAN"})
BLOCK = 20_000
"""Lines that are split into cells at once."""


def read(path: Path) -> Found:
    """The channels of a text table."""
    return found_in(read_text(path, BYTES))


def found_in(text: str) -> Found:
    """The channels of a table's text."""
    lines, numbers = _lines(text)
    above = _above(lines)
    lines, numbers = lines[above:], numbers[above:]
    separator = _separator(lines[0])
    header = [cell.strip() for cell in next(csv.reader([lines[0]], delimiter=separator))]
    if len(header) > COLUMNS:
        raise ModelError("the table has too many columns", found=str(len(header)), allowed=f"at most {COLUMNS}")
    names, units, skipped = _headed(header, lines, separator)
    body = lines[1 + skipped :]
    if not body:
        raise ModelError("the table has no row below its header", found=quoted(lines[0]))
    bounded(len(body) * len(names))
    values = _values(body, separator, names, numbers[1 + skipped :])
    columns = [Column(*described) for described in zip(names, units, values, strict=True)]
    return Found(channels_of(columns), "CSV")


def _lines(text: str) -> tuple[list[str], list[int]]:
    """The lines that are neither blank nor comments, and their numbers."""
    held = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"]
    if not held:
        raise ModelError("the table has no line but comments")
    return [line for _, line in held], [i for i, _ in held]


def _separator(line: str) -> str:
    return max(",;\t", key=line.count)


def _above(lines: list[str]) -> int:
    """How many lines stand above the header: the first one that has as many columns as a line of numbers below it, or
    below a line of units."""
    for i in range(min(len(lines) - 1, HEADS)):
        separator = _separator(lines[i])
        count = lines[i].count(separator)
        below = [line for line in lines[i + 1 : i + 3] if line.count(separator) == count]
        if count and any(_is_numbers(line, separator) for line in below) and not _is_numbers(lines[i], separator):
            return i
    return 0


def _is_numbers(line: str, separator: str) -> bool:
    """Whether a line holds numbers alone, some of which may be missing."""
    cells = [cell.strip().strip('"').replace(",", ".") for cell in line.split(separator)]
    return any(map(_NUMBER.fullmatch, cells)) and all(cell in MISSING or _NUMBER.fullmatch(cell) for cell in cells)


def _headed(header: list[str], lines: list[str], separator: str) -> tuple[list[str], list[str], int]:
    """Names and units of the columns, and how many lines below the header hold units."""
    if all(_NUMBER.fullmatch(cell) for cell in header):
        remedy = "write a first line such as 'time [s],n_mot [rpm]'"
        raise ModelError("the table has no header with names", found=quoted(lines[0]), remedy=remedy)
    pairs = [name_and_unit(cell) for cell in header]
    names, units = [name for name, _ in pairs], [unit for _, unit in pairs]
    below = next(csv.reader(lines[1:2], delimiter=separator), [])
    if any(units) or len(below) != len(header) or any(_NUMBER.fullmatch(cell.replace(",", ".")) for cell in below):
        return names, units, 0
    if not any(cell.strip() for cell in below):
        return names, units, 0
    return names, [cell.strip().strip("[]()") for cell in below], 1


def name_and_unit(cell: str) -> tuple[str, str]:
    """Name and unit of a header cell; the apostrophe that keeps a spreadsheet from reckoning is taken off.

    >>> name_and_unit("M_gbx (left) [Nm]"), name_and_unit("'=1+1")
    (('M_gbx (left)', 'Nm'), ('=1+1', ''))
    """
    plain = cell[1:] if re.match(r"'\s*[=+\-@]", cell) else cell
    matched = _HEADED.fullmatch(plain)
    return (matched[1], matched[2].strip()) if matched and matched[1] else (plain, "")


def _values(lines: list[str], separator: str, names: Sequence[str], numbers: Sequence[int]) -> Array:
    """The numbers (columns, rows); ModelError names the first cell that is none."""
    if any('"' in line for line in lines):
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, delimiter=separator)]
        lines, separator = ["\t".join(row) for row in rows], "\t"
    if separator != "," and any(_COMMA.search(line) for line in lines[:100]):
        lines = [line.replace(",", ".") for line in lines]
    wanted = len(names) - 1
    if len(lines) != len(numbers) or any(line.count(separator) != wanted for line in lines):
        raise _first_fault(lines, separator, names, numbers)
    try:
        return _parsed(lines, separator, len(names))
    except (ValueError, OverflowError):
        raise _first_fault(lines, separator, names, numbers) from None


def _parsed(lines: list[str], separator: str, columns: int) -> Array:
    """The numbers (columns, rows), a block of lines after the other: cells take ten times the room of numbers."""
    blocks = [_block(lines[at : at + BLOCK], separator, columns) for at in range(0, len(lines), BLOCK)]
    values = np.concatenate(blocks).T
    if np.isinf(values).any():
        raise ValueError
    return np.ascontiguousarray(values)


def _block(lines: list[str], separator: str, columns: int) -> Array:
    text = separator.join(lines)
    found = ["nan" if cell in MISSING or cell.isspace() else cell for cell in text.split(separator)]
    # float() alone would read 1_000 and infinity; with those letters shut out its grammar is ours
    if _FOREIGN.search(re.sub("nan|NaN|NAN", "", text.replace(separator, " "))):
        raise ValueError
    return np.array(found, dtype=float).reshape(len(lines), columns)


def _first_fault(lines: list[str], separator: str, names: Sequence[str], numbers: Sequence[int]) -> ModelError:
    for line, number in zip(lines, numbers, strict=False):
        row = line.split(separator)
        if len(row) != len(names):
            remedy = "decimals take a point where commas separate the columns" if len(row) > len(names) else ""
            told = f"{len(row)} cells in {quoted(line)}"
            return ModelError(f"{len(names)} cells are wanted", where=f"line {number}", found=told, remedy=remedy)
        for cell, name in zip(row, names, strict=True):
            text = cell.strip()
            if text not in MISSING and not _NUMBER.fullmatch(text):
                where = f"line {number}, column {quoted(name)}"
                remedy = "write values, not formulas" if text.startswith(("=", "@")) else ""
                return ModelError("a plain number is wanted", where=where, found=quoted(text), remedy=remedy)
            if _NUMBER.fullmatch(text) and not np.isfinite(float(text)):
                where = f"line {number}, column {quoted(name)}"
                return ModelError("a number this large is not read", where=where, found=quoted(text))
    return ModelError("the table cannot be read", remedy="look for quotes that are not closed")
