"""Pictures of period doubling: branches with the doubled one, and peaks over the stiffness step with straight lines."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.plots.branches import look
from torsional.plots.sweeps import LIMIT, wrapped

LOOKS = (("-", "o"), ("--", "s"), (":", "D"))


@style.styled
def plot_doubling(data: xr.Dataset) -> Figure:
    """Half the firing order and the firing order along branches: stable motions solid, unstable ones dashed and pale.

    ``data``: points with ``line`` and ``stable``; its attributes name the parameter (``along``), the ``orders``, the
    ``words`` of each line, and, where there are such, a ``band`` of the parameter that the claim names, ``runs``
    (in time: words, parameter, both orders) and what is ``shaded``.
    """
    orders, words = json.loads(data.attrs["orders"]), json.loads(data.attrs["words"])
    drawn = style.panels(2, 1, (8.6, 2.7), sharex=True)
    for axes, name, order in zip(drawn, ("half_order", "main_order"), orders, strict=True):
        _draw_lines(axes, data, name, words)
        _draw_runs(axes, data, int(name == "main_order"), str(data[name].attrs["quantity"]))
        _bands(axes, data)
        kind = str(data[name].attrs["quantity"])
        told = {"torque": "torque in the DMF", "relative_angle": "twist of the DMF"}.get(kind, "")
        axes.set_ylabel(wrapped(style.label(kind, "0-peak", f"order {order:g}, {told}")))
        axes.set_ylim(bottom=0.0)
    parameter = data[data.attrs["along"]]
    names = {"speed": "engine speed", "mean_torque": "mean engine torque"}
    drawn[-1].set_xlabel(style.label(str(parameter.attrs["quantity"]), name=names.get(str(parameter.name), "")))
    drawn[0].plot([], [], color=style.FAINT, label="stable")
    drawn[0].plot([], [], color=style.FAINT, linestyle=(0, (4, 1.6)), label="unstable")
    drawn[0].legend(loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0)
    return style.figure_of(drawn[0])


def _draw_lines(axes: Axes, data: xr.Dataset, name: str, words: list[str]) -> None:
    at = style.shown(data[data.attrs["along"]])
    size, good, line = style.shown(data[name]), data.stable.values > 0.5, data.line.values
    for number, told in enumerate(words):
        own = np.flatnonzero(line == number)
        for piece in np.split(own, np.flatnonzero(np.diff(good[own].astype(int))) + 1):
            if piece.size:
                till = np.append(piece, piece[-1] + 1) if piece[-1] + 1 in own else piece
                axes.plot(at[till], size[till], gid="motion", **look(number, bool(good[piece[0]])))  # type: ignore[arg-type]
        axes.plot([], [], label=wrapped(told), color=look(number, True)["color"])


def _draw_runs(axes: Axes, data: xr.Dataset, place: int, kind: str) -> None:
    """What runs in time ended on."""
    runs: dict[str, list[list[float]]] = json.loads(data.attrs.get("runs", "{}"))
    for number, (told, points) in enumerate(runs.items()):
        values = np.array(points, dtype=float)
        at = style.shown(values[:, 0], str(data[data.attrs["along"]].attrs["quantity"]))
        look_of: dict[str, Any] = {
            "marker": "ox+"[number % 3],
            "markersize": 7.5 - number,
            "markerfacecolor": "none",
            "clip_on": False,
        }
        axes.plot(at, style.shown(values[:, 1 + place], kind), linestyle="none", color=style.INK, zorder=6,
                  label=wrapped(told), gid="run", **look_of)  # fmt: skip


def _bands(axes: Axes, data: xr.Dataset) -> None:
    bands: dict[str, list[float]] = json.loads(data.attrs.get("bands", "{}"))
    kind = str(data[data.attrs["along"]].attrs["quantity"])
    for number, (told, ends) in enumerate(bands.items()):
        low, high = style.shown(np.array(ends), kind)
        axes.axvspan(low, high, color=(style.SHADE, "#fbeee6")[number % 2], zorder=0, label=wrapped(told), gid="band")


@style.styled
def plot_regression(data: xr.Dataset) -> Figure:
    """Values over the stiffness difference, sweep by sweep, with the straight line through each and its R².

    ``data``: cases with ``sweep`` and ``difference``; a variable's ``judged`` tells whether the verdict turns on it;
    without ``regression`` in the attributes there are no lines; a ``limit`` [SI] of all variables is drawn.
    """
    names = [str(name) for name, v in data.data_vars.items() if v.dtype.kind == "f" and name != "difference"]
    drawn = style.panels(len(names), 1, (8.6, 2.3), sharex=True)
    for axes, name in zip(drawn, names, strict=True):
        _regressed(axes, data, name)
        told = data[name].attrs
        role = "judged" if told.get("judged") else "reported"
        kind = str(told["quantity"])
        axes.set_ylabel(wrapped(style.label(kind, data.attrs.get("amplitude", ""), _called(data, str(told["words"])))))
        axes.set_title(f"{told['words']}: {role}", fontsize=9.0)
        axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0)
    drawn[-1].set_xlabel(style.label("stiffness", name="difference of the stiffnesses, k2 − k1"))
    return style.figure_of(drawn[0])


def _called(data: xr.Dataset, words: str) -> str:
    return f"{data.attrs['told']} {words}" if "told" in data.attrs else words


def _regressed(axes: Axes, data: xr.Dataset, name: str) -> None:
    x, y, sweeps = style.shown(data.difference), style.shown(data[name]), data.sweep.values
    for number, told in enumerate(dict.fromkeys(sweeps.tolist())):
        own = sweeps == told
        dash, marker = LOOKS[number % 3]
        label = told
        if data.attrs.get("regression"):
            slope, start = np.polyfit(x[own], y[own], 1)
            ends = np.array([x[own].min(), x[own].max()])
            axes.plot(
                ends, start + slope * ends, linestyle=dash, color=style.COLOURS[number], linewidth=1.0, gid="line"
            )
            label = f"R² = {_straightness(x[own], y[own]):.3f}: {told}"
        axes.plot(x[own], y[own], linestyle="none", marker=marker, markersize=5.0, color=style.COLOURS[number],
                  label=wrapped(label), gid="case")  # fmt: skip
    if "limit" in data.attrs:
        at = float(style.shown(np.asarray(data.attrs["limit"]), str(data[name].attrs["quantity"])))
        axes.axhline(at, color=LIMIT, linestyle=(0, (5, 2)), label=wrapped(data.attrs["limit_words"]), gid="limit")


def _straightness(x: Array, y: Array) -> float:
    return float(np.corrcoef(x, y)[0, 1] ** 2)
