"""The region of sub-harmonic vibration of a model, found over its whole range and then looked at closely."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import dataset
from torsional.solvers.periodic import subharmonic_map
from torsional.units import RPM

MARGIN = 0.15
"""Room around a region that is looked at closely, in shares of its size."""

Progress = Callable[[int, int], None]


@checked
def sought_region(
    model: Model,
    speeds: Array,
    torques: Array,
    gear: str | None = None,
    *,
    closely: bool = True,
    element: str = "",
    node: str = "",
    progress: Progress = lambda done, total: None,
) -> xr.Dataset:
    """`subharmonic_map` over ``speeds`` [rad/s] and mean ``torques`` [Nm], and ``closely`` again over what it found.

    The second map has about as many speeds and torques, at round values.  ``within_full_load`` (mean_torque, speed) is
    added: which cells the engine can reach, all of them without a full-load curve.  Raises ModelError as the map does.
    """

    def mapped(speeds: Array, torques: Array) -> xr.Dataset:
        found = subharmonic_map(model, speeds, torques, gear, element=element, node=node, progress=progress)
        return found.assign(within_full_load=(("mean_torque", "speed"), model.within_full_load(speeds, torques)))

    first = mapped(speeds, torques)
    closer = closer_grid(first) if closely else None
    return first if closer is None else mapped(*closer)


def closer_grid(found: xr.Dataset) -> tuple[Array, Array] | None:
    """Round speeds and mean torques over what a map has found and a margin around it; None where that is nothing."""
    axes = []
    for dim, other, unit in (("speed", "mean_torque", RPM), ("mean_torque", "speed", 1.0)):
        values = found[dim].values
        here = np.append(values[(found.amplitude > 0).any(other).values], found[f"boundary_{dim}"].values)
        if not here.size:
            return None
        margin = MARGIN * float(np.ptp(here)) or float(values[1] - values[0])
        low, high = max(here.min() - margin, values[0]), min(here.max() + margin, values[-1])
        axes.append(unit * round_steps(low / unit, high / unit, len(values)))
    return axes[0], axes[1]


def round_steps(low: float, high: float, count: int) -> Array:
    """About ``count`` values within two, in steps of 1, 2, 2.5 or 5 times a power of ten; the ends if those are few.

    >>> round_steps(847.0, 1412.0, 30).tolist()[:3]
    [860.0, 880.0, 900.0]
    """
    wanted = (high - low) / max(count - 1, 1)
    power = 10.0 ** np.floor(np.log10(wanted))
    step = min((f * power for f in (1, 2, 2.5, 5, 10)), key=lambda width: abs(np.log(width / wanted)))
    values = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
    return values if len(values) > 1 else np.array([low, high])


def full_load_curve(model: Model, low: float, high: float) -> xr.DataArray | None:
    """The full-load torque (speed) [Nm] between two speeds [rad/s], its corners included; None without one there."""
    curve = model.full_load_curve
    if curve is None:
        return None
    low, high = max(low, curve.speeds[0]), min(high, curve.speeds[-1])
    if low >= high:
        return None
    corners = [speed for speed in curve.speeds if low < speed < high]
    speeds = np.unique([*np.linspace(low, high, 200), *corners])
    told = {"mean_torque": (("speed",), curve(speeds), "torque")}
    found: xr.DataArray = dataset(told, {"speed": (speeds, "speed")}, analysis="full load").mean_torque
    return found


@checked
def within(found: xr.Dataset) -> xr.Dataset:
    """The same map with nothing in the cells above full load."""
    over = [name for name, values in found.data_vars.items() if {"mean_torque", "speed"} <= set(values.dims)]
    return found.assign({name: found[name].where(found.within_full_load, 0) for name in over})
