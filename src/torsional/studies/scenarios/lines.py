"""The line that a scenario moves: in neutral, with linings that slip, with a brake, on a road with limited grip."""

from __future__ import annotations

import dataclasses
from typing import Any

from torsional.components import Coupling, GearPair, Inertia, Shaft
from torsional.components.slip_clutch import SlipClutch
from torsional.errors import ModelError, nearest
from torsional.files.scenario_blocks import ClutchLinings
from torsional.laws import Coulomb
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.stamps import GROUND
from torsional.studies.scenarios import sizes
from torsional.studies.trucks import reached

LINING, LININGS, SYNCHRONISER = "clutch_lining", "clutch_linings", "synchroniser"
BRAKE, PATCH, ROAD, RESISTANCE = "brake", "contact_patch", "road", "road_load"
PATCH_INERTIA = 1.0
"""Of the tread in contact with the road [kgm²]: little beside a wheel."""
STICKING = 100.0
"""Torque that linings hold over the twist [rad] of those that stick: a brake at 1/100 rad."""
DAMPED = 1e-4
"""Damping of linings that stick over their stiffness [s]."""
CREEP = 0.02
"""Speed [rad/s] of a standing vehicle's wheels below which its resistance fades."""


def crank_of(model: Model) -> str:
    """The node that stands for the engine's speed."""
    return _mark(model, model.landmarks.crankshaft or "".join(model.landmarks.throws[-1:]), "crankshaft")


def load_of(model: Model) -> str:
    """The node that takes up the mean torque."""
    return _mark(model, model.landmarks.load, "load")


def _mark(model: Model, found: str, key: str) -> str:
    if not found:
        where = f"landmarks.{key}"
        raise ModelError("the scenario needs to know this node", where=where, remedy=f"name {where} in the model file")
    return found


def gear_of(model: Model, name: str, place: int = -1, where: str = "gear") -> str:
    """The gear named, or the one in its place among all of them; ModelError with the nearest name."""
    known = model.gear_names
    if not name:
        return known[max(min(place, len(known) - 1), -len(known))]
    if name not in known:
        remedy = nearest(name, known, listed=False) if model.gears else "this model has no gears: leave the key out"
        allowed = ", ".join(known) if model.gears else ""
        raise ModelError(f"there is no gear '{name}'", where=where, allowed=allowed, remedy=remedy)
    return name


def line_of(model: Model, gear: str = "") -> Powertrain:
    """The line in a gear as it moves in time: with the inner parts of an absorber that has them."""
    return model.detailed().powertrain(gear)


def inner_parts(model: Model) -> frozenset[str]:
    """Parts that an absorber has in time alone, in detail."""
    return frozenset(model.detail) - frozenset(model.components)


def in_neutral(model: Model) -> Powertrain:
    """What hangs on the crankshaft while no gear is engaged: all behind the gears is left out."""
    line = line_of(model)
    engaged = model.gears[model.top_gear].components if model.gears else {}
    meshing = [name for name, part in engaged.items() if isinstance(part, GearPair)] or list(engaged)
    kept = reached(line, [crank_of(model)], meshing) | {GROUND}
    parts = {
        name: part
        for name, part in line.components.items()
        if name not in meshing and all(set(stamp.weights) <= kept for stamp in part.stamps(name))
    }
    return Powertrain(parts, 1, line.reference)


def with_linings(line: Powertrain, model: Model, block: ClutchLinings) -> tuple[Powertrain, str, float]:
    """The line with linings that slip ahead of the clutch damper, pressed by the level "clutch"; the flywheel's node;
    what they carry [Nm].

    The damper, and friction beside it, hang on the linings instead of the flywheel.
    """
    name = model.landmarks.clutch
    if not name:
        remedy = "give the file a clutch, or landmarks.clutch"
        raise ModelError("the scenario needs a clutch", where="landmarks.clutch", remedy=remedy)
    disc, flywheel = _ends(line, name)
    capacity = sizes.torque(model, block.capacity, 1.4, "clutch.capacity")
    moved = dict(line.components)
    for other, part in line.components.items():
        if isinstance(part, Coupling | Shaft) and (part.a, part.b) == _ends(line, name):
            moved[other] = dataclasses.replace(part, b=LINING)
    values: dict[str, Any] = {"breakaway": block.breakaway, "damping": sizes.STICKING * capacity * DAMPED}
    values |= {"stiffness": block.stiffness or sizes.STICKING * capacity, "level": "clutch"}
    moved[LINING] = Inertia(sizes.lining_inertia(model, block.lining_inertia, disc))
    moved[LININGS] = SlipClutch.of_capacity(LINING, flywheel, capacity, **values)
    return Powertrain(moved, line.parts, line.reference), flywheel, capacity


def _ends(line: Powertrain, name: str) -> tuple[str, str]:
    part = line[name]
    if not isinstance(part, Coupling | Shaft):
        raise ModelError("a spring between two nodes is wanted here", where=name, found=type(part).__name__)
    return part.a, part.b


def braked(line: Powertrain, node: str, torque: float) -> Powertrain:
    """The line with a brake from the ground on a node, pressed by the level "brake"."""
    if node not in line.nodes:
        raise ModelError(f"there is no node '{node}'", where="node", remedy=nearest(node, line.nodes))
    values: dict[str, Any] = {"stiffness": STICKING * torque, "breakaway": 1.0, "damping": 0.1 * torque}
    brake = SlipClutch.of_capacity(GROUND, node, torque, level="brake", whole_speed=True, **values)
    return line.joined({BRAKE: brake})


def gripping(line: Powertrain, tyres: str, grip: float, level: str = "") -> Powertrain:
    """The line whose ``tyres`` hold the road by friction, of a ``level``, a contact patch between them and it."""
    if tyres not in line.components:
        springs = [name for name, part in line.components.items() if isinstance(part, Coupling | Shaft)]
        remedy = f"name the one between wheels and vehicle by the key 'tyres'; {nearest(tyres, springs)}"
        raise ModelError(f"there is no connection '{tyres}'", where="tyres", remedy=remedy)
    vehicle = _ends(line, tyres)[0]
    values: dict[str, Any] = {"stiffness": STICKING * grip, "breakaway": 1.0, "damping": 0.1 * grip}
    road = SlipClutch.of_capacity(vehicle, PATCH, grip, level=level, **values)
    held: Any = line[tyres]
    moved = {**line.components, tyres: dataclasses.replace(held, a=PATCH), PATCH: Inertia(PATCH_INERTIA), ROAD: road}
    return Powertrain(moved, line.parts, line.reference)


def stuck(line: Powertrain, names: tuple[str, ...]) -> Powertrain:
    """The line with linings that never slip in place of some that may: springs of the stiffness they have sticking."""
    held: dict[str, Any] = {name: line[name] for name in names}
    springs = {name: Shaft(part.a, part.b, part.stiffness) for name, part in held.items()}
    return Powertrain({**line.components, **springs}, line.parts, line.reference)


def resisted(line: Powertrain, node: str, torque: float) -> Powertrain:
    """The line with a constant resistance [Nm] at a node against its whole speed; it holds nothing at standstill."""
    return line.joined({RESISTANCE: Coupling(GROUND, node, Coulomb(torque, CREEP), whole_speed=True)})


def behind(line: Powertrain, connection: str, ahead: str) -> frozenset[str]:
    """The nodes that hang together with a connection's far end when the connection is cut; ``ahead``: its near end."""
    return frozenset(line.nodes) - reached(line, [ahead], [connection]) - {GROUND}
