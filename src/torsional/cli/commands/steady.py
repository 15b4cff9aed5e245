"""Commands about vibration that repeats itself: modes, orders, maps, branches."""

from __future__ import annotations

from torsional.cli import options as o
from torsional.cli.app import app
from torsional.cli.jobs import Job, analysis


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
    order: o.OneOrder = "",
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
    worst: o.Worst = "",
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
    points: o.Points = "",
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
