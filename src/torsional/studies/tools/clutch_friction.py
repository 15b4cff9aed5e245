"""`clutch-friction`: what a friction washer in the clutch does for the resonance, and what it costs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.model import Model
from torsional.studies.advice import HALF, advised, concept, drawn, over, positive, values_of
from torsional.studies.base import tool
from torsional.studies.friction import Curve as Answer
from torsional.studies.friction import answered, least_torque, washed
from torsional.studies.swept import Along, Curve
from torsional.studies.trucks import Trucks, stiffness
from torsional.units import RPM

STICKING = 4.0
"""Stiffness of a washer that sticks, over the clutch damper's."""
SWEEP = (0.004, 0.012, 0.024, 0.036, 0.048, 0.06)
"""Friction torques over the full-load peak."""
FAR = 0.75
"""The far speed over the highest one."""
LEAST = 0.0004
"""Friction torque that stands for none, over the full-load peak."""


@tool("clutch-friction", varies="friction torque of a washer in the clutch, engine speed", picture=drawn)
def clutch_friction(
    trucks: Trucks,
    *,
    absorber: Annotated[str, "absorber concept: smf, dmf, psva …"] = "smf",
    torques: Annotated[tuple[float, ...] | None, "torque", "friction torques; empty: 0.4 to 6 % of full load"] = None,
    viscous: Annotated[float, "viscous damping left beside the washer, over the clutch's own"] = 1.0,
    sticking: Annotated[
        float | None, "stiffness", "stiffness of a washer that sticks; default four times the damper's"
    ] = None,
    far: Annotated[float | None, "speed", "speed far from the resonance; default three quarters of the highest"] = None,
    limit: Annotated[
        float | None, "acceleration", "largest amplitude allowed; default the lowest of the sweep × 1.25"
    ] = None,
) -> xr.Dataset:
    """Clutch friction: resonance, vibration far from it and power over friction torque; friction that a limit needs.

    Top gear, by harmonic balance of the firing order and its multiples; the amplitude is that of the firing order.
    """
    model = concept(trucks, absorber)
    peak = model.full_load_peak()
    stuck = positive(sticking, STICKING * stiffness(model, model.landmarks.clutch), "sticking")
    at = values_of(torques, peak * np.array(SWEEP), "torques")
    ends = _ends(model, far)
    found = [answered(washed(model, float(torque), viscous, stuck), ends) for torque in at]
    data = over(Along("friction_torque", at, "torque", "friction torque"), _curves(found, ends[1]), model)
    most = positive(limit, 1.25 * float(data.peak.min()), "limit")
    condition = (
        f"mean torque 60 % of the peak, top gear, {ends[0] / RPM:.0f} to {ends[1] / RPM:.0f} rpm; firing order's "
        f"acceleration at the gearbox input, half peak-to-peak; washer of {stuck / 1e3:.3g} kNm/rad beside the clutch "
        f"damper, whose viscous damping is {viscous:g} of its own; absorber: {trucks.origins.get(absorber, 'as given')}"
    )

    def excess(torque: float) -> float:
        return answered(washed(model, torque, viscous, stuck), ends).peak[0] - most

    least = least_torque(excess, LEAST * peak, float(at[_best(data)]))
    return advised(data, "clutch-friction", model, condition, list(_findings(data, least, most)))


def _ends(model: Model, far: float | None) -> tuple[float, float]:
    """From idle, or the lowest speed asked, to the far one."""
    low, high = model.operation.speed
    end = positive(far, FAR * high, "far")
    if end <= low:
        raise ModelError("the far speed lies above the resonance", where="far", found=f"{end / RPM:.0f} rpm")
    return low, end


def _curves(found: list[Answer], far: float) -> dict[str, Curve]:
    peak, at = np.array([one.peak for one in found]).T
    away = np.array([one.amplitude[-1] for one in found])
    power = np.array([[one.at(place, one.power), one.power[-1]] for one, place in zip(found, at, strict=True)])
    at_far = f"at {far / RPM:.0f} rpm"
    return {
        "peak": Curve(peak, "acceleration", panel="largest acceleration", amplitude=HALF),
        "far": Curve(away, "acceleration", panel=f"acceleration {at_far}", amplitude=HALF),
        "resonance": Curve(at, "speed", panel="speed of the largest"),
        "power": Curve(power[:, 0], "power", "at the resonance", "friction power"),
        "far_power": Curve(power[:, 1], "power", at_far, "friction power"),
    }


def _findings(data: xr.Dataset, least: float, limit: float) -> Iterator[str]:
    first, last, best = (data.isel(friction_torque=place) for place in (0, -1, _best(data)))
    low, high, middle = (float(each.friction_torque) for each in (first, last, best))
    yield (
        f"with {low:.0f} Nm the resonance at {float(first.resonance) / RPM:.0f} rpm has "
        f"{float(first.peak):.0f} rad/s², "
        f"lowest with {middle:.0f} Nm: {float(best.peak):.0f} rad/s²"
    )
    far = f"from {float(first.far):.0f} to {float(last.far):.0f} rad/s²"
    yield f"far from the resonance the amplitude goes {far} from {low:.0f} to {high:.0f} Nm"
    power, away = (max(float(each), 0.0) for each in (best.power, best.far_power))
    yield f"with {middle:.0f} Nm the washer takes {power:.0f} W at the resonance and {away:.0f} W far from it"
    if least == 0:
        yield f"a limit of {limit:.0f} rad/s² is kept without friction"
    elif np.isfinite(least):
        yield f"{least:.0f} Nm of friction bring the largest amplitude to {limit:.0f} rad/s²"
    else:
        yield f"no friction torque of those asked brings the largest amplitude to {limit:.0f} rad/s²"


def _best(data: xr.Dataset) -> int:
    """Place of the lowest peak: with more friction the washer comes to stick."""
    return int(data.peak.values.argmin())
