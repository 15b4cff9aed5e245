"""What the continuation of F(x, p) = 0 works with: the problem, its points, the settings, the reasons to end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array

FOLD = "fold"


class Corrected(NamedTuple):
    """What a corrector gives back, in scaled variables.

    ``z`` (n + 1,) the point, parameter last; ``tangent`` (n + 1,) of length one with F_z · tangent = 0, along the
    normal (tangent · normal ≥ 0); ``iterations`` the Newton steps taken, ``residual`` the largest |F| left,
    ``converged``, and ``values`` (tests,) of the test functions.  Without convergence only ``converged`` counts.
    """

    z: Array
    tangent: Array
    iterations: int
    residual: float
    converged: bool
    values: Array


class Problem(Protocol):
    """Equations F(x, p) = 0, n of them, in the scaled variables z = (x, p) / scale.

    ``scale`` (n + 1,) brings every z to the order of one; ``tests`` names the functions whose changes of sign are
    events, best of the order of one too.
    """

    @property
    def scale(self) -> Array:
        """What a scaled variable is multiplied with, the parameter last: shape (n + 1,)."""
        ...

    @property
    def tests(self) -> tuple[str, ...]:
        """Names of the test functions, in the order of ``Corrected.values``."""
        ...

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method on F(z) = 0 in the plane normal · (z − guess) = 0; an axis as normal holds that entry.

        The arrays given back are the caller's to keep; ``guess`` and ``normal`` are left as they are.
        """
        ...


class Point(NamedTuple):
    """A point of a curve: ``z`` and ``tangent`` (n + 1,) scaled, ``values`` (tests,), ``parameter`` physical.

    ``arclength`` is counted from the start in scaled variables, ``event`` names what is located here ("" where nothing
    is), and ``within`` bounds the error of that place along the curve.
    """

    z: Array
    tangent: Array
    values: Array
    parameter: float
    arclength: float
    iterations: int
    residual: float
    event: str = ""
    within: float = 0.0


class End(Enum):
    """Why a trace ended; ``advice`` is a sentence on what to do about it."""

    LEFT_RANGE = "The parameter reached a bound of its span; widen the span to see more of the curve."
    CLOSED = "The curve came back to its start in the same direction; all of it has been followed."
    TERMINAL = "An event that ends the trace was located; leave its name out of `terminal` to go on beyond it."
    STEP_TOO_SMALL = (
        "No step longer than `smallest_step` led to another point; see whether the equations have an end, a jump or a "
        "corner behind the last point, and whether their Jacobian and the scale are right."
    )
    TOO_MANY_POINTS = "The trace has `most_points` points; raise that number, or the largest step and angle."
    START_FAILED = "No point of the curve was found near the start; give a better start or another parameter there."

    @property
    def advice(self) -> str:
        """What the end means and what to do about it."""
        return str(self.value)


@dataclass(frozen=True)
class Settings:
    """How a curve is followed.  Lengths are arclengths in scaled variables, which are best of the order of one.

    ``first_step``, ``largest_step`` and ``smallest_step``; ``largest_angle`` [rad] between the tangents at successive
    points, which keeps a step from reaching another branch and from passing over a pair of folds (a turn still larger
    within a hundred smallest steps is taken for a corner of the curve); ``most_points``, events not counted;
    ``tolerance`` of an event's place, relative to the size of z or of the step, whichever is larger; ``terminal`` the
    events that end the trace.  Raises ModelError where a setting contradicts itself or another.

    >>> Settings(largest_step=0.2).largest_angle
    0.35
    >>> Settings(largest_step=-1.0)
    Traceback (most recent call last):
    torsional.errors.ModelError: largest_step: must be a positive number; found -1.0
    """

    first_step: float = 0.02
    largest_step: float = 0.5
    smallest_step: float = 1e-7
    largest_angle: float = 0.35
    most_points: int = 5000
    tolerance: float = 1e-9
    terminal: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("first_step", "largest_step", "smallest_step", "largest_angle", "tolerance"):
            value = getattr(self, name)
            if not (isinstance(value, int | float) and math.isfinite(value) and value > 0.0):
                raise ModelError("must be a positive number", where=name, found=repr(value))
        if not self.smallest_step <= self.first_step <= self.largest_step:
            raise ModelError(
                "must lie between the smallest and the largest step",
                where="first_step",
                found=repr(self.first_step),
                allowed=f"{self.smallest_step!r} to {self.largest_step!r}",
            )
        _limited("largest_angle", self.largest_angle, 1.5, "rad; beyond a right angle a curve has no direction")
        _limited("tolerance", self.tolerance, 1e-3, "of the size of the variables")
        if isinstance(self.most_points, bool) or not isinstance(self.most_points, int) or self.most_points < 2:
            raise ModelError("must be a whole number of at least 2", where="most_points", found=repr(self.most_points))
        if not isinstance(self.terminal, tuple) or not all(isinstance(name, str) for name in self.terminal):
            raise ModelError("must be a tuple of names", where="terminal", found=repr(self.terminal))


def _limited(name: str, value: float, largest: float, unit: str) -> None:
    if value > largest:
        raise ModelError("is too large", where=name, found=repr(value), allowed=f"up to {largest} {unit}")


@dataclass(frozen=True)
class Trace:
    """A curve followed: its points in order, those of them that are events, and why it ended.

    ``began`` is None where the trace begins at its start, else the reason why following it backwards ended.
    """

    points: tuple[Point, ...]
    end: End
    scale: Array
    began: End | None = None

    @cached_property
    def events(self) -> tuple[Point, ...]:
        """The points with a name, in order."""
        return tuple(point for point in self.points if point.event)

    @cached_property
    def physical(self) -> Array:
        """(x, p) of every point in physical units, shape (points, n + 1)."""
        return np.array([point.z for point in self.points]).reshape(-1, self.scale.size) * self.scale

    @cached_property
    def parameter(self) -> Array:
        """The parameter of every point in physical units, shape (points,)."""
        return np.array([point.parameter for point in self.points])
