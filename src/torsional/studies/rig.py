"""A flywheel on a rig: loops of its design, as the rig would measure them, and the design found from measured ones.

One flywheel is turned to and fro against the other by a sine while both go round.  The model that is fitted has no
inertia; what that of the bodies in the channels does to the loops is seen where these are run in time.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from torsional.absorbers import spring_characteristic
from torsional.absorbers.spring_design import SpringFlywheel, detailed
from torsional.components import Shaft
from torsional.errors import ModelError, nearest
from torsional.laws import LuGre
from torsional.numerics.arrays import Array
from torsional.numerics.quasi_static.loops import loss_per_cycle
from torsional.powertrain import Powertrain
from torsional.solvers.hysteresis import FINE, Course, Followed, followed, on_bench
from torsional.solvers.transient import TorqueHistory, transient
from torsional.studies.identify import Identified, Unknown, identified, refined
from torsional.studies.loop_torques import LoopTorques, torques_in
from torsional.studies.records import Record
from torsional.system import System, assemble
from torsional.units import RPM

Design = TypeVar("Design", bound=SpringFlywheel)
ENDS = "primary", "secondary"
ROUGH_STEPS, STEPS = 96, 640
"""Steps of a cycle in which a model is followed while its parameters are looked for, and from there on, where what the
steps leave is extrapolated away: it alone moves the coefficient of friction of claim F1's loops by two standard
deviations."""
RIG_STEPS = 16 * STEPS
"""Of the virtual rig, which has none of the model's."""
ROUGH = 1e-2
"""Change of the sum of squares at which the first search ends."""
BED, STIFF, SETTLING, RUN, LONGEST, TOLD = ("actuator", "bed"), 1e9, 1e-5, 4, 1.5e-4, 640
"""Of runs in time: shafts of the rig, their stiffness [Nm/rad] and relaxation [s]; cycles, the longest step [s], and
instants of a cycle that are told."""
CYCLES, SAMPLES = 20, 400.618034
"""Cycles of a record, and samples of each: no whole number, as no clock of a rig is a multiple of its swing.  Samples
at the same phases of all cycles would meet a jump of the torque in each of them or in none."""


class Point(NamedTuple):
    """An operating point: mean ``speed`` [rad/s], half swing ``sweep`` [rad], ``mean_torque`` [Nm] about which, and the
    ``frequency`` [Hz] of the swing."""

    speed: float
    sweep: float
    mean_torque: float
    frequency: float

    @property
    def name(self) -> str:
        """The point in words."""
        swing = f"±{np.degrees(self.sweep):.3g}°, {self.frequency:.3g} Hz"
        return f"{self.speed / RPM:.4g} rpm, {swing}, {self.mean_torque:.4g} Nm"


class Sensors(NamedTuple):
    """What sensors add: ``noise``, a standard deviation over half the swing of torque and of angle; what they tell too
    much, ``torque_offset`` [Nm] and ``angle_offset`` [rad]."""

    noise: float = 0.02
    torque_offset: float = 0.0
    angle_offset: float = 0.0


def on_rig(design: SpringFlywheel) -> System:
    """The flywheel in all its detail, by itself."""
    return assemble(Powertrain(detailed(design).components))


def course(design: SpringFlywheel, point: Point, steps: int = RIG_STEPS) -> Course:
    """The sine about the angle at which the frictionless flywheel carries the mean torque."""
    centre = float(spring_characteristic(design).angle(point.mean_torque)) if point.mean_torque else 0.0
    phase = 2.0 * np.pi * np.arange(1, steps + 1) / steps
    return Course.through(point.speed, centre + point.sweep * np.sin(phase), 1.0 / point.frequency)


def met(design: SpringFlywheel, courses: Sequence[Course], miss: float = FINE) -> tuple[Followed, ...]:
    """What a flywheel meets along courses of its primary against its secondary."""
    return followed(on_rig(design), *ENDS, courses, miss=miss)


def measured_on_rig(
    design: SpringFlywheel, points: Sequence[Point], sensors: Sensors, seed: int, inertia: bool = False
) -> tuple[Record, ...]:
    """Loops of a design as a rig measures them: twenty cycles, begun anywhere, noise in angle and torque.

    With ``inertia`` of what slides in the channels they are run in time.
    """
    courses = [course(design, point) for point in points]
    torques = in_time(design, points) if inertia else [loop.torque for loop in met(design, courses)]
    return sensed(points, courses, torques, sensors, seed)


def sensed(
    points: Sequence[Point], courses: Sequence[Course], torques: Sequence[Array], sensors: Sensors, seed: int
) -> tuple[Record, ...]:
    """Loops whose ``torques`` along their courses are known, as sensors tell them."""
    draw = np.random.default_rng(seed)
    told = zip(points, courses, torques, strict=True)
    return tuple(_record(point, along.drive, torque, sensors, draw) for point, along, torque in told)


def in_time(design: SpringFlywheel, points: Sequence[Point]) -> list[Array]:
    """Torque [Nm] on the secondary over the last cycle of `course`, every body with its inertia.

    Stiff shafts hold the secondary and turn the primary; the swing grows within the first of four cycles.
    """
    bed = {name: Shaft(node, "ground", STIFF, STIFF * SETTLING) for name, node in zip(BED, ENDS, strict=True)}
    system = assemble(Powertrain({**detailed(design).components, **bed}))
    return [_in_time(system, course(design, point, TOLD), point) for point in points]


def _in_time(system: System, along: Course, point: Point) -> Array:
    lasting, output = RUN / point.frequency, along.step
    time = np.linspace(0.0, lasting, RUN * along.drive.size + 1)
    grown = np.clip(time * point.frequency, 0.0, 1.0)
    angle = (3.0 - 2.0 * grown) * grown**2 * np.append(along.drive[-1], np.tile(along.drive, RUN))
    turned = TorqueHistory(ENDS[0], tuple(time.tolist()), tuple((STIFF * angle).tolist()))
    step = output / np.ceil(output / LONGEST)
    run = transient(system, turned, lasting, "rest", speed=point.speed, step=float(step), output=output)
    return np.asarray(-run.torque.sel(element=BED[1]).values[-along.drive.size :])


def _record(point: Point, angle: Array, torque: Array, sensors: Sensors, draw: np.random.Generator) -> Record:
    cycles = np.arange(int(CYCLES * SAMPLES)) / SAMPLES
    phase = np.mod(cycles + draw.random(), 1.0)

    def sensed(values: Array, offset: float) -> Array:
        steps = np.arange(values.size + 1) / values.size
        told = np.interp(phase, steps, np.concatenate([values[-1:], values]))
        noise = sensors.noise * 0.5 * np.ptp(values)
        return np.asarray(told + offset + noise * draw.standard_normal(cycles.size))

    angle, torque = sensed(angle, sensors.angle_offset), sensed(torque, sensors.torque_offset)
    return Record(point.name, point.speed, cycles / point.frequency, angle, torque)


def with_values(design: Design, values: Mapping[str, float]) -> Design:
    """A design with some numbers changed, by names such as ``grease_damping`` and ``friction.sliding_coefficient``.

    Clearances on drive and on coast go together; so does the static coefficient of friction with the sliding one, in
    proportion, unless it is named.  Raises ModelError for a name that the design does not have, and for a design that
    cannot be.
    """
    made: Design = _changed(design, values, "")
    return made


def _changed(part: Any, changes: Mapping[str, float], where: str) -> Any:
    own: dict[str, Any] = {}
    fields = {field.name for field in dataclasses.fields(part)}
    for path, value in changes.items():
        name, _, rest = path.partition(".")
        if name not in fields or (rest and not dataclasses.is_dataclass(getattr(part, name))):
            raise ModelError("the design has no such number", where=where + path, remedy=nearest(name, fields))
        if rest:
            own.setdefault(name, {})[rest] = value
        else:
            own[name] = (value, value) if isinstance(getattr(part, name), tuple) else value
    for name, value in own.items():
        if isinstance(value, dict):
            own[name] = _changed(getattr(part, name), value, f"{where}{name}.")
    static = getattr(part, "static_coefficient", None)
    if static is not None and "sliding_coefficient" in own:
        own.setdefault("static_coefficient", static / part.sliding_coefficient * own["sliding_coefficient"])
    return dataclasses.replace(part, **own)


def torques_of(
    design: Callable[[Mapping[str, float]], SpringFlywheel], loops: Sequence[Record], steps: int = STEPS
) -> LoopTorques:
    """What a design made of parameters by name would have shown in measured loops; the offsets of the sensors are
    parameters too where they are named.  ``steps``: of a cycle."""
    return LoopTorques(lambda values: on_rig(design(values)), ENDS, loops, steps)


def found_on_rig(
    design: Callable[[Mapping[str, float]], SpringFlywheel], loops: Sequence[Record], unknowns: Sequence[Unknown]
) -> Identified:
    """The parameters of a design with which it comes nearest to measured loops: roughly in long steps, from there on in
    short ones.

    ``design`` makes it of values by name.
    """
    measured = torques_in(loops)
    long, short = (torques_of(design, loops, steps) for steps in (ROUGH_STEPS, STEPS))
    near = identified(long, measured, unknowns, enough=ROUGH)
    return refined(short.extrapolated, measured, near, errors=short.errors, rough=short)


def viscous_share(system: System, loop: Followed, period: float) -> float:
    """What grease and the viscous part of friction take of the energy that all friction takes in a loop."""
    c = on_bench(system, *ENDS).system.connections
    rubs = np.flatnonzero([law is None or not law.carries_mean_torque for law in c.laws])
    twist = loop.twist[:, rubs].T
    rate = (twist - np.roll(twist, 1, axis=1)) * (twist.shape[1] / period)
    by_load = np.array([law.viscous_damping if isinstance(law, LuGre) else 0.0 for law in c.laws])
    viscous = (c.damping + by_load * loop.normal_load)[:, rubs].T * rate
    lost, all_lost = (loss_per_cycle(twist, torque) for torque in (viscous, loop.element_torque[:, rubs].T))
    return float(lost.sum() / all_lost.sum())
