"""Loops of a rig beside the models that were fitted to them, and what the models leave."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from torsional.numerics.arrays import Array
from torsional.plots import style

_MEASURED: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 3.0, "color": "#bbbbbb", "zorder": 1.5}
_MODELS = {
    "fitted": ("viscous and dry friction", style.COLOURS[0], "-"),
    "coulomb": ("Coulomb", style.COLOURS[1], "--"),
}
_WORDS = {
    "spring.rate": "spring rate",
    "secondary_clearance": "clearance",
    "friction.sliding_coefficient": "friction coefficient",
    "friction.viscous_coefficient": "viscous coefficient",
    "grease_damping": "grease",
}


@style.styled
def plot_identified(data: xr.Dataset) -> Figure:
    """A panel for each speed and mean torque with the loops of all sweeps, measured and fitted; below, by what the
    parameters are missed, with two standard deviations of the noise.

    ``data`` as claim F1 gives it: ``angle``, ``measured`` and ``fitted`` over ``loop``, ``miss`` and ``deviation`` over
    ``parameter``.
    """
    speeds, loads = np.unique(data.speed.values), np.unique(data.mean_torque.values)
    figure = Figure(figsize=(3.3 * loads.size, 2.3 * speeds.size + 2.2))
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(speeds.size + 1, loads.size, height_ratios=[1.0] * speeds.size + [0.8])
    for row, speed in enumerate(speeds):
        for column, load in enumerate(loads):
            axes = figure.add_subplot(grid[row, column])
            _loops(axes, data.isel(loop=(data.speed.values == speed) & (data.mean_torque.values == load)))
            rpm = float(style.shown(np.asarray(speed), "speed"))
            axes.set_title(f"{rpm:.0f} rpm, {load:.0f} Nm", fontsize=9.0)
            axes.set_ylabel(style.label("torque") if column == 0 else "")
            axes.set_xlabel(style.label("relative_angle", name="angle") if row == speeds.size - 1 else "")
            if row == column == 0:
                axes.legend(loc="upper left", fontsize=7.0)
    _misses(figure.add_subplot(grid[speeds.size, :]), data)
    return figure


def _loops(axes: Axes, loops: xr.Dataset) -> None:
    for number in range(loops.sizes["loop"]):
        one = loops.isel(loop=number)
        angle, sweep = style.shown(one.angle, "relative_angle"), float(style.shown(one.sweep, "relative_angle"))
        axes.plot(
            angle, one.measured, label=None if number else "measured, mean of cycles", gid="measured", **_MEASURED
        )
        axes.plot(*_closed(angle, one.fitted.values), linewidth=1.0, label=f"fitted, ±{sweep:.0f}°", gid="fitted")


def _closed(*lines: Array) -> list[Array]:
    return [np.append(line, line[:1]) for line in lines]


def _misses(axes: Axes, data: xr.Dataset) -> None:
    miss, deviation = 100.0 * data.miss.values, 100.0 * data.deviation.values
    place = np.arange(miss.size)
    axes.axhspan(-5.0, 5.0, color=style.SHADE, zorder=0, label="within 5 %")
    axes.errorbar(
        place, miss, 2.0 * deviation, fmt="o", capsize=4.0, label="found, ± 2 standard deviations of the noise"
    )
    axes.set_xticks(place, [_WORDS.get(str(name), style.readable(name)) for name in data.parameter.values])
    axes.axhline(0.0, color=style.INK, linewidth=0.8)
    axes.set_xlim(-0.5, miss.size - 0.5)
    reach = max(7.0, 1.2 * float((np.abs(miss) + 2.0 * deviation).max()))
    axes.set_ylim(-reach, 1.4 * reach)
    axes.set_ylabel("off the truth [%]")
    axes.legend(loc="upper right", ncols=2)


@style.styled
def plot_rig_friction(data: xr.Dataset) -> Figure:
    """What friction makes of a loop, slowly and fast; residuals of both models; the viscous share of the loss.

    ``data`` as claim F2 gives it: loops as for F1 with a model ``coulomb`` beside ``fitted``, and the shares
    ``unloaded`` and ``loaded`` over ``rotation``, ``swing`` and ``pace``; ``load`` [Nm] in its attributes.
    """
    figure = Figure(figsize=(11.0, 7.4))
    FigureCanvasAgg(figure)
    axes = list(figure.subplots(2, 2).ravel())
    chosen = (data.speed.values == data.speed.values.min()) & (data.sweep.values == data.sweep.values.max())
    pair = data.isel(loop=np.flatnonzero(chosen)[[0, -1]])
    _widths(axes[:2], pair)
    _misfits(axes[2], data)
    _shares(axes[3], data)
    return figure


def _widths(axes: Sequence[Axes], pair: xr.Dataset) -> None:
    """Torque less the straight line through the fitted loop, over the angle."""
    for number, drawn in enumerate(axes):
        one = pair.isel(loop=number)
        angle = style.shown(one.angle, "relative_angle")
        spring = np.polynomial.Polynomial.fit(angle, one.fitted.values, 1)(angle)
        drawn.plot(angle, one.measured.values - spring, label="measured, mean of cycles", **_MEASURED)
        for name, (words, colour, dashes) in _MODELS.items():
            drawn.plot(
                *_closed(angle, one[name].values - spring), color=colour, linestyle=dashes, label=words, gid=name
            )
        speed, sweep = (
            float(style.shown(one[of], kind)) for of, kind in (("speed", "speed"), ("sweep", "relative_angle"))
        )
        drawn.set_title(f"{speed:.0f} rpm, ±{sweep:.0f}°, {float(one.frequency):.0f} Hz, no mean torque")
        drawn.set_xlabel(style.label("relative_angle", name="angle"))
        drawn.set_ylabel("torque less a straight line [Nm]")
    low, high = (pick([pick(each.get_ylim()) for each in axes]) for pick in (min, max))
    for drawn in axes:
        drawn.set_ylim(low, high)
    axes[0].legend(loc="upper right")


def _misfits(axes: Axes, data: xr.Dataset) -> None:
    place = np.arange(data.sizes["loop"])
    for number, (name, (words, colour, _)) in enumerate(_MODELS.items()):
        axes.bar(place + 0.4 * number - 0.2, data[f"{name}_misfit"].values, 0.38, color=colour, label=words, gid=name)
    axes.axhline(1.0, color=style.INK, linewidth=1.0, linestyle=":", label="noise alone")
    rpm, sweep = style.shown(data.speed, "speed"), style.shown(data.sweep, "relative_angle")
    told = [f"{a:.0f}\n±{b:.0f}°\n{c:.0f}" for a, b, c in zip(rpm, sweep, data.frequency.values, strict=True)]
    axes.set_xticks(place, told, fontsize=8.0)
    axes.set_xlabel("loops: rotational speed [rpm], sweep, frequency [Hz]")
    axes.set_ylabel("RMS of residuals over noise [-]")
    axes.set_title("what the models leave")
    axes.set_ylim(0.0, 1.2 * float(data.coulomb_misfit.max()))
    axes.legend(loc="upper left", ncols=3)


def _shares(axes: Axes, data: xr.Dataset) -> None:
    """A colour a rotational speed, at the smallest sweep; full without mean torque, dashed with it."""
    small = data.isel(swing=0)
    for number, rpm in enumerate(style.shown(data.rotation, "speed")):
        for name, dashes in (("unloaded", "-"), ("loaded", "--")):
            share = style.shown(small[name].isel(rotation=number), "energy_share")
            label = f"{rpm:.0f} rpm" if dashes == "-" else None
            axes.plot(data.pace, share, dashes, color=style.COLOURS[number], marker="o", markersize=3.0, label=label)
    axes.plot([], [], "--", color=style.INK, label=f"the same under {data.attrs['load']:.0f} Nm")
    axes.axhline(50.0, color=style.INK, linewidth=1.0, linestyle=":")
    axes.set_xscale("log")
    axes.set_xticks(data.pace.values, [f"{value:g}" for value in data.pace.values])
    axes.minorticks_off()
    axes.set_ylim(0.0, 100.0)
    axes.set_xlabel(style.label("frequency"))
    axes.set_ylabel("viscous share of friction's loss [%]")
    sweep = float(style.shown(small.swing, "relative_angle"))
    axes.set_title(f"viscous friction at ±{sweep:.0f}°")
    axes.legend(loc="upper left")
