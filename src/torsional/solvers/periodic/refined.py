"""Branches with points at values of the parameter that were asked for, between those that the continuation chose."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import Point
from torsional.solvers.periodic.branches import Branch

REACH = 0.5
"""Share of a step that a corrected point may lie away from the straight line: beyond, it is on another branch."""


def refined(branch: Branch, values: ArrayLike) -> Branch:
    """A branch with a point wherever it passes one of the ``values`` of its parameter, each corrected there.

    A value at which the corrector fails, or finds another branch, is left out.
    """
    wanted = np.unique(np.asarray(values, dtype=float))
    if not wanted.size:
        return branch
    wanted = wanted[np.append(True, np.diff(wanted) > 1e-9 * np.abs(wanted[1:]))]  # 940 rpm in two roundings is one
    points = list(branch.points[:1])
    for start, end in pairwise(branch.points):
        points += [*_between(branch, start, end, wanted), end]
    return replace(branch, points=tuple(points))


def _between(branch: Branch, start: Point, end: Point, wanted: Array) -> Iterator[Point]:
    """Points between two neighbours, in the order of the branch."""
    low, high = sorted((start.parameter, end.parameter))
    near = 1e-9 * max(abs(low), abs(high))
    inside = wanted[(wanted > low + near) & (wanted < high - near)]
    step = end.z - start.z
    for value in inside if end.parameter > start.parameter else inside[::-1]:
        share = (value - start.parameter) / (end.parameter - start.parameter)
        guess = start.z + share * step
        found = branch.problem.at(guess, float(value))
        if found.converged and np.linalg.norm(found.z - guess) <= REACH * np.linalg.norm(step):
            arclength = start.arclength + share * (end.arclength - start.arclength)
            side = 1.0 if found.tangent @ step > 0 else -1.0  # the bordered determinant turns with the tangent
            tangent, told = side * found.tangent, found.values[: len(start.values)].copy()
            told[:1] *= side
            yield Point(found.z, tangent, told, float(value), arclength, found.iterations, found.residual)
