"""Findings about modes: where the main order meets them."""

from __future__ import annotations

import numpy as np

from torsional.report.analysis import Variant
from torsional.report.finding import Finding
from torsional.report.labels import gears_told, listed, rounded, told


def resonances(variant: Variant) -> list[Finding]:
    """For every kind of mode the speeds at which the main order meets it, and in which gears inside the range."""
    order, operation = variant.main_order, variant.model.operation
    if order is None:
        return [_first_mode(variant)]
    inside = _crossings(variant, *operation.speed)
    found = [_inside(variant, name, at, order) for name, at in inside.items()]
    if not found:
        text = f"No mode is met by the main order, {order:g}, inside the operating range in any gear."
        found = [
            Finding("resonance", text.replace(" in any gear", "" if not any(variant.model.gears) else " in any gear"))
        ]
    below = _crossings(variant, 0.0, operation.speed[0] * (1 - 1e-9)).get(variant.model.absorber_mode, [])
    return found + ([_below(variant, below, order)] if below else [])


def _crossings(variant: Variant, low: float, high: float) -> dict[str, list[tuple[str, float]]]:
    """Mode name → (gear, speed) at which the main order meets it between two speeds."""
    met: dict[str, list[tuple[str, float]]] = {}
    for gear, names in variant.names.items():
        at = variant.interference.crossing.sel(gear=gear).isel(order=0).values
        for mode, name in enumerate(names):
            if low <= at[mode] <= high:
                met.setdefault(name, []).append((gear, float(at[mode])))
    return met


def _inside(variant: Variant, name: str, at: list[tuple[str, float]], order: float) -> Finding:
    gears = list(dict.fromkeys(gear for gear, _ in at))
    where = gears_told(gears, variant.model.gear_names)
    (low_gear, low), (high_gear, high) = min(at, key=lambda p: p[1]), max(at, key=lambda p: p[1])
    values = {"lowest": low, "highest": high}
    start = f"The {name} is met by order {order:g} inside the operating range"
    if high - low < 0.005 * high or not where:
        spots = sorted({told(speed, "speed") for _, speed in at}, key=lambda text: float(text.split()[0]))
        return Finding("resonance", f"{start}{f' in {where}' if where else ''}, at {listed(spots)}.", values)
    text = (
        f"{start} in {where}: at {told(low, 'speed')} in gear {low_gear}, at {told(high, 'speed')} in gear {high_gear}"
    )
    top = dict(at).get(variant.model.top_gear)
    extra = f", at {told(top, 'speed')} in gear {variant.model.top_gear}" if top and top not in (low, high) else ""
    return Finding("resonance", text + extra + ".", values | ({"top": top} if top else {}))


def _below(variant: Variant, at: list[tuple[str, float]], order: float) -> Finding:
    gear, speed = max(at, key=lambda p: p[1])
    idle = variant.model.operation.idle
    where = f" (gear {gear})" if gear else ""
    text = f"The {variant.model.absorber_mode} is met by order {order:g} at {told(speed, 'speed')} at most{where}, "
    text += f"{rounded(speed / idle, 2)} times the idle speed of {told(idle, 'speed')}."
    return Finding("absorber mode", text, {"speed": speed, "idle": idle})


def _first_mode(variant: Variant) -> Finding:
    gear = variant.model.top_gear
    modes = variant.modes(gear)
    elastic = np.flatnonzero(modes.frequency.values > 0)
    values = {f"mode {i}": float(modes.frequency[i]) for i in elastic[:3]}
    spots = [f"{told(value, 'frequency', 4)}" for value in values.values()]
    return Finding("modes", f"The lowest natural frequencies are {listed(spots)}.", values)
