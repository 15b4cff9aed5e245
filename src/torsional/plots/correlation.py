"""Computed orders beside measured ones, and how far they deviate."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style

MOST, COLUMNS = 6, 2


@style.styled
def plot_correlation(data: xr.Dataset) -> Figure:
    """Amplitudes measured and computed over speed, a panel for each of the six largest measured orders.

    ``data``: of `torsional.studies.correlation.correlation`.
    """
    size = np.sqrt(np.mean(np.abs(data.measured.fillna(0.0).values) ** 2, axis=1))
    order = np.argsort(-size, kind="stable")[:MOST]
    columns = min(order.size, COLUMNS)
    drawn = style.panels(math.ceil(order.size / columns), columns, (5.6, 3.2))
    for axes, place in zip(drawn, sorted(order.tolist()), strict=False):
        _order(axes, data.isel(order=place), str(data.attrs["quantity"]))
    for axes in drawn[order.size :]:
        axes.remove()
    drawn[0].legend()
    return style.figure_of(drawn[0])


def _order(axes: Axes, one: xr.Dataset, quantity: str) -> None:
    rpm = style.shown(one.speed)
    seen, told = (style.shown(np.abs(one[name].values), quantity) for name in ("measured", "computed"))
    axes.plot(rpm, seen, "o", markersize=3.5, color=style.INK, label="measured", gid="measured")
    axes.plot(rpm, told, color=style.COLOURS[0], label="computed", gid="computed")
    axes.set_title(f"order {float(one.order):g}: FRAC {float(one.frac):.2f}, R² {float(one.r_squared):.2f}")
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(style.label("speed", name="engine speed"))
    axes.set_ylabel(style.label(quantity, "0-peak", quantity.replace("_", " ")))
