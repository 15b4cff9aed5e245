"""The options of `torsional orders`, each told once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from torsional.cli.options import taking

Recording = Annotated[
    Path, typer.Argument(metavar="FILE", help="Measurement file: MDF, UFF, MATLAB, Parquet, CSV.", show_default=False)
]
Tacho = Annotated[
    str, taking("--tacho", metavar="CHANNEL", help="The channel that tells how the engine turns; its orders come too.")
]
Wheel = Annotated[
    str, taking("--wheel", metavar="TEETH", help="Its pulses or counts a turn, as 60, or 60-2 with a gap of two teeth.")
]
TachoKind = Annotated[
    str,
    taking(
        "--kind",
        metavar="KIND",
        help="What it is: voltage, pulses, counter, angle, speed; default: by its unit and values.",
    ),
]
Ratio = Annotated[
    str, taking("--ratio", metavar="N", help="Its speed over the engine's, as 0.5 on a camshaft; default: 1.")
]
Index = Annotated[
    str,
    taking("--index", metavar="ANGLE", help="Crank angle in degrees of the first tooth behind its gap; default: 0."),
]
Marks = Annotated[
    str,
    taking("--marks", metavar="CHANNEL", help="A pulse at each firing of cylinder 1: zero of phases, half orders too."),
]
Channels = Annotated[
    list[str] | None,
    taking("--channel", "-c", metavar="NAME", help="A signal to look at, or 'all'; may be repeated."),
]
Shafts = Annotated[
    list[str] | None,
    taking(
        "--shaft",
        metavar="CHANNEL=TEETH",
        help="A further shaft with its own wheel, as n_gearbox=90; without =TEETH for angles and speeds. May be "
        "repeated.",
    ),
]
Tracked = Annotated[
    str, taking("--orders", "-n", metavar="ORDERS", help="As 1.5,3 or 0.5:12:0.5; default: half orders up to 12.")
]
Cycles = Annotated[str, taking("--cycles", metavar="N", help="Cycles of 720° in a window; default: 4.")]
Window = Annotated[
    str, taking("--window", metavar="NAME", help="hann, or none for orders of steady size; default: hann.")
]
Amplitudes = Annotated[str, taking("--amplitude", metavar="NAME", help="0-peak, RMS or peak-to-peak; default: 0-peak.")]
ShaftsAs = Annotated[
    str,
    taking(
        "--as", metavar="NAME", help="Shafts in tables and pictures: angle, velocity, acceleration; default: angle."
    ),
]
Picture = Annotated[
    str,
    taking(
        "--picture",
        metavar="NAME",
        help="What .png and .svg show: orders, map, waterfall, frequencies, speed; default: orders.",
    ),
]
