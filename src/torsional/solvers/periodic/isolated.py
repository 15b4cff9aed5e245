"""Branches that hang together with none of those known: sought along other parameters, and from motions in time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import Settings, followed
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.solvers.periodic.branches import DOUBLED, MAIN, Branch, Explorer
from torsional.solvers.periodic.curves import DOUBLING
from torsional.solvers.periodic.detours import detours
from torsional.solvers.periodic.problem import HarmonicProblem, Setting
from torsional.solvers.periodic.stability import exact_motion
from torsional.solvers.periodic.states import states

PLACES, STARTS, LONGEST = 5, 6, 3
"""Values of the parameter at which is sought, starting states at each, longest period in periods of the excitation."""
AWAY = Settings(first_step=0.02, largest_step=0.2, most_points=300)
MOST = 2.0
"""How far amplitude and mean torque are raised in the search, times what they are."""
SETTLED = 1e-6
MOST_PERIODS = 200


def seek_isolated(explorer: Explorer, places: int = PLACES) -> int:
    """Add to an explorer the isolated branches found at some places of its span, and what leaves them; how many."""
    low, high = explorer.span
    before = len(explorer.branches)
    for value in low + (high - low) * (np.arange(places) + 0.5) / places:
        for problem, start in seeds(explorer, float(value)):
            explorer.isolated(problem, start)
    explorer.leave_all(before)
    return len(explorer.branches) - before


def seek_doubled(explorer: Explorer) -> None:
    """Add doubled branches that pass a span from end to end, so that none of their bifurcations lies in it.

    A branch whose determinant of the odd half orders is negative all along is unstable towards twice the period.  Less
    excitation, or another mean torque, makes it stable again: the doubled branch met on that way leads back.
    """
    for branch in list(explorer.branches):
        if branch.kind != MAIN or any(event.event == DOUBLING for event in branch.events):
            continue
        signs = [point.values[1] for point in branch.points if not point.event and len(point.values) > 1]
        if signs and max(signs) < 0:
            point = branch.points[0]
            for problem, z in _doubled_at(explorer, branch, point.z, point.parameter):
                explorer.isolated(problem, z, DOUBLED)


def _doubled_at(explorer: Explorer, branch: Branch, z: Array, value: float) -> Iterator[tuple[HarmonicProblem, Array]]:
    """Solutions of twice the period at one value, by way of the amplitude of the excitation or the mean torque."""
    for setting in detours(branch.problem, value):
        around = Explorer(setting, branch.base_order, (0.0, MOST), explorer.settings, depth=1, stability=False)
        for direction in (-1, 1):
            around.follow(around.problem(branch.base_order), np.append(z[:-1], 1.0), direction)
        around.leave_all()
        for found in around.branches:
            if found.kind == DOUBLED:
                own = explorer.problem(found.base_order)
                for solution in solutions_at(found, 1.0):
                    yield own, np.append(solution[:-1], value / own.scale[-1])


def seeds(explorer: Explorer, value: float) -> Iterator[tuple[HarmonicProblem, Array]]:
    """Scaled solutions at one value of the parameter, known ones among them."""
    known = [(b, z) for b in list(explorer.branches) for z in solutions_at(b, value)]
    for branch, z in known:
        for found in _by_torque(branch.problem, z, value):
            yield branch.problem, found
    if explorer.setting.split.straight and known:
        yield from _by_time(explorer, known[0][0].problem, known[0][1], value)


def solutions_at(branch: Branch, value: float) -> Iterator[Array]:
    """The scaled solutions of a branch at one value of the parameter."""
    scaled, at = branch.scaled, value / branch.problem.scale[-1]
    for i in np.flatnonzero((scaled[:-1, -1] - at) * (scaled[1:, -1] - at) <= 0):
        start, end = scaled[i], scaled[i + 1]
        share = (at - start[-1]) / (end[-1] - start[-1]) if end[-1] != start[-1] else 0.0
        found = branch.problem.at(start + share * (end - start), value)
        if found.converged:
            yield found.z


def _by_torque(problem: HarmonicProblem, z: Array, value: float) -> Iterator[Array]:
    """Where a continuation in the mean torque, and one in the amplitude of the excitation, passes the load again."""
    for setting in detours(problem, value):
        along = HarmonicProblem(setting, problem.base_order)
        for direction in (1, -1):
            trace = followed(along, np.append(z[:-1], 1.0), direction, (0.0, MOST), AWAY)
            scaled = np.array([point.z for point in trace.points])
            for i in np.flatnonzero((scaled[1:-1, -1] - 1.0) * (scaled[2:, -1] - 1.0) < 0) + 1:
                share = (1.0 - scaled[i, -1]) / (scaled[i + 1, -1] - scaled[i, -1])
                guess = scaled[i] + share * (scaled[i + 1] - scaled[i])
                found = problem.at(np.append(guess[:-1], 0.0), value)
                if found.converged:
                    yield found.z


def motion(setting: Setting, base_order: float, value: float) -> PiecewiseMotion:
    """The exact motion in time of a system whose laws are all hinges, at one value of the parameter."""
    problem = HarmonicProblem(setting, base_order)
    return exact_motion(problem, np.append(np.zeros(problem.scale.size - 1), value / problem.scale[-1]))


def _by_time(
    explorer: Explorer, problem: HarmonicProblem, z: Array, value: float
) -> Iterator[tuple[HarmonicProblem, Array]]:
    """Steady motions in time from states far off the main solution; as many harmonics of them as the balance takes."""
    setting = problem.frozen(value).setting
    timed = motion(setting, explorer.base_order, value)
    base = timed.bases.coordinates
    told = states(problem, z[None])
    rest = base.state(told.coordinates[0, 0].real, np.zeros(told.coordinates.shape[-1]))
    random = np.random.default_rng(0)
    for kick in np.geomspace(0.3, 10.0, STARTS):
        size = np.abs(base.angle_rows @ rest).max(initial=0.0) + setting.angle_scale.max()
        turned = random.standard_normal(base.size)
        turned[2 * base.scale.size :] = 0.0  # a rigid speed fades away slowly, and meanwhile acts like a mean torque
        turned *= kick * size / max(np.abs(base.angle_rows @ turned).max(initial=0.0), 1e-300)
        for state, repeat in _closed(timed, rest + turned):
            own = explorer.problem(explorer.base_order / repeat)
            harmonics = timed.harmonics(state, own.harmonics, repeat)
            at = own.at(own.point_of(harmonics.T, value), value)
            if at.converged:
                yield own, at.z


def _closed(timed: PiecewiseMotion, start: Array) -> Iterator[tuple[Array, int]]:
    """The periodic motion that one from a start tends to, and its periods; where it takes long, by Newton's method."""
    found = timed.steady(start, MOST_PERIODS, SETTLED, LONGEST)
    if found.converged:
        yield found.state, found.subharmonic
        return
    misses = [float(np.abs(timed.flow(found.state, n).state - found.state).max()) for n in range(1, LONGEST + 1)]
    repeat = next(n + 1 for n, miss in enumerate(misses) if miss <= 2.0 * min(misses))
    closed = timed.shoot(found.state, repeat)
    if closed.converged:
        yield closed.state, repeat
