"""`torsional scenario`: an engine start, a clutch engagement, a shift … in time: peaks, stops, energies, a picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from torsional.cli.answers import Answer, told_settings
from torsional.cli.outputs import checked
from torsional.cli.progress import running
from torsional.cli.request import Request
from torsional.cli.runs import chosen, hand_over, run_tables, signals, warn_refined
from torsional.files.scenario import SUFFIXES, load_scenario
from torsional.studies.scenarios.running import run_scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def run(request: Request, scenario: str, setting: Sequence[str] | None) -> None:
    """Answer the command."""
    block = load_scenario(scenario, setting or ())
    if Path(scenario).exists():
        checked(request.outputs, [path.suffix for path in request.outputs], [Path(scenario)])
    with running(block.title, request.quiet or request.as_json) as moved:
        found = run_scenario(request.model, block, moved)
    warn_refined(found)
    springs, watched, nodes = (json.loads(found.attrs[key]) for key in ("springs", "watched", "looked_at"))
    told = told_settings(request, scenario=block.scenario, file=_file(scenario), changes=list(setting or ()))
    settings = {"values": block.model_dump(mode="json"), "gear": found.attrs["gear"], "status": found.attrs["status"]}
    tables = run_tables(found, found.attrs["title"], springs)
    data = chosen(found, [found.attrs["crank"], *nodes], [*springs, *watched])
    answer = Answer("scenario", tables, {**told, **settings}, data, found, lambda: _picture(found), signals(data))
    hand_over(answer, request, found.attrs["status"])


def _file(scenario: str) -> str:
    return scenario if Path(scenario).suffix in SUFFIXES else ""


def _picture(found: xr.Dataset) -> Figure:
    from torsional.plots.scenario import plot_scenario

    return plot_scenario(found)
