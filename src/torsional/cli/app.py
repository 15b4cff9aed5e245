"""The commands and what they take; what they do is imported when one of them runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from torsional import __version__
from torsional.cli import options as o
from torsional.cli.jobs import Job, analysis, job

HELP = ["--help", "-h"]

app = typer.Typer(
    name="torsional",
    help="Torsional vibrations of vehicle powertrains and the absorbers that tame them.",
    epilog="A first model: torsional new truck -o my.yaml, then torsional check my.yaml.",
    rich_markup_mode=None,
    context_settings={"help_option_names": HELP},
    pretty_exceptions_enable=False,
)


def command() -> Any:
    """The command line as one callable; called without typer's own handling it returns the job to do."""
    return typer.main.get_command(app)


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"torsional {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    pass


@app.command()
def check(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.Torque = "",
    changes: o.Changes = None,
    expand: o.Expand = False,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Read a model and say what looks wrong.

    Tells what the file holds, how its springs stand under full load, and its first modes.  Exit code 2 for a file that
    is no model.
    """
    return analysis("check", locals(), (".yaml", ".yml") if expand else (".json",))


@app.command()
def modes(
    model: o.ModelFile,
    gear: o.Gears = "",
    torque: o.Torque = "",
    speed: o.Speed = "",
    order: o.OneOrder = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Natural frequencies, damping and energy.

    Tells as well at which engine speed an order meets each mode.
    """
    return analysis("modes", locals())


@app.command()
def respond(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.Torque = "",
    speed: o.Speeds = "",
    order: o.Order = None,
    orders: o.Orders = "",
    node: o.Nodes = None,
    element: o.Elements = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Response to the engine orders over speed.

    At full load or at one mean torque; tells the peaks of the strongest orders and of all orders together.
    """
    return analysis("respond", locals())


@app.command("map")
def map_(
    model: o.ModelFile,
    gear: o.Gears = "",
    torque: o.Torques = "",
    speed: o.Speeds = "",
    order: o.Order = None,
    orders: o.Orders = "",
    node: o.Nodes = None,
    element: o.Elements = None,
    worst: o.Worst = 3,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Response over speed, torque and gear.

    Tells the worst cells within full load.
    """
    return analysis("map", locals())


@app.command()
def campbell(
    model: o.ModelFile,
    gear: o.Gears = "",
    torque: o.Torque = "",
    speed: o.Speeds = "",
    order: o.Order = None,
    orders: o.Orders = "",
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Where engine orders meet the modes."""
    return analysis("campbell", locals())


@app.command()
def periodic(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.TorqueOrRange = "",
    speed: o.SpeedOrRange = "",
    parameter: o.Parameter = "",
    at: o.At = "",
    isolated: o.Isolated = False,
    order: o.Order = None,
    node: o.Nodes = None,
    element: o.Elements = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Periodic motions of springs with stages.

    Stable and unstable ones with their bifurcations, sub-harmonic ones among them, which no linear analysis shows.
    """
    return analysis("periodic", locals())


@app.command()
def subharmonic(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.Torques = "",
    speed: o.Speeds = "",
    points: o.Points = None,
    node: o.OneNode = "",
    element: o.OneElement = "",
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Where a model vibrates at half its engine's order.

    Order 1.5 of a six-cylinder: over speed and mean torque, how strong, and where it begins.
    """
    return analysis("subharmonic", locals())


@app.command()
def transient(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.Torque = "",
    speed: o.SpeedInTime = "",
    duration: o.Duration = "",
    step: o.Step = "",
    node: o.Nodes = None,
    element: o.Elements = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Motion in time, at one speed or running up.

    Laws, clearances, stops and friction as they are, the engine burning over its own crank angle.  Tells peaks, travel
    against stops and where the energy went; Ctrl-C keeps what was reached.
    """
    return analysis("transient", locals())


@app.command()
def scenario(
    model: o.ModelFile,
    scenario: o.ScenarioName,
    setting: o.Settings = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """An engine start, a clutch engagement, a shift … in time.

    Tells peaks, travel against stops and where the energy went; Ctrl-C keeps what was reached.
    """
    return analysis("scenario", locals())


@app.command()
def hysteresis(
    model: o.ModelFile,
    gear: o.Gear = "",
    speed: o.SpeedList = "",
    sweep: o.Sweep = "",
    rate: o.Rate = "",
    about: o.About = "",
    turned: o.Turned = "",
    held: o.Held = "",
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


@app.command()
def report(
    model: o.ModelFile,
    compare: o.Compare = None,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Page = Path("report.html"),
    quiet: o.Quiet = False,
) -> Job:
    """One HTML page about one model or several."""
    return job("report", **locals())


@app.command()
def schema(output: o.Output = None) -> Job:
    """JSON Schema of model files, for editors."""
    return job("starting", what="schema", **locals())


@app.command()
def new(
    kind: o.Kind = "truck",
    output: o.NewFile = None,
    force: o.Force = False,
) -> Job:
    """A commented model file to begin with."""
    return job("starting", what="new", kind=kind, output=[output] if output else None, force=force)


@app.command()
def warmup(as_json: o.Json = False, quiet: o.Quiet = False) -> Job:
    """Compile the numerical kernels once."""
    return job("warmup", **locals())
