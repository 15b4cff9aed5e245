"""The claim about cylinder deactivation and down-sizing (G4)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr

from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.quantities import acceleration, swing
from torsional.studies.answers import responded, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.cylinders import (
    SECOND,
    SHORTER,
    STEP,
    WHOLE,
    compared,
    deactivated,
    drawn,
    engines,
    every_second,
    firing_order,
    input_orders,
    part_loads,
    strongest,
)
from torsional.studies.trucks import Trucks
from torsional.units import RPM

MECHANISM = (
    "with every second cylinder off the others fire at twice the distance, each with over twice the work, so that "
    "modes which the firing order met below the range lie in it; a cylinder that is shut is a gas spring, repeats "
    "itself every turn and has no part in that order, while one that breathes compresses once a cycle and cancels the "
    "compression of the others in it"
)
CONDITION = (
    "equal mean torques up to half of full load, top gear; half the swing over a cycle of the acceleration at the "
    "gearbox input, orders 0.5 to 12; valves of deactivated cylinders shut; a shorter engine of {cylinders} cylinders "
    "of the same size on the same line"
)


@claim(
    "G4",
    "6.2",
    "Cylinder deactivation and down-sizing raise vibration and change the orders.",
    "with single and dual mass flywheel, over speed and mean torque: with every second cylinder off and with a shorter "
    "engine the largest swing at the gearbox input and the median over the map rise, and the order with most of the "
    "vibration's mean square moves from that of all cylinders to that of those which fire",
    varies="cylinders that fire (all, every second, neighbours, those of a shorter engine), speed, mean torque",
    picture=drawn,
    leading="DMF, every second off: largest swing over that of all cylinders [-]",
)
def g4(trucks: Trucks) -> Finding:
    pair = {"SMF": trucks.smf, "DMF": trucks.dmf}
    models = {concept: engines(model) for concept, model in pair.items()}
    data = compared(models, speeds(trucks.smf, STEP), part_loads(trucks.smf))
    figures: dict[str, Figure] = {}
    for concept in pair:
        figures |= _told(concept, data.sel(concept=concept)) | _breathing(concept, pair[concept], data)
    figures |= _at_full_load(models)
    fewer = data.sel(engine=[SECOND, SHORTER])
    ratio = fewer.swing / data.swing.sel(engine=WHOLE)
    largest = fewer.swing.max(("mean_torque", "speed")) > data.swing.sel(engine=WHOLE).max(("mean_torque", "speed"))
    more = bool(largest.all() and (ratio.median(("mean_torque", "speed")) > 1).all())
    named = data.sel(engine=[WHOLE, SECOND, SHORTER])
    moved = bool((strongest(named) == named.firing_order).all())
    others = "" if moved else "the strongest orders are not all those of the cylinders that fire"
    reason = "; ".join(text for text in (others, MECHANISM if more and moved else "", _quieter(data)) if text)
    condition = CONDITION.format(cylinders=f"{2 * firing_order(models['SMF'][SHORTER]):g}")
    return Finding(more and moved, condition, figures, reason, data)


def _told(concept: str, data: xr.Dataset) -> dict[str, Figure]:
    """Figures of every engine with one concept."""
    figures: dict[str, Figure] = {}
    worst, whole = data.swing.max(("mean_torque", "speed")), data.swing.sel(engine=WHOLE)
    ratio = (data.swing / whole).median(("mean_torque", "speed"))
    for name in data.engine.values:
        one, at = data.sel(engine=name), f"{concept}, {name}"
        figures[f"{at}: largest swing [rad/s²]"] = float(worst.sel(engine=name))
        figures[f"{at}: largest swing at [rpm]"] = _where(one.swing) / RPM
        figures[f"{at}: strongest order [-]"] = float(strongest(one))
        figures[f"{at}: its part of the mean square [%]"] = 100 * float(one.energy.max())
        figures |= {f"{at}: {m} met at [rpm]": float(v) / RPM for m, v in _met(one.resonance)}
        if name != WHOLE:
            figures[f"{at}: largest swing over that of all cylinders [-]"] = float(
                worst.sel(engine=name) / worst.sel(engine=WHOLE)
            )
            figures[f"{at}: median ratio to all cylinders [-]"] = float(ratio.sel(engine=name))
    return figures


def _where(values: xr.DataArray) -> float:
    """The speed of the largest value."""
    return float(values.speed[int(np.nanargmax(values.max("mean_torque").values))])


def _met(resonance: xr.DataArray) -> list[tuple[str, float]]:
    pairs = zip(resonance.mode.values, resonance.values, strict=True)
    return [(str(mode), float(speed)) for mode, speed in pairs if np.isfinite(speed)]


def _breathing(concept: str, model: Model, data: xr.Dataset) -> dict[str, Figure]:
    """The same with cylinders that go on breathing."""
    second = every_second(model.running_engine.layout)
    orders = input_orders(deactivated(model, second, "working"), data.speed.values, data.mean_torque.values)
    inside = np.isfinite(data.swing.sel(concept=concept, engine=SECOND).values)
    largest = float(swing(orders).values[inside].max())
    return {f"{concept}, {SECOND}, its cylinders breathing: largest swing [rad/s²]": largest}


def _at_full_load(models: Mapping[str, Mapping[str, Model]]) -> dict[str, Figure]:
    """Engines at their own full load, the shorter one with as much less torque."""
    figures: dict[str, Figure] = {}
    for concept, row in models.items():
        for name in (WHOLE, SHORTER):
            model = row[name]
            speed = speeds(model, STEP)
            orders = responded(model, speed, model.full_load(speed), orders=HALF_ORDERS).angle
            size = swing(acceleration(orders.sel(node=model.landmarks.input)))
            figures[f"{concept}, {name}, at its own full load: largest swing [rad/s²]"] = float(size.max())
    return figures


def _quieter(data: xr.Dataset) -> str:
    """Where fewer cylinders are quieter by the largest swing over speed, in words."""
    worst = data.swing.max("speed")
    whole = worst.sel(engine=WHOLE)
    told = [
        f"with the {concept} under {torque:.0f} Nm, {name}: "
        f"{float(worst.sel(at)):.0f} against {float(whole.sel(concept=concept, mean_torque=torque)):.0f} rad/s²"
        for concept in data.concept.values
        for name in (SECOND, SHORTER)
        for torque in data.mean_torque.values
        if float(worst.sel(at := {"concept": concept, "engine": name, "mean_torque": torque}))
        < float(whole.sel(concept=concept, mean_torque=torque))
    ]
    return f"by the largest swing over speed quieter {', '.join(told)}" if told else ""
