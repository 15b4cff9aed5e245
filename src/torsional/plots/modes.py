"""Mode shapes along the chain, and where each mode's elastic energy is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.layout import Chain, chain
from torsional.powertrain import Powertrain


@style.styled
def plot_mode_shapes(
    modes: xr.Dataset,
    powertrain: Powertrain,
    *,
    chosen: Sequence[int] | None = None,
    names: Sequence[str] = (),
    axes: Axes | None = None,
) -> Figure:
    """Angles of all nodes along the powertrain in some modes (default: the first five elastic ones), largest angle one.

    Angles are referred to engine speed: a gear changes nothing in them and only twist shows.  ``names``: one a mode.
    """
    line = chain(powertrain)
    elastic = [int(i) for i in modes.mode.values if float(modes.frequency.isel(mode=i)) > 0]
    shown = list(chosen) if chosen is not None else elastic[:5]
    figure, drawn = style.on(axes, (max(7.0, 0.55 * len(line.places)), 4.0))
    for number, mode in enumerate(shown):
        values = _referred(modes["shape"].isel(mode=mode), line)
        name = f"{names[mode]}, " if names else ""
        told = f"{name}{float(modes.frequency.isel(mode=mode)):.1f} Hz"
        _draw_shape(drawn, line, values, number, told)
    main = {node: x for node, (x, y) in line.places.items() if y == 0}
    drawn.set_xticks(list(main.values()), [style.readable(node) for node in main], rotation=50, ha="right")
    drawn.set_ylabel(style.label("mode_shape", name="angle referred to engine speed, largest 1"))
    drawn.set_ylim(-1.08, 1.08)
    drawn.axhline(0.0, color=style.FAINT, linewidth=0.8)
    figure.legend(loc="outside upper center", ncols=3) if axes is None else drawn.legend()
    return figure


def _referred(shape: xr.DataArray, line: Chain) -> dict[str, float]:
    values = {
        str(node): float(v) / (line.ratio[str(node)] or 1.0)
        for node, v in zip(shape.node.values, shape.values, strict=True)
    }
    largest = max(values.values(), key=abs)
    return {node: value / largest for node, value in values.items()}


def _draw_shape(axes: Axes, line: Chain, values: dict[str, float], number: int, told: str) -> None:
    colour = style.COLOURS[number % len(style.COLOURS)]
    dash = style.DASHES[number // len(style.COLOURS) % len(style.DASHES)]
    path = sorted((x, values[node]) for node, (x, y) in line.places.items() if y == 0)
    axes.plot(*np.transpose(path), color=colour, linestyle=dash, marker="o", markersize=3.5, label=told)
    for link in line.links:
        ends = [(line.places[node], values[node]) for node in link.nodes]
        if any(place[1] for place, _ in ends):
            axes.plot(
                [p[0] for p, _ in ends], [v for _, v in ends], color=colour, marker="s", markersize=3.5, linewidth=0.8
            )


@style.styled
def plot_energy_shares(
    modes: xr.Dataset, *, chosen: Sequence[int] | None = None, names: Sequence[str] = (), axes: Axes | None = None
) -> Figure:
    """One bar a mode: the shares of its elastic energy in each connection, what is below 8 % everywhere summed."""
    elastic = [int(i) for i in modes.mode.values if float(modes.frequency.isel(mode=i)) > 0]
    rows = list(chosen) if chosen is not None else elastic[:6]
    share = modes.elastic_share.isel(mode=rows)
    largest = share.max("mode")
    order = np.argsort(-largest.values, kind="stable")
    told = [str(share.element.values[i]) for i in order if float(largest[i]) >= 0.08][:10]
    told.sort(key=list(share.element.values).index)
    figure, drawn = style.on(axes, (7.0, 1.4 + 0.36 * len(rows)))
    left = np.zeros(len(rows))
    for number, element in enumerate(told):
        width = style.shown(share.sel(element=element))
        drawn.barh(range(len(rows)), width, left=left, color=_bar_colour(number), label=style.readable(element))
        left += width
    drawn.barh(range(len(rows)), 100.0 - left, left=left, color="#e3e3e3", label="others")
    drawn.set_yticks(range(len(rows)), [_mode_label(modes, mode, names) for mode in rows])
    drawn.invert_yaxis()
    drawn.set_xlim(0, 100)
    drawn.set_xlabel(style.label("energy_share", name="share of the mode's elastic energy"))
    drawn.grid(visible=False)
    drawn.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def _bar_colour(number: int) -> str:
    return (
        "#0072b2",
        "#d55e00",
        "#009e73",
        "#cc79a7",
        "#56b4e9",
        "#e69f00",
        "#4d4d4d",
        "#7b5ea7",
        "#8c6d31",
        "#a0c4a0",
    )[number]


def _mode_label(modes: xr.Dataset, mode: int, names: Sequence[str]) -> str:
    told = f"{names[mode]}, " if names else f"mode {mode}, "
    return style.plain(told) + f" {float(modes.frequency.isel(mode=mode)):.1f} Hz"
