"""Runs in time: speeds, twists with their stops, torques, each in a panel of its own over the same time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style

STOP = "#b3261e"
MOST_POINTS = 6000
"""Samples of a line that a picture can show; of more only the lowest and highest of each group are drawn."""


@style.styled
def plot_transient(
    run: xr.Dataset,
    *,
    nodes: Sequence[str],
    springs: Sequence[str],
    elements: Sequence[str] = (),
    title: str = "",
) -> Figure:
    """Speeds of ``nodes``, twists of ``springs`` with their stops, torques of springs and further ``elements``.

    ``run``: a Dataset of `transient`, stops and contacts as `read_off` adds them.
    """
    drawn = style.panels(3, 1, (8.4, 2.3), sharex=True)
    draw_motion(drawn, run, nodes, springs, elements)
    drawn[0].set_title(style.plain(title, 100), loc="left")
    drawn[-1].set_xlabel("time [s]")
    return style.figure_of(drawn[0])


def draw_motion(
    drawn: Sequence[Axes], run: xr.Dataset, nodes: Sequence[str], springs: Sequence[str], elements: Sequence[str]
) -> None:
    """Three panels: speeds, twists (of the springs, or where there are none of the elements), torques."""
    ratio = run.speed_ratio
    for node in nodes:
        at_engine = run.angular_velocity.sel(node=node) / (float(ratio.sel(node=node)) or 1.0)
        named = style.readable(node) + ("" if abs(float(ratio.sel(node=node)) - 1) < 1e-9 else ", as at the engine")
        _draw_line(drawn[0], run, style.shown(at_engine, "speed"), named)
    drawn[0].set_ylabel(style.label("speed", name="speed"))
    for spring in springs or elements:
        _draw_line(drawn[1], run, style.shown(run.twist.sel(element=spring)), style.readable(spring))
    _draw_stops(drawn[1], run, springs)
    drawn[1].set_ylabel(style.label("relative_angle", name="twist"))
    for place, element in enumerate([*springs, *elements]):
        values = style.shown(run.torque.sel(element=element))
        _draw_line(drawn[2], run, values, style.readable(element), place)
    drawn[2].set_ylabel(style.label("torque", name="torque"))
    for axes in drawn[:3]:
        axes.set_xlim(float(run.time[0]), float(run.time[-1]))
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=4, borderpad=0.1)


def _draw_line(axes: Axes, run: xr.Dataset, values: Array, name: str, place: int = -1) -> None:
    """One signal over time, thinned to its envelope where it has more points than can be seen."""
    time, thin = envelope(run.time.values, np.asarray(values))
    width = 1.1 if len(time) > 800 else 1.5
    colour = {} if place < 0 else {"color": style.COLOURS[place % len(style.COLOURS)]}
    axes.plot(time, thin, linewidth=width, label=name, gid="signal", **colour)  # type: ignore[arg-type]


def envelope(time: Array, values: Array, most: int = MOST_POINTS) -> tuple[Array, Array]:
    """Time and values of at most ``most`` points: of each group of neighbours the lowest and the highest, in turn.

    >>> t, x = envelope(np.arange(100.0), np.r_[np.zeros(50), 1.0, np.zeros(49)], most=10)
    >>> len(t) <= 10, float(x.max()), float(t[x.argmax()])
    (True, 1.0, 50.0)
    """
    if len(time) <= most:
        return time, values
    size = -(-2 * len(time) // most)
    starts = np.arange(0, len(time), size)
    places = [p for a in starts for p in sorted((a + values[a : a + size].argmin(), a + values[a : a + size].argmax()))]
    return time[places], values[places]


def _draw_stops(axes: Axes, run: xr.Dataset, springs: Sequence[str]) -> None:
    """Lines at the stops of springs that have any, and a mark wherever one is met."""
    named = False
    for spring in springs:
        one = run.sel(element=spring)
        stops = [float(one[name]) for name in ("stop_below", "stop_above") if name in one]
        for stop in stops:
            if np.isfinite(stop):
                at = float(style.shown(np.asarray(stop), "relative_angle"))
                axes.axhline(at, color=STOP, linestyle=(0, (5, 2)), linewidth=1.2, label=None if named else "stop")
                named = True
        if int(one.stop_contacts) if "stop_contacts" in one else 0:
            twist = one.twist.values
            beyond = (twist < stops[0]) | (twist > stops[1])
            axes.plot(
                run.time.values[beyond],
                style.shown(twist, "relative_angle")[beyond],
                linestyle="none",
                marker=".",
                markersize=4.0,
                color=STOP,
                label="on the stop",
            )
