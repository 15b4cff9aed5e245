"""The arguments and options that commands share, each told once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ModelFile = Annotated[Path, typer.Argument(metavar="MODEL", help="Model file (.yaml or .json).", show_default=False)]
Gear = Annotated[
    str,
    typer.Option("--gear", "-g", metavar="NAME", help="Gear by its name; default: the last one.", show_default=False),
]
Gears = Annotated[
    str,
    typer.Option(
        "--gear",
        "-g",
        metavar="NAMES",
        help="Gear, several as 10,11,12, or 'all'; default: the last one.",
        show_default=False,
    ),
]
Torque = Annotated[
    str,
    typer.Option(
        "--torque",
        "-t",
        metavar="TORQUE",
        help="Mean engine torque, as '1200 Nm'; default: full load.",
        show_default=False,
    ),
]
Torques = Annotated[
    str,
    typer.Option(
        "--torque",
        "-t",
        metavar="RANGE",
        help="Mean torques, as '0:2500:100 Nm'; default: up to full load.",
        show_default=False,
    ),
]
Speed = Annotated[
    str,
    typer.Option(
        "--speed",
        "-s",
        metavar="SPEED",
        help="Mean engine speed, as '900 rpm'; default: where full load is highest.",
        show_default=False,
    ),
]
Speeds = Annotated[
    str,
    typer.Option(
        "--speed",
        "-s",
        metavar="RANGE",
        help="Mean engine speeds, as 600:2000rpm or 600:2000:20rpm; default: the file's operating range.",
        show_default=False,
    ),
]
TorqueOrRange = Annotated[
    str,
    typer.Option(
        "--torque",
        "-t",
        metavar="TORQUE",
        help="Mean engine torque, as '1200 Nm', or a range to follow at one speed; default: full load.",
        show_default=False,
    ),
]
SpeedOrRange = Annotated[
    str,
    typer.Option(
        "--speed",
        "-s",
        metavar="RANGE",
        help="Mean engine speeds to follow, as 600:1200rpm, or one where something else is followed; default: the "
        "file's operating range.",
        show_default=False,
    ),
]
SpeedInTime = Annotated[
    str,
    typer.Option(
        "--speed",
        "-s",
        metavar="SPEED",
        help="Mean engine speed, as '900 rpm', or a run-up, as 600:1200rpm; default: where full load is highest.",
        show_default=False,
    ),
]
Duration = Annotated[
    str,
    typer.Option("--duration", "-d", metavar="TIME", help="How long it runs, as 3s; default: 2 s.", show_default=False),
]
Step = Annotated[
    str,
    typer.Option("--step", metavar="TIME", help="Step of time, as 0.05ms; default: 0.1 ms.", show_default=False),
]
ScenarioName = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO",
        help="engine_start, engine_stop, tip_in, tip_out, clutch_engagement, gear_shift, stall, traction_loss, "
        "idle_pulse, or a scenario file.",
        show_default=False,
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--setting",
        "-s",
        metavar="PATH=VALUE",
        help="Change the scenario, as starter.speed=150rpm; may be repeated.",
        show_default=False,
    ),
]
Parameter = Annotated[
    str,
    typer.Option(
        "--parameter",
        "-p",
        metavar="PATH=RANGE",
        help="A value of the file to follow at one speed and torque, as absorber.stages.1.stiffness=20:60kNm/rad.",
        show_default=False,
    ),
]
At = Annotated[
    str,
    typer.Option(
        "--at",
        metavar="VALUE",
        help="Where to look at the motions themselves, as 940rpm: orders, stages, waveforms.",
        show_default=False,
    ),
]
Order = Annotated[
    list[float] | None,
    typer.Option("--order", "-n", metavar="N", help="An engine order; may be repeated.", show_default=False),
]
Orders = Annotated[
    str, typer.Option("--orders", metavar="RANGE", help="Engine orders, as 0.5:12:0.5.", show_default=False)
]
Nodes = Annotated[
    list[str] | None,
    typer.Option("--node", metavar="NAME", help="A node to look at, or 'all'; may be repeated.", show_default=False),
]
Elements = Annotated[
    list[str] | None,
    typer.Option(
        "--element", metavar="NAME", help="A connection to look at, or 'all'; may be repeated.", show_default=False
    ),
]
OneNode = Annotated[
    str,
    typer.Option(
        "--node",
        metavar="NAME",
        help="The node whose acceleration is told; default: the one to be kept quiet.",
        show_default=False,
    ),
]
OneElement = Annotated[
    str,
    typer.Option(
        "--element",
        metavar="NAME",
        help="The connection whose torque is told; default: the first with stages.",
        show_default=False,
    ),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Change the model, as absorber.damping=30; may be repeated.",
        show_default=False,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document, in SI units, and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Output = Annotated[
    list[Path] | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        help="Write a file; its ending says the kind. May be repeated.",
        show_default=False,
    ),
]
