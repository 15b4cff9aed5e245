"""Loops as a rig measures them: angle and torque over time under a steady swing, read from tables and written to them.

A table has the columns ``loop`` (a number, the same in all rows of one operating point), ``time``, ``speed``, ``angle``
and ``torque``, each with its unit, as `torsional.tables` reads them.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.opening import TABLE_BYTES, read_text, shown
from torsional.numerics.arrays import Array, IntArray
from torsional.solvers.hysteresis import Course
from torsional.system import BoolArray
from torsional.tables import heading, parse_table
from torsional.units import QUANTITIES, RPM

COLUMNS = {"loop": "number", "time": "time", "speed": "speed", "angle": "relative_angle", "torque": "torque"}
LEAST = 32
"""Samples of a record at least."""
STEADY = 0.02
"""What the rotational speed may stray by within a record, over its mean or over 50 rpm."""
ORDERS = 15
"""Orders of the swing that a motion is made of: what is beyond counts as noise."""
MEDIAN = 0.6744897501960817
"""Median of what is normally distributed, without its sign, over its standard deviation."""
LEAST_PARTS, JUMP = 8, 6.0
"""Parts of a cycle at least, and how far a jump of the torque from one to the next stands out."""
CLEAR = 4.0
"""An order of the angle counts where its amplitude is so many standard deviations of what noise leaves there."""


class Swing(NamedTuple):
    """A periodic motion out of noise: ``period`` [s], ``begin`` [s] where it passes its middle upwards, ``terms``
    (1, cos, sin of each order) [rad] and the ``noise`` [rad] that is left."""

    period: float
    begin: float
    terms: Array
    noise: float

    def spread(self, time: Array) -> Array:
        """Independent errors (errors, terms) of the terms [rad], a standard deviation each, of samples at times [s].

        σ² (XᵀX)⁻¹ = L Lᵀ, the errors the columns of L.  That of the period is left out: it shifts the first cycles
        against the last ones, and over all of them next to nothing.
        """
        waves = _waves(time, self.period, (self.terms.size - 1) // 2)
        return np.asarray(self.noise * np.linalg.cholesky(np.linalg.inv(waves.T @ waves)).T)

    def at(self, time: Array) -> Array:
        """The angle [rad] at times [s]."""
        orders = (self.terms.size - 1) // 2
        return np.asarray(_waves(time, self.period, orders) @ self.terms)


@dataclass(frozen=True, eq=False)
class Record:
    """One operating point on a rig: mean ``speed`` [rad/s], and over ``time`` [s] the ``angle`` between the flywheels
    [rad] and the ``torque`` [Nm] between them, all (samples,).

    Raises ModelError for fewer than 32 samples, for values that are not finite, times that do not increase, and an
    angle that stands still or swings for less than one cycle.
    """

    name: str
    speed: float
    time: Array
    angle: Array
    torque: Array

    def __post_init__(self) -> None:
        for what in ("time", "angle", "torque"):
            values = getattr(self, what)
            if values.ndim != 1 or values.size < LEAST or values.size != self.time.size:
                found, allowed = f"{values.size} of {what}", f"{LEAST} at least, of each as many"
                raise ModelError("too few samples for a loop", where=self.name, found=found, allowed=allowed)
            bad = int(np.count_nonzero(~np.isfinite(values)))
            if bad:
                raise ModelError("measured values must be finite", where=self.name, found=f"{bad} of {what} are not")
        if not np.isfinite(self.speed) or (np.diff(self.time) <= 0.0).any():
            raise ModelError("a steady speed and increasing times are wanted", where=self.name)
        if np.ptp(self.angle) == 0.0:
            raise ModelError("the angle stands still", where=self.name, found=f"{self.angle[0]:g} rad throughout")
        if np.ptp(self.time) < 0.99 * self.swing.period:
            cycles = f"{np.ptp(self.time) / self.swing.period:.2f} cycles"
            raise ModelError("less than one cycle was measured", where=self.name, found=cycles)

    @cached_property
    def swing(self) -> Swing:
        """The motion of the angle, out of the encoder's noise: least squares, only orders that stand out of it."""
        period = _period(self.time, self.angle)
        most = min(ORDERS, self.time.size // 8)
        terms, noise = _fitted(self.time, self.angle, period, most)
        sizes = np.hypot(terms[1::2], terms[2::2])
        clear = np.flatnonzero(sizes > CLEAR * noise * np.sqrt(2.0 / self.time.size))
        terms, noise = _fitted(self.time, self.angle, period, 1 + int(clear.max(initial=0)))
        begin = np.arctan2(-terms[1], terms[2]) * period / (2.0 * np.pi)
        return Swing(period, float(begin), terms, noise)

    @cached_property
    def noise(self) -> float:
        """Standard deviation [Nm] of the torque's noise, as `white_noise` tells it."""
        return white_noise(self.time, self.torque)

    @cached_property
    def swing_errors(self) -> Array:
        """Independent errors (errors, terms) [rad] of the `swing` by the encoder's noise, a standard deviation each."""
        return self.swing.spread(self.time)

    def course(self, samples: int, offset: float = 0.0, error: Array | None = None) -> Course:
        """One cycle of the motion, in so many steps; ``offset`` [rad]: what the encoder tells too much, ``error``: what
        the terms of the swing are off by."""
        at = self.swing.begin + self.swing.period * np.arange(1, samples + 1) / samples
        swing = self.swing if error is None else self.swing._replace(terms=self.swing.terms + error)
        return Course.through(self.speed, swing.at(at) - offset, self.swing.period)

    def of_cycle(self, values: Array) -> Array:
        """What values (steps,) after the steps of `course` are at the instants of the `clear` samples."""
        phase = self._phase[self.clear]
        steps = np.arange(values.size + 1) / values.size
        return np.asarray(np.interp(phase, steps, np.concatenate([values[-1:], values])), dtype=float)

    @property
    def _phase(self) -> Array:
        """Of the samples within the cycle, 0 to 1."""
        return np.mod((self.time - self.swing.begin) / self.swing.period, 1.0)

    @cached_property
    def clear(self) -> BoolArray:
        """Which samples (samples,) are not beside a jump of the torque.

        There means over parts of the cycle, as many as it has samples, differ from the next one far beyond noise, and
        beyond what they do elsewhere.  A body that has crossed a clearance strikes its end there.  Models without
        inertia do not describe that; of such a sample they tell the instant of the jump, and in steps by chance.
        """
        parts = max(int(self.time.size * self.swing.period / np.ptp(self.time)), LEAST_PARTS)
        part = np.minimum((self._phase * parts).astype(np.int64), parts - 1)
        mean = self._means(self.torque, part, parts)
        step = np.abs(np.roll(mean, -1) - mean)
        spread = self.noise * np.sqrt(2.0 * parts / self.time.size)
        jump = np.nan_to_num(step) > JUMP * max(spread, float(np.nanmedian(step)))
        beside = jump | np.roll(jump, 1)
        for way in (-1, 1):
            beside = beside | np.roll(beside, way)
        return np.asarray(~beside[part])

    def averaged(self, values: Array, bins: int) -> Array:
        """Means of values over equal parts of the cycle, all cycles together, NaN where there are none: of all samples,
        or of those that are `clear`."""
        phase = self._phase if values.size == self.time.size else self._phase[self.clear]
        return self._means(values, np.minimum((phase * bins).astype(np.int64), bins - 1), bins)

    @staticmethod
    def _means(values: Array, part: IntArray, parts: int) -> Array:
        count = np.bincount(part, minlength=parts)
        total = np.bincount(part, weights=values, minlength=parts)
        return np.asarray(np.divide(total, count, out=np.full(parts, np.nan), where=count > 0))


def white_noise(time: Array, values: Array) -> float:
    """Standard deviation of white noise in values (samples,): how far they lie off the line between their neighbours.

    The median of it, so that corners and jumps of friction count for nothing.

    >>> draw = np.random.default_rng(0)
    >>> round(white_noise(np.arange(4000.0), 0.2 * draw.standard_normal(4000)), 2)
    0.2
    """
    share = (time[1:-1] - time[:-2]) / (time[2:] - time[:-2])
    off = values[1:-1] - (1.0 - share) * values[:-2] - share * values[2:]
    each = np.abs(off) / np.sqrt(1.0 + share**2 + (1.0 - share) ** 2)
    return float(np.median(each) / MEDIAN)


def _waves(time: Array, period: float, orders: int) -> Array:
    phase = 2.0 * np.pi * np.outer(time, np.arange(1, orders + 1)) / period
    pairs = np.stack([np.cos(phase), np.sin(phase)], axis=-1).reshape(time.size, -1)
    return np.column_stack([np.ones(time.size), pairs])


def _fitted(time: Array, values: Array, period: float, orders: int) -> tuple[Array, float]:
    """Terms of the first orders by least squares, and the standard deviation of what they leave."""
    waves = _waves(time, period, orders)
    terms = np.asarray(np.linalg.lstsq(waves, values, rcond=None)[0], dtype=float)
    left = values - waves @ terms
    return terms, float(np.sqrt(left @ left / (time.size - terms.size)))


def _period(time: Array, angle: Array) -> float:
    """The period [s] of the strongest wave: the largest line of the spectrum, then the wave that leaves least."""
    even = np.linspace(time[0], time[-1], time.size)
    lines = np.abs(np.fft.rfft(np.interp(even, time, angle) - angle.mean()))
    lasting = (time[-1] - time[0]) * time.size / (time.size - 1)
    number = 1 + int(lines[1:].argmax())

    def left(frequency: float) -> float:
        return _fitted(time, angle, 1.0 / frequency, 1)[1]

    near = (number - 0.7) / lasting, (number + 0.7) / lasting
    found = minimize_scalar(left, bounds=near, method="bounded", options={"xatol": 1e-7 / lasting})
    return 1.0 / float(found.x)


@checked
def loops_of_file(path: str | Path) -> tuple[Record, ...]:
    """The loops of a table in CSV, in the sequence of their numbers.

    Columns ``loop``, ``time [s]``, ``speed [rpm]``, ``angle [deg]``, ``torque [Nm]``, in any units of their kind and
    in any sequence.  Raises ModelError, with the file's name, for a table or a loop that cannot be read.
    """
    text = read_text(path, TABLE_BYTES)
    try:
        return loops_of_table(text)
    except ModelError as error:
        raise error.located(file=shown(path)) from None


def loops_of_table(text: str) -> tuple[Record, ...]:
    """The loops of the text of such a table."""
    table = {name: np.array(values) for name, values in parse_table(text, COLUMNS).items()}
    told = []
    for number in np.unique(table["loop"]):
        time, speed, angle, torque = (table[name][table["loop"] == number] for name in list(COLUMNS)[1:])
        mean, name = float(speed.mean()), f"loop {number:g}"
        if np.abs(speed - mean).max() > STEADY * max(abs(mean), 50.0 * RPM):
            found = f"{speed.min() / RPM:.4g} to {speed.max() / RPM:.4g} rpm"
            raise ModelError("the speed is not steady", where=name, found=found)
        told.append(Record(name, mean, time, angle, torque))
    return tuple(told)


@checked
def write_loops(loops: Sequence[Record], path: str | Path) -> Path:
    """Write loops as a table that `loops_of_file` reads, every digit kept; SI units."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(heading(name, QUANTITIES[quantity].unit) for name, quantity in COLUMNS.items())
    for number, loop in enumerate(loops, 1):
        rows = zip(loop.time.tolist(), loop.angle.tolist(), loop.torque.tolist(), strict=True)
        writer.writerows((number, time, loop.speed, angle, torque) for time, angle, torque in rows)
    target = Path(path)
    target.write_text(text.getvalue(), encoding="utf-8")
    return target
