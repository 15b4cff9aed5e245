"""The claim about damping at start-up and losses in driving of arc springs (F4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from torsional.files import changed
from torsional.files.scenario import load_scenario
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.hysteresis import absorber_ends, hysteresis, model_hysteresis
from torsional.solvers.transient import transient
from torsional.studies.answers import floats, main_order
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.hysteresis import long_arcs
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.running import run_plan
from torsional.studies.trucks import Trucks
from torsional.system import assemble
from torsional.units import RPM

START_SPEEDS, START_SWEEP = (100.0, 200.0, 300.0), np.radians(10.0)
"""Of starts [rpm], [rad]: the largest angle is bounded by the stop at 13.75°."""
DRIVING = ((1000.0, 0.6), (1400.0, 0.6), (1800.0, 0.6), (1400.0, 0.2))
"""Speeds [rpm], and mean torques over the peak of full load."""
LASTING, TURNS = 1.0, 12
"""A run in driving [s], and the turns of the crank at its end that are told."""
LONG_START, LONG_DRIVING = (200.0, np.radians(40.0), 0.0), (2000.0, np.radians(0.5), np.radians(36.0))
"""Speed [rpm], swing and middle [rad] of long arcs, as passenger cars have them."""
RUBBING = ("sliding_coefficient", "static_coefficient", "viscous_coefficient")
PARTLY, WHOLLY = 4.0 / (3.0 * np.pi), 1.0 / np.pi
"""Loss factors of a long row on dry ground: where it slides in part, and what it stays below where all of it slides
under its own load, (1 − e^−µα)/π."""


class Loop(NamedTuple):
    """Measures of a loop at the pace of a vibration: chord stiffness [Nm/rad], loss [J] a vibration and its power [W],
    loss factor [-], viscous coefficient [Nms/rad] and friction torque [Nm] of the same loss."""

    stiffness: float
    loss: float
    power: float
    loss_factor: float
    viscous: float
    torque: float

    @classmethod
    def of(cls, loops: xr.Dataset, swing: float, frequency: float) -> Loop:
        """By the swing [rad] and the frequency [Hz]."""
        loss = loops.loss.item()
        viscous = loss / (2 * np.pi**2 * frequency * swing**2)
        return cls(
            loops.stiffness.item(), loss, loss * frequency, loops.loss_factor.item(), viscous, loss / (4 * swing)
        )


class Driven(NamedTuple):
    """The truck in driving: middle and third order [rad] of the flywheels' relative angle, friction's power [W]."""

    middle: float
    swing: float
    power: float


def driven(model: Model, rpm: float, share: float) -> Driven:
    """The detailed truck in time, steady in top gear under a share of its largest torque."""
    front, back = absorber_ends(model)
    engine, marks, speed = model.running_engine, model.landmarks, rpm * RPM
    orders = np.arange(0.0, 12.5, 0.5)
    drive = engine.excitation(marks.throws, speed, share * model.full_load_peak(), orders)
    line = assemble(model.detailed().powertrain())
    run = transient(line, drive, LASTING, "vibrating", hold=marks.load, step=1e-4, output=2e-4)
    run = run.isel(time=run.time.values > run.time.values[-1] - TURNS * 2 * np.pi / speed)
    time, guides = run.time.values, [name for name in run.element.values if str(name).endswith("_guide")]
    relative = (run.angle.sel(node=front) - run.angle.sel(node=back)).values
    third = 2 * np.mean((relative - relative.mean()) * np.exp(-1j * main_order(model) * speed * time))
    rate = np.gradient(run.twist.sel(element=guides).transpose("time", "element").values, time, axis=0)
    rubbed = run.torque.sel(element=guides).transpose("time", "element").values * rate
    return Driven(float(relative.mean()), float(np.abs(third)), float(rubbed.sum(axis=1).mean()))


def looped(model: Model, rpm: float, swing: float, middle: float = 0.0) -> Loop:
    """The absorber's loop at the pace of the firing order."""
    frequency = main_order(model) * rpm * RPM / (2.0 * np.pi)
    loops = model_hysteresis(model, rpm * RPM, swing, rate=4 * swing * frequency, centre=middle)
    return Loop.of(loops, swing, frequency)


def _long_looped(rpm: float, swing: float, middle: float) -> Loop:
    """The loop of long arcs at the pace of the second order, that of four cylinders."""
    frequency = 2.0 * rpm * RPM / (2.0 * np.pi)
    loops = hysteresis(long_arcs(), "primary", "secondary", rpm * RPM, swing, rate=4 * swing * frequency, centre=middle)
    return Loop.of(loops, swing, frequency)


def rubbed(model: Model, times: float) -> Model:
    """A copy whose guides, and inner against outer springs, have so many times the coefficients of friction."""
    block = model.document["absorber"]
    edits = {f"absorber.friction.{key}": times * float(block["friction"][key]) for key in RUBBING}
    inner = times * float(block["inner_friction"]["sliding_coefficient"])
    return changed(model, edits | {"absorber.inner_friction.sliding_coefficient": inner})


def passed_on(model: Model) -> float:
    """The largest torque [Nm] of the clutch in an engine start in neutral."""
    run = run_plan(planned(load_scenario("engine_start", ["duration=1.5 s", "firing_from=0.65 s"]), model))
    return float(np.abs(run.torque.sel(element=model.landmarks.clutch).values).max())


CONDITION = (
    "start-up ±10° about no torque at 100, 200, 300 rpm; driving at 1000, 1400, 1800 rpm under 60 % and 1400 rpm under "
    "20 % of the largest torque, about the angle and by the third order that the truck has there in time; loops at the "
    "pace of the third order, no inertia"
)


@claim(
    "F4",
    "3.1",
    "At start-up, with large angles at low speed, an arc-spring flywheel has much damping and little stiffness; in "
    "normal driving its losses are small.",
    "chord stiffness lower, and loss per vibration and loss factor higher, at start-up than in driving, for every pair "
    "of operating points; damping and losses in other measures are told beside them",
    trucks=0,  # the arc springs' design decides, which is none of the uncertain parameters
)
def f4(trucks: Trucks) -> Finding:
    model = trucks.arc_spring
    start = [looped(model, rpm, START_SWEEP) for rpm in START_SPEEDS]
    motions = [driven(model, *point) for point in DRIVING]
    driving = [looped(model, rpm, at.swing, at.middle) for (rpm, _), at in zip(DRIVING, motions, strict=True)]
    figures: dict[str, Figure] = {
        "driving: third order of the angle [°]": floats([np.degrees(motion.swing) for motion in motions]),
        "driving: power of friction in time [W]": floats([motion.power for motion in motions]),
    }
    for name, unit, measure in MEASURES:
        figures |= {
            f"{state}: {name} [{unit}]": floats(measured(loops, measure))
            for state, loops in (("start-up", start), ("driving", driving))
        }
    figures |= uncertain(model, motions[1])
    softer = _above(driving, start, lambda loop: loop.stiffness)
    more = _above(start, driving, lambda loop: loop.loss)
    damped = _above(start, driving, lambda loop: loop.loss_factor)
    return Finding(softer and more and damped, CONDITION, figures, _reason(softer, more, damped))


MEASURES: tuple[tuple[str, str, Callable[[Loop], float]], ...] = (
    ("stiffness", "kNm/rad", lambda loop: loop.stiffness / 1e3),
    ("loss per vibration", "J", lambda loop: loop.loss),
    ("power lost", "W", lambda loop: loop.power),
    ("loss factor", "-", lambda loop: loop.loss_factor),
    ("viscous coefficient of the same loss", "Nms/rad", lambda loop: loop.viscous),
    ("friction torque of the same loss", "Nm", lambda loop: loop.torque),
)


def measured(loops: Sequence[Loop], measure: Callable[[Loop], float]) -> Array:
    """One measure of several loops."""
    return np.array([measure(loop) for loop in loops])


def _above(upper: Sequence[Loop], lower: Sequence[Loop], measure: Callable[[Loop], float]) -> bool:
    """Whether a measure is higher for every pair."""
    return bool(measured(upper, measure).min() > measured(lower, measure).max())


def uncertain(model: Model, motion: Driven) -> dict[str, Figure]:
    """Loss factors with less and more friction, with long arcs, and of so small angles that sections stick; what
    friction does to an engine start."""
    figures: dict[str, Figure] = {}
    for times in (0.5, 2.0):
        other, rpm = rubbed(model, times), DRIVING[1][0]
        pair = looped(other, START_SPEEDS[1], START_SWEEP), looped(other, rpm, motion.swing, motion.middle)
        figures[f"friction times {times:g}, start-up and driving: loss per vibration [J]"] = floats(
            [loop.loss for loop in pair]
        )
        figures[f"friction times {times:g}, start-up and driving: loss factor [-]"] = floats(
            [loop.loss_factor for loop in pair]
        )
    long = _long_looped(*LONG_START), _long_looped(*LONG_DRIVING)
    small = [looped(model, DRIVING[2][0], np.radians(swing), motion.middle).loss_factor for swing in (0.1, 0.03, 0.01)]
    return figures | {
        "long arcs, ±40° at 200 rpm and ±0.5° about 36° at 2000 rpm: loss per vibration [J]": floats(
            [loop.loss for loop in long]
        ),
        "the same: loss factor [-]": floats([loop.loss_factor for loop in long]),
        "driving at 1800 rpm, ±0.1, 0.03, 0.01°: loss factor [-]": floats(small),
        "a long row that slides in part: loss factor [-]": float(PARTLY),
        "a row that slides as a whole under its own load: loss factor below [-]": float(WHOLLY),
        "engine start, friction times 0.02, 1, 2: largest torque passed on [Nm]": floats(
            [passed_on(rubbed(model, times)) for times in (0.02, 1.0, 2.0)]
        ),
    }


def _reason(softer: bool, more: bool, damped: bool) -> str:
    if softer and more and damped:
        return ""
    held = [text for good, text in ((softer, "softer"), (more, "losing more energy a vibration")) if good]
    kept = f"at start-up it is {' and '.join(held)}, as claimed" if held else "at start-up it is not softer"
    if damped:
        return kept
    return (
        f"{kept}: damping read as energy taken from a vibration. Over the energy stored, as viscous coefficient or as "
        "friction torque it damps less than in driving, in which mean torque and rotation press the sections: such a "
        "row slides in part, its loss factor near 4/(3π), while at start-up all of it slides under its own load "
        "alone, and whatever the friction coefficient µ on an arc α its loss factor (1 − e^−µα)/π stays below 1/π. "
        "Friction takes little from an engine start here"
    )
