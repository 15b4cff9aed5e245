"""A first solution at one value of the parameter, without anybody's guess.

The linear answer about the static state comes first, which is the first Newton step from there.  Where Newton's method
does not follow it, the vibration is raised from nothing to its full amplitude by continuation, then the laws are bent
from straight springs to what they are, then the mean torque is brought from above to where it belongs.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator

import numpy as np

from torsional.errors import ModelError
from torsional.laws import HingeRows, Hinges
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import Settings, followed
from torsional.solvers.equilibrium import equilibrium, settled
from torsional.solvers.periodic.detours import between, over_amplitude, parts
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.problem import HarmonicProblem, Setting
from torsional.solvers.periodic.varied import VariedProblem
from torsional.system import System

HOMOTOPY = Settings(first_step=0.05, largest_step=0.3, most_points=400)


def first_solution(problem: HarmonicProblem, value: float) -> Array:
    """A scaled solution at a physical ``value`` of the parameter.

    Raises ModelError with the last good point and what to try where no way leads to one.
    """
    ways: tuple[Callable[[HarmonicProblem, float], Iterator[Array]], ...] = (_linear, _raised, _bent, _lighter, _shaken)
    for way in ways:
        for guess in way(problem, value):
            found = problem.at(guess, value)
            if found.converged:
                return found.z
    static = ", ".join(f"{angle:.4g} rad" for angle in _static_angles(problem.frozen(value).setting, value))
    raise ModelError(
        "no periodic solution was found to start from",
        where=f"parameter {value:g}",
        found=f"the last good point is the static state, mean angles {static}",
        remedy="start at another end of the range, at a higher mean torque or speed, or give more damping",
    )


def _static_angles(setting: Setting, value: float) -> Array:
    """Mean relative angles (m,) [rad] under the mean torque alone, or under straight springs where none is found."""
    mean = setting.load.at(value)[:, setting.load.orders == 0].real.sum(axis=1)
    split = setting.split
    onto = split.system.T[[split.system.node_index(node) for node in setting.load.nodes]]
    try:
        if setting.hold and mean.any():
            point = equilibrium(split.system, dict(zip(setting.load.nodes, mean, strict=True)), setting.hold)
            return np.asarray(point.angle[list(split.places)])
        return settled(split.system, mean @ onto)[list(split.places)]
    except ModelError:
        balanced = split.balanced(onto, setting.hold) if mean.any() else onto
        return np.asarray(split.twist(balanced) @ mean)


def _linear(problem: HarmonicProblem, value: float) -> Iterator[Array]:
    """The static state; and the same moved by a tenth of the scale, for one that lies exactly on a corner."""
    setting = problem.frozen(value).setting
    resting = problem.resting(value)
    static = _static_angles(setting, value) if resting is None else resting
    for shift in (0.0, 0.1, -0.1):
        at = np.zeros((static.size, 1), dtype=complex)
        at[:, 0] = static + shift * setting.angle_scale
        yield problem.point_of(at, value)


def _shaken(problem: HarmonicProblem, value: float) -> Iterator[Array]:
    """Vibrations of the first harmonic about several means, large enough to pass a free range from end to end."""
    setting = problem.frozen(value).setting
    static = _static_angles(setting, value)
    widths = np.array([law.nearest_edge for law in setting.split.laws])
    for size in (1.2, 2.0, 4.0):
        for phase in np.exp(1j * np.pi * np.arange(4) / 2):
            for shift in (0.0, 0.5, -0.5):
                at = np.zeros((static.size, 2), dtype=complex)
                at[:, 0] = static + shift * widths
                at[:, 1] = size * np.maximum(widths, setting.angle_scale) * phase
                yield problem.point_of(at, value)


def _bent(problem: HarmonicProblem, value: float) -> Iterator[Array]:
    """The end of a continuation in the law: from straight springs of the reference stiffness to what it is."""
    setting = problem.frozen(value).setting
    split, torque = setting.split, setting.load.at(value)
    rows = [own for law in split.laws if (own := law.straight) is not None]
    if not split.straight:
        return
    speed = value if setting.speed is None else setting.speed
    load = Load.polynomial(setting.load.nodes, setting.load.orders, np.array([0.0]), torque[None])

    def build(share: float) -> System:
        share = min(max(share, 0.0), 1.0)
        laws = list(split.system.connections.laws)
        for place, own, straight in zip(split.places, rows, split.reference_stiffness, strict=True):
            laws[place] = _partly(own, float(straight), share)
        return split.system.with_connections(laws=tuple(laws))

    varied = dataclasses.replace(setting, load=load, speed=speed, parameter_scale=1.0)
    bent = VariedProblem(varied, problem.base_order, build, (0.0, 1.0))
    mean, linear = bent.linear_size(0.0)
    at = np.zeros((mean.size, 2), dtype=complex)
    at[:, 0], at[:, 1] = mean, linear
    first = bent.at(bent.point_of(at, 0.0), 0.0).z  # exact: derivatives by the share are those of the guess
    trace = followed(bent, first, 1, (0.0, 1.0), HOMOTOPY)
    if trace.points and trace.parameter[-1] == 1.0:
        yield _moved(trace.points[-1].z, problem, value)


def _partly(rows: HingeRows, straight: float, share: float) -> Hinges:
    """The law some way from a straight spring to what it is."""
    gaps, sides, changes = (tuple(column.tolist()) for column in (rows.gap, rows.side, share * rows.change))
    return Hinges(straight + share * (rows.stiffness - straight), gaps, sides, changes)


def _raised(problem: HarmonicProblem, value: float) -> Iterator[Array]:
    """The end of a continuation in the amplitude of the vibration, from the static state."""
    setting = problem.frozen(value).setting
    raised = HarmonicProblem(over_amplitude(problem, value), problem.base_order)
    start = raised.point_of(_static_angles(setting, value)[:, None].astype(complex), 0.0)
    trace = followed(raised, start, 1, (0.0, 1.0), HOMOTOPY)
    if trace.points and trace.parameter[-1] == 1.0:
        yield _moved(trace.points[-1].z, problem, value)


def _lighter(problem: HarmonicProblem, value: float) -> Iterator[Array]:
    """The end of a continuation in the mean torque, from one high above where the law is met in another place."""
    mean, rest = parts(problem, value)
    if not mean.any():
        return
    for factor in (1.5, 3.0, 0.5, 0.1):
        moved = HarmonicProblem(between(problem, value, rest + factor * mean, rest + mean), problem.base_order)
        static = _static_angles(moved.setting, 0.0)[:, None].astype(complex)
        trace = followed(moved, moved.point_of(static, 0.0), 1, (0.0, 1.0), HOMOTOPY)
        if trace.points and trace.parameter[-1] == 1.0:
            yield _moved(trace.points[-1].z, problem, value)


def _moved(z: Array, problem: HarmonicProblem, value: float) -> Array:
    return np.append(z[:-1], value / problem.scale[-1])
