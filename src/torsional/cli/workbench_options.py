"""The options of `torsional workbench`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from torsional.cli.options import taking

FirstModel = Annotated[
    Path | None,
    typer.Argument(metavar="MODEL", help="Model file to begin with; default: the shipped truck.", show_default=False),
]
Host = Annotated[
    str,
    taking("--host", metavar="ADDRESS", help="Address of this machine to listen at; default: 127.0.0.1, itself alone."),
]
Port = Annotated[
    int | None,
    typer.Option(
        "--port", metavar="N", min=0, max=65535, help="Port; 0 takes a free one; default: 8210.", show_default=False
    ),
]
Token = Annotated[
    str,
    taking("--token", metavar="TEXT", help="What requests must bring; default: none, or one made up with --host."),
]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Open no browser, tell the address only.")]
AnsweringProcesses = Annotated[
    int,
    typer.Option(
        "--processes",
        metavar="N",
        min=0,
        max=64,
        help="Processes that answer side by side; default: one a core, two at most.",
        show_default=False,
    ),
]
Results = Annotated[
    list[Path] | None,
    taking("--results", metavar="FILE", help="A sweep's or optimisation's result (.nc) to browse; repeatable."),
]
