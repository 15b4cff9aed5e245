"""Spectra along measured run-ups: colour maps over order or frequency and speed, and stacked as a waterfall."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from torsional.measurements.orders import in_convention
from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.plots.maps import colour_limits
from torsional.plots.tracking import Convention, named_label, shown_factor
from torsional.units import RPM

STEADY = 0.03
"""Relative range of speed below which spectra are drawn over time: there is no run-up."""
BINS = 240
LINES = 40
"""Spectra that a waterfall shows at most."""
OVERLAP = 8.0
"""How many distances between its lines the largest peak of a waterfall is high."""


@style.styled
def plot_spectrogram(
    spectra: xr.DataArray,
    *,
    convention: Convention = "0-peak",
    orders: Sequence[float] = (),
    title: str = "",
    axes: Axes | None = None,
) -> Figure:
    """Sizes of ``spectra`` over order or frequency and speed in logarithmic colours, with lines of ``orders``.

    ``spectra``: a variable of `track_orders` (speed, order) or of `speed_spectrogram` (speed, spectrum_frequency).
    Windows at one speed are drawn by their root mean square; at steady speed the vertical axis is time.
    """
    figure, drawn = style.on(axes, (7.4, 4.2))
    across, sizes = _sizes(spectra, convention)
    along, told = _along(spectra)
    rows, where = _binned(sizes.values * shown_factor(spectra), along)
    low, high = colour_limits(rows)
    seen = np.ma.masked_invalid(np.maximum(rows, low))
    x = sizes[across].values
    look = {"cmap": style.AMOUNT, "shading": "nearest", "rasterized": True}
    mesh = drawn.pcolormesh(x, where, seen, norm=LogNorm(low, high), **look)  # type: ignore[arg-type]
    figure.colorbar(mesh, ax=drawn, extend="min", label=named_label(spectra, convention), pad=0.01)
    if across == "spectrum_frequency" and told == SPEED:
        _draw_orders(drawn, orders, where, float(x[-1]))
    _finish(drawn, across, x)
    drawn.set_ylim(float(where[0]), float(where[-1]))
    drawn.set_ylabel(told)
    drawn.set_title(style.plain(title, 80), loc="left")
    drawn.grid(visible=False)
    return figure


@style.styled
def plot_waterfall(
    spectra: xr.DataArray, *, convention: Convention = "0-peak", title: str = "", axes: Axes | None = None
) -> Figure:
    """Sizes of ``spectra`` as lines one above the other, each at its speed, with a bar that tells how high they are.

    ``spectra`` as of `plot_spectrogram`; of very many, one in several is shown.
    """
    figure, drawn = style.on(axes, (7.4, 5.4))
    across, sizes = _sizes(spectra, convention)
    along, told = _along(spectra)
    rows = sizes.values * shown_factor(spectra)
    picked = np.unique(np.linspace(0, along.size - 1, min(LINES, along.size)).round().astype(int))
    picked = picked[np.argsort(along[picked])]
    apart = float(np.ptp(along[picked])) / max(picked.size - 1, 1) or 1.0
    high = float(np.nanmax(rows[picked])) or 1.0
    scale, x = OVERLAP * apart / high, sizes[across].values
    for place, row in enumerate(picked[::-1]):
        line = along[row] + scale * rows[row]
        drawn.fill_between(x, along[row], line, color="white", zorder=2 * place + 2, linewidth=0)
        drawn.plot(x, line, color=style.COLOURS[0], linewidth=0.8, zorder=2 * place + 3, gid="spectrum")
    _draw_scale(drawn, high, scale, named_label(spectra, convention), float(along[picked].max()))
    _finish(drawn, across, x)
    drawn.set_ylabel(told)
    drawn.set_title(style.plain(title, 80), loc="left")
    return figure


SPEED = style.label("speed", name="engine speed")


def _sizes(spectra: xr.DataArray, convention: Convention) -> tuple[str, xr.DataArray]:
    """The axis across, and the sizes over speed and it."""
    across = "order" if "order" in spectra.dims else "spectrum_frequency"
    return across, in_convention(style.over(spectra, "speed", across), convention)


def _along(spectra: xr.DataArray) -> tuple[Array, str]:
    """Speeds in rpm, or times where the speed is steady, and how the axis is called."""
    rpm = np.asarray(spectra.speed.values / RPM)
    if np.ptp(rpm) < STEADY * rpm.mean() and "time" in spectra.coords:
        return np.asarray(spectra.time.values), "time [s]"
    return rpm, SPEED


def _binned(rows: Array, along: Array) -> tuple[Array, Array]:
    """Root mean squares of spectra in even steps of speed or time; steps without any take the next below."""
    count = int(np.clip(along.size, 1, BINS))
    edges = np.linspace(along.min(), along.max() + 1e-9 * abs(along.max()), count + 1)
    place = np.clip(np.searchsorted(edges, along, side="right") - 1, 0, count - 1)
    sums, numbers = np.zeros((count, rows.shape[1])), np.bincount(place, minlength=count)
    np.add.at(sums, place, rows**2)
    filled = np.maximum.accumulate(np.where(numbers > 0, np.arange(count), 0))
    return np.sqrt(sums[filled] / numbers[filled][:, None]), 0.5 * (edges[:-1] + edges[1:])


def _draw_orders(axes: Axes, orders: Sequence[float], rpm: Array, highest: float) -> None:
    for n in orders:
        hertz = n * rpm / 60
        axes.plot(hertz, rpm, color="white", linewidth=0.7, linestyle=(0, (5, 4)), gid="order")
        seen = np.flatnonzero(hertz < 0.97 * highest)
        if seen.size:
            at = int(seen[-1])
            look = {"color": "white", "fontsize": 7.5, "va": "top", "ha": "right"}
            axes.annotate(f"{n:g}", (hertz[at], rpm[at]), (-3, -3), textcoords="offset points", **look)  # type: ignore[arg-type]


def _draw_scale(axes: Axes, high: float, scale: float, told: str, top: float) -> None:
    """A bar of a round size at the right, beside the lines."""
    size = 10 ** np.floor(np.log10(high))
    size = size * max(k for k in (1, 2, 5) if k * size <= high)
    place = axes.get_yaxis_transform()
    axes.plot([1.02, 1.02], [top, top + scale * size], color=style.INK, transform=place, clip_on=False, linewidth=2.5)
    words = {"transform": place, "rotation": 90, "va": "top", "ha": "left", "fontsize": 8}
    axes.text(1.035, top + scale * size, f"{size:g} of {told}", clip_on=False, **words)  # type: ignore[arg-type]


def _finish(axes: Axes, across: str, x: Array) -> None:
    axes.set_xlim(float(x[0]), float(x[-1]))
    order = style.label("engine_order", name="engine order")
    axes.set_xlabel(order if across == "order" else style.label("frequency", name="frequency"))
