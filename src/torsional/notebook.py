"""What notebooks show of models, systems and operating points: short tables in HTML, in the units engineers expect."""

from __future__ import annotations

import dataclasses
import numbers
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from torsional.units import QUANTITIES, quoted, show


def html_table(title: str, headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A small table with a caption, everything in it escaped.

    >>> html_table("Springs", ["name"], [["dmf"]])
    '<table><caption>Springs</caption><tr><th>name</th></tr><tr><td>dmf</td></tr></table>'
    """
    head = "".join(f"<th>{escape(heading)}</th>" for heading in headings)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><caption>{escape(title)}</caption><tr>{head}</tr>{body}</table>"


def components_table(title: str, components: Mapping[str, object]) -> str:
    """Components by name, with their kind and values."""
    rows = [[name, type(part).__name__, _told_fields(part)] for name, part in components.items()]
    return html_table(title, ["name", "kind", "values"], rows)


def operating_point_table(point: Any) -> str:
    """Mean torque and twist of every connection of an `OperatingPoint`, its tangent and the stage it is in.

    Of several mean torques, only their number is told.
    """
    if point.angle.ndim > 1:
        return f"<p>Operating points of {len(point.names)} connections at {len(point.angle)} mean torques</p>"
    least = 1e-9 * max(abs(point.torque).max(), 1.0)  # what rounding leaves of no torque
    rows = []
    for i, name in enumerate(point.names):
        idle = abs(point.torque[i]) < least
        torque, twist = (0.0, 0.0) if idle else (float(point.torque[i]), float(point.angle[i]))
        amounts = [show(torque, "torque"), show(twist, "relative_angle"), show(float(point.stiffness[i]), "stiffness")]
        rows.append([name, *amounts, point.stage(name)])
    return html_table("Operating point", ["connection", "mean torque", "mean twist", "tangent", "stage"], rows)


def _told_fields(part: object) -> str:
    """The fields of a dataclass that differ from their defaults, with units where the nomenclature has the name."""
    if not dataclasses.is_dataclass(part):
        return ""
    values = ((field.name, getattr(part, field.name), field.default) for field in dataclasses.fields(part))
    return ", ".join(f"{name} {told(name, value)}" for name, value, usual in values if not _same(value, usual))


def told(name: str, value: object) -> str:
    """One value in words: an amount with its unit, a law by its kind, anything else as Python writes it, cut short.

    >>> told("stiffness", 13e3), told("a", "primary"), told("ratio", 3.5)
    ('13 kNm/rad', 'primary', '3.5')
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return show(float(value), name) if name in QUANTITIES else f"{float(value):.5g}"
    if isinstance(value, str):
        return value
    return type(value).__name__ if dataclasses.is_dataclass(value) else quoted(value)


def _same(value: object, usual: object) -> bool:
    return type(value) is type(usual) and value == usual
