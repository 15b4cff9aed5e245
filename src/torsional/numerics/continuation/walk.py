"""One trace of a curve under way: the next point, and what has happened since the last one."""

from __future__ import annotations

from collections.abc import Generator

from torsional.numerics.arrays import Array
from torsional.numerics.continuation.curves import Corrected, End, Point, Problem, Settings
from torsional.numerics.continuation.ends import SKEW, Span, Start, named
from torsional.numerics.continuation.events import Watch
from torsional.numerics.continuation.shape import arc_length, bend_between, slope_dip, value_dip

GROWTH, SHRINKAGE = 1.3, 0.6
FEW_ITERATIONS, MANY_ITERATIONS = 3, 6
CORNER = 100.0
"""A turn that a step of fewer smallest steps does not get below the largest angle is a corner of the curve."""


class Walk:
    """One trace under way: what stays the same along it, and the little it has to remember."""

    def __init__(self, problem: Problem, first: Corrected, span: tuple[float, float], settings: Settings) -> None:
        self.problem, self.settings, self.last = problem, settings, first.z.size - 1
        self.watch = Watch(problem, settings)
        self.span = Span(self.watch, span)
        self.limit = self.span.limit
        self.start = Start(self.watch, named(self.watch, self.watch.point(first, 0.0)))
        self.side, self.closing = 0.0, False  # of the plane through the start: of the last point; whether just crossed
        self.cruise = settings.first_step  # the last step that did not have to be shortened

    def points(self) -> Generator[Point, None, End]:
        """The points in order, events among them."""
        behind, here, step = None, self.start.point, self.settings.first_step
        yield here
        if self.span.left(here):
            return End.LEFT_RANGE
        for _ in range(self.settings.most_points - 1):
            there, step, smooth = self._ahead(behind, here, step)
            if there is None:
                return End.STEP_TOO_SMALL
            if self._quiet(here, there):
                yield there
            else:
                found, end = self._eventful(here, there)
                yield from found
                if end is not None:
                    return end
            behind, here = here if smooth else None, there
        return End.TOO_MANY_POINTS

    # --- the next point ---

    def _ahead(self, behind: Point | None, here: Point, step: float) -> tuple[Point | None, float, bool]:
        """The next point, the step to try after it, and whether the curve is smooth up to there."""
        last, span, limit, z, tangent = self.last, self.span, self.limit, here.z, here.tangent
        bend: Array | None = None
        if behind is not None:
            bend = (tangent - behind.tangent) * (0.5 / (here.arclength - behind.arclength))
        whole, dip = step, 0.0
        while step >= self.settings.smallest_step:
            guess = z + step * tangent
            if bend is not None:
                guess += (step * step) * bend
            if not span.lower <= guess.item(last) <= span.upper:
                bound = span.toward(here, guess)
                if bound is not None:
                    return bound, step, True
            got = self.problem.correct(guess, tangent)
            if not got.converged:
                step *= 0.5
                continue
            length, turn, skew = bend_between(here, got)
            smooth = turn <= limit and skew <= SKEW * limit
            if not smooth and not self._corner(step, length, turn, skew):
                step *= 0.5
                continue
            if smooth and not dip:
                dip = self._dip(behind, here, got, length)
                if dip:
                    step *= dip
                    continue
            if smooth and step == whole:
                self.cruise = step
            arclength = here.arclength + arc_length(length, turn)
            parameter = got.z.item(last) * self.watch.unit
            there = Point(got.z, got.tangent, got.values, parameter, arclength, got.iterations, got.residual)
            return there, self._longer(step, turn, got.iterations) if smooth else 0.5 * self.cruise, smooth
        return None, step, False

    def _longer(self, step: float, turn: float, iterations: int) -> float:
        """The step after a good one: by its iterations, and such that the next angle stays within the limit."""
        factor = GROWTH if iterations <= FEW_ITERATIONS else 1.0 if iterations < MANY_ITERATIONS else SHRINKAGE
        if turn * factor > 0.9 * self.limit:
            factor = 0.9 * self.limit / turn
        return min(max(step * factor, self.settings.smallest_step), self.settings.largest_step)

    def _corner(self, step: float, length: float, turn: float, skew: float) -> bool:
        """Whether a very short step turns a corner: the chord lies between two tangents less than 90° apart."""
        near = step < CORNER * self.settings.smallest_step and length < 3.0 * step
        return near and turn < 1.4 and skew < 0.6 * turn

    def _dip(self, behind: Point | None, here: Point, got: Corrected, length: float) -> float:
        """Where between two points a pair of folds or of zeros of a test seems to hide, as a share of the way, or 0."""
        last = self.last
        mean = (got.z.item(last) - here.z.item(last)) / length
        dip = slope_dip(here.tangent.item(last), got.tangent.item(last), mean)
        if dip or behind is None or not self.problem.tests:
            return dip
        before = here.arclength - behind.arclength
        values = zip(behind.values.tolist(), here.values.tolist(), got.values.tolist(), strict=True)
        for first, second, third in values:
            if abs(second) < abs(first) and (dip := value_dip(first, second, third, before, length)):
                return dip
        return 0.0

    # --- between two points ---

    def _quiet(self, here: Point, there: Point) -> bool:
        """Whether there is nothing to look for between two points."""
        side, self.side = self.side, there.z.dot(self.start.normal) - self.start.offset
        self.closing = bool(side < 0.0 <= self.side)
        if self.closing or not self.span.lower < there.z.item(self.last) < self.span.upper:
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
        end = None
        closed = self.start.met(here, there) if self.closing else None
        if closed is not None:
            there, end = closed, End.CLOSED
        found = self.watch.events(here, there)
        out = next((point for point in (*found, there) if self.span.left(point)), None)
        if out is not None:
            there, end = self.span.before(here, out), End.LEFT_RANGE
        found = self._merged(here, there, found)
        for number, point in enumerate(found):
            if point.event in self.settings.terminal:
                return found[: number + 1], End.TERMINAL
        return found, end

    def _merged(self, here: Point, there: Point, events: list[Point]) -> list[Point]:
        """The events before a point, and that point, which takes the name of an event that coincides with it."""
        margin = self.watch.tolerance(here, there)
        found = []
        for event in events:
            if event.arclength < there.arclength - margin:
                found.append(event)
            elif event.arclength < there.arclength + margin and not self.start.named_again(there, event.event):
                there = there._replace(event=there.event or event.event, within=event.within)
        return [*found, there]
