"""The claim about longer time steps with numerical damping where gap-activated springs rattle (E2)."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from torsional.absorbers.straight_spring import StraightSprings
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Settings, begin, march
from torsional.solvers.transient.acting import row_of
from torsional.studies.answers import floats, main_order
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.loose_springs import SAMPLING, LooseMotion
from torsional.studies.straight_springs import DESIGN
from torsional.studies.swept import Along, Curve, swept
from torsional.studies.trucks import Trucks
from torsional.units import RPM

STEPS = np.array([0.05, 0.1, 0.2, 0.25, 0.5, 1.0]) * 1e-3
RADII = (1.0, 0.8, 0.5, 0.0)
RATTLING = ((650.0, 300.0), (700.0, 150.0), (800.0, 100.0))
"""Speeds [rpm] and mean torques [Nm] at which springs and tabs let go and meet again in every period."""
MIDDLE = RATTLING[1]
"""Of these, the one at which designs are varied."""
CLOSED = (700.0, 1000.0)
"""Where they stay closed."""
SMALL = 0.05
"""Error up to which little accuracy is lost."""
SEVERAL = 3.0
"""Times a step at least that count as several."""
LASTING, SKIPPED = 2.0, 0.5
"""A run, and what is left out of it until it is steady [s]."""
TOLERANCE = 1e-6
"""Of the motion that the others are measured by: ten times as tight changes nothing that is told."""
CONDITION = (
    "the truck's DMF with straight springs in three channels, their play 0.7° to 1°, shoes and tabs that only push, no "
    "dry friction, viscous grease; top gear, third order, 2 s from equilibrium on, the last 1.5 s told; contact times "
    "as they are, no guard; error: the largest of RMS and third order of the flywheels' relative angle, and RMS and "
    "third order of the twist from the secondary flywheel to the gearbox input, beside an explicit integrator's"
)


class Rattle:
    """A motion beside which steps are measured by what its vibration amounts to, not by where it is when.

    Rattling springs part trajectories that differ by rounding alone; RMS and orders stay.
    """

    def __init__(self, model: Model, rpm: float, torque: float, design: StraightSprings = DESIGN) -> None:
        self.motion = LooseMotion(model, rpm * RPM, torque, design)
        start, equations = self.motion.start, self.motion.problem.equations
        times = np.linspace(0.0, LASTING, round(LASTING / SAMPLING) + 1)
        self.exact = self.told(explicit_march(equations, times, start.angle, start.speed, tolerance=TOLERANCE).angles)

    def told(self, angles: Array) -> Array:
        """RMS and third order [rad] of two relative angles, of coordinates (time, N)."""
        system, marks = self.motion.system, self.motion.model.landmarks
        behind = row_of(system, marks.input) - row_of(system, "secondary")
        steady = angles[round(SKIPPED / SAMPLING) :]
        relative = np.column_stack([self.motion.twist(steady), steady @ behind])
        relative = relative - relative.mean(axis=0)
        time, window = SAMPLING * np.arange(len(relative)), np.hanning(len(relative))
        turning = window * np.exp(-1j * main_order(self.motion.model) * self.motion.speed * time)
        return np.concatenate([relative.std(axis=0), np.abs(2 * turning @ relative / window.sum())])

    def error(self, step: float, radius: float, guard: bool = False) -> float:
        """Largest relative error of what is told with a step [s]; infinite where the run is lost."""
        plan, start, method = self.motion.problem.plan, self.motion.start, AlphaMethod.chung_hulbert(radius)
        state, count = begin(plan, start.angle, start.speed), round(LASTING / step)
        settings = Settings(guard=guard, production=np.inf)
        run = march(plan, method, step, count, state, stride=round(SAMPLING / step), settings=settings)
        if not np.isfinite(run.records.q).all():
            return float("inf")
        return float(np.abs(self.told(run.records.q) / self.exact - 1).max())

    def errors(self, radius: float, guard: bool = False) -> Array:
        """`error` with every step of `STEPS`."""
        return np.array([self.error(float(step), radius, guard) for step in STEPS])


def largest(errors: Array) -> float:
    """The largest step [s] up to which all errors are small; 0 without one.

    >>> largest(np.array([1e-3, 2e-3, 0.1, 1e-3, 1e-3, 1e-3])), largest(np.full(6, 1.0))
    (0.0001, 0.0)
    """
    good = int(np.argmin(np.append(errors <= SMALL, False)))
    return float(STEPS[good - 1]) if good else 0.0


def growth(table: Mapping[float, Array]) -> float:
    """How much longer than with radius 1 the step may be with the best radius below."""
    plain = largest(table[1.0])
    best = max(largest(errors) for radius, errors in table.items() if radius < 1.0)
    return best / plain if plain else float("nan")


VARIED = {
    "grease a third": dataclasses.replace(DESIGN, grease_damping=DESIGN.grease_damping / 3),
    "grease three times": dataclasses.replace(DESIGN, grease_damping=DESIGN.grease_damping * 3),
    "play half": dataclasses.replace(DESIGN, play_factors=tuple(0.5 * factor for factor in DESIGN.play_factors)),
    "play twice": dataclasses.replace(DESIGN, play_factors=tuple(2.0 * factor for factor in DESIGN.play_factors)),
}
"""What is uncertain of the design, at the second of the operating points."""

PROVISO = (
    "where springs and tabs let go and meet again, with a spectral radius of about 0.5 and measured by RMS and orders"
)
REASON = (
    "undamped steps are lost to energy that hard contacts make from {lost:g} ms on, damped ones are not; a radius of "
    "0.8 damps too little at light load, a radius of 0 takes too much. Where the springs stay closed there is nothing "
    "to damp and nothing is gained; trajectories of rattling springs part whatever the step and measure none"
)


@claim(
    "E2",
    "6.1",
    "With numerical damping the time step can grow several times with little loss of accuracy.",
    "error of RMS and third order over steps of 0.05 to 1 ms with spectral radius 1 and below: at every operating "
    "point at which springs rattle, the largest step up to which the error stays within 5 % is at least three times as "
    "long with some radius below 1 as with 1",
    varies="time step from 0.05 to 1 ms in six steps, spectral radius 1, 0.8, 0.5 and 0, three operating points",
    leading="smallest gain [-]",
    trucks=0,  # about a method, not about trucks
)
def e2(trucks: Trucks) -> Finding:
    figures: dict[str, Figure] = {"steps [ms]": floats(1e3 * STEPS)}
    gains, tables, curves = [], list[Mapping[float, Array]](), dict[str, Curve]()
    for rpm, torque in RATTLING:
        place, at = Rattle(trucks.dmf, rpm, torque), f"at {rpm:g} rpm, {torque:g} Nm"
        table = {radius: place.errors(radius) for radius in RADII}
        gains.append(growth(table))
        tables.append(table)
        figures |= told(at, table)
        curves |= _drawn(rpm, torque, table)
        if (rpm, torque) == MIDDLE:
            figures[f"error {at}, radius 1, contact times of at least half a step [%]"] = _percent(
                place.errors(1.0, guard=True)
            )
    others = _closed_and_varied(trucks.dmf)
    figures |= others | {"smallest gain [-]": min(gains)}
    good = min(gains) >= SEVERAL
    nothing = next(iter(others.values())) == 1.0
    reason = _why(tables, nothing) if good else "the step grows by less than three times at some point"
    drawn = swept("E2", Along("step", STEPS, "time", "time step", "log"), curves)
    return Finding(good, CONDITION, figures, reason, drawn, PROVISO if good else "")


def _why(tables: Sequence[Mapping[float, Array]], closed: bool) -> str:
    """The mechanism, where it shows: undamped steps are lost, those of radius 0.5 never, those of 0.8 at the lightest
    load; a radius of 0 has the largest error at the longest step; nothing is gained with springs ``closed``."""
    undamped, half = ([table[radius] >= 1.0 for table in tables] for radius in (1.0, 0.5))
    lost = np.any(undamped, axis=0)
    shown = lost.any() and not np.any(half) and bool((tables[-1][0.8] >= 1.0).any())
    shown = shown and all(table[0.0][-1] > table[0.5][-1] for table in tables) and closed
    return REASON.format(lost=1e3 * STEPS[lost].min()) if shown else ""


def _drawn(rpm: float, torque: float, table: Mapping[float, Array]) -> dict[str, Curve]:
    """Errors over the step; runs that are lost lie beyond the picture."""
    panel = f"{rpm:g} rpm, {torque:g} Nm: error of RMS and third order"
    limit: dict[str, Any] = {"limit": SMALL, "limit_words": f"criterion: within {100 * SMALL:g} %"}
    return {
        f"error_{rpm:.0f}_{100 * radius:.0f}": Curve(
            np.where(found < 1.0, found, np.inf),
            "relative_difference",
            f"spectral radius {radius:g}" + (" (arrow: lost)" if (found >= 1.0).any() else ""),
            panel,
            scale="log",
            **(limit if radius == 1.0 else {}),
        )
        for radius, found in table.items()
    }


def told(at: str, table: Mapping[float, Array]) -> dict[str, Figure]:
    """Errors by radius, and the gain."""
    figures: dict[str, Figure] = {
        f"error {at}, spectral radius {radius:g} [%]": _percent(found) for radius, found in table.items()
    }
    return figures | {f"gain {at} [-]": growth(table)}


def _closed_and_varied(model: Model) -> dict[str, Figure]:
    """Gains where the springs stay closed, and with other designs."""
    places = {f"at {CLOSED[0]:g} rpm, {CLOSED[1]:g} Nm, springs closed": Rattle(model, *CLOSED)}
    places |= {name: Rattle(model, *MIDDLE, design) for name, design in VARIED.items()}
    gains = {name: growth({radius: place.errors(radius) for radius in (1.0, 0.5)}) for name, place in places.items()}
    return {f"gain, {name} [-]": gain for name, gain in gains.items()}


def _percent(errors: Array) -> tuple[str, ...]:
    return tuple(f"{100 * error:.2g}" if error < 1.0 else "lost" for error in errors)
