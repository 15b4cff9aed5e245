"""Torques of all connections at the end of a step in which nothing has inertia, compiled; see `quasi_static`."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import depth
from torsional.numerics.motion.data import (
    ADDRESS,
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    DAMPER,
    GAP,
    LAW_OF,
    LOAD_AT,
    SIDE,
    SPRING,
    START,
    STOP,
    Connected,
)
from torsional.numerics.motion.normal_load import normal_load
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
    rate: Array
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
    count, free = connected.constants.shape[1], coordinates - 1
    stiffest = connected.constants[SPRING].max(initial=0.0) + np.abs(connected.hinges.values[CHANGE]).max(initial=0.0)
    square = np.zeros((free, free)), np.zeros(free, dtype=np.int64)
    ends = np.zeros(free), np.array([1e-12 * stiffest]), np.array([reach, miss]), np.zeros(free), np.zeros(coordinates)
    values = [np.zeros(count) for _ in range(9)]
    given: tuple[Any, ...] = (*values, connected.laws.values.copy(), np.zeros(free), *square, *ends)
    return Work(*given)


@uncounted()
def _springs(c: Connected, square: float, step: float, w: Work) -> None:
    """Torques and slopes of springs, hinges and dampers at their angles and rates."""
    hinges = c.hinges
    for e in range(w.angle.size):
        stiffness = c.constants[SPRING, e] + square * c.constants[CENTRIFUGAL, e]
        w.spring[e] = stiffness * w.angle[e] + c.constants[DAMPER, e] * w.rate[e]
        w.spring_slope[e] = stiffness + c.constants[DAMPER, e] / step
    for h in range(hinges.of.size):
        e, side, delay = hinges.of[h], hinges.values[SIDE, h], hinges.values[CONTACT_TIME, h]
        beyond = depth(w.angle[e], w.rate[e], hinges.values[GAP, h], side, delay)
        if beyond > 0.0:
            w.spring[e] += side * hinges.values[CHANGE, h] * beyond
            w.spring_slope[e] += hinges.values[CHANGE, h] * (1.0 + delay / step)


@uncounted()
def _law(c: Connected, l: int, square: float, memory: Array, step: float, w: Work) -> None:
    """Adds one law; its torque is a straight line in the normal load, whose slope is a chord's."""
    places, values = c.laws.places, w.law_values
    e, at, torque = places[LAW_OF, l], places[LOAD_AT, l], law_at(places[ADDRESS, l])
    own = values[places[START, l] : places[STOP, l]]
    if at >= 0:
        w.load[e] = normal_load(c.laws, l, 1.0, square, w.spring)
        more = max(w.load[e], 1.0)
        values[at] = w.load[e] + more
        w.load_slope[e] = torque(own, w.angle[e], w.rate[e], memory[e], step)[0]
        values[at] = w.load[e]
    told = torque(own, w.angle[e], w.rate[e], memory[e], step)
    w.torque[e] += told[0]
    w.slope[e] += told[1] + told[2] / step
    w.memory[e] = told[4]
    if at >= 0:
        w.load_slope[e] = (w.load_slope[e] - told[0]) / more


@uncounted()
def evaluate(c: Connected, square: float, old: Array, place: Array, memory: Array, step: float, w: Work) -> None:
    """Torques and slopes of all connections at ``place``, reached from ``old`` within ``step`` [s]; ``square`` is Ω².

    ``old``, ``place`` (coordinates,), ``memory`` (E,) before the step.
    """
    for e in range(w.angle.size):
        w.angle[e] = row_product(c.rows, e, place)
        w.rate[e] = (w.angle[e] - row_product(c.rows, e, old)) / step
    _springs(c, square, step, w)
    for e in range(w.angle.size):
        w.torque[e], w.slope[e] = w.spring[e], w.spring_slope[e]
    for l in range(c.laws.places.shape[1]):
        _law(c, l, square, memory, step, w)
