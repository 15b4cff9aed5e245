"""What a measurement is here: channels with their units over rasters, gathered in one Dataset.

Every format is read into `Channel` values; `recording` checks them and names dimensions and channels in one way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import SCHEMA
from torsional.units import quoted

ANALYSIS = "measurement"
VALUES = 200_000_000
"""Numbers of one measurement, channels and rasters together: 1.6 GB."""
EVEN = 1e-3
"""By what share of a step samples may stand off an even raster that loggers have rounded."""
LONGEST_NAME = 200
PULSES = "pulses"
"""``kind`` of a channel that is the times of events, which have no values."""


@dataclass(frozen=True, eq=False)
class Raster:
    """Where samples stand: times [s], or what a spectrum runs over, ``values`` in ``units``."""

    values: Array
    name: str = "time"
    units: str = "s"


@dataclass(frozen=True, eq=False)
class Channel:
    """One signal as a file has it: its name, its values in its own units, and what else the file tells of it."""

    name: str
    values: Array | ComplexArray
    raster: Raster
    units: str = ""
    group: str = ""
    comment: str = ""
    long_name: str = ""
    attrs: dict[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Found:
    """What a file holds: its channels, its format with the version, when it began, and the channels left out."""

    channels: Sequence[Channel]
    format: str
    start: str = ""
    left_out: Sequence[str] = ()


def pulses(name: str, times: Array, group: str = "", comment: str = "") -> Channel:
    """Events without values: a channel whose values are their times [s]."""
    return Channel(name, times, Raster(times), "s", group, comment, attrs={"kind": PULSES})


def recording(found: Found, source: str) -> xr.Dataset:
    """The Dataset of a measurement; every channel is a variable over the dimension of its raster.

    Rasters that agree are one dimension: ``time`` [s], the next ``time_2`` and so on.  Channels keep the file's values
    and units; of those with one name all but the first get the name of their group behind it.  Raises ModelError for a
    file without channels, rasters that do not increase and channels as long as no raster.

    >>> two = [Channel("n", np.array([1.0, 2.0]), Raster(np.array([0.0, 0.5])), "rpm")]
    >>> data = recording(Found(two, "example"), "a.csv")
    >>> data.n.attrs["units"], data.time.attrs["sampling"], data.time.attrs["sampling_rate"]
    ('rpm', 'even', 2.0)
    """
    _refuse_empty(found)
    rasters = _Rasters()
    placed = [(channel, rasters.dimension(channel)) for channel in found.channels]
    names = _names(found.channels, rasters.coordinates)
    variables = {
        name: ((dim,), channel.values, _described(channel, name))
        for name, (channel, dim) in zip(names, placed, strict=True)
    }
    return xr.Dataset(variables, rasters.coordinates, _told(found, source))


def bounded(count: int) -> None:
    """Refuse more numbers than a measurement may hold, before anything of that size is made."""
    if count > VALUES:
        told = {"found": f"{count:,} numbers".replace(",", " "), "allowed": f"{VALUES:,}".replace(",", " ")}
        raise ModelError("the recording is too large", remedy="cut it, or leave channels out", **told)


def _refuse_empty(found: Found) -> None:
    if not found.channels:
        left = f"{len(found.left_out)} that hold none" if found.left_out else ""
        raise ModelError("the file has no channel of numbers", found=left)
    bounded(sum(channel.values.size for channel in found.channels))
    if all(bool(np.isnan(channel.values).all()) for channel in found.channels):
        raise ModelError("no channel of the file has a value", found=f"{len(found.channels)} channels of NaN alone")


class _Rasters:
    """Rasters that agree, each with the name of its dimension."""

    def __init__(self) -> None:
        self.coordinates: dict[str, tuple[str, Array, dict[str, str | float]]] = {}
        self._known: dict[tuple[str, int, bytes], str] = {}

    def dimension(self, channel: Channel) -> str:
        """The dimension of a channel's raster, which is checked where it is new."""
        raster = channel.raster
        if raster.values.shape != channel.values.shape:
            found = f"{channel.values.size} values at {raster.values.size} places"
            raise ModelError("the channel and its raster differ in length", where=quoted(channel.name), found=found)
        key = (raster.name, raster.values.size, raster.values.tobytes())
        if key not in self._known:
            self._known[key] = self._added(channel)
        return self._known[key]

    def _added(self, channel: Channel) -> str:
        raster = channel.raster
        _refuse_unordered(raster, channel.name)
        count = sum(known[0] == raster.name for known in self._known)
        dim = raster.name if not count else f"{raster.name}_{count + 1}"
        self.coordinates[dim] = (dim, raster.values, {"units": raster.units, **sampling(raster.values)})
        return dim


def _refuse_unordered(raster: Raster, channel: str) -> None:
    values, where = raster.values, f"{raster.name} of {quoted(channel)}"
    if not values.size:
        raise ModelError("the channel has no samples", where=quoted(channel))
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        found = f"{values[wrong[0]]} at sample {wrong[0] + 1}"
        raise ModelError("a finite number is wanted", where=where, found=found)
    back = np.flatnonzero(np.diff(values) <= 0)
    if back.size:
        i = int(back[0])
        found = f"{float(values[i + 1])} after {float(values[i])} at sample {i + 2}"
        remedy = "sort the samples, and keep one of those that stand at one time"
        raise ModelError("must increase from sample to sample", where=where, found=found, remedy=remedy)


def sampling(values: Array) -> dict[str, str | float]:
    """Whether samples are even, and the rate [1/unit of the raster] of those that are.

    >>> sampling(np.array([0.0, 0.1, 0.2])), sampling(np.array([0.0, 0.1, 0.3]))
    ({'sampling': 'even', 'sampling_rate': 10.0}, {'sampling': 'uneven'})
    """
    if values.size < 2:
        return {"sampling": "uneven"}
    step = float(values[-1] - values[0]) / (values.size - 1)
    off = values - values[0] - step * np.arange(values.size)
    if not np.abs(off).max() <= EVEN * step:
        return {"sampling": "uneven"}
    return {"sampling": "even", "sampling_rate": _round_rate(1.0 / step)}


def _round_rate(rate: float) -> float:
    """A rate that is a whole number but for rounding as that number."""
    return float(round(rate)) if abs(rate - round(rate)) <= 1e-9 * rate else rate


def _names(channels: Sequence[Channel], taken: Iterable[str]) -> list[str]:
    """One name for each channel, no two alike and none that of a raster."""
    used: set[str] = set(taken)
    names = []
    for channel in channels:
        name = next(each for each in _candidates(channel) if each not in used)
        used.add(name)
        names.append(name)
    return names


def _candidates(channel: Channel) -> Iterator[str]:
    name = printable(channel.name) or "unnamed"
    yield name
    group = printable(channel.group)
    if group:
        yield f"{name} ({group})"
        name = f"{name} ({group})"
    number = 2
    while True:
        yield f"{name} ({number})"
        number += 1


def printable(text: str) -> str:
    """A text of a file as names and comments keep it: control characters and half letters escaped, long ones cut.

    >>> printable(" n_mot\\x1b[2J ")
    'n_mot\\\\x1b[2J'
    """
    shown = "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in text.strip()[:1000])
    return shown if len(shown) <= LONGEST_NAME else shown[: LONGEST_NAME - 1] + "…"


def _described(channel: Channel, name: str) -> dict[str, str | float]:
    long_name = printable(channel.long_name) or name
    told: dict[str, str | float] = {"units": printable(channel.units), "long_name": long_name}
    further = {"group": printable(channel.group), "comment": printable(channel.comment)}
    return {**told, **{key: text for key, text in further.items() if text}, **channel.attrs}


def _told(found: Found, source: str) -> dict[str, str | int]:
    from torsional import __version__

    told: dict[str, str | int] = {"analysis": ANALYSIS, "torsional_version": __version__, "schema": SCHEMA}
    told |= {"format": found.format, "source": printable(source)}
    told |= {"start": found.start} if found.start else {}
    return told | ({"left_out": ", ".join(map(printable, found.left_out))} if found.left_out else {})
