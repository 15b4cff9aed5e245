"""Pictures of studies whose point a plain sweep does not show: maps of several designs and gears beside each other."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.plots.maps import SERIES, colour_limits

BoolArray = npt.NDArray[np.bool_]
MARK = "#b3261e"
COLUMNS = 4
DESIGNS = {"soft": "one soft stage", "stiff": "one stiff stage", "two_stage": "two stages"}


@style.styled
def plot_gear_ratios(data: xr.Dataset) -> Figure:
    """Ratios (gear, mean_torque, speed) of two variants in at most four gears, a row of maps for each variable.

    Blue below one, red above; cells above one are framed, and named in each map's title with their speeds.
    """
    rows = [str(name) for name in data.data_vars]
    gears = _chosen(data)
    figure = Figure(figsize=(2.6 * len(gears) + 1.0, 2.5 * len(rows) + 0.3))
    FigureCanvasAgg(figure)
    grid = figure.subplots(len(rows), len(gears), squeeze=False, sharex=True, sharey=True)
    ticks = np.array([0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0])
    for line, name in zip(grid, rows, strict=True):
        for axes, gear in zip(line, gears, strict=True):
            values = data[name].sel(gear=gear).transpose("mean_torque", "speed")
            mesh = _mesh(axes, values, LogNorm(0.05, 20.0), style.RATIO)
            _frame(axes, values, values.values > 1)
            axes.set_title(f"gear {style.plain(gear, 12)}: {_above(values)}", fontsize=8.5, fontweight="normal")
        line[0].set_ylabel(f"{data[name].attrs.get('words', name)}\n{style.label('torque', name='mean torque')}")
        _colour_bar(figure, mesh, list(line), ticks, "dual over single mass\nflywheel [-]")
    for axes in grid[-1]:
        axes.set_xlabel(style.label("speed", name="engine speed"))
    _explained(figure, "× above one; grey: above full load")
    return figure


def _explained(figure: Figure, words: str) -> None:
    """A line above all panels."""
    figure.suptitle(words, fontsize=8.0, fontweight="normal", color=style.INK)


def _chosen(data: xr.Dataset) -> list[str]:
    """The gears that show most: first, middle, and those with the largest ratios."""
    gears = [str(gear) for gear in data.gear.values]
    if len(gears) <= COLUMNS:
        return gears
    peak = np.nanmax(np.array([v.max(("mean_torque", "speed")).values for v in data.data_vars.values()]), axis=0)
    loud = [gears[place] for place in np.argsort(peak)[::-1]]
    kept = list(dict.fromkeys([gears[0], gears[len(gears) // 2], gears[-1], *loud]))[:COLUMNS]
    return sorted(kept, key=gears.index)


def _above(values: xr.DataArray) -> str:
    """Which cells lie above one."""
    rpm = style.shown(values.speed)[(values.values > 1).any(axis=0)]
    if not rpm.size:
        return f"at most {float(values.max()):.2f}"
    span = f"{rpm.min():.0f}" if rpm.size == 1 else f"{rpm.min():.0f}–{rpm.max():.0f}"
    return f"above 1 at {span} rpm"


def _mesh(axes: Axes, values: xr.DataArray, norm: LogNorm, colours: str) -> QuadMesh:
    seen = np.ma.masked_invalid(values.values)
    rpm, torque = style.shown(values.speed), style.shown(values.mean_torque)
    axes.grid(visible=False)
    axes.set_facecolor("#f2f2f2")
    return axes.pcolormesh(rpm, torque, seen, norm=norm, cmap=colours, shading="nearest", rasterized=True)


def _frame(axes: Axes, values: xr.DataArray, marked: BoolArray) -> None:
    """Crosses in the marked cells."""
    row, column = np.nonzero(marked)
    rpm, torque = style.shown(values.speed)[column], style.shown(values.mean_torque)[row]
    axes.plot(rpm, torque, linestyle="none", marker="x", color=style.INK, markersize=4.0, gid="marked")


def _colour_bar(figure: Figure, mesh: QuadMesh, line: list[Axes], ticks: Array, told: str) -> None:
    bar = figure.colorbar(mesh, ax=line, label=told, pad=0.01, aspect=14)
    bar.ax.yaxis.set_major_locator(FixedLocator(list(ticks)))
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())


@style.styled
def plot_design_maps(data: xr.Dataset) -> Figure:
    """Swing of the input over (mean_torque, speed) of three designs of springs; below it what they do over the torque.

    ``amplitude_…`` and ``twist_…`` (over the stop's) of one soft stage, one stiff stage, two stages; a cross where the
    stop is met; grey where there is no stable motion, or none within full load.
    """
    figure = Figure(figsize=(9.6, 6.2))
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2, 6, height_ratios=[1.0, 0.9])
    sizes = {name: data[f"amplitude_{name}"].transpose("mean_torque", "speed") for name in DESIGNS}
    low, high = colour_limits(*(style.shown(size) for size in sizes.values()))
    drawn: list[Axes] = []
    for place, (name, size) in enumerate(sizes.items()):
        axes = figure.add_subplot(grid[0, 2 * place : 2 * place + 2], sharey=drawn[0] if drawn else None)
        mesh = _mesh(axes, size, LogNorm(low, high), style.AMOUNT)
        _crossed(axes, data[f"twist_{name}"].transpose("mean_torque", "speed"))
        crossed = bool((data[f"twist_{name}"] >= 1).any())
        axes.set_title(DESIGNS[name] + (" (× meets its stop)" if crossed else ""), fontsize=9.0)
        axes.set_xlabel(style.label("speed", name="engine speed"))
        drawn.append(axes)
    drawn[0].set_ylabel(style.label("torque", name="mean engine torque"))
    ticks = SERIES[(0.999 * low <= SERIES) & (1.001 * high >= SERIES)]
    _colour_bar(figure, mesh, drawn, ticks, "gearbox input, acceleration\n[rad/s²], half peak-to-peak")
    _over_torque(figure.add_subplot(grid[1, :3]), figure.add_subplot(grid[1, 3:]), data)
    _explained(figure, "grey: above full load, or no stable motion of these orders")
    return figure


def _crossed(axes: Axes, twist: xr.DataArray) -> None:
    row, column = np.nonzero(twist.values >= 1)
    rpm, torque = style.shown(twist.speed)[column], style.shown(twist.mean_torque)[row]
    axes.plot(rpm, torque, linestyle="none", marker="x", color=MARK, markersize=4.5, gid="marked")


def _over_torque(left: Axes, right: Axes, data: xr.Dataset) -> None:
    """Medians of the amplitude and largest twists over mean torque."""
    torque = style.shown(data.mean_torque)
    for number, (name, words) in enumerate(DESIGNS.items()):
        look = {"color": style.COLOURS[number], "marker": "osD"[number], "markersize": 4.0, "label": words}
        size = style.shown(data[f"amplitude_{name}"].median("speed"), "acceleration")
        left.plot(torque, size, **look)  # type: ignore[arg-type]
        right.plot(torque, data[f"twist_{name}"].max("speed"), **look)  # type: ignore[arg-type]
    left.set_yscale("log")
    left.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    left.set_ylabel("median over speed of the\nacceleration [rad/s²], half peak-to-peak")
    right.axhline(1.0, color=MARK, linestyle=(0, (5, 2)), linewidth=1.2, label="stop")
    right.set_ylabel("largest twist over the stop's [-]")
    right.set_ylim(bottom=0.0)
    right.legend(loc="lower right")
    for axes in (left, right):
        axes.set_xlabel(style.label("torque", name="mean engine torque"))


@style.styled
def plot_work_precision(data: xr.Dataset) -> Figure:
    """Error over CPU time, a line for each method with its tolerances or steps at the points; lower left is better."""
    axes = style.panels(1, 1, (8.6, 4.4))[0]
    methods = data.method.values
    axes.set_xscale("log")
    axes.set_yscale("log")
    for number, method in enumerate(dict.fromkeys(methods.tolist())):
        own = np.flatnonzero(methods == method)
        x, y = style.shown(data.cpu_time)[own] * 1e3, style.shown(data.error)[own]
        ours = method == data.attrs["ours"]
        look = {"color": style.COLOURS[number], "marker": "osD^v"[number % 5], "markersize": 5.0}
        axes.plot(x, y, label=method, linewidth=2.2 if ours else 1.2, **look)  # type: ignore[arg-type]
        for a, b, accuracy in zip(x, y, data.accuracy.values[own], strict=True):
            told = f"{1e3 * accuracy:g} ms" if ours else f"{accuracy:.0e}".replace("e-0", "e-")
            axes.annotate(told, (a, b), xytext=(5, 4), textcoords="offset points", fontsize=7.5)
    steps = data.sel(run=methods == data.attrs["ours"])
    judged = steps.isel(run=int(np.argsort(steps.accuracy.values)[steps.sizes["run"] // 2]))
    axes.axhline(float(style.shown(judged.error)), color=MARK, linestyle=(0, (5, 2)), linewidth=1.2,
                 label="error to come to")  # fmt: skip
    axes.margins(x=0.12, y=0.12)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("CPU time of the whole run [ms], as measured on this machine")
    axes.set_ylabel("error of the relative angle, RMS over RMS of its swing [%]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0.0)
    return style.figure_of(axes)
