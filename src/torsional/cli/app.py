"""The command line as one program; what a command does is imported when it runs."""

from __future__ import annotations

from importlib import import_module
from typing import Annotated, Any

import typer

from torsional import __version__

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
    for module in (
        "steady",
        "moving",
        "asking",
        "measuring",
        "tracking",
        "exchanging",
        "writing",
    ):  # in the order of the help; each declares its commands on the app
        import_module(f"torsional.cli.commands.{module}")
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
