"""The claim about centrifugal pendulums, linear, with the way that their paths leave them (G1)."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.optimize import brentq

from torsional.absorbers import CentrifugalPendulum
from torsional.absorbers.pendulum import flattening
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.harmonic import response
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import INPUT, at_input, floats, lowest, mean_torque, responded, span, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Curve, over_speed, swept
from torsional.studies.trucks import Trucks, joined, only, reached, replaced, without
from torsional.units import RPM

HEAVIEST = 64.0
"""How many times the pendulum's mass is tried."""
SMALL = (
    "small swings: under 60 % of the peak torque this pendulum of {mass:g} kg comes to the end of its path {where}; "
    "there the reduction is shown of heavier ones alone, whose swing stays within it ({heavier})"
)


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


def carrier_of(model: Model) -> str:
    """The body that carries the clutch, on the engine's side of it."""
    name = model.landmarks.clutch
    clutch: Any = model.components[name]
    near = reached(model.powertrain(), [model.landmarks.crankshaft], [name])
    return str(clutch.a if clutch.a in near else clutch.b)


def way(pendulum: CentrifugalPendulum) -> float:
    """Way along the path [m] to its cusp, ρ0/λ (a quarter turn of a circle), or to the stop before it."""
    bend = flattening(pendulum.path, pendulum.order)
    cusp = pendulum.curvature_radius * (1 / bend if bend else np.pi / 2)
    return min(cusp, pendulum.stop or np.inf)


def on(trucks: Trucks, concept: str, times: float = 1.0) -> Model:
    """A concept's truck with the pendulum on the body that carries the clutch, its mass and damping multiplied."""
    name = only(trucks.pendulum, CentrifugalPendulum)
    own: Any = trucks.pendulum.components[name]
    base = without(trucks.pendulum, name) if concept == "dmf" else trucks.models[concept]
    carrier = own.carrier if concept == "dmf" else carrier_of(base)
    heavier = {"mass": times * own.mass, "damping": times * own.damping}
    return joined(base, **{name: dataclasses.replace(own, carrier=carrier, count=1, **heavier)})


def share_of_way(model: Model, speed: Array) -> Array:
    """Swing of the pendulum along its path, linear, over the way that it has."""
    name = only(model, CentrifugalPendulum)
    pendulum: Any = model.components[name]
    angle = responded(model, speed).angle.isel(order=0)
    swing = np.abs((angle.sel(node=name) - angle.sel(node=pendulum.carrier)).values) * pendulum.distance
    return np.asarray(swing / way(pendulum))


def fitting(trucks: Trucks, concept: str, speed: Array) -> float:
    """How many times the pendulum's mass keeps its swing within its path at every speed; infinite beyond `HEAVIEST`."""

    def excess(log: float) -> float:
        return float(np.log(share_of_way(on(trucks, concept, float(np.exp(log))), speed).max()))

    if excess(0.0) < 0:
        return 1.0
    most = float(np.log(HEAVIEST))
    return float(np.exp(brentq(excess, 0.0, most, xtol=1e-3) + 2e-3)) if excess(most) < 0 else float("inf")


CONCEPTS = ("dmf", "smf", "psva", "tva", "planetary")


@claim(
    "G1",
    "2.2.4",
    "A centrifugal pendulum's tuning frequency is proportional to speed; it adds reduction to any concept.",
    "the order at which its carrier stands still is the same at every speed (to 1e-6); on each of five concepts the "
    "amplitude with it is below that without it, where its linear swing stays short of the end of its path, and with "
    "the mass with which it does so at every speed of the range; where the model's own mass does not, that is the "
    "condition",
    varies="engine speed over the operating range in steps of 10 rpm; with and without the pendulum, on single and "
    "dual mass flywheel, power split absorber, tuned absorber and planetary flywheel; its mass",
    leading="DMF: amplitude with over without, median [-]",
)
def g1(trucks: Trucks) -> Finding:
    speed, some = speeds(trucks.pendulum), np.linspace(*trucks.pendulum.operation.speed, 5)
    order = np.array([quiet_order(trucks.pendulum, float(v)) for v in some])
    ratio = {name: _ratio(on(trucks, name), speed) for name in CONCEPTS}
    share = {name: share_of_way(on(trucks, name), speed) for name in CONCEPTS}
    times = {name: fitting(trucks, name, speed) for name in CONCEPTS}
    fits = {name: _ratio(on(trucks, name, times[name]), speed) for name in CONCEPTS if np.isfinite(times[name])}
    mass = float(trucks.pendulum.components[only(trucks.pendulum, CentrifugalPendulum)].mass)  # type: ignore[attr-defined]
    figures: dict[str, Figure] = {
        "speeds [rpm]": floats(some / RPM),
        "order of rest [-]": floats(order),
        "tuning frequency [Hz]": floats(order * some / (2 * np.pi)),
    }
    for name, values in ratio.items():
        told = name.upper()
        figures[f"{told}: amplitude with over without, median [-]"] = float(np.median(values))
        figures[f"{told}: amplitude with over without, largest [-]"] = float(values.max())
        figures[f"{told}: largest swing over the way to the end of the path [-]"] = float(share[name].max())
        figures[f"{told}: mass whose swing fits at every speed [kg]"] = mass * times[name]
        figures[f"{told}: with that mass, largest [-]"] = float(fits[name].max()) if name in fits else np.nan
    constant = bool(np.abs(order / order[0] - 1).max() < 1e-6)
    less = all(bool((ratio[name][share[name] < 1] < 1).all()) for name in CONCEPTS)
    good = constant and less and set(fits) == set(CONCEPTS) and all(bool((v < 1).all()) for v in fits.values())
    data = swept("G1", over_speed(speed), _drawn(ratio, share), trucks.pendulum)
    proviso = _proviso(speed, share, times, mass) if good else ""
    reason = "" if good else f"no mass up to {HEAVIEST:g} times fits, or the amplitude is not lower at every speed"
    return Finding(good, f"{INPUT}; pendulum linear", figures, reason, data, proviso)


def _drawn(ratio: Mapping[str, Array], share: Mapping[str, Array]) -> dict[str, Curve]:
    """Amplitudes with over without the pendulum, and its swing over the way that it has."""
    told = (("", "gearbox input, amplitude with the pendulum over that without", "criterion: below one", ratio),)
    also = (("way_", "linear swing over the way to the end of the path", "end of the path", share),)
    curves = {}
    for prefix, panel, words, found in told + also:
        for name, values in found.items():
            limit = {"limit": 1.0, "limit_words": words} if name == "dmf" else {}
            look: dict[str, Any] = {"panel": panel, "scale": "log", **limit}
            curves[prefix + name] = Curve(values, "ratio", f"on the {name.upper()}", **look)
    return curves


def _proviso(speed: Array, share: Mapping[str, Array], times: Mapping[str, float], mass: float) -> str:
    """On which concepts, at how many speeds, the pendulum comes to the end of its path; nothing where on none."""
    beyond = {name: (values >= 1) for name, values in share.items() if (values >= 1).any()}
    if not beyond:
        return ""
    where = ", ".join(
        f"on the {name.upper()} at {span(speed[over])} ({share[name].max():.1f} times as far at most)"
        for name, over in beyond.items()
    )
    heavier = ", ".join(f"{mass * times[name]:.0f} kg on the {name.upper()}" for name in beyond)
    return SMALL.format(mass=mass, where=where, heavier=heavier)


def _ratio(model: Model, speed: Array) -> Array:
    """Amplitude with the pendulum over that without."""
    return at_input(model, speed) / at_input(without(model, only(model, CentrifugalPendulum)), speed)


def on_single(trucks: Trucks) -> Model:
    """The single mass flywheel truck with the same pendulum on its flywheel."""
    return on(trucks, "smf")
