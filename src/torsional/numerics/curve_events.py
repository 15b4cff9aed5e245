"""Events between two neighbouring points of a curve, located by corrections between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from torsional.numerics.arrays import Array
from torsional.numerics.curves import Corrected, Point, Problem

MOST_CORRECTIONS = 80
"""Halving 0.5 down to rounding takes 52; smooth functions take three or four."""

Measure = Callable[[Point | Corrected], float]


class Located(NamedTuple):
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


def between(low: _Sample, high: _Sample, place: float, normal: Array) -> Array:
    """The cubic through two points with their tangents, in the plane of z with normal · (z − first point) = place."""
    length = high.place - low.place
    u = (place - low.place) / length
    rest = 1.0 - u
    left = u * rest * rest * length / low.point.tangent.dot(normal)
    right = -u * u * rest * length / high.point.tangent.dot(normal)
    weight = u * u * (3.0 - 2.0 * u)
    cubic: Array = (1.0 - weight) * low.point.z + weight * high.point.z
    cubic += left * low.point.tangent + right * high.point.tangent
    return cubic


def guess_at(here: Point, there: Point | Corrected, share: float) -> Array:
    """The cubic between two points, at a share of the way along the first one's tangent."""
    length = here.tangent.dot(there.z - here.z)
    return between(_Sample(0.0, 0.0, here), _Sample(length, 0.0, there), share * length, here.tangent)


def share_of_fold(here: Point, there: Point | Corrected) -> float:
    """Where the cubic of the parameter between two points has its extremum, as a share of the way."""
    length = float(here.tangent.dot(there.z - here.z))
    a = float(here.tangent[-1])
    b = float(there.tangent[-1]) / float(there.tangent.dot(here.tangent))
    slope = float(there.z[-1] - here.z[-1]) / length
    return _root(a, 6.0 * slope - 4.0 * a - 2.0 * b, 3.0 * (a + b) - 6.0 * slope)


def _root(c: float, b: float, a: float) -> float:
    """The root of a u² + b u + c between 0 and 1, where its values there differ in sign; one half in case of doubt."""
    discriminant = b * b - 4.0 * a * c
    if discriminant < 0.0:
        return 0.5
    q = -0.5 * (b + math.copysign(math.sqrt(discriminant), b))
    roots = [root for root in (c / q if q else 0.5, q / a if a else 0.5) if 0.0 < root < 1.0]
    return roots[0] if roots else 0.5


def locate(
    problem: Problem,
    here: Point,
    there: Point | Corrected,
    measure: Measure,
    tolerance: float,
    share: float | None = None,
) -> Located:
    """The point between two at which a measure of points is zero, of which it has different signs at the two.

    Places are counted along the tangent of the first; each sample is corrected from the cubic between the nearest two.
    Inverse quadratic interpolation where it is safe, else halves: Chandrupatla, Advances in Engineering Software 28
    (1997) 145, doi 10.1016/S0965-9978(96)00051-8.  Where the corrector fails, the nearest point it found is given.
    """
    normal = here.tangent
    a = _Sample(0.0, measure(here), here)
    b = _Sample(float(normal.dot(there.z - here.z)), measure(there), there)
    if b.value == 0.0:
        return Located(there, 0.0)
    c = a
    t = a.value / (a.value - b.value) if share is None else share
    failures = 0
    for _ in range(MOST_CORRECTIONS):
        place = a.place + t * (b.place - a.place)
        got = problem.correct(between(a, b, place, normal), normal)
        if not got.converged:
            failures, t = failures + 1, (0.5, 0.25, 0.75, 0.1, 0.9)[min(failures, 4)]
            if failures > 5:
                break
            continue
        new = _Sample(place, measure(got), got)
        b, c = (b, a) if (new.value < 0.0) == (a.value < 0.0) else (a, b)
        a = new
        if _error(a, b, c) <= tolerance or abs(b.place - a.place) <= tolerance:
            break
        t = _next(a, b, c, tolerance)
    best = min(a, b, key=lambda sample: abs(sample.value))
    return Located(best.point, _error(a, b, c) if best is a else abs(b.place - a.place))


def _error(a: _Sample, b: _Sample, c: _Sample) -> float:
    """How far the zero may be from the newest sample, by the smaller of the two slopes next to it."""
    inverse = abs((a.place - b.place) / (a.value - b.value)) if a.value != b.value else math.inf
    if c.value != a.value:
        inverse = max(inverse, abs((a.place - c.place) / (a.value - c.value)))
    return min(abs(a.value) * inverse if a.value else 0.0, abs(b.place - a.place))


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
