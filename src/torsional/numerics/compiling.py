"""A word to whoever waits for the compiler: one line, once a process, and only where somebody is looking."""
# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator
from typing import Any

from numba.core import event

PATIENCE = 1.5
"""Seconds of compiling before a word is said."""
WORD = "torsional: compiling for the first use of this version, up to a minute; `torsional warmup` does it beforehand"


class Watch(event.Listener):
    """Counts the time that this package's functions take to compile; those kept on disk are no events.

    Numba holds its lock while it compiles, so that events of several threads come one compilation after the other.
    """

    def __init__(self) -> None:
        self.spent = 0.0
        self.told = False
        self._begun: list[float] = []
        self._silences = 0

    @contextlib.contextmanager
    def silent(self, wanted: bool = True) -> Iterator[None]:
        """Within it nothing is said, if that is ``wanted``."""
        self._silences += wanted
        try:
            yield
        finally:
            self._silences -= wanted

    def on_start(self, event: Any) -> None:
        """A compilation begins, within another one where a compiled function calls a second."""
        if not _ours(event):
            return
        now = time.perf_counter()
        self._begun.append(now)
        if self.spent + now - self._begun[0] > PATIENCE and not (self.told or self._silences) and watched():
            self.told = True
            with contextlib.suppress(OSError, ValueError):  # whoever looked has gone
                print(WORD, file=sys.stderr, flush=True)

    def on_end(self, event: Any) -> None:
        """It is done."""
        if _ours(event) and self._begun:
            begun = self._begun.pop()
            self.spent += 0.0 if self._begun else time.perf_counter() - begun


WATCH = Watch()
"""The one watch of this process."""
event.register("numba:compile", WATCH)


def watched() -> bool:
    """Whether somebody sees stderr: a terminal, or the notebook of one who could be asked for input.

    Notebooks that run by themselves, for pages of documentation say, could not.
    """
    stream = sys.stderr  # None in a process without any
    return stream is not None and not stream.closed and (stream.isatty() or _notebook())


def _notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return bool(getattr(getattr(shell, "kernel", None), "_allow_stdin", False))


def _ours(event: Any) -> bool:
    function = getattr(event.data["dispatcher"], "py_func", None)
    return str(getattr(function, "__module__", "")).partition(".")[0] == __name__.partition(".")[0]
