"""Hysteresis loops of an absorber at several rotational speeds, and what they amount to."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from torsional.plots import style

_FIGURES = (
    ("stiffness", "stiffness", "stiffness"),
    ("loss_factor", "loss_factor", "loss factor"),
    ("sliding", "number", "sliding elements"),
)
_WIDE = 4.0
"""Ratio of the largest to the smallest sweep from which on they are drawn on a logarithmic scale."""


@style.styled
def plot_hysteresis(loops: xr.Dataset, *, title: str = "") -> Figure:
    """Loops at every speed under the largest sweep; beside them stiffness, loss factor and what slides, over the sweep
    (over the speed where there is one sweep).

    ``loops`` as `torsional.solvers.hysteresis.hysteresis` gives them.
    """
    several = loops.sizes["speed"] * loops.sizes["sweep"] > 1
    figure = Figure(figsize=(10.5 if several else 6.4, 5.4))
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(1, 2 if several else 1, width_ratios=[1.6, 1.0][: 2 if several else 1])
    loop = figure.add_subplot(grid[0, 0])
    plot_hysteresis_loops(loops.isel(sweep=-1), axes=loop)
    loop.set_title(style.plain(title, 80), loc="left")
    if several:
        shown = [entry for entry in _FIGURES if entry[0] != "sliding" or bool(loops.rubs.any())]
        rows = grid[0, 1].subgridspec(len(shown), 1)
        first = None
        for row, (name, quantity, told) in enumerate(shown):
            axes = figure.add_subplot(rows[row, 0], sharex=first)
            _draw_figures(axes, loops, name, quantity, told, last=row == len(shown) - 1)
            first = first or axes
    return figure


@style.styled
def plot_hysteresis_loops(loops: xr.Dataset, *, axes: Axes | None = None) -> Figure:
    """Torque over angle of one sweep, a closed loop for each speed; dotted the first loading from rest."""
    figure, drawn = style.on(axes, (6.4, 5.4))
    angle = style.shown(loops.drive_angle, "relative_angle")
    quarter = angle.size // 4
    for number, speed in enumerate(style.shown(loops.speed, "speed")):
        look: dict[str, Any] = {"color": style.COLOURS[number % len(style.COLOURS)], "zorder": 20 - number}
        torque = style.shown(loops.drive_torque.isel(speed=number), "torque")
        first, closed = torque[0], torque[1]
        closed, x = np.append(closed, closed[:1]), np.append(angle, angle[:1])
        drawn.plot(x, closed, gid="loop", label=f"{speed:.0f} rpm", **look)
        drawn.plot(angle[:quarter], first[:quarter], gid="first", linestyle=":", linewidth=1.0, **look)
    drawn.plot([], [], color=style.INK, linestyle=":", linewidth=1.0, label="first loading")
    drawn.set_xlabel(style.label("relative_angle", name=f"angle of {_words(loops)}"))
    drawn.set_ylabel(style.label("torque"))
    drawn.legend(loc="upper left")
    return figure


def _words(loops: xr.Dataset) -> str:
    return " against ".join(style.readable(loops.attrs[name]) for name in ("turned", "held"))


def _draw_figures(axes: Axes, loops: xr.Dataset, name: str, quantity: str, told: str, last: bool) -> None:
    """One figure over the sweep, a line for each speed; over the speed where there is one sweep."""
    along = "sweep" if loops.sizes["sweep"] > 1 else "speed"
    kind = "relative_angle" if along == "sweep" else "speed"
    x = style.shown(loops[along], kind)
    lines = loops[name] if along == "sweep" else loops[name].isel(sweep=[0]).transpose("sweep", "speed")
    for number, line in enumerate(lines.values):
        colour = style.COLOURS[number % len(style.COLOURS)] if along == "sweep" else style.INK
        axes.plot(x, style.shown(line, quantity), color=colour, marker="o", markersize=3.5, gid=name)
    if along == "sweep" and x.max() > _WIDE * x.min():
        axes.set_xscale("log")
        axes.set_xticks(x, [f"{value:g}" for value in x])
        axes.minorticks_off()
    axes.margins(y=0.08)
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(style.label(quantity, name=told))
    axes.tick_params(labelbottom=last)
    if last:
        axes.set_xlabel(style.label(kind, name="sweep to either side" if along == "sweep" else ""))
