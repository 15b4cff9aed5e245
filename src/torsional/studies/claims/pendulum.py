"""The claim about centrifugal pendulums, linear and in time, with the way that their paths leave them (G1)."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.optimize import brentq

from torsional.absorbers import CentrifugalPendulum
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.harmonic import response
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import INPUT, at_input, floats, lowest, mean_torque, span, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Curve, over_speed, swept
from torsional.studies.swinging import SHORT, Swing, share_of_way, swings
from torsional.studies.trucks import Trucks, joined, only, reached, replaced, without
from torsional.units import RPM

HEAVIEST = 64.0
"""How many times the pendulum's mass is tried."""
SMALL = (
    "small swings: under 60 % of the peak torque the linear swing of this pendulum of {mass:g} kg reaches the end "
    "of its path {where}; there the linear reduction is that of heavier ones alone, whose swing stays within it "
    "({heavier})"
)
ALIKE = 0.05
"""How far ratios of amplitudes, linear and in time, may be apart where swings are `SHORT`."""
SHARES = {"dmf": (0.3, SHORT, 0.9, np.inf), "smf": (SHORT, np.inf), "smf_heavy": (SHORT, 1.0)}
"""Linear swings over the way that are asked in time; other concepts: `SHORT` alone."""
FIELDS = {
    "share": "linear swing over the way",
    "reached": "swing over the way",
    "linear": "linear amplitude with over without",
    "timed": "amplitude with over without",
    "whole": "all orders together, half peak-to-peak, with over without",
}
HEAVY, IN_TIME = "smf_heavy", "in time, exact path"


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


def on(trucks: Trucks, concept: str, times: float = 1.0) -> Model:
    """A concept's truck with the pendulum on the body that carries the clutch, its mass and damping multiplied."""
    name = only(trucks.pendulum, CentrifugalPendulum)
    own: Any = trucks.pendulum.components[name]
    base = without(trucks.pendulum, name) if concept == "dmf" else trucks.models[concept]
    carrier = own.carrier if concept == "dmf" else carrier_of(base)
    heavier = {"mass": times * own.mass, "damping": times * own.damping}
    return joined(base, **{name: dataclasses.replace(own, carrier=carrier, count=1, **heavier)})


def fitting(trucks: Trucks, concept: str, speed: Array) -> float:
    """How many times the pendulum's mass keeps its swing within its path at every speed; infinite beyond `HEAVIEST`."""

    def excess(log: float) -> float:
        return float(np.log(share_of_way(on(trucks, concept, float(np.exp(log))), speed).max()))

    if excess(0.0) < 0:
        return 1.0
    most = float(np.log(HEAVIEST))
    return float(np.exp(brentq(excess, 0.0, most, xtol=1e-3) + 2e-3)) if excess(most) < 0 else float("inf")


def places(speed: Array, share: Array, shares: Sequence[float]) -> Array:
    """Speeds of the largest linear swing up to some shares of the way; infinite: of the largest, and of the last one
    beyond the way, if there is any."""
    asked = [int(np.where(share <= most, share, -1.0).argmax()) for most in shares if (share <= most).any()]
    if np.isinf(max(shares)) and (share >= 1).any():
        asked.append(int(np.flatnonzero(share >= 1)[-1]))
    return np.asarray(speed[sorted(set(asked))])


Timed = Mapping[str, Sequence[Swing]]


def in_time(trucks: Trucks, speed: Array, share: Mapping[str, Array], heavy: Model | None) -> Timed:
    """Runs in time on every concept, and on the single mass flywheel with the ``heavy`` pendulum."""
    models = {name: on(trucks, name) for name in CONCEPTS} | ({HEAVY: heavy} if heavy else {})
    at = {name: places(speed, share[name], SHARES.get(name, (SHORT,))) for name in models}
    return {name: list(swings(models[name], some)) for name, some in at.items() if some.size}


CONCEPTS = ("dmf", "smf", "psva", "tva", "planetary")


@claim(
    "G1",
    "2.2.4",
    "A centrifugal pendulum's tuning frequency is proportional to speed; it adds reduction to any concept.",
    "the order at which its carrier stands still is the same at every speed (to 1e-6); on each of five concepts the "
    "amplitude with it is below that without it, where its linear swing stays short of the end of its path, and with "
    "the mass with which it does so at every speed of the range; where the model's own mass does not, that is the "
    "condition. By time steps with the pendulum's exact path the amplitude with it is below that without it at such "
    "points, and, where the linear swing takes up to 60 % of the way, within 0.05 of the linear ratio",
    varies="engine speed over the operating range in steps of 10 rpm; with and without the pendulum, on single and "
    "dual mass flywheel, power split absorber, tuned absorber and planetary flywheel; its mass; linear, and in time "
    "where the swing is large",
    leading="DMF: amplitude with over without, median [-]",
    trucks=30,
)
def g1(trucks: Trucks) -> Finding:
    speed = speeds(trucks.pendulum)
    ratio = {name: _ratio(on(trucks, name), speed) for name in CONCEPTS}
    share = {name: share_of_way(on(trucks, name), speed) for name in CONCEPTS}
    times = {name: fitting(trucks, name, speed) for name in CONCEPTS}
    fits = {name: _ratio(on(trucks, name, times[name]), speed) for name in CONCEPTS if np.isfinite(times[name])}
    mass = float(trucks.pendulum.components[only(trucks.pendulum, CentrifugalPendulum)].mass)  # type: ignore[attr-defined]
    figures, constant = _at_rest(trucks)
    for name, values in ratio.items():
        told = name.upper()
        figures[f"{told}: amplitude with over without, median [-]"] = float(np.median(values))
        figures[f"{told}: amplitude with over without, largest [-]"] = float(values.max())
        figures[f"{told}: largest swing over the way to the end of the path [-]"] = float(share[name].max())
        figures[f"{told}: mass whose swing fits at every speed [kg]"] = mass * times[name]
        figures[f"{told}: with that mass, largest [-]"] = float(fits[name].max()) if name in fits else np.nan
    less = all(bool((ratio[name][share[name] < 1] < 1).all()) for name in CONCEPTS)
    good = constant and less and set(fits) == set(CONCEPTS) and all(bool((v < 1).all()) for v in fits.values())
    heavy = on(trucks, "smf", times["smf"]) if 1 < times["smf"] < np.inf else None
    if heavy:
        ratio, share = ratio | {HEAVY: fits["smf"]}, share | {HEAVY: share_of_way(heavy, speed)}
    timed, words = in_time(trucks, speed, share, heavy), named(mass * times["smf"])
    curves = _drawn(words, {"": ratio, "way_": share}) | _points(words, speed, timed)
    data = swept("G1", over_speed(speed), curves, trucks.pendulum)
    alike = _as_said(timed)
    reason = _near(words, timed) if good and alike else _amiss(good, timed)
    proviso = _proviso(speed, share, times, mass) + _beyond(words, timed) if good and alike else ""
    figures |= _told(words, timed)
    return Finding(good and alike, f"{INPUT}; pendulum linear, and in time where told", figures, reason, data, proviso)


def _at_rest(trucks: Trucks) -> tuple[dict[str, Figure], bool]:
    """The order at which the carrier stands still over speed, and whether it is the same at every one."""
    some = np.linspace(*trucks.pendulum.operation.speed, 5)
    order = np.array([quiet_order(trucks.pendulum, float(v)) for v in some])
    figures: dict[str, Figure] = {
        "speeds [rpm]": floats(some / RPM),
        "order of rest [-]": floats(order),
        "tuning frequency [Hz]": floats(order * some / (2 * np.pi)),
    }
    return figures, bool(np.abs(order / order[0] - 1).max() < 1e-6)


def named(heavy: float) -> dict[str, str]:
    """What concepts are called, the single mass flywheel with a ``heavy`` pendulum [kg] too."""
    return {name: f"on the {name.upper()}" for name in CONCEPTS} | {HEAVY: f"on the SMF with {heavy:.0f} kg"}


def _amiss(linear: bool, timed: Timed) -> str:
    """What stands against the claim."""
    if not linear:
        return f"no mass up to {HEAVIEST:g} times fits, or the amplitude is not lower at every speed"
    most = max(p.timed for p in _known(timed) if p.share < 1)
    return (
        f"in time, on the exact path, the amplitude with over without is up to {_apart(timed):.2f} off the linear one "
        f"where the linear swing takes up to {100 * SHORT:.0f} % of the way, and {most:.2f} at most short of its end"
    )


PANELS = {
    "": "gearbox input, amplitude with the pendulum over that without (lines: linear)",
    "way_": "swing over the way to the end (lines: linear)",
    "whole_": "gearbox input, all orders together, with over without (in time)",
}
LIMITS = {"": "criterion: below one", "way_": "end of the path", "whole_": "as without"}


def _drawn(words: Mapping[str, str], found: Mapping[str, Mapping[str, Array]]) -> dict[str, Curve]:
    """Amplitudes with over without the pendulum, and its swing over the way that it has."""
    return {
        prefix + name: Curve(values, "ratio", words[name], PANELS[prefix], scale="log", **_limit(prefix, name))
        for prefix, curves in found.items()
        for name, values in curves.items()
    }


def _points(words: Mapping[str, str], speed: Array, timed: Timed) -> dict[str, Curve]:
    """What runs in time tell, at the speeds that were asked."""
    curves = dict[str, Curve]()
    for prefix, field in (("", "timed"), ("way_", "reached"), ("whole_", "whole")):
        for name, each in timed.items():
            values = np.full(speed.size, np.nan)
            values[np.searchsorted(speed, [p.speed for p in each])] = [getattr(p, field) for p in each]
            told = {"words": words[name], **_limit(prefix, name)} if prefix == "whole_" else {"words": IN_TIME}
            look: dict[str, Any] = {"points": True, "scale": "log", "like": f"{prefix}{name}" * (prefix != "whole_")}
            curves[f"{prefix}{name}_timed"] = Curve(values, "ratio", panel=PANELS[prefix], **told, **look)
    return curves


def _limit(prefix: str, name: str) -> dict[str, Any]:
    return {"limit": 1.0, "limit_words": LIMITS[prefix]} if name == "dmf" else {}


def _proviso(speed: Array, share: Mapping[str, Array], times: Mapping[str, float], mass: float) -> str:
    """On which concepts, at how many speeds, the pendulum comes to the end of its path; nothing where on none."""
    beyond = {name: (share[name] >= 1) for name in CONCEPTS if (share[name] >= 1).any()}
    if not beyond:
        return ""
    where = ", ".join(
        f"on the {name.upper()} at {span(speed[over])} ({share[name].max():.1f} times as far at most)"
        for name, over in beyond.items()
    )
    heavier = ", ".join(f"{mass * times[name]:.0f} kg on the {name.upper()}" for name in beyond)
    return SMALL.format(mass=mass, where=where, heavier=heavier)


def _known(timed: Timed) -> list[Swing]:
    """All points but those at which the pendulum is driven through its stop."""
    return [p for each in timed.values() for p in each if np.isfinite(p.timed)]


def _as_said(timed: Timed) -> bool:
    """Whether the amplitude is lower in time too, and near the linear one while the swing is short."""
    return all(p.timed < 1 for p in _known(timed) if p.share < 1) and _apart(timed) < ALIKE


def _apart(timed: Timed) -> float:
    """Largest difference between the ratio in time and the linear one while the linear swing is short."""
    return max((abs(p.timed - p.linear) for p in _known(timed) if p.share <= SHORT), default=0.0)


def _told(words: Mapping[str, str], timed: Timed) -> dict[str, Figure]:
    """Figures of the runs in time, one value a point."""
    points = [point for each in timed.values() for point in each]
    where = tuple(f"{words[name]}, {p.speed / RPM:.0f} rpm" for name, each in timed.items() for p in each)
    found: dict[str, Figure] = {"in time: asked": where}
    for field, told in FIELDS.items():
        found[f"in time: {told} [-]"] = tuple(getattr(p, field) for p in points)
    return found | {f"in time: largest difference from linear, up to {SHORT:g} of the way [-]": _apart(timed)}


def _listed(words: Mapping[str, str], timed: Timed, low: float, high: float) -> str:
    """The ratios at points whose linear swing lies between two shares of the way, in words."""
    found = [(name, p) for name, each in timed.items() for p in each if low <= p.share < high]
    return ", ".join(
        (f"{p.timed:.2f} " if np.isfinite(p.timed) else "unknown, as it is driven through its stop, ")
        + f"{words[name]} at {p.speed / RPM:.0f} rpm (linear {p.linear:.2f})"
        for name, p in found
    )


def _near(words: Mapping[str, str], timed: Timed) -> str:
    """What the linear ratio is worth towards the end of the path."""
    found = _listed(words, timed, SHORT, 1.0)
    return f"towards the end of its path the amplitude in time with over without is {found}" if found else ""


def _beyond(words: Mapping[str, str], timed: Timed) -> str:
    """What becomes of pendulums that would have to swing beyond their path."""
    known = [p for p in _known(timed) if p.share >= 1]
    found = _listed(words, timed, 1.0, np.inf)
    if not known:
        return f"; in time the amplitude with over without is {found}" if found else ""
    reached, whole = max(p.reached for p in known), max(p.whole for p in known)
    return (
        f"; in time it swings over {reached:.2f} of its way there at most, and the amplitude with over without is "
        f"{found}; that of all orders together, half peak-to-peak, is {whole:.1f} at most"
    )


def _ratio(model: Model, speed: Array) -> Array:
    """Amplitude with the pendulum over that without."""
    return at_input(model, speed) / at_input(without(model, only(model, CentrifugalPendulum)), speed)


def on_single(trucks: Trucks) -> Model:
    """The single mass flywheel truck with the same pendulum on its flywheel."""
    return on(trucks, "smf")
