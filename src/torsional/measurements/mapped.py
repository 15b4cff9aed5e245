"""Channels of a measurement as quantities of nodes and elements, in SI, in the schema of motions in time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.measurements.mapping_file import (
    ELEMENTS,
    NODES,
    PULSED,
    ChannelBlock,
    MappingFile,
    kind_of,
    quantity_of,
)
from torsional.measurements.rasters import brought, common
from torsional.measurements.recording import ANALYSIS, EVEN, sampling
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import Variable, dataset, of_model
from torsional.system import assemble
from torsional.units import QUANTITIES, quoted, unit_factor

NAMED = ("finest", "coarsest")


@dataclass(frozen=True, eq=False)
class _Signal:
    """A channel in SI over its own times."""

    key: str
    block: ChannelBlock
    time: Array
    values: Array

    @property
    def rate(self) -> float:
        """Samples a second, of uneven ones on the mean."""
        return float((self.time.size - 1) / (self.time[-1] - self.time[0]))


@checked
def mapped(
    data: xr.Dataset, mapping: MappingFile, model: Model | None = None, gear: str | int | None = None
) -> xr.Dataset:
    """The channels that a mapping names, in SI, over one even ``time`` and ``node`` or ``element``, as of runs in time:
    ``angle``, ``angular_velocity``, ``acceleration``, ``twist``, ``torque``; NaN where a place has no channel of one.

    Values are sign · (factor · value + offset) in their unit, then in SI.  Pulses stay over a raster of their own, by
    the name of their channel, with ``node``, ``pulses_per_turn`` and ``missing``.  With a ``model`` its nodes and
    elements in that ``gear`` are the ones that may be named.  Raises ModelError for channels that are not there, units
    that do not fit, missing values, and names that the model does not have.

    >>> from torsional.measurements.recording import Channel, Found, Raster, recording
    >>> channel = Channel("n", np.array([1500.0, 1530.0]), Raster(np.array([0.0, 0.5])), "rpm")
    >>> block = {"quantity": "angular_velocity", "node": "crankshaft"}
    >>> mapping = MappingFile.model_validate({"torsional_mapping": 1, "channels": {"n": block}})
    >>> mapped(recording(Found([channel], "example"), ""), mapping).angular_velocity.values.round(3).tolist()
    [[157.08], [160.221]]
    """
    for key, block in mapping.channels.items():
        _refuse_missing(data, key, block)
    if model is not None:
        _refuse_strange(mapping, model, gear)
    signals = [_signal(data, key, block) for key, block in mapping.channels.items() if block.quantity != PULSED]
    found = _together(signals, mapping) if signals else xr.Dataset(attrs={"analysis": ANALYSIS})
    for key, block in mapping.channels.items():
        if block.quantity == PULSED:
            found = _with_pulses(found, data, key, block)
    told = {key: data.attrs[key] for key in ("source", "start", "format") if key in data.attrs}
    found = found.assign_attrs(told | {"mapping": mapping.name})
    return found if model is None else of_model(found, model, model.gear_name(gear))


def _name(key: str, block: ChannelBlock) -> str:
    return block.channel or key


def _where(key: str) -> str:
    return f"channels.{key}"


def _refuse_missing(data: xr.Dataset, key: str, block: ChannelBlock) -> None:
    name = _name(key, block)
    if name not in data.data_vars:
        left = [each.strip() for each in str(data.attrs.get("left_out", "")).split(",")]
        problem = "the channel holds no numbers" if name in left else "the measurement has no such channel"
        raise ModelError(problem, where=_where(key), found=quoted(name), remedy=nearest(name, map(str, data.data_vars)))
    if np.isnan(data[name].values).all():
        raise ModelError("the channel has no value", where=_where(key), found=f"{data[name].size} samples of NaN")
    if np.iscomplexobj(data[name].values) or not str(data[name].dims[0]).startswith("time"):
        raise ModelError("a signal over time is wanted", where=_where(key), found=f"over {data[name].dims[0]}")


def _refuse_strange(mapping: MappingFile, model: Model, gear: str | int | None) -> None:
    """Refuse places that the model does not have."""
    system = assemble(model.powertrain(gear))
    for key, block in mapping.channels.items():
        place = "element" if block.quantity in ELEMENTS else "node"
        known = system.connections.names if place == "element" else system.nodes
        name = getattr(block, place)
        if name not in known:
            where, remedy = f"{_where(key)}.{place}", nearest(name, known)
            raise ModelError(f"the model has no such {place}", where=where, found=quoted(name), remedy=remedy)


def _signal(data: xr.Dataset, key: str, block: ChannelBlock) -> _Signal:
    channel = data[_name(key, block)]
    holes = np.flatnonzero(~np.isfinite(channel.values))
    time = np.asarray(channel[channel.dims[0]].values, dtype=float) - block.delay
    if holes.size:
        found = f"{holes.size} of {channel.size} samples, the first at {time[holes[0]]:g} s"
        remedy = "cut the measurement, or fill them first"
        raise ModelError("values are missing", where=_where(key), found=found, remedy=remedy)
    if time.size < 2:
        raise ModelError("two samples at least are wanted", where=_where(key), found=str(time.size))
    factor = _factor(str(channel.attrs.get("units", "")), key, block)
    values = block.sign * (block.factor * np.asarray(channel.values, dtype=float) + block.offset) * factor
    return _Signal(key, block, time, values)


def _factor(unit: str, key: str, block: ChannelBlock) -> float:
    """The factor to SI of the channel's unit, or of the one that the mapping says."""
    kind, given = kind_of(block), block.unit or unit
    factor = unit_factor(given, kind) if given else None
    if factor is None:
        quantity = QUANTITIES[quantity_of(block)]
        where = f"{_where(key)}.unit" if block.unit else _where(key)
        problem = f"the channel's unit is no unit of {quantity.long_name}" if given else "the channel has no unit"
        remedy = f"say which it is, as 'unit: {quantity.shown}'"
        raise ModelError(problem, where=where, found=quoted(given) if given else "", remedy=remedy)
    return factor


def _together(signals: Sequence[_Signal], mapping: MappingFile) -> xr.Dataset:
    """All signals on one even raster, by quantity and place."""
    rate = _rate(signals, mapping)
    time = common([signal.time for signal in signals], rate)
    nodes = _places(signal.block.node for signal in signals)
    elements = _places(signal.block.element for signal in signals)
    variables: dict[str, Variable] = {}
    for signal in signals:
        quantity, at_node = signal.block.quantity, signal.block.quantity in NODES
        places, dim = (nodes, "node") if at_node else (elements, "element")
        empty = np.full((time.size, len(places)), np.nan)
        values = variables.setdefault(quantity, (("time", dim), empty, quantity_of(signal.block)))[1]
        column = places.index(str(signal.block.node if at_node else signal.block.element))
        if not np.isnan(values[0, column]):
            raise ModelError("another channel is the same quantity of the same place", where=_where(signal.key))
        values[:, column] = brought(signal.time, signal.values, time, mapping.method)
    labels = {"node": nodes, "element": elements}
    coordinates = {dim: (np.array(names), "") for dim, names in labels.items() if names}
    told = {"raster": mapping.raster if mapping.rate is None else f"{mapping.rate:g} Hz", "method": mapping.method}
    found = dataset(variables, {"time": (time, "time"), **coordinates}, analysis=ANALYSIS, amplitude="signal", **told)
    found.time.attrs.update({"sampling": "even", "sampling_rate": rate})
    return found


def _places(names: Iterable[str | None]) -> list[str]:
    return list(dict.fromkeys(name for name in names if name is not None))


def _rate(signals: Sequence[_Signal], mapping: MappingFile) -> float:
    """Samples a second of the raster that the mapping names."""
    if mapping.rate is not None:
        return mapping.rate
    rates = {_name(signal.key, signal.block): signal.rate for signal in signals}
    if mapping.raster in NAMED:
        chosen = max(rates.values()) if mapping.raster == "finest" else min(rates.values())
    elif mapping.raster in rates:
        chosen = rates[mapping.raster]
    else:
        remedy = nearest(mapping.raster, [*NAMED, *rates])
        raise ModelError("there is no such raster", where="raster", found=quoted(mapping.raster), remedy=remedy)
    return float(round(chosen)) if abs(chosen - round(chosen)) <= EVEN * EVEN * chosen else chosen


def _with_pulses(found: xr.Dataset, data: xr.Dataset, key: str, block: ChannelBlock) -> xr.Dataset:
    """The measurement with a channel of pulses as it stands, over a raster of its own."""
    channel = data[_name(key, block)]
    time = np.asarray(channel[channel.dims[0]].values, dtype=float) - block.delay
    dim = f"time_of_{key}"
    told = {"node": block.node, "pulses_per_turn": block.pulses_per_turn, "missing": block.missing}
    values = channel.values - block.delay if channel.attrs.get("kind") == PULSED else channel.values * block.factor
    if key in found.variables:
        raise ModelError("the name is that of a quantity", where=_where(key), remedy="name the key otherwise")
    attrs = {**channel.attrs, **told}
    return found.assign_coords({dim: (dim, time, {"units": "s", **sampling(time)})}).assign({key: (dim, values, attrs)})
