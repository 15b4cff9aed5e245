"""The whole model file."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from torsional.files.schema.absorbers import AnyAbsorber
from torsional.files.schema.engine import EngineBlock
from torsional.files.schema.fields import Block, Name, Node, Quantity, Ratio, Speed, only_version
from torsional.files.schema.line import Clutch, Crankshaft, Driveline, Gearbox, VehicleBlock
from torsional.files.schema.making import Making
from torsional.files.schema.parts import Part
from torsional.files.schema.published import schema_of

VERSION = 1
_TITLE = 200
Range = tuple[float, ...]
SpeedRange = Annotated[Range, Quantity("speed", above=0, shape="range")]
Parts = Annotated[dict[Name, Part], Field(max_length=400)]


def _version(value: object) -> object:
    return only_version(value, VERSION, "torsional")


def _names(value: object) -> object:
    """One name stands for a list of one."""
    return [value] if isinstance(value, str) else value


class TorqueRange(Quantity):
    """A range of torque, or full_load, which is an empty one."""

    def read(self, value: object) -> float | list[float] | dict[str, float] | tuple[float, ...]:
        """The range in Nm."""
        return () if value == "full_load" else super().read(value)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        told = super().__get_pydantic_json_schema__(schema, handler)
        return {**told, "anyOf": [{"const": "full_load"}, *told["anyOf"]]}


Names = Annotated[list[Node], Field(max_length=16), BeforeValidator(_names, json_schema_input_type=str | list[str])]


class OperationBlock(Block):
    """Where the machine runs."""

    idle: Speed | None = None
    speed: SpeedRange | None = Field(None, description="from:to of the mean engine speed, e.g. 600:2000 rpm")
    torque: Annotated[Range, TorqueRange("torque", shape="range")] = Field(
        (), description="from:to of the mean engine torque, or full_load: zero up to the full-load curve"
    )


class LandmarksBlock(Making):
    """Names of the places that analyses ask for, where the blocks do not say them."""

    throws: Names | None = Field(None, description="nodes on which the cylinders act: one a throw, or one for all")
    crankshaft: Node | None = Field(None, description="node that stands for the engine's speed")
    load: Node | None = Field(None, description="node where the mean torque is taken up")
    input: Node | None = Field(None, description="node to be kept quiet, such as the gearbox input")
    springs: Names | None = Field(None, description="the absorber's connections")
    clutch: Node | None = Field(None, description="the clutch damper")


class GearBlock(Block):
    """One gear of a machine written as components: what stands in the line while it is engaged."""

    ratio: Ratio
    components: Parts = Field({})


class ModelFile(Block):
    """A model file: a vehicle by its blocks, any machine by its components, or both."""

    torsional: Annotated[Literal[1], BeforeValidator(_version)] = Field(
        description="version of this schema, as 'torsional: 1'"
    )
    name: Annotated[str, Field(min_length=1, max_length=_TITLE)] = Field(description="what it is, in words")
    description: Annotated[str, Field(max_length=4000)] = ""
    engine: EngineBlock | None = None
    crankshaft: Crankshaft | None = None
    absorber: AnyAbsorber | None = None
    clutch: Clutch | None = None
    gearbox: Gearbox | None = None
    driveline: Driveline | None = None
    vehicle: VehicleBlock | None = None
    components: Parts = Field({}, description="further parts, or the whole machine, by name")
    gears: Annotated[dict[Name, GearBlock], Field(max_length=40)] = Field(
        {}, description="gears of a machine written as components"
    )
    operation: OperationBlock | None = None
    landmarks: LandmarksBlock | None = None


def json_schema() -> dict[str, Any]:
    """The schema of model files as JSON Schema, draft 2020-12, for editors and other tools."""
    return schema_of(ModelFile, "torsional model file")
