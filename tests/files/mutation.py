"""Deterministic damage to a text file: mutant ``index`` of a seed is the same bytes on every machine and in any order.

A test walks ``mutants(text, 1000)``; a long run takes 100 000 and may split them among processes by ``start``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from random import Random

HOSTILE = (
    *(b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"\x1b[31m", b"\xc3\x28", b"\xed\xa0\x80", b"\t", b"\r", b"\xe2\x80\xa8"),
    *(b"&a ", b"*a", b"!!python/object:os.system ", b"<<: ", b"---\n", b"...\n", b"%YAML 1.1\n", b"? ", b"- ", b": "),
    *(b"[" * 40, b"{a: " * 40, b"- " * 40, b'"', b"'", b"|\n", b">\n", b"#", b"@", b"`", b"%", b"\\"),
    *(b"nan", b".nan", b"-.inf", b"1e999", b"1_000", b"0x1F", b"0o17", b"12:30:00", b"yes", b"null", b"1,5", b"9" * 99),
    *(b"<script>alert(1)</script>", b"=1+1", b"../../etc/passwd", b"\xf0\x9f\x9a\x9b", b"k" * 5000),
)


def truncated(data: bytes, random: Random) -> bytes:
    return data[: random.randrange(len(data) + 1)]


def beheaded(data: bytes, random: Random) -> bytes:
    return data[random.randrange(len(data) + 1) :]


def bits_flipped(data: bytes, random: Random) -> bytes:
    mutant = bytearray(data)
    for _ in range(random.choice((1, 1, 1, 2, 8))):
        mutant[random.randrange(len(mutant))] ^= 1 << random.randrange(8)
    return bytes(mutant)


def bytes_inserted(data: bytes, random: Random) -> bytes:
    at = random.randrange(len(data) + 1)
    return data[:at] + random.randbytes(random.randrange(1, 6)) + data[at:]


def hostile_inserted(data: bytes, random: Random) -> bytes:
    at = random.randrange(len(data) + 1)
    return data[:at] + random.choice(HOSTILE) + data[at:]


def bytes_deleted(data: bytes, random: Random) -> bytes:
    at = random.randrange(len(data))
    return data[:at] + data[at + random.randrange(1, 12) :]


def line_deleted(data: bytes, random: Random) -> bytes:
    lines = data.splitlines(keepends=True)
    del lines[random.randrange(len(lines))]
    return b"".join(lines)


def line_repeated(data: bytes, random: Random) -> bytes:
    lines = data.splitlines(keepends=True)
    at = random.randrange(len(lines))
    return b"".join(lines[: at + 1] + lines[at:])


def lines_swapped(data: bytes, random: Random) -> bytes:
    lines = data.splitlines(keepends=True)
    first, second = random.randrange(len(lines)), random.randrange(len(lines))
    lines[first], lines[second] = lines[second], lines[first]
    return b"".join(lines)


def line_moved(data: bytes, random: Random) -> bytes:
    """One line indented or outdented."""
    lines = data.splitlines(keepends=True)
    at = random.randrange(len(lines))
    lines[at] = b" " * random.randrange(1, 4) + lines[at] if random.random() < 0.5 else lines[at].lstrip()
    return b"".join(lines)


def keys_swapped(data: bytes, random: Random) -> bytes:
    """The names of two keys exchanged, their values left where they are."""
    lines = data.splitlines(keepends=True)
    keyed = [i for i, line in enumerate(lines) if b":" in line]
    if len(keyed) < 2:
        return data
    first, second = random.sample(keyed, 2)
    one, two = lines[first].partition(b":"), lines[second].partition(b":")
    lines[first], lines[second] = two[0] + b":" + one[2], one[0] + b":" + two[2]
    return b"".join(lines)


def value_replaced(data: bytes, random: Random) -> bytes:
    """The value of one key replaced by something hostile."""
    lines = data.splitlines(keepends=True)
    at = random.randrange(len(lines))
    lines[at] = lines[at].partition(b":")[0] + b": " + random.choice(HOSTILE) + b"\n"
    return b"".join(lines)


def number_changed(data: bytes, random: Random) -> bytes:
    """One digit replaced by a sign, a digit or a separator."""
    digits = [i for i, byte in enumerate(data) if 48 <= byte <= 57]
    if not digits:
        return data
    at = random.choice(digits)
    return data[:at] + random.choice((b"-", b"0", b"9", b".", b"e", b",", b"_", b"", b" ")) + data[at + 1 :]


def recoded(data: bytes, random: Random) -> bytes:
    encoding = random.choice(("utf-16", "utf-16-le", "utf-32", "utf-8-sig", "utf-7", "cp037"))
    return data.decode("utf-8").encode(encoding, "replace")


MUTATORS: tuple[Callable[[bytes, Random], bytes], ...] = (
    truncated,
    beheaded,
    bits_flipped,
    bits_flipped,
    bytes_inserted,
    hostile_inserted,
    hostile_inserted,
    bytes_deleted,
    line_deleted,
    line_repeated,
    lines_swapped,
    line_moved,
    keys_swapped,
    value_replaced,
    number_changed,
    recoded,
)


def mutant(data: bytes, seed: int, index: int) -> tuple[str, bytes]:
    """The name of the damage done and the damaged bytes; every mutator takes its turn."""
    damage = MUTATORS[index % len(MUTATORS)]
    return damage.__name__, damage(data, Random(f"{seed}:{index}"))


def mutants(data: bytes, count: int, seed: int = 0, start: int = 0) -> Iterator[tuple[str, bytes]]:
    """``count`` mutants of the data, from number ``start`` on."""
    for index in range(start, start + count):
        yield mutant(data, seed, index)
