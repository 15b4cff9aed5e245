"""`torsional scenario`: an engine start, a clutch engagement, a shift … in time: peaks, stops, energies, a picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, told_settings
from torsional.cli.outputs import checked
from torsional.cli.progress import running
from torsional.cli.request import Request
from torsional.cli.runs import chosen, hand_over, run_tables, signals, warn_refined
from torsional.files.scenario import SUFFIXES, load_scenario
from torsional.files.scenario_blocks import Scenario
from torsional.model import Model
from torsional.studies.scenarios.running import run_scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEED, TORQUES = "speed", ("before", "after", "torque")
"""Keys of scenarios that are the engine's speed, and its mean torque."""


def run(request: Request, scenario: str, setting: Sequence[str] | None) -> None:
    """Answer the command."""
    block = load_scenario(scenario, setting or ())
    if Path(scenario).exists():
        checked(request.outputs, [path.suffix for path in request.outputs], [Path(scenario)])
    _warn_beyond_engine(block, request.model)
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


def _warn_beyond_engine(block: Scenario, model: Model) -> None:
    """Say which of the keys given ask for more than the engine of the model has."""
    given = {key: value for key in (SPEED, *TORQUES) if (value := getattr(block, key, None)) is not None}
    over = [given[SPEED]] if SPEED in given else []
    inputs.warn_off_range(model, over, SPEED)
    for key in given.keys() - {SPEED}:
        inputs.warn_overload(model, given[key], over, key)


def _file(scenario: str) -> str:
    return scenario if Path(scenario).suffix in SUFFIXES else ""


def _picture(found: xr.Dataset) -> Figure:
    from torsional.plots.scenario import plot_scenario

    return plot_scenario(found)
