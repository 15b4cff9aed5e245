"""Commands about motion in time, and about slow sweeps."""

from __future__ import annotations

from torsional.cli import options as o
from torsional.cli.app import app
from torsional.cli.jobs import Job, analysis


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
