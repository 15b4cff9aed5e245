"""`torsional orders`: orders of a measured run-up, of its shafts and of its signals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional import units
from torsional.cli import typed
from torsional.cli.answers import Answer, deliver
from torsional.cli.failures import complain
from torsional.cli.inputs import orders as read_orders
from torsional.cli.inputs import whole
from torsional.cli.outputs import checked
from torsional.cli.request import Wanted
from torsional.cli.run_up_tables import columns, mended, sentences, tables
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError, nearest
from torsional.measurements.orders import CONVENTIONS, track_orders
from torsional.measurements.reading import read_measurement
from torsional.measurements.resampling import highest_order
from torsional.measurements.rotation import mean_rotation
from torsional.measurements.tachos import KINDS, PER_TURN, event_times, kind_of, shaft_from_channel
from torsional.numerics.arrays import Array
from torsional.report.run_up import PICTURES, POWERS, RunUp, write_run_up

SUFFIXES = (".nc", ".csv", ".json", ".html", ".png", ".svg")
WINDOWS = ("hann", "none")


def run(
    file: Path,
    tacho: str,
    wheel: str,
    kind: str,
    ratio: str,
    index: str,
    marks: str,
    channel: Sequence[str] | None,
    shaft: Sequence[str] | None,
    orders: str,
    cycles: str,
    window: str,
    amplitude: str,
    shown_as: str,
    picture: str,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    outputs = checked(output, SUFFIXES, [file])
    order = asked_orders(orders)
    settings = {"cycles": whole(cycles, "--cycles", 1, 4), "window": one_of(window, WINDOWS, "--window")}
    convention = one_of(amplitude, tuple(CONVENTIONS), "--amplitude")
    drawn, told_as = one_of(picture, tuple(PICTURES), "--picture"), one_of(shown_as, tuple(POWERS), "--as")
    kinds, turns = one_of(kind, KINDS, "--kind"), typed.read(ratio or "1", "gear_ratio", "--ratio")
    record = Record(read_measurement(file), tacho)
    engine = record.shaft(record.tacho, wheel, kinds, typed.read(index or "0", "angle", "--index"))
    rotation = mean_rotation(engine, ratio=turns, marks=record.marks(marks))
    shafts = {record.tacho: engine, **{name: record.shaft(name, teeth) for name, teeth in map(wheel_of, shaft or ())}}
    signals = record.signals(channel or (), shafts)
    if not orders:
        order = told_apart(order, rotation, [*shafts.values(), *(signals[name] for name in signals.data_vars)])
    found = track_orders(signals, rotation, order, shafts=shafts, **settings)  # type: ignore[arg-type]
    run_up = RunUp(file.name, rotation, shafts, signals, found, convention, told_as, settings)  # type: ignore[arg-type]
    told: dict[str, Any] = {"file": str(file), "tacho": record.tacho, "shafts": mended(run_up), "settings": settings}
    answer = Answer(
        "orders",
        tables(run_up),
        told,
        found,
        picture=lambda: PICTURES[drawn](run_up),
        columns=columns(run_up),
        sentences=sentences(run_up),
        page=lambda draft: write_run_up(run_up, draft),
    )
    deliver(answer, Wanted(outputs, as_json, quiet))


@dataclass(frozen=True, eq=False)
class Record:
    """The channels of a file, and the name given for the one that tells how the engine turns."""

    data: xr.Dataset
    named: str

    @cached_property
    def tacho(self) -> str:
        """That channel; ModelError with the names there are."""
        return self.channel(self.named, "--tacho") if self.named else self._likely()

    def _likely(self) -> str:
        """The only channel that can be a tacho, by its kind."""
        told = [str(name) for name in self.data.data_vars if kind_of(self.data[name]) in ("pulses", "angle", "speed")]
        if len(told) == 1:
            return told[0]
        remedy = f"as --tacho {units.quoted(told[0] if told else next(iter(self.data.data_vars)))}"
        known = ", ".join(map(str, list(self.data.data_vars)[:12]))
        raise ModelError(
            "the channel that tells how the engine turns is wanted", where="--tacho", allowed=known, remedy=remedy
        )

    def channel(self, name: str, option: str) -> str:
        """The name of a channel that is there."""
        if name not in self.data.data_vars:
            remedy = nearest(name, map(str, self.data.data_vars))
            raise ModelError(f"there is no channel {units.quoted(name)}", where=option, remedy=remedy)
        return name

    def shaft(self, name: str, wheel: str, kind: str = "auto", index: float = 0.0) -> xr.Dataset:
        """The shaft that a channel tells of."""
        option = "--tacho" if name == self.tacho else "--shaft"
        channel = self.data[self.channel(name, option)]
        found: Any = kind_of(channel) if kind == "auto" else kind
        if found in PER_TURN and not wheel:
            written = "--wheel 60, or --wheel 60-2" if option == "--tacho" else f"--shaft {name}=60, or {name}=60-2"
            remedy = f"say it as {written} with a gap of two teeth; where it is no {found}, say so with --kind"
            raise ModelError(f"the number of teeth of this {found}'s wheel is wanted", where=name, remedy=remedy)
        teeth, missing = teeth_of(wheel, "--wheel" if option == "--tacho" else option) if wheel else (0, 0)
        return shaft_from_channel(channel, kind=found, teeth=teeth, missing=missing, index_angle=index)

    def marks(self, name: str) -> Array:
        """Times [s] at which cylinder 1 fires; none where no channel is named."""
        if not name:
            return np.empty(0)
        channel = self.data[self.channel(name, "--marks")]
        return event_times(channel, "pulses" if kind_of(channel) == "pulses" else "voltage")[0]

    def signals(self, names: Sequence[str], shafts: dict[str, xr.Dataset]) -> xr.Dataset:
        """The channels to look at; of 'all', those that are none of the shafts'."""
        if "all" in names and "all" not in self.data.data_vars:
            rest = [str(name) for name in self.data.data_vars if name not in shafts]
            left = [name for name in rest if not np.isfinite(np.asarray(self.data[name].values, dtype=float)).all()]
            if left:
                complain(f"--channel all: left out for values that are no numbers: {', '.join(left)}", kind="warning")
            return self.data[[name for name in rest if name not in left]]
        return self.data[[self.channel(name, "--channel") for name in dict.fromkeys(names)]]


def asked_orders(text: str) -> Array:
    """The orders typed: some with commas between them, or a range."""
    ranges = [part.strip() for part in text.split(",") if ":" in part]
    single = [part.strip() for part in text.split(",") if part.strip() and ":" not in part]
    found = [read_orders(None, part) for part in ranges] + [read_orders(single, "")]
    every = [each for each in found if each is not None]
    return np.unique(np.concatenate(every)) if every else np.array(HALF_ORDERS)


def told_apart(order: Array, rotation: xr.Dataset, records: Sequence[xr.Dataset | xr.DataArray]) -> Array:
    """Of the usual orders those of which all records have samples enough, the lowest at least."""
    times = [record[next(dim for dim in record.dims if str(dim).startswith("time"))].values for record in records]
    return np.asarray(order[order <= max(highest_order(rotation, times), order[0])])


def one_of(text: str, known: Sequence[str], option: str) -> str:
    """A name typed, whatever its case; the first one by default."""
    match = {name.casefold(): name for name in known}
    if text and text.casefold() not in match:
        told = {"found": units.quoted(text), "allowed": ", ".join(known), "remedy": nearest(text, known, listed=False)}
        raise ModelError("there is no such choice", where=option, **told)
    return match[text.casefold()] if text else known[0]


def wheel_of(text: str) -> tuple[str, str]:
    """A channel and the teeth behind it, as they are typed.

    >>> wheel_of("n_gearbox=90"), wheel_of("angle")
    (('n_gearbox', '90'), ('angle', ''))
    """
    name, between, teeth = text.rpartition("=")
    return (name, teeth) if between else (text, "")


def teeth_of(text: str, option: str) -> tuple[int, int]:
    """Teeth of a wheel and how many of them are missing, as they are typed.

    >>> teeth_of("60-2", "--wheel"), teeth_of("1024", "--wheel")
    ((60, 2), (1024, 0))
    """
    parts = text.replace("−", "-").split("-")
    if len(parts) > 2 or not all(part.strip().isascii() and part.strip().isdigit() and len(part) < 8 for part in parts):
        allowed = "60, or 60-2 where two of 60 are missing"
        raise ModelError("teeth a turn are wanted", where=option, found=units.quoted(text), allowed=allowed)
    return int(parts[0]), int(parts[1]) if len(parts) > 1 else 0
