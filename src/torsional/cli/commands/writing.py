"""Commands that write pages and files to begin with, and the one that compiles."""

from __future__ import annotations

from pathlib import Path

from torsional.cli import options as o
from torsional.cli import workbench_options as w
from torsional.cli.app import app
from torsional.cli.jobs import Job, job


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
def workbench(
    model: w.FirstModel = None,
    host: w.Host = "",
    port: w.Port = None,
    token: w.Token = "",
    no_browser: w.NoBrowser = False,
    processes: w.AnsweringProcesses = 0,
    results: w.Results = None,
) -> Job:
    """A page in the browser: the truck answers while you turn its values.

    Serves this machine alone unless --host names another address, which then wants the token that is told with the
    address. Nothing is kept on the server. Ctrl-C ends it.
    """
    return job("workbench", **locals())


@app.command()
def schema(kind: o.FileKind = "model", output: o.Output = None) -> Job:
    """JSON Schema of model files, or of another kind, for editors."""
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
