"""Mapping files: which channel of a measurement is which quantity of which node or element."""

from __future__ import annotations

import os
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.faults import told_of
from torsional.files.reader import read_tree
from torsional.files.schema.fields import Block, Node, Quantity, only_version
from torsional.files.schema.published import schema_of
from torsional.units import QUANTITIES

VERSION, KEY = 1, "torsional_mapping"
NODES = {"angle": "angle", "angular_velocity": "angular_velocity", "acceleration": "acceleration"}
"""Quantities of nodes, and what they are in the nomenclature."""
ELEMENTS = {"twist": "relative_angle", "torque": "torque"}
"""The same of elements."""
PULSED = "pulses"
Finite = Annotated[float, Quantity("number")]
Time = Annotated[float, Quantity("time")]


def _version(value: object) -> object:
    return only_version(value, VERSION, KEY)


class ChannelBlock(Block):
    """What one channel is: a quantity of a node or of an element, or pulses of a wheel on a node."""

    quantity: Literal["angle", "angular_velocity", "acceleration", "twist", "torque", "pulses"]
    node: Node | None = Field(None, description="of an angle, a speed, an acceleration, pulses")
    element: Node | None = Field(None, description="of a twist or a torque")
    channel: str = Field("", max_length=1000, description="the channel's name in the file, where it is no key")
    unit: str = Field("", max_length=40, description="instead of the file's own")
    factor: Annotated[float, Quantity("number", nonzero=True)] = Field(1.0, description="times the value, in its unit")
    offset: Finite = Field(0.0, description="added after the factor, in the same unit")
    sign: Literal[1, -1] = Field(1, description="-1 where the sensor counts the other way")
    delay: Time = Field(0.0, description="by which the channel comes late")
    pulses_per_turn: Annotated[int, Field(ge=1, le=100_000)] | None = Field(
        None, description="of a wheel, the missing ones counted"
    )
    missing: Annotated[int, Field(ge=0, le=100)] = Field(0, description="teeth that a wheel has left out")

    @model_validator(mode="after")
    def _one_place(self) -> ChannelBlock:
        """A quantity stands at the kind of place that has it."""
        wanted = "element" if self.quantity in ELEMENTS else "node"
        other = "node" if wanted == "element" else "element"
        if getattr(self, other) is not None:
            remedy = (
                f"a {self.quantity} is of a {wanted}" if wanted == "node" else f"a {self.quantity} is of an element"
            )
            raise ModelError("the key does not fit the quantity", where=other, remedy=remedy)
        if getattr(self, wanted) is None:
            raise ModelError(f"the key '{wanted}' is missing", allowed=f"the {wanted} whose {self.quantity} it is")
        if (self.quantity == PULSED) != (self.pulses_per_turn is not None):
            problem = (
                "the key 'pulses_per_turn' is missing" if self.quantity == PULSED else "the key is of pulses alone"
            )
            raise ModelError(problem, where="" if self.quantity == PULSED else "pulses_per_turn")
        return self


class MappingFile(Block):
    """Which channels are which quantities of a model, and the even raster they are brought to."""

    torsional_mapping: Annotated[int, BeforeValidator(_version)] = Field(description=f"version, as '{KEY}: {VERSION}'")
    name: str = Field("", max_length=200)
    channels: dict[str, ChannelBlock] = Field(min_length=1, max_length=1000, description="by their names in the file")
    raster: str = Field("finest", max_length=200, description="finest, coarsest, or the name of a channel to follow")
    rate: Annotated[float, Quantity("frequency", above=0)] | None = Field(None, description="instead of a raster")
    method: Literal["linear", "previous", "mean"] = Field(
        "linear", description="between samples: straight, as the last one stood, or the mean over a step"
    )


@checked
def load_mapping(path: str | os.PathLike[str]) -> MappingFile:
    """The mapping of a YAML or JSON file; ModelError, with file, key path and line, for anything that is none.

    >>> import tempfile, pathlib
    >>> text = "torsional_mapping: 1\\nchannels: {n_mot: {quantity: angular_velocity, node: crankshaft}}"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = pathlib.Path(folder, "rig.yaml").write_text(text)
    ...     load_mapping(f"{folder}/rig.yaml").channels["n_mot"].node
    'crankshaft'
    """
    tree = read_tree(path)
    if KEY not in tree.data:
        remedy = "is this a model file?" if "torsional" in tree.data else f"write '{KEY}: {VERSION}'"
        raise ModelError(f"the key '{KEY}' is missing", remedy=remedy, file=tree.file)
    with told_of(tree):
        return MappingFile.model_validate(tree.data)


def mapping_schema() -> dict[str, Any]:
    """The JSON Schema of mapping files, for editors."""
    return schema_of(MappingFile, "torsional mapping file")


def quantity_of(block: ChannelBlock) -> str:
    """The quantity of the nomenclature that a channel is read in."""
    return {**NODES, **ELEMENTS}[block.quantity]


def kind_of(block: ChannelBlock) -> str:
    """The kind of unit that a channel may have."""
    return QUANTITIES[quantity_of(block)].kind
