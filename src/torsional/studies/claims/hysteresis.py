"""The claim about the friction of arc springs over rotational speed (F3), by loops under a slow sweep."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from torsional.absorbers import ArcSprings, CoilSpring, GuideFriction, arc_spring_flywheel
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain
from torsional.results import labelled
from torsional.solvers.hysteresis import hysteresis, model_hysteresis
from torsional.studies.answers import floats, rising
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.trucks import Trucks
from torsional.system import System, assemble
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

SPEEDS = np.array([0.0, 2000.0, 4000.0]) * RPM
LONG_SWEEPS = np.radians([2.0, 5.0, 20.0, 60.0])
SAMPLES = 240
"""Steps of a loop of the truck; three times as many change its loss by less than 1 %."""
TRUCK_SWEEPS = np.radians([1.0, 2.0, 5.0, 13.0])
"""Up to just before the truck's end stop."""

CONDITION = (
    "3°/s from rest until the loop closes, no inertia; sections are pressed by rotation and by the springs' curvature; "
    "the truck with arc springs within its stops, ±13° (±60° would measure the stops), and two arc springs of 165° "
    "with a travel of 70°, as passenger cars have them, with the same friction, at ±60°"
)


@cache
def long_arcs() -> System:
    """Two flywheels with two arc springs of 165° each: 72° of travel of their own, 250 Nm at 60°."""
    radius, arc = 0.115, np.radians(164.0)
    length = radius * float(arc)
    spring = CoilSpring(rate=8e3, free_length=length, solid_length=length - radius * float(np.radians(72.0)), mass=0.5)
    design = ArcSprings(
        primary_inertia=0.12,
        secondary_inertia=0.09,
        channels=2,
        radius=radius,
        channel_arc=float(np.radians(165.0)),
        stop_angle=float(np.radians(70.0)),
        secondary_clearance=(float(np.radians(1.0)),) * 2,
        spring=spring,
        segments=12,
        friction=GuideFriction(0.09, 0.11, viscous_coefficient=0.02),
        grease_damping=0.02,
    )
    return assemble(Powertrain(arc_spring_flywheel(design).components))


def truck_loops(model: Model, speed: Array = SPEEDS, sweep: Array = TRUCK_SWEEPS) -> xr.Dataset:
    """Loops of the truck's absorber."""
    return model_hysteresis(model, speed, sweep, samples=SAMPLES)


@cache
def _long_loops() -> xr.Dataset:
    """Loops of the flywheel with long arc springs, which are the same whatever the truck."""
    return hysteresis(long_arcs(), "primary", "secondary", SPEEDS, LONG_SWEEPS)


def stuck(loops: xr.Dataset) -> bool:
    """Whether fewer sections slide the faster it turns and the smaller the sweep, and some stick at the top speed."""
    count = loops.sliding.values
    fewer, more = bool((np.diff(count, axis=0) <= 0).all()), bool((np.diff(count, axis=1) >= 0).all())
    return fewer and more and bool(count[-1, 0] < int(loops.rubs.sum()) == count[0, 0])


def told(name: str, loops: xr.Dataset) -> dict[str, Figure]:
    """Figures of loops at the largest sweep over speed, and of what slides over speed and sweep."""
    largest = loops.isel(sweep=-1)
    at = f"{name}, ±{np.degrees(loops.sweep.values[-1]):.0f}°, at {_listed(loops.speed.values / RPM)} rpm"
    figures: dict[str, Figure] = {
        f"{at}: loss per cycle [J]": floats(largest.loss),
        f"{at}: stiffness [kNm/rad]": floats(largest.stiffness / 1e3),
        f"{at}: loss factor [-]": floats(largest.loss_factor),
    }
    sweeps = _listed(np.degrees(loops.sweep.values))
    for speed, row in zip(loops.speed.values, loops.sliding.values, strict=True):
        at = f"{name}, {speed / RPM:.0f} rpm, ±{sweeps}°: sliding sections of {int(loops.rubs.sum())}"
        figures[at] = floats(row)
    return figures


def _listed(values: Array) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def loops_drawn(data: xr.Dataset) -> Picture:
    """Loops at every speed, their losses, what slides."""
    from torsional.plots import plot_arc_friction

    return plot_arc_friction(data)


@claim(
    "F3",
    "3.1",
    "Friction and effective stiffness of arc springs grow with speed: the area of the hysteresis loop rises with "
    "rotational speed, and at high speed sections of the springs stick to their guide.",
    "loops at 0, 2000 and 4000 rpm at 3°/s: loss per cycle and chord stiffness rise strictly at the largest sweep; the "
    "number of sliding sections never rises with speed nor falls with the sweep, and some stick at 4000 rpm where all "
    "slide at standstill",
    varies="rotational speed 0, 2000 and 4000 rpm, sweep ±1 to 13° of the truck's absorber, ±2 to 60° of long arcs",
    picture=loops_drawn,
    leading="truck: loss at the highest speed over that at standstill [-]",
    trucks=0,  # the arc springs' design decides, which is none of the uncertain parameters
)
def f3(trucks: Trucks) -> Finding:
    truck, long = truck_loops(trucks.arc_spring), _long_loops()
    good = True
    for loops in (truck, long):
        good &= rising(loops.loss.values[:, -1]) and rising(loops.stiffness.values[:, -1]) and stuck(loops)
    figures = {**told("truck", truck), **told("long arcs", long)}
    loss = truck.loss.values[:, -1]
    figures["truck: loss at the highest speed over that at standstill [-]"] = float(loss[-1] / loss[0])
    return Finding(good, CONDITION, figures, dataset=_beside({"truck": truck, "long": long}))


def _beside(found: dict[str, xr.Dataset]) -> xr.Dataset:
    """Closed loops of the largest sweep, their loss and stiffness, and which share of the sections slides."""
    told: dict[str, tuple[tuple[str, ...], Any, str]] = {}
    coordinates: dict[str, tuple[Any, str]] = {"speed": (next(iter(found.values())).speed.values, "speed")}
    for name, loops in found.items():
        largest = loops.isel(sweep=-1)
        told |= {
            f"{name}_torque": (("speed", f"{name}_sample"), largest.drive_torque.sel(cycle="closed").values, "torque"),
            f"{name}_angle": ((f"{name}_sample",), largest.drive_angle.values, "relative_angle"),
            f"{name}_loss": (("speed",), largest.loss.values, "energy"),
            f"{name}_stiffness": (("speed",), largest.stiffness.values, "stiffness"),
            f"{name}_sliding": (("speed", f"{name}_sweep"), loops.sliding.values / int(loops.rubs.sum()), "efficiency"),
        }
        coordinates[f"{name}_sweep"] = (loops.sweep.values, "relative_angle")
    return labelled(told, coordinates, analysis="claim F3")
