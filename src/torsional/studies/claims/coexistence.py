"""The claim that several stable motions exist at one speed and load (B5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.periodic.branches import Explorer
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.studies.answers import by_idle, by_peak, floats, main_order
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.pictured import Line, branch_points, draw_motions
from torsional.studies.motions import (
    TWIST,
    distinct,
    in_time,
    over_torque,
    rest_of,
    stable,
    state_of,
    twist_orders,
    twist_swing,
)
from torsional.studies.settling import Stepped, order_of
from torsional.studies.stiffness_step import transition_torque
from torsional.studies.trucks import Trucks, hinged, replaced
from torsional.units import RPM

DAMPINGS = (1.0, 0.75, 0.5, 0.25)
"""Dampings of the DMF over the model's that are asked, its own first; the first with an answer is shown in time."""
SPEEDS = np.arange(840.0, 981.0, 20.0) * RPM
LOWEST, GRID = 800.0, 25.0
"""Lowest mean torque and step [Nm]."""
CONDITION = (
    "two-stage DMF, transition {transition:.0f} Nm, top gear, {low:.0f}–{high:.0f} rpm in steps of {step:.0f}, mean "
    "torques in steps of {grid:.0f} Nm, motions short of the stop; orders 0-peak"
)
LESS = (
    "with little damping only: at the model's {own:g} Nms/rad no speed and load has two, at {shown:g} Nms/rad some "
    "have, the loudest of those shown swinging to {reach:.3f} of the stop's angle"
)
OFF, SETTLING = 1.03, 600
"""Factor on a motion at the start of a run in time, and periods of the firing in which it settles."""


@dataclass(frozen=True, eq=False)
class Place:
    """A speed [rad/s] and mean torque [Nm] with its stable motions."""

    explorer: Explorer
    speed: float
    torque: float
    motions: tuple[tuple[HarmonicProblem, Array], ...]


def places(model: Model, speed: float) -> list[Place]:
    """The grid points over mean torque, within full load, at which more than one motion short of the stop is stable."""
    low, step = by_peak(model, LOWEST), by_peak(model, GRID)
    grid = np.arange(low, float(model.running_engine.full_load_torque(speed)), step)
    if grid.size < 2:
        return []
    explorer = over_torque(model, speed, (float(grid[0]), float(grid[-1])))
    if not any(branch.events for branch in explorer.branches[1:]):
        return []
    found, stop = [], max(hinged(model, model.landmarks.springs[0]).stops)
    for torque in map(float, grid):
        motions = tuple(
            (p, z) for p, z in distinct(explorer, torque) if twist_swing(p, z)[1] < stop and stable(p, z[None])[0]
        )
        found += [Place(explorer, speed, torque, motions)] if len(motions) > 1 else []
    return found


def returns(place: Place, model: Model, problem: HarmonicProblem, z: Array) -> tuple[float, float]:
    """Relative errors of half the firing order and of the firing order in the DMF's twist after runs in time that began
    off a motion, over its largest harmonic: exact between hinges, and by time steps."""
    timed = in_time(place.explorer, place.torque)
    start = rest_of(problem, z, timed)
    start = start + OFF * (state_of(problem, z, timed) - start)
    exact = twist_orders(timed, timed.flow(start, SETTLING).state, 2)[1:3]
    line = Stepped.of(model, place.speed, place.torque)
    steps = told(model, line.settled(line.begun(timed, start)))
    own = np.array([_size(problem, z, order) for order in asked(model)])
    largest = np.abs(problem.harmonics_of(z)[0, 1:]).max()
    return float(np.abs(exact - own).max() / largest), float(np.abs(steps - own).max() / largest)


def asked(model: Model) -> tuple[float, float]:
    """Half the firing order, and the firing order."""
    return main_order(model) / 2, main_order(model)


def told(model: Model, found: xr.Dataset) -> Array:
    """0-peak of the two orders of the DMF's twist [rad] in a steady motion by time steps."""
    return np.array([order_of(found, model.landmarks.springs[0], order) for order in asked(model)])


def _size(problem: HarmonicProblem, z: Array, order: float) -> float:
    """0-peak of one order of the DMF's twist [rad]."""
    harmonics, place = problem.harmonics_of(z)[0], order / problem.base_order
    return float(abs(harmonics[round(place)])) if abs(place - round(place)) < 1e-9 else 0.0


def _apart(place: Place) -> float:
    """How far the two motions that are most alike in order 1.5 are from each other, over the largest."""
    half = 0.5 * place.explorer.base_order
    sizes = np.sort([_size(p, z, half) for p, z in place.motions])
    return float(np.diff(sizes).min() / (sizes.max() or 1.0))


def _ranges(found: list[Place]) -> list[str]:
    """Speeds with the mean torques between which motions coexist."""
    told = []
    for speed in sorted({place.speed for place in found}):
        torques = [place.torque for place in found if place.speed == speed]
        ends = dict.fromkeys(f"{torque:g}" for torque in (min(torques), max(torques)))
        told.append(f"{speed / RPM:.0f} rpm: {'–'.join(ends)} Nm")
    return told


@claim(
    "B5",
    "6.1",
    "Several stable steady states can coexist at one speed and load.",
    "at one speed and mean torque, within full load, at least two stable periodic motions; runs in time that begin 3 % "
    "off either, exact between hinges and by time steps, stay with it, orders 1.5 and 3 within 2 %; where the model's "
    "own damping shows none but less of it does, that is the condition",
    varies="engine speed from 1.4 to 1.63 of idle in eight steps, mean torque in steps of 1 % of full load's peak; "
    "damping of the DMF × 1, 0.75, 0.5 and 0.25",
    picture=draw_motions,
    leading="most stable motions at one place [-]",
    trucks=40,
)
def b5(trucks: Trucks) -> Finding:
    spring = trucks.two_stage.landmarks.springs[0]
    condition, own = _condition(trucks.two_stage), float(trucks.two_stage.components[spring].damping)  # type: ignore[attr-defined]
    variants = {c: replaced(trucks.two_stage, spring, damping=c) for c in (own * part for part in DAMPINGS)}
    speeds = by_idle(trucks.two_stage, SPEEDS)
    found = {c: [place for speed in speeds for place in places(m, float(speed))] for c, m in variants.items()}
    figures: dict[str, Figure] = {f"{c:g} Nms/rad: where": tuple(_ranges(found[c])) for c in variants}
    answered = [c for c in variants if found[c]]
    most = max((len(place.motions) for c in answered for place in found[c]), default=1)
    figures["most stable motions at one place [-]"] = float(most)
    if not answered:
        return Finding(False, condition, figures, "no stable motions beside each other were found")
    shown = max(found[answered[0]], key=_apart)
    stop = max(hinged(trucks.two_stage, spring).stops)
    model, (half, main) = variants[answered[0]], asked(trucks.two_stage)
    exact, steps = np.array([returns(shown, model, problem, z) for problem, z in shown.motions]).T
    equilibrium = told(model, Stepped.of(model, shown.speed, shown.torque).settled())
    figures |= {
        "shown at [Nms/rad]": answered[0],
        "shown at [rpm]": shown.speed / RPM,
        "shown at [Nm]": shown.torque,
        "DMF twist of order 1.5 [rad]": floats([_size(p, z, half) for p, z in shown.motions]),
        "DMF twist of order 3 [rad]": floats([_size(p, z, main) for p, z in shown.motions]),
        "largest twist over the stop's [-]": floats([twist_swing(p, z)[1] / stop for p, z in shown.motions]),
        "difference to the run in time [%]": floats(100 * exact),
        "difference to the run by time steps [%]": floats(100 * steps),
        "orders 1.5 and 3 by time steps from equilibrium [rad]": floats(equilibrium),
    }
    good = len(shown.motions) > 1 and max(*exact, *steps) < 0.02
    reach = max(twist_swing(p, z)[1] for p, z in shown.motions) / stop
    proviso = "" if found[own] else LESS.format(own=own, shown=answered[0], reach=reach)
    data = _drawn(model, found[answered[0]], shown)
    return Finding(good, condition, figures, "" if good else OTHERWISE, data, proviso if good else "")


OTHERWISE = "runs in time do not stay with both"


def _condition(model: Model) -> str:
    """What is asked, in words."""
    speeds = by_idle(model, SPEEDS) / RPM
    grid = {"low": speeds[0], "high": speeds[-1], "step": speeds[1] - speeds[0], "grid": by_peak(model, GRID)}
    return CONDITION.format(transition=transition_torque(model), **grid)


def _drawn(model: Model, found: list[Place], shown: Place) -> xr.Dataset:
    """The branches over mean torque at the speed that is shown, and what runs in time stay with."""
    branches, whole = shown.explorer.branches, shown.explorer.base_order
    named = [("doubled period" if branch.base_order < whole else "period of the firing", branch) for branch in branches]
    lines = [Line(branch, f"{words}, branch {n}") for n, (words, branch) in enumerate(named, 1)]
    torques = [place.torque for place in found if place.speed == shown.speed]
    half, main = asked(model)
    sizes = [[shown.torque, _size(p, z, half), _size(p, z, main)] for p, z in shown.motions]
    told = {"bands": {f"stable beside each other at {shown.speed / RPM:.0f} rpm": [min(torques), max(torques)]}}
    runs = {"runs in time stay here": sizes}
    return branch_points("B5", model, lines, ("mean_torque", "torque"), TWIST, "relative_angle", runs=runs, **told)
