"""Commands that ask whole studies: the thesis's claims, and the tools that engineers run by name."""

from __future__ import annotations

from pathlib import Path

import typer

from torsional.cli import identification_options as i
from torsional.cli import options as o
from torsional.cli.app import app
from torsional.cli.jobs import Job, job
from torsional.cli.study_group import StudyGroup


@app.command()
def claims(
    ids: o.ClaimIds = None,
    truck: o.TruckFile = None,
    changes: o.Changes = None,
    quick: o.Quick = False,
    trucks: o.Many = 200,
    thorough: o.Thorough = False,
    processes: o.Processes = 0,
    as_json: o.Json = False,
    output: o.Page = Path("claims.html"),
    quiet: o.Quiet = False,
) -> Job:
    """The claims of the thesis judged on a truck.

    Writes a page with statement, criterion, figures, picture and verdict of each, and on how many of many varied trucks
    it holds; the same figures as .json beside it.
    """
    return job("claims", **locals())


@app.command()
def sweep(
    plan: o.PlanFile,
    folder: o.Folder = None,
    resume: o.Resume = False,
    status: o.Status = False,
    processes: o.Processes = 0,
    cluster: o.Cluster = "",
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """One analysis of many designs.

    Model, parameters, designs and analysis stand in a plan.  What is worked out is kept in a folder piece by piece;
    stopped in the middle, --resume goes on.  Exit code 3 where some designs have no answer.
    """
    return job("sweep", **locals())


@app.command()
def sensitivity(
    plan: o.PlanFile,
    figure: o.Figures = None,
    folder: o.Folder = None,
    resume: o.Resume = False,
    processes: o.Processes = 0,
    cluster: o.Cluster = "",
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Which parameters of a sweep move its figures.

    Works through a plan whose designs are chosen by morris or saltelli, as sweep does, and tells Morris's elementary
    effects or Sobol's shares of the variance.  Exit code 3 where some designs have no answer.
    """
    return job("sensitivity", **locals())


@app.command()
def bands(
    plan: o.PlanFile,
    folder: o.Folder = None,
    resume: o.Resume = False,
    processes: o.Processes = 0,
    cluster: o.Cluster = "",
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Bands in which figures lie for most designs, as order curves under tolerances.

    Works through a plan as sweep does, and tells percentiles of every figure beside the unchanged model's.  Exit code 3
    where some designs have no answer.
    """
    return job("bands", **locals())


@app.command()
def optimise(
    plan: o.Optimisation,
    model: o.StudyModel = None,
    changes: o.Changes = None,
    space: o.Space = "",
    travel: o.Travel = "",
    power: o.Power = "",
    absorber: o.AbsorberKind = "",
    mass: o.PendulumMass = "",
    tuning: o.Tuning = "",
    population: o.Population = 0,
    generations: o.Generations = 0,
    seed: o.Seed = None,
    folder: o.KeptIn = None,
    resume: o.Resume = False,
    processes: o.Processes = 0,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """The best designs of a plan, or of a preset on a truck.

    A genetic search over what may be chosen, within limits, refined by exact gradients: the Pareto front of the
    objectives, its knee, and how both compare with the nominal design.  Presets: best-dmf, best-clutch-friction,
    best-psva, best-tva, best-pendulum.  Stopped in the middle, --resume goes on.  -o takes a page, .html, too.
    """
    limits = {"space": space, "travel": travel, "power": power, "absorber": absorber, "mass": mass, "tuning": tuning}
    given = {name: value for name, value in limits.items() if value}
    return job(
        "optimise",
        plan=plan,
        model=model,
        changes=changes,
        given=given,
        population=population,
        generations=generations,
        seed=seed,
        folder=folder,
        resume=resume,
        processes=processes,
        as_json=as_json,
        output=output,
        quiet=quiet,
    )


@app.command()
def identify(
    plan: i.Identification,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Parameters of a model found from measurements.

    Loops of a rig, order curves or signals in time, as a plan names them: least squares within bounds, with intervals,
    what the data cannot tell, other models of the same data, and points that are held back.  -o takes a page, .html,
    too.
    """
    return job("identify", **locals())


@app.command()
def correlate(
    measured: i.MeasuredOrders,
    computed: i.ComputedOrders,
    node: o.Nodes = None,
    element: o.Elements = None,
    gear: o.Gear = "",
    torque: o.Torque = "",
    amplitude: i.AmplitudeKind = "0-peak",
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """Measured orders beside computed ones.

    Order by order at one node or connection: errors of amplitude, peak and phase, the frequency response assurance
    criterion, RMS and R².  Computed is a result (.nc) or a model file, which is asked at the measured speeds.  -o takes
    a page, .html, too.
    """
    return job("correlate", **locals())


app.add_typer(
    typer.Typer(cls=StudyGroup, rich_markup_mode=None),
    name="study",
    help="Design studies by name: torsional study lists them.",
)
