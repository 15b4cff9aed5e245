"""One trace of a curve under way: the next point, and what has happened between two points."""

from __future__ import annotations

from collections.abc import Generator
from math import sin, sqrt

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.curve_events import Measure, crosses, guess_at, locate, share_of_fold
from torsional.numerics.curves import FOLD, Corrected, End, Point, Problem, Settings

GROWTH, SHRINKAGE = 1.3, 0.6
FEW_ITERATIONS, MANY_ITERATIONS = 3, 6
NEARLY = 1e-6
"""Below this a component of the tangent or a test value of the start may be a zero blurred by rounding."""


def point_at(problem: Problem, got: Corrected | Point, arclength: float, event: str = "", within: float = 0.0) -> Point:
    """What was corrected, as a point of the curve."""
    parameter = got.z.item(got.z.size - 1) * float(problem.scale[-1])
    return Point(got.z, got.tangent, got.values, parameter, arclength, got.iterations, got.residual, event, within)


def bend_between(here: Point, got: Corrected | Point) -> tuple[float, float, float]:
    """Length of the chord, angle between the tangents, and the sum of the angles of both with the chord [rad].

    On an arc the last two are equal; a chord to another branch is askew to both tangents.  Angles are their chords on
    the circle of radius one, 2 sin(angle / 2).
    """
    chord = got.z - here.z
    length = sqrt(chord.dot(chord))
    if length == 0.0:
        return 0.0, 0.0, 2.0
    turn = sqrt(abs(2.0 - 2.0 * float(here.tangent.dot(got.tangent))))
    first = sqrt(abs(2.0 - 2.0 * float(chord.dot(here.tangent)) / length))
    second = sqrt(abs(2.0 - 2.0 * float(chord.dot(got.tangent)) / length))
    return length, turn, first + second


def dip_between(a: float, b: float, mean: float) -> float:
    """Where a parabola with values a at 0, b at 1 and that mean dips through zero and back, else 0.

    >>> dip_between(1.0, 1.0, 0.0), dip_between(1.0, 1.0, 1.0)
    (0.5, 0.0)
    """
    if a * b <= 0.0 or (3.0 * mean - a - b) * a >= 0.0:
        return 0.0
    linear, square = 6.0 * mean - 4.0 * a - 2.0 * b, 3.0 * (a + b) - 6.0 * mean
    place = -0.5 * linear / square
    return place if 0.02 < place < 0.98 and (a + 0.5 * linear * place) * a < 0.0 else 0.0


class Walk:
    """One trace under way: what stays the same along it, and on which side of the start's plane the last point was."""

    def __init__(self, problem: Problem, start: Point, span: tuple[float, float], settings: Settings) -> None:
        self.problem, self.settings, self.last = problem, settings, start.z.size - 1
        self.unit = float(problem.scale[-1])
        self.span = span
        self.lower, self.upper = span[0] / self.unit, span[1] / self.unit
        self.limit = 2.0 * sin(0.5 * settings.largest_angle)
        self.cruise = settings.first_step  # the last step that did not have to be shortened
        self.start = self._named(start)
        self.offset, self.side, self.closing = float(start.z.dot(start.tangent)), 0.0, False

    def points(self) -> Generator[Point, None, End]:
        """The points in order, events among them."""
        here, step, bend = self.start, self.settings.first_step, None
        yield here
        if self._leaves(here):
            return End.LEFT_RANGE
        for _ in range(self.settings.most_points - 1):
            there, step, smooth = self._ahead(here, step, bend)
            if there is None:
                return End.STEP_TOO_SMALL
            if self._quiet(here, there):
                yield there
            else:
                found, end = self._eventful(here, there)
                yield from found
                if end is not None:
                    return end
            bend = (there.tangent - here.tangent) * (0.5 / (there.arclength - here.arclength)) if smooth else None
            here = there
        return End.TOO_MANY_POINTS

    # --- the next point ---

    def _ahead(self, here: Point, step: float, bend: Array | None) -> tuple[Point | None, float, bool]:
        """The next point, the step to try after it, and whether the curve is smooth up to there."""
        last, limit, whole, dipped = self.last, self.limit, step, False
        z, tangent = here.z, here.tangent
        while step >= self.settings.smallest_step:
            guess = z + step * tangent
            if bend is not None:
                guess += (step * step) * bend
            if not self.lower <= guess.item(last) <= self.upper:
                bound = self._bound(here, guess)
                if bound is not None:
                    return bound, step, True
            got = self.problem.correct(guess, tangent)
            if not got.converged:
                step *= 0.5
                continue
            length, turn, bow = bend_between(here, got)
            smooth = turn <= limit and bow <= turn + 0.5 * limit
            if not smooth and not self._corner(here, got, step):
                step *= 0.5
                continue
            parameter = got.z.item(last)
            dip = dip_between(tangent.item(last), got.tangent.item(last), (parameter - z.item(last)) / length)
            if dip and smooth and not dipped:
                step, dipped = dip * step, True
                continue
            arclength = here.arclength + length * (1.0 + turn * turn / 24.0)
            there = Point(
                got.z, got.tangent, got.values, parameter * self.unit, arclength, got.iterations, got.residual
            )
            if step == whole:
                self.cruise = step
            return there, self._longer(step, turn, got.iterations) if smooth else 0.5 * self.cruise, smooth
        return None, step, False

    def _longer(self, step: float, turn: float, iterations: int) -> float:
        """The step after a good one: by its iterations, and such that the next angle stays within the limit."""
        factor = GROWTH if iterations <= FEW_ITERATIONS else 1.0 if iterations < MANY_ITERATIONS else SHRINKAGE
        if turn * factor > 0.9 * self.limit:
            factor = 0.9 * self.limit / turn
        return min(step * factor, self.settings.largest_step)

    def _corner(self, here: Point, got: Corrected, step: float) -> bool:
        """Whether the smallest step turns a corner: there another branch cannot be meant."""
        chord = got.z - here.z
        near = step < 2.0 * self.settings.smallest_step and sqrt(chord.dot(chord)) < 3.0 * step
        return near and float(got.tangent.dot(here.tangent)) > 0.0 and float(got.tangent.dot(chord)) > 0.0

    def _bound(self, here: Point, guess: Array) -> Point | None:
        """The point exactly on the bound beyond which the guess lies, if it follows smoothly."""
        last = self.last
        upper = guess.item(last) > self.upper
        bound = self.upper if upper else self.lower
        share = (bound - here.z.item(last)) / (guess.item(last) - here.z.item(last))
        return self._on_bound(here, here.z + share * (guess - here.z), upper)

    def _on_bound(self, here: Point, guess: Array, upper: bool) -> Point | None:
        """The guess corrected with its parameter on a bound."""
        guess[self.last] = self.upper if upper else self.lower
        axis = np.zeros(guess.size)
        axis[self.last] = 1.0 if upper else -1.0
        got = self.problem.correct(guess, axis)
        if not got.converged:
            return None
        length, turn, bow = bend_between(here, got)
        if turn > self.limit or bow > turn + 0.5 * self.limit:
            return None
        z = got.z.copy()
        z[self.last] = guess[self.last]
        there = point_at(self.problem, got, here.arclength + length * (1.0 + turn * turn / 24.0))
        return there._replace(z=z, parameter=float(self.span[upper]))

    # --- between two points ---

    def _quiet(self, here: Point, there: Point) -> bool:
        """Whether there is nothing to look for between two points."""
        side, self.side = self.side, there.z.dot(self.start.tangent) - self.offset
        self.closing = bool(side < 0.0 <= self.side)
        if self.closing or not self.lower < there.z.item(self.last) < self.upper:
            return False
        before, after = here.tangent.item(self.last), there.tangent.item(self.last)
        if before < 0.0 <= after or before > 0.0 >= after:
            return False
        for before, after in zip(here.values.tolist(), there.values.tolist(), strict=True):
            if before < 0.0 <= after or before > 0.0 >= after:
                return False
        return True

    def _eventful(self, here: Point, there: Point) -> tuple[list[Point], End | None]:
        """The events up to the next point and that point, or up to where the trace ends, and why it ends."""
        end, closed = None, self._closed(here, there) if self.closing else None
        if closed is not None:
            there, end = closed, End.CLOSED
        found = [*self._events(here, there)]
        out = next((point for point in [*found, there] if self._leaves(point)), None)
        if out is not None:
            there, end = self._bound_before(here, out), End.LEFT_RANGE
        found = self._before(here, there, found)
        for number, point in enumerate(found):
            if point.event in self.settings.terminal:
                return found[: number + 1], End.TERMINAL
        return found, end

    def _before(self, here: Point, there: Point, events: list[Point]) -> list[Point]:
        """The events before a point, and that point, which takes the name of an event that coincides with it."""
        margin = self._tolerance(here, there)
        found = []
        for event in events:
            if event.arclength < there.arclength - margin:
                found.append(event)
            elif event.arclength < there.arclength + margin and not self._known(there, event.event):
                there = there._replace(event=event.event, within=event.within)
        return [*found, there]

    def _known(self, there: Point, name: str) -> bool:
        """Whether the start, met again at the end of a closed curve, had that name already."""
        return there.event != "" or (there.z is self.start.z and self.start.event == name)

    def _events(self, here: Point, there: Point) -> list[Point]:
        """The events between two points in their order."""
        found = []
        for name, measure in self._measures():
            if crosses(measure(here), measure(there)):
                share = share_of_fold(here, there) if name == FOLD else None
                found.append(self._event(here, there, name, measure, share))
        return sorted(found, key=lambda point: point.arclength)

    def _event(self, here: Point, there: Point, name: str, measure: Measure, share: float | None = None) -> Point:
        tolerance = self._tolerance(here, there)
        found = locate(self.problem, here, there, measure, tolerance, share)
        length, turn, _ = bend_between(here, found.point)
        arclength = here.arclength + length * (1.0 + turn * turn / 24.0)
        return point_at(self.problem, found.point, arclength, name, found.within)

    def _measures(self) -> list[tuple[str, Measure]]:
        """Every event's name and the function of a point that is zero there."""
        tests = [(name, _value(number)) for number, name in enumerate(self.problem.tests)]
        return [(FOLD, _slope), *tests]

    def _tolerance(self, here: Point, there: Point) -> float:
        size = max(float(np.linalg.norm(there.z)), there.arclength - here.arclength)
        return self.settings.tolerance * size

    # --- where the trace begins and ends ---

    def _leaves(self, point: Point) -> bool:
        """Whether a point is outside of the span, or on its bound and on the way out; a fold may touch a bound."""
        p, slope = point.z.item(self.last), point.tangent.item(self.last)
        slack = self.settings.tolerance * max(1.0, abs(p)) if point.event == FOLD else 0.0
        outside = p > self.upper + slack or p < self.lower - slack
        return outside or (not slack and ((p == self.upper and slope > 0.0) or (p == self.lower and slope < 0.0)))

    def _bound_before(self, here: Point, out: Point) -> Point:
        """The point on the bound between a point inside and one that leaves."""
        upper = out.z.item(self.last) >= self.upper
        bound = self.upper if upper else self.lower
        if out.z.item(self.last) == bound:
            return out
        crossing = self._event(here, out, "", lambda point: point.z.item(self.last) - bound)
        exact = self._on_bound(here, crossing.z.copy(), upper)
        return exact or crossing._replace(parameter=float(self.span[upper]), within=0.0)

    def _closed(self, here: Point, there: Point) -> Point | None:
        """The start once again, if the curve comes through it between two points that are on both sides of it."""
        start, normal = self.start, self.start.tangent
        chord = there.z - here.z
        if np.linalg.norm(start.z - here.z) > 2.0 * np.linalg.norm(chord):
            return None
        share = float((self.offset - here.z.dot(normal)) / chord.dot(normal))
        guess = guess_at(here, there, share)
        got = self.problem.correct(guess - normal * (guess.dot(normal) - self.offset), normal)
        if not got.converged or np.linalg.norm(got.z - start.z) > 1e3 * self._tolerance(here, there):
            return None
        length, turn, _ = bend_between(here, start)
        return start._replace(arclength=here.arclength + length * (1.0 + turn * turn / 24.0), event="", within=0.0)

    def _named(self, start: Point) -> Point:
        """The start, with its name and an exact zero where it is an event itself, to the tolerance."""
        for name, measure in self._measures():
            if abs(measure(start)) > NEARLY:
                continue
            reach = 0.1 * self.settings.first_step * start.tangent
            behind = self.problem.correct(start.z - reach, start.tangent)
            ahead = self.problem.correct(start.z + reach, start.tangent)
            if behind.converged and ahead.converged and crosses(measure(behind), measure(ahead)):
                low, high = point_at(self.problem, behind, 0.0), point_at(self.problem, ahead, 0.0)
                event = self._event(low, high, name, measure)
                if np.linalg.norm(event.z - start.z) <= 10.0 * self._tolerance(low, high):
                    start = self._zeroed(start, name, event.within)
        return start

    def _zeroed(self, start: Point, name: str, within: float) -> Point:
        tangent, values = start.tangent.copy(), start.values.copy()
        if name == FOLD:
            tangent[self.last] = 0.0
        else:
            values[self.problem.tests.index(name)] = 0.0
        return start._replace(tangent=tangent, values=values, event=start.event or name, within=within)


def _slope(point: Point | Corrected) -> float:
    """The parameter's part of the tangent: zero at a fold."""
    return point.tangent.item(point.tangent.size - 1)


def _value(number: int) -> Measure:
    """One test function's value at a point."""
    return lambda point: point.values.item(number)
