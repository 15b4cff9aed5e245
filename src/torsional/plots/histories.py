"""Signals over time of runs that are compared: a panel for each parameter that is varied, a line for each value."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.sweeps import axis_label, wrapped

SIZE = (8.6, 2.3)


@style.styled
def plot_histories(data: xr.Dataset) -> Figure:
    """Every variable over (a parameter, a time), one panel below the other; ``words`` of a variable is its title."""
    told = [str(name) for name in data.data_vars if data[name].ndim == 2]
    drawn = style.panels(len(told), 1, SIZE)
    for axes, name in zip(drawn, told, strict=True):
        _draw(axes, data[name])
    return style.figure_of(drawn[0])


def _draw(axes: Axes, signals: xr.DataArray) -> None:
    parameter, time = (signals[dim] for dim in signals.dims)
    for place, (value, row) in enumerate(zip(style.shown(parameter), style.shown(signals), strict=True)):
        colour = style.COLOURS[place % len(style.COLOURS)]
        unit = style.shown_unit(str(parameter.attrs["quantity"]))
        dash = style.DASHES[place % len(style.DASHES)]
        axes.plot(time.values, row, dash, color=colour, linewidth=1.1, label=f"{value:.4g} {unit}")
    ends = time.values[np.isfinite(signals.values).any(axis=0)]
    axes.set_xlim(ends[0], ends[-1])
    axes.set_xlabel(style.label("time", name="time"))
    words = str(signals.attrs.get("panel", ""))
    axes.set_ylabel(wrapped(axis_label(str(signals.attrs["quantity"]), "", words)))
    title = style.readable(parameter.attrs.get("words", parameter.name))
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0, title=title)
