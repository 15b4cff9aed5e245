"""Runs in time: engine starts, shifts, clutch engagements."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.errors import ModelError, nearest
from torsional.files.scenario import scenario_from_document
from torsional.files.scenario_blocks import VERSION
from torsional.files.scenario_schema import KINDS
from torsional.model import Model
from torsional.studies.scenarios.running import run_scenario
from torsional.units import quoted, show
from torsional.workbench.background.asking import Found, Long, Name, Progress
from torsional.workbench.fields import words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAMPLES = 4000
"""Instants that a page is sent of each channel, extremes between them kept."""


class ScenarioRun(Long):
    """A scenario by its name, with ``values`` for its keys as its file would have them."""

    scenario: Name
    values: Annotated[dict[Name, Any], Field(max_length=40)] = Field({})

    def found(self, model: Model, progress: Progress) -> Found:
        """Speeds, twists and torques over time, what was done, and what it came to."""
        if self.scenario not in KINDS:
            where, remedy = "settings.scenario", nearest(self.scenario, KINDS)
            raise ModelError("there is no such scenario", where=where, found=quoted(self.scenario), remedy=remedy)
        block = scenario_from_document(self._document())

        def moved(time: float, end: float, speed: float) -> None:
            done = round(1000 * min(max(time / end, 0.0), 1.0)) if end > 0 else 0
            progress(done, 1000, f"{max(time, 0.0):.2f} of {end:g} s")

        run = run_scenario(model, block, moved)
        return Found(_content(run), lambda: _picture(run), _table(run))

    def _document(self) -> dict[str, Any]:
        named = {"torsional_scenario": VERSION, "scenario": self.scenario}
        for key in named.keys() & self.values.keys():
            raise ModelError("the scenario is chosen already", where=f"settings.values.{key}")
        document = {**named, **self.values}
        if self.gear and "gear" in KINDS[self.scenario].model_fields:
            document.setdefault("gear", self.gear)
        return document


def _places(run: xr.Dataset) -> tuple[list[str], list[str]]:
    """The nodes and the connections worth looking at."""
    listed = {key: json.loads(run.attrs[key]) for key in ("springs", "watched", "looked_at")}
    nodes = dict.fromkeys([str(run.attrs["crank"]), *listed["looked_at"]])
    return list(nodes), list(dict.fromkeys([*listed["springs"], *listed["watched"]]))


def _content(run: xr.Dataset) -> dict[str, Any]:
    kept = _kept(run)
    return {
        "title": str(run.attrs["title"]),
        "gear": str(run.attrs["gear"]),
        "status": str(run.attrs["status"]),
        "time": run.time.values[kept],
        "channels": list(_channels(run, kept)),
        "moved": _moved(run, kept),
        "events": list(_events(run)),
        "stops": _stops(run),
        "measures": list(_measures(run)),
        "notes": [
            str(run.attrs[key])
            for key in ("refined", "damped", "unguarded", "energy_error", "unresolved", "restless", "unsynchronised")
            if key in run.attrs
        ],
    }


def _kept(run: xr.Dataset) -> np.ndarray:
    """Places along time of what is sent: of each stretch the instants at which a torque or speed is largest and
    smallest, so that no peak is lost."""
    nodes, elements = _places(run)
    count = run.sizes["time"]
    if count <= SAMPLES:
        return np.arange(count)
    signals = [*run.torque.sel(element=elements).values.T, *run.angular_velocity.sel(node=nodes).values.T]
    edges = np.unique(np.linspace(0, count, max(SAMPLES // (2 * len(signals)), 200) + 1).astype(int))
    found = {0, count - 1}
    for first, last in pairwise(edges):
        for signal in signals:
            found |= {first + int(signal[first:last].argmin()), first + int(signal[first:last].argmax())}
    return np.array(sorted(found))


def _channels(run: xr.Dataset, kept: np.ndarray) -> Iterator[dict[str, Any]]:
    nodes, elements = _places(run)
    for kind, dim, places, quantity in (
        ("angular_velocity", "node", nodes, "angular_velocity"),
        ("twist", "element", elements, "relative_angle"),
        ("torque", "element", elements, "torque"),
    ):
        for place in places:
            values = run[kind].sel({dim: place}).values[kept]
            yield {
                "name": f"{kind}:{place}",
                "label": f"{_WORDS[kind]} of {words(place)}",
                "quantity": quantity,
                "values": values,
            }
    if "event" in run.coords:
        told = json.loads(run.attrs["schedule_quantities"])
        for event in map(str, run.event.values):
            values = run.schedule.sel(event=event).values[kept]
            yield {"name": f"done:{event}", "label": event, "quantity": told.get(event) or None, "values": values}


_WORDS = {"angular_velocity": "speed", "twist": "twist", "torque": "torque"}


def _moved(run: xr.Dataset, kept: np.ndarray) -> dict[str, Any]:
    """Angles [rad] of all nodes beyond the mean rotation, by node and time, and how fast each turns to the crank."""
    return {
        "crank": str(run.attrs["crank"]),
        "nodes": [str(name) for name in run.node.values],
        "speed_ratio": run.speed_ratio.values,
        "angle": run.angle.transpose("node", "time").values[:, kept],
    }


def _events(run: xr.Dataset) -> Iterator[dict[str, Any]]:
    """When something begins: phases, and what is done."""
    if "phase" in run.coords:
        for name, begin in zip(run.phase.values, run.phase_begin.values, strict=True):
            yield {"time": float(begin), "text": str(name)}
    if "event" in run.coords:
        for event in run.event.values:
            values = run.schedule.sel(event=event).values
            moved = np.flatnonzero(np.diff(values) != 0)
            if moved.size:
                yield {"time": float(run.time[int(moved[0])]), "text": str(event)}


def _stops(run: xr.Dataset) -> dict[str, list[float]]:
    """The stops of the springs [rad]."""
    _, elements = _places(run)
    ends = {e: [float(run[name].sel(element=e)) for name in ("stop_below", "stop_above")] for e in elements}
    return {name: both for name, both in ends.items() if np.isfinite(both).all()}


def _measures(run: xr.Dataset) -> Iterator[dict[str, Any]]:
    _, elements = _places(run)
    for place in elements:
        one = run.sel(element=place)
        for name, told, quantity in (
            ("torque_highest", "highest torque", "torque"),
            ("torque_lowest", "lowest torque", "torque"),
            ("twist_highest", "highest twist", "relative_angle"),
            ("twist_lowest", "lowest twist", "relative_angle"),
        ):
            yield _measure(f"{name}:{place}", f"{told} of {words(place)}", quantity, float(one[name]))
        if np.isfinite(float(one.stop_above)):
            text = f"times {words(place)} met its stop"
            yield _measure(f"stop_contacts:{place}", text, None, float(one.stop_contacts))
    for share in ("friction", "dampers", "contacts"):
        if share in run.share.values:
            yield _measure(f"lost:{share}", f"lost in {share}", "energy", float(run.energy.sel(share=share)[-1]))


def _measure(name: str, label: str, quantity: str | None, value: float) -> dict[str, Any]:
    text = f"{value:g}" if quantity is None else show(value, quantity)
    return {"name": name, "label": label, "quantity": quantity, "value": value, "text": text}


def _picture(run: xr.Dataset) -> Figure:
    from torsional.plots import plot_scenario

    return plot_scenario(run)


def _table(run: xr.Dataset) -> xr.Dataset:
    """Every instant of the signals at the places looked at."""
    nodes, elements = _places(run)
    kept = run[[name for name in ("angular_velocity", "twist", "torque") if name in run]]
    return kept.sel(node=nodes, element=elements)
