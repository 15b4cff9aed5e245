"""Commands that hand a model to other tools, and take one from them."""

from __future__ import annotations

from pathlib import Path

from torsional.cli import exchange_options as e
from torsional.cli import options as o
from torsional.cli.app import app
from torsional.cli.jobs import Job, analysis, job


@app.command()
def fmu(
    model: o.ModelFile,
    absorber: e.AbsorberAlone = False,
    inputs: e.InputNodes = None,
    gear: o.Gear = "",
    torque: e.TorqueWithin = "",
    speed: o.Speed = "",
    step: o.Step = "",
    fmi: e.FmiVersion = "2.0",
    sources: e.SourcesOnly = False,
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: e.FmuFile = Path("unit.fmu"),
    quiet: o.Quiet = False,
) -> Job:
    """A functional mock-up unit for other simulation tools.

    The line, or its absorber alone, for co-simulation: the laws and time steps of transient in C, compiled where a C
    compiler is at hand.  Torques on nodes go in, motions and torques come out; of an absorber motions of its two sides
    go in and torques come out.
    """
    return analysis("fmu", {**locals(), "output": [output]}, (".fmu",))


@app.command()
def export(
    model: o.ModelFile,
    gear: o.Gear = "",
    torque: o.Torque = "",
    speed: o.Speed = "",
    changes: o.Changes = None,
    as_json: o.Json = False,
    output: o.Output = None,
    quiet: o.Quiet = False,
) -> Job:
    """The matrices M, C, K about a mean torque.

    As .mat, .csv or .json, with names and units; without a file the table goes to the terminal.
    """
    return analysis("export", locals(), (".mat", ".csv", ".json"))


@app.command("import")
def import_(table: e.LineTable, output: o.NewFile = None, force: o.Force = False) -> Job:
    """A model file of a table or an openTorsion file.

    A CSV table has a line for each node: inertia, stiffness to the next, damping, ratio.  An assembly of openTorsion
    comes in that tool's own form, TORS (.json).
    """
    return job("imported", **locals())
