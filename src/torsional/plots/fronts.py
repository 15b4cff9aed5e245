"""Pictures of optimisations: designs and their Pareto front, chosen designs over speed."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style

MARKERS = "sD^v*<>"
BEYOND, INSIDE = "#e3b9b5", "#b8c4d0"
"""Colours of designs beyond a limit, and of those that keep all limits."""
FAR = 3.0
"""Designs this many times as far out as the front and the nominal design reach are left out of the picture."""


@style.styled
def plot_front(data: xr.Dataset) -> Figure:
    """Designs by their objectives, two a panel, with the front and the designs that stand out; of one objective the
    best design so far."""
    objectives = json.loads(data.attrs["objectives"])
    if len(objectives) == 1:
        return _course(data, objectives[0])
    pairs = [(objectives[0], other) for other in objectives[1:]]
    drawn = style.panels(1, len(pairs), (8.6 if len(pairs) == 1 else 5.2, 4.6))
    for axes, (first, second) in zip(drawn, pairs, strict=True):
        _pair(axes, data, first, second)
    drawn[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return style.figure_of(drawn[0])


def _pair(axes: Axes, data: xr.Dataset, first: str, second: str) -> None:
    x, y = (style.shown(data[name]) for name in (first, second))
    on, within = data.on_front.values, data.within.values
    seen = on | (data.generation.values == 0)
    for values, limit in ((x, axes.set_xlim), (y, axes.set_ylim)):
        if seen.any() and np.nanmin(values[seen]) >= 0:
            limit(0.0, 1.08 * min(np.nanmax(values), FAR * np.nanmax(values[seen]) / 2 + np.nanmax(values[seen]) / 2))
    tried = np.isfinite(x) & np.isfinite(y)
    axes.plot(x[tried & ~within], y[tried & ~within], ".", color=BEYOND, markersize=3.5, label="beyond a limit")
    axes.plot(x[within], y[within], ".", color=INSIDE, markersize=4.5, label="keeps all limits")
    _staircase(axes, x[on], y[on])
    _stand_out(axes, data, x, y)
    axes.set_xlabel(label_of(data, first))
    axes.set_ylabel(label_of(data, second))


def _staircase(axes: Axes, x: Array, y: Array) -> None:
    rise = np.argsort(x)
    axes.plot(x[rise], y[rise], "-o", color=style.COLOURS[0], markersize=4.0, label="Pareto front")


def _stand_out(axes: Axes, data: xr.Dataset, x: Array, y: Array) -> None:
    final = [n for n, told in enumerate(data.role.values) if any(e and "before" not in e for e in told.split("; "))]
    for number, place in enumerate(final):
        told = "\n".join(_told(each) for each in str(data.role.values[place]).split("; ") if "before" not in each)
        look: dict[str, Any] = {
            "color": style.INK if told == "nominal" else style.COLOURS[1 + number % 5],
            "markersize": 8.0,
        }
        axes.plot(x[place], y[place], MARKERS[number % len(MARKERS)], label=told, markeredgecolor="white", **look)


def label_of(data: xr.Dataset, name: str) -> str:
    """A criterion as an axis label."""
    quantity = str(data[name].attrs.get("quantity", "number"))
    return style.label(quantity, "", style.readable(name))


def _course(data: xr.Dataset, name: str) -> Figure:
    """The best figure so far, design by design."""
    axes = style.panels(size=(7.0, 3.8))[0]
    largest = name in json.loads(data.attrs["maximised"])
    values, within = style.shown(data[name]), data.within.values
    so_far = (np.fmax if largest else np.fmin).accumulate(np.where(within, values, np.nan))
    axes.plot(np.arange(values.size)[within], values[within], ".", color=INSIDE, label="keeps all limits")
    axes.plot(so_far, color=style.COLOURS[0], label="best so far")
    axes.set_xlabel("designs asked")
    axes.set_ylabel(label_of(data, name))
    axes.legend(loc="upper right")
    return style.figure_of(axes)


@style.styled
def plot_chosen(data: xr.Dataset) -> Figure:
    """The ``acceleration`` of chosen designs (role, speed) over engine speed."""
    axes = style.panels(size=(8.6, 4.2))[0]
    speed = style.shown(data.speed)
    for number, name in enumerate(data.role.values):
        look: dict[str, Any] = (
            {"color": style.INK, "linestyle": "--"} if name == "nominal" else {"color": style.COLOURS[number % 6]}
        )
        axes.plot(speed, style.shown(data.acceleration.isel(role=number)), label=_told(str(name)), **look)
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(speed[0], speed[-1])
    axes.set_xlabel(style.label("speed"))
    axes.set_ylabel(style.label("acceleration", "half peak-to-peak", "gearbox input, acceleration"))
    axes.legend(loc="upper right")
    return style.figure_of(axes)


def _told(name: str) -> str:
    return style.plain(name.replace("_", " "), 60)


@style.styled
def plot_fronts(data: xr.Dataset) -> Figure:
    """Fronts of several concepts (``concept``, ``point``) on one pair of logarithmic axes, with their nominal designs.

    Read: ``low_speed``, ``high_speed`` (concept, point), ``nominal_low_speed``, ``nominal_high_speed``, ``knee``
    (concept), which of the points it is.
    """
    axes = style.panels(size=(8.6, 5.4))[0]
    for number, concept in enumerate(data.concept.values):
        one = data.isel(concept=number)
        colour, marker = style.COLOURS[number % 6], "os^Dv"[number % 5]
        x, y = style.shown(one.low_speed), style.shown(one.high_speed)
        known = np.isfinite(x)
        axes.plot(x[known], y[known], "-", color=colour, marker=marker, markersize=5.0, label=style.plain(concept))
        at = int(one.knee)
        if at >= 0:
            axes.plot(x[at], y[at], marker, color=colour, markersize=11.0, markerfacecolor="none", markeredgewidth=1.6)
        own = style.shown(one.nominal_low_speed), style.shown(one.nominal_high_speed)
        axes.plot(*own, "x", color=colour, markersize=8.0, markeredgewidth=2.0)
    axes.plot([], [], "x", color=style.FAINT, markeredgewidth=2.0, label="as it is")
    axes.plot([], [], "o", color=style.FAINT, markersize=11.0, markerfacecolor="none", label="knee")
    for scale, axis in ((axes.set_xscale, axes.xaxis), (axes.set_yscale, axes.yaxis)):
        scale("log")
        plain_decades(axes, axis.axis_name)
    low, high = (json.loads(data.attrs[name]) for name in ("low_range", "high_range"))
    axes.set_xlabel(_worst(low))
    axes.set_ylabel(_worst(high))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return style.figure_of(axes)


def _worst(ends: Sequence[float]) -> str:
    low, high = (float(v) for v in style.shown(np.array(ends), "speed"))
    return f"worst of {low:.0f} to {high:.0f} rpm, all gears,\ngearbox input [rad/s²], half peak-to-peak"


def plain_decades(axes: Axes, which: str) -> None:
    """Numbers as they are spoken at 1, 2 and 5 of each decade."""
    low, high = axes.get_xlim() if which == "x" else axes.get_ylim()
    ticks = [float(m * 10.0**d) for d in range(-2, 6) for m in (1, 2, 5) if low <= m * 10.0**d <= high]
    set_ticks = axes.set_xticks if which == "x" else axes.set_yticks
    set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    set_ticks([], minor=True)
