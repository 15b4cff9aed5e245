"""The trucks that claims are asked of, and changed copies of them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from torsional.components import Component, Coupling, Inertia, PlanetSpin, Superposition
from torsional.components.shaft import Damper
from torsional.errors import ModelError, nearest
from torsional.laws import Hinges, Law
from torsional.model import Gear, Model
from torsional.powertrain import Powertrain
from torsional.stamps import GROUND, Mass
from torsional.studies import concepts


@dataclass(frozen=True, eq=False)
class Trucks:
    """One truck with eight absorbers: single mass flywheel, dual mass flywheel (of one stage), power split absorber,
    flange absorber (TVA), planetary dual mass flywheel, dual mass flywheel with centrifugal pendulum, dual mass
    flywheel of two stages, dual mass flywheel with arc springs in detail.

    Landmarks must be set; the parts of an absorber bear the names that `torsional.absorbers` gives them.
    ``origins``: by concept, whose design it is, in words.
    """

    smf: Model
    dmf: Model
    psva: Model
    tva: Model
    planetary: Model
    pendulum: Model
    two_stage: Model
    arc_spring: Model
    origins: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def shipped(cls) -> Trucks:
        """The representative truck: a tractor of 40 t with a 13-litre six-cylinder diesel.

        >>> Trucks.shipped().smf.name
        '13-litre truck with a single mass flywheel'
        """
        models = concepts.shipped()
        return cls(**models, origins=dict.fromkeys(models, concepts.SHIPPED))

    @classmethod
    def of(cls, model: Model) -> Trucks:
        """A user's truck with each concept: its own absorber as the concept it is, the shipped ones scaled to it.

        The ratio t of the full-load peaks scales torques and stiffnesses, t ((3 · 600 rpm)/(n · idle))² inertias (n the
        firing order), so that modes meet the firing order at the same multiples of idle; damping ratios stay.
        ModelError for a model without file, absorber, engine with full-load curve, clutch or gearbox.

        >>> from torsional.files import load_model
        >>> Trucks.of(load_model("examples/truck_psva.yaml")).origins["psva"]
        'yours, as it is'
        """
        models, told = concepts.on_truck(model)
        return cls(**models, origins=told)

    @property
    def models(self) -> dict[str, Model]:
        """The models by concept."""
        return {each.name: getattr(self, each.name) for each in dataclasses.fields(self) if each.name != "origins"}


def mapped(model: Model, change: Callable[[dict[str, Component]], dict[str, Component]]) -> Model:
    """A copy whose components, those of every gear too, went through ``change``."""
    gears = {name: Gear(gear.ratio, change(dict(gear.components))) for name, gear in model.gears.items()}
    return model.replaced(components=change(dict(model.components)), gears=gears, document={})


def replaced(model: Model, name: str, component: Component | None = None, **fields: Any) -> Model:
    """A copy with one component exchanged, or some of its fields changed; raises ModelError for an unknown name."""
    known = {*model.components, *(part for gear in model.gears.values() for part in gear.components)}
    if name not in known:
        raise ModelError(f"there is no component '{name}'", where=name, remedy=nearest(name, known))

    def change(parts: dict[str, Component]) -> dict[str, Component]:
        if name in parts:
            old: Any = parts[name]
            parts[name] = component or dataclasses.replace(old, **fields)
        return parts

    return mapped(model, change)


def without(model: Model, *names: str) -> Model:
    """A copy without some components."""
    return mapped(model, lambda parts: {name: part for name, part in parts.items() if name not in names})


def joined(model: Model, **parts: Component) -> Model:
    """A copy with more components."""
    return model.replaced(components={**model.components, **parts}, document={})


def sprung(model: Model, name: str, stiffness: float) -> Model:
    """A copy whose coupling ``name`` is one linear stage of this stiffness [Nm/rad]."""
    return replaced(model, name, law=Hinges(float(stiffness)))


def hinged(model: Model, name: str) -> Law:
    """The piecewise-linear law of a coupling; raises ModelError for any other law."""
    law = _coupling(model, name).law
    if law.straight is None:
        raise ModelError("a piecewise-linear law is needed", where=name, found=type(law).__name__)
    return law


def stiffness(model: Model, name: str) -> float:
    """Stiffness of the first stage of a coupling [Nm/rad]."""
    return float(_coupling(model, name).law.tangent(0.0))


def _coupling(model: Model, name: str) -> Coupling:
    found = model.components.get(name)
    if not isinstance(found, Coupling):
        raise ModelError("is not a coupling with a law", where=name, found=type(found).__name__)
    return found


def only(model: Model, kind: type[Any]) -> str:
    """Name of the one component of a kind; raises ModelError where there is none, or several."""
    names = [name for name, part in model.components.items() if isinstance(part, kind)]
    if len(names) != 1:
        raise ModelError(f"one {kind.__name__} is needed", where=model.name, found=", ".join(names) or "none")
    return names[0]


def merged(psva: Model) -> Model:
    """The dual mass flywheel that corresponds to a power split absorber.

    Springs, damping and inertias are the same, but its secondary body and output turn as one (gear quotient 1) and no
    planets spin.
    """
    rigid = replaced(psva, only(psva, Superposition), ratio=1.0)
    return replaced(rigid, only(psva, PlanetSpin), inertia=0.0, switch=None)


def reached(powertrain: Powertrain, start: Iterable[str], barred: Iterable[str]) -> set[str]:
    """Nodes that hang together with ``start`` when the stamps named in ``barred`` are cut; ground joins nothing."""
    cut, found, size = set(barred), set(start), 0
    groups = [set(s.weights) - {GROUND} for s in powertrain.stamps if s.name not in cut]
    while size < len(found):
        size = len(found)
        found = found.union(*(group for group in groups if group & found))
    return found


def lumped(model: Model) -> Model:
    """A copy whose engine, up to the first absorber spring or the clutch, is one inertia at the crankshaft landmark.

    Dampers from engine parts to ground are kept, summed; what lies within the engine is rigid and so without effect.
    """
    marks = model.landmarks
    engine = reached(model.powertrain(), marks.throws, (*marks.springs, marks.clutch))
    inner = within(model, engine)
    inertia = sum(s.inertia for name, part in inner.items() for s in part.stamps(name) if isinstance(s, Mass))
    drag = sum(part.damping for part in inner.values() if isinstance(part, Damper))
    node = marks.crankshaft
    kept: dict[str, Component] = {"engine_body": Inertia(inertia, node)}
    kept |= {"engine_drag": Damper(node, damping=drag)} if drag else {}
    kept |= {name: part for name, part in model.components.items() if name not in inner}
    return model.replaced(components=kept, landmarks=dataclasses.replace(marks, throws=(node,)), document={})


def within(model: Model, nodes: set[str]) -> dict[str, Component]:
    """Components that touch these nodes and ground alone."""
    known = nodes | {GROUND}
    parts = model.components.items()
    return {name: part for name, part in parts if all(set(stamp.weights) <= known for stamp in part.stamps(name))}
