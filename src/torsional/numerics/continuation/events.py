"""Events between two neighbouring points of a curve, located by corrections between them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from torsional.numerics.continuation.curves import FOLD, Corrected, Point, Problem, Settings
from torsional.numerics.continuation.shape import arc_between, cubic_between, share_of_fold

MOST_CORRECTIONS = 80
"""Halving 0.5 down to rounding takes 52; smooth functions take three or four."""
LONGEST_ARC = 1.02
"""Arc over chord beyond what a step may be bent: 1.005 for a turn of 0.35 rad."""
ELSEWHERE = (0.5, 0.25, 0.75, 0.1, 0.9)
"""Shares of the way to try where the corrector fails."""

Measure = Callable[[Point | Corrected], float]


class _Located(NamedTuple):
    """A point where the measure is zero, and the bound of its error along the curve."""

    point: Point | Corrected
    within: float


class _Sample(NamedTuple):
    """A point between, its place along the tangent of the first point, and the measure there."""

    place: float
    value: float
    point: Point | Corrected


def crosses(before: float, after: float) -> bool:
    """Whether a value changes its sign, or arrives at zero; leaving zero is no change.

    >>> crosses(-1.0, 2.0), crosses(-1.0, 0.0), crosses(0.0, 2.0)
    (True, True, False)
    """
    return before < 0.0 <= after or before > 0.0 >= after


def _locate(
    problem: Problem,
    here: Point,
    there: Point | Corrected,
    measure: Measure,
    tolerance: float,
    share: float | None = None,
) -> _Located:
    """The point between two at which a measure of points is zero, of which it has different signs at the two.

    Places are counted along the tangent of the first, a first guess is a ``share`` of the way; each sample is corrected
    from the cubic between the two nearest.  Inverse quadratic interpolation where it is safe, else halves: Chandrupatla
    in Advances in Engineering Software 28 (1997) 145, doi 10.1016/S0965-9978(96)00051-8.  Where the corrector fails,
    the nearest point it found is given, with the distance to the other side as its error.
    """
    normal = here.tangent
    a = _Sample(0.0, measure(here), here)
    b = _Sample(float(normal.dot(there.z - here.z)), measure(there), there)
    if b.value == 0.0:
        return _Located(there, 0.0)
    c, failures = a, 0
    t = a.value / (a.value - b.value) if share is None else share
    for _ in range(MOST_CORRECTIONS):
        got = problem.correct(cubic_between(a.point, b.point, t, normal), normal)
        if not got.converged:
            if failures == len(ELSEWHERE):
                break
            t, failures = ELSEWHERE[failures], failures + 1
            continue
        new = _Sample(a.place + t * (b.place - a.place), measure(got), got)
        b, c = (b, a) if (new.value < 0.0) == (a.value < 0.0) else (a, b)
        a = new
        if _error(a, b, c) <= tolerance:
            break
        t = _next(a, b, c, tolerance)
    best = min(a, b, key=lambda sample: abs(sample.value))
    return _Located(best.point, _error(a, b, c) if best is a else abs(b.place - a.place))


def _error(a: _Sample, b: _Sample, c: _Sample) -> float:
    """How far the zero may be from the newest sample, by the smaller of the two slopes next to it."""
    if a.value == 0.0:
        return 0.0
    inverse = abs((a.place - b.place) / (a.value - b.value))
    if c.value != a.value:
        inverse = max(inverse, abs((a.place - c.place) / (a.value - c.value)))
    return min(abs(a.value) * inverse, abs(b.place - a.place))


def _next(a: _Sample, b: _Sample, c: _Sample, tolerance: float) -> float:
    """The share of the way from the newest sample a to b, on the other side of the zero, to try next."""
    least = min(0.5, 0.5 * tolerance / abs(b.place - a.place))
    if c.place == b.place or c.value in (a.value, b.value):
        return 0.5
    xi = (a.place - b.place) / (c.place - b.place)
    phi = (a.value - b.value) / (c.value - b.value)
    if not (phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi):
        return 0.5
    t = a.value / (b.value - a.value) * c.value / (b.value - c.value)
    t += (c.place - a.place) / (b.place - a.place) * a.value / (c.value - a.value) * b.value / (c.value - b.value)
    return min(max(t, least), 1.0 - least)


class Watch:
    """The events of a problem: their names, and for each the function of a point that is zero there."""

    def __init__(self, problem: Problem, settings: Settings) -> None:
        self.problem, self.settings = problem, settings
        self.unit = float(problem.scale[-1])
        tests = [(name, _value(number)) for number, name in enumerate(problem.tests)]
        self.measures: list[tuple[str, Measure]] = [(FOLD, slope), *tests]

    def point(self, got: Corrected | Point, arclength: float, event: str = "", within: float = 0.0) -> Point:
        """What was corrected, as a point of the curve."""
        parameter = got.z.item(got.z.size - 1) * self.unit
        return Point(got.z, got.tangent, got.values, parameter, arclength, got.iterations, got.residual, event, within)

    def tolerance(self, here: Point, there: Point) -> float:
        """How far a located point may be from the event, along the curve."""
        return self.settings.tolerance * max(float(np.linalg.norm(there.z)), there.arclength - here.arclength)

    def events(self, here: Point, there: Point) -> list[Point]:
        """The events between two points in their order."""
        found = []
        for name, measure in self.measures:
            if crosses(measure(here), measure(there)):
                share = share_of_fold(here, there) if name == FOLD else None
                found.append(self.located(here, there, name, measure, share))
        return sorted(found, key=lambda point: point.arclength)

    def located(self, here: Point, there: Point, name: str, measure: Measure, share: float | None = None) -> Point:
        """One event between two points."""
        found = _locate(self.problem, here, there, measure, self.tolerance(here, there), share)
        chord = float(np.linalg.norm(found.point.z - here.z))
        arc = arc_between(here, found.point)
        if arc > LONGEST_ARC * chord:  # where curves cross, the tangent found may be the other one's
            arc = chord
        return self.point(found.point, here.arclength + arc, name, found.within)


def slope(point: Point | Corrected) -> float:
    """The parameter's part of the tangent: zero at a fold."""
    return point.tangent.item(point.tangent.size - 1)


def _value(number: int) -> Measure:
    """One test function's value at a point."""

    def value(point: Point | Corrected) -> float:
        return point.values.item(number)

    return value
