"""Fits of an identification: curves measured and fitted, residuals, correlations, intervals and profiles."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from torsional.plots import style

MOST, COLUMNS = 12, 3
"""Points that are drawn, and how many side by side."""
SEEN = {"linestyle": "none", "marker": "o", "markersize": 2.6, "color": "#aaaaaa", "zorder": 1.5}


@style.styled
def plot_fits(data: xr.Dataset) -> Figure:
    """A panel for each of up to twelve points with what was measured and what the models predict.

    ``data``: of `torsional.studies.identification.result.identify`.  What was held back says so in its title.
    """
    shown = _chosen(data)
    drawn = style.panels(math.ceil(len(shown) / COLUMNS), min(len(shown), COLUMNS), (4.2, 3.0))
    for axes, place in zip(drawn, shown, strict=False):
        _curves(axes, data, place)
    for axes in drawn[len(shown) :]:
        axes.remove()
    handles, labels = drawn[0].get_legend_handles_labels()
    figure = style.figure_of(drawn[0])
    figure.legend(handles, labels, loc="outside lower center", ncols=min(len(labels), 4))
    return figure


def _chosen(data: xr.Dataset) -> list[int]:
    """All points, or an even choice that keeps some of those held back."""
    count = data.sizes["point"]
    if count <= MOST:
        return list(range(count))
    held = np.flatnonzero(data.held.values)[: MOST // 4]
    rest = np.setdiff1d(np.arange(count), held)
    even = rest[np.unique(np.linspace(0, rest.size - 1, MOST - held.size).astype(int))]
    return sorted(int(place) for place in {*held.tolist(), *even.tolist()})


def _curves(axes: Axes, data: xr.Dataset, place: int) -> None:
    one = data.isel(sample=data.sample_point.values == place)
    along, quantity = (str(data[name].values[place]) for name in ("along", "quantity"))
    across = style.shown(one.axis.values, along)
    loop = along == "relative_angle"
    axes.plot(across, style.shown(one.measured.values, quantity), label="measured", gid="measured", **SEEN)  # type: ignore[arg-type]
    for number, name in enumerate(data.model.values):
        line = style.shown(one.fitted.values[number], quantity)
        ends = (np.append(values, values[:1]) if loop else values for values in (across, line))
        look = style.DASHES[number % 4]
        axes.plot(*ends, look, color=style.COLOURS[number], linewidth=1.2, label=style.plain(name, 28), gid="fitted")
    held = " (held back)" if data.held.values[place] else ""
    axes.set_title(style.plain(f"{data.point.values[place]}{held}"), fontsize=8.5)
    axes.set_xlabel(style.label(along, name="angle" if loop else ""))
    peak = along == "speed" and quantity != "number"
    axes.set_ylabel(style.label(quantity, "0-peak" if peak else "", quantity.replace("_", " ")))


@style.styled
def plot_residuals(data: xr.Dataset) -> Figure:
    """Residuals over the noise of the plan's own model along each point, and the misfit of every point and model."""
    figure = Figure(figsize=(11.0, 4.0))
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.2))
    _spread(left, data)
    place, count = np.arange(data.sizes["point"]), data.sizes["model"]
    for number, name in enumerate(data.model.values):
        shift = 0.8 * ((number + 0.5) / count - 0.5)
        right.bar(
            place + shift, data.point_misfit.values[number], 0.8 / count, label=style.plain(name, 28), gid="misfit"
        )
    right.axhline(1.0, color=style.INK, linestyle=":", linewidth=1.0, label="noise alone")
    told = [
        f"{style.plain(name, 24)}{'*' if held else ''}"
        for name, held in zip(data.point.values, data.held.values, strict=True)
    ]
    right.set_xticks(place, told, rotation=60 if place.size > 3 else 0, ha="right" if place.size > 3 else "center")
    right.set_ylabel("RMS of residuals over noise [-]")
    right.set_title("what the models leave" + (" (* held back)" if data.held.values.any() else ""))
    right.set_ylim(0.0, 1.3 * float(data.point_misfit.max()))
    right.legend(loc="upper left", ncols=2)
    return figure


def _spread(axes: Axes, data: xr.Dataset) -> None:
    """Residuals in bins along the points, over the noise: a curve away from zero is what the model lacks."""
    off = (data.measured.values - data.fitted.values[0]) / data.noise.values[data.sample_point.values]
    for place in range(data.sizes["point"]):
        own = off[data.sample_point.values == place]
        way = (np.arange(own.size) + 0.5) / own.size
        axes.plot(way, own, linewidth=0.8, alpha=0.7, color=style.COLOURS[place % len(style.COLOURS)], gid="residual")
    axes.axhline(0.0, color=style.INK, linewidth=0.8)
    axes.set_xlabel("way along each point [-]")
    axes.set_ylabel("residual over noise [-]")
    axes.set_title("residuals (loops: means of cycles)")


@style.styled
def plot_certainty(data: xr.Dataset) -> Figure:
    """Correlations of the estimates, the half width of each interval over its estimate, and profiles if there are."""
    profiles = "profile_rise" in data
    figure = Figure(figsize=(13.5 if profiles else 10.5, 1.8 + 0.38 * data.sizes["parameter"] + 1.4))
    FigureCanvasAgg(figure)
    axes = list(figure.subplots(1, 3 if profiles else 2))
    names = [f"{n + 1}  {style.plain(_short(str(name)), 34)}" for n, name in enumerate(data.parameter.values)]
    _matrix(axes[0], data, names)
    _widths(axes[1], data, names)
    if profiles:
        _profiles(axes[2], data, names)
    return figure


def _short(path: str) -> str:
    """The last two keys of a path, which tell it from others."""
    return ".".join(path.split(".")[-2:])


def _matrix(axes: Axes, data: xr.Dataset, names: list[str]) -> None:
    values = data.correlation.values
    axes.imshow(values, cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto", gid="correlation")
    axes.grid(visible=False)
    for (row, column), value in np.ndenumerate(values):
        told = "" if not np.isfinite(value) else f"{value:.2f}"
        colour = "white" if abs(value) > 0.6 else style.INK
        axes.text(column, row, told, ha="center", va="center", fontsize=7.0, color=colour)
    axes.set_yticks(np.arange(len(names)), names)
    axes.set_xticks(np.arange(len(names)), [str(number + 1) for number in range(len(names))])
    axes.set_title("correlations of the estimates")


def _widths(axes: Axes, data: xr.Dataset, names: list[str]) -> None:
    half = 0.5 * (data.interval_high - data.interval_low).values
    size = np.where(data.estimate.values != 0.0, np.abs(data.estimate.values), np.nan)
    share = 100.0 * half / size
    axes.barh(np.arange(len(names)), np.where(np.isfinite(share), share, 0.0), 0.6, gid="width")
    for row, value in enumerate(share):
        told = f" {value:.2g} %" if np.isfinite(value) else " not told by the data"
        axes.text(value if np.isfinite(value) else 0.0, row, told, va="center", fontsize=8.0)
    axes.set_yticks(np.arange(len(names)), [str(number + 1) for number in range(len(names))])
    axes.invert_yaxis()
    finite = share[np.isfinite(share)]
    axes.set_xlim(0.0, 1.3 * float(finite.max()) if finite.size else 1.0)
    axes.set_xlabel(f"half of the {100 * data.attrs['level']:g} % interval over the estimate [%]")
    axes.set_title("how sure they are")


def _profiles(axes: Axes, data: xr.Dataset, names: list[str]) -> None:
    """√ΔS with the sign of the way, over the way in deviations: straight where intervals by deviations hold."""
    for row in range(len(names)):
        off = (data.profile_value.values[row] - data.estimate.values[row]) / data.deviation.values[row]
        rise = np.sqrt(np.maximum(data.profile_rise.values[row], 0.0)) * np.sign(off)
        axes.plot(off, rise, marker="o", markersize=3.0, label=str(row + 1), gid="profile")
    axes.plot([-3, 3], [-3, 3], color=style.FAINT, linestyle="--", linewidth=1.0, label="linear")
    axes.set_xlabel("off the estimate, in standard deviations [-]")
    axes.set_ylabel("root of the rise in squares, signed [-]")
    axes.set_title("profiles, all others fitted anew")
    axes.legend(fontsize=7.0)
