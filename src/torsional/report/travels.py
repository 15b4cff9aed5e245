"""Findings about the travel of springs: distance to the stop, stages crossed, modes by stage."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array
from torsional.plots.layout import stage_angles
from torsional.quantities import swing
from torsional.report.analysis import Response, Variant, named
from torsional.report.finding import Finding
from torsional.report.labels import listed, told
from torsional.report.springs import Spring
from torsional.solvers.campbell import campbell


def travel(response: Response, spring: Spring) -> list[Finding]:
    """How far a spring is twisted at full load, its distance to the stop, and whether a stage is crossed."""
    gear, data = widest(response, spring.name)
    most, reach = float(data.mean_twist.max()), data.mean_twist + data.swing
    extent, speed = float(reach.max()), float(data.speed[int(reach.argmax("speed"))])
    name = spring.name.replace("_", " ")
    text = (
        f"At full load the mean twist of {name} is {told(most, 'relative_angle')} at most; with its swing it reaches "
    )
    text += f"{told(extent, 'relative_angle')}, at {told(speed, 'speed')}{f' in gear {gear}' if gear else ''}."
    values = {"mean": most, "extent": extent, "speed": speed}
    if spring.stop is not None:
        values["stop"] = spring.stop
        text += _distance(spring.stop, extent)
    return [Finding("travel", text, values), *_crossed(spring, data, name), *_slipping(spring, data, name)]


def _distance(stop: float, extent: float) -> str:
    at = told(stop, "relative_angle")
    if extent <= stop:
        return f" Its stop is at {at}: {told(stop - extent, 'relative_angle')} are left."
    beyond = f" That is {told(extent - stop, 'relative_angle')} beyond its stop at {at}, where the response linearised "
    return beyond + "about the mean torque no longer holds; a nonlinear one is needed."


def widest(response: Response, element: str) -> tuple[str, xr.Dataset]:
    """The gear in which a spring reaches furthest at full load; its mean twist, swing and torque over speed."""
    twist = swing(response.full.twist.sel(element=element)).transpose("gear", "speed")
    mean = response.full.mean_twist.sel(element=element)
    gear = str(twist.gear.values[int((mean + twist).max("speed").argmax("gear"))])
    chosen = {"mean_twist": mean.sel(gear=gear), "swing": twist.sel(gear=gear)}
    plain = {key: value.drop_vars(("gear", "element"), errors="ignore") for key, value in chosen.items()}
    return gear, xr.Dataset({**plain, "mean_torque": response.full.mean_torque})


def _crossed(spring: Spring, data: xr.Dataset, name: str) -> list[Finding]:
    """Speeds at which the swing at full load runs across a change of stiffness other than the stop."""
    edges = () if spring.law is None else spring.law.transitions
    low, high = (data.mean_twist - data.swing).values, (data.mean_twist + data.swing).values
    crossed = np.any([(low < edge) & (edge < high) for edge in edges], axis=0) if edges else np.zeros(low.shape, bool)
    if not crossed.any():
        return []
    span, ends = _span(data, crossed)
    text = f"At full load {name} swings across a change of its stiffness at speeds {span}: the linear response is an "
    text += "approximation there, and sub-harmonic vibration may occur."
    return [Finding("stages", text, ends)]


def _slipping(spring: Spring, data: xr.Dataset, name: str) -> list[Finding]:
    """Speeds at which the friction beside a spring slips at full load."""
    if spring.friction is None:
        return []
    low, high = (data.mean_twist - data.swing).values, (data.mean_twist + data.swing).values
    slips = spring.friction.changes_within(low, high)
    if not slips.any():
        return [Finding("friction", f"At full load the friction beside {name} sticks at all speeds.")]
    span, ends = _span(data, slips)
    text = f"At full load the friction beside {name} slips at speeds {span}: the linear response, which lets it stick, "
    return [Finding("friction", text + "is too stiff and has too little damping there.", ends)]


def _span(data: xr.Dataset, chosen: Array) -> tuple[str, dict[str, float]]:
    """The chosen speeds from the first to the last, in words and as values."""
    first, last = (float(speed) for speed in data.speed.values[chosen][[0, -1]])
    span = f"between {told(first, 'speed')} and {told(last, 'speed')}" if first < last else f"at {told(first, 'speed')}"
    return span, {"from": first, "to": last}


def stage_modes(variant: Variant, spring: Spring) -> list[Finding]:
    """For a spring of several stages the speeds at which the main order meets its mode, in the last gear."""
    law = spring.law
    angles = [] if law is None else stage_angles(law)
    gear, order = variant.model.top_gear, variant.main_order
    if law is None or len(angles) < 2 or order is None:
        return []
    parts, values, wanted = [], {}, variant.model.absorber_mode
    for torque in (float(law.torque(angle)) for angle in angles):
        met = campbell(variant.model, torque, [gear] if gear else None, orders=[order])
        at = met.crossing.isel(gear=0, order=0).values
        mode = next((i for i, name in enumerate(named(variant.model, met, gear)) if name == wanted), None)
        if mode is not None and np.isfinite(at[mode]):
            parts.append(f"{told(float(at[mode]), 'speed')} under {told(torque, 'torque')}")
            values[told(torque, "torque")] = float(at[mode])
    if len(parts) < 2:
        return []
    text = f"Stage by stage the {wanted} is met by order {order:g} at {listed(parts)} of mean torque"
    return [Finding("stage modes", f"{text}{f' (gear {gear})' if gear else ''}.", values)]
