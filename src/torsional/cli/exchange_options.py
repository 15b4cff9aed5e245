"""Options of the commands that speak to other tools."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from torsional.cli.options import taking

AbsorberAlone = Annotated[bool, typer.Option("--absorber", help="The absorber alone, between its two sides.")]
InputNodes = Annotated[
    list[str] | None,
    taking(
        "--input",
        "-i",
        metavar="NODE",
        help="A node on which a torque comes from outside; may be repeated; default: throws and load.",
    ),
]
TorqueWithin = Annotated[
    str,
    taking(
        "--torque",
        "-t",
        metavar="TORQUE",
        help="Mean engine torque in Nm, or with its unit as 1.2kNm, whose orders drive the unit from within; "
        "default: no engine within.",
    ),
]
FmiVersion = Annotated[str, typer.Option("--fmi", metavar="VERSION", help="Version of FMI: 2.0 or 3.0.")]
SourcesOnly = Annotated[bool, typer.Option("--sources", help="The C sources alone, without a binary.")]
FmuFile = Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="The unit to write, ending in .fmu.")]
LineTable = Annotated[
    Path, typer.Argument(metavar="TABLE", help="Table (.csv) or assembly of openTorsion (.json).", show_default=False)
]
