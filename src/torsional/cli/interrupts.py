"""Ctrl-C: it stops the work wherever it is, also where a library swallows the exception that it raises."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_received = threading.Event()


class Kept(KeyboardInterrupt):
    """Ctrl-C after which what had been reached was handed back; the message says how far that was."""


def _receive(_number: int, _frame: FrameType | None) -> None:
    _received.set()
    raise KeyboardInterrupt


def taken() -> None:
    """A Ctrl-C has been answered: what was reached may be written."""
    _received.clear()


def _here() -> bool:
    return threading.current_thread() is threading.main_thread()


@contextmanager
def listening() -> Iterator[None]:
    """Remember a Ctrl-C while a command runs: an exception raised inside compiled code's callbacks can get lost."""
    _received.clear()
    if not _here() or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, _receive)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Ctrl-C waits for the few moments in which files are moved to their places; an earlier one that got lost stops."""
    if _received.is_set():
        raise KeyboardInterrupt
    if not _here():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
