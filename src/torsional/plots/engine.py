"""What the engine does: full-load curve and torque orders."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.plots import style


@style.styled
def plot_full_load(curve: xr.DataArray, *, idle: float | None = None, axes: Axes | None = None) -> Figure:
    """Full-load torque (speed) [Nm] and the power that goes with it."""
    figure, drawn = style.on(axes, (5.2, 3.6))
    rpm, torque = style.shown(curve.speed), style.shown(curve)
    drawn.plot(rpm, torque, color=style.COLOURS[0], label="torque")
    drawn.set_xlim(rpm[0], rpm[-1])
    drawn.set_ylim(0, 1.15 * torque.max())
    style.operating_range(drawn, None, idle)
    drawn.set_xlabel(style.label("speed", name="engine speed"))
    drawn.set_ylabel(style.label("torque", name="full-load torque"), color=style.COLOURS[0])
    other = drawn.twinx()
    other.plot(rpm, style.shown(np.asarray(curve * curve.speed), "power"), color=style.COLOURS[1], linestyle="--")
    other.set_ylabel(style.label("power"), color=style.COLOURS[1])
    other.set_ylim(bottom=0)
    other.grid(visible=False)
    return figure


@style.styled
def plot_engine_orders(harmonics: xr.DataArray, *, axes: Axes | None = None) -> Figure:
    """Torque of all cylinders together by order, 0-peak, a bar for each speed; ``harmonics`` complex (speed, order)."""
    figure, drawn = style.on(axes, (6.4, 3.6))
    count = harmonics.speed.size
    gap = float(np.diff(harmonics.order.values).min(initial=1.0))
    width = 0.8 * gap / count
    for number, speed in enumerate(harmonics.speed.values):
        size = np.abs(style.shown(harmonics.sel(speed=speed)))
        place = harmonics.order.values + (number - 0.5 * (count - 1)) * width
        rpm = float(style.shown(np.asarray(speed), "speed"))
        drawn.bar(place, size, width, color=style.COLOURS[number % 8], label=f"{rpm:.0f} rpm")
    drawn.set_xticks(harmonics.order.values[harmonics.order.values % 1 == 0])
    drawn.set_xlabel(style.label("engine_order", name="engine order (cycles per revolution)"))
    drawn.set_ylabel(style.label("torque", "0-peak", "torque of all cylinders"))
    drawn.legend()
    return figure
