"""Claims that set a dual mass flywheel beside a single mass flywheel over the whole range (A10, A11, A14)."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from scipy.signal import find_peaks

from torsional.components import Component
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, swing
from torsional.results import labelled
from torsional.solvers.map import response_map
from torsional.stamps import GROUND
from torsional.studies.answers import (
    INPUT,
    at_input,
    floats,
    main_order,
    modes,
    rising,
    span,
    speeds,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Along, Curve, over_speed, swept
from torsional.studies.trucks import Trucks, mapped, reached, replaced, sprung, stiffness
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

TORQUES = 7
STEP = 25 * RPM
LIGHT = 0.2
"""Clutch damping of a variant that shows what the clutch mode can do, over the shipped one."""
PROMINENT = 0.1
"""How far a peak over speed stands out of the valleys beside it to be called a resonance."""
DAMPED = (
    "lower as a rule; but a resonance shows with little damping in the clutch alone: with "
    f"× {LIGHT:g} of it in {{gears}} gears, with the model's own in none"
)


def _input_map(model: Model, speed: Array, torque: Array, orders: Array) -> xr.DataArray:
    """Acceleration orders at the gearbox input over gear, torque and speed, complex 0-peak; NaN beyond full load."""
    found = response_map(model, speed, torque, orders=orders, nodes=[model.landmarks.input], elements=[])
    inside = found.within_full_load.astype(bool)
    return acceleration(found.angle.isel(node=0)).where(inside)


def ratio_maps(data: xr.Dataset) -> Picture:
    """Ratios over speed and torque in some gears, cells above one marked."""
    from torsional.plots import plot_gear_ratios

    return plot_gear_ratios(data)


@claim(
    "A10",
    "abstract, 6.1",
    "Vibration is generally lower with a dual than with a single mass flywheel, yet some conditions excite resonance.",
    "amplitudes over speed × torque × gear, dual over single: median below one half; cells above 1 are named, and in "
    "some gear the dual's amplitude over speed has a peak in the range, 10 % above the valleys beside it; where it has "
    "none but with little damping in the clutch, that is the condition",
    varies="engine speed over the operating range in steps of 25 rpm, six mean torques up to full load, all gears; "
    "clutch damping × 1 and × 0.2",
    picture=ratio_maps,
    leading="median ratio, firing order [-]",
)
def a10(trucks: Trucks) -> Finding:
    speed, torque = speeds(trucks.smf, STEP), trucks.smf.torques(TORQUES)[1:]
    order = np.array([main_order(trucks.smf)])
    double = _input_map(trucks.dmf, speed, torque, order).isel(order=0)
    ratio = abs(double) / abs(_input_map(trucks.smf, speed, torque, order).isel(order=0))
    sharp = _swings(lightly(trucks.dmf), speed, torque, order)
    light = sharp / _swings(lightly(trucks.smf), speed, torque, order)
    shown, sharply = _resonant(abs(double)), _resonant(sharp)
    cycle, other = (_swings(m, speed[::2], torque[1::2], HALF_ORDERS) for m in (trucks.dmf, trucks.smf))
    cycle = cycle / other
    figures: dict[str, Figure] = {
        "median ratio, firing order [-]": float(ratio.median()),
        "largest ratio, firing order [-]": float(ratio.max()),
        "cells above 1": _named(ratio),
        "swing over the cycle: median ratio [-]": float(cycle.median()),
        "swing over the cycle: largest ratio [-]": float(cycle.max()),
        "swing over the cycle: cells above 1": _named(cycle),
        "DMF: gears with a resonance above idle": shown,
        f"clutch damping × {LIGHT:g}: median ratio [-]": float(light.median()),
        f"clutch damping × {LIGHT:g}: cells above 1": _named(light),
        f"clutch damping × {LIGHT:g}: DMF: gears with a resonance above idle": sharply,
    }
    kept = ("gear", "mean_torque", "speed")
    maps = {"ratio": ratio, "ratio_light": light}
    data = labelled(
        {name: (kept, found.transpose(*kept).values, "ratio") for name, found in maps.items()},
        {"gear": (ratio.gear.values, ""), "mean_torque": (torque, "torque"), "speed": (speed, "speed")},
        analysis="claim A10",
    )
    data.ratio.attrs["words"] = "clutch damping as in the model"
    data.ratio_light.attrs["words"] = f"clutch damping × {LIGHT:g}"
    condition = "acceleration at the gearbox input inside the full-load curve, all gears; half peak-to-peak"
    good = float(ratio.median()) < 0.5 and bool(shown or sharply)
    reason = "" if shown or sharply else "no gear has a resonance in the range"
    return Finding(
        good, condition, figures, reason, data, "" if shown or not good else DAMPED.format(gears=len(sharply))
    )


def lightly(model: Model) -> Model:
    """A copy with little damping in the clutch."""
    clutch: Any = model.components[model.landmarks.clutch]
    return replaced(model, model.landmarks.clutch, damping=LIGHT * clutch.damping)


def _swings(model: Model, speed: Array, torque: Array, orders: Array) -> xr.DataArray:
    """Swing of the input acceleration."""
    return swing(_input_map(model, speed, torque, orders), 360)


def _named(ratio: xr.DataArray) -> tuple[str, ...]:
    """Gears with ratios above 1 and the speeds between which they occur."""
    told = []
    for gear in ratio.gear.values:
        above = ratio.speed.values[(ratio.sel(gear=gear) > 1).any("mean_torque").values]
        told += [f"gear {gear}: {span(above)}"] if above.size else []
    return tuple(told)


def _resonant(amplitude: xr.DataArray) -> tuple[str, ...]:
    """Gears in which the amplitude over speed at half of the peak torque has a peak above idle, and its speed.

    A peak stands out of the higher of the valleys on its sides by `PROMINENT` or more.
    """
    found = []
    for gear in amplitude.gear.values:
        curve = amplitude.sel(gear=gear).isel(mean_torque=amplitude.mean_torque.size // 2).dropna("speed")
        peaks, about = find_peaks(curve.values, prominence=0.0)
        valley = curve.values[peaks] - about["prominences"]
        peaks = peaks[curve.values[peaks] >= (1 + PROMINENT) * valley]
        if peaks.size:
            best = peaks[curve.values[peaks].argmax()]
            found.append(f"gear {gear}: {curve.speed.values[best] / RPM:.0f} rpm")
    return tuple(found)


@claim(
    "A11",
    "2.2.1",
    "A softer dual mass flywheel isolates better but carries less torque.",
    "over a 4:1 sweep of the spring's stiffness, amplitude at speeds above the resonances rises strictly with it; "
    "bottoming torque at a fixed travel reported",
    varies="stiffness of the DMF's springs from half to twice the model's in five steps",
    leading="least rise of the amplitude from step to step [%]",
)
def a11(trucks: Trucks) -> Finding:
    model, spring = trucks.dmf, trucks.dmf.landmarks.springs[0]
    k = stiffness(model, spring) * np.geomspace(0.5, 2.0, 5)
    variants = [sprung(model, spring, value) for value in k]
    speed = speeds(model)
    above = 1.1 * resonances(variants[-1], spring)
    speed = speed[speed > above]
    if not speed.size:
        remedy = f"widen operation.speed beyond {above / RPM:.0f} rpm"
        raise ModelError("no speed of the range lies above the resonances", where=model.name, remedy=remedy)
    table = np.array([at_input(variant, speed) for variant in variants])
    travel = 0.8 * float(model.full_load_peak() / k[0])
    figures: dict[str, Figure] = {
        "stiffness [Nm/rad]": floats(k),
        "speeds above [rpm]": above / RPM,
        "amplitude at the middle speed [rad/s²]": floats(table[:, speed.size // 2]),
        "travel of the fixed design [rad]": travel,
        "bottoming torque [Nm]": floats(k * travel),
        "least rise of the amplitude from step to step [%]": 100 * float((table[1:] / table[:-1] - 1).min()),
    }
    panel = "gearbox input above the resonances, acceleration"
    curves = {
        f"amplitude_{place}": Curve(
            table[:, place], "acceleration", f"{speed[place] / RPM:.0f} rpm", panel, "half peak-to-peak", scale="log"
        )
        for place in (0, speed.size // 2, -1)
    }
    told = {"limit": model.full_load_peak(), "limit_words": "peak of full load"}
    curves["bottoming_torque"] = Curve(k * travel, "torque", panel="torque that bottoms a fixed travel", **told)  # type: ignore[arg-type]
    data = swept("A11", Along("stiffness", k, "stiffness", "stiffness of the DMF"), curves)
    return Finding(rising(table), INPUT, figures, dataset=data)


def resonances(model: Model, spring: str) -> float:
    """Order speed [rad/s] of the highest mode in the range that lives in absorber spring or clutch damper."""
    found = modes(model)
    share = found.elastic_share.sel(element=[spring, model.landmarks.clutch]).sum("element").values
    speed = found.order_speed.values[(share > 0.5)]
    speed = speed[speed < model.operation.speed[1]]
    if not speed.size:
        remedy = "widen operation.speed, or ask a truck with softer springs"
        raise ModelError("no mode of springs and clutch lies below the top speed", where=model.name, remedy=remedy)
    return float(speed.max())


def behind_clutch(model: Model, gear: str) -> set[str]:
    """Connections behind the clutch damper."""
    powertrain = model.powertrain(gear)
    nodes = reached(powertrain, [model.landmarks.input], [model.landmarks.clutch])
    return {stamp.name for stamp in powertrain.stamps if set(stamp.weights) <= nodes | {GROUND}}


def damped(model: Model, factor: float) -> Model:
    """A copy whose damping behind the clutch is multiplied: viscous damping and loss factors."""
    behind = {name for gear in model.gear_names for name in behind_clutch(model, gear)}

    def change(parts: dict[str, Component]) -> dict[str, Component]:
        return {name: _scaled(part, factor) if name in behind else part for name, part in parts.items()}

    return mapped(model, change)


def _scaled(part: Component, factor: float) -> Component:
    known: Any = part
    fields = {key: factor * getattr(part, key) for key in ("damping", "loss_factor") if hasattr(part, key)}
    scaled: Component = dataclasses.replace(known, **fields) if fields else part
    return scaled


@claim(
    "A14",
    "4.1",
    "Damping behind the clutch hardly affects the steady vibration into the gearbox.",
    "±50 % of all damping behind the clutch changes the amplitude by less than 5 % over at least 90 % of the range of "
    "speeds and gears; exceptions named",
    varies="engine speed over the operating range in steps of 25 rpm, all gears; damping "
    "behind the clutch × 0.5, 1, 1.5",
    leading="cells under 5 %, least of both [%]",
)
def a14(trucks: Trucks) -> Finding:
    speed, figures = speeds(trucks.smf, STEP), dict[str, Figure]()
    curves, share = dict[str, Curve](), list[float]()
    for name, model in (("SMF", trucks.smf), ("DMF", trucks.dmf)):
        both = [damped(model, factor) for factor in (0.5, 1.5)]
        change = np.array([_changes(model, both, speed, gear) for gear in model.gear_names])
        named = {gear: speed[row > 0.05] for gear, row in zip(model.gear_names, change, strict=True)}
        figures |= {
            f"{name}: largest change [%]": 100 * float(change.max()),
            f"{name}: cells under 5 % [%]": 100 * float((change < 0.05).mean()),
            f"{name}: exceptions": tuple(f"gear {g}: {span(v)}" for g, v in named.items() if v.size),
        }
        share.append(float((change < 0.05).mean()))
        curves |= _changed(name, change)
    figures["cells under 5 %, least of both [%]"] = 100 * min(share)
    condition = "mean torque 60 % of the peak, all gears; firing order's acceleration at the gearbox input"
    return Finding(min(share) > 0.9, condition, figures, dataset=swept("A14", over_speed(speed), curves))


def _changed(name: str, change: Array) -> dict[str, Curve]:
    """The largest change of all gears over speed with its limit, and the median."""
    panel = f"{name}: change of the amplitude by ±50 % damping"
    limit: dict[str, Any] = {"limit": 0.05, "limit_words": "criterion: below 5 % in 90 % of all cells"}
    told = {"largest": (change.max(axis=0), limit), "median": (np.median(change, axis=0), {})}
    return {
        f"{name}_{which}".lower(): Curve(
            values, "relative_difference", f"{which} of all gears", panel, scale="log", **more
        )
        for which, (values, more) in told.items()
    }


def _changes(model: Model, others: list[Model], speed: Array, gear: str) -> Array:
    """Larger of both relative changes over speed in one gear."""
    own = at_input(model, speed, gear=gear)
    both = [np.abs(at_input(other, speed, gear=gear) / own - 1) for other in others]
    return np.maximum(*both)
