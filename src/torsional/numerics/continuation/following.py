"""Continuation of F(x, p) = 0: a generator of points along a curve, with step control, events and reasons to end."""

from __future__ import annotations

import math
from collections.abc import Generator

import numpy as np

from torsional.errors import ModelError, nearest
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.curves import FOLD, Corrected, End, Point, Problem, Settings, Trace
from torsional.numerics.continuation.equations import Equations, branch_test
from torsional.numerics.continuation.walk import Walk

__all__ = [
    "FOLD",
    "Corrected",
    "End",
    "Equations",
    "Point",
    "Problem",
    "Settings",
    "Trace",
    "both_ways",
    "branch_test",
    "followed",
    "steps",
]

EVERYWHERE = (-math.inf, math.inf)


def steps(
    problem: Problem,
    start: Array,
    direction: int = 1,
    span: tuple[float, float] = EVERYWHERE,
    settings: Settings | None = None,
    *,
    heading: Array | None = None,
) -> Generator[Point, None, End]:
    """Points along the curve F(x, p) = 0 through a start, one at a time; returns why it ended.

    ``start`` (n + 1,) is a solution or a guess of one in scaled variables; ``direction`` +1 begins with a growing
    parameter, −1 with a falling one; ``span`` are the bounds of the parameter, physical.  With a ``heading`` (n + 1,)
    the start is corrected across it instead of at its parameter, and +1 means along it: the way onto a branch that
    leaves another one.  Raises ModelError for a start outside of the span and for an unknown terminal event.

    Pseudo-arclength: a point is predicted along tangent and curvature, and corrected by Newton's method in the plane
    across the tangent.  Steps grow by 1.3 after at most 3 iterations, shrink by 0.6 after 6 and more, and are halved
    where the corrector fails or the curve turns too far.  Source: Allgower and Georg, Introduction to Numerical
    Continuation Methods, SIAM 2003, doi 10.1137/1.9780898719154.

    A quarter of the circle x² + p² = 1, from its top to where p = 1 is a fold:

    >>> circle = Equations(lambda x, p: x**2 + p**2 - 1.0, scale=[1.0, 1.0])
    >>> walk = steps(circle, np.array([1.0, 0.0]), settings=Settings(terminal=("fold",)))
    >>> [*walk][-1].z.round(9) + 0.0
    array([0., 1.])
    """
    settings = settings or Settings()
    start = _checked(problem, np.array(start, dtype=float), direction, span, settings)
    first = _first(problem, start, float(direction), heading, settings)
    if first is None:
        return End.START_FAILED
    return (yield from Walk(problem, first, span, settings).points())


def followed(
    problem: Problem,
    start: Array,
    direction: int = 1,
    span: tuple[float, float] = EVERYWHERE,
    settings: Settings | None = None,
    *,
    heading: Array | None = None,
) -> Trace:
    """The whole curve from a start to where it ends; arguments and errors as in ``steps``.

    >>> circle = Equations(lambda x, p: x**2 + p**2 - 1.0, scale=[1.0, 1.0])
    >>> trace = followed(circle, np.array([1.0, 0.0]))
    >>> trace.end.name, [(point.event, round(point.parameter, 9)) for point in trace.events]
    ('CLOSED', [('fold', 1.0), ('fold', -1.0)])
    """
    walk = steps(problem, start, direction, span, settings, heading=heading)
    points: list[Point] = []
    while True:
        try:
            points.append(next(walk))
        except StopIteration as stop:
            return Trace(tuple(points), stop.value, problem.scale)


def both_ways(
    problem: Problem,
    start: Array,
    span: tuple[float, float] = EVERYWHERE,
    settings: Settings | None = None,
    *,
    heading: Array | None = None,
) -> Trace:
    """The curve on both sides of a start as one trace, in the direction of a growing parameter at the start.

    Arguments and errors as in ``steps``.  Points before the start have a negative arclength; their tangents point
    along the trace, their test values are those met on the way back.

    >>> line = Equations(lambda x, p: x - p, scale=[1.0, 1.0])
    >>> trace = both_ways(line, np.zeros(2), (-1.0, 1.0))
    >>> trace.began.name, trace.end.name, trace.parameter[[0, -1]]
    ('LEFT_RANGE', 'LEFT_RANGE', array([-1.,  1.]))
    """
    forward = followed(problem, start, 1, span, settings, heading=heading)
    if not forward.points or forward.end is End.CLOSED:
        return forward
    first = forward.points[0]
    if math.isnan(_snapped(problem, first.z, span)):  # a heading led out of the span
        return forward
    backward = followed(problem, first.z, 1, span, settings, heading=-first.tangent)
    turned = [point._replace(tangent=-point.tangent, arclength=-point.arclength) for point in backward.points[:0:-1]]
    return Trace((*turned, *forward.points), forward.end, problem.scale, backward.end)


def _checked(problem: Problem, start: Array, direction: int, span: tuple[float, float], settings: Settings) -> Array:
    scale = problem.scale
    if start.shape != scale.shape or not np.all(np.isfinite(start)):
        raise ModelError(
            "must be finite, one for each scale", where="start", found=repr(start), allowed=f"{scale.shape}"
        )
    found = repr(float(start[-1] * scale[-1]))
    if direction not in (1, -1):
        raise ModelError("must be 1 or -1", where="direction", found=repr(direction))
    if not span[0] < span[1]:
        raise ModelError("the lower bound must be below the upper one", where="span", found=repr(span))
    start[-1] = _snapped(problem, start, span)
    if math.isnan(start[-1]):
        raise ModelError("lies outside of the span", where="start", found=found, allowed=f"{span[0]} to {span[1]}")
    known = (FOLD, *problem.tests)
    for name in settings.terminal:
        if name not in known:
            raise ModelError(
                "is not an event of this problem", where="terminal", found=name, remedy=nearest(name, known)
            )
    return start


def _snapped(problem: Problem, z: Array, span: tuple[float, float]) -> float:
    """The scaled parameter, exactly on a bound that it equals but for rounding; NaN outside."""
    p, unit = float(z[-1]), float(problem.scale[-1])
    for bound in (span[0] / unit, span[1] / unit):
        if math.isfinite(bound) and abs(p - bound) <= 1e-12 * max(1.0, abs(bound)):
            return bound
    return p if span[0] / unit < p < span[1] / unit else math.nan


def _first(problem: Problem, start: Array, way: float, heading: Array | None, settings: Settings) -> Corrected | None:
    """The start corrected, its tangent along the way; at a fold, where the parameter cannot be held, near it."""
    axis = np.zeros(start.size)
    axis[-1] = way
    if heading is not None:
        got = problem.correct(start, way * heading / np.linalg.norm(heading))
        return got if got.converged else None
    random = np.random.default_rng(0).standard_normal((3, start.size))
    for normal in (axis, *(way * random / np.linalg.norm(random, axis=1)[:, np.newaxis])):
        got = problem.correct(start, normal)
        if got.converged and abs(got.z[-1] - start[-1]) <= settings.first_step:
            break
    else:
        return None
    if got.tangent[-1] * way < 0.0:
        got = problem.correct(got.z, -got.tangent)
    return got
