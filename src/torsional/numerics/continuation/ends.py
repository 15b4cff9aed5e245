"""Where a trace begins and ends: an event at the start, the bounds of the parameter, a curve that closes."""

from __future__ import annotations

from math import sin

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.continuation.curves import FOLD, Corrected, Point
from torsional.numerics.continuation.events import Watch, crosses
from torsional.numerics.continuation.shape import arc_between, bend_between, cubic_between

NEARLY = 1e-6
"""Below this a component of the tangent or a test value of the start may be a zero blurred by rounding."""

SKEW = 0.25
"""How skew a chord may be, in largest angles: what tells a step to a neighbouring branch."""


def follows(here: Point, got: Corrected | Point, limit: float) -> bool:
    """Whether a point continues the curve: tangents within the limit, the chord not skew to them."""
    _, turn, skew = bend_between(here, got)
    return turn <= limit and skew <= SKEW * limit


def named(watch: Watch, start: Point) -> Point:
    """The start, with its name and an exact zero where it is an event itself, to the tolerance.

    Rounding gives the zero of a start on an event a sign at random; without this the event would be met at once, or
    never.
    """
    for number, (name, measure) in enumerate(watch.measures):
        if abs(measure(start)) > NEARLY:
            continue
        reach = 0.1 * watch.settings.first_step * start.tangent
        behind = watch.problem.correct(start.z - reach, start.tangent)
        ahead = watch.problem.correct(start.z + reach, start.tangent)
        if behind.converged and ahead.converged and crosses(measure(behind), measure(ahead)):
            low, high = watch.point(behind, 0.0), watch.point(ahead, 0.0)
            event = watch.located(low, high, name, measure)
            if np.linalg.norm(event.z - start.z) <= 10.0 * watch.tolerance(low, high):
                start = _zeroed(start, number)._replace(event=start.event or name, within=event.within)
    return start


def _zeroed(start: Point, number: int) -> Point:
    """The start with one measure exactly zero: the slope of the parameter, then the tests."""
    tangent, values = start.tangent.copy(), start.values.copy()
    if number == 0:
        tangent[-1] = 0.0
    else:
        values[number - 1] = 0.0
    return start._replace(tangent=tangent, values=values)


class Start:
    """The start of a trace and the plane across the curve there, in which a closed curve comes back."""

    def __init__(self, watch: Watch, start: Point) -> None:
        self.watch, self.point, self.normal = watch, start, start.tangent
        self.offset = float(start.z.dot(start.tangent))

    def met(self, here: Point, there: Point) -> Point | None:
        """The start once again, if the curve comes through it between two points on both sides of the plane."""
        chord = there.z - here.z
        if np.linalg.norm(self.point.z - here.z) > 2.0 * np.linalg.norm(chord):
            return None
        share = float((self.offset - here.z.dot(self.normal)) / chord.dot(self.normal))
        guess = cubic_between(here, there, share, here.tangent)
        guess -= self.normal * (guess.dot(self.normal) - self.offset)
        got = self.watch.problem.correct(guess, self.normal)
        if not got.converged or np.linalg.norm(got.z - self.point.z) > 1e3 * self.watch.tolerance(here, there):
            return None
        arclength = here.arclength + arc_between(here, self.point)
        return self.point._replace(arclength=arclength, event="", within=0.0)

    def named_again(self, there: Point, name: str) -> bool:
        """Whether a point is the start met again, which had that name already."""
        return there.z is self.point.z and self.point.event == name


class Span:
    """The bounds of the parameter, physical and scaled."""

    def __init__(self, watch: Watch, span: tuple[float, float]) -> None:
        self.watch, self.physical = watch, span
        self.lower, self.upper = span[0] / watch.unit, span[1] / watch.unit
        self.limit = 2.0 * sin(0.5 * watch.settings.largest_angle)

    def left(self, point: Point) -> bool:
        """Whether a point is outside, or on a bound and on the way out; a fold may touch a bound."""
        p, slope = point.z.item(point.z.size - 1), point.tangent.item(point.z.size - 1)
        slack = self.watch.settings.tolerance * max(1.0, abs(p)) if point.event == FOLD else 0.0
        if p > self.upper + slack or p < self.lower - slack:
            return True
        return not slack and ((p == self.upper and slope > 0.0) or (p == self.lower and slope < 0.0))

    def toward(self, here: Point, guess: Array) -> Point | None:
        """The point exactly on the bound beyond which a guess lies, if the curve goes there smoothly."""
        last = guess.size - 1
        upper = guess.item(last) > self.upper
        way = (self.upper if upper else self.lower) - here.z.item(last)
        share = way / (guess.item(last) - here.z.item(last))
        return self._on_bound(here, here.z + share * (guess - here.z), upper)

    def before(self, here: Point, out: Point) -> Point:
        """The point exactly on the bound between a point inside and one that leaves."""
        upper = out.z.item(out.z.size - 1) >= self.upper
        bound = self.upper if upper else self.lower
        if out.z.item(out.z.size - 1) == bound:
            return out
        crossing = self.watch.located(here, out, "", lambda point: float(point.z[-1]) - bound)
        exact = self._on_bound(here, crossing.z.copy(), upper)
        return exact or self._exactly(crossing, upper)

    def _on_bound(self, here: Point, guess: Array, upper: bool) -> Point | None:
        guess[-1] = self.upper if upper else self.lower
        axis = np.zeros(guess.size)
        axis[-1] = 1.0 if upper else -1.0
        got = self.watch.problem.correct(guess, axis)
        if not got.converged or not follows(here, got, self.limit):
            return None
        return self._exactly(self.watch.point(got, here.arclength + arc_between(here, got)), upper)

    def _exactly(self, point: Point, upper: bool) -> Point:
        """A point on the bound to rounding, moved exactly there."""
        z = point.z.copy()
        z[-1] = self.upper if upper else self.lower
        return point._replace(z=z, parameter=float(self.physical[upper]), within=0.0)
