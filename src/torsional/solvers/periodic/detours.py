"""Settings along another parameter than the one asked for: ways round to solutions at one value of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from torsional.numerics.arrays import ComplexArray
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.problem import HarmonicProblem, Setting


def parts(problem: HarmonicProblem, value: float) -> tuple[ComplexArray, ComplexArray]:
    """Mean torques and the others (nodes, orders) [Nm] at one value of the parameter."""
    load = problem.setting.load
    torque = load.at(value)
    mean = np.where(load.orders == 0, torque, 0.0)
    return mean, torque - mean


def between(problem: HarmonicProblem, value: float, start: ComplexArray, end: ComplexArray) -> Setting:
    """The setting at one value with torques that go straight from ``start`` at 0 to ``end`` at 1 of a new parameter."""
    setting = problem.frozen(value).setting
    load = Load.polynomial(setting.load.nodes, setting.load.orders, np.array([0.0, 1.0]), np.stack([start, end]))
    speed = value if setting.speed is None else setting.speed
    return replace(setting, load=load, speed=speed, parameter_scale=1.0)


def over_amplitude(problem: HarmonicProblem, value: float) -> Setting:
    """The setting at one value with all orders above 0 times a new parameter."""
    mean, rest = parts(problem, value)
    return between(problem, value, mean, mean + rest)


def detours(problem: HarmonicProblem, value: float) -> Iterator[Setting]:
    """Over the amplitude of the excitation, then over the mean torque, where there is any; at 1 all is as it was."""
    mean, rest = parts(problem, value)
    if rest.any():
        yield between(problem, value, mean, mean + rest)
    if mean.any():
        yield between(problem, value, rest, mean + rest)
