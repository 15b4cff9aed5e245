"""Whether the motions along a branch are stable, and how far the multipliers can be trusted.

Multipliers come from the crossings of a motion of few harmonics.  The determinants of the balance tell besides whether
an odd number of them lies beyond +1 (the sign of det J) and beyond −1 (that of the odd half orders).  Where the two
disagree by a multiplier that is all but on the circle, the determinants decide; elsewhere the motion is closed in time
by Newton's method, whose crossings are exact, and asked again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.continuation.following import Point
from torsional.numerics.piecewise.monodromy import ordered
from torsional.solvers.periodic.problem import BoolArray, HarmonicProblem
from torsional.solvers.periodic.stability import MARGIN, branch_multipliers, exact_motion
from torsional.solvers.periodic.states import states

ANOTHER = 0.05
"""Relative distance from the balance's motion beyond which the exact one found is another."""
CLOSE = 0.02
"""Distance from ±1 within which a real multiplier may lie on either side."""


class Verdict(NamedTuple):
    """``multipliers`` (points, states), whether each point is ``stable``, and whether that was ``confirmed``."""

    multipliers: ComplexArray
    stable: BoolArray
    confirmed: BoolArray


def verdict(problem: HarmonicProblem, points: Sequence[Point]) -> Verdict:
    """The stability of points of a branch."""
    scaled = np.array([point.z for point in points])
    found = branch_multipliers(problem, scaled)
    stable, confirmed = np.zeros(len(points), dtype=bool), np.ones(len(points), dtype=bool)
    for i, point in enumerate(points):
        told = _told(found[i], point, problem)
        if told is None and problem.setting.split.straight and not point.event:
            closed = _closed(problem, scaled[i])
            if closed is not None:
                found[i] = closed
                told = _told(closed, point, problem)
        confirmed[i] = told is not None or bool(point.event)
        stable[i] = not _outside(found[i]).any() if told is None else told
    return Verdict(found, stable, confirmed)


def _outside(values: ComplexArray) -> BoolArray:
    return np.asarray(np.abs(values) > 1 + MARGIN)


def _told(values: ComplexArray, point: Point, problem: HarmonicProblem) -> bool | None:
    """Whether a point is stable, or None where multipliers and determinants contradict each other."""
    outside, real = _outside(values), np.abs(values.imag) <= 1e-9
    unstable = bool((outside & ~real).any())
    tests = [(1.0, float(point.values[0]) * float(point.tangent[-1]))] if len(point.values) else []
    if len(problem.tests) > 1:
        tests.append((-1.0, float(point.values[1])))
    else:
        unstable |= bool((outside & real & (values.real < 0)).any())
    for side, determinant in tests:
        own = values.real[real] * side
        count = int(np.count_nonzero(own > 1 + MARGIN))
        if count % 2 != int(determinant < 0):
            if not (np.abs(own - 1.0) < CLOSE).any():
                return None
            count += 1 if determinant < 0 else -1
        unstable |= count > 0
    return not unstable


def _closed(problem: HarmonicProblem, z: Array) -> ComplexArray | None:
    """Multipliers of the exact motion near a scaled point, or None where Newton's method does not close one."""
    timed = exact_motion(problem, z)
    told = states(problem, z[None]).coordinates[0]
    speed = float(z[-1] * problem.scale[-1]) if problem.setting.speed is None else problem.setting.speed
    pace = 1j * problem.base_order * speed * np.arange(len(told))
    base = timed.bases.coordinates
    start = base.state(told.real.sum(axis=0), (pace[:, None] * told).real.sum(axis=0))
    try:
        closed = timed.shoot(start)
    except (ArithmeticError, ValueError):
        return None
    moved = float(np.abs(closed.state - start).max()) / max(float(np.abs(start).max()), 1e-300)
    if not closed.converged or moved > ANOTHER:
        return None
    return ordered(np.linalg.eigvals(closed.monodromy))
