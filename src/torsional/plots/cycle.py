"""A signal put together from its orders over one cycle, beside the bound."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.quantities import order_sum, swing, waveform


@style.styled
def plot_cycle(
    orders: xr.DataArray, *, shown: Sequence[float] = (), title: str = "", axes: Axes | None = None
) -> Figure:
    """The signal of complex ``orders`` (order) over 720° of crank angle, phases kept, between plus and minus the bound.

    ``shown``: orders drawn by themselves as thin lines.  The legend tells half the peak-to-peak swing and the bound.
    """
    figure, drawn = style.on(axes, (7.0, 3.6))
    quantity = str(orders.attrs["quantity"])
    signal, most = waveform(orders), float(style.shown(order_sum(orders), quantity))
    degrees = style.shown(np.asarray(signal.crank_angle), "crank_angle")
    for number, order in enumerate(shown):
        part = style.shown(waveform(orders.sel(order=[order])), quantity)
        colour = style.COLOURS[(number + 2) % len(style.COLOURS)]
        drawn.plot(degrees, part, color=colour, linewidth=0.9, linestyle="--", label=f"order {order:g}")
    half = float(style.shown(swing(orders), quantity))
    unit = style.shown_unit(quantity)
    told = f"all orders, half peak-to-peak {half:.4g} {unit}"
    drawn.plot(degrees, style.shown(signal, quantity), color=style.COLOURS[0], linewidth=2.0, label=told)
    for sign, name in ((1, f"bound, sum of amplitudes {most:.4g} {unit}"), (-1, "_")):
        drawn.axhline(sign * most, color=style.COLOURS[1], linestyle=":", label=name)
    drawn.set_xlim(0, 720)
    drawn.set_ylim(-1.6 * most, 1.12 * most)
    drawn.set_xticks(range(0, 721, 120))
    drawn.set_xlabel(style.label("crank_angle"))
    drawn.set_ylabel(style.label(quantity, name="acceleration" if quantity == "acceleration" else ""))
    drawn.set_title(style.plain(title, 80), loc="left")
    drawn.legend(loc="lower left", ncols=2)
    return figure
