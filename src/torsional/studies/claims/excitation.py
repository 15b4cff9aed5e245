"""Claims about what the engine does to the line, and how it must be modelled (A1, A13, A15)."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.engine.orders import HALF_ORDERS, BoolArray
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, irregularity, order_share, swing
from torsional.studies.answers import (
    curves,
    floats,
    input_shaft,
    main_order,
    mode_of,
    modes,
    responded,
    speeds,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.trucks import Trucks, lumped
from torsional.units import RPM

CROSSING = 0.5
"""The firing order is near a zero crossing where the engine's own is below this share of its median over speed."""
NEAR = 0.1
"""Near a resonance: within this share of its speed."""
STEP = 25 * RPM


def crossing(model: Model, speed: Array) -> BoolArray:
    """Where gas and mass torque of the firing order all but cancel in the engine itself, at full load; boolean."""
    own = model.running_engine.harmonics(speed, model.full_load(speed), [main_order(model)]).sum(axis=-2)[:, 0]
    return np.asarray(np.abs(own) < CROSSING * np.median(np.abs(own)))


def _orders_at(model: Model, speed: Array) -> xr.DataArray:
    """Torque orders of the gearbox input shaft at full load [Nm], complex 0-peak, (speed, order)."""
    found: xr.DataArray = responded(model, speed, model.full_load(speed), orders=HALF_ORDERS).torque
    return found.sel(element=input_shaft(model))


def share(model: Model, speed: Array) -> Array:
    """Share of the firing order in the mean square of that torque."""
    return np.asarray(order_share(_orders_at(model, speed), main_order(model)).values)


@claim(
    "A1",
    "2.1",
    "The torque of a four-stroke six-cylinder engine peaks three times a revolution: its third order dominates behind "
    "the flywheel.",
    "at full load the firing order has more than 80 % of the mean square of the torque oscillation in the gearbox "
    "input shaft at every speed of the range away from zero crossings of the order (single mass flywheel, top gear)",
)
def a1(trucks: Trucks) -> Finding:
    model, speed = trucks.smf, speeds(trucks.smf, STEP)
    away = ~crossing(model, speed)
    flexible, rigid, double = (share(m, speed) for m in (model, lumped(model), trucks.dmf))
    power = abs(_orders_at(model, speed)) ** 2
    short = away & (flexible <= 0.8)
    figures: dict[str, Figure] = {
        "lowest share away from crossings [-]": float(flexible[away].min()),
        "part of the range above 80 % [%]": 100 * float((flexible[away] > 0.8).mean()),
        "share of the whole range's mean square [-]": float(power.sel(order=main_order(model)).sum() / power.sum()),
        "rigid crankshaft: lowest share [-]": float(rigid[away].min()),
        "DMF: part of the range above 80 % [%]": 100 * float((double[away] > 0.8).mean()),
    }
    reason = _other_orders(model, speed[short], power.values[short]) if short.any() else ""
    data = curves("A1", speed, "energy_share", smf=flexible, dmf=double, rigid_crankshaft=rigid)
    return Finding(not short.any(), "full load, top gear, orders 0.5–12", figures, reason, data)


def _other_orders(model: Model, speed: Array, power: Array) -> str:
    others = [place for place, n in enumerate(HALF_ORDERS) if n != main_order(model)]
    strongest = HALF_ORDERS[others][np.argsort(power[:, others].sum(axis=0))[::-1][:2]]
    named = " and ".join(f"{n:g}" for n in sorted(strongest))
    return (
        f"from {speed[0] / RPM:.0f} rpm the line isolates the firing order so well that orders {named} show, which "
        "meet higher modes there (what all other orders hold of the whole range's mean square is in the figures)"
    )


def differences(model: Model, speed: Array) -> tuple[Array, Array]:
    """A lumped engine's input acceleration over that of the flexible crankshaft, less one: firing order, swing."""
    load = model.full_load(speed)
    pair = [_accelerations(m, speed, load) for m in (model, lumped(model))]
    order = [np.abs(a.sel(order=main_order(model)).values) for a in pair]
    cycle = [swing(a).values for a in pair]
    return order[1] / order[0] - 1, cycle[1] / cycle[0] - 1


def _accelerations(model: Model, speed: Array, torque: Array) -> xr.DataArray:
    return acceleration(responded(model, speed, torque, orders=HALF_ORDERS).angle.sel(node=model.landmarks.input))


def resonance(model: Model) -> float:
    """Order speed of the clutch mode in top gear [rad/s]."""
    found = modes(model)
    return float(found.order_speed[mode_of(found, model.landmarks.clutch)])


def _first_crank_mode(model: Model) -> float:
    """Order speed [rad/s] of the lowest mode with most of its elastic energy in the engine."""
    rigid = {stamp.name for stamp in lumped(model).powertrain().stamps}
    found = modes(model)
    engine = found.elastic_share.sel(element=[name for name in found.element.values if name not in rigid])
    within = found.order_speed.values[engine.sum("element").values > 0.5]
    return float(within.min(initial=np.inf))


@claim(
    "A13",
    "4.1",
    "Near resonance the model of the engine, flexible crankshaft or one lumped inertia, significantly changes the "
    "result behind the flywheel.",
    "firing order's acceleration at the gearbox input: the two differ by more than 10 % within ±10 % of the "
    "resonance's speed and by less than 5 % away from it",
)
def a13(trucks: Trucks) -> Finding:
    figures: dict[str, Figure] = {}
    good = True
    told: dict[str, Array] = {}
    for name, model in (("SMF", trucks.smf), ("DMF", trucks.dmf)):
        speed = speeds(model, STEP)
        order, cycle = differences(model, speed)
        near = np.abs(speed / resonance(model) - 1) < NEAR
        figures |= _sides(name, speed, near, order, cycle)
        figures[f"{name}: first crankshaft mode over clutch mode [-]"] = _first_crank_mode(model) / resonance(model)
        good &= bool(np.abs(order[near]).max() > 0.1 and np.abs(order[~near]).max() < 0.05)
        told |= {f"{name.lower()}_order": order, f"{name.lower()}_swing": cycle}
    reason = (
        "the crankshaft's first mode lies far above the clutch mode, so near that resonance the engine moves as one "
        "body; the difference grows with the square of frequency instead. In the swing over a cycle, which holds the "
        "orders that only a flexible crankshaft passes on, it is large near the higher resonances"
    )
    data = curves("A13", speed, "ratio", **told)
    return Finding(good, "full load, top gear, half peak-to-peak", figures, "" if good else reason, data)


def _sides(name: str, speed: Array, near: BoolArray, order: Array, cycle: Array) -> dict[str, Figure]:
    worst = int(np.abs(cycle).argmax())
    return {
        f"{name}: order, near [%]": 100 * float(np.abs(order[near]).max()),
        f"{name}: order, away, largest [%]": 100 * float(np.abs(order[~near]).max()),
        f"{name}: order, away, within 5 % up to [rpm]": float(
            speed[~near & (np.abs(order) > 0.05)].min(initial=np.inf) / RPM
        ),
        f"{name}: swing, near [%]": 100 * float(np.abs(cycle[near]).max()),
        f"{name}: swing, largest [%]": 100 * float(np.abs(cycle[worst])),
        f"{name}: swing, largest at [rpm]": float(speed[worst] / RPM),
    }


@claim(
    "A15",
    "3.3",
    "The crankshaft's irregularity as a solid body is larger with a dual mass flywheel.",
    "cyclic irregularity of the crankshaft at idle under full load: dual mass above single mass flywheel",
)
def a15(trucks: Trucks) -> Finding:
    single, double = _irregularity(trucks.smf), _irregularity(trucks.dmf)
    figures: dict[str, Figure] = {
        "SMF, solid body and flywheel [%]": floats(100 * single),
        "DMF, solid body and primary [%]": floats(100 * double),
        "ratio [-]": floats(double / single),
    }
    condition = "idle, full load, top gear, peak-to-peak over mean, orders 0.5–12"
    return Finding(bool((double > single).all()), condition, figures)


def _irregularity(model: Model) -> Array:
    """Irregularity of the throws' mean motion and of the crankshaft landmark at idle under full load."""
    idle = np.array([model.operation.idle])
    angle = responded(model, idle, model.full_load(idle), orders=HALF_ORDERS).angle
    body = angle.sel(node=list(model.landmarks.throws)).mean("node")
    both = [body, angle.sel(node=model.landmarks.crankshaft)]
    return np.array([float(irregularity(motion).values[0]) for motion in both])
