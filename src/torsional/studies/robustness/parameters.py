"""The uncertain parameters of a truck, in engineers' words, with the key paths of model files at which they stand.

Left out is what makers publish (bore, stroke, compression ratio, firing order, gear ratios, rolling radius) and what
they choose (idle and the range of speeds); so is the inner design of the arc springs, in which parts fit each other by
tenths of a degree.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from torsional.files.edit import put
from torsional.files.scaling import read_document, values_at
from torsional.files.schema import ModelFile
from torsional.model import Model
from torsional.studies.concepts import absorbers, built
from torsional.studies.trucks import Trucks

SPREAD = 0.2
"""Every parameter is uncertain by this share of its value, up and down."""
FULL_LOAD = "engine.full_load"
Place = tuple[tuple[str, ...], str]

ONE_STAGE = ("dmf", "pendulum")
SPRUNG = (*ONE_STAGE, "planetary", "tva")
DOUBLE = (*SPRUNG, "two_stage", "arc_spring")
ROWS = ("absorber.primary_springs", "absorber.secondary_springs")


@dataclass(frozen=True)
class Parameter:
    """A figure of the truck under its ``name``; one factor multiplies it in all ``places`` (concepts, key path).

    ``origin``: what its distance from is multiplied, 0 but for quotients that must not pass 1.
    """

    name: str
    places: tuple[Place, ...]
    origin: float = 0.0

    def times(self, value: float, factor: float) -> float:
        """The value when the parameter is multiplied."""
        return self.origin + factor * (value - self.origin) if self.origin else factor * value

    @property
    def concepts(self) -> frozenset[str]:
        """The concepts that have it."""
        return frozenset(concept for concepts, _ in self.places for concept in concepts)


def at(concepts: tuple[str, ...], *paths: str) -> tuple[Place, ...]:
    """Key paths in the files of some concepts."""
    return tuple((concepts, path) for path in paths)


def line(*paths: str) -> tuple[Place, ...]:
    """Key paths in all files."""
    return at(tuple(absorbers()), *paths)


def sprung(key: str) -> tuple[str, ...]:
    """Key paths of one-stage springs, written as a stage or not, in one row or in two."""
    stage = {"stiffness": "absorber.stages.0.stiffness", "stop_torque": "absorber.stages.0.up_to"}[key]
    return (f"absorber.{key}", stage, *(f"{row}.{key}" for row in ROWS))


PARAMETERS = (
    Parameter("connecting rod length", line("engine.rod_length")),
    Parameter("reciprocating mass", line("engine.reciprocating_mass")),
    Parameter("full-load torque", line(FULL_LOAD)),
    Parameter("crank damper ring inertia", line("crankshaft.damper.ring_inertia")),
    Parameter("crank damper hub inertia", line("crankshaft.damper.hub_inertia")),
    Parameter("crank damper stiffness", line("crankshaft.damper.stiffness")),
    Parameter("crank damper damping", line("crankshaft.damper.damping")),
    Parameter("crank throw inertia", line("crankshaft.throw_inertia", "crankshaft.lumped_inertia")),
    Parameter("crankshaft stiffness", line("crankshaft.stiffness", "crankshaft.damper.hub_stiffness")),
    Parameter("crank flange stiffness", line("crankshaft.flange_stiffness")),
    Parameter("crankshaft damping, relative", line("crankshaft.damping", "crankshaft.flange_damping")),
    Parameter("crankshaft damping, absolute", line("crankshaft.absolute_damping")),
    Parameter("SMF inertia", at(("smf",), "absorber.inertia")),
    Parameter("DMF primary inertia", at(DOUBLE, "absorber.primary_inertia")),
    Parameter("DMF secondary inertia", at(DOUBLE, "absorber.secondary_inertia")),
    Parameter("DMF spring stiffness", at(SPRUNG, *sprung("stiffness"))),
    Parameter("DMF first-stage stiffness", at(("two_stage",), "absorber.stages.0.stiffness")),
    Parameter("DMF second-stage stiffness", at(("two_stage",), "absorber.stages.1.stiffness")),
    Parameter("DMF transition torque", at(("two_stage",), "absorber.stages.0.up_to")),
    Parameter("DMF stop torque", at(SPRUNG, *sprung("stop_torque")) + at(("two_stage",), "absorber.stages.1.up_to")),
    Parameter("DMF damping", at(DOUBLE, "absorber.damping")),
    Parameter("planetary DMF planet inertia", at(("planetary",), "absorber.planet_inertia", "absorber.switch.inertia")),
    Parameter("pendulum mass", at(("pendulum",), "absorber.pendulum.mass")),
    Parameter("PSVA primary inertia", at(("psva",), "absorber.primary_inertia")),
    Parameter("PSVA secondary inertia", at(("psva",), "absorber.secondary_inertia")),
    Parameter("PSVA output inertia", at(("psva",), "absorber.output_inertia")),
    Parameter("PSVA planet inertia", at(("psva",), "absorber.planet_inertia")),
    Parameter("planet ratio", at(("psva", "planetary"), "absorber.planet_ratio")),
    # ±20 % of r itself would pass 1, where springs and gears carry the torque no longer side by side.
    Parameter("PSVA gear quotient, its distance from 1", at(("psva",), "absorber.gear_quotient"), origin=1.0),
    Parameter("PSVA spring stiffness", at(("psva",), *sprung("stiffness"))),
    Parameter("PSVA stop torque", at(("psva",), *sprung("stop_torque"))),
    Parameter("PSVA damping", at(("psva",), "absorber.damping")),
    Parameter("TVA flange inertia", at(("tva",), "absorber.flange_inertia")),
    Parameter("TVA inertia", at(("tva",), "absorber.tva.inertia")),
    Parameter("TVA tuning speed", at(("tva",), "absorber.tva.tuned_to")),
    Parameter("TVA spring stiffness", at(("tva",), "absorber.tva.stiffness")),
    Parameter("TVA damping", at(("tva",), "absorber.tva.damping")),
    Parameter("clutch disc inertia", line("clutch.inertia")),
    Parameter("clutch damper stiffness", line("clutch.stiffness", "clutch.stages.*.stiffness")),
    Parameter("clutch damper damping", line("clutch.damping")),
    Parameter("clutch friction torque", line("clutch.friction_torque")),
    Parameter("clutch hub stiffness", line("clutch.hub_stiffness")),
    Parameter("gearbox input inertia", line("gearbox.input_inertia")),
    Parameter("gearbox mesh inertia", line("gearbox.mesh_inertia")),
    Parameter("gearbox output inertia", line("gearbox.output_inertia")),
    Parameter("gearbox stiffness", line("gearbox.stiffness")),
    Parameter("propeller shaft stiffness", line("driveline.propeller_shaft_stiffness")),
    Parameter("axle inertia", line("driveline.axle_inertia")),
    Parameter("final drive ratio", line("driveline.final_drive_ratio")),
    Parameter("half shaft stiffness", line("driveline.half_shaft_stiffness")),
    Parameter("wheel inertia", line("driveline.wheel_inertia")),
    Parameter("tyre stiffness", line("driveline.tyre_stiffness")),
    Parameter("tyre damping", line("driveline.tyre_damping")),
    Parameter("vehicle mass", line("vehicle.mass")),
)


@lru_cache(maxsize=4)
def _files(trucks: Trucks) -> dict[str, ModelFile]:
    return {concept: read_document(model.document) for concept, model in trucks.models.items()}


def parameters_of(trucks: Trucks) -> tuple[Parameter, ...]:
    """The parameters that stand in the files of these trucks; ModelError for models that came from no file."""
    models, read = trucks.models, _files(trucks)
    return tuple(
        each
        for each in PARAMETERS
        if any(_values(models[concept], read[concept], path) for concept, path in _places(each))
    )


def varied(trucks: Trucks, factors: Mapping[str, float]) -> Trucks:
    """Trucks whose parameters, by name, are multiplied; those of the same engine share it.

    >>> varied(Trucks.shipped(), {"clutch damper stiffness": 1.2}).smf.components["clutch"].law.stiffness  # Nm/rad
    30000.0
    """
    models, read = trucks.models, _files(trucks)
    documents = {concept: copy.deepcopy(dict(model.document)) for concept, model in models.items()}
    for each in PARAMETERS:
        factor = factors.get(each.name, 1.0)
        for concept, path in _places(each) if factor != 1.0 else ():
            for key, value in _values(models[concept], read[concept], path).items():
                put(documents[concept], key, _times(each, value, factor))
    return Trucks(**built(documents, trucks.smf), origins=trucks.origins)


def _places(parameter: Parameter) -> list[tuple[str, str]]:
    return [(concept, path) for concepts, path in parameter.places for concept in concepts]


def _values(model: Model, file: ModelFile, path: str) -> Mapping[str, Any]:
    """What stands at a path in SI; of full load the curve, wherever it was read from."""
    curve = model.full_load_curve
    return {FULL_LOAD: curve} if path == FULL_LOAD and curve else values_at(file, path)


def _times(parameter: Parameter, value: Any, factor: float) -> Any:
    if isinstance(value, float):
        return parameter.times(value, factor)
    return {"speed": list(value.speeds), "torque": [parameter.times(torque, factor) for torque in value.torques]}
