"""Absorber and clutch chosen together: what may be chosen, within which limits, and the choice that shakes least.

Springs keep the way to their stops, so that a stiffer one carries more; the clutch damper's twist under the peak of the
full-load curve stays below twice the shipped one.  Numbers to be chosen are factors on those of the truck.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import differential_evolution
from scipy.stats.qmc import Sobol

from torsional.components import Coupling, Inertia, PlanetSpin, Superposition
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.down_speeding import Bench, half_swing, moved, travels
from torsional.studies.trucks import Trucks, hinged, only, reached, replaced
from torsional.units import RPM

SPRINGS = (0.3, 4.0)
"""Stiffness of the absorber's springs; what is too soft meets its stop."""
CLUTCH = (0.5, 2.0)
"""Stiffness of the clutch damper, from twice the twist to half of it; the softest rises with the peak torque."""
FRICTION = (0.5, 2.0)
"""Damping of the clutch damper: from a light washer to a strong one."""
TUNING = (0.25, 4.0)
"""Stiffness of a tuned absorber's spring: from half the tuning speed to twice of it."""
PLANETS = (0.5, 2.0)
"""Spin inertia of the planets, which their circle has to hold."""

COARSE = 25 * RPM
"""Step of speeds in a search [rad/s]."""
SEARCHED = (0.0, 1.0)
"""Shares of full load in a search."""
POPULATION, GENERATIONS, FEWER, SEED = 8, 30, 10, 1
HELD = 2e4
"""Acceleration [rad/s²] that a spring costs which would be twisted to twice its way: far more than softness gains."""


@dataclass(frozen=True)
class Knob:
    """A number to be chosen: a factor between ``low`` and ``high`` on some ``places`` (component, field)."""

    name: str
    places: tuple[tuple[str, str], ...]
    low: float
    high: float


@dataclass(frozen=True)
class Concept:
    """A truck with one absorber: what may be chosen, which ``bodies`` it has and which of them have grown together with
    the installation space (``grown``); ``along`` is scaled with them so that their tuning stays."""

    name: str
    model: Model
    knobs: tuple[Knob, ...]
    bodies: tuple[str, ...]
    grown: tuple[str, ...]
    along: tuple[tuple[str, str], ...] = ()

    @property
    def inertia(self) -> float:
        """All its bodies [kgm²], planets by their spin."""
        return _sum(self.model, self.bodies)

    def sized(self, inertia: float) -> Concept:
        """The same concept with another inertia in all [kgm²], taken up by the bodies that grow; these must stay."""
        grown = _sum(self.model, self.grown)
        factor = (inertia - self.inertia + grown) / grown
        places = [*((name, "inertia") for name in self.grown), *self.along]
        return dataclasses.replace(self, model=turned(self.model, dict.fromkeys(places, factor)))

    @property
    def smallest(self) -> float:
        """The inertia [kgm²] left when what grows is at a third of its own."""
        return self.inertia - 2 / 3 * _sum(self.model, self.grown)

    def moved(self, model: Model) -> Concept:
        """The same concept on another truck of the same parts."""
        return dataclasses.replace(self, model=model)


def concepts(trucks: Trucks) -> dict[str, Concept]:
    """Single mass flywheel, dual mass flywheel, power split absorber and flange absorber, by their short names."""
    found = {
        "SMF": _concept("SMF", trucks.smf),
        "DMF": _concept("DMF", trucks.dmf),
    }
    psva, planets = trucks.psva, only(trucks.psva, PlanetSpin)
    behind = (*_bodies(psva, _ends(psva, psva.landmarks.springs[0])[1]), *_bodies(psva, _carrier(psva)), planets)
    found["PSVA"] = _concept("PSVA", psva, (Knob("planets", ((planets, "inertia"),), *PLANETS),), behind)
    tuned = ("tva_spring", "stiffness"), ("tva_spring", "damping")
    tuning = Knob("tuning", (tuned[0],), *TUNING)
    found["DMF with TVA"] = _concept(
        "DMF with TVA", trucks.tva, (tuning,), (*_bodies(trucks.tva, _carrier(trucks.tva)), "tva"), tuned
    )
    return found


def _concept(
    name: str,
    model: Model,
    own: tuple[Knob, ...] = (),
    grown: tuple[str, ...] = (),
    along: tuple[tuple[str, str], ...] = (),
) -> Concept:
    marks = model.landmarks
    springs = tuple((spring, "stiffness") for spring in marks.springs)
    knobs = (
        *((Knob("springs", springs, *SPRINGS),) if springs else ()),
        *own,
        Knob("clutch stiffness", ((marks.clutch, "stiffness"),), *CLUTCH),
        Knob("clutch damping", ((marks.clutch, "damping"),), *FRICTION),
    )
    ends = [_ends(model, spring) for spring in marks.springs]
    bodies = [body for pair in ends for node in pair for body in _bodies(model, node)]
    growing = grown or _bodies(model, _carrier(model))
    return Concept(name, model, knobs, tuple(dict.fromkeys((*bodies, *growing))), growing, along)


def _ends(model: Model, name: str) -> tuple[str, str]:
    """The nodes of a coupling, the engine's side first."""
    part: Any = model.components[name]
    front = reached(model.powertrain(), model.landmarks.throws, [name, f"{name}_friction", *_planets(model)])
    return (part.a, part.b) if part.a in front and part.b not in front else (part.b, part.a)


def _planets(model: Model) -> list[str]:
    """Trains beside the springs, which join both ends too."""
    return [name for name, part in model.components.items() if isinstance(part, (PlanetSpin, Superposition))]


def _carrier(model: Model) -> str:
    """The node that carries the clutch."""
    part: Any = model.components[model.landmarks.clutch]
    behind = reached(model.powertrain(), [model.landmarks.input], [model.landmarks.clutch])
    return str(part.b if part.a in behind else part.a)


def _bodies(model: Model, node: str) -> tuple[str, ...]:
    """Names of the inertias on a node."""
    parts = model.components.items()
    return tuple(name for name, part in parts if isinstance(part, Inertia) and (part.node or name) == node)


def _sum(model: Model, names: tuple[str, ...]) -> float:
    parts: list[Any] = [model.components[name] for name in names]
    return float(sum(part.inertia for part in parts))


def turned(model: Model, factors: Mapping[tuple[str, str], float]) -> Model:
    """A copy with numbers (component, field) times factors; a law's torque is scaled, its way to the stops stays."""
    for (name, field), factor in factors.items():
        part: Any = model.components.get(name)
        if field == "stiffness" and isinstance(part, Coupling):
            model = replaced(model, name, law=_scaled(part.law, factor))
        else:
            changed: dict[str, Any] = {field: float(getattr(part, field, 0.0) * factor)}
            model = replaced(model, name, **changed)
    return model


def _scaled(law: Any, factor: float) -> Hinges:
    changes = tuple(float(factor * change) for change in law.changes)
    scaled: Hinges = dataclasses.replace(law, stiffness=float(factor * law.stiffness), changes=changes)
    return scaled


def one_stage(model: Model, name: str, stop: bool = True) -> Model:
    """A copy whose coupling has one stage up to where its stop is, or, without one, to the peak of full load.

    ``stop``: whether its stop stays.  Raises ModelError for a law that is not piecewise linear.
    """
    law: Any = hinged(model, name)
    way = max(law.stops, default=0.0) or float(law.angle(model.full_load_peak()))
    k = float(law.torque(way) / way)
    hard = float(law.tangent(way * (1 + 1e-9))) if stop and law.stops else 0.0
    return replaced(model, name, law=Hinges.staged([(k * way, k)], stop_stiffness=hard))


@dataclass(frozen=True)
class Match:
    """A matched truck, down-speeded; the ``factors`` chosen by knob; the last ``population`` of the search."""

    model: Model
    factors: Mapping[str, float]
    population: Array


def matched(concept: Concept, by: float = 0.0, cruise: float = 0.0, near: Match | None = None) -> Match:
    """The truck down-speeded ``by`` [rad/s] with all that may be chosen chosen so that its worst is least.

    Searched is the worst firing-order acceleration at the gearbox input over speeds, loads and gears, while no spring
    of the absorber meets its stop: differential evolution (Storn and Price, 1997) with a fixed seed, on a logarithmic
    scale between the limits; from the population of a match ``near`` by it needs fewer generations.
    """
    marks, plain = concept.model.landmarks, concept.model
    for name in (*marks.springs, marks.clutch):
        plain = one_stage(plain, name)
    truck = bare = moved(plain, by, cruise)
    knobs = _limited(concept.knobs, plain, truck.full_load_peak() / plain.full_load_peak())
    for name in marks.springs:
        bare = one_stage(bare, name, stop=False)
    cost = _cost(Bench(bare, COARSE, SEARCHED, stops=travels(truck), gears=_some(bare.gear_names)), knobs)
    found = _evolved(cost, len(knobs), near)
    factors = {spot: float(value[0]) for spot, value in _factors(knobs, found.x[None]).items()}
    chosen = {knob.name: factors[knob.places[0]] for knob in knobs}
    return Match(turned(truck, factors), chosen, np.asarray(found.population))


def _some(gears: tuple[str, ...]) -> tuple[str, ...]:
    """Every second gear from the top, and the lowest: what is worst changes little from gear to gear."""
    return tuple(gear for place, gear in enumerate(gears) if place == 0 or (len(gears) - 1 - place) % 2 == 0)


def _cost(bench: Bench, knobs: tuple[Knob, ...]) -> Callable[[Array], Array]:
    def cost(place: Array) -> Array:
        found, reach = bench.accelerations(_factors(knobs, place.T))
        return np.asarray(half_swing(found, bench.orders).max(axis=(1, 2, 3)) + HELD * np.maximum(reach - 1.0, 0.0))

    return cost


def _mixed(population: Array) -> Array:
    """Half of a population, the best first, and as many designs spread evenly over the box."""
    half = len(population) // 2
    fresh = Sobol(population.shape[1], scramble=False).random(2 ** int(np.ceil(np.log2(half))))
    return np.concatenate([population[:half], fresh[:half]])


def _evolved(cost: Callable[[Array], Array], dimensions: int, near: Match | None) -> Any:
    start, generations = ("sobol", GENERATIONS) if near is None else (_mixed(near.population), FEWER)
    return differential_evolution(
        cost,
        [(0.0, 1.0)] * dimensions,
        init=start,
        maxiter=generations,
        popsize=POPULATION,
        tol=1e-4,
        polish=False,
        vectorized=True,
        updating="deferred",
        seed=SEED,
    )


def _limited(knobs: tuple[Knob, ...], model: Model, rise: float) -> tuple[Knob, ...]:
    """The limits under a peak torque that has risen: softest clutch damper, softest springs that have no stop."""
    stopped = travels(model)
    free = {name for name in model.landmarks.springs if name not in stopped}
    found = []
    for knob in knobs:
        low = knob.low * rise if knob.name == "clutch stiffness" else knob.low
        found.append(dataclasses.replace(knob, low=rise if free & {name for name, _ in knob.places} else low))
    return tuple(found)


def _factors(knobs: tuple[Knob, ...], place: Array) -> dict[tuple[str, str], Array]:
    """Factors of designs at places (designs, knobs) between the limits, 0 to 1 on a logarithmic scale."""
    return {
        spot: knob.low * (knob.high / knob.low) ** place[:, i] for i, knob in enumerate(knobs) for spot in knob.places
    }
