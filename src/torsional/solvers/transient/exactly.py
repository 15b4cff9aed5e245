"""Motion from event to event, to rounding: linear parts, hinges and contacts under harmonic torques."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.contacts.exact import ExactContacts
from torsional.solvers.transient.acting import Source
from torsional.solvers.transient.linear_parts import parts_of
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState

WHAT = "the exact method"
SMALL, MOST = 1e-13, 400
"""Share of the largest harmonic from which one counts, and how many there may be."""


class Motion(NamedTuple):
    """Coordinates, rates, accelerations (T, N), torques of connections (T, E), and the events on the way."""

    angles: Array
    rates: Array
    accelerations: Array
    torque: Array
    events: int


def exact_motion(problem: Problem, state: MotionState, times: Array) -> Motion:
    """The motion at rising times [s] from a state; raises ModelError that names what it does not know."""
    parts, speed = parts_of(problem, WHAT), _speed(problem)
    loads, base = _loads(problem, speed)
    engine = ExactContacts(parts.mass, parts.damping, parts.stiffness, parts.walls, loads, base)
    run = engine.run(times, state.angle, state.speed)
    turn = np.exp(1j * base * np.multiply.outer(times, np.arange(len(loads))))
    torque = parts.torques(run.angles, run.rates)
    accelerations = np.linalg.solve(parts.mass, ((turn @ loads).real - torque @ parts.rows).T).T
    return Motion(run.angles, run.rates, np.asarray(accelerations), torque, len(run.events))


def _speed(problem: Problem) -> float:
    """The constant speed [rad/s]; refuses what acts otherwise than by harmonic torques."""
    acting, (low, high) = problem.acting, problem.speed.range
    listed = (
        (low != high, "speed", "a speed that changes"),
        (bool(acting.governors), "governor", "governors"),
        (bool(acting.cranks or acting.drags or acting.leaks), "cylinders", "cylinders over the crank's own angle"),
        (np.isfinite(problem.reference_time), "reference_time", "dampers that follow a reference"),
        (any(s.feedback and s.profile for s in acting.sources), "feedback", "events that the motion moves"),
        (any(s.level is not None and np.ptp(s.level.value) for s in acting.sources), "torques", "torques over time"),
    )
    for there, where, name in listed:
        if there:
            remedy = "take the time steps, or method='explicit'"
            raise ModelError(f"{WHAT} knows harmonic torques alone, not {name}", where=where, remedy=remedy)
    return low


def _loads(problem: Problem, speed: float) -> tuple[ComplexArray, float]:
    """Torques on the coordinates (H + 1, N), 0-peak, and the frequency [rad/s] of the first harmonic."""
    found: dict[Fraction, ComplexArray] = {}
    for source in problem.acting.sources:
        for order, torque in _harmonics(source, speed):
            found[order] = found.get(order, np.zeros(len(source.row), dtype=complex)) + torque * source.row
    orders = [order for order in found if order]
    count = problem.equations.coordinates
    if not orders:
        return np.array([found.get(Fraction(0), np.zeros(count, dtype=complex))]), 0.0
    base = Fraction(gcd(*(o.numerator for o in orders)), lcm(*(o.denominator for o in orders)))
    highest = int(max(orders) / base)
    if highest > MOST:
        raise ModelError(f"{WHAT} follows {MOST} harmonics", where="orders", found=f"{highest} of order {base}")
    loads = [found.get(base * h, np.zeros(count, dtype=complex)) for h in range(highest + 1)]
    return np.array(loads), float(base) * speed


def _harmonics(source: Source, speed: float) -> list[tuple[Fraction, complex]]:
    """Orders of the frame's rotation and torques of one source."""
    level = 1.0 if source.level is None else float(source.level.value[0])
    if source.profile is None:
        return [(Fraction(0), level)]
    if speed == 0.0:
        return [(Fraction(0), level * float(source.profile.at(source.phase)))]
    values = source.profile.coefficients[:, 0]
    series = np.fft.rfft(values) / len(values) * level
    series[1:] *= 2.0
    kept = [h for h in np.flatnonzero(np.abs(series) > SMALL * np.abs(series).max()) if 2 * h < len(values) or h == 0]
    turns = [Fraction(h / source.profile.period).limit_denominator(1000) for h in map(int, kept)]
    multiple = Fraction(source.multiple).limit_denominator(1000)
    return [(o * multiple, series[h] * np.exp(1j * float(o) * source.phase)) for h, o in zip(kept, turns, strict=True)]
