"""What the commands that run in time share: durations, tables of peaks and energies, a run that was stopped."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr

from torsional import units
from torsional.cli import typed
from torsional.cli.answers import Answer, deliver
from torsional.cli.failures import complain
from torsional.cli.interrupts import Kept, taken
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError

_ROUNDING = 1e-13
SUSPENSION = ".suspension"
"""What the way of a pendulum along its path is named by, behind the pendulum's name."""
_ENERGIES = {
    "dampers": "lost in dampers",
    "friction": "lost in friction",
    "contacts": "lost in contacts",
    "engaging": "lost as the gear engaged",
    "method": "made by the time steps themselves",
}
"""The shares of the ledger that mean the same in every frame; the others count speeds from the mean one."""


RUNNING = ("tip_in", "tip_out", "clutch_engagement", "gear_shift", "traction_loss", "idle_pulse")
"""Scenarios through which an engine runs."""


def seconds(text: str, option: str, default: float) -> float:
    """A positive time [s]."""
    if not text:
        return default
    found = typed.read(text, "time", option)
    if not found > 0:
        raise ModelError("must be positive", where=option, found=units.quoted(text), allowed="> 0 s")
    return found


def run_tables(run: xr.Dataset, title: str, springs: Sequence[str]) -> list[Table]:
    """Peaks of the elements that are told, travel of springs against their stops, energies."""
    return [_peaks(run, title), *_travel(run, springs), *_phases(run), _energies(run)]


def _peaks(run: xr.Dataset, title: str) -> Table:
    columns = [Column("element"), Column("lowest torque", "torque"), Column("highest torque", "torque")]
    columns += [Column("largest at", "time"), Column("lowest twist", "relative_angle")]
    columns += [Column("highest twist", "relative_angle")]
    names = ("torque_lowest", "torque_highest", "peak_time", "twist_lowest", "twist_highest")
    rows = [[e, *_unrounded([float(run[name].sel(element=e)) for name in names])] for e in _told_elements(run)]
    return Table(f"Peaks, {title}" if title else "Peaks", columns, rows)


def _unrounded(figures: list[float]) -> list[float]:
    """The figures of one element, the lower or higher torque nought where only rounding is left of it."""
    nothing = _ROUNDING * max(map(abs, figures[:2]))
    return [0.0 if abs(value) <= nothing else value for value in figures[:2]] + figures[2:]


def _told_elements(run: xr.Dataset) -> list[str]:
    """The elements worth a row: those the run names, all of them where it names none."""
    return json.loads(run.attrs["told"]) if "told" in run.attrs else [str(e) for e in run.element.values]


def _travel(run: xr.Dataset, springs: Sequence[str]) -> list[Table]:
    """How far springs and pendulums with stops went; nothing where none has any."""
    columns = [Column("spring"), Column("from", "relative_angle"), Column("to", "relative_angle")]
    columns += [Column("stop", "relative_angle"), Column("way left", "relative_angle"), Column("contacts")]
    rows: list[Sequence[object]] = []
    pendulums = [str(e) for e in run.element.values if str(e).endswith(SUSPENSION) and e not in springs]
    for spring in [*springs, *pendulums]:
        one = run.sel(element=spring)
        low, high, below, above = (
            float(one[name]) for name in ("twist_lowest", "twist_highest", "stop_below", "stop_above")
        )
        if np.isfinite([below, above]).any():
            left = np.nanmin([above - high, low - below])
            rows.append(
                [
                    spring.removesuffix(SUSPENSION),
                    low,
                    high,
                    np.nanmin(np.abs([below, above])),
                    max(left, 0.0),
                    int(one.stop_contacts),
                ]
            )
    return [Table("Springs against their stops", columns, rows)] if rows else []


def _phases(run: xr.Dataset) -> list[Table]:
    """Speeds of what is looked at, at the end of each phase; nothing where there is none."""
    if "phase" not in run.coords:
        return []
    nodes = list(dict.fromkeys([run.attrs["crank"], *json.loads(run.attrs["looked_at"])]))
    columns = [Column("phase"), Column("from", "time"), Column("to", "time")]
    columns += [Column(f"{node} at its end", "speed") for node in nodes]
    ends = zip(run.phase.values, run.phase_begin.values, run.phase_end.values, strict=True)
    rows = [[str(n), float(a), float(b), *run.phase_speed.sel(phase=n, node=nodes).values.tolist()] for n, a, b in ends]
    return [Table("Phases", columns, rows)]


def _energies(run: xr.Dataset) -> Table:
    columns = [Column("energy up to the end"), Column("", "energy")]
    known = [str(name) for name in run.share.values]
    nothing = _ROUNDING * float(np.abs(run.energy).max())
    shares = {told: float(run.energy.sel(share=name)[-1]) for name, told in _ENERGIES.items() if name in known}
    rows: list[Sequence[object]] = []
    for told, value in shares.items():
        rows.append([told, value if abs(value) > nothing else 0.0])
        rows += _rubbing(run, nothing) if told == _ENERGIES["friction"] else []
    return Table("Energy", columns, rows)


def _rubbing(run: xr.Dataset, nothing: float) -> list[Sequence[object]]:
    """What each friction part lost of it; those inside an absorber together."""
    if "friction_loss" not in run:
        return []
    lost = {str(name): float(run.friction_loss.sel(rubbing=name)[-1]) for name in run.rubbing.values}
    own = [[f"  of it in {name}", lost.pop(name)] for name in _told_elements(run) if name in lost]
    engine = [name for name in lost if name.removeprefix("friction_") in run.node.values]
    own += [["  of it in the engine", sum(lost.pop(name) for name in engine)]] if engine else []
    inner = sum(lost.values())
    listed = own + ([["  of it inside the absorber", inner]] if lost else [])
    return [[told, value if abs(value) > nothing else 0.0] for told, value in listed]  # type: ignore[arg-type]


def chosen(run: xr.Dataset, nodes: Sequence[str], elements: Sequence[str]) -> xr.Dataset:
    """What of a run goes to tables for machines: signals at some places; all of it is in netCDF."""
    names = ("angle", "angular_velocity", "acceleration", "twist", "torque", "schedule")
    figures = [name for name in run.data_vars if run[name].dims == ("element",)]
    kept = run[[*(name for name in names if name in run), *figures]]
    return kept.sel(node=list(dict.fromkeys(nodes)), element=list(dict.fromkeys(elements)))


def signals(data: xr.Dataset) -> xr.Dataset:
    """What goes to .csv, a row an instant: what changes with time, without the rotation of a frame that stands."""
    kept = data[[name for name in data.data_vars if "time" in data[name].dims]]
    return kept if kept.crank_angle.any() else kept.drop_vars(["speed", "crank_angle"])


def hand_over(answer: Answer, request: Request, status: str) -> None:
    """Deliver the answer; of a run that was stopped too, which then ends with the exit code of Ctrl-C."""
    stopped = status != "complete"
    if stopped:
        taken()
    deliver(answer, request)
    if stopped:
        raise Kept(f"{status}; what was reached is kept")


def warn_refined(run: xr.Dataset) -> None:
    """Say what the steps did to the run, and where an engine that should run on was stalled."""
    for told in ("refined", "damped", "unguarded", "energy_error", "unresolved", "restless", "unsynchronised"):
        if told in run.attrs:
            complain(str(run.attrs[told]), kind="warning")
    if run.attrs.get("scenario") in RUNNING:
        turning = run.angular_velocity.sel(node=run.attrs["crank"])
        if float(turning.min()) <= 0:
            at = units.show(float(run.time[int((turning.values <= 0).argmax())]), "time")
            complain(f"the engine stalls at {at}: what follows is no engine's motion any more", kind="warning")
