"""An absorber spring's characteristic with its operating points, and its travel over speed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.laws import Law, hinge_rows
from torsional.numerics.arrays import Array
from torsional.plots import style


@style.styled
def plot_characteristic(
    travel: xr.Dataset, law: Law | None = None, *, stiffness: float = 0.0, axes: Axes | None = None
) -> Figure:
    """Torque over twist of a spring with its operating points at full load; a bar is the swing about each.

    ``travel``: ``mean_twist`` and ``swing`` (half peak-to-peak) [rad] and ``mean_torque`` [Nm] over ``speed``; ``law``
    or ``stiffness`` [Nm/rad] the spring's; stages are told apart by shade and the stop by a line.
    """
    figure, drawn = style.on(axes, (6.4, 4.2))
    mean, swing = travel.mean_twist.values, travel.swing.values
    stops = [s for s in law.stops if s > 0] if law is not None else []
    low, high = float(np.min(mean - swing)), float(np.max(mean + swing))
    ends = min(low, 0.0), max(high, *stops) if stops else high
    room = 0.05 * (ends[1] - ends[0])
    angle = np.linspace(ends[0] - room, ends[1] + room, 600)
    torque = stiffness * angle + (law.torque(angle) if law is not None else 0.0)
    drawn.plot(style.shown(angle, "relative_angle"), torque, color=style.INK, linewidth=2.0, label="spring")
    if law is not None and hinge_rows(law) is not None:
        _draw_stages(drawn, law, angle)
    chosen = _widest(travel.mean_torque.values, swing)
    x, bar = style.shown(mean, "relative_angle")[chosen], style.shown(swing, "relative_angle")[chosen]
    y = stiffness * mean[chosen] + (law.torque(mean[chosen]) if law is not None else 0.0)
    look = {"color": style.COLOURS[0], "capsize": 2.5, "elinewidth": 1.0, "markersize": 4.5}
    drawn.errorbar(x, y, xerr=bar, fmt="o", label="full load, bar: swing (half peak-to-peak)", **look)  # type: ignore[arg-type]
    drawn.set_xlabel(style.label("relative_angle", name="twist"))
    drawn.set_ylabel(style.label("torque"))
    top = 1.15 * max(float(np.interp(at, angle, torque)) for at in (mean.max(), *stops))
    drawn.set_ylim(min(0.0, float(torque.min())) - 0.04 * top, 1.08 * top)
    drawn.set_xlim(*style.shown(angle[[0, -1]], "relative_angle"))
    drawn.legend(loc="upper left")
    return figure


def _widest(torque: Array, swing: Array, count: int = 12) -> list[int]:
    """For some levels of mean torque the point with the widest swing, so that bars do not cover each other."""
    level = np.round(count * torque / max(float(np.abs(torque).max()), 1e-9))
    return [int(max(np.flatnonzero(level == value), key=lambda i: swing[i])) for value in np.unique(level)]


def _draw_stages(axes: Axes, law: Law, angle: Array) -> None:
    """Shades for the stages in drive, a red line at the stop."""
    stops = [stop for stop in law.stops if stop > 0]
    end = min(stops, default=float(angle[-1]))
    edges = [0.0, *(edge for edge in law.edges.tolist() if 0 < edge < end), end]
    for number, (a, b) in enumerate(pairwise(edges)):
        left, right = (float(v) for v in style.shown(np.array([a, b]), "relative_angle"))
        axes.axvspan(left, right, color=(style.SHADE, "#dbe4ec")[number % 2], zorder=0)
        if len(edges) > 2:
            axes.text(
                0.5 * (left + right), 0.02, f"stage {number + 1}", transform=axes.get_xaxis_transform(), ha="center"
            )
    for stop in stops:
        axes.axvline(float(style.shown(np.array(stop), "relative_angle")), color=style.COLOURS[1], label="stop")


@style.styled
def plot_travel(
    travel: xr.Dataset, *, stop: float | None = None, transition: float | None = None, axes: Axes | None = None
) -> Figure:
    """Mean twist at full load over speed with its swing as a band; ``stop`` and the ``transition`` of stages [rad]."""
    figure, drawn = style.on(axes, (6.4, 4.2))
    rpm = style.shown(travel.speed)
    mean, swing = (style.shown(travel[key].values, "relative_angle") for key in ("mean_twist", "swing"))
    drawn.fill_between(
        rpm, mean - swing, mean + swing, color=style.COLOURS[4], alpha=0.45, label="swing, half peak-to-peak"
    )
    drawn.plot(rpm, mean, color=style.COLOURS[0], label="mean twist at full load")
    for at, name, colour in ((stop, "stop", style.COLOURS[1]), (transition, "next stage", style.COLOURS[2])):
        if at is not None:
            drawn.axhline(float(style.shown(np.array(at), "relative_angle")), color=colour, label=name)
    drawn.set_xlim(rpm[0], rpm[-1])
    drawn.set_xlabel(style.label("speed", name="engine speed"))
    drawn.set_ylabel(style.label("relative_angle", name="twist"))
    drawn.legend(loc="best")
    return figure
