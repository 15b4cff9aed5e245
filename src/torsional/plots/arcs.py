"""Arc springs: loops over rotational speed with what they lose, and stiffness and losses over the angle."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.sweeps import LIMIT, plain_decades, wrapped

ROWS = {"truck": "truck's absorber", "long": "long arcs"}


@style.styled
def plot_arc_friction(data: xr.Dataset) -> Figure:
    """Closed loops of two absorbers at every speed; below, the loss over the speed and how many sections slide.

    ``data``: for "truck" and "long" the torque (speed, sample), angle, loss, stiffness, sliding (speed, sweep).
    """
    drawn = style.panels(2, 2, (5.0, 3.3))
    for axes, (name, words) in zip(drawn[:2], ROWS.items(), strict=True):
        _draw_loops(axes, data, name)
        axes.set_title(words, fontsize=9.0)
    rpm = style.shown(data.speed)
    for number, (name, words) in enumerate(ROWS.items()):
        look: dict[str, Any] = {"marker": "os"[number], "markersize": 4.0, "linestyle": style.DASHES[number]}
        ratio = data[f"{name}_stiffness"].values / data[f"{name}_stiffness"].values[0]
        drawn[2].plot(rpm, data[f"{name}_loss"].values / data[f"{name}_loss"].values[0], color=style.COLOURS[0],
                      label=f"loss per cycle, {words}", **look)  # fmt: skip
        drawn[2].plot(rpm, ratio, color=style.COLOURS[1], label=f"chord stiffness, {words}", **look)
        _draw_sliding(drawn[3], data, name, look)
    drawn[2].set_ylabel("over that at standstill [-]")
    drawn[2].set_xlabel(style.label("speed", name="rotational speed"))
    drawn[2].set_ylim(bottom=0.0)
    drawn[2].legend(loc="upper left")
    _finish_sliding(drawn[3], data)
    return style.figure_of(drawn[0])


def _draw_loops(axes: Axes, data: xr.Dataset, name: str) -> None:
    angle = style.shown(data[f"{name}_angle"])
    for number, speed in enumerate(style.shown(data.speed)):
        torque = style.shown(data[f"{name}_torque"].isel(speed=number))
        closed = np.append(angle, angle[:1]), np.append(torque, torque[:1])
        axes.plot(*closed, label=f"{speed:.0f} rpm", color=style.COLOURS[number], linewidth=1.3, zorder=9 - number)
    axes.set_xlabel(style.label("relative_angle", name="angle between the flywheels"))
    axes.set_ylabel(style.label("torque"))
    axes.legend(loc="upper left")


def _draw_sliding(axes: Axes, data: xr.Dataset, name: str, look: dict[str, Any]) -> None:
    sweep = style.shown(data[f"{name}_sweep"])
    for number, row in enumerate(style.shown(data[f"{name}_sliding"])):
        axes.plot(sweep, row, color=style.COLOURS[number], **look)


def _finish_sliding(axes: Axes, data: xr.Dataset) -> None:
    axes.set_xscale("log")
    plain_decades(axes.xaxis)
    for number, speed in enumerate(style.shown(data.speed)):
        axes.plot([], [], color=style.COLOURS[number], label=f"{speed:.0f} rpm")
    for number, words in enumerate(ROWS.values()):
        axes.plot([], [], color=style.FAINT, linestyle=style.DASHES[number], label=words)
    axes.set_ylim(0.0, 105.0)
    axes.set_ylabel("sections that slide on their guide [%]")
    axes.set_xlabel(style.label("relative_angle", name="sweep to either side"))
    axes.legend(loc="lower right")


@style.styled
def plot_arc_losses(data: xr.Dataset) -> Figure:
    """Chord stiffness, loss per vibration and loss factor over the angle, a mark for each loop by its ``state``."""
    drawn = style.panels(3, 1, (8.6, 2.3), sharex=True)
    told = {"stiffness": "chord stiffness", "loss": "loss per vibration", "loss_factor": "loss factor"}
    swing = style.shown(data.swing)
    for axes, (name, words) in zip(drawn, told.items(), strict=True):
        for number, state in enumerate(dict.fromkeys(data.state.values.tolist())):
            own = np.flatnonzero(data.state.values == state)
            own = own[np.argsort(swing[own])]
            colour, plain = style.COLOURS[number // 2], number % 2
            axes.plot(swing[own], style.shown(data[name])[own], color=colour, marker="os"[plain], gid="loop",
                      markerfacecolor="white" if plain else colour, linestyle="--" if plain else "none",
                      linewidth=1.0, markersize=6.0, label=wrapped(state))  # fmt: skip
        axes.set_yscale("log")
        plain_decades(axes.yaxis)
        unit = " [-]" if name == "loss_factor" else ""
        axes.set_ylabel(wrapped(style.label(str(data[name].attrs["quantity"]), name=words) + unit))
    for number, (at, words) in enumerate((("partly", "row slides in part"), ("wholly", "whole row slides: below"))):
        drawn[2].axhline(float(data.attrs[at]), color=(style.INK, LIMIT)[number], linewidth=1.0, linestyle=(0, (5, 2)),
                         label=f"{words} {data.attrs[at]:.2f}")  # fmt: skip
    for axes in (drawn[0], drawn[2]):
        handles, words_of = axes.get_legend_handles_labels()
        kept = slice(0, None) if axes is drawn[0] else slice(-2, None)
        axes.legend(handles[kept], words_of[kept], loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0)
    drawn[-1].set_xscale("log")
    drawn[-1].xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    drawn[-1].set_xlabel(style.label("relative_angle", "half peak-to-peak", "angle between the flywheels"))
    return style.figure_of(drawn[0])
