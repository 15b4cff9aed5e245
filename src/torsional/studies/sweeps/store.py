"""A store of a sweep's pieces on disk: each whole and checked or not there, whatever ended the work on it.

A store is a folder: the plan as it was given, and one file a chunk under a name that tells plan, chunk and code.  Files
are written beside their place, brought to the disk and moved there; a checksum stands in front of what it is of.  Who
begins again looks at what is there, and two who work on one store write the same bits.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import uuid
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.units import quoted

PLAN, CHUNKS = "plan.json", "chunks"
MAGIC = b"torsional chunk 1\n"
DIGEST = 64


class TornError(Exception):
    """A chunk that is not what was written: cut off, or with a bit turned."""


def digest(value: Any) -> str:
    """The hash of a plain value (mappings, lists, texts, numbers), the same on every machine.

    >>> digest({"a": 1.0, "b": [2]}) == digest({"b": [2], "a": 1.0})
    True
    """
    return hashlib.sha256(json_of(value).encode()).hexdigest()


def json_of(value: Any) -> str:
    """A plain value as one text, keys in order; what is no plain value (an array in an attribute) by its words."""
    return json.dumps(value, sort_keys=True, ensure_ascii=False, default=repr)


def packed(arrays: Mapping[str, np.ndarray]) -> bytes:
    """Arrays as the bytes of a chunk, the same bytes for the same values."""
    body = io.BytesIO()
    for name, values in sorted(arrays.items()):
        head = json.dumps({"name": name, "dtype": values.dtype.str, "shape": values.shape}).encode()
        body.write(len(head).to_bytes(4, "little") + head + np.ascontiguousarray(values).tobytes())
    told = body.getvalue()
    return MAGIC + hashlib.sha256(told).hexdigest().encode() + told


def unpacked(data: bytes) -> dict[str, np.ndarray]:
    """The arrays of a chunk; raises `TornError` where the bytes are not those that were written.

    >>> unpacked(packed({"status": np.zeros(2, np.int8)}))["status"].tolist()
    [0, 0]
    """
    start = len(MAGIC) + DIGEST
    told = data[start:]
    if not data.startswith(MAGIC) or hashlib.sha256(told).hexdigest().encode() != data[len(MAGIC) : start]:
        raise TornError
    return dict(_arrays(told))


def _arrays(told: bytes) -> Iterator[tuple[str, np.ndarray]]:
    at = 0
    while at < len(told):
        size = int.from_bytes(told[at : at + 4], "little")
        head = json.loads(told[at + 4 : at + 4 + size])
        at += 4 + size
        kind = np.dtype(head["dtype"])
        count = int(np.prod(head["shape"], dtype=np.int64))
        yield head["name"], np.frombuffer(told, kind, count, at).reshape(head["shape"])
        at += count * kind.itemsize


@dataclass(frozen=True)
class Store:
    """The folder of a sweep: its ``plan`` (plain values), and the ``code`` that works on it.

    Chunks of another plan or other code are not seen.
    """

    folder: Path
    plan: Mapping[str, Any]
    code: str

    @classmethod
    def begun(cls, folder: str | os.PathLike[str], plan: Mapping[str, Any], code: str) -> Store:
        """The store in a folder, made where it is not there; raises ModelError where that holds another plan."""
        store = cls(Path(folder), plan, code)
        known = plan_in(folder)
        if known is not None and digest(known) != digest(plan):
            remedy = "name another folder, or remove this one"
            raise ModelError("the folder holds the sweep of another plan", where=str(folder), remedy=remedy)
        store.chunks.mkdir(parents=True, exist_ok=True)
        if known is None:
            written(store.folder / PLAN, json_of(plan).encode())
        return store

    @property
    def chunks(self) -> Path:
        """The folder of the chunks."""
        return self.folder / CHUNKS

    @property
    def key(self) -> str:
        """What names of chunks tell of plan and code."""
        return digest([digest(self.plan), self.code])[:16]

    def path(self, number: int) -> Path:
        """Where a chunk lies."""
        return self.chunks / f"{number:08d}-{self.key}.chunk"

    def put(self, number: int, arrays: Mapping[str, np.ndarray]) -> None:
        """Keep a chunk; raises OSError where the disk is full, and leaves nothing half-written under its name."""
        self.keep(number, packed(arrays))

    def keep(self, number: int, data: bytes) -> None:
        """Keep a chunk that was `packed` elsewhere."""
        written(self.path(number), data)

    def get(self, number: int) -> dict[str, np.ndarray] | None:
        """A chunk; None where it is not there or not whole."""
        try:
            return unpacked(self.path(number).read_bytes())
        except (FileNotFoundError, TornError):
            return None

    def missing(self, count: int) -> list[int]:
        """The numbers of chunks, of ``count``, that are not there or not whole."""
        return [number for number in range(count) if self.get(number) is None]


def plan_in(folder: str | os.PathLike[str]) -> dict[str, Any] | None:
    """The plan that a folder holds; None where it holds none.  Raises ModelError for one that cannot be read."""
    path = Path(folder) / PLAN
    try:
        text = path.read_text(encoding="utf-8")
        plan = json.loads(text)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise ModelError("the plan of the sweep cannot be read", where=str(path), found=quoted(error)) from None
    if not isinstance(plan, dict):
        raise ModelError("the plan of the sweep is not one", where=str(path), found=quoted(text[:40]))
    return plan


def written(path: Path, data: bytes) -> None:
    """Bytes under a name, all of them or none, also where the machine stops in the middle."""
    draft = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    try:
        with draft.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise
    _settled(path.parent)


def _settled(folder: Path) -> None:
    """Bring a folder's entries to the disk, where the system lets folders be opened."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:  # Windows
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
