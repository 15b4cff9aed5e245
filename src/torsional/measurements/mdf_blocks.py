"""The blocks of an MDF 4 file, walked through before a library reads them: lengths, links, records, sizes.

Damage and malice are found here: blocks outside the file, chains that bite their own tail, channels beyond their
record, compressed blocks that swell, records that are not there.  Layout: ASAM MDF 4.1, "Measurement Data Format".
"""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

from torsional.errors import ModelError
from torsional.measurements.recording import VALUES, bounded

HEADER = 64
BLOCKS = 2_000_000
NESTED = 20
TEXT = 1_000_000
"""Bytes of one text."""
RAW = 8 * VALUES
"""Bytes of records, unpacked."""
_STRANGE = re.compile(r"[^A-Za-z0-9_\s+\-*/^().,]|__|\.\s*(?![eE][+-]?\d)[A-Za-z_]")
"""What no formula has: other marks, and a point before a name."""
_KINDS, _VIRTUAL, _FORMS = range(7), (3, 6), range(17)
"""Types of channels, those that stand in no record, and types of data."""


@dataclass(frozen=True)
class Block:
    """A block: where it is, its identifier, its links, and the bytes behind them."""

    at: int
    kind: str
    links: tuple[int, ...]
    begin: int
    size: int


class Walk:
    """A walk over all blocks of a file's bytes; raises ModelError for the first that cannot be."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self._seen: set[int] = set()
        self._numbers = 0
        self._raw = 0

    def whole(self) -> None:
        """Walk through everything that is read later."""
        if self.data[60:62] != b"\0\0":
            remedy = "open and save it once in the program that recorded it"
            raise ModelError("the recording was not finished properly", remedy=remedy)
        header = self.block(HEADER, "HD")
        if len(header.links) != 6 or header.size < 32:
            raise ModelError("the head of the file is damaged", found=f"{len(header.links)} links", allowed="6")
        for link, kind in ((1, "FH"), (3, "AT"), (4, "EV")):
            for block in self._chain(_link(header, link), kind):
                self._text(_link(block, 1 if kind == "FH" else 3))
        for group in self._chain(_link(header, 0), "DG"):
            self._data_group(group)
        self._text(_link(header, 5))

    def block(self, at: int, *kinds: str) -> Block:
        """The block at a place, of one of the ``kinds``; its links and its bytes lie inside the file."""
        if not HEADER <= at <= len(self.data) - 24:
            raise ModelError("the file is cut: a block lies beyond its end", found=f"a link to byte {at}")
        name, length, count = struct.unpack_from("<4s4xQQ", self.data, at)
        kind = name[2:].decode("latin-1")
        if name[:2] != b"##" or (kinds and kind not in kinds):
            wanted = " or ".join(kinds) or "a block"
            raise ModelError("a block is damaged", where=f"byte {at}", found=repr(name)[1:], allowed=wanted)
        if length < 24 + 8 * count or at + length > len(self.data):
            raise ModelError("the file is cut within a block", where=f"byte {at}", found=f"{kind} of {length} bytes")
        links = struct.unpack_from(f"<{count}Q", self.data, at + 24)
        begin = at + 24 + 8 * count
        return Block(at, kind, links, begin, at + length - begin)

    def _once(self, block: Block) -> None:
        if block.at in self._seen or len(self._seen) > BLOCKS:
            raise ModelError("blocks refer to each other in a circle", where=f"byte {block.at}", found=block.kind)
        self._seen.add(block.at)

    def _chain(self, at: int, *kinds: str) -> Iterator[Block]:
        while at:
            block = self.block(at, *kinds)
            self._once(block)
            yield block
            at = _link(block, 0)

    def _data_group(self, group: Block) -> None:
        self._text(_link(group, 3))
        wanted, number = 0, self._unpack("<B", group)[0]  # bytes of the number in front of records that alternate
        for records in self._chain(_link(group, 1), "CG"):
            cycles, size = self._channel_group(records)
            wanted += cycles * (size + number)
        there = self._bytes_of(_link(group, 2))
        self._raw += there
        if self._raw > RAW:
            raise ModelError("the recording is too large", found=f"{self._raw} bytes", allowed=f"{RAW} bytes")
        if there < wanted:
            found = f"{there} bytes of records where {wanted} are announced"
            raise ModelError("the file is cut: records are missing", found=found)

    def _channel_group(self, records: Block) -> tuple[int, int]:
        """Number and size of the records of a group, whose channels must lie within them."""
        _, cycles, flags, _, data, invalid = self._unpack("<QQHH4xII", records)
        self._whole_links(records, 2, 3, 4)
        self._text(_link(records, 5))
        if flags & 1:  # texts of other channels, of any length
            return 0, 0
        count = self._channels(_link(records, 1), data, invalid, 0)
        self._numbers += cycles * max(count, 1)
        bounded(self._numbers)
        return cycles, data + invalid

    def _channels(self, at: int, record: int, invalid: int, depth: int) -> int:
        if depth > NESTED:
            raise ModelError("channels are nested too deeply", allowed=f"at most {NESTED} levels")
        count = 0
        for channel in self._chain(at, "CN"):
            self._fits(channel, record, invalid)
            self._whole_links(channel, 2, 3, 4, 5)
            for link in (6, 7):
                self._text(_link(channel, link))
            self._formula(_link(channel, 4))
            inner = _link(channel, 1)
            if inner and self.block(inner, "CN", "CA").kind == "CN":
                count += self._channels(inner, record, invalid, depth + 1)
            count += 1
        return count

    def _whole_links(self, block: Block, *numbers: int) -> None:
        """Blocks that are read for their words stand in the file."""
        for at in (_link(block, number) for number in numbers):
            if at:
                self.block(at)

    def _fits(self, channel: Block, record: int, invalid: int) -> None:
        kind, _, form, first, offset, bits, flags, invalid_bit = self._unpack("<BBBBIIII", channel)
        if kind not in _KINDS or form not in _FORMS or first > 7:
            found = f"type {kind}, data type {form}, bit {first}"
            raise ModelError("a channel is damaged", where=f"byte {channel.at}", found=found)
        real = form in (4, 5)
        wide = form <= 5 and not (bits in (16, 32, 64) and first == 0 if real else 0 < bits <= 64 - first)
        beyond = offset + (first + bits + 7) // 8 > record
        if (kind not in _VIRTUAL and (beyond or wide)) or (flags & 2 and invalid_bit >= 8 * invalid):
            found = f"bits {8 * offset + first} to {8 * offset + first + bits} of {8 * record}"
            raise ModelError("a channel lies outside its record", where=f"byte {channel.at}", found=found)

    def _formula(self, at: int) -> None:
        """Conversions by a formula hold nothing but reckoning."""
        if not at:
            return
        block = self.block(at, "CC")
        self._whole_links(block, *range(len(block.links)))
        if self._unpack("<B", block)[0] != 3:
            return
        text = self._read_text(_link(block, 4))
        if _STRANGE.search(text):
            raise ModelError("a conversion is no formula", where=f"byte {at}", found=repr(text[:60]))

    def _text(self, at: int) -> None:
        """Comments are plain XML: what could swell or read other files while it is parsed is refused."""
        if at and "<!" in self._read_text(at).replace("<!--", "").replace("<![CDATA[", ""):
            raise ModelError("a comment declares entities, which are not read", where=f"byte {at}")

    def _read_text(self, at: int) -> str:
        if not at:
            return ""
        block = self.block(at, "TX", "MD")
        if block.size > TEXT:
            raise ModelError("a text is too long", where=f"byte {at}", found=f"{block.size} bytes")
        return self.data[block.begin : block.begin + block.size].split(b"\0")[0].decode("utf-8", "replace")

    def _bytes_of(self, at: int) -> int:
        """Bytes of records behind a link, unpacked."""
        if not at:
            return 0
        block = self.block(at, "DT", "SD", "RD", "DV", "DZ", "DL", "HL", "LD")
        self._once(block)
        if block.kind in ("DT", "SD", "RD", "DV"):
            return block.size
        if block.kind == "DZ":
            return self._unzipped(block)
        if block.kind == "HL":
            return self._bytes_of(_link(block, 0))
        return self._listed(block)

    def _listed(self, block: Block) -> int:
        total, first = 0, block
        for each in self._from(first):
            total += sum(map(self._bytes_of, filter(None, each.links[1:])))
            if total > RAW:
                raise ModelError("the recording is too large", found=f"over {total} bytes", allowed=f"{RAW} bytes")
        return total

    def _from(self, block: Block) -> Iterator[Block]:
        yield block
        yield from self._chain(_link(block, 0), block.kind)

    def _unzipped(self, block: Block) -> int:
        _, kind, _, size, packed = self._unpack("<2sBxIQQ", block)
        if kind not in (0, 1):
            remedy = "save the recording as version 4.10 or 4.20"
            raise ModelError("data compressed in this way are not read", found=f"method {kind}", remedy=remedy)
        if packed > block.size - 24 or size > min(RAW, 1100 * packed + 1024):
            raise ModelError("a compressed block is damaged", where=f"byte {block.at}", found=f"{size} bytes")
        begin = block.begin + 24
        try:
            found = len(zlib.decompressobj().decompress(self.data[begin : begin + packed], size + 1))
        except zlib.error as error:
            raise ModelError("a compressed block is damaged", where=f"byte {block.at}", found=str(error)) from None
        if found != size:
            told = f"{found if found < size else f'over {size}'} bytes, {size} announced"
            raise ModelError("a compressed block is damaged", where=f"byte {block.at}", found=told)
        return int(size)

    def _unpack(self, form: str, block: Block) -> tuple[int, ...]:
        if struct.calcsize(form) > block.size:
            raise ModelError("a block is damaged", where=f"byte {block.at}", found=f"{block.kind} too short")
        return struct.unpack_from(form, self.data, block.begin)


def _link(block: Block, number: int) -> int:
    return block.links[number] if number < len(block.links) else 0
