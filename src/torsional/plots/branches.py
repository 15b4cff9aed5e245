"""Branch diagram: amplitudes of periodic motions over the continued parameter, with stability and bifurcations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.quantities import acceleration, amplitude, swing
from torsional.quantities.branches import (
    bifurcation_points,
    branch_numbers,
    coexisting,
    letter,
    parameter_quantity,
    pieces,
)
from torsional.units import QUANTITIES, convert

Kind = float | str
"""What is drawn of a signal: an order (its amplitude, 0-peak), "mean", or "swing" (half peak-to-peak)."""

MARKERS = {"fold": "s", "period doubling": "D", "branch point": "^", "Neimark–Sacker": "*"}
PATCH = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.2}
NOTHING = 1e-9
"""Share of the largest amplitude below which there is nothing but rounding."""

QUANTITIES_OF = {"element": ("torque", "twist"), "node": ("acceleration", "angle")}


@style.styled
def plot_branches(
    result: xr.Dataset,
    shown: Sequence[Kind],
    *,
    element: str = "",
    node: str = "",
    quantity: str = "",
    solutions: xr.Dataset | None = None,
    legend: bool = True,
    axes: Sequence[Axes] | None = None,
) -> Figure:
    """Amplitudes over the continued parameter, a panel for each of ``shown``: orders, "mean" or "swing".

    ``result`` as a periodic response is given; of one ``element`` its torque (or ``quantity`` "twist"), of one ``node``
    its acceleration (or "angle").  A colour for each branch, stable motions solid, unstable ones dashed and pale,
    a marker at each bifurcation; ranges with several stable motions are shaded; ``solutions`` at one value of the
    parameter are marked by their letters.  The ``legend`` stands beside the first panel.
    """
    drawn = list(axes) if axes is not None else style.panels(len(shown), 1, (8.0, 2.6), sharex=True)
    signal = _signal_of(result, element, node, quantity)
    told, scale = parameter_axis(result)
    for number, (kind, panel) in enumerate(zip(shown, drawn, strict=True)):
        _draw(panel, result, measured(signal, kind), scale)
        _limit(panel, measured(signal, kind), kind, signal)
        if solutions is not None and solutions.sizes["point"]:
            _mark(panel, solutions, measured(_signal_of(solutions, element, node, quantity), kind), scale)
        panel.set_ylabel(_label(signal, kind))
        if number == len(shown) - 1:
            panel.set_xlabel(told)
    if legend:
        _legend(drawn[0], result)
    return style.figure_of(drawn[0])


def _signal_of(result: xr.Dataset, element: str = "", node: str = "", quantity: str = "") -> xr.DataArray:
    """Complex orders (point, order) of one element's torque or twist, or of one node's acceleration or angle."""
    kind = quantity or QUANTITIES_OF["node" if node else "element"][0]
    if node:
        angle = result.angle.sel(node=node)
        return acceleration(angle) if kind == "acceleration" else angle
    return result[kind].sel(element=element)


def measured(signal: xr.DataArray, kind: Kind) -> Array:
    """One number a point: the amplitude of an order, the mean, or half the peak-to-peak swing, in the shown unit."""
    if kind == "mean":
        return style.shown(signal.sel(order=0.0)).real
    return style.shown(swing(signal) if kind == "swing" else amplitude(signal, float(kind)))


def _label(signal: xr.DataArray, kind: Kind) -> str:
    """What is measured and by which convention, then the quantity with its unit."""
    quantity = str(signal.attrs["quantity"])
    name = {"relative_angle": "twist", "angle": "angle"}.get(quantity, quantity)
    told = {"mean": "mean", "swing": "half peak-to-peak"}.get(str(kind), "")
    return (told or f"order {float(kind):g}, 0-peak") + "\n" + style.label(quantity, name=name)


def parameter_axis(result: xr.Dataset) -> tuple[str, float]:
    """The axis label of the continued parameter and the factor from its SI unit to the unit that is shown."""
    name = str(result.attrs["parameter"])
    entry = QUANTITIES[parameter_quantity(result)]
    if entry.name == "ratio":
        return style.plain(name, 60), 1.0
    factor = 1.0 if entry.unit == entry.shown else convert(1.0, entry.unit, entry.shown)
    told = {"speed": "engine speed", "mean_torque": "mean engine torque"}.get(name, style.plain(name, 60))
    return style.label(entry.name, name=told), factor


def branch_colour(number: int) -> str:
    """A branch's colour, the same in every picture."""
    return style.COLOURS[number % len(style.COLOURS)]


def pale(colour: str) -> str:
    """A colour halfway to white, for what is unstable."""
    r, g, b = to_rgb(colour)
    return to_hex((0.5 + 0.5 * r, 0.5 + 0.5 * g, 0.5 + 0.5 * b))


def look(number: int, stable: bool) -> dict[str, object]:
    """The line of a branch's stable or unstable motions."""
    colour = branch_colour(number)
    if stable:
        return {"color": colour, "linewidth": 1.9, "zorder": 3}
    return {"color": pale(colour), "linewidth": 1.4, "linestyle": (0, (4, 1.6)), "zorder": 2.5}


def _draw(axes: Axes, result: xr.Dataset, size: Array, scale: float) -> None:
    at = result.value.values * scale
    for (low, high), _ in coexisting(result):
        axes.axvspan(low * scale, high * scale, color=style.SHADE, zorder=0)
    for piece in pieces(result):
        gid = "stable" if piece.stable else "unstable"
        axes.plot(at[piece.points], size[piece.points], gid=gid, **look(piece.branch, piece.stable))  # type: ignore[arg-type]
    for kind, point, place in zip(
        result.bifurcation_type.values, bifurcation_points(result), result.bifurcation_value.values * scale, strict=True
    ):
        marker = MARKERS.get(str(kind), "o")
        axes.plot(place, size[point], marker, gid="bifurcation", **_marker(marker))  # type: ignore[arg-type]
    axes.set_xlim(at.min(), at.max())


def _limit(axes: Axes, size: Array, kind: Kind, signal: xr.DataArray) -> None:
    """Amplitudes from zero; an order that is not there, and a mean that does not move, are no noise drawn large."""
    axes.ticklabel_format(useOffset=False)
    largest = float(np.abs(style.shown(signal)).max())
    if kind != "mean":
        top = 1.06 * float(size.max()) if size.max() > NOTHING * largest else 1.0
        axes.set_ylim(-0.03 * top, top)
        if size.max() <= NOTHING * largest:
            axes.text(0.5, 0.5, "none", transform=axes.transAxes, ha="center", color=style.FAINT)
    elif np.ptp(size) <= NOTHING * largest:
        axes.set_ylim(float(size.mean()) - 0.1 * (largest or 1.0), float(size.mean()) + 0.1 * (largest or 1.0))


def _mark(axes: Axes, solutions: xr.Dataset, size: Array, scale: float) -> None:
    """A line at the parameter's value and the letter of each motion there; those that lie together share a place."""
    at = float(solutions.value[0]) * scale
    axes.axvline(at, color=style.FAINT, linewidth=1.0, zorder=1)
    low, high = axes.get_ylim()
    told: dict[float, str] = {}
    for point, value in enumerate(size):
        near = next((y for y in told if abs(y - value) < 0.05 * (high - low)), float(value))
        told[near] = told.get(near, "") + letter(point)
        axes.plot(at, value, "o", mfc="white", color=style.INK, markersize=4.5, zorder=5, gid="solution")
    for y, text in told.items():
        look = {"fontsize": 8, "weight": "bold", "zorder": 6, "bbox": PATCH}
        axes.annotate(text, (at, y), (5, 4), textcoords="offset points", **look)  # type: ignore[arg-type]


def _marker(marker: str) -> dict[str, object]:
    size = {"*": 9.0, "D": 5.0}.get(marker, 5.5)
    return {"color": style.INK, "markeredgecolor": "white", "markeredgewidth": 0.7, "markersize": size, "zorder": 4}


def _branch_name(result: xr.Dataset, number: int) -> str:
    """A branch in words: its number, how it came about, and the lowest order that its motions are made of."""
    return f"{number}: {result.kind.values[number]}, base order {float(result.base_order[number]):g}"


def _legend(axes: Axes, result: xr.Dataset) -> None:
    """Branches, stability and the kinds of bifurcation that are there, beside the first panel."""
    for number in branch_numbers(result):
        axes.plot([], [], color=branch_colour(number), linewidth=1.9, label=_branch_name(result, number))
    if not result.stable.values.all():
        axes.plot([], [], **{**look(7, False), "color": style.FAINT}, label="unstable")  # type: ignore[arg-type]
    for kind in dict.fromkeys(str(k) for k in result.bifurcation_type.values):
        marker = MARKERS.get(kind, "o")
        axes.plot([], [], marker, label=kind, **_marker(marker))  # type: ignore[arg-type]
    if coexisting(result):
        axes.fill_between([], [], color=style.SHADE, label="several stable motions")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2)
