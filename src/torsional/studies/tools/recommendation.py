"""`recommendation`: the best absorber at equal inertia, low-speed against high-speed vibration, as Pareto fronts."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.advice import positive
from torsional.studies.base import tool
from torsional.studies.optimise.optimise import optimised
from torsional.studies.optimise.presets import TUNED, criteria_of, preset, split_of
from torsional.studies.optimise.task import Limit, Method
from torsional.studies.sweeps.absorbers import InertiaRun
from torsional.studies.trucks import Trucks

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

PRESETS = {"DMF": "best-dmf", "PSVA": "best-psva", "DMF with TVA": "best-tva", "DMF with pendulum": "best-pendulum"}
ADDED = 0.3 / 2.2
"""Inertia added to the dual mass flywheel's own, over it: what the shipped absorber on the flange takes."""
ENDS = ("low_speed", "high_speed")
FIGURES = (*ENDS, "space", "travel")
PLAIN = "DMF"


def _drawn(data: xr.Dataset) -> Picture:
    from torsional.plots.fronts import plot_fronts

    return plot_fronts(data)


@tool(
    "recommendation",
    varies="absorber concept; all inertias, springs, tunings, gear quotient and clutch within their limits",
    picture=_drawn,
)
def recommendation(
    trucks: Trucks,
    *,
    space: Annotated[
        float | None, "inertia", "inertia of the whole absorber, equal for all; default 13.6 % above the DMF's"
    ] = None,
    population: Annotated[int, "designs of a generation"] = 120,
    generations: Annotated[int, "generations searched"] = 25,
    between: Annotated[int, "designs refined between the ends of a front"] = 5,
    seed: Annotated[int, "of all that is drawn by chance"] = 1,
    processes: Annotated[int, "side by side"] = 1,
) -> xr.Dataset:
    """Which absorber is best at equal inertia: Pareto fronts of low-speed against high-speed vibration.

    Designs that are louder than the truck's dual mass flywheel at either end are left out.  Takes some ten minutes.
    """
    own = float(InertiaRun(analysis="inertia")(trucks.dmf).inertia)
    most = positive(space, own * (1 + ADDED), "space")
    method = Method(population, generations, seed)
    today = criteria_of(trucks.dmf)(trucks.dmf)
    no_worse = {name: Limit(most=float(today[name])) for name in ENDS}
    found = {}
    for concept, name in PRESETS.items():
        task = preset(name, trucks, {"space": f"{most!r} kgm²"}).task
        narrower = replace(task, limits={**task.limits, **no_worse})
        found[concept] = optimised(narrower, method, between, processes=processes)
    return _told(trucks, found, most)


def _told(trucks: Trucks, found: Mapping[str, xr.Dataset], space: float) -> xr.Dataset:
    fronts = {concept: _front(data) for concept, data in found.items()}
    longest = max((data.sizes["design"] for data in fronts.values()), default=0)
    names = list(fronts)
    values = {name: np.array([_padded(fronts[c][name].values, longest) for c in names]) for name in FIGURES}
    quantities = {name: str(next(iter(fronts.values()))[name].attrs["quantity"]) for name in FIGURES}
    nominal = {f"nominal_{n}": np.array([float(found[c][n][0]) for c in names]) for n in ENDS}
    data = labelled(
        {name: (("concept", "point"), table, quantities[name]) for name, table in values.items()}
        | {name: (("concept",), table, "acceleration") for name, table in nominal.items()}
        | {"knee": (("concept",), np.array([_knee(data) for data in fronts.values()]), "number")},
        {"concept": (np.array(names), ""), "point": (np.arange(longest), "")},
        analysis="study recommendation",
    )
    (low, high), split = trucks.dmf.operation.speed, split_of(trucks.dmf)
    condition = (
        f"equal inertia of the whole absorber, at most {space:.3g} kgm²; firing order's acceleration at the gearbox "
        f"input, half peak-to-peak, the worst of all gears and mean torques within full load; linear, springs off "
        f"their stops, a pendulum within 60 % of its way and tuned {100 * (TUNED - 1):.0f} % above the firing order; "
        f"no louder than the truck's dual mass flywheel at either end; figures and damping as shipped, or yours"
    )
    ranges = {"low_range": json.dumps([low, split]), "high_range": json.dumps([split, high])}
    return data.assign_attrs(condition=condition, **ranges, findings="\n".join(findings(data)))


def _front(data: xr.Dataset) -> xr.Dataset:
    """The designs of the front by rising low-speed vibration."""
    on = data.isel(design=np.flatnonzero(data.on_front.values))
    return on.isel(design=np.argsort(on.low_speed.values, kind="stable"))


def _knee(front: xr.Dataset) -> int:
    places = [place for place, told in enumerate(front.role.values) if "knee" in str(told).split("; ")]
    return places[0] if places else -1


def _padded(values: Array, size: int) -> Array:
    return np.append(values, np.full(size - values.size, np.nan))


def findings(data: xr.Dataset) -> Iterator[str]:
    """What an engineer reads off the fronts."""
    best = {str(c): _best(data.sel(concept=c)) for c in data.concept.values if data.low_speed.sel(concept=c).count()}
    for missing in sorted({*map(str, data.concept.values)} - {*best}):
        yield f"{missing}: none of the designs searched keeps all limits at this inertia; search more of them."
    for concept, (low, high, at_low) in best.items():
        yield (
            f"{concept}: down to {low:.3g} rad/s² at low speed, where high speed has {at_low:.3g}, and down to "
            f"{high:.3g} rad/s² at high speed."
        )
    if PLAIN in best:
        base = best[PLAIN]
        for concept, (low, high, _) in best.items():
            if concept != PLAIN:
                yield f"{concept} against {PLAIN}: {_over(low, base[0])} at low speed, {_over(high, base[1])} at high."
    yield from _dominance(data, list(best))


def _best(one: xr.Dataset) -> tuple[float, float, float]:
    """Least low-speed and least high-speed vibration, and the high-speed one of the quietest at low speed."""
    at = int(np.nanargmin(one.low_speed.values))
    return float(one.low_speed[at]), float(one.high_speed.min()), float(one.high_speed[at])


def _over(value: float, base: float) -> str:
    return f"{100 * (value / base - 1):+.0f} %"


def _dominance(data: xr.Dataset, names: list[str]) -> Iterator[str]:
    """Which fronts lie wholly inside others, and which cross."""
    points = {}
    for name in names:
        one = data.sel(concept=name)
        pairs = np.column_stack([one.low_speed.values, one.high_speed.values])
        points[name] = pairs[np.isfinite(pairs).all(axis=1)]
    for name in names:
        beaten = [other for other in names if other != name and _inside(points[name], points[other])]
        if beaten:
            yield f"For every design of {' and '.join(beaten)} there is one of {name} that is quieter at both ends."


def _inside(mine: Array, other: Array) -> bool:
    return all(((mine <= point).all(axis=1)).any() for point in other)
