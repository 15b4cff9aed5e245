"""What two neighbouring points and their tangents tell of the curve between them."""

from __future__ import annotations

from math import copysign, sqrt

from torsional.numerics.arrays import Array
from torsional.numerics.continuation.curves import Corrected, Point


def bend_between(here: Point, got: Corrected | Point) -> tuple[float, float, float]:
    """Length of the chord, the ``turn`` between the tangents, and the ``skew`` between the chord and their mean.

    On an arc the skew is zero, on a smooth curve of the second order in the length; a chord to another branch is as
    skew as that branch is far.  Angles are given as chords of the circle of radius one, 2 sin(angle / 2), which
    rounding does not spoil where they are small.
    """
    chord = got.z - here.z
    length = sqrt(chord.dot(chord))
    cosine = float(here.tangent.dot(got.tangent))
    if length == 0.0 or cosine <= -1.0:
        return length, 2.0, 2.0
    along = float(chord.dot(here.tangent)) + float(chord.dot(got.tangent))
    skew = sqrt(abs(2.0 - 2.0 * along / (length * sqrt(2.0 + 2.0 * cosine))))
    return length, sqrt(abs(2.0 - 2.0 * cosine)), skew


def arc_length(length: float, turn: float) -> float:
    """Length of an arc by its chord and its turn, the series of arcsin(turn / 2) / (turn / 2).

    >>> round(arc_length(0.2988762649, 0.2988762649), 6)
    0.3
    """
    square = turn * turn
    return length * (1.0 + square * (1.0 / 24.0 + square * (3.0 / 640.0)))


def arc_between(here: Point, got: Corrected | Point) -> float:
    """Length of the arc between two points."""
    length, turn, _ = bend_between(here, got)
    return arc_length(length, turn)


def slope_dip(a: float, b: float, mean: float) -> float:
    """Where a parabola with values a at 0, b at 1 and that mean dips through zero and back, else 0.

    For the slope of a quantity, whose mean is known from its values: tells a pair of extrema between two points.

    >>> slope_dip(1.0, 1.0, 0.0), slope_dip(1.0, 1.0, 1.0)
    (0.5, 0.0)
    """
    if a * b <= 0.0 or (3.0 * mean - a - b) * a >= 0.0:
        return 0.0
    linear, square = 6.0 * mean - 4.0 * a - 2.0 * b, 3.0 * (a + b) - 6.0 * mean
    place = -0.5 * linear / square
    return place if 0.02 < place < 0.98 and (a + 0.5 * linear * place) * a < 0.0 else 0.0


def value_dip(behind: float, here: float, there: float, before: float, length: float) -> float:
    """Where the parabola through three values dips through zero and back between the last two, as a share, else 0.

    ``before`` and ``length`` are the lengths of the two intervals: tells a pair of zeros between two points.

    >>> value_dip(15.0, 1.0, 1.0, 1.0, 1.0), value_dip(3.0, 2.0, 1.0, 1.0, 1.0)
    (0.5, 0.0)
    """
    if not (behind * here > 0.0 and here * there > 0.0 and abs(here) < abs(behind)):
        return 0.0
    slope = (there - here) / length
    square = (slope - (here - behind) / before) / (before + length) * length * length
    linear = there - here - square
    if linear * here >= 0.0 or (linear + 2.0 * square) * here <= 0.0:
        return 0.0
    place = -0.5 * linear / square
    return place if 0.02 < place < 0.98 and (here + 0.5 * linear * place) * here < 0.0 else 0.0


def cubic_between(here: Point | Corrected, there: Point | Corrected, share: float, normal: Array) -> Array:
    """The cubic through two points with their tangents, a share of the way along a common normal."""
    chord = there.z - here.z
    length = chord.dot(normal)
    rest = 1.0 - share
    left = share * rest * rest * length / here.tangent.dot(normal)
    right = -share * share * rest * length / there.tangent.dot(normal)
    cubic: Array = here.z + (share * share * (3.0 - 2.0 * share)) * chord
    cubic += left * here.tangent + right * there.tangent
    return cubic


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
    q = -0.5 * (b + copysign(sqrt(discriminant), b))
    roots = [root for root in (c / q if q else 0.5, q / a if a else 0.5) if 0.0 < root < 1.0]
    return roots[0] if roots else 0.5
