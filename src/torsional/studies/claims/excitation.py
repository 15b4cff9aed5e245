"""Claims about what the engine does to the line, and how it must be modelled (A1, A15)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from torsional.engine.orders import HALF_ORDERS, BoolArray
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import irregularity, order_share
from torsional.studies.answers import (
    floats,
    input_shaft,
    main_order,
    modes,
    responded,
    speeds,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Curve, over_speed, swept
from torsional.studies.trucks import Trucks, lumped
from torsional.units import RPM

CROSSING, MEETS = 0.5, 0.1
"""The firing order is near a zero crossing where the engine's own is below this share of its median over speed; an
order meets a mode within this share of its frequency."""
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
    varies="engine speed over the operating range in steps of 25 rpm, at full load in top gear; beside the single mass "
    "flywheel a rigid crankshaft and the dual mass flywheel",
    leading="lowest share away from crossings [-]",
)
def a1(trucks: Trucks) -> Finding:
    model, speed = trucks.smf, speeds(trucks.smf, STEP)
    away, order = ~crossing(model, speed), main_order(model)
    flexible, rigid, double = (share(m, speed) for m in (model, lumped(model), trucks.dmf))
    torque = abs(_orders_at(model, speed))
    own, other = torque.sel(order=order).values, torque.drop_sel(order=order).max("order").values
    figures: dict[str, Figure] = {
        "lowest share away from crossings [-]": float(flexible[away].min()),
        "part of the range above 80 % [%]": 100 * float((flexible[away] > 0.8).mean()),
        "share of the whole range's mean square [-]": float((own**2).sum() / (torque**2).sum()),
        "firing order over the next largest order, lowest [-]": float((own / other)[away].min()),
        "rigid crankshaft: lowest share [-]": float(rigid[away].min()),
        "DMF: part of the range above 80 % [%]": 100 * float((double[away] > 0.8).mean()),
    }
    short = away & (flexible <= 0.8)
    reason = _other_orders(model, speed, torque, short, rigid) if short.any() else ""
    told = {"smf": (flexible, "SMF"), "rigid": (rigid, "SMF, rigid crankshaft"), "dmf": (double, "DMF")}
    limit: dict[str, Any] = {"limit": 0.8, "limit_words": "criterion: above 80 % (SMF)"}
    panel = "firing order's share of the mean square, off its zero crossings"
    curves = {
        name: Curve(np.where(away, values, np.nan), "energy_share", words, panel, **(limit if name == "smf" else {}))
        for name, (values, words) in told.items()
    }
    curves |= _torques(torque, order)
    return Finding(
        not short.any(), "full load, top gear, orders 0.5–12", figures, reason, swept("A1", over_speed(speed), curves)
    )


def _torques(torque: xr.DataArray, order: float) -> dict[str, Curve]:
    """The orders of the input shaft's torque that matter."""
    panel = "SMF: orders of the torque in the input shaft"
    chosen = [order, *(n for n in (1.5, 4.5, 6.0) if n != order)]
    return {
        f"order_{n:g}".replace(".", "_"): Curve(
            torque.sel(order=n).values, "torque", f"order {n:g}", panel, "0-peak", scale="log"
        )
        for n in chosen
    }


def _other_orders(model: Model, speed: Array, torque: xr.DataArray, short: BoolArray, rigid: Array) -> str:
    """Why the firing order is short of its share at some speeds."""
    main = main_order(model)
    own, others = torque.sel(order=main), torque.drop_sel(order=main)
    strongest = others.order.values[np.argsort((others.values[short] ** 2).sum(axis=0))[::-1][:2]]
    place = int(np.flatnonzero(short)[(own.values / others.max("order").values)[short].argmin()])
    loudest = others.isel(speed=place)
    n = float(loudest.order.values[int(loudest.values.argmax())])
    frequency = n * speed[place] / (2 * np.pi)
    near = modes(model).frequency.values
    near = near[np.abs(near / frequency - 1).argmin()]
    meets = f"meets a mode at {near:.0f} Hz" if abs(near / frequency - 1) < MEETS else "meets no mode"
    return (
        f"from {speed[short][0] / RPM:.0f} rpm orders {strongest.min():g} and {strongest.max():g} show. There the line "
        f"isolates the firing order so well that {own.values[place]:.0f} Nm are left of it at "
        f"{speed[place] / RPM:.0f} rpm ({own.values.max():.0f} Nm at its resonance), while order {n:g} has "
        f"{frequency:.0f} Hz, {meets} and brings {float(loudest.max()):.0f} Nm. Orders that "
        f"are no multiples of {main:g} leave a flexible crankshaft alone: with a rigid one the cylinders cancel them, "
        f"and the share never falls below {100 * rigid[~crossing(model, speed)].min():.0f} %. In torque the claim "
        "stands: away from its crossings the firing order is the largest of all at every speed"
        if (own.values > others.max("order").values)[~crossing(model, speed)].all()
        else f"from {speed[short][0] / RPM:.0f} rpm orders {strongest.min():g} and {strongest.max():g} show, and order "
        f"{n:g} is larger than the firing order at {speed[place] / RPM:.0f} rpm: at {frequency:.0f} Hz it {meets}"
    )


@claim(
    "A15",
    "3.3",
    "The crankshaft's irregularity as a solid body is larger with a dual mass flywheel.",
    "cyclic irregularity of the crankshaft at idle under full load: dual mass above single mass flywheel",
    varies="engine speed over the operating range in steps of 25 rpm, at full load in top gear; judged at idle",
    leading="solid body, DMF over SMF [-]",
)
def a15(trucks: Trucks) -> Finding:
    speed = speeds(trucks.smf, STEP)
    single, double = (
        _irregularity(model, np.array([model.operation.idle]))[:, 0] for model in (trucks.smf, trucks.dmf)
    )
    figures: dict[str, Figure] = {
        "SMF, solid body and flywheel [%]": floats(100 * single),
        "DMF, solid body and primary [%]": floats(100 * double),
        "ratio [-]": floats(double / single),
        "solid body, DMF over SMF [-]": float(double[0] / single[0]),
    }
    curves = {
        name.lower(): Curve(_irregularity(model, speed)[0], "irregularity", f"{name}, crankshaft as a solid body")
        for name, model in (("SMF", trucks.smf), ("DMF", trucks.dmf))
    }
    condition = "idle, full load, top gear, peak-to-peak over mean, orders 0.5–12"
    return Finding(bool((double > single).all()), condition, figures, dataset=swept("A15", over_speed(speed), curves))


def _irregularity(model: Model, speed: Array) -> Array:
    """Irregularity (2, speeds) of the throws' mean motion and of the crankshaft landmark under full load."""
    angle = responded(model, speed, model.full_load(speed), orders=HALF_ORDERS).angle
    body = angle.sel(node=list(model.landmarks.throws)).mean("node")
    both = [body, angle.sel(node=model.landmarks.crankshaft)]
    return np.array([irregularity(motion).values for motion in both])
