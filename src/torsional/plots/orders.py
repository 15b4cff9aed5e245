"""Order cuts: amplitudes of single orders over speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.campbell import gear_bar, gear_colour
from torsional.quantities import amplitude


@style.styled
def plot_gears(orders: xr.DataArray, order: float, *, idle: float | None = None, axes: Axes | None = None) -> Figure:
    """The 0-peak amplitude of one ``order`` over speed, a line for every gear; ``orders`` (gear, speed, order).

    Raises ModelError for an order that was not computed and for further dimensions of more than one value.
    """
    figure, drawn = style.on(axes, (8.0, 4.2))
    rpm = style.shown(orders.speed)
    lines = style.over(amplitude(orders, order), "gear", "speed")
    for number, size in enumerate(style.shown(lines)):
        drawn.plot(rpm, size, color=gear_colour(number, orders.gear.size), gid="cut")
    drawn.set_xlim(rpm[0], rpm[-1])
    drawn.set_ylim(bottom=0)
    style.operating_range(drawn, None, idle)
    drawn.set_xlabel(style.label("speed", name="engine speed"))
    drawn.set_ylabel(style.label(str(orders.attrs["quantity"]), "0-peak", f"order {order:g}, {_short(orders)}"))
    gear_bar(drawn, [str(gear) for gear in orders.gear.values])
    return figure


@style.styled
def plot_order_cuts(
    variants: Mapping[str, xr.DataArray],
    gear: str,
    order: Sequence[float],
    *,
    highest: float | None = None,
    axes: Axes | None = None,
) -> Figure:
    """0-peak amplitudes of some orders over speed in one gear: a colour for each variant, a dash for each order.

    ``variants`` {name: values (gear, speed, order)}.  Raises ModelError as `plot_gears` does.
    """
    figure, drawn = style.on(axes)
    for number, (name, orders) in enumerate(variants.items()):
        rpm = style.shown(orders.speed)
        for which, n in enumerate(order):
            size = style.shown(style.over(amplitude(orders.sel(gear=gear), n), "speed"))
            look = {"linestyle": style.DASHES[which % 4], "linewidth": 1.7 if which == 0 else 1.0}
            told = f"{style.plain(name, 28)}, order {n:g}"
            drawn.plot(rpm, size, color=style.COLOURS[number % len(style.COLOURS)], label=told, **look)  # type: ignore[arg-type]
            drawn.set_xlim(rpm[0], rpm[-1])
    first = next(iter(variants.values()))
    drawn.set_ylim(0, highest)
    drawn.set_xlabel(style.label("speed", name="engine speed"))
    drawn.set_ylabel(style.label(str(first.attrs["quantity"]), "0-peak", _short(first)))
    if axes is None:
        drawn.legend()
    return figure


def _short(orders: xr.DataArray) -> str:
    return {"acceleration": "acceleration", "torque": "torque"}.get(str(orders.attrs["quantity"]), "amplitude")
