"""`tva-design`: a tuned absorber in a dual mass flywheel, on its flange or on its secondary."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
import xarray as xr

from torsional.absorbers import tuned_stiffness
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.advice import HALF, advised, chosen, drawn, over, positive, values_of
from torsional.studies.answers import INPUT, STEP, at_input, main_order, modes, speeds
from torsional.studies.base import tool
from torsional.studies.swept import Along, Curve
from torsional.studies.trucks import Trucks, replaced, without
from torsional.studies.tuned_absorber import RING, SPRING, added, tuning
from torsional.units import RPM

SEPARATIONS = (0.05, 0.1, 0.2)
"""Of the added resonance from the tuning, over the tuning."""
QUANTITIES = {"inertia": "inertia", "damping": "damping"}


def fitted(model: Model, carrier: str, inertia: float, damping: float, speed: float) -> Model:
    """A copy whose absorber sits on the flange or on the secondary, tuned to a firing-order ``speed`` [rad/s]."""
    springs, omega = model.landmarks.springs, speed * main_order(model)
    first, last = (model.components[name] for name in (springs[0], springs[-1]))
    nodes: dict[str, Any] = {"flange": first.a, "secondary": last.a}  # type: ignore[attr-defined]
    k = tuned_stiffness(inertia, omega)
    model = replaced(model, RING, inertia=inertia)
    return replaced(model, SPRING, a=chosen(nodes, carrier, "carrier"), stiffness=k, damping=damping)


@tool("tva-design", varies="inertia or damping of a tuned absorber, engine speed", picture=drawn)
def tva_design(
    trucks: Trucks,
    *,
    carrier: Annotated[str, "body it sits on: flange or secondary"] = "flange",
    varied: Annotated[str, "inertia (tuning and damping ratio kept) or damping"] = "inertia",
    values: Annotated[
        tuple[float, ...] | None, "values of it in SI; empty: from a quarter to eight times its own"
    ] = None,
    tuned: Annotated[float | None, "speed", "engine speed at which the firing order meets the tuning"] = None,
    inertia: Annotated[float | None, "inertia", "inertia of the absorber where damping is varied"] = None,
    gear: Annotated[str, "gear by its name; empty: the last one"] = "",
) -> xr.Dataset:
    """Design of a tuned absorber: reduction at its speed, the resonance that it adds, how far that lies below.

    Amplitudes are told against the same flywheel without it; the tuning is kept while inertia or damping vary.
    """
    model, speed = trucks.tva, positive(tuned, tuning(trucks.tva), "tuned")
    quantity = chosen(QUANTITIES, varied, "varied")
    ring: Any = model.components[RING]
    spring: Any = model.components[SPRING]
    size = positive(inertia, ring.inertia, "inertia")
    scale = spring.damping / np.sqrt(spring.stiffness * ring.inertia)  # twice the damping ratio
    own = {"inertia": size, "damping": scale * main_order(model) * speed * size}
    at = values_of(values, own[varied] * np.geomspace(0.25, 8.0, 16), "values")
    pairs = [(J, scale * main_order(model) * speed * J) for J in at] if varied == "inertia" else [(size, c) for c in at]
    models = [fitted(model, carrier, float(J), float(c), speed) for J, c in pairs]
    curves = _curves(models, speed, gear)
    data = over(Along(varied, at, quantity, f"{varied} of the absorber", "log"), curves, model)
    condition = (
        f"{INPUT.replace('top gear', 'gear ' + model.gear_name(gear))}; absorber on the {carrier}, tuned to "
        f"{speed / RPM:.0f} rpm; flywheel: {trucks.origins.get('tva', 'as given')}"
    )
    return advised(data, "tva-design", model, condition, list(_findings(data, varied, speed)))


def _curves(models: list[Model], tuned: float, gear: str) -> dict[str, Curve]:
    plain, there = without(models[0], RING, SPRING), np.array([tuned])
    grid = speeds(models[0], STEP)
    bare, bare_there = at_input(plain, grid, gear=gear), float(at_input(plain, there, gear=gear)[0])
    found = np.array([at_input(each, grid, gear=gear) for each in models])
    notch = np.array([at_input(each, there, gear=gear)[0] for each in models])
    resonance = np.array([added(each, lambda line: modes(line, gear).order_speed.values) for each in models])
    panel, ratio = "order speed", "amplitude over that without absorber"
    limit = {"limit": tuned, "limit_words": "tuning"}
    return {
        "resonance": Curve(resonance, "speed", "resonance that the absorber adds", panel, **limit),  # type: ignore[arg-type]
        "separation": Curve(1 - resonance / tuned, "ratio", panel="separation over the tuning speed"),
        "at_tuning": Curve(
            notch / bare_there, "ratio", "at the tuning speed", ratio, limit=1.0, limit_words="as without it"
        ),
        "worst": Curve(found.max(axis=1) / bare.max(), "ratio", "largest over the range", ratio),
        "median": Curve(np.median(found / bare, axis=1), "ratio", "median over the range", ratio),
        "largest": Curve(found.max(axis=1), "acceleration", "with absorber", "largest acceleration in the range", HALF),
        "stiffness": Curve([each.components[SPRING].stiffness for each in models], "stiffness", panel="stiffness"),  # type: ignore[attr-defined]
    }


def _findings(data: xr.Dataset, varied: str, tuned: float) -> Iterator[str]:
    ends = [data.isel({varied: place}) for place in (0, -1)]
    unit = data[varied].attrs["units"]
    for end in ends:
        yield (
            f"with {float(end[varied]):.3g} {unit} the added resonance lies at {float(end.resonance) / RPM:.0f} rpm, "
            f"{100 * float(end.separation):.0f} % below the tuning of {tuned / RPM:.0f} rpm; amplitude there "
            f"{100 * float(end.at_tuning):.0f} % of that without absorber, the largest of the range "
            f"{100 * float(end.worst):.0f} %"
        )
    if varied == "inertia":
        told = [f"{100 * apart:.0f} % {_told(needed_inertia(data, apart))}" for apart in SEPARATIONS]
        yield f"separations need, of the absorber: {', '.join(told)}"
    best = data.isel({varied: int(data.worst.values.argmin())})
    yield (
        f"the largest amplitude of the range is lowest with {float(best[varied]):.3g} {unit}: "
        f"{float(best.largest):.0f} rad/s², {100 * float(best.worst):.0f} % of that without absorber"
    )


def _told(inertia: float) -> str:
    return f"{inertia:.2g} kgm²" if np.isfinite(inertia) else "more than asked"


def needed_inertia(data: xr.Dataset, separation: float) -> float:
    """Inertia [kgm²] for a separation, between the values asked; infinite where none of them reaches it."""
    apart: Array = data.separation.values
    return float(np.exp(np.interp(separation, apart, np.log(data.inertia.values), right=np.inf)))
