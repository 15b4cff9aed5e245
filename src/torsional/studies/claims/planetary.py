"""Claims about the planetary dual mass flywheel (C4, C5)."""

from __future__ import annotations

from typing import Any

import numpy as np

from torsional.components import Coupling, PlanetSpin
from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.studies.answers import INPUT, at_input, curves, floats, main_order, responded, speeds
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.power_split import Parts, inertia_at
from torsional.studies.trucks import Trucks, only, replaced
from torsional.units import RPM

CRITICAL = 650 * RPM
"""A low engine speed at which a truck wants isolation [rad/s]."""


@claim(
    "C4",
    "2.2.5",
    "A planetary dual mass flywheel is a power split absorber of quotient 1; cancelling low takes very large planets.",
    "angles at the gearbox input agree to 1e-10 at quotient 1, all half orders; planet inertia that cancels at 650 rpm "
    "above the power split absorber's",
)
def c4(trucks: Trucks) -> Finding:
    p, n = Parts.of(trucks.psva), main_order(trucks.psva)
    worst = _largest_difference(trucks)
    alone, split = (p.planets_for(n * CRITICAL, quotient) for quotient in (1.0, p.r))
    same = p.planets_for(p.cancellation(), 1.0)
    figures: dict[str, Figure] = {
        "largest relative difference [-]": worst,
        "planet inertia for 650 rpm, planetary [kgm²]": alone,
        "planet inertia for 650 rpm, power split [kgm²]": split,
        "ratio [-]": alone / split,
        "planetary's for the shipped cancellation speed [kgm²]": same,
        "over the shipped power split absorber's [-]": same / p.J3,
    }
    condition = "orders 0.5–12, operating range, top gear; the same springs, damping and inertias"
    return Finding(worst < 1e-10 and alone > split, condition, figures)


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
    }
    data = curves("C5", speed, "ratio", larger=ratio[0], smaller=ratio[1], envelope=both, switched=switched)
    good = useful[2] > max(useful[:2]) and minima[0] < minima[1]
    return Finding(good, INPUT, figures, dataset=data)
