"""What a worker of a cluster does: chunks of a sweep, which it is sent once, as bytes for who keeps them."""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import pickle
import sys
import threading
import time
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from torsional import __version__
from torsional.studies.sweeps.identity import code
from torsional.studies.sweeps.store import packed

if TYPE_CHECKING:
    from torsional.studies.sweeps.sweep import Pieces

DONE, UNKNOWN, OTHER, UNREAD = "done", "unknown", "other code", "unread"
SWEEPS = 4
"""How many sweeps a worker remembers."""
_SENT: dict[str, bytes] = {}
_READ: dict[str, Pieces] = {}
_ONE = threading.Lock()
"""Caches of the package are a thread's: a worker with several threads works with one of them at a time."""


class Reply(NamedTuple):
    """What a worker says: the ``kind`` of answer, ``found`` chunks or words, ``seconds`` each took, its ``address``."""

    kind: str
    found: Sequence[Any]
    seconds: Sequence[float]
    address: str


def _keep(key: str, sent: bytes) -> None:
    while key not in _SENT and len(_SENT) >= SWEEPS:
        first = next(iter(_SENT))
        _SENT.pop(first)
        _READ.pop(first, None)
    _SENT[key] = sent


def answered(
    own: str, key: str, numbers: Sequence[int], aside: Collection[int], design: int = -1, sent: bytes = b""
) -> Reply:
    """Some chunks of a sweep as bytes, or one ``design`` of it tried, for a driver of the code ``own``.

    ``sent``: the sweep itself, where a worker has said that it does not know it.
    """
    from distributed import get_worker

    address = get_worker().address
    with _ONE:
        if code() != own:
            return Reply(OTHER, [__version__, code()], [], address)
        if sent:
            _keep(key, sent)
        if key not in _SENT:
            return Reply(UNKNOWN, [], [], address)
        try:
            pieces = _read(key)
        except Exception as error:  # whatever the libraries of this machine say against functions of another
            return Reply(UNREAD, [f"{type(error).__name__}: {error}"], [], address)
        if design >= 0:
            pieces.work.stretch(design, design + 1, ())
            return Reply(DONE, [], [], address)
        return _worked(pieces, numbers, aside, address)


def _worked(pieces: Pieces, numbers: Sequence[int], aside: Collection[int], address: str) -> Reply:
    found, seconds = [], []
    for number in numbers:
        begun = time.perf_counter()
        found.append(packed(pieces.figures(number, aside)))
        seconds.append(time.perf_counter() - begun)
    return Reply(DONE, found, seconds, address)


def _read(key: str) -> Pieces:
    if key not in _READ:
        texts, pieces = pickle.loads(_SENT[key])
        for name, text in texts.items():
            here = source(getattr(pieces.work, name))
            if text and here and text != here:
                raise ImportError(f"the function '{name}' has another text here")
        _READ[key] = pieces
    return _READ[key]


def source(function: Any) -> str:
    """A hash of the text of a function that is found by its name, as others may find another there; else nothing."""
    found: Any = sys.modules.get(getattr(function, "__module__", None) or "")
    for part in getattr(function, "__qualname__", "").split("."):
        found = getattr(found, part, None)
    if found is not function or function.__module__ == "__main__":
        return ""
    with contextlib.suppress(OSError, TypeError):
        return hashlib.sha256(inspect.getsource(function).encode()).hexdigest()
    return ""
