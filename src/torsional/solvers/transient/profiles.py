"""Torques over one turn of an angle as even cubic pieces, and values over time as straight lines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray

PIECES = 256
"""Cubic pieces a period of the highest order: a cosine is met to (2π/256)⁴/384 = 9e-10 of its amplitude."""
ROUNDING = 1e-13


class Profile(NamedTuple):
    """A torque over an angle: ``coefficients`` (pieces, 4), lowest power first, of the share of the piece, repeating
    itself every 2π ``period`` [rad]."""

    coefficients: Array
    period: float

    @property
    def mean(self) -> float:
        """Its mean over a period; zero where nothing but rounding is left.

        >>> Profile(np.array([[1.0, 2.0, 0.0, 0.0]]), 1.0).mean
        2.0
        """
        found = float((self.coefficients @ (1.0 / np.arange(1, 5))).mean())
        return found if abs(found) > ROUNDING * float(np.abs(self.coefficients).max()) else 0.0

    def at(self, angle: ArrayLike) -> Array:
        """Values at angles [rad]."""
        pieces = len(self.coefficients)
        place = np.mod(np.asarray(angle, dtype=float) / (2 * np.pi * self.period), 1.0) * pieces
        piece = np.minimum(place.astype(int), pieces - 1)
        s = place - piece
        c = self.coefficients[piece]
        return np.asarray(c[..., 0] + s * (c[..., 1] + s * (c[..., 2] + s * c[..., 3])))


class Level(NamedTuple):
    """A value over ``time`` [s]: straight lines between knots, constant before and after."""

    time: Array
    value: Array

    def at(self, time: ArrayLike) -> Array:
        """Values at times [s]."""
        return np.asarray(np.interp(np.asarray(time, dtype=float), self.time, self.value))


def level_of(times: ArrayLike, values: ArrayLike, where: str) -> Level:
    """Checked knots; a jump is two knots at one time.  Raises ModelError for falling times and lengths that differ.

    >>> level_of([0.0, 1.0], [2.0, 4.0], "torque").at(0.25)
    array(2.5)
    """
    time, value = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (times, values))
    if time.ndim != 1 or time.shape != value.shape or not time.size:
        found = f"{time.size} times and {value.size} values"
        raise ModelError("a value is wanted for each time", where=where, found=found)
    if not (np.isfinite(time).all() and np.isfinite(value).all()):
        raise ModelError("times and values must be finite", where=where)
    if (np.diff(time) < 0).any():
        at = int(np.flatnonzero(np.diff(time) < 0)[0])
        raise ModelError("times must not fall", where=where, found=f"{time[at]:g}, {time[at + 1]:g} s")
    return Level(time, value)


def of_orders(orders: Array, torque: ComplexArray) -> Profile:
    """The profile of Re Σ_n T_n exp(i n α) by its values and slopes, from ``orders`` (orders,) and T_n (orders,).

    >>> bool(abs(of_orders(np.array([0.0, 3.0]), np.array([1.0, 2.0])).at(0.4) - 1 - 2 * np.cos(1.2)) < 4e-9)
    True
    """
    above = orders[orders > 0]
    if not above.size:
        return Profile(np.array([[float(np.real(torque).sum()), 0.0, 0.0, 0.0]]), 1.0)
    base = float(np.gcd.reduce(np.round(2 * above).astype(int))) / 2
    pieces = round(above.max() / base) * PIECES
    angle = np.arange(pieces) * (2 * np.pi / base / pieces)
    turns = np.exp(1j * np.multiply.outer(angle, orders)) * torque
    return _hermite(turns.sum(axis=1).real, (turns * 1j * orders).sum(axis=1).real, 1.0 / base)


def _hermite(values: Array, slopes: Array, period: float) -> Profile:
    """The profile through ``values`` with ``slopes`` by the angle [1/rad] at even angles of one period."""
    rise = slopes * (2 * np.pi * period / len(values))
    after, rise_after = np.roll(values, -1), np.roll(rise, -1)
    change = after - values
    pieces = np.stack([values, rise, 3 * change - 2 * rise - rise_after, rise + rise_after - 2 * change], axis=1)
    return Profile(pieces, period)


def through(values: Array, period: float) -> Profile:
    """The periodic cubic spline through ``values`` at even angles of one period of 2π ``period``.

    >>> alpha = np.arange(400) * 2 * np.pi / 400
    >>> bool(abs(through(np.cos(alpha), 1.0).at(1.0) - np.cos(1.0)) < 1e-9)
    True
    """
    turns = np.fft.rfftfreq(len(values), 1.0 / len(values)) * (2 * np.pi / len(values))
    slopes = np.fft.irfft(np.fft.rfft(values) * (3j * np.sin(turns) / (2 + np.cos(turns))), len(values))
    return _hermite(values, slopes * (len(values) / (2 * np.pi * period)), period)
