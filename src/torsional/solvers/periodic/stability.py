"""Floquet multipliers along branches: segment by segment between the crossings of the stages, or by sampled tangents."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from torsional.laws import Hinges
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.balance import forces_along
from torsional.numerics.floquet import multipliers
from torsional.numerics.piecewise_basis import StageBases
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.problem import HarmonicProblem

MARGIN = 1e-6
"""A multiplier counts as outside of the unit circle beyond this excess."""


@lru_cache(maxsize=64)
def stage_bases(split: Split) -> StageBases:
    """The linear systems between the hinges, made once for all branches of a system whose laws are all hinges."""
    s = split.system.switched(split.speed)
    w = split.weights
    stiffness = s.K + split.speed**2 * s.S
    return StageBases(s.M, s.C, stiffness, w, [law.parameters for law in split.laws], split.rigid)


def motion_at(harmonics: ComplexArray, tau: Array) -> Array:
    """Angles (m, times) of harmonics (m, H + 1) at τ."""
    turns = np.exp(1j * np.multiply.outer(np.arange(harmonics.shape[1]), tau))
    return np.asarray((harmonics @ turns).real)


def crossings_along(problem: HarmonicProblem, points: Array) -> tuple[list[Array], list[IntArray]]:
    """Angles τ of the crossings of each scaled point, ascending, and the stages (crossings, m) that follow them."""
    m, count = problem.connections, problem.harmonics
    forces = np.empty((len(points), m, count + 1), dtype=complex)
    found, number = np.empty((len(points), m, 4 * count + 16, 3)), np.empty((len(points), m))
    forces_along(problem.balance, points, forces, found, number)
    harmonics = problem.harmonics_of(points)
    edges = [np.unique(law.gaps) if isinstance(law, Hinges) else np.zeros(0) for law in problem.setting.split.laws]
    times: list[Array] = []
    stages: list[IntArray] = []
    for i in range(len(points)):
        at = np.unique(np.concatenate([found[i, e, : int(number[i, e]), 0] for e in range(m)]))
        middles = at + 0.5 * np.diff(at, append=at[0] + 2 * np.pi) if at.size else np.zeros(1)
        angles = motion_at(harmonics[i], middles)
        times.append(at)
        stages.append(np.stack([np.searchsorted(edge, own) for edge, own in zip(edges, angles, strict=True)], axis=1))
    return times, stages


def branch_multipliers(problem: HarmonicProblem, points: Array) -> ComplexArray:
    """Floquet multipliers (points, states) over the period of the problem's base order, by falling modulus."""
    return np.concatenate([_multipliers(piece, points[run]) for run, piece in problem.pieces(points)])


def _multipliers(problem: HarmonicProblem, points: Array) -> ComplexArray:
    split = problem.setting.split
    times, stages = crossings_along(problem, points)
    value = points[:, -1] * problem.scale[-1]
    speed = value if problem.setting.speed is None else np.full(len(points), problem.setting.speed)
    pace = problem.base_order * speed
    bases = stage_bases(split)
    return multipliers(bases, [t / p for t, p in zip(times, pace, strict=True)], stages, 2 * np.pi / pace)
