"""The region of a sub-harmonic motion over speed and mean torque: its amplitude, its boundaries, full load."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style
from torsional.plots.maps import draw_limits
from torsional.quantities.region import boundary_curves

BOUNDARIES = {"period doubling": (style.INK, "-"), "fold": (style.COLOURS[1], "--")}
COLOURS = "cividis_r"
"""Dark where the motion is strong, told apart by every eye, and never as light as the white of no motion."""


@style.styled
def plot_region(
    found: xr.Dataset,
    shown: str = "amplitude",
    *,
    full_load: xr.DataArray | None = None,
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """0-peak amplitude of the sub-harmonic order over (torque, speed) in colour, white where there is none.

    ``found`` as a sub-harmonic map is given; ``shown`` "amplitude" (torque of the element), "twist_amplitude" or
    "acceleration".  Curves of period doublings and folds bound the region; cells with several stable motions are
    dotted; a cross marks the largest amplitude; ``full_load`` (speed) [Nm].
    """
    figure, drawn = style.on(axes, (7.6, 4.8))
    values = found[shown].transpose("mean_torque", "speed")
    rpm, torque = style.shown(values.speed), style.shown(values.mean_torque)
    size = np.ma.masked_less_equal(np.ma.masked_invalid(style.shown(values)), 0.0)
    mesh = drawn.pcolormesh(rpm, torque, size, cmap=COLOURS, shading="nearest", vmin=0.0, rasterized=True)
    figure.colorbar(mesh, ax=drawn, label=_label(found, shown), pad=0.01)
    _draw_several(drawn, found)
    _draw_boundaries(drawn, found)
    if size.count():
        row, column = np.unravel_index(int(size.argmax()), size.shape)
        told = f"largest: {size.max():.4g} {style.shown_unit(str(values.attrs['quantity']))}"
        look = {"color": style.COLOURS[1], "markersize": 8, "markeredgewidth": 2.0, "linestyle": "none"}
        drawn.plot(rpm[column], torque[row], "x", label=told, zorder=6, gid="largest", **look)  # type: ignore[arg-type]
    draw_limits(drawn, values, None, full_load, title)
    if not size.count():
        drawn.text(
            0.5, 0.5, "no such motion found", transform=drawn.transAxes, ha="center", bbox={"facecolor": "white"}
        )
    drawn.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3)
    return figure


def _label(found: xr.Dataset, shown: str) -> str:
    quantity = str(found[shown].attrs["quantity"])
    place = style.plain(found.attrs.get("element", ""), 24)
    name = {"amplitude": f"torque in {place}", "twist_amplitude": f"twist of {place}"}.get(
        shown, shown.replace("_", " ")
    )
    return style.label(quantity, "0-peak", f"order {float(found.attrs['order']):g}: {name}")


def _draw_several(axes: Axes, found: xr.Dataset) -> None:
    """Dots where more than one motion is stable: which of them is met depends on how one came there."""
    several = (found.stable_solutions.transpose("mean_torque", "speed").values > 1).astype(float)
    if several.any() and min(several.shape) > 1:
        rpm, torque = style.shown(found.speed), style.shown(found.mean_torque)
        dots = {"colors": "none", "hatches": ["..."]}
        axes.contourf(rpm, torque, several, levels=[0.5, 1.5], **dots)  # type: ignore[arg-type]
        axes.fill_between([], [], facecolor="none", edgecolor=style.INK, hatch="...", label="several stable motions")


def _draw_boundaries(axes: Axes, found: xr.Dataset) -> None:
    """Each boundary in the colour and dash of its kind."""
    told: set[str] = set()
    for kind, curve in boundary_curves(found):
        colour, dash = BOUNDARIES.get(kind, (style.FAINT, ":"))
        look = {"color": colour, "linestyle": dash, "linewidth": 1.8, "zorder": 4, "gid": "boundary"}
        rpm, torque = style.shown(curve[:, 0], "speed"), style.shown(curve[:, 1], "torque")
        axes.plot(rpm, torque, label="_" if kind in told else kind, **look)  # type: ignore[arg-type]
        told.add(kind)
