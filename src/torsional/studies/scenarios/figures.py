"""What an engineer reads off a run in time: peaks, travel against the stop, contacts with it, energies."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from torsional.laws import Law
from torsional.numerics.arrays import Array
from torsional.units import QUANTITIES

LOSSES = ("dampers", "contacts", "friction")
"""Shares of the ledger that are lost."""


def read_off(run: xr.Dataset, laws: Mapping[str, Law | None]) -> xr.Dataset:
    """The run with, for every element, its lowest and highest torque [Nm] and twist [rad], when the torque was largest
    [s], the angles of its stops [rad] (not a number without), and how often it met them.

    ``laws``: of the elements by name; one that is missing has no stop.
    """
    stops = np.array([_stop_angles(laws.get(str(name))) for name in run.element.values]).reshape(-1, 2)
    twist, torque = (run[name].transpose("time", "element") for name in ("twist", "torque"))
    at = np.abs(torque.values).argmax(axis=0)
    found = {
        "torque_lowest": (torque.values.min(axis=0), "torque"),
        "torque_highest": (torque.values.max(axis=0), "torque"),
        "peak_time": (run.time.values[at], "time"),
        "twist_lowest": (twist.values.min(axis=0), "relative_angle"),
        "twist_highest": (twist.values.max(axis=0), "relative_angle"),
        "stop_below": (stops[:, 0], "relative_angle"),
        "stop_above": (stops[:, 1], "relative_angle"),
        "stop_contacts": (contacts(twist.values, stops), ""),
    }
    return run.assign({name: ("element", values, _attrs(quantity)) for name, (values, quantity) in found.items()})


def _stop_angles(law: Law | None) -> tuple[float, float]:
    """The angles [rad] of the stops for negative and positive torque; not a number where there is none.

    >>> from torsional.laws import Hinges
    >>> _stop_angles(Hinges.staged([(1000.0, 1e4)], stop_stiffness=1e6))
    (-0.1, 0.1)
    """
    listed: Sequence[float] = getattr(law, "stops", ())
    below, above = [s for s in listed if s < 0], [s for s in listed if s > 0]
    return (max(below) if below else float("nan")), (min(above) if above else float("nan"))


def contacts(twist: Array, stops: Array) -> Array:
    """How often each twist (time, elements) comes to lie beyond one of its stops (elements, 2); beginning there counts.

    >>> contacts(np.array([[0.0], [0.2], [0.0], [-0.3], [-0.2]]), np.array([[-0.1, 0.1]])).tolist()
    [2]
    """
    with np.errstate(invalid="ignore"):
        beyond = [twist < stops[:, 0], twist > stops[:, 1]]
    return np.asarray(sum(there[0].astype(int) + (there[1:] & ~there[:-1]).sum(axis=0) for there in beyond))


def lost(run: xr.Dataset) -> dict[str, float]:
    """Energy [J] dissipated up to the end, by where it went."""
    return {name: float(run.energy.sel(share=name)[-1]) for name in LOSSES if name in run.share.values}


def scheduled(run: xr.Dataset, shown: Mapping[str, tuple[tuple[Sequence[float], Sequence[float]], str]]) -> xr.Dataset:
    """The run with ``schedule`` (event, time): what was done, by name and quantity, interpolated from its knots."""
    if not shown:
        return run
    values = [_interpolated(run.time.values, *knots) for knots, _ in shown.values()]
    told = {name: quantity for name, (_, quantity) in shown.items()}
    data = run.assign_coords(event=list(shown)).assign(schedule=(("event", "time"), np.array(values)))
    return data.assign_attrs(schedule_quantities=json.dumps(told))


def phased(run: xr.Dataset, phases: Sequence[tuple[str, float, float]], crank: str) -> xr.Dataset:
    """The run with what happened one after the other: ``phase_begin`` and ``phase_end`` [s] of each ``phase``, and
    ``phase_speed`` (phase, node) [rad/s], the mean over the last cycle of the engine in it; as far as it was reached.
    """
    last = float(run.time[-1])
    listed = [(name, begin, min(end, last)) for name, begin, end in phases if begin < last]
    if not listed:
        return run
    names, begins, ends = zip(*listed, strict=True)
    speeds = [_late(run.angular_velocity, begin, end, crank) for _, begin, end in listed]
    return run.assign_coords(phase=list(names)).assign(
        phase_begin=("phase", list(begins), _attrs("time")),
        phase_end=("phase", list(ends), _attrs("time")),
        phase_speed=(("phase", "node"), np.array(speeds), _attrs("angular_velocity")),
    )


def _late(speeds: xr.DataArray, begin: float, end: float, crank: str) -> Array:
    """Means over the last cycle of the engine before an end, or from the beginning where that is later."""
    turning = abs(float(speeds.sel(node=crank).sel(time=end, method="nearest")))
    cycle = 4 * np.pi / turning if turning > 0 else end - begin
    return np.asarray(speeds.sel(time=slice(max(begin, end - cycle), end)).mean("time").values)


def _interpolated(time: Array, knots: Sequence[float], values: Sequence[float]) -> Array:
    """Straight lines; of two knots at one time the later one counts from there on."""
    at, value = np.asarray(knots, dtype=float), np.asarray(values, dtype=float)
    place = np.clip(np.searchsorted(at, time, "right") - 1, 0, len(at) - 1)
    after = np.minimum(place + 1, len(at) - 1)
    span = at[after] - at[place]
    share = np.divide(time - at[place], span, out=np.zeros(len(time)), where=span > 0)
    return np.asarray(value[place] + np.clip(share, 0.0, 1.0) * (value[after] - value[place]))


def _attrs(quantity: str) -> dict[str, str]:
    if not quantity:
        return {}
    entry = QUANTITIES[quantity]
    return {"units": entry.unit, "long_name": entry.long_name, "quantity": quantity}
