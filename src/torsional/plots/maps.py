"""Maps over speed and mean torque, and the ratio of two."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from torsional.numerics.arrays import Array
from torsional.plots import style

SERIES = np.array([0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 2e3, 5e3, 1e4, 2e4, 5e4, 1e5])


@style.styled
def plot_map(
    values: xr.DataArray,
    *,
    within: xr.DataArray | None = None,
    full_load: xr.DataArray | None = None,
    limits: tuple[float, float] | None = None,
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """An amplitude over (mean_torque, speed) in colour, logarithmic, with lines at round values.

    ``within`` (mean_torque, speed): cells that are false, above full load, are greyed and hatched; ``full_load``
    (speed) [Nm] is drawn; ``limits`` of the colours in the shown unit, for maps that are to be compared.
    """
    figure, drawn = style.on(axes, (6.0, 4.2))
    values = style.over(values, "mean_torque", "speed")
    size = style.shown(values)
    low, high = limits or colour_limits(size)
    ticks = SERIES[(0.999 * low <= SERIES) & (1.001 * high >= SERIES)]
    convention = str(values.attrs.get("amplitude", "")).removesuffix(" over the cycle")
    quantity = str(values.attrs["quantity"])
    unit_label = style.label(quantity, convention, "acceleration" if quantity == "acceleration" else "")
    _draw(drawn, values, size, LogNorm(low, high), style.AMOUNT, ticks, unit_label)
    _draw_contours(drawn, values, size, ticks, within, "white")
    draw_limits(drawn, values, within, full_load, title)
    return figure


@style.styled
def plot_ratio_map(
    ratio: xr.DataArray,
    *,
    within: xr.DataArray | None = None,
    full_load: xr.DataArray | None = None,
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """The ratio of two variants' amplitudes over (mean_torque, speed): blue below one, red above, white at one."""
    figure, drawn = style.on(axes, (6.0, 4.2))
    ratio = style.over(ratio, "mean_torque", "speed")
    size = ratio.values
    ticks = np.array([0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0])
    _draw(drawn, ratio, size, LogNorm(0.1, 10.0), style.RATIO, ticks, "ratio of the amplitudes [-]")
    _draw_contours(drawn, ratio, size, ticks, within, "black")
    draw_limits(drawn, ratio, within, full_load, title)
    return figure


def colour_limits(*sizes: Array) -> tuple[float, float]:
    """Limits of logarithmic colours: the largest value of all, and a hundredth of it or the smallest."""
    every = np.concatenate([np.ravel(size) for size in sizes])
    every = every[np.isfinite(every) & (every > 0)]
    if not every.size:
        return 0.1, 1.0
    high = float(every.max())
    return max(float(every.min()), high / 200) * 0.999, high


def _draw(
    axes: Axes, values: xr.DataArray, size: Array, norm: Normalize, colours: str, ticks: Array, told: str
) -> None:
    rpm, torque = style.shown(values.speed), style.shown(values.mean_torque)
    seen = np.ma.masked_invalid(size)
    mesh = axes.pcolormesh(rpm, torque, seen, norm=norm, cmap=colours, shading="nearest", rasterized=True)
    extend = "both" if colours == style.RATIO else "min"
    bar = style.figure_of(axes).colorbar(mesh, ax=axes, extend=extend, label=told, pad=0.01)
    bar.ax.yaxis.set_major_locator(FixedLocator(list(ticks)))
    bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    bar.ax.yaxis.set_minor_locator(NullLocator())


def _draw_contours(
    axes: Axes, values: xr.DataArray, size: Array, ticks: Array, within: xr.DataArray | None, ink: str
) -> None:
    """Lines at round values, below full load only."""
    kept = np.isfinite(size) if within is None else within.transpose("mean_torque", "speed").values & np.isfinite(size)
    levels = [t for t in ticks if kept.any() and size[kept].min() < t < size[kept].max()]
    if levels and min(size.shape) > 1:
        rpm, torque = style.shown(values.speed), style.shown(values.mean_torque)
        seen = np.ma.masked_where(~kept, size)
        lines = axes.contour(rpm, torque, seen, levels=levels, colors=ink, linewidths=0.6, alpha=0.8)
        axes.clabel(lines, fontsize=7, fmt=lambda value: f"{value:g}")


def draw_limits(
    axes: Axes, values: xr.DataArray, within: xr.DataArray | None, full_load: xr.DataArray | None, title: str
) -> None:
    """What lies above full load, the curve itself, axis labels."""
    rpm, torque = style.shown(values.speed), style.shown(values.mean_torque)
    look = {"facecolor": "#ffffffb8", "edgecolor": "#555555", "hatch": "////", "linewidth": 0.0}
    if full_load is not None:
        curve = style.shown(full_load.speed), style.shown(full_load)
        axes.fill_between(*curve, torque[-1] + np.zeros(curve[0].size), where=curve[1] <= torque[-1], **look)  # type: ignore[arg-type]
        axes.plot(*curve, color="black", linewidth=2.0, label="full load", gid="full-load")
    elif within is not None and not within.all() and min(len(rpm), len(torque)) > 1:
        above = np.where(within.transpose("mean_torque", "speed").values, 0.0, 1.0)
        axes.contourf(rpm, torque, above, levels=[0.5, 1.5], colors=["#ffffffb8"], hatches=["////"])
    axes.set_xlim(rpm[0], rpm[-1])
    axes.set_ylim(torque[0], torque[-1])
    axes.set_xlabel(style.label("speed", name="engine speed"))
    axes.set_ylabel(style.label("torque", name="mean engine torque"))
    axes.set_title(style.plain(title, 60), loc="left")
    axes.grid(visible=False)
