"""Curves over one swept parameter, a panel for every quantity: the picture of a study that needs none of its own."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Sequence
from copy import copy
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.plots import style

LIMIT = "#b3261e"
MARKED = 26
"""Points up to which each bears a marker."""
MARKERS = "osD^v*<>"
POINTS = {"linestyle": "none", "marker": "x", "markersize": 7.0, "markeredgewidth": 1.8, "zorder": 6, "clip_on": False}
"""How single places look, whole at the edges of the picture too."""
WIDTH, HEIGHT, LONE = 8.6, 2.4, 3.6
"""Size of the picture and of its panels [inch]; height of one that stands alone."""
SHORT = 0.05
"""Times below it [s] are told in milliseconds."""
WRAP = 29
"""Letters of a line of an axis label or a legend."""


@style.styled
def plot_sweep(data: xr.Dataset) -> Figure:
    """Every real variable over the Dataset's one dimension: a panel for each quantity, legends beside the panels.

    Read from attributes where they are there: ``words`` (of a curve, of the coordinate), ``panel`` (what a panel
    shows; curves of one quantity and panel share one), ``amplitude`` (0-peak or half peak-to-peak), ``limit`` in SI
    with ``limit_words`` (a dashed line), ``points`` (markers only, in the colour of the curve that they are ``like``),
    ``scale`` "log", ``inverse`` (what one over the coordinate is called, told along the upper edge); of the Dataset
    ``speed_range``
    [rad/s], shaded wherever an axis is a speed.  What is infinite is marked at the panel's upper edge.  Values over
    names (gears) are told point by point.  Raises ModelError for a Dataset without such curves.
    """
    along, panels = _panels(data)
    size = (WIDTH, LONE if len(panels) == 1 else HEIGHT)
    drawn = style.panels(len(panels), 1, size, sharex=True)
    for axes, curves in zip(drawn, panels, strict=True):
        draw_curves(axes, data, along, curves)
    _label_along(drawn, data[along])
    return style.figure_of(drawn[0])


def _panels(data: xr.Dataset) -> tuple[str, list[list[str]]]:
    """The swept coordinate, and the variables of each panel."""
    curves = [str(name) for name, v in data.data_vars.items() if v.ndim == 1 and v.dtype.kind == "f"]
    if not curves:
        raise ModelError("a sweep is drawn from real variables over one dimension", found=", ".join(map(str, data)))
    along = str(data[curves[0]].dims[0])
    groups: dict[tuple[str, str], list[str]] = {}
    for name in curves:
        told = data[name].attrs
        if data[name].dims == (along,):
            groups.setdefault((told.get("quantity", ""), told.get("panel", "")), []).append(name)
    return along, list(groups.values())


def draw_curves(axes: Axes, data: xr.Dataset, along: str, curves: Sequence[str]) -> None:
    """The curves of one panel with its limits, shades, label and legend."""
    x = positions(data[along])
    for place, name in enumerate(curves):
        like = data[name].attrs.get("like")
        number = curves.index(like) if like in curves else place
        if data[along].dtype.kind == "f" or along == "gear":
            _draw_curve(axes, x, data[name], number)
        else:
            _draw_bars(axes, x, data[name], (number, len(curves)))
    first = data[curves[0]].attrs
    if all(data[name].attrs.get("scale") == "log" for name in curves):
        axes.set_yscale("log")
        plain_decades(axes.yaxis)
    _from_zero(axes, [style.shown(data[name]) for name in curves])
    _limits(axes, [data[name] for name in curves])
    _beyond(axes, x, [data[name] for name in curves])
    _shade(axes, data, along, str(first.get("quantity", "")))
    quantity, panel = str(first.get("quantity", "")), str(first.get("panel", ""))
    axes.set_ylabel(wrapped(axis_label(quantity, amplitude(data, curves[0]), panel)))
    _legend(axes, several=len(curves) > 1)


def positions(along: xr.DataArray) -> Array:
    """Places on the axis: values in the shown unit (short times in ms), or the numbers of names."""
    if along.dtype.kind != "f":
        return np.arange(along.size, dtype=float)
    return style.shown(along) * (1e3 if _short(along) else 1.0)


def _short(along: xr.DataArray) -> bool:
    """Whether times are told in milliseconds."""
    return bool(along.attrs.get("quantity") == "time" and along.values.max() < SHORT)


def amplitude(data: xr.Dataset, name: str) -> str:
    """The convention by which a variable's amplitudes are told, the Dataset's own for accelerations."""
    told = data[name].attrs
    whole = data.attrs.get("amplitude", "") if told.get("quantity") == "acceleration" else ""
    return str(told.get("amplitude", whole))


def axis_label(quantity: str, convention: str = "", words: str = "") -> str:
    """An axis label whose unit stands there for plain numbers too."""
    told = style.label(quantity, "", words) if quantity else words
    told += " [-]" if quantity and style.shown_unit(quantity) == "-" else ""
    return told + (f", {convention}" if convention else "")


def wrapped(text: str) -> str:
    """A label in lines."""
    return "\n".join(textwrap.wrap(text, WRAP))


def named(curve: xr.DataArray) -> str:
    """What a curve is called in a legend."""
    return wrapped(style.plain(curve.attrs.get("words") or style.readable(curve.name), 90))


def _draw_curve(axes: Axes, x: Array, curve: xr.DataArray, number: int) -> None:
    values = np.where(np.isfinite(curve.values), style.shown(curve), np.nan)
    look: dict[str, Any] = {"color": style.COLOURS[number % len(style.COLOURS)], "gid": "curve"}
    look |= {"marker": MARKERS[number % len(MARKERS)], "markersize": 4.0} if x.size <= MARKED else {}
    if curve.attrs.get("points"):
        look |= POINTS
    elif curve[curve.dims[0]].dtype.kind != "f":
        look |= {"linewidth": 0.9}
    axes.plot(x, values, label=named(curve), **look)


def _draw_bars(axes: Axes, x: Array, curve: xr.DataArray, place: tuple[int, int]) -> None:
    number, count = place
    width = 0.8 / count
    colour = style.COLOURS[number % len(style.COLOURS)]
    at = x - 0.4 + (number + 0.5) * width
    axes.bar(at, np.nan_to_num(style.shown(curve)), width, color=colour, label=named(curve), gid="curve")
    axes.grid(visible=False, axis="x")


def _from_zero(axes: Axes, values: Sequence[Array]) -> None:
    """Amounts are drawn from zero up where that does not flatten them."""
    every = np.concatenate([v[np.isfinite(v)] for v in values])
    if axes.get_yscale() == "linear" and every.size and 0 <= every.min() < 0.5 * every.max():
        axes.set_ylim(bottom=0.0)


def _limits(axes: Axes, curves: Sequence[xr.DataArray]) -> None:
    """Dashed lines, each in the colour of its curve where there are several."""
    several = sum("limit" in curve.attrs for curve in curves) > 1
    for number, curve in enumerate(curves):
        colour = style.COLOURS[number % len(style.COLOURS)] if several else LIMIT
        told = wrapped(str(curve.attrs.get("limit_words", "limit")))
        limits = np.atleast_1d(np.asarray(curve.attrs.get("limit", ()), dtype=float))
        for at in style.shown(limits, str(curve.attrs["quantity"])) if limits.size else ():
            axes.axhline(at, color=colour, linestyle=(0, (5, 2)), linewidth=1.2, label=told, gid="limit", zorder=1.5)
            _room_for(axes, float(at))
            told = "_again"


def _room_for(axes: Axes, at: float) -> None:
    """The axis wide enough for a limit to be seen."""
    low, high = axes.get_ylim()
    if axes.get_yscale() == "log":
        axes.set_ylim(min(low, at / 1.3), max(high, at * 1.3))
    else:
        room = 0.06 * (max(high, at) - min(low, at))
        axes.set_ylim(low if low < at else at - room, high if high > at else at + room)


def _beyond(axes: Axes, x: Array, curves: Sequence[xr.DataArray]) -> None:
    """What is infinite, as arrows at the upper edge."""
    for number, curve in enumerate(curves):
        at = x[np.isposinf(curve.values)]
        if at.size:
            top = np.full(at.size, 0.94 - 0.09 * number)
            look: dict[str, Any] = {"linestyle": "none", "marker": r"$\uparrow$", "markersize": 9.0, "gid": "beyond"}
            colour = style.COLOURS[number % len(style.COLOURS)]
            axes.plot(at, top, transform=axes.get_xaxis_transform(), color=colour, **look)


def _shade(axes: Axes, data: xr.Dataset, along: str, quantity: str) -> None:
    """The operating range along whichever axis is a speed, unless it fills that."""
    if "speed_range" not in data.attrs:
        return
    low, high = style.shown(np.asarray(json.loads(data.attrs["speed_range"])), "speed")
    look: dict[str, Any] = {
        "color": style.SHADE,
        "zorder": 0,
        "label": f"operating range {low:.0f}–{high:.0f} rpm",
        "gid": "range",
    }
    if quantity == "speed":
        bottom, top = axes.get_ylim()
        room = 0.04 * (top - bottom)
        axes.axhspan(low, high, **look)
        axes.set_ylim(min(bottom - room, 0.9 * low) if bottom else 0.0, max(top + room, min(1.04 * high, 1.5 * top)))
    elif data[along].attrs.get("quantity") == "speed":
        x = positions(data[along])
        if x.min() < 0.99 * low or x.max() > 1.01 * high:
            axes.axvspan(max(low, x.min()), min(high, x.max()), **look)


def _legend(axes: Axes, several: bool) -> None:
    """Beside the panel, so that it hides nothing; none for a lone curve that its axis names."""
    handles, words = axes.get_legend_handles_labels()
    kept = _once([(h, w) for h, w in zip(handles, words, strict=True) if several or not _is_curve(h)])
    if kept:
        axes.legend(*zip(*kept, strict=True), loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0)


def _once(entries: Sequence[tuple[Any, str]]) -> list[tuple[Any, str]]:
    """Legend entries without repetition; what several curves share is told in ink, not in the colour of one of them."""
    words = [word for _, word in entries]
    first = {word: handle for handle, word in reversed(entries)}
    for word, handle in first.items():
        if words.count(word) > 1:
            first[word] = copy(handle)
            first[word].set_color(style.INK)
    return [(first[word], word) for word in dict.fromkeys(words)]


def _is_curve(handle: Any) -> bool:
    artist = handle[0] if isinstance(handle, tuple) else handle
    return bool(artist.get_gid() == "curve") if hasattr(artist, "get_gid") else False


def plain_decades(axis: Axis) -> None:
    """Plain numbers at 1, 2 and 5 of every decade, or at 1 where there are many."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 1000 * low else (1.0,)))
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter("")


def _reciprocal(values: ArrayLike) -> ArrayLike:
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / np.asarray(values))


def _label_inverse(top: Axes, along: xr.DataArray) -> None:
    """The inverse of what is varied along the upper edge."""
    upper = top.secondary_xaxis("top", functions=(_reciprocal, _reciprocal))
    upper.set_xticks(np.round(1.0 / positions(along), 2))
    upper.set_xlabel(axis_label(str(along.attrs.get("quantity", "")), "", str(along.attrs["inverse"])))


def _label_along(drawn: Sequence[Axes], along: xr.DataArray) -> None:
    last, told = drawn[-1], along.attrs
    if "inverse" in told:
        _label_inverse(drawn[0], along)
    words = str(told.get("words", ""))
    if along.dtype.kind == "f":
        x = positions(along)
        last.set_xlabel(f"{words} [ms]" if _short(along) else axis_label(str(told.get("quantity", "")), "", words))
        if told.get("scale") == "log":
            last.set_xscale("log")
            plain_decades(last.xaxis)
            if x.size <= MARKED / 2:
                apart = np.append(True, np.diff(np.log(x)) > 0.05 * np.log(x.max() / x.min()))
                last.set_xticks(x[apart], [f"{value:.3g}" for value in x[apart]], minor=False)
        elif x.size > MARKED:
            last.set_xlim(x.min(), x.max())
        return
    names = [style.readable(name) for name in along.values]
    turned = {"rotation": 40, "ha": "right", "rotation_mode": "anchor"} if max(map(len, names)) > 4 else {}
    last.set_xticks(range(along.size), names, **turned)  # type: ignore[arg-type]
    last.set_xlabel(words or style.readable(along.name))
