"""Interference diagram, and the speeds at which an order meets each mode by gear."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional import units
from torsional.numerics.arrays import Array
from torsional.plots import style

MARKERS = "osD^vPX*<>"
PATCH = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}
_PER_RPM = units.RPM / (2.0 * np.pi)
"""Frequency [Hz] of the first order per engine speed [rpm]."""

Names = Mapping[str, Sequence[str]]


@style.styled
def plot_campbell(
    result: xr.Dataset,
    names: Names | None = None,
    *,
    speed: tuple[float, float] | None = None,
    idle: float | None = None,
    axes: Axes | None = None,
) -> Figure:
    """Natural frequencies of every gear over engine speed with the engine orders; circles where the main one meets one.

    ``result`` as `campbell` gives it, the main order first; ``names``: {gear: one name a mode}; ``speed`` and ``idle``
    [rad/s] mark the operating range.
    """
    figure, drawn = style.on(axes, (8.0, 5.0))
    rpm = style.shown(result.speed)
    highest = _highest(result, rpm)
    for number, gear in enumerate(result.gear.values):
        colour = gear_colour(number, result.gear.size)
        for mode in result.mode.values[1:]:
            line = result.frequency.sel(gear=gear, mode=mode).values
            if np.nanmin(line) < 1.1 * highest:
                drawn.plot(rpm, line, color=colour, linewidth=1.2, gid="mode")
    for number, order in enumerate(result.order.values):
        _draw_order(drawn, float(order), rpm[-1], highest, style.DASHES[number % len(style.DASHES)])
    _mark_crossings(drawn, result, speed)
    _name_modes(drawn, result, names or {}, highest)
    drawn.set_xlim(0, rpm[-1] * 1.06)
    drawn.set_ylim(0, highest)
    style.operating_range(drawn, speed, idle)
    drawn.set_xlabel(style.label("speed", name="engine speed"))
    drawn.set_ylabel(style.label("frequency", name="natural frequency"))
    gear_bar(drawn, result.gear.values)
    return figure


def _highest(result: xr.Dataset, rpm: Array) -> float:
    """The main order's frequency at the highest speed and some room, so that what it can meet is seen."""
    if result.order.size:
        return 1.25 * float(result.order[0]) * float(rpm[-1]) * _PER_RPM
    return 1.1 * float(result.frequency.isel(mode=slice(0, 6)).max())


def _draw_order(axes: Axes, order: float, last: float, highest: float, dash: str) -> None:
    end = min(last, highest / (order * _PER_RPM))
    axes.plot([0, end], [0, order * end * _PER_RPM], color=style.INK, linestyle=dash, linewidth=1.3, gid="order")
    inside = 0.97 * end
    axes.annotate(
        f"order {order:g}",
        (inside, order * inside * _PER_RPM),
        fontsize=8,
        ha="right",
        va="bottom",
        bbox=PATCH,
    )


def _mark_crossings(axes: Axes, result: xr.Dataset, speed: tuple[float, float] | None) -> None:
    """A circle at each crossing with the main order in the operating range."""
    if not result.order.size:
        return
    main = float(result.order[0])
    met = result.crossing.isel(order=0).values.ravel()
    low, high = speed or (0.0, float(result.speed[-1]))
    at = met[np.isfinite(met) & (met >= low) & (met <= high)]
    label = f"order {main:g} meets a mode" + (" in the operating range" if speed else "")
    axes.plot(
        style.shown(at, "speed"),
        main * at / (2 * np.pi),
        "o",
        mfc="none",
        color=style.COLOURS[1],
        ms=6,
        label=label,
        zorder=5,
    )


def _name_modes(axes: Axes, result: xr.Dataset, names: Names, highest: float) -> None:
    """The last gear's mode names at the right edge, each above its line; of lines close together the upper is named."""
    gear = str(result.gear.values[-1])
    at = result.frequency.sel(gear=gear).isel(speed=-1).values
    above = np.inf
    for mode in range(len(names.get(gear, ())) - 1, 0, -1):
        if at[mode] < 0.96 * highest and above - at[mode] > 0.045 * highest:
            place = (float(style.shown(result.speed)[-1]), float(at[mode]))
            name = style.plain(names[gear][mode])
            axes.annotate(name, place, fontsize=7.5, ha="right", va="bottom", color=style.INK, bbox=PATCH)
            above = at[mode]


def gear_colour(number: int, count: int) -> tuple[float, float, float, float]:
    """A gear's colour, dark for the first and light for the last, the palest left out."""
    return mpl.colormaps[style.SEQUENCE](0.88 * number / max(count - 1, 1))


def gear_bar(axes: Axes, gears: Sequence[str]) -> None:
    """A legend with one entry a gear and whatever else has a label; nothing for a machine without gears."""
    for number, gear in enumerate(gears):
        if str(gear):
            axes.plot([], [], color=gear_colour(number, len(gears)), label=f"gear {style.plain(gear, 12)}")
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)


@style.styled
def plot_resonance_speeds(
    result: xr.Dataset,
    names: Names,
    *,
    speed: tuple[float, float] | None = None,
    idle: float | None = None,
    axes: Axes | None = None,
) -> Figure:
    """For every gear the speeds at which the main order meets its modes; ``names``: {gear: one name a mode}."""
    gears = [str(gear) for gear in result.gear.values]
    figure, drawn = style.on(axes, (8.0, 1.6 + 0.24 * len(gears)))
    rpm = style.shown(result.crossing.isel(order=0))
    last = 1.25 * float(style.shown(result.speed)[-1])
    found: dict[str, list[tuple[float, int]]] = {}
    for row, gear in enumerate(gears):
        for mode, at in enumerate(rpm[row]):
            if np.isfinite(at) and at <= last:
                found.setdefault(names[gear][mode], []).append((float(at), row))
    for number, (name, points) in enumerate(sorted(found.items(), key=lambda item: min(item[1]))):
        colour, marker = style.COLOURS[number % len(style.COLOURS)], MARKERS[number % len(MARKERS)]
        drawn.plot(*np.transpose(points), marker, color=colour, label=style.plain(name), markersize=6)
    drawn.set_xlim(0, last)
    drawn.set_ylim(len(gears) - 0.5, -0.5)
    drawn.set_yticks(range(len(gears)), [f"gear {style.plain(gear, 12)}" if gear else "" for gear in gears])
    style.operating_range(drawn, speed, idle)
    drawn.set_xlabel(
        style.label("speed", name=f"engine speed at which order {float(result.order[0]):g} meets the mode")
    )
    drawn.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
    return figure
