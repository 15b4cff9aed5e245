"""`cylinder-deactivation`: vibration with fewer cylinders at work."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
import xarray as xr

from torsional.studies.advice import advised, concept, values_of
from torsional.studies.answers import speeds
from torsional.studies.base import tool
from torsional.studies.cylinders import BESIDE, STEP, WHOLE, compared, drawn, engines, part_loads, strongest
from torsional.studies.trucks import Trucks
from torsional.units import RPM


@tool("cylinder-deactivation", varies="cylinders that fire, engine speed, mean torque", picture=drawn)
def cylinder_deactivation(
    trucks: Trucks,
    *,
    absorbers: Annotated[tuple[str, ...], "absorber concepts, at most two are drawn"] = ("smf", "dmf"),
    off: Annotated[tuple[int, ...], "cylinders without fuel; empty: every second of the firing order"] = (),
    valves: Annotated[str, "of those cylinders: closed (gas springs) or working (they breathe)"] = "closed",
    cylinders: Annotated[int, "cylinders of the shorter engine beside it; 0: the next smaller"] = 0,
    torques: Annotated[tuple[float, ...] | None, "torque", "mean torques"] = None,
    gear: Annotated[str, "gear by its name; empty: the last one"] = "",
) -> xr.Dataset:
    """Vibration at the gearbox input with cylinders switched off and with a shorter engine: orders, resonances, swing.

    Mean torques beyond half of full load (NaN) are left out, so that all engines are asked alike.
    """
    models = {name: concept(trucks, name) for name in absorbers}
    asked = {name.upper().replace("_", " "): engines(m, off, cylinders, valves) for name, m in models.items()}
    first = next(iter(models.values()))
    mean = values_of(torques, part_loads(first), "torques", least=1)
    data = compared(asked, speeds(first, STEP), mean, gear)
    condition = (
        f"mean torques {mean[0]:.0f} to {mean[-1]:.0f} Nm up to half of full load, gear {first.gear_name(gear)}; half "
        f"the swing of the acceleration at the gearbox input over a cycle, orders 0.5 to 12; valves of cylinders "
        f"without fuel {valves}"
    )
    return advised(data, "cylinder-deactivation", first, condition, list(_findings(data)))


def _findings(data: xr.Dataset) -> Iterator[str]:
    worst = data.swing.max(("mean_torque", "speed"))
    for name in data.concept.values:
        whole = float(worst.sel(concept=name, engine=WHOLE))
        yield f"{name}: all cylinders swing by {whole:.0f} rad/s² at most, order {_order(data, name, WHOLE)}"
        for engine in data.engine.values[1:]:
            at, size = (
                _place(data.swing.sel(concept=name, engine=engine)),
                float(worst.sel(concept=name, engine=engine)),
            )
            met = "" if engine == BESIDE else _met(data, name, engine)
            yield (
                f"{name}, {engine}: {size:.0f} rad/s² ({size / whole:.2g} times) at {at / RPM:.0f} rpm, "
                f"order {_order(data, name, engine)} holds most of it{met}"
            )


def _order(data: xr.Dataset, concept: str, engine: str) -> str:
    return f"{float(strongest(data.sel(concept=concept, engine=engine))):g}"


def _place(swing: xr.DataArray) -> float:
    return float(swing.speed[int(np.nanargmax(swing.max("mean_torque").values))])


def _met(data: xr.Dataset, concept: str, engine: str) -> str:
    """The modes that the firing order meets at or below the speeds asked."""
    found = data.resonance.sel(concept=concept, engine=engine)
    pairs = zip(found.mode.values, found.values, strict=True)
    told = [f"the {mode} at {at / RPM:.0f} rpm" for mode, at in pairs if at <= float(data.speed[-1])]
    return f"; the firing order meets {' and '.join(told)}" if told else ""
