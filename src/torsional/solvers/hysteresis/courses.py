"""The parts of an absorber on a bench taken along a course of the turned angle, cycle by cycle."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import Connected
from torsional.numerics.quasi_static.march import march
from torsional.numerics.quasi_static.torques import work_for
from torsional.solvers.hysteresis.bench import Bench, on_bench
from torsional.solvers.hysteresis.parts import Part, parts_of
from torsional.solvers.transient.arrays import connected
from torsional.system import System

FINE = 5e-4
"""Share of the sweep by which a part may miss where its pace led before the step is shortened."""
COARSE = 1.0
"""The same where steps are shortened only for want of a balance: torques then change smoothly with parameters."""
SAME = 1e-6
"""What torques of all elements may differ by where a cycle begins and ends, over the largest: it then repeats."""


class Course(NamedTuple):
    """One cycle of the turned angle ``drive`` (samples,) [rad], as it is after each ``step`` [s], at a mean ``speed``
    [rad/s]; about a ``centre`` by ± a ``sweep`` [rad], at a mean pace of ``rate`` [rad/s].

    The last angle is where the next cycle begins.
    """

    speed: float
    drive: Array
    step: float
    centre: float
    sweep: float
    rate: float

    @classmethod
    def through(cls, speed: float, angle: ArrayLike, period: float) -> Course:
        """The course through angles (samples,) [rad] that lie evenly over a period [s], the last one at its end.

        Raises ModelError for fewer than eight, for what is not finite, and for an angle that stands still.

        >>> Course.through(0.0, [1.0, 2.0, 1.0, 0.0, -1.0, -2.0, -1.0, 0.0], 4.0)[2:]
        (0.5, 0.0, 2.0, 2.0)
        """
        drive = np.asarray(angle, dtype=float)
        if drive.ndim != 1 or drive.size < 8 or not np.isfinite(drive).all() or not 0.0 < period < np.inf:
            found, allowed = f"{drive.size} angles over {period:g} s", "8 finite ones or more, over a time"
            raise ModelError("a course is one cycle of an angle", where="course", found=found, allowed=allowed)
        high, low = float(drive.max()), float(drive.min())
        if high == low:
            raise ModelError("the angle stands still", where="course", found=f"{high:g} rad throughout")
        return cls(
            float(speed),
            drive,
            period / drive.size,
            0.5 * (high + low),
            0.5 * (high - low),
            2.0 * (high - low) / period,
        )


class Run(NamedTuple):
    """Places, torques and loads (cycle, samples, …) of the first and the last cycle; how many cycles it took, and by
    what the last two differ, over the largest torque."""

    place: Array
    torque: Array
    load: Array
    cycles: int
    closure: float


class Followed(NamedTuple):
    """The last cycle of a course: ``torque`` (samples,) at the turned node, and of all elements (samples, elements)
    ``twist``, ``element_torque`` and what presses them, ``normal_load`` [N]."""

    torque: Array
    twist: Array
    element_torque: Array
    normal_load: Array


class Mounted(NamedTuple):
    """One of the parts that are alike, and its arrays."""

    part: Part
    arrays: Connected


@checked
def followed(
    system: System, turned: str, held: str, courses: Sequence[Course], *, cycles: int = 2, miss: float = COARSE
) -> tuple[Followed, ...]:
    """What the turned node meets along each of several courses of its angle against the held one, inertia left out.

    As `torsional.solvers.hysteresis.hysteresis`, but of any periodic angle, and quicker where the same courses are
    followed again and again while parameters vary: ``cycles`` from rest, the last of them told; steps are shortened
    where parts ``miss`` by more than this share of the sweep where their pace led.  Raises ModelError as
    `hysteresis` does.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = {"a": Inertia(1.0), "b": Inertia(1.0), "spring": Shaft("b", "a", 1000.0)}
    >>> sine = 0.1 * np.sin(2 * np.pi * np.arange(1, 41) / 40)
    >>> (met,) = followed(assemble(Powertrain(pair)), "a", "b", [Course.through(0.0, sine, 1.0)])
    >>> round(float(met.torque.max()), 6)
    100.0
    """
    bench = on_bench(system, turned, held)
    weights, parts = bench.system.connections.weights, mounted(bench)
    told = []
    for course in courses:
        met = run(bench, parts, course, most=cycles, closed=0.0, miss=miss)
        torque = met.torque[1]
        told.append(Followed(torque @ weights[:, -1], met.place[1] @ weights.T, torque, met.load[1]))
    return tuple(told)


def mounted(bench: Bench) -> tuple[Mounted, ...]:
    """The parts of a bench, ready to be taken along courses."""
    found = []
    for part in parts_of(bench.system.connections):
        alone = dataclasses.replace(bench.system, connections=part.connections)
        levels = {load.level: -1 for load in part.connections.loads if load is not None}
        found.append(Mounted(part, connected(alone, levels)))
    return tuple(found)


def run(bench: Bench, parts: Sequence[Mounted], course: Course, *, most: int, closed: float, miss: float = FINE) -> Run:
    """Every part from rest to the centre, then along the course, ``most`` times or until two cycles differ by less
    than ``closed``; ``miss``: see `FINE`."""
    count, width = bench.system.connections.weights.shape
    place, torque, load = (np.zeros((2, course.drive.size, size)) for size in (width, count, count))
    cycles, closure = 1, 0.0
    place[..., -1] = course.drive
    for part, arrays in parts:
        own = _part_run(part, arrays, course, most, closed, miss)
        for columns, elements in zip(part.columns, part.elements, strict=True):
            place[..., columns], torque[..., elements], load[..., elements] = own.place[..., :-1], own.torque, own.load
        cycles, closure = max(cycles, own.cycles), max(closure, own.closure)
    return Run(place, torque, load, cycles, closure)


def _part_run(part: Part, c: Connected, course: Course, most: int, closed: float, miss: float) -> Run:
    weights, centre, step = part.connections.weights, course.centre, course.step
    work = work_for(c, weights.shape[1], abs(centre) + course.sweep, miss * course.sweep)
    place, memory = np.zeros(weights.shape[1]), np.zeros(len(weights))

    def along(drive: Array) -> tuple[Array, Array, Array]:
        places, told = np.empty((drive.size, place.size)), np.empty((2, drive.size, memory.size))
        lost = march(c, float(course.speed) ** 2, place, memory, drive, step, work, places, told)
        if lost:
            found = f"{lost} times in {drive.size} steps at a sweep of ±{np.degrees(course.sweep):g}°"
            raise ModelError("the parts find no balance under the slow turn", where="hysteresis", found=found)
        return places, told[0], told[1]

    along(np.linspace(0.0, centre, 1 + int(np.ceil(abs(centre) / (course.rate * step)))))
    first = last = along(course.drive)
    count, closure = 1, np.inf
    while count < most and closure > closed:
        before, last, count = last, along(course.drive), count + 1
        closure = _difference(before[1], last[1], weights[:, -1])
    both = [np.stack(pair) for pair in zip(first, last, strict=True)]
    return Run(both[0], both[1], both[2], count, closure)


def _difference(before: Array, last: Array, drive: Array) -> float:
    """By what two cycles differ, over the largest torque; nothing where all torques are at the end what they were."""
    if np.abs(last[-1] - before[-1]).max() <= SAME * np.abs(last).max():
        return 0.0
    torque = last @ drive
    return float(np.abs(torque - before @ drive).max() / np.abs(torque).max())
