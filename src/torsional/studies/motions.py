"""Periodic motions that the claims ask for: branches at one speed or one mean torque, and the motion in time."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from torsional.engine.orders import HIGHEST_ORDER
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.solvers.periodic.branches import Branch, Explorer
from torsional.solvers.periodic.isolated import motion
from torsional.solvers.periodic.machine import engine_load, engine_torque_load
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.solvers.periodic.response import Exploration, explorer_of
from torsional.solvers.periodic.stability import MARGIN, branch_multipliers
from torsional.solvers.periodic.states import states
from torsional.studies.answers import input_shaft
from torsional.system import System, assemble

Range = tuple[float, float]
SPRING, SHAFT, INPUT_ACCELERATION, TWIST = range(4)
"""Places of the quantities that `amplitudes` tells."""
SAMPLES = 512
ALIKE = 1e-3
"""Share of the largest harmonic within which two motions are the same."""


def over_torque(
    model: Model, speed: float, torque: Range, gear: str = "", *, depth: int = 1, highest_order: float = HIGHEST_ORDER
) -> Explorer:
    """Branches over a range of mean torque [Nm] at one speed [rad/s], followed."""
    load = engine_torque_load(model, speed, torque, highest_order)
    asked = Exploration(
        parameter="mean_torque",
        speed=speed,
        hold=model.landmarks.load,
        highest_order=highest_order,
        depth=depth,
        stability=False,
    )
    return _followed(explorer_of(_assembled(model, gear), load, torque, asked))


def over_speed(
    model: Model, speed: Range, torque: float, gear: str = "", *, depth: int = 1, highest_order: float = HIGHEST_ORDER
) -> Explorer:
    """Branches over a range of speed [rad/s] at one mean torque [Nm], followed."""
    load = engine_load(model, speed, torque, highest_order)
    asked = Exploration(hold=model.landmarks.load, highest_order=highest_order, depth=depth, stability=False)
    return _followed(explorer_of(_assembled(model, gear), load, speed, asked))


@lru_cache(maxsize=8)
def _assembled(model: Model, gear: str) -> System:
    """Kept, as searches over speed ask one model again and again."""
    return assemble(model.powertrain(gear))


def _followed(explorer: Explorer) -> Explorer:
    explorer.explored()
    return explorer


def doubled(explorer: Explorer) -> list[Branch]:
    """The branches of twice the period."""
    half = 0.5 * explorer.base_order
    return [branch for branch in explorer.branches if branch.base_order == half and branch.kind == "period doubling"]


def amplitudes(model: Model, branch: Branch, order: float) -> Array:
    """Of one order along a branch, 0-peak (4, points): spring torque, torque and acceleration at the gearbox input,
    twist of the spring."""
    system = branch.problem.setting.split.system
    told, place = states(branch.problem, branch.scaled), round(order / branch.base_order)
    spring = system.connections.names.index(model.landmarks.springs[0])
    shaft, quiet = system.connections.names.index(input_shaft(model)), system.node_index(model.landmarks.input)
    speed = branch.values if branch.problem.setting.speed is None else branch.problem.setting.speed
    return np.abs(
        [
            told.torque[:, place, spring],
            told.torque[:, place, shaft],
            told.angle[:, place, quiet] * (order * speed) ** 2,
            told.twist[:, place, spring],
        ]
    )


def doubling_margin(branch: Branch) -> Array:
    """The determinant of the linearised half orders along a branch (points,), negative where its period has doubled."""
    return np.array([np.linalg.det(branch.problem.half_order_block(z)) for z in branch.scaled])


def stable(problem: HarmonicProblem, points: Array) -> Array:
    """Whether the motions at scaled points (points, n + 1) are stable."""
    return np.asarray((np.abs(branch_multipliers(problem, points)) <= 1 + MARGIN).all(axis=1))


def at_value(branch: Branch, value: float) -> list[Array]:
    """The scaled solutions of a branch at one value of its parameter."""
    found: list[Array] = []
    for start, end in zip(branch.points[:-1], branch.points[1:], strict=True):
        low, high = start.parameter, end.parameter
        if (low - value) * (high - value) > 0 or low == high:
            continue
        corrected = branch.problem.at(start.z + (value - low) / (high - low) * (end.z - start.z), value)
        if corrected.converged and not any(np.abs(corrected.z - z).max() < 1e-6 for z in found):
            found.append(corrected.z)
    return found


def in_time(explorer: Explorer, value: float) -> PiecewiseMotion:
    """The exact motion in time at one value of the parameter."""
    return motion(explorer.setting, explorer.base_order, value)


def state_of(problem: HarmonicProblem, z: Array, timed: PiecewiseMotion) -> Array:
    """The state at the angle zero of the crank of a scaled solution."""
    q: ComplexArray = states(problem, z[None]).coordinates[0]
    value = float(z[-1] * problem.scale[-1])
    omega = problem.base_order * (value if problem.setting.speed is None else problem.setting.speed)
    rates = 1j * omega * np.arange(len(q))[:, None] * q
    return timed.bases.coordinates.state(q.real.sum(axis=0), rates.real.sum(axis=0))


def rest_of(problem: HarmonicProblem, z: Array, timed: PiecewiseMotion) -> Array:
    """The state of rest at the mean angles of a scaled solution."""
    mean = states(problem, z[None]).coordinates[0, 0].real
    return timed.bases.coordinates.state(mean, np.zeros_like(mean))


def twist_orders(timed: PiecewiseMotion, state: Array, periods: int) -> Array:
    """0-peak harmonics (4 periods + 1,) [rad] of the first law's angle from a state on, in multiples of the load's
    base frequency over ``periods``."""
    return np.abs(timed.harmonics(state, 4 * periods, periods)[:, 0])


def twist_swing(problem: HarmonicProblem, z: Array) -> tuple[float, float]:
    """Smallest and largest angle [rad] of the first law over a period of a scaled solution."""
    harmonics = problem.harmonics_of(z)[0]
    turns = np.exp(1j * np.multiply.outer(np.arange(harmonics.size), np.linspace(0, 2 * np.pi, SAMPLES)))
    angle = (harmonics @ turns).real
    return float(angle.min()), float(angle.max())


def distinct(explorer: Explorer, value: float) -> list[tuple[HarmonicProblem, Array]]:
    """The motions of all branches at one value of the parameter, those told twice or moved by a period left out.

    What is left of a doubled branch where it joins the one it left is not told apart from that.
    """
    found: list[tuple[HarmonicProblem, Array]] = []
    marks: list[Array] = []
    for branch in explorer.branches:
        for z in at_value(branch, value):
            harmonics = np.abs(branch.problem.harmonics_of(z)[0])
            mark = np.zeros(2 * explorer.setting.harmonics(explorer.base_order) + 1)
            step = round(2 * branch.base_order / explorer.base_order)
            mark[:: max(step, 1)][: harmonics.size] = harmonics[: mark[:: max(step, 1)].size]
            if not any(np.abs(mark - other).max() < ALIKE * mark.max() for other in marks):
                marks.append(mark)
                found.append((branch.problem, z))
    return found
