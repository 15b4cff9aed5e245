"""Global sensitivities: bars of shares of the variance, and the plane of elementary effects."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.errors import ModelError
from torsional.plots import style

SHOWN = 20
"""Parameters that a panel shows, the most important first."""
COLUMNS = 2
BAR = 0.38
DISC: dict[str, Any] = {
    "fmt": "o",
    "markersize": 12.0,
    "color": style.COLOURS[0],
    "markeredgecolor": "white",
    "ecolor": style.COLOURS[0],
    "elinewidth": 1.4,
    "capsize": 3.0,
    "clip_on": False,
}
NUMBER: dict[str, Any] = {"color": "white", "fontsize": 7.5, "ha": "center", "va": "center_baseline", "zorder": 4}
"""How the points in the plane of effects look, and the ranks in them."""
WHISKER = {"ecolor": style.INK, "elinewidth": 1.0, "capsize": 2.5, "capthick": 1.0}


@style.styled
def plot_sensitivities(data: xr.Dataset) -> Figure:
    """A panel for each figure of `torsional.studies.sweeps.sensitivities`, whiskers over the confidence intervals.

    Of Sobol's shares of the variance two bars a parameter, with all interactions and by itself; of Morris's elementary
    effects the spread over their mean size, with the line on which both are equal.  Raises ModelError for a Dataset
    without either.
    """
    method = data.attrs.get("method")
    if method not in ("saltelli", "morris"):
        raise ModelError("a picture of sensitivities is drawn from their indices", found=str(method))
    shown = min(data.sizes["parameter"], SHOWN)
    columns = min(COLUMNS, data.sizes["figure"])
    size = (6.4, 1.6 + 0.42 * shown) if method == "saltelli" else (7.6, 4.0)
    drawn = style.panels(-(-data.sizes["figure"] // columns), columns, size)
    for number, axes in enumerate(drawn):
        if number >= data.sizes["figure"]:
            axes.remove()
            continue
        here = data.isel(figure=number)
        order = np.argsort(-here[data.attrs["importance"]].fillna(-1.0).values, kind="stable")[:SHOWN]
        (_bars if method == "saltelli" else _plane)(axes, here.isel(parameter=order))
        axes.set_title(_title(here))
    return style.figure_of(drawn[0])


def _title(here: xr.Dataset) -> str:
    told = style.readable(here.figure.item())
    reduction = str(here.reduction.item())
    return "\n".join(textwrap.wrap(f"{told}, {reduction}" if reduction else told, 60))


def _bars(axes: Axes, here: xr.Dataset) -> None:
    places = np.arange(here.sizes["parameter"], dtype=float)
    for shift, name, words, colour in (
        (-0.5, "total", "with all interactions (total)", style.COLOURS[0]),
        (0.5, "first_order", "by itself (first order)", style.COLOURS[5]),
    ):
        error = here[f"{name}_confidence"].values
        axes.barh(places + shift * BAR, here[name].values, BAR, xerr=error, color=colour, label=words, error_kw=WHISKER)
    axes.set_yticks(places, [style.plain(name) for name in here.parameter.values])
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
    axes.axvline(0.0, color=style.INK, linewidth=0.8)
    axes.set_xlabel("share of the variance [-], with 95 % interval")
    if not np.isfinite(here.total.values).any():
        axes.text(0.5, 0.5, "no parameter moves it", transform=axes.transAxes, ha="center")
        return
    axes.legend(loc="lower right")


def _plane(axes: Axes, here: xr.Dataset) -> None:
    quantity = str(here.quantity.item()) or "number"
    size, spread = style.shown(here.effect_size, quantity), style.shown(here.effect_spread, quantity)
    error = style.shown(here.effect_size_confidence, quantity)
    reach = np.nan_to_num(np.append(size + error, spread))
    high = float(reach.max()) or 1.0
    axes.plot([0, high], [0, high], color=style.FAINT, linestyle=(0, (4, 2)), linewidth=1.0, zorder=1, label="σ = µ*")
    for place in reversed(range(size.size)):  # the most important on top
        name = f"{place + 1}  {style.plain(here.parameter.values[place])}"
        axes.errorbar(size[place], spread[place], xerr=error[place], label=name, **DISC)
        axes.annotate(str(place + 1), (size[place], spread[place]), **NUMBER)
    axes.set_xlim(0, 1.06 * high)
    axes.set_ylim(0, 1.15 * max(float(np.nan_to_num(spread).max()), 0.25 * high))
    lines, names = axes.get_legend_handles_labels()
    axes.legend(lines[:0:-1] + lines[:1], names[:0:-1] + names[:1], loc="upper left", bbox_to_anchor=(1.01, 1.0))
    unit = style.shown_unit(quantity)
    told = "" if unit == "-" else f" [{unit}]"
    axes.set_xlabel(f"mean size of effects µ*{told}, with 95 % interval")
    axes.set_ylabel(f"spread of effects σ{told}")
