"""The command for hysteresis loops: what it takes."""

from __future__ import annotations

from typing import Annotated

import typer

from torsional.cli import options as o
from torsional.cli.jobs import Job, analysis


def hysteresis(
    model: o.ModelFile,
    gear: o.Gear = "",
    speed: Annotated[
        str,
        typer.Option(
            "--speed",
            "-s",
            metavar="SPEEDS",
            help="Rotational speeds, as 0,2000,4000rpm or 0:4000:500rpm; default: 0, 2000, 4000 rpm.",
            show_default=False,
        ),
    ] = "",
    sweep: Annotated[
        str,
        typer.Option(
            "--sweep",
            metavar="ANGLES",
            help="How far it is turned to either side, as 60deg or 5,20,60deg; default: up to the stop, or 60°.",
            show_default=False,
        ),
    ] = "",
    rate: Annotated[
        str, typer.Option("--rate", metavar="PACE", help="How fast, as 3deg/s, the default.", show_default=False)
    ] = "",
    about: Annotated[
        str,
        typer.Option(
            "--about", metavar="ANGLE", help="The angle in the middle of the sweep; default: 0.", show_default=False
        ),
    ] = "",
    turned: Annotated[
        str,
        typer.Option(
            "--turned",
            metavar="NODE",
            help="The node that is turned; default: the flywheel on the crankshaft.",
            show_default=False,
        ),
    ] = "",
    held: Annotated[
        str,
        typer.Option(
            "--held",
            metavar="NODE",
            help="The node it is turned against; default: the flywheel that carries the clutch.",
            show_default=False,
        ),
    ] = "",
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Hysteresis loops of the absorber under a slow sweep.

    Torque over angle at any rotational speed: stiffness, loss per cycle, loss factor, which elements slide and which
    stick.
    """
    return analysis("hysteresis", locals())
