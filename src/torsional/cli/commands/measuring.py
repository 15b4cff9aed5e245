"""Commands about measurements."""

from __future__ import annotations

import typer

from torsional.cli import options as o
from torsional.cli.app import HELP, app
from torsional.cli.jobs import Job, job

measurement = typer.Typer(
    name="measurement",
    help="Measurement files: MDF, UFF, MATLAB, Parquet, CSV.",
    rich_markup_mode=None,
    context_settings={"help_option_names": HELP},
)
app.add_typer(measurement)


@measurement.command()
def show(
    file: o.Measurement,
    mapping: o.Mapping = None,
    model: o.MappedModel = None,
    gear: o.Gear = "",
    as_json: o.Json = False,
) -> Job:
    """What a measurement file holds.

    Tells channels with units, samples, rate and range, --json their groups and comments too; with a mapping what they
    are of the model.
    """
    return job("measurement", what="show", **locals())


@measurement.command()
def convert(
    file: o.Measurement,
    output: o.Converted,
    mapping: o.Mapping = None,
    model: o.MappedModel = None,
    gear: o.Gear = "",
    force: o.Force = False,
    quiet: o.Quiet = False,
) -> Job:
    """A measurement, or a result, in another format.

    Takes what show takes, and results as .nc; with a mapping it writes nodes and elements in SI over one raster.
    """
    return job("measurement", what="convert", **locals())


@measurement.command()
def mapping(
    file: o.Measurement,
    output: o.NewMapping = None,
    force: o.Force = False,
) -> Job:
    """A mapping file to begin with.

    Lists the channels of a measurement; those whose unit tells what they are only want the name of their place.
    """
    return job("measurement", what="mapping", **locals())
