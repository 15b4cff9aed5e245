"""Branches that hang together with none of those known: sought along other parameters, and from motions in time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from torsional.laws import Hinges
from torsional.numerics.arrays import Array
from torsional.numerics.continuation import Settings, followed
from torsional.numerics.piecewise_motion import PiecewiseMotion
from torsional.solvers.periodic.branches import Branch, Explorer
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.problem import HarmonicProblem, Setting
from torsional.solvers.periodic.stability import stage_bases
from torsional.solvers.periodic.states import driving, states

PLACES, STARTS, LONGEST = 5, 6, 3
"""Values of the parameter at which is sought, starting states at each, longest period in periods of the excitation."""
AWAY = Settings(first_step=0.02, largest_step=0.2, most_points=300)
SETTLED = 1e-6
MOST_PERIODS = 600


def seek_isolated(explorer: Explorer, places: int = PLACES) -> int:
    """Add to an explorer the isolated branches found at some places of its span, and what leaves them; how many."""
    low, high = explorer.span
    before = len(explorer.branches)
    for value in low + (high - low) * (np.arange(places) + 0.5) / places:
        for problem, start in seeds(explorer, float(value)):
            explorer.isolated(problem, start)
    explorer.leave_all(before)
    return len(explorer.branches) - before


def seeds(explorer: Explorer, value: float) -> Iterator[tuple[HarmonicProblem, Array]]:
    """Scaled solutions at one value of the parameter, known ones among them."""
    known = [(b, z) for b in list(explorer.branches) for z in solutions_at(b, value)]
    for branch, z in known:
        for found in _by_torque(branch.problem, z, value):
            yield branch.problem, found
    if all(isinstance(law, Hinges) for law in explorer.setting.split.laws) and known:
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
    setting = problem.setting
    torque = setting.load.at(value)
    mean = np.where(setting.load.orders == 0, torque, 0.0)
    speed = value if setting.speed is None else setting.speed
    for still, moved in ((torque - mean, mean), (mean, torque - mean)):
        if not np.abs(moved).any():
            continue
        ends = np.stack([still, still + moved])
        load = Load.polynomial(setting.load.nodes, setting.load.orders, np.array([0.0, 1.0]), ends)
        frozen = problem.frozen(value).setting
        along = HarmonicProblem(replace(frozen, load=load, speed=speed, parameter_scale=1.0), problem.base_order)
        start = np.append(z[:-1], 1.0)
        for direction in (1, -1):
            trace = followed(along, start, direction, (0.0, 2.0), AWAY)
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
    speed = value if setting.speed is None else setting.speed
    loads = driving(problem, np.array([value]))[0]
    return PiecewiseMotion(stage_bases(setting.split), loads, base_order * speed)


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
        turned *= kick * size / max(np.abs(base.angle_rows @ turned).max(initial=0.0), 1e-300)
        found = timed.steady(rest + turned, MOST_PERIODS, SETTLED, LONGEST)
        if not found.converged:
            continue
        order = explorer.base_order / found.subharmonic
        own = explorer.problem(order)
        harmonics = timed.harmonics(found.state, own.harmonics, found.subharmonic)
        at = own.at(own.point_of(harmonics.T, value), value)
        if at.converged:
            yield own, at.z
