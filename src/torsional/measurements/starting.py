"""A mapping file to begin with, written from the channels of a measurement."""

from __future__ import annotations

import json

import xarray as xr

from torsional.measurements.mapping_file import ELEMENTS, KEY, NODES, VERSION
from torsional.measurements.recording import PULSES
from torsional.units import QUANTITIES, unit_factor

_HEAD = f"""\
# Which channel is which quantity of which node or element. Keys of a channel: quantity (angle, angular_velocity,
# acceleration of a node; twist, torque of an element; pulses of a node), node or element, and where needed unit,
# factor, offset, sign, delay, pulses_per_turn, missing. Remove the lines of channels that are not asked for.
{KEY}: {VERSION}
raster: finest   # or coarsest, or a channel's name; or rate: 1000 Hz
method: linear   # or previous, mean
channels:
"""
_GUESSED = ("angular_velocity", "torque", "acceleration", "angle")
"""What a channel is taken for by its unit, the likeliest first."""


def starter(data: xr.Dataset) -> str:
    """The text of a mapping that names every channel over time, a place to be filled in for each.

    >>> from torsional.measurements.recording import Channel, Found, Raster, recording
    >>> import numpy as np
    >>> one = Channel("n_mot", np.array([1.0, 2.0]), Raster(np.array([0.0, 0.5])), "rpm")
    >>> print(starter(recording(Found([one], "example"), "")).splitlines()[-1])
      n_mot: {quantity: angular_velocity, node: NAME}   # rpm
    """
    lines = [_line(number, str(name), values) for number, (name, values) in enumerate(data.data_vars.items(), 1)]
    return _HEAD + "\n".join(lines) + "\n"


def _line(number: int, name: str, values: xr.DataArray) -> str:
    plain = len(name) <= 64 and name.isidentifier()
    key, named = (name, "") if plain else (f"channel_{number}", f"channel: {json.dumps(name, ensure_ascii=False)}, ")
    unit = str(values.attrs.get("units", ""))
    if values.attrs.get("kind") == PULSES:
        return f"  {key}: {{{named}quantity: pulses, node: NAME, pulses_per_turn: 60}}"
    quantity = _guess(unit)
    place = "element" if quantity in ELEMENTS else "node"
    told = f"  {key}: {{{named}quantity: {quantity or 'angular_velocity'}, {place}: NAME}}"
    return f"{told}   # {unit}" if quantity else f"  # {told.strip()}   # {unit or 'no unit'}"


def _guess(unit: str) -> str:
    known = {**NODES, **ELEMENTS}
    kinds = {quantity: QUANTITIES[known[quantity]].kind for quantity in _GUESSED}
    return next((q for q, kind in kinds.items() if unit and unit_factor(unit, kind) is not None), "")
