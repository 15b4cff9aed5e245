"""The arguments and options of all commands, each told once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer


def taking(*names: str, metavar: str, help: str) -> Any:
    """An option that takes a value."""
    return typer.Option(*names, metavar=metavar, help=help, show_default=False)


ModelFile = Annotated[
    Path,
    typer.Argument(
        metavar="MODEL", help="Model file (.yaml or .json); 'torsional new' writes one.", show_default=False
    ),
]
Gear = Annotated[str, taking("--gear", "-g", metavar="NAME", help="Gear by its name; default: the last one.")]
Gears = Annotated[
    str,
    taking("--gear", "-g", metavar="NAMES", help="Gear, several as 10,11,12, or 'all'; default: the last one."),
]

_TORQUE = "Mean engine torque in Nm, or with its unit as 1.2kNm"
_SPEED = "Mean engine speed in rpm, or with its unit as 94rad/s"
Torque = Annotated[str, taking("--torque", "-t", metavar="TORQUE", help=f"{_TORQUE}; default: full load.")]
Torques = Annotated[
    str,
    taking(
        "--torque", "-t", metavar="RANGE", help="Mean engine torques in Nm, as 0:2500:100; default: up to full load."
    ),
]
TorqueOrRange = Annotated[
    str,
    taking("--torque", "-t", metavar="TORQUE", help=f"{_TORQUE}; or a range, as 900:1500; default: full load."),
]
Speed = Annotated[str, taking("--speed", "-s", metavar="SPEED", help=f"{_SPEED}; default: where full load is highest.")]
Speeds = Annotated[
    str,
    taking(
        "--speed",
        "-s",
        metavar="RANGE",
        help="Mean engine speeds in rpm, as 600:2000 or 600:2000:20; default: the file's operating range.",
    ),
]
SpeedOrRange = Annotated[
    str,
    taking(
        "--speed",
        "-s",
        metavar="RANGE",
        help="Mean engine speeds in rpm to follow, as 600:1200, or one where something else is followed; default: the "
        "file's operating range.",
    ),
]
SpeedInTime = Annotated[
    str,
    taking(
        "--speed",
        "-s",
        metavar="SPEED",
        help=f"{_SPEED}; or a run-up, as 600:1200; default: where full load is highest.",
    ),
]
SpeedList = Annotated[
    str,
    taking(
        "--speed",
        "-s",
        metavar="SPEEDS",
        help="Rotational speeds in rpm, as 0,2000,4000 or 0:4000:500; default: 0,2000,4000.",
    ),
]

Duration = Annotated[
    str, taking("--duration", "-d", metavar="TIME", help="How long it runs in s, or with its unit; default: 2.")
]
Step = Annotated[
    str, taking("--step", metavar="TIME", help="Step of time in s, or with its unit as 0.05ms; default: 0.1ms.")
]

Sweep = Annotated[
    str,
    taking(
        "--sweep",
        metavar="ANGLES",
        help="How far it is turned to either side in degrees, as 60 or 5,20,60; default: up to the stop, or 60.",
    ),
]
Rate = Annotated[str, taking("--rate", metavar="PACE", help="How fast in deg/s, or with its unit; default: 3.")]
About = Annotated[
    str, taking("--about", metavar="ANGLE", help="The angle in the middle of the sweep in degrees; default: 0.")
]
Turned = Annotated[
    str,
    taking("--turned", metavar="NODE", help="The node that is turned; default: the flywheel on the crankshaft."),
]
Held = Annotated[
    str,
    taking(
        "--held", metavar="NODE", help="The node it is turned against; default: the flywheel that carries the clutch."
    ),
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
_AS_FILES = "units as in the file, none being SI; may be repeated"
Settings = Annotated[
    list[str] | None,
    taking(
        "--setting",
        "-s",
        metavar="PATH=VALUE",
        help=f"Change the scenario, as starter.speed=150rpm: {_AS_FILES}.",
    ),
]
Changes = Annotated[
    list[str] | None,
    taking("--set", metavar="PATH=VALUE", help=f"Change the model, as absorber.damping=30: {_AS_FILES}."),
]

Parameter = Annotated[
    str,
    taking(
        "--parameter",
        "-p",
        metavar="PATH=RANGE",
        help="A value of the file to follow at one speed and torque, as absorber.stages.1.stiffness=20:60kNm/rad: "
        "units as in the file, none being SI.",
    ),
]
At = Annotated[
    str,
    taking(
        "--at",
        metavar="VALUE",
        help="Where to look at the motions themselves: orders, stages, waveforms; a value of what is followed, as 940.",
    ),
]
Isolated = Annotated[
    bool, typer.Option("--isolated", help="Seek as well motions that hang together with no other; takes longer.")
]
Points = Annotated[
    str,
    taking("--points", metavar="N", help="Speeds, and mean torques, of ranges without a step; default: 71 and 26."),
]

Order = Annotated[list[str] | None, taking("--order", "-n", metavar="N", help="An engine order; may be repeated.")]
Orders = Annotated[str, taking("--orders", metavar="RANGE", help="Engine orders, as 0.5:12:0.5.")]
OneOrder = Annotated[
    str,
    taking("--order", "-n", metavar="N", help="Engine order of the speeds; default: the strongest."),
]
Nodes = Annotated[
    list[str] | None, taking("--node", metavar="NAME", help="A node to look at, or 'all'; may be repeated.")
]
Elements = Annotated[
    list[str] | None, taking("--element", metavar="NAME", help="A connection to look at, or 'all'; may be repeated.")
]
OneNode = Annotated[
    str,
    taking("--node", metavar="NAME", help="The node whose acceleration is told; default: the one to be kept quiet."),
]
OneElement = Annotated[
    str,
    taking("--element", metavar="NAME", help="The connection whose torque is told; default: the first with stages."),
]
Worst = Annotated[str, taking("--worst", metavar="N", help="Cells to list for each place; default: 3.")]
Expand = Annotated[bool, typer.Option("--expand", help="Print the model written as components alone.")]

Json = Annotated[bool, typer.Option("--json", help="Print one JSON document, in SI units, and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Output = Annotated[
    list[Path] | None,
    taking("--output", "-o", metavar="FILE", help="Write a file; its ending says the kind. May be repeated."),
]
Page = Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="The page to write, ending in .html.")]
NewFile = Annotated[Path | None, taking("--output", "-o", metavar="FILE", help="The model file to write.")]
Force = Annotated[bool, typer.Option("--force", help="Replace a file that is there already.")]
Kind = Annotated[str, typer.Argument(metavar="[KIND]", help="truck or line.")]
FileKind = Annotated[
    str, typer.Argument(metavar="[KIND]", help="Kind of file: model, scenario, mapping, sweep, optimise or identify.")
]
Compare = Annotated[
    list[Path] | None,
    taking("--compare", "-c", metavar="OTHER", help="A model to set beside it; may be repeated."),
]

ClaimIds = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="IDS", help="Claims, as B2 C3; a letter for all of its paper; default: all.", show_default=False
    ),
]
TruckFile = Annotated[
    Path | None, taking("--truck", metavar="MODEL", help="A model file to ask; default: the shipped truck.")
]
StudyModel = Annotated[
    Path | None,
    typer.Argument(metavar="MODEL", help="Model file to ask; default: the shipped truck.", show_default=False),
]
Quick = Annotated[bool, typer.Option("--quick", help="Ask the truck alone, not many varied ones.")]
Many = Annotated[int, typer.Option("--trucks", metavar="N", min=1, help="How many varied trucks are asked together.")]
Thorough = Annotated[
    bool,
    typer.Option("--thorough", help="Ask dear claims of all varied trucks too: an hour or two instead of minutes."),
]
Processes = Annotated[
    int,
    typer.Option("--processes", metavar="N", min=0, help="Processes side by side; 0: one a core.", show_default=False),
]

Cluster = Annotated[
    str, taking("--cluster", metavar="ADDRESS", help="Dask scheduler whose workers do it, as tcp://host:8786.")
]

PlanFile = Annotated[Path, typer.Argument(metavar="PLAN", help="Plan of a sweep (YAML or JSON).", show_default=False)]
Optimisation = Annotated[
    str, typer.Argument(metavar="PLAN", help="Plan of an optimisation, or the name of a preset.", show_default=False)
]
Space = Annotated[
    str, taking("--space", metavar="VALUE", help="Preset: most inertia of the absorber in kgm²; default: its own.")
]
Travel = Annotated[
    str,
    taking("--travel", metavar="VALUE", help="Preset: most twist of its springs in rad, or 15deg; default: its stop."),
]
Power = Annotated[
    str, taking("--power", metavar="VALUE", help="Preset: most friction power at the resonance in W, or 0.5kW.")
]
PendulumMass = Annotated[
    str, taking("--mass", metavar="VALUE", help="Preset best-pendulum: most mass in kg; default: 1.5 times its own.")
]
Tuning = Annotated[
    str,
    taking("--tuning", metavar="RATIO", help="Preset best-pendulum: its order over the firing order; default: 1.02."),
]
AbsorberKind = Annotated[
    str, taking("--absorber", metavar="NAME", help="Preset best-clutch-friction: smf, dmf, psva …; default: the own.")
]
Population = Annotated[
    int, typer.Option("--population", metavar="N", min=0, help="Designs of a generation.", show_default=False)
]
Generations = Annotated[
    int, typer.Option("--generations", metavar="N", min=0, help="Generations searched.", show_default=False)
]
Seed = Annotated[
    int | None, typer.Option("--seed", metavar="N", min=0, help="Of all that is drawn by chance.", show_default=False)
]
KeptIn = Annotated[
    Path | None,
    taking("--folder", metavar="FOLDER", help="Where work is kept; default: the plan's name and .optimise."),
]
Folder = Annotated[
    Path | None,
    taking("--folder", metavar="FOLDER", help="Where pieces are kept; default: the plan's name and .sweep."),
]
Figures = Annotated[
    list[str] | None, taking("--figure", metavar="NAME", help="A figure of the answer; may be repeated; default: all.")
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with what the folder holds.")]
Status = Annotated[bool, typer.Option("--status", help="Tell how far the folder is, and do nothing.")]

Measurement = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", help="Measurement file: .mf4, .uff, .mat, .parquet, .csv; or a result, .nc.", show_default=False
    ),
]
Converted = Annotated[
    Path,
    typer.Argument(
        metavar="OUTPUT",
        help="The file to write: .mf4, .uff, .mat, .parquet or .csv; with a mapping also a result, .nc.",
        show_default=False,
    ),
]
Mapping = Annotated[
    Path | None,
    taking("--mapping", "-m", metavar="FILE", help="Which channel is which quantity of which node; see mapping."),
]
MappedModel = Annotated[
    Path | None, taking("--model", metavar="MODEL", help="The model whose nodes and elements the mapping may name.")
]
NewMapping = Annotated[Path | None, taking("--output", "-o", metavar="FILE", help="The mapping file to write.")]
