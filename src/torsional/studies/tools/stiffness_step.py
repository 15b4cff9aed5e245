"""`stiffness-step`: sub-harmonic vibration of a dual mass flywheel of two stages over the step between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.advice import advised, drawn, over, positive, values_of
from torsional.studies.answers import main_order
from torsional.studies.base import tool
from torsional.studies.motions import INPUT_ACCELERATION, SHAFT, SPRING, TWIST, doubled, over_speed
from torsional.studies.stiffness_step import carrying, searched, stepped, transition_torque
from torsional.studies.strongest import HIGHEST_ORDER
from torsional.studies.swept import Along, Curve
from torsional.studies.trucks import Trucks
from torsional.units import RPM

DIFFERENCES = (1.25, 1.5, 2.0, 2.5, 3.0, 3.25)
"""k2 − k1 over k1."""


@dataclass(frozen=True)
class Strongest:
    """Of one step: largest amplitudes (0-peak) of half the firing order, speed [rad/s] and mean torque [Nm] of the
    largest torque in the springs, and the speeds [rad/s] between which it lives at that torque; not a number for none.
    """

    amplitudes: Array
    speed: float = np.nan
    torque: float = np.nan
    ends: tuple[float, float] = (np.nan, np.nan)


@tool(
    "stiffness-step",
    varies="stiffness of the second stage at one of the first, engine speed, mean torque",
    picture=drawn,
)
def stiffness_step(
    trucks: Trucks,
    *,
    first: Annotated[float | None, "stiffness", "stiffness of the first stage; default its own"] = None,
    differences: Annotated[
        tuple[float, ...] | None, "stiffness", "second less first; default 1.25 to 3.25 of it"
    ] = None,
    damping: Annotated[float | None, "damping", "damping beside the springs; default its own"] = None,
    speeds: Annotated[tuple[float, ...] | None, "speed", "speeds to climb from; default about twice the mode's"] = None,
) -> xr.Dataset:
    """Half-order vibration over the stiffness step: largest amplitude, its mean torque, speeds where it lives.

    Top gear, by harmonic balance; branches are followed over mean torque from 0.7 to 2.3 of the transition's.
    """
    model = trucks.two_stage
    soft = positive(first, carrying(model)[0], "first")
    steps = values_of(differences, soft * np.array(DIFFERENCES), "differences")
    found = [strongest(stepped(model, soft, soft + float(d), damping), speeds) for d in steps]
    along = Along("difference", steps, "stiffness", "difference of the stiffnesses, second less first")
    data = over(along, _curves(found, transition_torque(model), main_order(model) / 2), model)
    beside = "its own damping" if damping is None else f"{damping:g} Nms/rad"
    condition = (
        f"two stages, {soft / 1e3:.3g} kNm/rad up to {transition_torque(model):.0f} Nm, {beside}; top gear; order "
        f"{main_order(model) / 2:g}, 0-peak, each the largest over speed and mean torque; absorber: "
        f"{trucks.origins.get('two_stage', 'as given')}"
    )
    return advised(data, "stiffness-step", model, condition, list(_findings(data, main_order(model) / 2)))


def strongest(model: Model, looked: tuple[float, ...] | None = None) -> Strongest:
    """The strongest vibration of half the firing order with two stages; amplitudes of zero where there is none."""
    search = searched(model)
    search = replace(search, first_look=values_of(looked, search.first_look, "speeds"))
    if not any(search.at(float(speed))[0, SPRING] for speed in search.first_look):
        return Strongest(np.zeros(4))
    peak = search.peak(SPRING)
    others = [search.peak(quantity, peak.speed).amplitude for quantity in (SHAFT, INPUT_ACCELERATION, TWIST)]
    branches = doubled(over_speed(model, model.operation.speed, peak.torque, highest_order=HIGHEST_ORDER))
    values = np.concatenate([branch.values for branch in branches]) if branches else np.array([np.nan])
    ends = (float(values.min()), float(values.max()))
    return Strongest(np.array([peak.amplitude, *others]), peak.speed, peak.torque, ends)


def _curves(found: list[Strongest], transition: float, order: float) -> dict[str, Curve]:
    spring, shaft, acceleration, twist = np.array([each.amplitudes for each in found]).T
    torque = f"order {order:g}"
    ends = np.array([each.ends for each in found])
    limit = {"limit": transition, "limit_words": "torque at the transition"}
    return {
        "spring_torque": Curve(spring, "torque", "in the springs", torque, "0-peak"),
        "input_torque": Curve(shaft, "torque", "at the gearbox input", torque, "0-peak"),
        "input_acceleration": Curve(
            acceleration, "acceleration", panel="gearbox input, acceleration", amplitude="0-peak"
        ),
        "spring_twist": Curve(twist, "relative_angle", panel="twist of the springs", amplitude="0-peak"),
        "strongest_at": Curve([each.torque for each in found], "torque", panel="mean torque of the strongest", **limit),  # type: ignore[arg-type]
        "speed_of_strongest": Curve([each.speed for each in found], "speed", "strongest", "engine speed"),
        "lowest_speed": Curve(ends[:, 0], "speed", "lowest at that mean torque", "engine speed"),
        "highest_speed": Curve(ends[:, 1], "speed", "highest", "engine speed"),
    }


def _findings(data: xr.Dataset, order: float) -> Iterator[str]:
    there = data.isel(difference=np.flatnonzero(data.spring_torque.values > 0))
    none = data.difference.values[data.spring_torque.values == 0]
    if none.size:
        yield f"no vibration of order {order:g} up to a difference of {none.max() / 1e3:.3g} kNm/rad"
    if not there.difference.size:
        return
    for place in dict.fromkeys((0, there.difference.size - 1)):
        at = there.isel(difference=place)
        yield (
            f"difference {float(at.difference) / 1e3:.3g} kNm/rad: order {order:g} has "
            f"{float(at.spring_torque):.0f} Nm in the springs, {float(at.input_torque):.0f} Nm and "
            f"{float(at.input_acceleration):.0f} rad/s² at the gearbox input, at "
            f"{float(at.speed_of_strongest) / RPM:.0f} rpm under {float(at.strongest_at):.0f} Nm; it lives from "
            f"{float(at.lowest_speed) / RPM:.0f} to {float(at.highest_speed) / RPM:.0f} rpm there"
        )
    if there.difference.size > 1:
        slope, torque = (np.polyfit(there.difference / 1e3, there[n], 1)[0] for n in ("spring_torque", "strongest_at"))
        yield f"each kNm/rad adds {slope:.0f} Nm to it and moves it up by {torque:.0f} Nm of mean torque"
