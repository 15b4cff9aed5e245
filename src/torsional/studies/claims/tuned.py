"""Claims about a tuned absorber on the flange of a dual mass flywheel (D1 to D4)."""

from __future__ import annotations

from typing import Any

import numpy as np

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import (
    INPUT,
    at_input,
    falling,
    floats,
    lowest,
    rising,
    speeds,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Along, Curve, over_speed, swept
from torsional.studies.trucks import Trucks, replaced, without
from torsional.studies.tuned_absorber import (
    RING,
    SPRING,
    added,
    flywheel_alone,
    order_speeds,
    sized,
    tuning,
    tunings_above,
)
from torsional.units import RPM

INERTIAS = np.geomspace(0.02, 6.0, 24)
"""Absorber inertias of the sweeps [kgm²], all tuned to the same speed."""
MODES = "undamped modes about 60 % of the peak torque, top gear, as speeds at which the firing order meets them"


HALF = "half peak-to-peak"
AT_TUNING = "criterion: below one half at the tuning speed"
SECONDARY = (
    "on the secondary flywheel the added mode starts just below the tuning too, since clutch and gearbox hang on that "
    "flywheel; there it stays close, and the resonance above moves up. With an open clutch the added one lies above"
)


def ratio_at(model: Model, plain: Model, speed: float) -> float:
    """Amplitude of one model over that of another at a speed [rad/s]."""
    there = np.array([speed])
    return float((at_input(model, there) / at_input(plain, there))[0])


@claim(
    "D1",
    "2.2.3",
    "A tuned absorber reduces vibration near its tuning frequency and adds one resonance.",
    "one undamped mode more than without it; with the absorber undamped the gearbox input's amplitude is lowest at the "
    "tuning speed (to 0.1 %), and as shipped it is below half of that without the absorber",
    varies="engine speed over the operating range in steps of 10 rpm; with and without the absorber",
    leading="ratio to no absorber there, as shipped [-]",
)
def d1(trucks: Trucks) -> Finding:
    model, speed = trucks.tva, speeds(trucks.tva)
    plain, at = without(model, RING, SPRING), tuning(model)
    near = np.linspace(0.9, 1.1, 41) * at
    bare = replaced(model, SPRING, damping=0.0)
    found = lowest(lambda v: at_input(bare, v) / at_input(plain, v), near)
    there, best = (ratio_at(m, plain, at) for m in (model, bare))
    more = order_speeds(model).size - order_speeds(plain).size
    figures: dict[str, Figure] = {
        "modes more [-]": float(more),
        "tuning speed [rpm]": at / RPM,
        "lowest, absorber undamped [rpm]": found / RPM,
        "ratio to no absorber there, undamped [-]": best,
        "ratio to no absorber there, as shipped [-]": there,
        "added resonance [rpm]": added(model) / RPM,
        "ratio to no absorber at idle, as shipped [-]": ratio_at(model, plain, model.operation.idle),
    }
    panel, own, other = "gearbox input, acceleration", at_input(model, speed), at_input(plain, speed)
    curves = {
        "with_absorber": Curve(own, "acceleration", "with the absorber", panel, HALF, scale="log"),
        "without": Curve(other, "acceleration", "without", panel, HALF, scale="log"),
        "ratio": Curve(own / other, "ratio", "with over without", "ratio", limit=0.5, limit_words=AT_TUNING),
    }
    data = swept("D1", over_speed(speed), curves, model)
    good = more == 1 and abs(found / at - 1) < 1e-3 and there < 0.5
    return Finding(good, INPUT, figures, dataset=data)


@claim(
    "D2",
    "2.2.3, 6.1",
    "With the absorber on the intermediate flange the added resonance lies below the tuning frequency.",
    "for every absorber inertia of a sweep at the absorber's tuning; tunings of the operating range at which it lies "
    "above, whatever the inertia, are named; shown beside the absorber on the secondary flywheel",
    varies="inertia of the absorber from 0.02 to 6 kgm² in 24 steps, tuned alike; its tuning over the operating range; "
    "on the flange, on the secondary",
    leading="on the flange: highest added resonance over the tuning [-]",
)
def d2(trucks: Trucks) -> Finding:
    model, at = trucks.tva, tuning(trucks.tva)
    last: Any = model.components[model.landmarks.springs[-1]]
    own: Any = model.components[RING]
    flange = np.array([added(sized(model, J)) for J in INERTIAS])
    secondary = np.array([added(sized(model, J, last.a)) for J in INERTIAS])
    beside = [sized(model, own.inertia, carrier) for carrier in ("", last.a)]
    lone = [added(m, flywheel_alone) for m in beside]
    figures: dict[str, Figure] = {
        "inertias [kgm²]": floats(INERTIAS[[0, -1]]),
        "on the flange: added resonance [rpm]": floats(flange[[0, -1]] / RPM),
        "on the secondary: added resonance [rpm]": floats(secondary[[0, -1]] / RPM),
        "on the flange: highest added resonance over the tuning [-]": float(flange.max() / at),
        "shipped inertia, flange: resonances about the tuning [rpm]": _about(order_speeds(beside[0]), at),
        "shipped inertia, secondary: resonances about the tuning [rpm]": _about(order_speeds(beside[1]), at),
        "no absorber: resonances about the tuning [rpm]": _about(order_speeds(without(model, RING, SPRING)), at),
        "on the flange: added resonance above tunings of [rpm]": _ranges(tunings_above(model)),
        "on the secondary: added resonance above tunings of [rpm]": _ranges(tunings_above(model, last.a)),
        "open clutch, flange: added resonance [rpm]": lone[0] / RPM,
        "open clutch, secondary: added resonance [rpm]": lone[1] / RPM,
    }
    panel, limit = "order speed of the added resonance", {"limit": at, "limit_words": "tuning: criterion below it"}
    curves = {
        "flange": Curve(flange, "speed", "absorber on the flange", panel, **limit),  # type: ignore[arg-type]
        "secondary": Curve(secondary, "speed", "absorber on the secondary flywheel", panel),
    }
    data = swept("D2", SIZES, curves, model)
    below = bool((flange < at).all())
    reason = SECONDARY if (secondary < at).all() and lone[1] > at else ""
    return Finding(below, MODES, figures, reason if below else ABOVE, data, _tuned_where(model) if below else "")


ABOVE = (
    "at this tuning a mode of the line lies just below, and with the flange held still none between it and the tuning"
)


def _tuned_where(model: Model) -> str:
    """At which tunings the added resonance lies below them; nothing where it does at all of the operating range."""
    above = _ranges(tunings_above(model))
    if not above:
        return ""
    return (
        f"whatever the absorber's inertia, for tunings outside {' and '.join(above)} rpm only: there, from a mode of "
        "the line up to where it would lie with the flange held still, the added resonance is above the tuning"
    )


def _ranges(ends: list[tuple[float, float]]) -> tuple[str, ...]:
    return tuple(f"{low / RPM:.0f}–{high / RPM:.0f}" for low, high in ends)


def _about(resonances: Array, at: float) -> tuple[float, ...]:
    """The resonances next to a speed, one on either side [rpm]."""
    below, above = resonances[resonances < at], resonances[resonances > at]
    return floats(np.array([below.max(initial=0.0), above.min(initial=np.inf)]) / RPM)


@claim(
    "D3",
    "6.1",
    "A large separation of added resonance and tuning needs a much larger absorber.",
    "separation rises strictly with the absorber's inertia; to bring the resonance below 0.8 of idle the absorber must "
    "have more inertia than the whole dual mass flywheel without it",
    varies="inertia of the absorber from 0.02 to 6 kgm² in 24 steps, its tuning kept",
    leading="inertia that brings it below 0.8 of idle, over the whole flywheel's [-]",
)
def d3(trucks: Trucks) -> Finding:
    model, at = trucks.tva, tuning(trucks.tva)
    apart = np.array([1 - added(sized(model, J)) / at for J in INERTIAS])
    wanted = np.array([0.05, 0.1, 0.2, 1 - 0.8 * model.operation.idle / at])
    needed = np.exp(np.interp(wanted, apart, np.log(INERTIAS), right=np.inf))
    last: Any = model.components[model.landmarks.springs[-1]]
    first: Any = model.components[model.landmarks.springs[0]]
    bodies: list[Any] = [model.components[node] for node in (first.b, first.a, last.a)]
    whole, own = sum(body.inertia for body in bodies), model.components[RING].inertia  # type: ignore[attr-defined]
    figures: dict[str, Figure] = {
        "separations of the tuning speed [%]": floats(100 * wanted),
        "absorber inertia needed [kgm²]": floats(needed),
        "dual mass flywheel without absorber [kgm²]": whole,
        "shipped: separation [%]": 100 * (1 - added(model) / at),
        "inertia that brings it below 0.8 of idle, over the whole flywheel's [-]": float(needed[-1] / whole),
    }
    told = {"limit": float(wanted[-1]), "limit_words": "added resonance at 0.8 of idle"}
    panel = "added resonance below the tuning speed"
    curves = {
        "separation": Curve(apart, "relative_difference", "all tuned alike", panel, **told),  # type: ignore[arg-type]
        "shipped": _single(own, 1 - added(model) / at, f"as in the model, {own:.2g} kgm²", panel),
        "whole": _single(whole, float(np.interp(whole, INERTIAS, apart)), WHOLE, panel),
    }
    data = swept("D3", SIZES, curves, model)
    return Finding(rising(apart) and bool(needed[-1] > whole), MODES, figures, dataset=data)


SIZES = Along("inertia", INERTIAS, "inertia", "inertia of the absorber", "log")
WHOLE = "as much inertia as the whole dual mass flywheel"


def _single(inertia: float, value: float, words: str, panel: str) -> Curve:
    """A value told at the swept inertia that is nearest to one."""
    at = int(np.abs(np.log(INERTIAS / inertia)).argmin())
    values = np.where(np.arange(INERTIAS.size) == at, value, np.nan)
    return Curve(values, "relative_difference", words, panel, points=True)


@claim(
    "D4",
    "6.1",
    "More damping lowers the added resonance's excitation and spoils the reduction.",
    "over a sweep of the absorber's damping the largest amplitude around the added resonance falls strictly and the "
    "amplitude at the tuning speed rises strictly",
    varies="damping of the absorber from 0.5 to 16 Nms/rad in six steps",
    leading="amplitude at the tuning speed, most over least damping [-]",
)
def d4(trucks: Trucks) -> Finding:
    model, at = trucks.tva, tuning(trucks.tva)
    damping = np.array([0.5, 1.0, 2.0, 4.0, 8.0, 16.0])
    around = np.linspace(0.95 * added(model), 0.99 * at, 81)
    variants = [replaced(model, SPRING, damping=float(c)) for c in damping]
    peak = np.array([at_input(m, around).max() for m in variants])
    notch = np.array([at_input(m, np.array([at]))[0] for m in variants])
    plain = float(at_input(without(model, RING, SPRING), np.array([at]))[0])
    figures: dict[str, Figure] = {
        "absorber damping [Nms/rad]": floats(damping),
        "largest amplitude around the added resonance [rad/s²]": floats(peak),
        "amplitude at the tuning speed [rad/s²]": floats(notch),
        "without absorber at the tuning speed [rad/s²]": plain,
        "amplitude at the tuning speed, most over least damping [-]": float(notch[-1] / notch[0]),
    }
    panel, limit = (
        "gearbox input, acceleration",
        {"limit": plain, "limit_words": "at the tuning speed without absorber"},
    )
    curves = {
        "peak": Curve(peak, "acceleration", "largest around the added resonance", panel, HALF),
        "notch": Curve(notch, "acceleration", "at the tuning speed", panel, HALF, **limit),  # type: ignore[arg-type]
    }
    data = swept("D4", Along("damping", damping, "damping", "damping of the absorber", "log"), curves)
    return Finding(falling(peak) and rising(notch), INPUT, figures, dataset=data)
