"""Compiled code that is kept on disk is thrown away once the source of any of it has changed.

Numba looks at the file of a function alone, not at those of what it calls: after an update of the package it may join
old code to new, which ends the process.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Sequence
from pathlib import Path

COMPILED = ("numerics", "laws", "studies/claims")
"""Folders of the package with compiled functions, at any depth."""
STAMP = "compiled_from"


def discard_outdated(package: Path, folders: Sequence[str] = COMPILED) -> int:
    """Remove what numba keeps in the folders of a ``package`` unless it was made from these sources; how many files.

    Where the folders cannot be written numba keeps its files elsewhere, and nothing is done.
    """
    told = hashlib.sha256()
    for folder in folders:
        for source in sorted((package / folder).rglob("*.py")):
            told.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    stamp = package / folders[0] / "__pycache__" / STAMP
    with contextlib.suppress(OSError):
        if stamp.is_file() and stamp.read_text(encoding="ascii") == told.hexdigest():
            return 0
        kept = [file for folder in folders for file in (package / folder).rglob("*.nb[ic]")]
        for file in kept:
            file.unlink(missing_ok=True)
        stamp.parent.mkdir(exist_ok=True)
        new = stamp.with_suffix(f".{os.getpid()}")
        new.write_text(told.hexdigest(), encoding="ascii")
        new.replace(stamp)  # last, so that whoever reads it finds no outdated code
        return len(kept)
    return 0
