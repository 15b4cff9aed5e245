"""The tool ``down-speeding``: which absorber buys how many rpm at an equal limit of vibration into the gearbox."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.attaining import SLACK, as_it_is, attained, rematched
from torsional.studies.base import tool
from torsional.studies.down_speeding import Worst, cruise_speed, moved, worst
from torsional.studies.matching import Concept, concepts
from torsional.studies.trucks import Trucks
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

SIZES = (0.75, 1.0, 1.5, 2.0, 2.5)
"""Inertias of whole absorbers in the chart, over the dual mass flywheel's."""
DESIGNS = ("as it is", "matched")


def _drawn(data: xr.Dataset) -> Picture:
    from torsional.plots.down_speeding import plot_down_speeding

    return plot_down_speeding(data)


@tool(
    "down-speeding",
    varies="range and full-load curve moved down at equal power, with the final drive; absorber, as it is and matched "
    "with its clutch; inertia of the absorber; gear",
    picture=_drawn,
)
def down_speeding(
    trucks: Trucks,
    *,
    by: Annotated[tuple[float, ...], "speed", "how far the engine's range moves down"] = (100 * RPM, 200 * RPM),
    limit: Annotated[
        float | None, "acceleration", "limit at the gearbox input (default: the worst of the DMF as it is, today)"
    ] = None,
    cruise: Annotated[
        float | None,
        "speed",
        "engine speed at which the vehicle stays as fast (default: where full load leaves its peak)",
    ] = None,
    cap: Annotated[float, "speed", "farthest that is tried"] = 300 * RPM,
    inertias: Annotated[
        tuple[float, ...] | None,
        "inertia",
        "inertias of whole absorbers in the chart (default: 0.75 to 2.5 of the DMF's)",
    ] = None,
    no_chart: Annotated[bool, "leave out the chart over the absorber's inertia, which takes longest"] = False,
) -> xr.Dataset:
    """Which absorber lets the engine run how much slower at equal power, at an equal limit at the gearbox input."""
    known = concepts(trucks)
    bound = limit or worst(trucks.dmf).acceleration
    steps = np.array([0.0, *sorted(by)])
    at = cruise or cruise_speed(trucks.dmf)
    looks = {name: (as_it_is(concept, at), rematched(concept, at)) for name, concept in known.items()}
    found = {(name, step): [look(step) for look in pair] for name, pair in looks.items() for step in steps.tolist()}
    reached = [[attained(look, bound, cap) for look in pair] for pair in looks.values()]
    sizes = np.array([] if no_chart else (inertias or np.array(SIZES) * known["DMF"].inertia), dtype=float)
    charted = [[_charted(one, size, bound, at, cap) for size in sizes] for one in known.values()]
    data = _dataset(known, steps, found, np.array(reached), sizes, np.array(charted).reshape(len(known), -1))
    condition = (
        f"equal power at every speed, vehicle as fast at {at / RPM:.0f} rpm, idle kept; firing order's acceleration at "
        f"the gearbox input, half peak-to-peak, worst over speeds, mean torques within full load and gears; linear, "
        f"springs off their stops"
    )
    rise = _rise(trucks.dmf, steps, at)
    findings = "\n".join(_findings(data, bound, cap, rise))
    return data.assign_attrs(condition=condition, limit=bound, cap=cap, findings=findings)


def _charted(concept: Concept, inertia: float, limit: float, cruise: float, cap: float) -> float:
    """Attainable down-speeding [rad/s] of a concept matched at another inertia; not a number where it is too small."""
    if inertia < concept.smallest:
        return float("nan")
    return attained(rematched(concept.sized(inertia), cruise), limit, cap)


def _rise(model: Model, steps: Array, cruise: float) -> dict[float, tuple[float, float]]:
    """Peak torque [Nm] and its brake mean effective pressure [bar] of each range moved down."""
    volume = model.running_engine.displacement
    peaks = {float(step): moved(model, step, cruise).full_load_peak() for step in steps}
    return {step: (peak, 4e-5 * np.pi * peak / volume) for step, peak in peaks.items()}


def _dataset(
    known: dict[str, Concept],
    steps: Array,
    found: dict[tuple[str, float], list[Worst]],
    reached: Array,
    sizes: Array,
    charted: Array,
) -> xr.Dataset:
    def table(read: str) -> Array:
        rows = [[[getattr(one, read) for one in found[name, step]] for step in steps] for name in known]
        return np.moveaxis(np.array(rows), 2, 1)

    grid = ("concept", "design", "by")
    gears = next(iter(known.values())).model.gear_names
    return labelled(
        {
            "worst_by_gear": ((*grid, "gear"), table("by_gear"), "acceleration"),
            "worst": (grid, table("acceleration"), "acceleration"),
            "worst_gear": (grid, table("gear"), ""),
            "worst_speed": (grid, table("speed"), "speed"),
            "worst_torque": (grid, table("torque"), "torque"),
            "stop_reach": (grid, table("reach"), "ratio"),
            "attainable": (("concept", "design"), reached, "speed"),
            "own_inertia": (("concept",), np.array([one.inertia for one in known.values()]), "inertia"),
            "attainable_by_inertia": (("concept", "inertia"), charted, "speed"),
        },
        {
            "concept": (np.array(list(known)), ""),
            "design": (np.array(DESIGNS), ""),
            "by": (steps, "speed"),
            "gear": (np.array(gears), ""),
            "inertia": (sizes, "inertia"),
        },
        analysis="study down-speeding",
    )


def _findings(data: xr.Dataset, limit: float, cap: float, rise: dict[float, tuple[float, float]]) -> Sequence[str]:
    told = [f"Equal limit at the gearbox input: {limit:.0f} rad/s²."]
    for concept in data.concept.values:
        for design in data.design.values:
            at = {"concept": concept, "design": design}
            told.append(f"{concept}, {design}: {_told(float(data.attainable.sel(at)), cap)}; {_cases(data.sel(at))}.")
    told += [
        f"{step / RPM:.0f} rpm down the engine must give {peak:.0f} Nm at its peak, {pressure:.0f} bar of brake mean "
        f"effective pressure: whether it can is another question."
        for step, (peak, pressure) in rise.items()
        if step > 0
    ]
    for concept in data.concept.values if data.inertia.size else ():
        row = data.attainable_by_inertia.sel(concept=concept)
        pairs = zip(row.inertia.values, row.values, strict=True)
        values = [f"{size:.2f} kgm²: {rpm / RPM:.0f} rpm" for size, rpm in pairs if np.isfinite(rpm)]
        told.append(f"{concept}, matched at each inertia: {', '.join(values) or 'at none of them within the limit'}.")
    return told


def _told(attainable: float, cap: float) -> str:
    if np.isnan(attainable):
        return "above the limit even in the range of today"
    if attainable < RPM:
        return "at the limit in the range of today, nothing to spare"
    if attainable >= cap:
        return f"{cap / RPM:.0f} rpm and more, the farthest that was tried"
    return f"attainable {attainable / RPM:.0f} rpm"


def _cases(row: xr.Dataset) -> str:
    """The worst of each range with its gear."""
    parts = []
    for place, step in enumerate(row.by.values):
        one = row.isel(by=place)
        gear = f" in gear {one.worst_gear.item()}" if str(one.worst_gear.item()) else ""
        stop = ", springs at their stop" if float(one.stop_reach) > SLACK else ""
        span = f"{step / RPM:.0f} rpm down" if step else "range of today"
        parts.append(f"{span} {float(one.worst):.0f} rad/s²{gear}{stop}")
    return ", ".join(parts)
