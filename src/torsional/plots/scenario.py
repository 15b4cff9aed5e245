"""Scenarios: what was done over time above what it did to speeds, twists and torques."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.transient import draw_motion
from torsional.units import show

ROW = 0.32
"""Height [inch] of the strip of one event."""
SLANTED = 38.0
"""Room [points] for the names of phases, aslant, under the title."""
GLYPH = 0.011
"""Width of a letter above the strips over that of the panels."""
FILLS = ("#c9dcea", "#f3d9c0", "#cfe6da", "#ead6e2")


@style.styled
def plot_scenario(run: xr.Dataset) -> Figure:
    """A strip for each thing done, then speeds, twists of the absorber's springs with their stops, and torques.

    ``run``: of `run_scenario`.
    """
    events = run.event.values if "event" in run.coords else np.zeros(0)
    strip = ROW * max(len(events), 1) + 0.1
    figure = Figure(figsize=(8.6, 6.9 + strip))
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(4, 1, height_ratios=[strip, 2.1, 2.4, 2.4])
    last = figure.add_subplot(grid[3, 0])
    drawn = [figure.add_subplot(grid[row, 0], sharex=last) for row in (0, 1, 2)] + [last]
    nodes = list(dict.fromkeys([run.attrs["crank"], *_listed(run, "looked_at")]))
    draw_motion(drawn[1:], run, nodes, _listed(run, "springs"), _listed(run, "watched"))
    _draw_events(drawn[0], run)
    _draw_capacity(last, run)
    _draw_phases(drawn, run)
    for axes in drawn[:-1]:
        axes.tick_params(labelbottom=False)
    last.set_xlabel("time [s]")
    drawn[0].set_title(style.plain(_title(run), 100), loc="left", pad=SLANTED if "phase" in run.coords else None)
    return figure


def _draw_events(axes: Axes, run: xr.Dataset) -> None:
    """One strip an event, as high as the event is strong, named with its largest value."""
    axes.grid(visible=False)
    axes.set_yticks([])
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(bottom=False)
    if "schedule" not in run:
        return
    told = json.loads(run.attrs["schedule_quantities"])
    for row, event in enumerate(run.event.values):
        values = run.schedule.sel(event=event).values
        low, most = min(values.min(), 0.0), np.abs(values).max() or 1.0
        base, share = -row, 0.8 * (values - low) / (most - low)
        axes.fill_between(run.time.values, base, base + share, color=FILLS[row % len(FILLS)], linewidth=0, gid="event")
        axes.plot(run.time.values, base + share, color=style.FAINT, linewidth=0.8)
        named = style.plain(event) + (f", up to {show(float(most), told[event])}" if told.get(event) else "")
        axes.text(0.995, base + 0.4, named, transform=axes.get_yaxis_transform(), ha="right", va="center", fontsize=8)
    axes.set_ylim(0.1 - len(run.event), 1.0)


def _draw_phases(drawn: Sequence[Axes], run: xr.Dataset) -> None:
    """A line through all panels where a phase begins, and its name above, aslant where there is little room."""
    if "phase" not in run.coords:
        return
    top, whole = drawn[0], float(run.time[-1] - run.time[0])
    for place, begin in enumerate(run.phase_begin.values):
        for axes in drawn if place else ():
            axes.axvline(float(begin), color=style.FAINT, linewidth=0.8, linestyle=(0, (2, 2)), zorder=0.5, gid="phase")
    for name, begin, end in zip(run.phase.values, run.phase_begin.values, run.phase_end.values, strict=True):
        told = style.plain(str(name))
        top.text(
            float(begin) + 0.004 * whole,
            1.02,
            told,
            transform=top.get_xaxis_transform(),
            fontsize=7.5,
            va="bottom",
            rotation=0 if len(told) * GLYPH < (end - begin) / whole else 25,
        )


def _draw_capacity(axes: Axes, run: xr.Dataset) -> None:
    """What linings among the elements could carry at most, as a dashed line that does not widen the picture."""
    name = "clutch capacity"
    if "schedule" not in run or name not in run.event.values:
        return
    low, high = axes.get_ylim()
    values = style.shown(run.schedule.sel(event=name), "torque")
    axes.plot(run.time.values, values, color=style.INK, linestyle=(0, (4, 2)), linewidth=1.0, label=name)
    axes.set_ylim(low, high)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=4, borderpad=0.1)


def _title(run: xr.Dataset) -> str:
    stopped = str(run.attrs.get("status", "complete"))
    return str(run.attrs.get("title", "")) + ("" if stopped == "complete" else f" ({stopped})")


def _listed(run: xr.Dataset, key: str) -> list[str]:
    value = run.attrs.get(key, [])
    return json.loads(value) if isinstance(value, str) else list(value)
