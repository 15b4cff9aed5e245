"""What a rig tells over what its flywheel does, over frequency."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from torsional.plots import style

WORDS = {"sensed": "torque as sensed", "corrected": "torque, inertia corrected", "twist_told": "twist"}


@style.styled
def plot_sensor_reach(data: xr.Dataset) -> Figure:
    """Size and angle of what sensors tell over what is, with the band within which it counts as right.

    ``data``: of `torsional.studies.rig_model.sensor_reach`; dots mark how far each reaches.
    """
    size, angle = style.panels(1, 2, (4.6, 3.2))
    within = float(data.attrs["within"])
    size.axhspan(1.0 - within, 1.0 + within, color="#dddddd", zorder=0, label=f"within {100 * within:g} %")
    for number, (name, words) in enumerate(WORDS.items()):
        ratio, colour = data[name], style.COLOURS[number]
        look: dict[str, Any] = {"color": colour, "linestyle": style.DASHES[number], "linewidth": 1.4}
        size.plot(data.frequency, np.abs(ratio), label=words, gid=name, **look)
        angle.plot(data.frequency, np.degrees(np.angle(ratio)), **look)
        reach = float(data.reach.sel(told=name))
        if np.isfinite(reach):
            at = np.abs(ratio.sel(frequency=reach, method="nearest"))
            size.plot(reach, float(at), "o", color=colour, markersize=4.0)
    size.set(yscale="log", ylabel="told over true, size [-]")
    angle.set(ylabel="told over true, angle [°]", yticks=range(-180, 181, 90))
    ends = float(data.frequency.values[0]), float(data.frequency.values[-1])
    for axes in (size, angle):
        axes.set(xscale="log", xlabel=style.label("frequency"), xlim=ends)
    handles, labels = size.get_legend_handles_labels()
    figure = style.figure_of(size)
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure
