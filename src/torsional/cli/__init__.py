"""The command `torsional`: a thin face of the same functions that Python calls."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code: 0 done, 1 our fault, 2 the user's to mend, 130 stopped.

    ``arguments`` are those after the program's name (default: those of the process).
    """
    from torsional.cli.failures import guarded

    return guarded(arguments)
