"""The claim that the model of the engine matters near resonance (A13)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from torsional.engine.orders import HALF_ORDERS, BoolArray
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, swing
from torsional.studies.answers import main_order, mode_of, modes, responded, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.excitation import STEP
from torsional.studies.swept import Curve, over_speed, swept
from torsional.studies.trucks import Trucks, lumped, replaced
from torsional.units import RPM

NEAR = 0.1
"""Near a resonance: within this share of its speed."""
LIGHT = 0.05
"""Clutch damping that shows what a sharper resonance would tell, over the shipped one."""
BEYOND = (
    ". Away from it the difference grows with the square of frequency, as the firing order nears the crankshaft's "
    "first mode"
)
OTHERS = (
    ". In the swing over a cycle, which holds the orders that only a flexible crankshaft lets out, the two models "
    "differ by up to {swing:.0f} %: there the thesis's observation holds"
)


def differences(model: Model, speed: Array, gear: str | None = None) -> tuple[Array, Array]:
    """A lumped engine's input acceleration over that of the flexible crankshaft, less one: firing order, swing."""
    load = model.full_load(speed)
    pair = [_accelerations(m, speed, load, gear) for m in (model, lumped(model))]
    order = [np.abs(a.sel(order=main_order(model)).values) for a in pair]
    cycle = [swing(a).values for a in pair]
    return order[1] / order[0] - 1, cycle[1] / cycle[0] - 1


def _accelerations(model: Model, speed: Array, torque: Array, gear: str | None) -> xr.DataArray:
    angle = responded(model, speed, torque, gear, orders=HALF_ORDERS).angle
    return acceleration(angle.sel(node=model.landmarks.input))


def resonance(model: Model, gear: str | None = None) -> float:
    """Order speed of the clutch mode [rad/s], in top gear unless given."""
    found = modes(model, gear)
    return float(found.order_speed[mode_of(found, model.landmarks.clutch)])


def _first_crank_mode(model: Model) -> float:
    """Order speed [rad/s] of the lowest mode with most of its elastic energy in the engine."""
    rigid = {stamp.name for stamp in lumped(model).powertrain().stamps}
    found = modes(model)
    engine = found.elastic_share.sel(element=[name for name in found.element.values if name not in rigid])
    within = found.order_speed.values[engine.sum("element").values > 0.5]
    return float(within.min(initial=np.inf))


def _why(name: str, figures: dict[str, Figure]) -> str:
    """What little a flexible crankshaft does near the clutch mode, and what would make it more."""
    ratio, shift, width, light, low = (
        figures[f"{name}: {told}"]
        for told in (
            "first crankshaft mode over clutch mode [-]",
            "clutch mode moved by the lumped engine [%]",
            "width of the resonance, twice its damping ratio [%]",
            f"clutch damping × {LIGHT:g}: order, near [%]",
            "lowest gear: order, near [%]",
        )
    )
    return (
        f"{name}: the crankshaft's first mode lies at {ratio:.1f} times the clutch mode; lumping moves that mode by "
        f"{shift:.2f} %, a shift that tells as much as damping leaves of the resonance, here {width:.0f} % wide: near "
        f"it the difference is {figures[f'{name}: order, near [%]']:.1f} %, {low:.1f} % in the lowest gear, and "
        f"{light:.1f} % with × {LIGHT:g} of the clutch's damping"
    )


def _sharpness(name: str, model: Model) -> dict[str, Figure]:
    """How far lumping the engine moves the clutch mode, beside the width of its resonance; a sharper one."""
    found, at = modes(model), resonance(model)
    clutch: Any = model.components[model.landmarks.clutch]
    sharp = replaced(model, model.landmarks.clutch, damping=LIGHT * clutch.damping)
    damping = float(found.damping_ratio[mode_of(found, model.landmarks.clutch)])
    lowest = model.gear_names[0]
    return {
        f"{name}: first crankshaft mode over clutch mode [-]": _first_crank_mode(model) / at,
        f"{name}: clutch mode moved by the lumped engine [%]": 100 * abs(resonance(lumped(model)) / at - 1),
        f"{name}: width of the resonance, twice its damping ratio [%]": 100 * 2 * damping,
        f"{name}: clutch damping × {LIGHT:g}: order, near [%]": _closely(sharp, at),
        f"{name}: lowest gear: order, near [%]": _closely(model, resonance(model, lowest), lowest),
    }


def _closely(model: Model, resonance: float, gear: str | None = None) -> float:
    """The largest difference [%] of the firing order near a resonance [rad/s]; 0 for one out of range."""
    (low, high), (first, last) = model.operation.speed, ((1 - NEAR) * resonance, (1 + NEAR) * resonance)
    speed = np.linspace(max(low, first), min(high, last), 101 if max(low, first) < min(high, last) else 0)
    return 100 * float(np.abs(differences(model, speed, gear)[0]).max()) if speed.size else 0.0


def _compared(name: str, near: BoolArray, order: Array, cycle: Array) -> dict[str, Curve]:
    """Differences near the resonance and away from it, each with its limit, and of the swing."""
    key, panel, size = name.lower(), f"{name}: lumped against flexible engine, difference", np.abs(order)
    look: dict[str, Any] = {"panel": panel, "scale": "log"}
    told = "firing order, within ±10 % of the clutch mode"
    return {
        f"{key}_near": Curve(
            np.where(near, size, np.nan), "relative_difference", told, limit=0.1, limit_words="near: above 10 %", **look
        ),
        f"{key}_away": Curve(
            np.where(near, np.nan, size),
            "relative_difference",
            "firing order, away from it",
            limit=0.05,
            limit_words="away: below 5 %",
            **look,
        ),
        f"{key}_swing": Curve(np.abs(cycle), "relative_difference", "swing over a cycle, all orders", **look),
    }


def _sides(name: str, speed: Array, near: BoolArray, order: Array, cycle: Array) -> dict[str, Figure]:
    worst = int(np.abs(cycle).argmax())
    return {
        f"{name}: order, near [%]": 100 * float(np.abs(order[near]).max(initial=0.0)),
        f"{name}: order, away, largest [%]": 100 * float(np.abs(order[~near]).max(initial=0.0)),
        f"{name}: order, away, within 5 % up to [rpm]": float(
            speed[~near & (np.abs(order) > 0.05)].min(initial=np.inf) / RPM
        ),
        f"{name}: swing, near [%]": 100 * float(np.abs(cycle[near]).max(initial=0.0)),
        f"{name}: swing, largest [%]": 100 * float(np.abs(cycle[worst])),
        f"{name}: swing, largest at [rpm]": float(speed[worst] / RPM),
    }


@claim(
    "A13",
    "4.1",
    "Near resonance the model of the engine, flexible crankshaft or one lumped inertia, significantly changes the "
    "result behind the flywheel.",
    "firing order's acceleration at the gearbox input: the two differ by more than 10 % within ±10 % of the "
    "resonance's speed and by less than 5 % away from it",
    varies="engine speed over the operating range in steps of 25 rpm, at full load in top gear; flexible crankshaft "
    "against one lumped inertia, single and dual mass flywheel; damping of the clutch × 1 and × 0.05; top and "
    "lowest gear",
    leading="SMF: order, near [%]",
)
def a13(trucks: Trucks) -> Finding:
    figures: dict[str, Figure] = {}
    good, curves, why = True, dict[str, Curve](), list[str]()
    for name, model in (("SMF", trucks.smf), ("DMF", trucks.dmf)):
        speed = speeds(model, STEP)
        order, cycle = differences(model, speed)
        near = np.abs(speed / resonance(model) - 1) < NEAR
        figures |= _sides(name, speed, near, order, cycle) | _sharpness(name, model)
        good &= bool(np.abs(order[near]).max(initial=0.0) > 0.1 and np.abs(order[~near]).max(initial=0.0) < 0.05)
        curves |= _compared(name, near, order, cycle)
        why.append(_why(name, figures))
    most = min(float(figures[f"{name}: swing, largest [%]"]) for name in ("SMF", "DMF"))  # type: ignore[arg-type]
    reason = "; ".join(why) + BEYOND + (OTHERS.format(swing=most) if most > 10 else "")
    data = swept("A13", over_speed(speed), curves)
    return Finding(good, "full load, top gear, half peak-to-peak", figures, "" if good else reason, data)
