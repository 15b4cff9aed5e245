"""MDF 4 through asammdf, after its blocks have been walked through."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.files.opening import read_bytes
from torsional.measurements.formats import library
from torsional.measurements.mdf_blocks import Walk
from torsional.measurements.recording import PULSES, Channel, Found, Raster, printable, pulses
from torsional.numerics.arrays import Array

BYTES = 4_000_000_000
_MASTERS = {1: ("time", "s"), 2: ("crank_angle", "rad"), 3: ("distance", "m"), 4: ("index", "")}
"""What the master of a group counts, by its kind of synchronisation."""
_TEXTS = 6
"""From this data type on channels hold texts, bytes or dates."""


def read(path: Path) -> Found:
    """The channels of numbers of an MDF file, conversions applied; those that turn numbers into texts are not."""
    data = read_bytes(path, BYTES)
    version = printable(data[8:16].rstrip(b"\0").decode("latin-1"))
    if not re.fullmatch(r"4\.\d\d", version):
        told = {"found": f"version {version}", "allowed": "4.00 to 4.20"}
        raise ModelError("this version of MDF is not read", remedy="convert it with the program that wrote it", **told)
    Walk(data).whole()
    with library("asammdf", "MDF").MDF(io.BytesIO(data), process_bus_logging=False) as file:
        channels: list[Channel] = []
        left_out: list[str] = []
        for number in range(len(file.groups)):
            channels += _group(file, number, left_out)
        return Found(channels, f"MDF {version}", _start(file), left_out)


def _start(file: Any) -> str:
    """When the recording began; zero, the epoch, stands for unknown."""
    return str(file.header.start_time.isoformat()) if file.header.abs_time else ""


def _group(file: Any, number: int, left_out: list[str]) -> Iterator[Channel]:
    """The channels of a group, all over its master; a master alone is a list of events."""
    group, master = file.groups[number], file.masters_db.get(number)
    if not group.channel_group.cycles_nr:
        return
    name = str(group.channel_group.acq_name or "")
    raster = _raster(file, number, master)
    wanted = []
    for index, channel in enumerate(group.channels):
        if index == master:
            continue
        if channel.data_type >= _TEXTS or channel.component_addr or channel.channel_type == 1:
            left_out.append(str(channel.name))
        else:
            wanted.append(index)
    if master is not None and len(group.channels) == 1:
        yield pulses(name or str(group.channels[master].name), raster.values)
    for index, signal in zip(wanted, _selected(file, number, wanted), strict=True):
        yield _channel(group.channels[index], signal, raster, name)


def _selected(file: Any, number: int, wanted: Sequence[int]) -> list[Any]:
    if not wanted:
        return []
    asked = [(None, number, index) for index in wanted]
    return list(file.select(asked, copy_master=False, ignore_value2text_conversions=True))


def _raster(file: Any, number: int, master: int | None) -> Raster:
    values: Array = np.asarray(file.get_master(number), dtype=float)
    if master is None:
        return Raster(np.arange(values.size, dtype=float), "index", "")
    channel = file.groups[number].channels[master]
    name, units = _MASTERS.get(channel.sync_type, ("time", "s"))
    return Raster(values, name, units)


def _channel(channel: Any, signal: Any, raster: Raster, group: str) -> Channel:
    values = np.asarray(signal.samples)
    if values.dtype.kind not in "biuf" or values.ndim != 1:
        raise ModelError("the channel cannot be read as numbers", where=repr(str(channel.name)))
    numbers: Array = values.astype(float)
    if signal.invalidation_bits is not None:
        numbers[np.asarray(signal.invalidation_bits, dtype=bool)] = np.nan
    comment = str(signal.comment or "")
    attrs: dict[str, str | float] = {"kind": PULSES} if comment == PULSES else {}
    told = {"units": str(signal.unit or ""), "group": group, "comment": "" if attrs else comment}
    return Channel(str(channel.name), numbers, raster, **told, attrs=attrs)
