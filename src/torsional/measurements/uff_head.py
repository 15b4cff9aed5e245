"""Heads of functions in universal files: eleven lines of fixed columns.

The format: Structural Dynamics Research Laboratory, University of Cincinnati, "Universal file formats", dataset 58.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from torsional.errors import ModelError
from torsional.measurements.recording import bounded
from torsional.units import quoted

HEAD_LINES = 11
HEAD_BYTES = 4000
KINDS = {2: (False, 4), 4: (False, 8), 5: (True, 4), 6: (True, 8)}
"""Whether complex, and the bytes of a number, by the ordinate's data type."""
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")


@dataclass(frozen=True)
class Head:
    """What the head of a function says; texts without what stands for none."""

    binary: bool
    order: str
    titles: tuple[str, ...]
    place: str
    complex: bool
    width: int
    count: int
    even: bool
    start: float
    step: str
    axis: int
    axis_units: str
    label: str
    units: str


def body(data: bytes, start: int) -> int:
    """The place behind the eleven lines of the head."""
    for _ in range(HEAD_LINES):
        start = data.find(b"\n", start) + 1
        if not start:
            raise ModelError("the file is cut within the head of a dataset")
    return start


def head_lines(data: bytes, start: int) -> list[str]:
    """The lines of a head."""
    text = data[start : start + HEAD_BYTES].decode("utf-8", "replace")
    return [line.rstrip("\r") for line in text.split("\n")[:HEAD_LINES]]


def head_of(text: str, lines: Sequence[str]) -> Head:
    if len(lines) < HEAD_LINES:
        raise ModelError("the head of the function is not whole", found=f"{len(lines)} lines", allowed="11")
    form, axis, ordinate = lines[6], lines[7], lines[8]
    kind, count, spacing = (_whole(form[i : i + 10], "line 7 of the head") for i in (0, 10, 20))
    if kind not in KINDS:
        allowed = "2, 4 (real), 5, 6 (complex)"
        raise ModelError("the ordinate has an unknown data type", found=str(kind), allowed=allowed)
    bounded(count)
    binary = text[6:7].lower() == "b"
    return Head(
        binary=binary,
        order=_byte_order(text) if binary else "<",
        titles=tuple(_text(line) for line in lines[:5]),
        place=_place(lines[5]),
        complex=KINDS[kind][0],
        width=KINDS[kind][1],
        count=count,
        even=spacing == 1,
        start=_real(form[30:43]),
        step=form[43:56].strip(),
        axis=_whole(axis[:10], "line 8 of the head"),
        axis_units=_text(axis[47:67]),
        label=_text(ordinate[26:46]),
        units=_text(ordinate[47:67]),
    )


def _byte_order(text: str) -> str:
    order, form = (_whole(text[i : i + 6], "the line '58b'") for i in (7, 13))
    if order not in (1, 2) or form != 2:
        allowed = "byte order 1 or 2, number format 2 (IEEE 754)"
        raise ModelError("numbers in this form are not read", found=quoted(text[:20]), allowed=allowed)
    return "<" if order == 1 else ">"


def _whole(text: str, where: str) -> int:
    if not re.fullmatch(r"\s*[+-]?\d{1,10}\s*", text):
        raise ModelError("a whole number is wanted", where=where, found=quoted(text))
    if int(text) < 0:
        raise ModelError("must not be negative", where=where, found=quoted(text))
    return int(text)


def _real(text: str) -> float:
    plain = text.strip().upper().replace("D", "E")
    if not plain:
        return 0.0
    if not NUMBER.fullmatch(plain) or not np.isfinite(float(plain)):
        raise ModelError("a finite number is wanted", where="line 7 of the head", found=quoted(text))
    return float(plain)


def _text(field: str) -> str:
    return "" if field.strip().upper() == "NONE" else field.strip()


def _place(line: str) -> str:
    """Entity, node and direction of the response, as measuring points are named: 12:+Z."""
    entity, node = _text(line[31:41]), line[41:51].strip()
    axis = {"1": "X", "2": "Y", "3": "Z", "4": "RX", "5": "RY", "6": "RZ"}.get(line[51:55].strip().lstrip("+-"), "")
    sign = "-" if line[51:55].strip().startswith("-") else "+"
    point = "" if node in ("", "0") and not axis else node + (f":{sign}{axis}" if axis else "")
    return " ".join(part for part in (entity, point) if part)


def exact_step(text: str) -> float:
    """The step, whose few digits stand for one over a whole rate where that rounds to them; zero for none above zero.

    >>> 1 / exact_step("2.26757E-05")
    44100.0
    """
    step = _real(text)
    if step <= 1e-12:
        return max(step, 0.0)
    rate = round(1.0 / step)
    digits = len(re.sub(r"[eE].*|\D", "", text).lstrip("0")) - 1
    if rate < 1 or digits < 4:
        return step
    return 1.0 / rate if float(f"{1.0 / rate:.{digits}e}") == step else step
