"""Smooth elastic laws: a polynomial, and a curve through measured points."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numba
import numpy as np

from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.laws.base import Law, Told, plain
from torsional.laws.checks import rising_points
from torsional.numerics.arrays import Array


@numba.njit(cache=True, error_model="numpy")
def polynomial_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f(φ) = c_1 φ + c_2 φ² + c_3 φ³ + …, by Horner's rule; parameters are the coefficients."""
    torque, slope = 0.0, 0.0
    for i in range(parameters.size - 1, -1, -1):
        torque = torque * angle + parameters[i]
        slope = slope * angle + (i + 1) * parameters[i]
    return plain(torque * angle, slope, 0.0)


@dataclass(frozen=True)
@checked_fields
class Polynomial(Law):
    """f(φ) = c_1 φ + c_2 φ² + c_3 φ³ + … with ``coefficients`` c_n [Nm/rad^n]; (k, 0, k3) is Duffing's spring.

    Raises ModelError unless they are finite and at least one.

    >>> Polynomial((100.0, 0.0, 5e3)).torque([-0.1, 0.2]).tolist()
    [-15.0, 60.0]
    """

    coefficients: tuple[float, ...]

    kernel: ClassVar[Callable[..., Told]] = polynomial_torque

    def __post_init__(self) -> None:
        values = np.asarray(self.coefficients, dtype=float)
        if values.ndim != 1 or not values.size or not np.isfinite(values).all():
            found, remedy = repr(self.coefficients), "list those of φ, φ², φ³ …"
            raise ModelError("a polynomial has finite coefficients", where="coefficients", found=found, remedy=remedy)
        object.__setattr__(self, "coefficients", tuple(values.tolist()))

    @property
    def parameters(self) -> Array:
        """The coefficients of φ, φ², φ³ …"""
        return np.array(self.coefficients, dtype=float)


@numba.njit(cache=True, error_model="numpy")
def table_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """Cubics between the points, straight on beyond the outer ones; parameters are rows (angle, torque, slope)."""
    last = parameters.size // 3 - 1
    if angle <= parameters[0]:
        return plain(parameters[1] + parameters[2] * (angle - parameters[0]), parameters[2], 0.0)
    if angle >= parameters[3 * last]:
        slope = parameters[3 * last + 2]
        return plain(parameters[3 * last + 1] + slope * (angle - parameters[3 * last]), slope, 0.0)
    low, high = 0, last
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if parameters[3 * middle] <= angle else (low, middle)
    start, base, first = parameters[3 * low], parameters[3 * low + 1], parameters[3 * low + 2]
    width, rise, second = parameters[3 * high] - start, parameters[3 * high + 1] - base, parameters[3 * high + 2]
    s = (angle - start) / width
    c2, c3 = 3.0 * rise - (2.0 * first + second) * width, (first + second) * width - 2.0 * rise
    torque = base + s * (first * width + s * (c2 + s * c3))
    return plain(torque, first + s * (2.0 * c2 + 3.0 * s * c3) / width, 0.0)


@dataclass(frozen=True)
@checked_fields
class Table(Law):
    """A smooth rising curve through ``points`` (angle [rad], torque [Nm]), with one slope at each point.

    Cubics whose slopes are weighted harmonic means of the neighbouring chords', so that the curve rises between
    rising points and swings over none (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300); beyond the
    outer points it goes on straight.  Straight lines between the points are `Hinges.through`.  Raises ModelError
    unless the angles rise and no torque falls.

    >>> Table(((-0.1, -50.0), (0.0, 0.0), (0.1, 100.0), (0.2, 400.0))).torque([0.0, 0.1, 0.3]).tolist()
    [0.0, 100.0, 800.0]
    """

    points: tuple[tuple[float, float], ...]

    kernel: ClassVar[Callable[..., Told]] = table_torque

    def __post_init__(self) -> None:
        angles, torques = rising_points(self.points)
        object.__setattr__(self, "points", tuple(zip(angles.tolist(), torques.tolist(), strict=True)))

    @cached_property
    def parameters(self) -> Array:
        """(angle, torque, slope) of every point."""
        angles, torques = rising_points(self.points)
        return np.column_stack([angles, torques, _slopes(angles, torques)]).ravel()


def _slopes(angles: Array, torques: Array) -> Array:
    """Slopes at the points: weighted harmonic means of the chords' inside, one-sided three-point ones at the ends."""
    width, chord = np.diff(angles), np.diff(torques) / np.diff(angles)
    if chord.size == 1:
        return np.repeat(chord, 2)
    left, right = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
    with np.errstate(divide="ignore"):
        inner = (left + right) / (left / chord[:-1] + right / chord[1:])
    ends = [_end(width[0], width[1], chord[0], chord[1]), _end(width[-1], width[-2], chord[-1], chord[-2])]
    return np.concatenate([[ends[0]], inner, [ends[1]]])


def _end(near: float, far: float, chord: float, other: float) -> float:
    """The three-point slope at an end, kept between nought and three times the chord's."""
    slope = ((2 * near + far) * chord - near * other) / (near + far)
    return float(min(max(slope, 0.0), 3 * chord))
