"""Torques of all connections at the end of a step in which nothing has inertia, compiled; see `quasi_static`."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import depth
from torsional.numerics.motion.data import Connected
from torsional.numerics.motion.sources import row_product
from torsional.numerics.uncounted import uncounted


class Work(NamedTuple):
    """What one evaluation leaves behind, a value a connection, and the equations of the coordinates that are free.

    ``hold`` [Nm/rad]: a spring to the place before the step, so weak that it only keeps what is free from drifting;
    ``reach`` [rad]: the largest angles to be expected, which tell what rounding leaves, and by how much a step may
    miss where the pace of the last would have led; ``pace`` [rad/s] of the free coordinates;
    ``old`` place before a step.
    """

    angle: Array
    spring: Array
    spring_slope: Array
    torque: Array
    slope: Array
    load: Array
    load_slope: Array
    memory: Array
    law_values: Array
    rest: Array
    tangent: Array
    order: IntArray
    move: Array
    hold: Array
    reach: Array
    pace: Array
    old: Array


def work_for(connected: Connected, coordinates: int, reach: float, miss: float) -> Work:
    """Room for a march over ``coordinates`` (the moved one among them) up to an angle of ``reach`` [rad].

    ``miss`` [rad]: how far a step may miss where the pace of the one before would have led, before it is shortened.
    """
    count, free = len(connected.stiffness), coordinates - 1
    stiffest = connected.stiffness.max(initial=0.0) + np.abs(connected.change).max(initial=0.0)
    square = np.zeros((free, free)), np.zeros(free, dtype=np.int64)
    ends = np.zeros(free), np.array([1e-12 * stiffest]), np.array([reach, miss]), np.zeros(free), np.zeros(coordinates)
    values = [np.zeros(count) for _ in range(8)]
    given: tuple[Any, ...] = (*values, connected.law_values.copy(), np.zeros(free), *square, *ends)
    return Work(*given)


@uncounted()
def _spring(c: Connected, e: int, square: float, rate: float, step: float, w: Work) -> None:
    """Torque and slope of spring, hinges and damper of one connection at its angle."""
    angle = w.angle[e]
    stiffness = c.stiffness[e] + square * c.centrifugal[e]
    torque, slope = stiffness * angle + c.damping[e] * rate, stiffness + c.damping[e] / step
    for h in range(c.hinge_start[e], c.hinge_start[e + 1]):
        side, change, delay = c.side[h], c.change[h], c.contact_time[h]
        beyond = depth(angle, rate, c.gap[h], side, delay)
        if beyond > 0.0:
            torque += side * change * beyond
            slope += change * (1.0 + delay / step)
    w.spring[e], w.spring_slope[e] = torque, slope


@uncounted()
def _load(c: Connected, e: int, square: float, w: Work) -> float:
    """The normal load of one connection under the springs' torques."""
    load = c.load_constant[e] + square * c.load_centrifugal[e]
    for k in range(c.load_start[e], c.load_start[e + 1]):
        load += c.load_share[k] * abs(w.spring[c.load_of[k]])
    return float(max(0.0, load))


@uncounted()
def _law(c: Connected, e: int, square: float, rate: float, memory: float, step: float, w: Work) -> None:
    """Adds the law of one connection; its torque is a straight line in the normal load, whose slope is a chord's."""
    told_by = law_at(c.address[e])
    values = w.law_values[c.law_start[e] : c.law_start[e + 1]]
    place = c.load_place[e]
    if place >= 0:
        w.load[e] = _load(c, e, square, w)
        more = max(w.load[e], 1.0)
        values[place] = w.load[e] + more
        w.load_slope[e] = told_by(values, w.angle[e], rate, memory, step)[0]
        values[place] = w.load[e]
    told = told_by(values, w.angle[e], rate, memory, step)
    w.torque[e] += told[0]
    w.slope[e] += told[1] + told[2] / step
    w.memory[e] = told[4]
    if place >= 0:
        w.load_slope[e] = (w.load_slope[e] - told[0]) / more


@uncounted()
def evaluate(c: Connected, square: float, old: Array, place: Array, memory: Array, step: float, w: Work) -> None:
    """Torques and slopes of all connections at ``place``, reached from ``old`` within ``step`` [s]; ``square`` is Ω².

    ``old``, ``place`` (coordinates,), ``memory`` (E,) before the step.
    """
    for e in range(c.stiffness.size):
        w.angle[e] = row_product(c.rows, e, place)
        _spring(c, e, square, (w.angle[e] - row_product(c.rows, e, old)) / step, step, w)
        w.torque[e], w.slope[e] = w.spring[e], w.spring_slope[e]
    for e in range(c.stiffness.size):
        if c.address[e] != 0:
            _law(c, e, square, (w.angle[e] - row_product(c.rows, e, old)) / step, memory[e], step, w)
