"""What a recorded channel tells of a shaft, whichever kind of tacho it is of."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.measurements.encoders import shaft_from_counter, shaft_from_encoder, shaft_from_speed
from torsional.measurements.pulses import pulse_times
from torsional.measurements.recording import PULSES
from torsional.measurements.shafts import shaft_from_pulses
from torsional.measurements.signals import named
from torsional.numerics.arrays import Array
from torsional.units import unit_factor

Kind = Literal["auto", "voltage", "pulses", "counter", "angle", "speed"]
KINDS: tuple[Kind, ...] = ("auto", "voltage", "pulses", "counter", "angle", "speed")
PER_TURN: tuple[Kind, ...] = ("voltage", "pulses", "counter")
"""Kinds that tell nothing without the number of pulses a turn."""


@checked
def shaft_from_channel(
    channel: xr.DataArray, *, kind: Kind = "auto", teeth: int = 0, missing: int = 0, index_angle: float = 0.0
) -> xr.Dataset:
    """Angle and speed of a shaft from a recorded ``channel``: a voltage, pulses, a counter, an angle or a speed.

    Which of them it is follows from its unit and its values unless ``kind`` names it (`kind_of`).  ``teeth`` a turn,
    or counts, of which ``missing`` are the gap; the first tooth behind it stands at ``index_angle`` [rad].  Raises
    ModelError as the functions for each kind do, and for pulses whose number a turn is not told.

    >>> t = np.arange(0.0, 1.0, 1e-3)
    >>> channel = xr.DataArray(600.0 + 0 * t, {"time": t}, name="n_mot", attrs={"units": "rpm"})
    >>> shaft_from_channel(channel).attrs["source"]
    'speed'
    """
    found = kind_of(channel) if kind == "auto" else kind
    if found == "angle":
        return shaft_from_encoder(channel)
    if found == "speed":
        return shaft_from_speed(channel)
    if not teeth:
        problem = f"a channel of {found} needs the number of pulses a turn"
        raise ModelError(
            problem, where=named(channel), remedy="name the wheel's teeth, as 60, or 60-2 with a gap of two"
        )
    if found == "counter":
        return shaft_from_counter(channel, teeth)
    times, resolution = event_times(channel, found)
    told = {"missing": missing, "index_angle": index_angle, "resolution": resolution, "name": named(channel)}
    return shaft_from_pulses(times, teeth, **told)  # type: ignore[arg-type]


@checked
def kind_of(channel: xr.DataArray) -> Kind:
    """Which kind of tacho a ``channel`` is of, by what the file says, its unit and its values.

    Events without values are pulses; units of angle and of speed tell the rest.  What has other units is a counter
    where its values are more than two whole numbers, else a voltage.

    >>> kind_of(xr.DataArray([0.0, 5.0, 0.0, 5.0], attrs={"units": "V"}))
    'voltage'
    """
    unit = str(channel.attrs.get("units", ""))
    if channel.attrs.get("kind") == PULSES:
        return "pulses"
    if unit and unit_factor(unit, "angle") is not None:
        return "angle"
    if unit and unit_factor(unit, "angular velocity") is not None:
        return "speed"
    values = np.asarray(channel.values, dtype=float)
    whole = bool(np.isfinite(values).all() and (values == np.round(values)).all())
    return "counter" if whole and np.unique(values).size > 2 else "voltage"


def event_times(channel: xr.DataArray, kind: Kind) -> tuple[Array, float | None]:
    """Times [s] of the events of a channel, and their resolution where that is known."""
    if kind == "pulses":
        return np.asarray(channel[channel.dims[0]].values, dtype=float), None
    found = pulse_times(channel)
    return np.asarray(found.values), float(found.attrs["resolution"])
