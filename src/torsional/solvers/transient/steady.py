"""Where a run in time ends up: periodic or not, in orders, with what is needed to go on from there."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.engine.orders import HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import dataset
from torsional.solvers.transient.character import Character
from torsional.solvers.transient.honesty import honest
from torsional.solvers.transient.marching import Accuracy, Marched, method_share
from torsional.solvers.transient.presented import ending
from torsional.solvers.transient.problem import Drives, Levels, Problem
from torsional.solvers.transient.starts import starting
from torsional.solvers.transient.stroboscope import Stroboscope
from torsional.system import System

WANDERING = 64
"""Periods over which the orders of a motion that never repeats itself are taken."""


@checked
def steady_state(
    system: System,
    drives: Drives,
    *,
    speed: float | None = None,
    hold: str = "",
    levels: Levels | None = None,
    start: object = "vibrating",
    step: float = 1e-4,
    method: str = "chung_hulbert",
    spectral_radius: float = 0.8,
    base_order: float | None = None,
    highest_order: float = HIGHEST_ORDER,
    longest: int = 8,
    most_periods: int = 3000,
    tolerance: float = 1e-5,
    thorough: bool = True,
    parts: int = 0,
) -> xr.Dataset:
    """The motion that a run in time settles on: its character in words and its orders, as one point of a branch.

    The line is looked at once a period of its drives, which is that of ``base_order`` (default: the largest that all
    are multiples of).  It is periodic when the last ``longest`` looks agree with those k periods before, k up to
    ``longest``, within ``tolerance`` of the motion's size in the norm of energy; k is ``periods`` in the attributes.
    After ``most_periods`` without, the largest Lyapunov exponent from two neighbouring runs, and the dimension of the
    stroboscopic points, tell quasi-periodic from chaotic motion (not asked where not ``thorough``).  The step is made
    to fit the period, and halved where that ends changes from period to period below 2 % (``refined``).  Everything
    else as in `transient`; the frame keeps one speed.

    ``angle`` (order, node) [rad], ``twist`` and ``torque`` (order, element) complex 0-peak, order 0 the mean, orders
    multiples of the base order over ``parts`` (default: 2 or what the periods ask for); ``end_angle`` and so on are a
    start for the next run, at the crank angle zero; attributes ``kind``, ``status``, ``periods``, ``exponent``
    [1/period], ``dimension``; what the
    steps made or lost of the energy is ``method_share``, and what else is to be said of them as in `transient`.
    Raises ModelError where nothing that drives the line repeats itself.

    Exponent after Benettin and others (Meccanica 15 (1980) 9), dimension after Grassberger and Procaccia (Physica D 9
    (1983) 189).

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.engine import Excitation
    >>> from torsional.laws import Hinges
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> law = Hinges(1.0, (1.0,), (1.0,), (1.0,))
    >>> one = assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law, damping=0.04)}))
    >>> drive = Excitation(("disc",), [0, 1], 2.41, [[1.0, 1.0]])
    >>> found = steady_state(one, drive, step=0.01, spectral_radius=1.0, tolerance=1e-4)
    >>> found.attrs["status"]
    'periodic, repeats itself after 2 periods of the drive'
    """
    counts = {"longest": (longest, 1), "most_periods": (most_periods, 1), "parts": (parts, 0)}
    sizes = {"highest_order": highest_order, "tolerance": tolerance, "base_order": base_order}
    _refuse_settings(counts, {name: value for name, value in sizes.items() if value is not None})
    problem = Problem.of(system, drives, speed, hold=hold, levels=levels)
    scope = stroboscope(problem, Accuracy(step, method, spectral_radius), start, base_order)
    return settled(scope, highest_order, longest, most_periods, tolerance, thorough, parts)


def _refuse_settings(counts: Mapping[str, tuple[int, int]], sizes: Mapping[str, float]) -> None:
    """Refuse counts below their least and sizes that are not positive."""
    for name, (count, least) in counts.items():
        if count < least:
            raise ModelError("too few", where=name, found=str(count), allowed=f">= {least}")
    for name, size in sizes.items():
        if not size > 0:
            raise ModelError("must be positive", where=name, found=f"{size:g}", allowed="> 0")


def stroboscope(problem: Problem, accuracy: Accuracy, start: object, base_order: float | None) -> Stroboscope:
    """The line looked at once a period, from a start on."""
    if problem.speed.range[0] < problem.speed.range[1] or not problem.start_speed > 0:
        raise ModelError("a steady motion has one mean speed above zero", where="speed")
    base = base_order or problem.base_order
    if not base > 0:
        remedy = "give an excitation with orders above 0"
        raise ModelError("nothing that repeats itself drives the line", where="drives", remedy=remedy)
    state = starting(start, problem.system, problem.acting, problem.hold, problem.start_speed)
    return Stroboscope(problem, accuracy, state.since(0.0), base)


def settled(
    scope: Stroboscope,
    highest_order: float,
    longest: int,
    most_periods: int,
    tolerance: float,
    thorough: bool,
    parts: int,
) -> xr.Dataset:
    """Run until periodic, then the orders of the last periods."""
    character = scope.character(longest, most_periods, tolerance, thorough)
    fine = scope.base_order / (parts or math.lcm(2, character.periods or 1))
    count = math.lcm(parts or 2, character.periods or WANDERING)
    told = scope.full(count)
    orders = np.asarray(fine * np.arange(int(highest_order / fine + 1e-9) + 1), dtype=float)
    return _presented(scope, told, orders, character, count)


def _presented(scope: Stroboscope, told: Marched, orders: Array, character: Character, count: int) -> xr.Dataset:
    problem = scope.problem
    system, end = problem.system, scope.state
    turns = scope.base_order / count
    angle = _orders(told.angle, orders, turns)
    return dataset(
        {
            "angle": (("order", "node"), angle @ system.T.T, "angle"),
            "twist": (("order", "element"), angle @ system.connections.weights.T, "relative_angle"),
            "torque": (("order", "element"), _orders(told.torque, orders, turns), "torque"),
        }
        | ending(end),
        {
            "order": (orders, "engine_order"),
            "node": (np.array(system.nodes), ""),
            "element": (np.array(system.connections.names), ""),
            "speed_ratio": (system.speed_ratio, "gear_ratio", "node"),
        },
        analysis="steady state in time",
        amplitude="complex 0-peak; order 0 is the mean",
        kind=character.kind,
        status=character.words,
        periods=character.periods,
        left=character.left,
        exponent=character.exponent,
        dimension=character.dimension,
        base_order=scope.base_order,
        periods_taken=len(scope.points) - 1,
        step=scope.settled.step,
        end_time=0.0,
        end_reference=float("nan") if end.reference is None else end.reference,
        system_hash=problem.line_hash,
        method_share=method_share(end.standing),
        **(honest(problem, end.standing, scope.settled) | scope.notes),
    ).assign_coords(speed=problem.start_speed)


def _orders(signal: Array, orders: Array, resolution: float) -> ComplexArray:
    """Complex 0-peak harmonics (orders, …) of samples over 1/``resolution`` turns, the last sample the first of the
    next; what it has drifted by is taken off."""
    count = len(signal) - 1
    slope = np.multiply.outer(np.arange(count) / count - 0.5, signal[-1] - signal[0])
    series = np.fft.rfft(signal[:-1] - slope, axis=0) * (2.0 / count)
    series[0] /= 2.0
    places = np.round(orders / resolution).astype(int)
    if places.max() > count // 2:
        allowed = f"up to {resolution * (count // 2):g} with this step"
        raise ModelError("the step is too long for the order", where="highest_order", allowed=allowed)
    return np.asarray(series[places])
