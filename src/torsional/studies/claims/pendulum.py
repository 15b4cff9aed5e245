"""The claim about centrifugal pendulums, as far as small amplitudes go (G1)."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from torsional.absorbers import CentrifugalPendulum
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.harmonic import response
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import INPUT, at_input, floats, lowest, mean_torque, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Curve, over_speed, swept
from torsional.studies.trucks import Trucks, joined, only, replaced, without
from torsional.units import RPM


def quiet_order(model: Model, speed: float) -> float:
    """The engine order at which the pendulum's carrier moves least at a mean ``speed`` [rad/s], pendulum undamped."""
    name = only(model, CentrifugalPendulum)
    pendulum: Any = model.components[name]
    bare = replaced(model, name, damping=0.0)
    system, _ = at_operating_point(bare, mean_torque(bare))
    carrier, push = system.node_index(pendulum.carrier), bare.landmarks.crankshaft

    def motion(order: Array) -> Array:
        q, _ = response(system, order * speed, np.full(order.size, speed), [push], np.ones((order.size, 1), complex))
        return np.asarray(np.abs(q.reshape(order.size, -1) @ system.T[carrier]))

    n = pendulum.order
    return lowest(motion, np.linspace(0.8 * n, 1.2 * n, 41))


@claim(
    "G1",
    "2.2.4",
    "A centrifugal pendulum's tuning frequency is proportional to speed; it adds reduction to any concept.",
    "the order at which its carrier stands still is the same at every speed (to 1e-6); the amplitude with it is below "
    "that without it at every speed of the range, on the dual and on the single mass flywheel (linear)",
    varies="engine speed over the operating range in steps of 10 rpm; with and without the pendulum",
    leading="DMF: amplitude with over without, median [-]",
)
def g1(trucks: Trucks) -> Finding:
    speed, some = speeds(trucks.pendulum), np.linspace(*trucks.pendulum.operation.speed, 5)
    order = np.array([quiet_order(trucks.pendulum, float(v)) for v in some])
    ratio = {"dmf": _ratio(trucks.pendulum, speed), "smf": _ratio(on_single(trucks), speed)}
    figures: dict[str, Figure] = {
        "speeds [rpm]": floats(some / RPM),
        "order of rest [-]": floats(order),
        "tuning frequency [Hz]": floats(order * some / (2 * np.pi)),
    }
    for name, values in ratio.items():
        figures[f"{name.upper()}: amplitude with over without, median [-]"] = float(np.median(values))
        figures[f"{name.upper()}: amplitude with over without, largest [-]"] = float(values.max())
    constant = bool(np.abs(order / order[0] - 1).max() < 1e-6)
    good = constant and all(bool((values < 1).all()) for values in ratio.values())
    panel = "gearbox input, amplitude with the pendulum over that without"
    limit = {"limit": 1.0, "limit_words": "criterion: below one"}
    curves = {
        name: Curve(values, "ratio", f"on the {name.upper()}", panel, **(limit if name == "dmf" else {}))  # type: ignore[arg-type]
        for name, values in ratio.items()
    }
    return Finding(good, INPUT, figures, dataset=swept("G1", over_speed(speed), curves, trucks.pendulum))


def _ratio(model: Model, speed: Array) -> Array:
    """Amplitude with the pendulum over that without."""
    return at_input(model, speed) / at_input(without(model, only(model, CentrifugalPendulum)), speed)


def on_single(trucks: Trucks) -> Model:
    """The single mass flywheel truck with the same pendulum on its flywheel."""
    name = only(trucks.pendulum, CentrifugalPendulum)
    pendulum: Any = trucks.pendulum.components[name]
    return joined(trucks.smf, **{name: dataclasses.replace(pendulum, carrier=trucks.smf.landmarks.crankshaft)})
