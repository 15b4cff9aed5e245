"""Measured run-ups: speed with the pulses that were mended, and orders over speed above what the clock makes."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.measurements.orders import CONVENTIONS, in_convention
from torsional.measurements.shafts import LOST
from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.plots.transient import envelope
from torsional.units import QUANTITIES, RPM

MOST_POINTS = 6000
MENDED, TAKEN = "#b3261e", "#e69f00"
Convention = Literal["0-peak", "RMS", "peak-to-peak"]


@style.styled
def plot_rotation(shaft: xr.Dataset, rotation: xr.Dataset | None = None, *, axes: Axes | None = None) -> Figure:
    """Speed of a measured ``shaft`` over time, its mean ``rotation`` in it, and where pulses were mended.

    A line in the middle of a band of ± twice the standard deviation that the clock makes of it.
    """
    figure, drawn = style.on(axes, (8.4, 3.2))
    time, speed = shaft.time.values, shaft.angular_velocity.values / RPM
    noise = 2 * shaft.speed_noise.values / RPM
    at, line = envelope(time, speed, MOST_POINTS)
    drawn.plot(at, line, color=style.COLOURS[4], linewidth=0.8, label="from tooth to tooth", gid="speed")
    told = f"± 2 σ of the clock ({np.median(noise):.2g} rpm)"
    edges = [envelope(time, speed + sign * noise, MOST_POINTS) for sign in (-1, 1)]
    drawn.fill_between(
        edges[0][0], edges[0][1], edges[1][1], color=style.COLOURS[4], alpha=0.35, linewidth=0, label=told
    )
    if rotation is not None:
        ratio = float(rotation.attrs["ratio"]) if str(rotation.attrs.get("shaft")) == shaft.attrs.get("name") else 1.0
        mean = rotation.speed.values * ratio / RPM
        drawn.plot(rotation.time.values, mean, color=style.COLOURS[0], linewidth=1.4, label="mean rotation", gid="mean")
    lost = shaft.pulse.values == LOST
    _draw_marks(drawn, time[lost], speed[lost], "v", MENDED, "lost")
    extra = shaft.extra_pulse.values
    _draw_marks(drawn, extra, np.interp(extra, time, speed), "x", TAKEN, "too many")
    drawn.set_xlim(float(time[0]), float(time[-1]))
    drawn.set_xlabel("time [s]")
    drawn.set_ylabel(style.label("speed", name="speed"))
    drawn.set_title(style.plain(shaft.attrs.get("name", ""), 60), loc="left")
    drawn.legend(loc="best")
    return figure


def _draw_marks(axes: Axes, time: Array, speed: Array, marker: str, colour: str, what: str) -> None:
    if time.size:
        label = f"{time.size} pulse{'s' * (time.size > 1)} {what}"
        axes.plot(time, speed, marker, color=colour, markersize=5, label=label, gid=what, zorder=4)


@style.styled
def plot_tracked_orders(
    orders: xr.DataArray,
    noise: xr.DataArray | None = None,
    *,
    convention: Convention = "0-peak",
    phases: bool = False,
    logarithmic: bool = False,
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """Sizes of tracked ``orders`` (speed, order) over speed, told by a ``convention``, and their ``phases`` below.

    Phases are drawn where an order is three times as large as the noise.

    ``noise`` (speed): what clock and counts make of nothing, 0-peak, drawn as a floor; one that depends on the order,
    as that of a speed does, is (speed, order) and drawn for the largest.
    """
    values = style.over(orders, "speed", "order")
    size = (7.4, 2.6 if phases else 3.6)
    drawn = style.panels(2 if phases else 1, 1, size, sharex=True) if axes is None else [axes]
    phases = phases and axes is None
    rpm = values.speed.values / RPM
    sizes = in_convention(values, convention)
    factor = shown_factor(values)
    for place, n in enumerate(values.order.values):
        colour, dash = style.COLOURS[place % len(style.COLOURS)], style.DASHES[place // len(style.COLOURS) % 4]
        drawn[0].plot(rpm, sizes.values[:, place] * factor, dash, color=colour, label=f"order {n:g}", gid="cut")
        if phases:
            floor = 0.0 if noise is None else 3 * noise.values.reshape(rpm.size, -1).max(axis=1)
            heard = np.abs(values.values[:, place]) > floor
            angle = np.degrees(np.angle(values.values[:, place]))
            drawn[1].plot(rpm[heard], angle[heard], ".", color=colour, markersize=3, gid="phase")
    if noise is not None:
        worst = (noise.max("order") if "order" in noise.dims else noise).values * CONVENTIONS[convention] * factor
        _draw_floor(drawn[0], rpm, worst)
    drawn[0].set_yscale("log") if logarithmic else drawn[0].set_ylim(bottom=0)
    drawn[0].set_ylabel(named_label(values, convention))
    drawn[0].set_title(style.plain(title, 80), loc="left")
    drawn[0].legend()
    if phases:
        drawn[1].set_ylabel("phase against\ncrank angle [deg]")
        drawn[1].set_ylim(-185, 185)
        drawn[1].set_yticks([-180, -90, 0, 90, 180])
    drawn[-1].set_xlim(float(rpm.min()), float(rpm.max()) if np.ptp(rpm) else float(rpm.max()) + 1)
    drawn[-1].set_xlabel(style.label("speed", name="engine speed"))
    return style.figure_of(drawn[0])


def _draw_floor(axes: Axes, rpm: Array, level: Array) -> None:
    order = np.argsort(rpm)
    look = {"color": style.FAINT, "alpha": 0.3, "linewidth": 0}
    axes.fill_between(rpm[order], level[order], label="noise floor of clock and counts", gid="floor", **look)  # type: ignore[arg-type]


def shown_factor(values: xr.DataArray) -> float:
    """From a channel's own unit to the one in which its quantity is shown; 1 where that is not known here."""
    quantity = str(values.attrs.get("quantity", ""))
    known = quantity in QUANTITIES and values.attrs.get("units") == QUANTITIES[quantity].unit
    return float(style.shown(np.ones(1), quantity)[0]) if known else 1.0


def named_label(values: xr.DataArray, convention: str) -> str:
    """An axis label: quantity, or the channel's own name and unit, and the convention of amplitudes."""
    quantity = str(values.attrs.get("quantity", ""))
    if quantity in QUANTITIES and values.attrs.get("units") == QUANTITIES[quantity].unit:
        return style.label(quantity, convention, WORDS.get(quantity, ""))
    unit = str(values.attrs.get("units", ""))
    told = style.plain(values.attrs.get("long_name", values.name or "signal"))
    return f"{told}{f' [{style.plain(unit, 16)}]' if unit else ''}, {convention}"


WORDS = {"angle": "torsional angle", "angular_velocity": "torsional velocity", "acceleration": "torsional acceleration"}
