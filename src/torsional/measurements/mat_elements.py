"""The elements of a MATLAB 5 file, walked through before SciPy reads them: sizes, shapes, what they unpack to.

Layout: The MathWorks, "MAT-File Format".
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

from torsional.errors import ModelError
from torsional.measurements.recording import VALUES
from torsional.units import quoted

HEADER = 128
UNPACKED = 8 * VALUES
DEPTH = 20
MATRIX, COMPRESSED = 14, 15
_WIDTHS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
"""Bytes of one value, by the type of the element that holds it."""
_CELL, _STRUCT, _CHAR, _NUMBERS = 1, 2, 4, range(6, 16)


@dataclass(frozen=True)
class Element:
    """An element: the type of its data, and where they stand in ``data``."""

    kind: int
    data: memoryview
    next: int


@dataclass
class _Budget:
    left: int = UNPACKED

    def spend(self, count: int) -> None:
        self.left -= count
        if self.left < 0:
            raise ModelError("the recording is too large", found=f"over {UNPACKED} bytes unpacked")


def sound_variables(data: bytes) -> tuple[list[str], list[str]]:
    """Names of the variables that hold numbers, texts and structures of them alone, and of the others; ModelError for a
    file that is cut or damaged."""
    if len(data) < HEADER or data[126:128] not in (b"IM", b"MI"):
        raise ModelError("the file is cut or damaged in its head")
    order = "<" if data[126:128] == b"IM" else ">"
    budget = _Budget()
    sound: list[str] = []
    others: list[str] = []
    view, at = memoryview(data), HEADER
    while at < len(data):
        element = _element(view, at, order, padded=False)
        body = element
        if element.kind == COMPRESSED:
            body = _element(memoryview(_unpacked(element.data, budget)), 0, order)
        if body.kind != MATRIX:
            raise ModelError("the file is damaged", where=f"byte {at}", found=f"an element of type {body.kind}")
        name, fine = _matrix(body.data, order, budget, 0)
        if name in sound or name in others:
            raise ModelError("a variable stands twice", found=quoted(name))
        (sound if fine and name and not name.startswith("__") else others).append(name)
        at = element.next
    return sound, [name for name in others if name]


def _unpacked(packed: memoryview, budget: _Budget) -> bytes:
    try:
        worker = zlib.decompressobj()
        found = worker.decompress(packed, budget.left + 1)
    except zlib.error as error:
        raise ModelError("a compressed variable is damaged", found=str(error)) from None
    budget.spend(len(found))
    if not worker.eof:
        raise ModelError("a compressed variable is cut")
    return found


def _element(view: memoryview, at: int, order: str, padded: bool = True) -> Element:
    """The element at a place; small ones stand within their tag, others are followed by a gap up to eight bytes."""
    if at + 8 > len(view):
        raise ModelError("the file is cut within a variable")
    kind, count = struct.unpack_from(f"{order}II", view, at)
    if kind >> 16:
        kind, count = kind & 0xFFFF, kind >> 16
        if count > 4:
            raise ModelError("a variable is damaged", found=f"{count} bytes in a place for four")
        return Element(kind, view[at + 4 : at + 4 + count], at + 8)
    end = at + 8 + count
    if end > len(view):
        raise ModelError("the file is cut within a variable", found=f"{len(view) - at} bytes of {count + 8}")
    gap = -count % 8 if padded and kind != COMPRESSED else 0
    return Element(kind, view[at + 8 : end], min(end + gap, len(view)) if gap else end)


def _elements(view: memoryview, order: str) -> Iterator[Element]:
    at = 0
    while at < len(view):
        element = _element(view, at, order)
        yield element
        at = element.next


def _matrix(view: memoryview, order: str, budget: _Budget, depth: int) -> tuple[str, bool]:
    """Name of an array, and whether it is one of numbers or texts, or a structure; its parts are as large as told."""
    if depth > DEPTH:
        raise ModelError("variables are nested too deeply", allowed=f"{DEPTH} levels")
    parts = list(_elements(view, order))
    if not parts:  # an empty field
        return "", True
    if len(parts) < 3 or parts[0].kind != 6 or len(parts[0].data) != 8 or parts[1].kind not in (5, 6):
        return _opaque(parts, order)
    flags = struct.unpack(f"{order}I", parts[0].data[:4])[0]
    name = bytes(parts[2].data).decode("latin-1")
    dims = struct.unpack(f"{order}{len(parts[1].data) // 4}i", parts[1].data[: len(parts[1].data) // 4 * 4])
    if len(dims) < 2 or min(dims) < 0 or len(dims) > 32 or parts[2].kind not in (1, 16):
        raise ModelError("a variable is damaged", where=quoted(name), found=f"dimensions {dims}")
    kind, count = flags & 0xFF, math.prod(dims)
    if kind in _NUMBERS or kind == _CHAR:
        _numbers(parts[3:], count, 2 if flags & 0x800 else 1, name, budget)
        return name, True
    if kind not in (_CELL, _STRUCT):
        return name, False
    return name, _nested(parts[3:], count, kind, order, budget, depth, name)


def _opaque(parts: list[Element], order: str) -> tuple[str, bool]:
    """An object, whose head is another one: it is not read."""
    flags = parts[0].data
    if parts[0].kind == 6 and len(flags) == 8 and struct.unpack(f"{order}I", flags[:4])[0] & 0xFF == 17:
        return bytes(parts[1].data).decode("latin-1") if len(parts) > 1 else "", False
    raise ModelError("a variable is damaged", found="no flags, dimensions and name")


def _numbers(parts: list[Element], count: int, planes: int, name: str, budget: _Budget) -> None:
    """Real and imaginary part are as many values as the dimensions say."""
    budget.spend(8 * count * planes)
    texts = [part.kind in (16, 17, 18) for part in parts[:1]]
    if not count and len(parts) <= planes:
        return
    if len(parts) != planes:
        raise ModelError("a variable is damaged", where=quoted(name), found=f"{len(parts)} parts", allowed=str(planes))
    for part in parts:
        width = _WIDTHS.get(part.kind)
        if width is None or len(part.data) % width or (len(part.data) // width != count and not any(texts)):
            found = f"{len(part.data)} bytes of type {part.kind} for {count} values"
            raise ModelError("a variable is damaged", where=quoted(name), found=found)


def _nested(parts: list[Element], count: int, kind: int, order: str, budget: _Budget, depth: int, name: str) -> bool:
    """Cells and fields are arrays themselves, as many as told; only a structure's are read."""
    wanted = count
    if kind == _STRUCT:
        if len(parts) < 2 or len(parts[0].data) != 4:
            raise ModelError("a structure is damaged", where=quoted(name))
        length = struct.unpack(f"{order}i", parts[0].data)[0]
        if length <= 0 or length > 256 or len(parts[1].data) % length:
            raise ModelError("a structure is damaged", where=quoted(name), found=f"names of {length} letters")
        wanted, parts = count * (len(parts[1].data) // length), parts[2:]
    if len(parts) != wanted or any(part.kind != MATRIX for part in parts):
        raise ModelError("a variable is damaged", where=quoted(name), found=f"{len(parts)} parts, {wanted} announced")
    inner = [_matrix(part.data, order, budget, depth + 1)[1] for part in parts]
    return all(inner)
