"""The blocks of a model file as named components, gears and landmarks."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from torsional.absorbers import Absorber
from torsional.components import Component, GearPair, Inertia, Shaft, Vehicle
from torsional.components import blocks as groups
from torsional.errors import ModelError
from torsional.files.schema import ModelFile
from torsional.files.schema.fields import fitting
from torsional.files.schema.line import Clutch, Crankshaft, Driveline, Gearbox
from torsional.files.schema.making import Making
from torsional.model import Gear, Landmarks

Parts = dict[str, Component]


@dataclass
class Machine:
    """What the blocks have given so far: parts by name and the key path each comes from, gears, landmarks."""

    parts: Parts = field(default_factory=dict)
    origin: dict[str, str] = field(default_factory=dict)
    gears: dict[str, Gear] = field(default_factory=dict)
    landmarks: Landmarks = field(default_factory=Landmarks)
    absorber: Absorber | None = None

    def add(self, parts: Mapping[str, Component], path: str) -> None:
        """Take in the parts of a block; a name that is taken is refused."""
        for name, part in parts.items():
            self.refuse_taken(name, path)
            self.parts[name], self.origin[name] = part, path

    def refuse_taken(self, name: str, path: str) -> None:
        """A name is taken by another block, or by an inner part of the absorber."""
        if name in self.parts or (self.absorber and name in self.absorber.detail):
            problem = f"the name '{name}' is taken by {self.origin.get(name, 'absorber')}"
            raise ModelError(problem, where=path, remedy="give the component another name")

    def mark(self, **places: Any) -> None:
        """Name landmarks."""
        self.landmarks = dataclasses.replace(self.landmarks, **places)


def machine(file: ModelFile, throws: int | None) -> Machine:
    """All blocks as one machine; ``throws`` is the engine's number, None without an engine."""
    built = Machine()
    concept: Absorber | None = _made(file.absorber, "absorber") if file.absorber else None
    if concept:
        _engine_side(built, file.crankshaft, concept, throws)
        built.add(concept.components, "absorber")
        built.absorber = concept
        built.mark(crankshaft=concept.input, springs=concept.springs)
    if file.clutch and concept:
        built.add(_clutch(file.clutch, concept.output), "clutch")
        built.mark(clutch="clutch", input="gearbox_input")
    if file.gearbox:
        _gearbox(built, file.gearbox)
        built.mark(load="gearbox_output")
    if file.driveline and file.vehicle:
        vehicle = Vehicle(file.vehicle.mass, file.vehicle.rolling_radius)
        built.add(_driveline(file.driveline, vehicle), "driveline")
        built.mark(load="vehicle")
    for name, part in file.components.items():
        built.add({name: _made(part, f"components.{name}")}, f"components.{name}")
    _listed_gears(built, file)
    return built


def _engine_side(built: Machine, block: Crankshaft | None, concept: Absorber, throws: int | None) -> None:
    if block is None:
        built.mark(throws=(concept.input,) if throws else ())
    elif block.lumped_inertia is not None:
        built.add(_lumped(block.lumped_inertia, block, concept.input), "crankshaft")
        built.mark(throws=("crankshaft",))
    else:
        count = block.throws or throws
        if count is None:
            remedy = "give an engine block, or crankshaft.throws"
            raise ModelError("the number of throws is not known", where="crankshaft", remedy=remedy)
        if throws is not None and throws != count:
            found, allowed = str(count), f"{throws}, as the engine has"
            raise ModelError(
                "the throws do not fit the engine", where="crankshaft.throws", found=found, allowed=allowed
            )
        built.add(_crankshaft(block, concept.input, count), "crankshaft")
        built.mark(throws=tuple(f"throw{number}" for number in range(1, count + 1)))


def _lumped(inertia: float, block: Crankshaft, flange: str) -> Parts:
    rigid = block.flange_stiffness is None
    joint = GearPair("crankshaft", flange, 1.0) if rigid else _flange_shaft(block, flange)
    return {"crankshaft": Inertia(inertia), "crank_flange": joint}


def _flange_shaft(block: Crankshaft, flange: str) -> Shaft:
    return Shaft(flange, "crankshaft", block.flange_stiffness or 0.0, block.flange_damping)


def _crankshaft(block: Crankshaft, flange: str, count: int) -> Parts:
    damper, between = block.damper, max(count - 1, 1)
    front: Parts = {}
    if damper:
        front = groups.torsional_damper(damper.ring_inertia, damper.hub_inertia, damper.stiffness, damper.damping)
    rear = groups.crankshaft(
        count,
        fitting(block.throw_inertia or 0.0, count, "crankshaft.throw_inertia", "throw"),
        fitting(block.stiffness or 1.0, between, "crankshaft.stiffness", "pair of throws"),
        flange=flange,
        flange_stiffness=block.flange_stiffness or 0.0,
        damping=fitting(block.damping, between, "crankshaft.damping", "pair of throws"),
        flange_damping=block.flange_damping,
        absolute_damping=fitting(block.absolute_damping, count, "crankshaft.absolute_damping", "throw"),
        before="damper_hub" if damper else "",
        before_stiffness=damper.hub_stiffness if damper else 0.0,
    )
    return {**front, **rear}


def _made(block: Making, path: str) -> Any:
    """What a block makes; ModelError names the key path."""
    try:
        return block.made()
    except ModelError as error:
        raise error.located(prefix=path) from None


def _clutch(block: Clutch, flywheel: str) -> Parts:
    return groups.clutch(
        flywheel,
        block.law(),
        inertia=block.inertia,
        damping=block.damping,
        hub_stiffness=block.hub_stiffness,
        friction=block.washer(),
    )


def _gearbox(built: Machine, block: Gearbox) -> None:
    """What every gear has goes to the common parts; each gear keeps its own."""
    ratios = block.by_name
    stiffness = fitting(block.stiffness, len(ratios), "gearbox.stiffness", "gear")
    each = stiffness if isinstance(stiffness, list) else [stiffness] * len(ratios)
    shared = {
        "input_inertia": block.input_inertia,
        "mesh_inertia": block.mesh_inertia,
        "output_inertia": block.output_inertia,
    }
    gears = {
        name: groups.gearbox(ratio, stiffness=k, **shared)
        for (name, ratio), k in zip(ratios.items(), each, strict=True)
    }
    first = next(iter(gears.values()))
    own = [name for name in first if name == "gear" or any(gear[name] != first[name] for gear in gears.values())]
    built.add({name: part for name, part in first.items() if name not in own}, "gearbox")
    for name in own:
        built.origin[name] = "gearbox"
    built.gears = {name: Gear(ratios[name], {key: gear[key] for key in own}) for name, gear in gears.items()}


def _driveline(block: Driveline, vehicle: Vehicle) -> Parts:
    return groups.driveline(
        shaft_stiffness=block.propeller_shaft_stiffness,
        shaft_damping=block.propeller_shaft_damping,
        axle_inertia=block.axle_inertia,
        final_drive_ratio=block.final_drive_ratio,
        half_shaft_stiffness=block.half_shaft_stiffness,
        half_shaft_damping=block.half_shaft_damping,
        wheel_inertia=block.wheel_inertia,
        tyre_stiffness=block.tyre_stiffness,
        tyre_damping=block.tyre_damping,
        vehicle=vehicle,
    )


def _listed_gears(built: Machine, file: ModelFile) -> None:
    for gear, block in file.gears.items():
        parts: Parts = {}
        for name, part in block.components.items():
            path = f"gears.{gear}.components.{name}"
            built.refuse_taken(name, path)
            parts[name] = _made(part, path)
            built.origin.setdefault(name, path)
        built.gears[gear] = Gear(block.ratio, parts)
