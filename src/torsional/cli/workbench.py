"""`torsional workbench`: serves the page on which a model answers while its values are turned."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path

from torsional.cli.interrupts import taken
from torsional.workbench import start


def run(
    model: Path | None,
    host: str,
    port: int | None,
    token: str,
    no_browser: bool,
    processes: int,
    results: Sequence[Path] | None,
) -> None:
    """Answer the command: it ends with Ctrl-C, by which nothing is lost."""
    asked = start.Asked(
        model=model,
        host=host or start.HOST,
        port=start.PORT if port is None else port,
        token=token,
        browser=not no_browser,
        processes=processes,
        results=tuple(results or ()),
    )
    with contextlib.suppress(KeyboardInterrupt):
        start.served(asked, _listening)
    taken()
    print("\nThe workbench has ended.")


def _listening(address: str) -> None:
    print(f"The workbench is at {address}\nCtrl-C ends it.", flush=True)
