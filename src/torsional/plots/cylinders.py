"""Engines with fewer cylinders at work, side by side: vibration over speed, resonance speeds, strongest orders."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style

MARKS = ("o", "s", "^", "D", "v", "P")
MOST = 3
"""Engines whose strongest orders are mapped."""


@style.styled
def plot_fewer_cylinders(data: xr.Dataset) -> Figure:
    """The Dataset of `torsional.studies.cylinders.compared`: above, the swing over speed under the middle mean torque
    for each concept, and where the firing order meets the modes; below, the strongest order of the last concept."""
    drawn = style.panels(2, 3, (4.6, 3.5))
    concepts = [str(name) for name in data.concept.values]
    middle = float(data.mean_torque[data.sizes["mean_torque"] // 2])
    for axes, concept in zip(drawn[:2], concepts[:2], strict=False):
        _draw_swings(axes, data.sel(concept=concept, mean_torque=middle), f"{concept}, {middle:.0f} Nm")
    top = max(axes.get_ylim()[1] for axes in drawn[: len(concepts[:2])])
    for axes in drawn[: len(concepts[:2])]:
        axes.set_ylim(10 ** np.floor(np.log10(top) - 2.7), top)
    drawn[0].legend(loc="lower left")
    if len(concepts) < 2:
        drawn[1].set_axis_off()
    _draw_resonances(drawn[2], data)
    chosen = [name for name in data.engine.values if name != "neighbours off"][:MOST]
    for axes, name in zip(drawn[3:], chosen, strict=False):
        _draw_strongest(axes, data.strongest.sel(concept=concepts[-1], engine=name), f"{concepts[-1]}, {name}")
    for axes in drawn[3 + len(chosen) :]:
        axes.set_axis_off()
    return style.figure_of(drawn[0])


def _draw_swings(axes: Axes, found: xr.Dataset, title: str) -> None:
    rpm = style.shown(found.speed)
    for place, name in enumerate(found.engine.values):
        values = found.swing.sel(engine=name).values
        axes.semilogy(rpm, values, color=style.COLOURS[place], linestyle=style.DASHES[place % 4], label=str(name))
    axes.set_xlim(rpm[0], rpm[-1])
    axes.set_title(title)
    axes.set_xlabel(style.label("speed", name="engine speed"))
    axes.set_ylabel(style.label("acceleration", "half peak-to-peak", "acceleration"))


def _draw_resonances(axes: Axes, data: xr.Dataset) -> None:
    """A row for each concept's mode, a mark for each engine; the operating range shaded."""
    pairs = [
        (concept, mode)
        for concept in data.concept.values
        for mode in data.mode.values
        if np.isfinite(data.resonance.sel(concept=concept, mode=mode).values).all()
    ]
    for place, name in enumerate(data.engine.values):
        if name == "neighbours off":
            continue
        rpm = [style.shown(data.resonance.sel(concept=c, mode=m, engine=name), "speed") for c, m in pairs]
        order = f"{name}, order {float(data.firing_order.sel(engine=name)):g}"
        axes.plot(rpm, np.arange(len(pairs)), MARKS[place], color=style.COLOURS[place], label=order, linestyle="none")
    axes.set_yticks(np.arange(len(pairs)), [f"{c}\n{m}" for c, m in pairs])
    axes.set_ylim(len(pairs) - 0.5, -0.5 - 0.45 * len(pairs))
    low, high = style.shown(data.speed)[[0, -1]]
    axes.axvspan(low, high, color=style.SHADE, zorder=0, label="speeds asked")
    axes.set_title("Firing order meets the mode")
    axes.set_xlabel(style.label("speed", name="engine speed"))
    axes.legend(loc="upper right")


def _draw_strongest(axes: Axes, orders: xr.DataArray, title: str) -> None:
    known = np.unique(orders.values[np.isfinite(orders.values)])
    place = np.where(np.isfinite(orders.values), np.searchsorted(known, np.nan_to_num(orders.values)), np.nan)
    colours = ListedColormap(_colours(known))
    edges = np.arange(known.size + 1) - 0.5
    rpm = style.shown(orders.speed)
    mesh = axes.pcolormesh(
        rpm,
        style.shown(orders.mean_torque),
        place,
        cmap=colours,
        norm=BoundaryNorm(edges, known.size),
        shading="nearest",
        rasterized=True,
    )
    axes.grid(visible=False)
    axes.set_title(f"Strongest order: {title}")
    axes.set_xlabel(style.label("speed", name="engine speed"))
    axes.set_ylabel(style.label("torque", name="mean torque"))
    bar = style.figure_of(axes).colorbar(mesh, ax=axes, ticks=np.arange(known.size), label="engine order")
    bar.ax.set_yticklabels([f"{n:g}" for n in known])


def _colours(orders: Array) -> list[str]:
    """One colour for an order in all maps: by the order itself, half orders up to 4 and one for all above."""
    table = {0.5: 7, 1.0: 4, 1.5: 1, 2.0: 2, 2.5: 3, 3.0: 0, 4.0: 5}
    return [style.COLOURS[table[float(n)]] if float(n) in table else "#d8d8d8" for n in orders]
