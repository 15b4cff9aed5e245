"""Arguments and options of the commands that hold models against measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from torsional.cli.options import taking

Identification = Annotated[
    Path, typer.Argument(metavar="PLAN", help="Plan of an identification (YAML or JSON).", show_default=False)
]
MeasuredOrders = Annotated[
    Path,
    typer.Argument(metavar="MEASURED", help="Measured orders: a table (.csv), or a result (.nc).", show_default=False),
]
ComputedOrders = Annotated[
    Path, typer.Argument(metavar="COMPUTED", help="A result (.nc), or a model file.", show_default=False)
]
AmplitudeKind = Annotated[
    str,
    taking("--amplitude", metavar="KIND", help="What a table tells: 0-peak, RMS or peak-to-peak; default: 0-peak."),
]
