"""Loops cut out of a rig's raw channels, as a mapping has brought them to nodes and elements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.studies.records import Record
from torsional.studies.rig_model import INSTRUMENTS, held_inertia
from torsional.studies.rig_run import loop_of_run
from torsional.units import RPM, quoted, show

STEADY = 0.1
"""What size and middle of a swing may change by from its first to its last third, over its size."""
LEAST = 3
"""Cycles from which on that is asked."""
TURNING = 10.0 * RPM
"""Pace from which on an angle counts as that of a shaft that turns."""


class Cut(NamedTuple):
    """An operating point of a run: its ``name``, from ``begin`` to ``end`` [s]."""

    name: str
    begin: float
    end: float


class Places(NamedTuple):
    """Where it was measured: the nodes of the ``drive``'s and the ``held`` encoder and the ``sensor`` of the torque, a
    connection, with the ``inertia`` [kgm²] between it and the springs."""

    drive: str
    held: str
    sensor: str
    inertia: float = 0.0


def places_of(data: xr.Dataset, model: Model, ends: tuple[str, str], sensor: str, inertia: float | None) -> Places:
    """The places of mapped channels: the encoders of a rig's fixtures, or of the flywheel's ``ends``.

    ``inertia``: None for what a rig as a model has between the sensor and the springs.
    Raises ModelError where a channel is missing.
    """
    nodes, torques = _named(data, "angle", "node"), _named(data, "torque", "element")
    if not torques or (sensor and sensor not in torques):
        remedy = nearest(sensor, torques) if torques else "map the torque sensor's channel to a connection"
        raise ModelError("the mapping brings no torque of the sensor", found=quoted(sensor or "none"), remedy=remedy)
    if not sensor and len(torques) > 1:
        raise ModelError("several torques are mapped", found=", ".join(torques), remedy="name one by sensor")
    chosen = sensor or torques[0]
    for drive, held in ((INSTRUMENTS.drive, INSTRUMENTS.held), ends):
        if drive in nodes and held in nodes:
            rig = chosen == INSTRUMENTS.sensor and held == INSTRUMENTS.held
            own = held_inertia(model) if rig else 0.0
            return Places(drive, held, chosen, own if inertia is None else inertia)
    found, allowed = ", ".join(nodes) or "none", " and ".join(ends)
    raise ModelError("the mapping brings no angles of both sides", found=found, allowed=f"{allowed}, or of fixtures")


def _named(data: xr.Dataset, quantity: str, dim: str) -> list[str]:
    """Places that have a channel of a quantity."""
    if quantity not in data:
        return []
    there = np.isfinite(data[quantity].transpose(..., dim).values).any(axis=0)
    return [str(name) for name, has in zip(data[dim].values, there, strict=True) if has]


def loops_of_run(
    data: xr.Dataset, places: Places, cuts: Sequence[Cut] = (), speed: float | None = None
) -> tuple[Record, ...]:
    """The loops of operating points, each cut to whole periods of its swing; without ``cuts`` the whole run is one.

    The mean speed [rad/s] is that of a mapped ``angular_velocity`` or of an angle that turns; else it must be given.
    Raises ModelError, by the point's name, for times outside the run and a swing that is not steady.
    """
    time = data.time.values
    whole = Cut("loop 1", float(time[0]), float(time[-1]))
    found = []
    for cut in cuts or (whole,):
        if not time[0] - 1e-9 <= cut.begin < cut.end <= time[-1] + 1e-9:
            seen, allowed = f"{cut.begin:g} to {cut.end:g} s", f"within {time[0]:g} to {time[-1]:g} s"
            raise ModelError("the operating point is not in the run", where=cut.name, found=seen, allowed=allowed)
        found.append(_loop(data.sel(time=slice(cut.begin, cut.end)), places, cut.name, speed))
    return tuple(found)


def _loop(part: xr.Dataset, places: Places, name: str, speed: float | None) -> Record:
    time = part.time.values
    drive, held = (part.angle.sel(node=node).values for node in (places.drive, places.held))
    if time.size < 2:
        raise ModelError("too few samples for a loop", where=name, found=f"{time.size}")
    pace = float(np.polyfit(time, held, 1)[0])
    turned = pace * time if abs(pace) > TURNING else 0.0
    channels = {"drive_angle": drive - turned, "held_angle": held - turned}
    channels["sensor_torque"] = part.torque.sel(element=places.sensor).values
    run = xr.Dataset({key: ("time", values) for key, values in channels.items()}, {"time": time})
    run.attrs["speed"] = _speed(part, pace, name) if speed is None else speed
    loop = loop_of_run(run, name, places.inertia)
    step = float(np.median(np.diff(time)))
    cycles = int((time[-1] - time[0] + 1.01 * step) / loop.swing.period)
    _refuse_unsteady(loop, cycles)
    kept = time > time[-1] - max(cycles, 1) * loop.swing.period + 0.01 * step
    return Record(name, loop.speed, *(values[kept] for values in (loop.time, loop.angle, loop.torque)))


def _speed(part: xr.Dataset, pace: float, name: str) -> float:
    """The mean rotational speed that the channels tell."""
    if "angular_velocity" in part:
        known = part.angular_velocity.values[np.isfinite(part.angular_velocity.values)]
        if known.size:
            return float(known.mean())
    if abs(pace) > TURNING:
        return abs(pace)
    remedy = "give speed, or map a channel of angular_velocity"
    raise ModelError("the channels tell no rotational speed", where=name, remedy=remedy)


def _refuse_unsteady(loop: Record, cycles: int) -> None:
    """Refuse a swing of another size or middle in its last third than in its first, whole cycles of both."""
    if cycles < LEAST:
        return
    length = cycles // LEAST * loop.swing.period
    first, last = loop.angle[loop.time < loop.time[0] + length], loop.angle[loop.time > loop.time[-1] - length]
    size = float(np.std(loop.angle)) * np.sqrt(2.0)
    change = max(abs(float(np.std(first) - np.std(last))) * np.sqrt(2.0), abs(float(np.mean(first) - np.mean(last))))
    if change > STEADY * size:
        found = f"a change by {show(change, 'relative_angle')} at ±{show(size, 'relative_angle')}"
        remedy = "cut where it has settled, by begin and end"
        raise ModelError("the swing is not steady", where=loop.name, found=found, remedy=remedy)
