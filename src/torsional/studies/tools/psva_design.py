"""`psva-design`: where a power split absorber cancels, how deep, and what it costs at high speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.advice import HALF, advised, chosen, drawn, over, positive, values_of
from torsional.studies.answers import INPUT, STEP, at_input, main_order, speeds
from torsional.studies.base import tool
from torsional.studies.power_split import Parts, cancelled
from torsional.studies.swept import Along, Curve
from torsional.studies.trucks import Trucks, merged, replaced, sprung
from torsional.units import RPM

Change = Callable[[Model, float], Model]
VARIED: dict[str, tuple[str, str, Change]] = {
    "planet_inertia": ("inertia", "J3", lambda model, value: replaced(model, Parts.of(model).planets, inertia=value)),
    "gear_quotient": ("ratio", "r", lambda model, value: replaced(model, Parts.of(model).gear, ratio=value)),
    "stiffness": ("stiffness", "k", lambda model, value: sprung(model, Parts.of(model).springs, value)),
    "secondary_inertia": (
        "inertia",
        "J2",
        lambda model, value: replaced(model, Parts.of(model).nodes[1], inertia=value),
    ),
}
"""What may be varied: its quantity, its symbol in `Parts`, and how a model is changed."""
HIGH = 1.25
"""High speeds lie this far above the highest cancellation."""
ABOVE_IDLE = 13 / 12
"""Cancellation asked for over idle: 650 rpm where that is 600."""


@tool(
    "psva-design",
    varies="planet inertia, gear quotient, stiffness or secondary inertia of a power split absorber, engine speed",
    picture=drawn,
)
def psva_design(
    trucks: Trucks,
    *,
    varied: Annotated[str, "planet-inertia, gear-quotient, stiffness or secondary-inertia"] = "planet-inertia",
    values: Annotated[tuple[float, ...] | None, "values of it in SI; empty: from half to twice its own"] = None,
    cancellation: Annotated[float | None, "speed", "engine speed at which to cancel; default 13/12 of idle"] = None,
    held: Annotated[bool, "let the planet inertia follow, so that every variant cancels at that speed"] = False,
    gear: Annotated[str, "gear by its name; empty: the last one"] = "",
) -> xr.Dataset:
    """Design of a power split absorber: cancellation speed, its depth against a dual mass flywheel, the price above it.

    Told with it is the planet inertia for a wanted cancellation speed.
    """
    model, (quantity, symbol, change) = trucks.psva, chosen(VARIED, varied, "varied")
    own = Parts.of(model)
    wanted = positive(cancellation, ABOVE_IDLE * model.operation.idle, "cancellation")
    at = values_of(values, _derived(own, symbol), "values")
    _within(at, symbol, own)
    models = [change(model, float(value)) for value in at]
    if held:
        _refuse_both(symbol)
        models = [_tuned(each, wanted) for each in models]
    data = over(
        Along(varied.replace("-", "_"), at, quantity, varied.replace("-", " ")),
        _curves(models, gear) | _following(models, held),
        model,
    )
    where = INPUT.replace("top gear", f"gear {model.gear_name(gear)}")
    condition = f"{where}; absorber: {trucks.origins.get('psva', 'as given')}"
    return advised(data, "psva-design", model, condition, list(_findings(model, data, wanted, held)))


def _derived(own: Parts, symbol: str) -> Array:
    """From half to twice its own value; a quotient from 0.5 to 0.95."""
    return np.linspace(0.5, 0.95, 10) if symbol == "r" else float(getattr(own, symbol)) * np.geomspace(0.5, 2.0, 9)


def _within(values: Array, symbol: str, own: Parts) -> None:
    if symbol == "r" and values.max() > 1:
        allowed = "above 0, at most 1 (1: output and secondary turn as one; 1/r is the other reading of the quotient)"
        raise ModelError("no such quotient", where="values", found=f"{values.max():g}", allowed=allowed)


def _refuse_both(symbol: str) -> None:
    if symbol == "J3":
        remedy = "vary gear-quotient, stiffness or secondary-inertia"
        raise ModelError("planets that follow cannot be varied as well", where="held", remedy=remedy)


def planets(model: Model, wanted: float) -> float:
    """Planet inertia [kgm²] that cancels at an engine speed [rad/s].

    Raises ModelError where the absorber without planets already cancels below it.
    """
    own = Parts.of(model)
    found = float(own.planets_for(main_order(model) * wanted, own.r))
    if found <= 0:
        highest = np.sqrt(own.k / (own.J2 * (1 - own.r))) / main_order(model) if own.r < 1 else np.inf
        raise ModelError(
            "no planet inertia moves the cancellation that high",
            where="cancellation",
            found=f"{wanted / RPM:.0f} rpm",
            allowed=f"below {highest / RPM:.0f} rpm",
            remedy="stiffer springs, less secondary inertia or a gear quotient nearer 1 move it up",
        )
    return found


def _tuned(model: Model, wanted: float) -> Model:
    return replaced(model, Parts.of(model).planets, inertia=planets(model, wanted))


def _curves(models: list[Model], gear: str) -> dict[str, Curve]:
    at = np.array([cancelled(each) for each in models])
    grid = speeds(models[0], STEP)
    own = np.array([at_input(each, grid, gear=gear) for each in models])
    plain = np.array([at_input(merged(each), grid, gear=gear) for each in models])
    ratio = own / plain
    high = grid > min(HIGH * at.max(), 0.8 * grid[-1])
    better = [grid[row < 1][[0, -1]] if (row < 1).any() else np.full(2, np.nan) for row in ratio]
    low, up = np.array(better).T
    speed = "engine speed"
    return {
        "cancellation": Curve(at, "speed", "output stands still, undamped", speed),
        "better_from": Curve(low, "speed", "lowest at which it is quieter than the DMF", speed),
        "better_to": Curve(up, "speed", "highest", speed),
        "depth": Curve(ratio.min(axis=1), "ratio", "lowest over the DMF's", "amplitude over the corresponding DMF's"),
        "high": Curve(
            own[:, high].mean(axis=1),
            "acceleration",
            "power split absorber",
            f"mean from {grid[high][0] / RPM:.0f} rpm on, acceleration",
            HALF,
        ),
        "high_dmf": Curve(
            plain[:, high].mean(axis=1),
            "acceleration",
            "corresponding DMF",
            f"mean from {grid[high][0] / RPM:.0f} rpm on, acceleration",
            HALF,
        ),
    }


def _following(models: list[Model], held: bool) -> dict[str, Curve]:
    used = Curve([Parts.of(each).J3 for each in models], "inertia", panel="planet inertia")
    return {"planets": used} if held else {}


def _findings(model: Model, data: xr.Dataset, wanted: float, held: bool) -> Iterator[str]:
    own, along = Parts.of(model), str(next(iter(data.dims)))
    yield (
        f"as it is (planets {own.J3:.3g} kgm², r = {own.r:.3g}, 1/r = {1 / own.r:.3g}, {own.k / 1e3:.3g} kNm/rad) the "
        f"absorber cancels at {cancelled(model) / RPM:.0f} rpm"
    )
    try:
        yield f"{planets(model, wanted):.3g} kgm² of planets cancel at {wanted / RPM:.0f} rpm"
    except ModelError as error:
        yield str(error)
    ends = [data.isel({along: place}) for place in (0, -1)]
    name = along.replace("_", " ")
    for what, value in (("cancellation", "cancellation"), ("mean amplitude at high speed", "high")):
        low, up = (float(end[value]) / (RPM if value == "cancellation" else 1) for end in ends)
        unit = "rpm" if value == "cancellation" else "rad/s²"
        if not (held and value == "cancellation"):
            first, last = (_shown(end[along]) for end in ends)
            yield f"{name} from {first} to {last}: {what} from {low:.0f} to {up:.0f} {unit}"
    best = data.isel({along: int(data.depth.values.argmin())})
    yield (
        f"deepest at {name} {_shown(best[along])}: {100 * float(best.depth):.0f} % of the corresponding dual mass "
        f"flywheel's amplitude; quieter than it from {float(best.better_from) / RPM:.0f} to "
        f"{float(best.better_to) / RPM:.0f} rpm"
    )


def _shown(value: xr.DataArray) -> str:
    unit = str(value.attrs.get("units", ""))
    return f"{float(value):.3g}" + (f" {unit}" if unit not in ("", "-") else "")
