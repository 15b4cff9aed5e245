"""An MDF 4.10 file written byte by byte after the standard: two groups whose records alternate, as of bus loggers."""

from __future__ import annotations

import struct
from collections.abc import Sequence


class Blocks:
    """Blocks one behind the other, each known by where it begins."""

    def __init__(self) -> None:
        self.data = b"MDF     4.10    byhand  " + bytes(4) + struct.pack("<H", 410) + bytes(34)
        self.data += self._block(
            "HD", [0] * 6, struct.pack("<QhhBBBBdd", 1_700_000_000 * 10**9, 60, 0, 2, 0, 0, 0, 0, 0)
        )

    @staticmethod
    def _block(kind: str, links: Sequence[int], body: bytes) -> bytes:
        size = 24 + 8 * len(links) + len(body)
        head = b"##" + kind.encode() + bytes(4) + struct.pack("<QQ", size, len(links))
        return head + struct.pack(f"<{len(links)}Q", *links) + body + bytes(-size % 8)

    def add(self, kind: str, links: Sequence[int] = (), body: bytes = b"") -> int:
        """A block at the end; where it begins."""
        at = len(self.data)
        self.data += self._block(kind, links, body)
        return at

    def text(self, text: str) -> int:
        """A text."""
        return self.add("TX", (), text.encode() + b"\0")

    def channel(
        self, name: str, unit: str, kind: tuple[int, int, int], place: tuple[int, int, int], following: int
    ) -> int:
        """A channel: (type, synchronisation, data type), (first bit, first byte, bits)."""
        first, offset, bits = place
        body = struct.pack("<BBBBIIIIBBH6d", *kind, first, offset, bits, 0, 0, 0, 0, 0, *[0.0] * 6)
        return self.add("CN", [following, 0, self.text(name), 0, 0, 0, self.text(unit), 0], body)


def unsorted(fast: Sequence[tuple[float, int]], slow: Sequence[tuple[float, float]]) -> bytes:
    """Times and 12-bit numbers in bits 2 to 13 of two bytes, times and single floats, one record of each in turn."""
    b = Blocks()
    value = b.channel("level", "mm", (0, 0, 0), (2, 8, 12), 0)
    time = b.channel("t", "s", (2, 1, 4), (0, 0, 64), value)
    single = b.channel("T", "Nm", (0, 0, 4), (0, 8, 32), 0)
    other = b.channel("t", "s", (2, 1, 4), (0, 0, 64), single)
    second = b.add("CG", [0, other, b.text("slow"), 0, 0, 0], struct.pack("<QQHH4xII", 2, len(slow), 0, 0, 12, 0))
    first = b.add("CG", [second, time, b.text("fast"), 0, 0, 0], struct.pack("<QQHH4xII", 1, len(fast), 0, 0, 10, 0))
    records = b""
    for i in range(max(len(fast), len(slow))):
        records += b"\1" + struct.pack("<dH", fast[i][0], fast[i][1] << 2 | 0xC003) if i < len(fast) else b""
        records += b"\2" + struct.pack("<df", *slow[i]) if i < len(slow) else b""
    group = b.add("DG", [0, first, b.add("DT", (), records), 0], struct.pack("<B7x", 1))
    return b.data[: 64 + 24] + struct.pack("<Q", group) + b.data[64 + 32 :]
