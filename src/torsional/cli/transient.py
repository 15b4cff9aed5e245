"""`torsional transient`: a model in time at one speed or running up: peaks, stops, energies, a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import xarray as xr

from torsional import units
from torsional.cli import inputs, typed
from torsional.cli.answers import Answer, told_settings
from torsional.cli.documents import amount
from torsional.cli.modes import in_gear
from torsional.cli.places import chosen_places
from torsional.cli.progress import running
from torsional.cli.request import Request
from torsional.cli.runs import chosen, hand_over, run_tables, seconds, signals, warn_refined
from torsional.errors import ModelError
from torsional.model import Model
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.studies.scenarios.run_up import run_up

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DURATION = 2.0


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    duration: str,
    step: str,
    node: Sequence[str] | None,
    element: Sequence[str] | None,
) -> None:
    """Answer the command."""
    machine, time = request.model, seconds(duration, "--duration", DURATION)
    engaged = inputs.one_gear(machine, gear)
    turning, told_speed = speed_over(machine, speed, time)
    mean = inputs.torque(machine, torque, list(dict.fromkeys(turning.range)))
    nodes, elements = chosen_places(machine.detailed(), engaged, node, element)
    width = seconds(step, "--step", 0.0) or None
    with running("run in time", request.quiet or request.as_json) as moved:
        found = run_up(machine, turning, mean, time, engaged, step=width, progress=moved)
    warn_refined(found)
    title = f"{told_speed}, {units.show(mean, 'torque')}{in_gear(engaged)}"
    told = told_settings(request, gear=engaged, torque=amount(mean, "torque"), duration=amount(time, "time"))
    springs = [name for name in elements if name in machine.landmarks.springs] or elements[:1]
    tables = run_tables(found, title, [name for name in springs if name in found.element.values])
    others = [name for name in elements if name not in springs]
    data = chosen(found, nodes, elements)
    answer = Answer(
        "transient",
        tables,
        {**told, "status": found.attrs["status"]},
        data,
        found,
        picture=lambda: _picture(found, nodes, springs, others, title),
        columns=signals(data),
    )
    hand_over(answer, request, found.attrs["status"])


def speed_over(model: Model, text: str, duration: float) -> tuple[SpeedProfile, str]:
    """The speed over time, and in words: one speed, or from one to another within the duration."""
    if ":" not in text:
        at = inputs.speed(model, text)
        _turning(at)
        return SpeedProfile.constant(at), units.show(at, "speed")
    ends = _ends(text)
    inputs.warn_off_range(model, ends)
    return SpeedProfile.ramp(*ends, duration), " to ".join(units.show(end, "speed") for end in ends)


def _ends(text: str) -> tuple[float, float]:
    """The ends of a run-up, or of a run-down."""
    first, _, last = typed.with_unit(text, "speed").partition(":")
    if not (first.strip() and last.strip()) or ":" in last:
        remedy = "name where it begins and where it ends, as 600:1200rpm"
        raise ModelError("how does the speed run?", where="--speed", found=units.quoted(text), remedy=remedy)
    unit = last.lstrip(" 0123456789.+-eE")
    both = (first if first.strip()[-1:].isalpha() else first + unit, last)
    start, end = (units.read(part, "speed", "--speed") for part in both)
    for speed in (start, end):
        _turning(speed)
    inputs.checked_values([start, end], "speed", "--speed", text)
    return start, end


def _turning(speed: float) -> None:
    if not speed > 0:
        told = {"found": units.show(speed, "speed"), "remedy": "an engine start is a scenario: torsional scenario"}
        raise ModelError("the engine must turn", where="--speed", **told)


def _picture(
    found: xr.Dataset, nodes: Sequence[str], springs: Sequence[str], others: Sequence[str], title: str
) -> Figure:
    from torsional.plots.transient import plot_transient

    return plot_transient(found, nodes=nodes, springs=springs, elements=others, title=title)
