"""Down-speeding: what it costs in every gear, and how far each absorber goes for its inertia."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from torsional.plots import style
from torsional.units import RPM

MARKS = ("o", "s", "^", "D")
MET = 1.005
"""Twist over the way to the stop from which a spring is said to meet it."""


@style.styled
def plot_worst_by_gear(data: xr.Dataset) -> Figure:
    """``worst`` over gears, a line for each case; the Dataset's ``limit`` [rad/s²] as a line."""
    axes = style.panels(size=(8.4, 4.4))[0]
    place = np.arange(data.gear.size)
    for number, case in enumerate(data.case.values):
        colour, dash = style.COLOURS[number // 2], style.DASHES[number % 2]
        mark = MARKS[number // 2]
        axes.semilogy(place, data.worst.sel(case=case), dash, color=colour, marker=mark, markersize=4, label=str(case))
    axes.axhline(data.attrs["limit"], color=style.INK, linewidth=1.0, linestyle=(0, (1, 1)), label="1.1 × SMF of today")
    axes.set_xticks(place, [style.plain(gear) for gear in data.gear.values])
    axes.set_xlabel("gear")
    axes.set_ylabel(style.label("acceleration", "half peak-to-peak", "worst firing-order acceleration"))
    axes.set_ylim(bottom=0.7 * float(data.worst.min()))
    _plain_decades(axes)
    _beside(axes)
    return style.figure_of(axes)


@style.styled
def plot_down_speeding(data: xr.Dataset) -> Figure:
    """The Dataset of the study: attainable down-speeding over inertia, worst of each range, worst in every gear."""
    drawn = style.panels(3 if data.inertia.size else 2, 1, (9.4, 4.0))
    if data.inertia.size:
        _draw_chart(drawn[0], data)
    _draw_ranges(drawn[-2], data)
    _draw_gears(drawn[-1], data)
    return style.figure_of(drawn[0])


def _draw_chart(axes: Axes, data: xr.Dataset) -> None:
    """Lines: matched at each inertia; large marks: the absorber with its own inertia, matched (full) and as it is."""
    for number, concept in enumerate(data.concept.values):
        row = data.sel(concept=concept)
        own, (bare, best) = float(row.own_inertia), row.attainable.values / RPM
        size, rpm = np.append(row.inertia.values, own), np.append(row.attainable_by_inertia.values / RPM, best)
        order = np.argsort(size)
        look: dict[str, Any] = {"color": style.COLOURS[number], "marker": MARKS[number % len(MARKS)]}
        told = str(concept) + ("" if np.isfinite(best) else ",\nabove the limit\nwith its own inertia")
        axes.plot(size[order], rpm[order], markersize=4, label=told, **look)
        axes.plot(own, best, markersize=9, **look)
        axes.plot(own, bare, markersize=9, fillstyle="none", markeredgewidth=1.5, clip_on=False, zorder=5, **look)
    cap = float(data.attrs["cap"]) / RPM
    axes.axhline(cap, color=style.FAINT, linewidth=1.0, linestyle=(0, (4, 2)))
    axes.annotate("farthest tried", (0.01, cap), xycoords=("axes fraction", "data"), va="bottom", fontsize=8)
    axes.set_ylim(0, 1.08 * cap)
    axes.set_xlabel(style.label("inertia", name="inertia of the whole absorber"))
    axes.set_ylabel("attainable down-speeding [rpm]")
    axes.set_title(
        f"Down-speeding within {data.attrs['limit']:.0f} rad/s² at the gearbox input, matched at each inertia"
    )
    whole: dict[str, Any] = {"color": style.FAINT, "marker": "o", "linestyle": "", "markersize": 9}
    axes.plot([], [], label="own inertia, matched", **whole)
    axes.plot([], [], fillstyle="none", label="own inertia, as it is", **whole)
    _beside(axes)


def _draw_ranges(axes: Axes, data: xr.Dataset) -> None:
    """Bars in groups: a group for each concept and design, a bar for each range, its worst gear written in it."""
    groups = [(concept, design) for concept in data.concept.values for design in data.design.values]
    wide, shades = 0.86 / data.by.size, np.linspace(0.4, 1.0, data.by.size)
    low = 0.4 * float(data.worst.min())
    for number, (concept, design) in enumerate(groups):
        for place in range(data.by.size):
            one = data.sel(concept=concept, design=design).isel(by=place)
            at, value = number + (place - 0.5 * (data.by.size - 1)) * wide, float(one.worst)
            look: dict[str, Any] = {"hatch": "////"} if float(one.stop_reach) > MET else {}
            colour = style.COLOURS[number // data.design.size]
            axes.bar(at, value, 0.94 * wide, color=colour, alpha=shades[place], edgecolor="white", **look)
            axes.annotate(f"{value:.0f}", (at, value), ha="center", va="bottom", fontsize=6.0, rotation=45)
            axes.annotate(str(one.worst_gear.item()), (at, 1.1 * low), ha="center", fontsize=7.0)
    axes.axhline(data.attrs["limit"], color=style.INK, linewidth=1.0, linestyle=(0, (1, 1)))
    axes.set_yscale("log")
    axes.set_ylim(low, 2.2 * float(data.worst.max()))
    _plain_decades(axes)
    names = [f"{style.plain(concept).replace(' with ', chr(10) + 'with ')}\n{design}" for concept, design in groups]
    axes.set_xticks(range(len(groups)), names)
    axes.grid(False, axis="x")
    axes.set_title("Worst over all gears, which stands at the foot")
    axes.set_ylabel(style.label("acceleration", "half peak-to-peak", "acceleration"))
    keys = [
        Patch(facecolor=style.FAINT, alpha=a, label=_range(by)) for a, by in zip(shades, data.by.values, strict=True)
    ]
    stop = Patch(facecolor="white", edgecolor=style.FAINT, hatch="////", label="springs meet\ntheir stop")
    _beside(axes, handles=[*keys, stop, _limit_key()])


def _draw_gears(axes: Axes, data: xr.Dataset) -> None:
    """The worst in every gear, matched: a colour for each concept, a dash for each range."""
    place = np.arange(data.gear.size)
    for number, concept in enumerate(data.concept.values):
        rows = data.worst_by_gear.sel(concept=concept, design=data.design.values[-1])
        for step in range(data.by.size):
            label = str(concept) if step == 0 else None
            look = {"linestyle": style.DASHES[step % 4], "color": style.COLOURS[number]}
            axes.semilogy(place, rows.isel(by=step), label=label, **look)
    axes.axhline(data.attrs["limit"], color=style.INK, linewidth=1.0, linestyle=(0, (1, 1)))
    _plain_decades(axes)
    axes.set_xticks(place, [style.plain(gear) for gear in data.gear.values])
    axes.set_xlabel("gear")
    axes.set_title("Matched for each range, in every gear")
    axes.set_ylabel(style.label("acceleration", "half peak-to-peak", "acceleration"))
    for step, by in enumerate(data.by.values):
        axes.plot([], [], style.DASHES[step % 4], color=style.FAINT, label=_range(by))
    _beside(axes, handles=[*axes.get_legend_handles_labels()[0], _limit_key()])


def _limit_key() -> Line2D:
    return Line2D([], [], color=style.INK, linewidth=1.0, linestyle=(0, (1, 1)), label="limit")


def _range(by: float) -> str:
    return f"{by / RPM:.0f} rpm down" if by else "range of today"


def _beside(axes: Axes, **handles: Any) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), **handles)


def _plain_decades(axes: Axes) -> None:
    """Numbers as they are spoken at 1, 2 and 5 of each decade."""
    low, high = axes.get_ylim()
    ticks = [float(m * 10**d) for d in range(6) for m in (1, 2, 5) if low <= m * 10**d <= high]
    axes.set_yticks(ticks, [f"{tick:.0f}" for tick in ticks])
    axes.set_yticks([], minor=True)
