"""Frames: what the page is answered with, a header in JSON and the numbers as they are in memory.

uint32 little endian: bytes of the header; the header in UTF-8, blanks at its end so that the numbers begin at a
multiple of eight bytes; the numbers as float64 little endian.  An array stands in the header as
``{"$array": [offset, shape]}``, its offset counted in numbers.  NaN is no value; a figure arrives with the bits it was
worked out with.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

ARRAY = "$array"


def encoded(content: Mapping[str, Any]) -> bytes:
    """A frame of mappings, lists, texts, numbers and arrays.

    >>> decoded(encoded({"speed": np.array([62.8]), "name": "truck"}))
    {'speed': array([62.8]), 'name': 'truck'}
    """
    arrays: list[np.ndarray[Any, Any]] = []
    header = json.dumps(_referring(content, arrays, [0]), ensure_ascii=False, allow_nan=False).encode()
    header += b" " * (-(4 + len(header)) % 8)
    return b"".join([struct.pack("<I", len(header)), header, *(array.tobytes() for array in arrays)])


def decoded(frame: bytes) -> Any:
    """What a frame was made of."""
    (size,) = struct.unpack_from("<I", frame)
    return _restored(json.loads(frame[4 : 4 + size]), np.frombuffer(frame, "<f8", offset=4 + size))


def _referring(value: Any, arrays: list[np.ndarray[Any, Any]], end: list[int]) -> Any:
    """The value with its arrays put behind the header; plain numbers that are no numbers become null."""
    if isinstance(value, Mapping):
        return {str(key): _referring(item, arrays, end) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_referring(item, arrays, end) for item in value]
    if isinstance(value, np.ndarray):
        arrays.append(np.ascontiguousarray(value, dtype="<f8"))
        start, end[0] = end[0], end[0] + value.size
        return {ARRAY: [start, list(value.shape)]}
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _restored(value: Any, numbers: np.ndarray[Any, Any]) -> Any:
    if isinstance(value, list):
        return [_restored(item, numbers) for item in value]
    if not isinstance(value, dict):
        return value
    if ARRAY in value:
        start, shape = value[ARRAY]
        return numbers[start : start + int(np.prod(shape))].reshape(shape)
    return {key: _restored(item, numbers) for key, item in value.items()}
