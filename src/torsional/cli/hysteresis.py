"""`torsional hysteresis`: torque over angle of an absorber under a slow sweep, at any rotational speed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional import units
from torsional.cli import inputs, typed
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount
from torsional.cli.failures import complain
from torsional.cli.modes import in_gear
from torsional.cli.progress import progress
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.hysteresis import CLOSED, RATE, absorber_ends, hysteresis, on_bench
from torsional.system import System, assemble

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEEDS, WIDEST = "0,2000,4000 rpm", np.radians(60.0)
SHORT = 0.95
"""How far towards the stop the sweep goes unless told otherwise."""
SMALL = (
    "drive_torque",
    "drive_angle",
    "loss",
    "stiffness",
    "harmonic_stiffness",
    "loss_factor",
    "sliding",
    "cycles",
    "closure",
)
"""What a .csv holds; a .netCDF has every node and element as well."""


def run(request: Request, gear: str, speed: str, sweep: str, rate: str, about: str, turned: str, held: str) -> None:
    """Answer the command."""
    machine = request.model
    engaged = inputs.one_gear(machine, gear)
    speeds = listed(speed or SPEEDS, "speed", "--speed")
    pace = _positive(typed.read(rate, "angular_velocity", "--rate") if rate else RATE, "--rate", rate)
    centre = typed.read(about, "relative_angle", "--about") if about else 0.0
    ends = _chosen_ends(machine, turned, held)
    system = assemble(machine.detailed().powertrain(engaged))
    own = f"{_within_stops(system, ends, machine.landmarks.springs)} rad"
    sweeps = listed(sweep or own, "relative_angle", "--sweep")
    _positive(float(sweeps.min()), "--sweep", sweep)
    with progress("loops", request.quiet or request.as_json) as moved:
        data = hysteresis(system, *ends, speeds, sweeps, rate=pace, centre=centre, progress=moved)
    data = data.assign_attrs(model=machine.name, hash=machine.hash)
    _warn_beyond_stops(data, system, machine)
    _warn_open(data)
    told = told_settings(
        request,
        gear=engaged,
        turned=ends[0],
        held=ends[1],
        rate=amount(pace, "angular_velocity"),
        about=amount(centre, "relative_angle"),
    )
    kept = data[list(SMALL)].drop_vars(["node", "element", "rubs"], errors="ignore")
    title = f"{ends[0]} against {ends[1]}{in_gear(engaged)}, {np.degrees(pace):.3g}°/s"
    answer = Answer("hysteresis", [table(data, title)], told, kept, data, picture=lambda: _picture(data, title))
    deliver(answer, request)


def listed(text: str, quantity: str, option: str) -> Array:
    """Values separated by commas, the last one's unit good for all that have none; or a range with its step."""
    if ":" in text:
        start, stop, *step = typed.read_range(text, quantity, option)
        if not step:
            remedy = "name a step as 0:4000:1000rpm, or the values as 0,2000,4000rpm"
            raise ModelError("how many values are meant?", where=option, found=units.quoted(text), remedy=remedy)
        values = np.arange(start, stop + 1e-9 * step[0], step[0])
    else:
        parts = [part.strip() for part in typed.with_unit(text, quantity).split(",")]
        unit = parts[-1].lstrip("0123456789.+-eE −–")
        values = np.array(
            [units.read(p if p[-1:].isalpha() or p[-1:] == "°" else p + unit, quantity, option) for p in parts]
        )
    inputs.checked_values(values.tolist(), quantity, option, text)
    return np.unique(values)


def _positive(value: float, option: str, text: str) -> float:
    if not value > 0:
        raise ModelError("must be positive", where=option, found=units.quoted(text), allowed="> 0")
    return float(value)


def _chosen_ends(model: Model, turned: str, held: str) -> tuple[str, str]:
    """The nodes between which it is measured; ModelError where the file does not say and nobody names them."""
    first, last = absorber_ends(model)
    ends = turned or first, held or last
    if not all(ends):
        remedy = "name two nodes by --turned and --held"
        raise ModelError("the model does not say where its absorber begins and ends", where="hysteresis", remedy=remedy)
    return ends


def _within_stops(system: System, ends: tuple[str, str], springs: Sequence[str]) -> float:
    """A sweep [rad] to just before the first stop of the absorber's springs, or a wide one where they have none."""
    c = on_bench(system, *ends).system.connections
    ways: list[float] = []
    for name, law, row in zip(c.names, c.laws, c.weights, strict=True):
        lever = abs(float(row[-1])) if not row[:-1].any() else 1.0  # gears may twist it by more or less than the sweep
        ways += [abs(stop) / lever for stop in getattr(law, "stops", ()) if name in springs and lever]
    return SHORT * min(ways) if ways else float(WIDEST)


def _warn_beyond_stops(data: xr.Dataset, system: System, model: Model) -> None:
    """Say where the sweep goes into an end stop, whose stiffness then counts."""
    c = system.connections
    for name, law in zip(c.names, c.laws, strict=True):
        stops = getattr(law, "stops", ())
        if name not in model.landmarks.springs or name not in data.element or not stops:
            continue
        twist = data.twist.sel(element=name)
        over = [
            float(a)
            for a, t in zip(data.sweep, twist.transpose("sweep", ...).values, strict=True)
            if t.max() > max(stops) or t.min() < min(stops)
        ]
        if over:
            at = ", ".join(units.show(stop, "relative_angle") for stop in stops)
            told = ", ".join(f"±{units.show(value, 'relative_angle')}" for value in over)
            complain(f"{told} goes beyond the stop of {name} at {at}: the loop has the stop in it", kind="warning")


def _warn_open(data: xr.Dataset) -> None:
    """Say that cycles do not repeat."""
    worst = max(_cases(data), key=lambda case: float(data.closure.sel(speed=case[0], sweep=case[1])))
    most, count = float(data.closure.max()), int((data.closure > CLOSED).sum())
    if count:
        where = f"{units.show(worst[0], 'speed')}, ±{units.show(worst[1], 'relative_angle')}"
        told = f"{count} of {data.closure.size} loops do not repeat themselves exactly: stick-slip, or a slow creep"
        complain(f"{told}; the last two cycles differ by {100 * most:.2g} % of the torque ({where})", kind="warning")


def _cases(data: xr.Dataset) -> Iterator[tuple[float, float]]:
    for sweep in data.sweep.values:
        for speed in data.speed.values:
            yield float(speed), float(sweep)


def table(data: xr.Dataset, title: str) -> Table:
    """Stiffness, loss and what slides, for every sweep and speed."""
    count = int(data.rubs.sum())
    columns = [Column("sweep ±", "relative_angle"), Column("speed", "speed"), Column("stiffness", "stiffness")]
    columns += [Column("first harmonic", "stiffness"), Column("loss per cycle", "energy")]
    columns += [Column("loss factor", "loss_factor"), Column("largest torque", "torque")]
    columns += [Column(f"sliding, of {count}", "number")] if count else []
    rows: list[list[object]] = []
    for speed, sweep in _cases(data):
        one = data.sel(speed=speed, sweep=sweep)
        figures = [one.stiffness, one.harmonic_stiffness, one.loss, one.loss_factor]
        rows.append([sweep, speed, *map(float, figures), float(abs(one.drive_torque.sel(cycle="closed")).max())])
        rows[-1] += [float(one.sliding)] if count else []
    return Table(f"Hysteresis: {title}", columns, rows)


def _picture(data: xr.Dataset, title: str) -> Figure:
    from torsional.plots import plot_hysteresis

    return plot_hysteresis(data, title=title)
