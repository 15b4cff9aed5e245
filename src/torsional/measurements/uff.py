"""Functions of universal files (dataset 58, in text or binary), as measuring systems and modal software write them.

The format: Structural Dynamics Research Laboratory, University of Cincinnati, "Universal file formats", datasets 58 and
58b: eleven lines of a head, then values in fixed columns or as numbers of four or eight bytes.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path

import numpy as np

from torsional.errors import ModelError
from torsional.files.opening import read_bytes
from torsional.measurements.columns import seconds
from torsional.measurements.recording import PULSES, Channel, Found, Raster, bounded
from torsional.measurements.uff_head import NUMBER, Head, body, exact_step, head_lines, head_of
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import quoted

BYTES = 2_000_000_000
FUNCTION = 58
AXES = {17: "time", 18: "frequency", 19: "speed", 20: "order"}
"""What the abscissa is, by its specific data type."""
_AXIS_UNITS = {"time": "s", "frequency": "Hz", "speed": "rpm", "order": "-"}
_EDGE = re.compile(rb"(?:^|\n)[ ]{4}-1[ \t]*\r?(?=\n|\Z)")
_END = re.compile(rb"\s*-1[ \t]*\r?(?:\n|\Z)")


def read(path: Path) -> Found:
    """The functions of a universal file; other datasets are passed over."""
    data = read_bytes(path, BYTES)
    channels, others, dates = [], set[str](), []
    for number, (kind, text, start) in enumerate(_datasets(data), 1):
        if kind != FUNCTION:
            others.add(str(kind))
            continue
        try:
            head = head_of(text, head_lines(data, start))
            channels.append(_channel(head, _values(head, data, body(data, start))))
        except ModelError as error:
            raise error.located(prefix=f"dataset {number}") from None
        dates.append(head.titles[2])
    if not channels:
        found = f"datasets {', '.join(sorted(others))}" if others else "no whole dataset"
        raise ModelError("the file holds no function (dataset 58)", found=found)
    return Found(channels, "UFF 58", _start(dates))


def _start(dates: Sequence[str]) -> str:
    """The first date that is one, as ISO writes it: the format's own is 23-NOV-26 14:05:00."""
    for date in dates:
        for parse in (datetime.fromisoformat, lambda text: datetime.strptime(text, "%d-%b-%y %H:%M:%S")):
            with contextlib.suppress(ValueError):
                return parse(date).isoformat()
    return ""


def _datasets(data: bytes) -> Iterator[tuple[int, str, int]]:
    """Number, identifier line, and the place behind it, of every dataset."""
    at = 0
    while (edge := _EDGE.search(data, at)) is not None:
        begin = edge.end() + 1
        end = data.find(b"\n", begin)
        if end < 0:
            return
        text = data[begin:end].decode("latin-1")
        number = re.fullmatch(r"\s*(\d{1,6})([bB].*|\s*)", text.rstrip("\r"))
        if number is None:
            raise ModelError("a dataset begins with its number", found=quoted(text[:40]))
        yield int(number[1]), text, end + 1
        at = _after(data, text, end + 1)


def _after(data: bytes, text: str, start: int) -> int:
    """Where to look for the next dataset: past the edge that ends this one; bytes of values may look like an edge."""
    if "b" in text.lower():
        head = head_of(text, head_lines(data, start))
        begin = body(data, start)
        ended = _END.match(data, begin + _size(head, data, begin))
        if ended:
            return ended.end() - 1
    edge = _EDGE.search(data, start)
    if edge is None:
        raise ModelError("the file is cut: a dataset has no end", found=f"dataset {text.split()[0]}")
    return edge.end()


def _size(head: Head, data: bytes, begin: int) -> int:
    """Bytes of a binary body: as the data form says, the abscissa in eight bytes or in four beside ordinates of eight.

    The number of bytes in the identifier line is not asked, since programs are known to write it wrong.
    """
    parts = 1 + head.complex
    sizes = [head.count * head.width * (parts + (not head.even))]
    sizes += [head.count * (8 * parts + 4)] if head.width == 8 and not head.even else []
    return next((size for size in sizes if _END.match(data, begin + size)), sizes[0])


def _values(head: Head, data: bytes, begin: int) -> Array:
    """The numbers of a function (place, number): the abscissa in front where it is uneven."""
    across = 1 + head.complex + (not head.even)
    bounded(head.count * across)
    if head.binary:
        return _unpacked(head, data, begin, across)
    edge = _EDGE.search(data, begin - 1)
    words = data[begin : edge.start() if edge else len(data)].decode("latin-1").upper().replace("D", "E")
    found = _split(words, head, across)
    if found.size < head.count * across:
        raise _short(head, found.size // across)
    return found[: head.count * across].reshape(head.count, across)


def _short(head: Head, count: int) -> ModelError:
    return ModelError("the function is cut", found=f"{count} values", allowed=f"{head.count}, as its head says")


def _unpacked(head: Head, data: bytes, begin: int, across: int) -> Array:
    size = _size(head, data, begin)
    if begin + size > len(data):
        raise _short(head, (len(data) - begin) // max(size // max(head.count, 1), 1))
    if size == head.count * across * head.width:
        numbers = np.frombuffer(data, f"{head.order}f{head.width}", head.count * across, begin)
        return numbers.reshape(head.count, across).astype(float)
    mixed = np.dtype([("x", f"{head.order}f4"), ("y", f"{head.order}f8", (across - 1,))])
    rows = np.frombuffer(data, mixed, head.count, begin)
    return np.column_stack([rows["x"].astype(float), rows["y"]])


def _split(text: str, head: Head, across: int) -> Array:
    """Numbers of a text: by the blanks between them, or by fixed columns where they touch."""
    words = text.split()
    if len(words) != head.count * across:
        widths = [13] * across if head.width == 4 else [*([13] if not head.even else []), *[20] * (1 + head.complex)]
        words = [word for line in text.splitlines() for word in _fixed(line, widths)]
    try:
        found = np.array(words, dtype=float)
    except ValueError:
        wrong = next(word for word in words if not NUMBER.fullmatch(word))
        raise ModelError("a number is wanted among the values", found=quoted(wrong)) from None
    return found


def _fixed(line: str, widths: Sequence[int]) -> Iterator[str]:
    at, i = 0, 0
    while line[at:].strip():
        yield line[at : at + widths[i % len(widths)]].strip()
        at, i = at + widths[i % len(widths)], i + 1


def _channel(head: Head, values: Array) -> Channel:
    name = AXES.get(head.axis, "abscissa")
    if head.even:
        step = exact_step(head.step)
        if not step > 0:
            raise ModelError("the step of the abscissa must be positive", found=quoted(head.step))
        axis: Array = np.asarray(head.start + step * np.arange(head.count))
    else:
        axis, values = values[:, 0].copy(), values[:, 1:]
    units = head.axis_units or _AXIS_UNITS.get(name, "")
    raster = Raster(seconds(axis, units, "abscissa"), name, "s") if name == "time" else Raster(axis, name, units)
    ordinate: Array | ComplexArray = values[:, 0] + 1j * values[:, 1] if head.complex else values[:, 0].copy()
    told = {"units": head.units, "group": head.place, "comment": head.titles[1], "long_name": head.label}
    attrs: dict[str, str | float] = {"kind": PULSES} if head.titles[4] == PULSES else {}
    return Channel(head.titles[0] or head.place or "function", ordinate, raster, **told, attrs=attrs)
