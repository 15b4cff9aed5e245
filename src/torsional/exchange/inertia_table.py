"""A line as a table in CSV: inertia of each node, stiffness to the next, damping, ratio."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from torsional import units
from torsional.arguments import checked
from torsional.components import Component, Damper, GearPair, Inertia, Shaft
from torsional.errors import ModelError, nearest
from torsional.files.opening import TABLE_BYTES, read_text, shown
from torsional.files.schema.fields import plain_name
from torsional.model import Landmarks, Model
from torsional.tables import Cells, cells, heading, named
from torsional.units import QUANTITIES, quoted

COLUMNS: Mapping[str, str] = {
    "node": "",
    "inertia": "inertia",
    "stiffness": "stiffness",
    "damping": "damping",
    "ratio": "gear_ratio",
    "ground_damping": "damping",
    "to": "",
}
"""Columns of a table and their quantities; texts have none."""
WANTED = ("node", "inertia", "stiffness")


class Row(NamedTuple):
    """One line of a table in SI; what is not told is nought, the ratio one."""

    line: int
    node: str
    inertia: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    ratio: float = 1.0
    ground_damping: float = 0.0
    to: str = ""


@checked
def read_inertia_table(path: str | os.PathLike[str]) -> Model:
    """The model of a CSV table: a line for each node with its ``inertia``, and what joins it to the next one.

    Columns, named with their units in the first line: ``node``, ``inertia``, ``stiffness``; further ``damping`` beside
    the stiffness, ``ratio``, how fast what the stiffness ends on turns over the next node, ``ground_damping`` of the
    node itself, and ``to``, the node that is joined where it is not that of the next line.  Without a stiffness a
    ratio is a rigid gear, and a line without either is an end.  Raises ModelError with line and column.

    >>> import tempfile
    >>> table = "node;inertia [kgm²];stiffness [kNm/rad]\\nengine;2.1;25\\nload;8;\\n"
    >>> with tempfile.NamedTemporaryFile("w", suffix=".csv", encoding="utf-8") as file:
    ...     _ = file.write(table), file.flush()
    ...     print(read_inertia_table(file.name).components["engine to load"])
    Shaft(a='engine', b='load', stiffness=25000.0, damping=0.0, loss_factor=0.0)
    """
    try:
        rows = list(_rows(cells(read_text(path, TABLE_BYTES))))
        parts = dict(_parts(rows))
        model = Model(Path(path).stem, parts, Landmarks())
        _ = model.powertrain()
    except ModelError as error:
        raise error if error.file else error.located(file=shown(path)) from None
    return model


def _rows(table: Cells) -> Iterator[Row]:
    """The lines of a table, in SI."""
    columns = [_column(cell) for cell in table.header]
    names = [name for name, _ in columns]
    for name in (*WANTED, *names):
        if names.count(name) != 1:
            problem = f"the column '{name}' {'is missing' if name not in names else 'stands twice'}"
            allowed = ", ".join(COLUMNS)
            raise ModelError(problem, where="header", found=quoted(",".join(table.header)), allowed=allowed)
    for line, found in zip(table.lines, table.rows, strict=True):
        if len(found) != len(columns):
            told, remedy = f"{len(found)} cells", "decimals take a point; columns are separated by commas"
            raise ModelError(f"{len(columns)} cells are wanted", where=f"line {line}", found=told, remedy=remedy)
        values = {name: _value(cell, name, unit, line) for cell, (name, unit) in zip(found, columns, strict=True)}
        given: dict[str, Any] = {name: value for name, value in values.items() if value != ""}
        yield Row(**{"line": line, "node": "", **given})


def _column(cell: str) -> tuple[str, str]:
    """Name and unit of a column."""
    name, unit = named(cell)
    if name not in COLUMNS:
        raise ModelError("the column is unknown", where="header", found=quoted(cell), remedy=nearest(name, COLUMNS))
    quantity = COLUMNS[name]
    if quantity and not unit and QUANTITIES[quantity].kind != "number":
        example = f"'{heading(name, QUANTITIES[quantity].shown)}'"
        raise ModelError("the header names no unit", where=f"column '{name}'", remedy=f"write {example}")
    return name, unit


def _value(cell: str, name: str, unit: str, line: int) -> str | float:
    """A cell in SI; an empty one is a text without letters."""
    text, where = cell.strip(), f"line {line}, column '{name}'"
    if not COLUMNS[name] or not text:
        try:
            return plain_name(text) if text else ""
        except ModelError as error:
            raise error.located(prefix=where) from None
    return units.read(f"{text} {unit}", COLUMNS[name], where)


def _parts(rows: Sequence[Row]) -> Iterator[tuple[str, Component]]:
    """The components of a table."""
    nodes = [row.node for row in rows]
    for row in rows:
        where = f"line {row.line}"
        if not row.node or nodes.count(row.node) > 1:
            problem = "the node has no name" if not row.node else "the node stands twice"
            raise ModelError(problem, where=where, found=quoted(row.node), remedy="give every line a name of its own")
        try:
            if row.inertia:
                yield row.node, Inertia(row.inertia)
            if row.ground_damping:
                yield f"{row.node} to ground", Damper(row.node, "ground", row.ground_damping)
        except ModelError as error:
            raise error.located(prefix=where) from None
    for row, following in zip(rows, [*nodes[1:], ""], strict=True):
        yield from _joined(row, row.to or (following if _joins(row) else ""), nodes)


def _joins(row: Row) -> bool:
    return bool(row.stiffness or row.ratio != 1.0)


def _joined(row: Row, to: str, nodes: Sequence[str]) -> Iterator[tuple[str, Component]]:
    """What joins a node to another."""
    where = f"line {row.line}"
    if not to and not _joins(row):
        if row.damping:
            raise ModelError("damping stands beside a stiffness", where=where, found=f"{row.damping:g} Nms/rad")
        return
    if to not in nodes:
        problem = "there is no next node" if not to else "there is no such node"
        remedy = "leave the last line's stiffness empty" if not to else nearest(to, nodes)
        raise ModelError(problem, where=f"{where}, column 'to'", found=quoted(to), remedy=remedy)
    name, between = f"{row.node} to {to}", f"{row.node} end"
    if between in nodes and row.ratio != 1.0:
        raise ModelError("the name is taken by the shaft's end", where=where, found=quoted(between), remedy="rename it")
    try:
        if not row.stiffness:
            yield name, GearPair(row.node, to, row.ratio)
        elif row.ratio == 1.0:
            yield name, Shaft(row.node, to, row.stiffness, row.damping)
        else:
            yield name, Shaft(row.node, between, row.stiffness, row.damping)
            yield f"{name} gear", GearPair(between, to, row.ratio)
    except ModelError as error:
        raise error.located(prefix=where) from None
