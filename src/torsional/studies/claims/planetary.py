"""Claims about the planetary dual mass flywheel (C4, C5)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from torsional.components import Coupling, PlanetSpin
from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import INPUT, at_input, by_idle, floats, main_order, responded, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.power_split import Parts, inertia_at
from torsional.studies.swept import Along, Curve, over_speed, swept
from torsional.studies.trucks import Trucks, only, replaced
from torsional.units import RPM

CRITICAL = 650 * RPM
"""A low engine speed at which a truck wants isolation [rad/s]."""
LOWER = np.arange(500.0, 1201.0, 25.0) * RPM
"""Cancellation speeds that are asked for [rad/s]."""


@claim(
    "C4",
    "2.2.5",
    "A planetary dual mass flywheel is a power split absorber of quotient 1; cancelling low takes very large planets.",
    "angles at the gearbox input agree to 1e-10 at quotient 1, all half orders; planet inertia that cancels at 650 rpm "
    "(13/12 of idle) above the power split absorber's",
    varies="cancellation speed asked for, 500 to 1200 rpm in steps of 25; quotient 1 and the power split absorber's",
    leading="ratio [-]",
)
def c4(trucks: Trucks) -> Finding:
    p, n = Parts.of(trucks.psva), main_order(trucks.psva)
    worst = _largest_difference(trucks)
    critical = by_idle(trucks.psva, CRITICAL)
    alone, split = (float(p.planets_for(n * critical, quotient)) for quotient in (1.0, p.r))
    low = f"planet inertia for {critical / RPM:.0f} rpm"
    same = float(p.planets_for(p.cancellation(), 1.0))
    figures: dict[str, Figure] = {
        "largest relative difference [-]": worst,
        f"{low}, planetary [kgm²]": alone,
        f"{low}, power split [kgm²]": split,
        "ratio [-]": alone / split,
        "power split absorber's planets as in the model [kgm²]": p.J3,
        "planetary's over those in the model [-]": alone / p.J3,
        "planetary's for the shipped cancellation speed [kgm²]": same,
        "over the shipped power split absorber's [-]": same / p.J3,
    }
    condition = "orders 0.5–12, operating range, top gear; the same springs, damping and inertias"
    return Finding(
        worst < 1e-10 and alone > split, condition, figures, dataset=_asked(p, n, by_idle(trucks.psva, LOWER))
    )


def _positive(values: Array) -> Array:
    """What can be built."""
    return np.where(values > 0, values, np.nan)


def _asked(p: Parts, order: float, speed: Array) -> xr.Dataset:
    """Planet inertia needed over the cancellation speed asked for."""
    panel = "inertia of all planets needed"
    told = {"planetary": (1.0, "planetary DMF, quotient 1"), "power_split": (p.r, f"power split, quotient {p.r:.3g}")}
    curves = {
        name: Curve(_positive(p.planets_for(order * speed, quotient)), "inertia", words, panel)
        for name, (quotient, words) in told.items()
    }
    own = np.where(np.arange(speed.size) == np.abs(speed - p.cancellation() / order).argmin(), p.J3, np.nan)
    curves["shipped"] = Curve(own, "inertia", "power split as in the model", panel, points=True)
    return swept("C4", Along("speed", speed, "speed", "cancellation speed asked for"), curves)


def _largest_difference(trucks: Trucks) -> float:
    """Largest relative difference of the two models' angles at quotient 1 at the gearbox input."""
    angles = [responded(m, speeds(trucks.psva), orders=HALF_ORDERS) for m in at_quotient_one(trucks)]
    first, second = (a.angle.sel(node=trucks.psva.landmarks.input).values for a in angles)
    return float(np.max(np.abs(first - second) / np.abs(first)))


def at_quotient_one(trucks: Trucks) -> tuple[Model, Model]:
    """The power split absorber with its quotient set to 1, and the planetary flywheel with the same numbers."""
    p, psva, planetary = Parts.of(trucks.psva), trucks.psva, trucks.planetary
    spin: Any = planetary.components[only(planetary, PlanetSpin)]
    springs: Any = psva.components[p.springs]
    assert isinstance(springs, Coupling)
    same = replaced(planetary, spin.a, inertia=inertia_at(psva, p.nodes[0]))
    same = replaced(same, spin.b, inertia=p.J2 + p.J4)
    same = replaced(same, only(planetary, PlanetSpin), inertia=p.J3, ratio=p.g, switch=None)
    same = replaced(same, planetary.landmarks.springs[0], law=springs.law, damping=springs.damping)
    return replaced(psva, p.gear, ratio=1.0), same


@claim(
    "C5",
    "2.2.5",
    "Planets whose inertia can be switched give two cancellation speeds and a wider useful range.",
    "amplitude below half of the plain dual mass flywheel's over a larger part of the range than with either inertia "
    "alone, and two minima of the ratio",
    varies="engine speed over the operating range in steps of 10 rpm; each planet inertia alone, the better of both",
    leading="useful part of the range: better of both over the larger part alone [-]",
)
def c5(trucks: Trucks) -> Finding:
    model, speed = trucks.planetary, speeds(trucks.planetary)
    name = only(model, PlanetSpin)
    spin: Any = model.components[name]
    other = spin.switch.inertia if spin.switch else 0.5 * spin.inertia
    plain = at_input(replaced(model, name, inertia=0.0, switch=None), speed)
    ratio = [at_input(replaced(model, name, inertia=J, switch=None), speed) / plain for J in (spin.inertia, other)]
    both = np.minimum(*ratio)
    switched = at_input(model, speed) / plain
    useful = [100 * float((r < 0.5).mean()) for r in (*ratio, both, switched)]
    minima = tuple(float(speed[int(r.argmin())] / RPM) for r in ratio)
    figures: dict[str, Figure] = {
        "planet inertias [kgm²]": (spin.inertia, other),
        "lowest against the plain DMF at [rpm]": minima,
        "lowest ratio to the plain DMF [-]": floats([r.min() for r in ratio]),
        "useful part of the range: larger alone [%]": useful[0],
        "useful part of the range: smaller alone [%]": useful[1],
        "useful part of the range: better of both [%]": useful[2],
        "useful part of the range: switched as shipped [%]": useful[3],
        "useful part of the range: better of both over the larger part alone [-]": useful[2] / (max(useful[:2]) or 1.0),
    }
    panel, limit = "amplitude over that of the plain DMF", {"limit": 0.5, "limit_words": "useful: below one half"}
    told = {"larger": (ratio[0], "larger inertia alone"), "smaller": (ratio[1], "smaller inertia alone")}
    told |= {"switched": (switched, "switched as in the model")}
    curves = {name: Curve(v, "ratio", words, panel, scale="log") for name, (v, words) in told.items()}
    curves["switched"] = Curve(switched, "ratio", told["switched"][1], panel, scale="log", **limit)  # type: ignore[arg-type]
    data = swept("C5", over_speed(speed), curves, model)
    good = useful[2] > max(useful[:2]) and minima[0] < minima[1]
    return Finding(good, INPUT, figures, dataset=data)
