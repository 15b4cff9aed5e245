"""The claim that without mean torque friction is viscous, and Coulomb's law does not suffice (F2)."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.absorbers import GuideFriction, StraightSprings
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.solvers.hysteresis import Course
from torsional.studies.answers import floats
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.identification import (
    EXPLAINED,
    SEED,
    SENSORS,
    compared,
    flywheel_values,
    greased,
    identified_flywheel,
    rig_flywheel,
)
from torsional.studies.estimates import Identified
from torsional.studies.records import Record
from torsional.studies.rig import STEPS, Point, course, found_on_rig, measured_on_rig, met, on_rig, viscous_share
from torsional.studies.trucks import Trucks
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

SPEEDS = tuple(speed * RPM for speed in (0.0, 300.0, 900.0))
SWEEPS = tuple(np.radians([1.0, 4.0]).tolist())
SLOW, FAST = 1.0, 20.0
POINTS = tuple(Point(speed, sweep, 0.0, pace) for speed in SPEEDS for sweep in SWEEPS for pace in (SLOW, FAST))
"""Without mean torque, swung slowly and fast [Hz]."""
FREQUENCIES = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0)
LOADED = 1200.0
"""Mean torque [Nm] beside which the share of viscous friction is told."""
CLEARLY = 10.0
"""Standard deviations of its sum of squares by which a model must leave more than another to be rejected."""
VISCOUS = ("friction.viscous_coefficient", "grease_damping")
SEARCHED = 30.0
"""Up to how many times the truth the damping of a model without friction is looked for."""


CONDITION = (
    "a virtual rig: a flywheel of straight springs with shoes, no mean torque, 0, 300, 900 rpm, ±1 and 4°, swung at 1 "
    "and 20 Hz; noise of 2 % of half the swing in torque and in angle, both zeros unknown; no inertia; shares from 1 "
    "to 60 Hz and beside 1200 Nm; the guide's viscous coefficient (0.02 s/m) and the grease (0.3 Nms/rad a shoe) are "
    "assumed"
)


def dry(values: Mapping[str, float]) -> StraightSprings:
    """Coulomb's friction alone: one coefficient, nothing that grows with the rate."""
    coulomb = GuideFriction(values["friction.sliding_coefficient"], bristle_time=0.0, viscous_coefficient=0.0)
    plain = {name: value for name, value in values.items() if name != "friction.sliding_coefficient"}
    return dataclasses.replace(greased(plain), friction=coulomb, grease_damping=0.0)


def viscous(values: Mapping[str, float]) -> StraightSprings:
    """Grease alone, no friction."""
    return dataclasses.replace(greased(values), friction=None)


def fitted(
    design: Callable[[Mapping[str, float]], StraightSprings], loops: Sequence[Record], full: Identified, *without: str
) -> Identified:
    """A model with fewer parameters, begun where the full one ended."""
    asked = [dataclasses.replace(u, start=full.values[u.name]) for u in full.unknowns if u.name not in without]
    if "grease_damping" not in without:
        asked = [dataclasses.replace(u, high=SEARCHED * u.high) if u.name == "grease_damping" else u for u in asked]
    return found_on_rig(design, loops, asked)


def excess(model: Identified, full: Identified) -> float:
    """By how much more squares a model leaves than the full one, over the standard deviation √2N of their sum."""
    count = sum(each.size for each in full.residuals)
    return (model.misfit**2 - full.misfit**2) / full.misfit**2 * count / float(np.sqrt(2.0 * count))


def shares(design: StraightSprings, load: float) -> Array:
    """Share of viscous friction in the energy that friction takes in a loop, over speeds, sweeps and frequencies."""
    points = [Point(speed, sweep, load, pace) for speed in SPEEDS for sweep in SWEEPS for pace in FREQUENCIES]
    courses: list[Course] = [course(design, point, STEPS) for point in points]
    loops = zip(points, met(design, courses), strict=True)
    system = on_rig(design)
    found = [viscous_share(system, loop, 1.0 / point.frequency) for point, loop in loops]
    return np.array(found).reshape(len(SPEEDS), len(SWEEPS), len(FREQUENCIES))


def judged(full: Identified, others: Mapping[str, Identified], unloaded: Array, loaded: Array) -> dict[str, Figure]:
    """What the models leave, and what share of the energy viscous friction takes."""
    figures: dict[str, Figure] = {"viscous and dry friction: residuals over the noise, RMS [-]": full.misfit}
    for name, model in others.items():
        figures[f"{name}: residuals over the noise, RMS [-]"] = model.misfit
        figures[f"{name}: the same of the worst loop [-]"] = float(model.misfits.max())
        figures[f"{name}: squares left beyond those, in their standard deviations [-]"] = excess(model, full)
        criteria = model.aicc - full.aicc, model.bic - full.bic
        figures[f"{name}: Akaike's (AICc) and Schwarz's criterion above those [-]"] = criteria
    at = f"viscous share of friction's loss, ±{', '.join(f'{np.degrees(a):.0f}' for a in SWEEPS)}°"
    rpm = ", ".join(f"{speed / RPM:.0f}" for speed in SPEEDS)
    for pace in (SLOW, FAST, FREQUENCIES[-1]):
        place = FREQUENCIES.index(pace)
        for words, share in (("no mean torque", unloaded), (f"{LOADED:.0f} Nm", loaded)):
            figures[f"{at} at {rpm} rpm, {pace:.0f} Hz, {words} [%]"] = floats(100.0 * share[..., place].T)
    needed = (1.0 / unloaded - 1.0)[..., FREQUENCIES.index(FAST)]
    figures[f"viscosity for half of it without mean torque at {FAST:.0f} Hz, over the assumed one [-]"] = floats(
        needed.T
    )
    return figures


def where(unloaded: Array) -> str:
    """In words, where viscous friction takes more than half of the loss."""
    told = []
    for speed, rows in zip(SPEEDS, unloaded, strict=True):
        for sweep, row in zip(SWEEPS, rows, strict=True):
            above = [pace for pace, share in zip(FREQUENCIES, row, strict=True) if share > 0.5]
            if above:
                told.append(f"{speed / RPM:.0f} rpm and ±{np.degrees(sweep):.0f}° from {min(above):.0f} Hz on")
    return "; ".join(told)


def drawn(data: xr.Dataset) -> Picture:
    """What is left of loops without their spring; residuals of both models; the share of viscous friction."""
    from torsional.plots.identification import plot_rig_friction

    return plot_rig_friction(data)


@claim(
    "F2",
    "6.1",
    "With zero mean torque viscous friction dominates, and a pure Coulomb model does not suffice.",
    "fitted to loops of a virtual rig without mean torque, swung at 1 and 20 Hz: LuGre's friction with its viscous "
    "part and grease leaves the noise alone, Coulomb's leaves more by over ten standard deviations of the squares; "
    "viscous friction takes over half of friction's loss, and more of it than under a high mean torque. Where it does "
    "so at some operating points only, these are the condition",
    varies="the law of friction; 3 rotational speeds × 2 amplitudes × 2 frequencies; mean torque",
    picture=drawn,
    trucks=0,  # about the law of friction: the flywheel on the rig is the study's own, no truck's
)
def f2(trucks: Trucks) -> Finding:
    loops = measured_on_rig(rig_flywheel(), POINTS, SENSORS, SEED)
    full = identified_flywheel(loops)
    coulomb = fitted(dry, loops, full, *VISCOUS)
    grease = fitted(viscous, loops, full, "friction.sliding_coefficient", VISCOUS[0])
    design = greased(flywheel_values(full))
    unloaded, loaded = shares(design, 0.0), shares(design, LOADED)
    rejected = full.misfit <= EXPLAINED and excess(coulomb, full) > CLEARLY
    less = bool(loaded.mean() < unloaded.mean())
    region = where(unloaded)
    everywhere = bool((unloaded > 0.5).all())
    figures = judged(full, {"Coulomb's friction": coulomb, "grease alone": grease}, unloaded, loaded)
    data = (
        compared(loops, POINTS, fitted=full, coulomb=coulomb).merge(_field(unloaded, loaded)).assign_attrs(load=LOADED)
    )
    good = rejected and less and bool(region)
    proviso = "" if everywhere or not good else _proviso(region, coulomb, grease)
    return Finding(good, CONDITION, figures, "" if good else _reason(rejected, less, region), data, proviso)


def _field(unloaded: Array, loaded: Array) -> xr.Dataset:
    over = ("rotation", "swing", "pace")
    values = {"unloaded": (over, unloaded, "energy_share"), "loaded": (over, loaded, "energy_share")}
    axes = {"rotation": (np.array(SPEEDS), "speed"), "swing": (np.array(SWEEPS), "relative_angle")}
    return labelled(values, {**axes, "pace": (np.array(FREQUENCIES), "frequency")}, analysis="loops on a rig")


def _proviso(region: str, coulomb: Identified, grease: Identified) -> str:
    dry_first = coulomb.misfit < grease.misfit
    told = (
        "Coulomb's friction does not suffice, but viscous friction takes over half of friction's loss only at "
        f"{region}; inertia is left out, by which shoes that cross the clearance strike the tabs at such frequencies "
        "(see F1)"
    )
    if dry_first:
        told += (
            "; elsewhere rotation presses the shoes and dry friction takes more, and of the two alone Coulomb's leaves "
            "less. The coefficients are assumed: the figures say how much more viscous a flywheel must be for the rest"
        )
    return told


def _reason(rejected: bool, less: bool, region: str) -> str:
    told = [] if rejected else ["Coulomb's friction is not rejected, or the full model leaves more than noise"]
    told += [] if less else ["viscous friction takes no larger share without mean torque than under it"]
    told += [] if region else ["viscous friction takes over half of the loss nowhere: dry friction is larger"]
    return "; ".join(told)
