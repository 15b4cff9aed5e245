"""What goes wrong becomes one sentence on stderr and an exit code; tracebacks only where they are asked for."""

from __future__ import annotations

import gc
import os
import sys
import traceback
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from torsional.cli.interrupts import Kept, listening
from torsional.errors import TorsionalError

DONE, FAILED, MENDABLE, PARTLY, STOPPED, UNREAD = 0, 1, 2, 3, 130, 141
DEBUG = "TORSIONAL_DEBUG"


def guarded(arguments: Sequence[str] | None) -> int:
    """Run the command with every failure told; the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal without the letter shows '?' and goes on
            stream.reconfigure(errors="replace")
    if arguments is None:
        for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):  # read once, when numpy is imported
            os.environ.setdefault(name, "1")
    with warnings.catch_warnings(), _seldom_collected(ending=arguments is None), listening():
        warnings.showwarning = _show_warning
        try:
            return _run(list(sys.argv[1:] if arguments is None else arguments))
        except BaseException as failure:  # every failure has its sentence
            return told(failure)


class UnansweredError(Exception):
    """The work is done and written, but a part of what was asked has no answer; the message says which."""


@contextmanager
def _seldom_collected(ending: bool) -> Iterator[None]:
    """Cyclic garbage is looked for seldom, and not at all where the process is ``ending``: a third of a second saved.

    Most of it is the hundreds of modules of the packages below, walked through again and again while they are imported
    and once more before Python ends.
    """
    before = gc.get_threshold()
    gc.set_threshold(200_000, 20, 100)
    try:
        yield
    finally:
        gc.set_threshold(*before)
        if ending:
            gc.freeze()


def _run(arguments: list[str]) -> int:
    from torsional.cli.app import HELP, command

    program, path = command(), "torsional"
    while arguments and arguments[0] in getattr(program, "commands", ()):
        path = f"{path} {arguments[0]}"  # straight to it: typer would first work through the group's own
        program, arguments = program.commands[arguments[0]], arguments[1:]
    if not arguments and hasattr(program, "list_commands"):
        arguments = ["--help"]
    try:
        job: Any = program(args=arguments, prog_name=path, standalone_mode=False, help_option_names=HELP)
    except Exception as failure:
        failure.command_path = path  # type: ignore[attr-defined]  # some of typer's own do not know where they arose
        raise
    if callable(job):
        job()
    sys.stdout.flush()  # a reader that is gone is met here, not while Python shuts down
    return job if isinstance(job, int) else DONE


def told(failure: BaseException) -> int:
    """Say on stderr what went wrong; the exit code."""
    if os.environ.get(DEBUG) and not isinstance(failure, SystemExit):
        traceback.print_exception(failure)
    for kinds, answer in _ANSWERS:
        if isinstance(failure, kinds):
            return answer(failure)
    if hasattr(failure, "exit_code"):  # raised by typer, whose classes have moved between its versions
        return _usage(failure)
    remedy = "" if os.environ.get(DEBUG) else f"; {DEBUG}=1 in the environment shows where"
    complain(f"this should not have happened: {type(failure).__name__}: {failure}{remedy}")
    return FAILED


def complain(message: str, kind: str = "error") -> None:
    """A sentence on stderr, or several below each other."""
    print(f"{kind}: {chr(10).join(map(clean, message.split(chr(10))))}", file=sys.stderr)


def clean(text: object) -> str:
    """A text as it may be printed: control characters, which could steer a terminal, are escaped."""
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in str(text))


def _mendable(failure: BaseException) -> int:
    complain(str(failure))
    return MENDABLE


def _stopped(_: BaseException) -> int:
    print("stopped, nothing written", file=sys.stderr)
    return STOPPED


def _kept(failure: BaseException) -> int:
    complain(str(failure), kind="stopped")
    return STOPPED


def _unread(_: BaseException) -> int:
    """Nobody reads stdout any more (| head): be silent, also in the flush while Python shuts down."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return UNREAD


def _partly(failure: BaseException) -> int:
    complain(str(failure), kind="warning")
    return PARTLY


def _full_memory(_: BaseException) -> int:
    complain("there is not enough memory for this; ask for fewer speeds, torques, orders or gears")
    return FAILED


def _unwritable(failure: BaseException) -> int:
    """A full disk, a device that is gone: nothing a traceback would explain."""
    path = getattr(failure, "filename", None)
    reason = getattr(failure, "strerror", None) or str(failure)
    complain(f"{path}: {reason}" if path else f"the system says: {reason}")
    return FAILED


def _exits(failure: BaseException) -> int:
    code = getattr(failure, "code", None)
    return code if isinstance(code, int) else DONE if code is None else FAILED


_ANSWERS: tuple[tuple[type[BaseException], Callable[[BaseException], int]], ...] = (
    (TorsionalError, _mendable),
    (UnansweredError, _partly),
    (Kept, _kept),
    (KeyboardInterrupt, _stopped),
    (BrokenPipeError, _unread),
    (MemoryError, _full_memory),
    (OSError, _unwritable),
    (SystemExit, _exits),
)


def _usage(failure: Any) -> int:
    """Typer's exceptions: an early exit, an abort, or a line that cannot be read."""
    if not hasattr(failure, "format_message"):
        return int(failure.exit_code)
    context = getattr(failure, "ctx", None)
    path = context.command_path if context is not None else getattr(failure, "command_path", "torsional")
    message = " ".join(failure.format_message().split()).rstrip(".")
    wanted = getattr(getattr(failure, "param", None), "help", None) or "" if message.startswith("Missing") else ""
    complain(f"{message}{': ' if wanted else ''}{wanted.rstrip('.')} (see '{path} --help')")
    return MENDABLE


def _show_warning(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    complain(str(message), kind="warning")
