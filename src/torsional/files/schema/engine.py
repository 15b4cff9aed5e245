"""The engine block."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, model_validator

from torsional import units
from torsional.engine import ChenFlynn, CombustionCycle, LoadTable, Wiebe
from torsional.errors import ModelError
from torsional.files.schema.fields import Angle, Block, Length, Number, Pressure, Quantity, Speed
from torsional.files.schema.making import Making

Angles = Annotated[list[float], Quantity("angle", least=0, shape="list")]
Factors = Annotated[list[float], Quantity("ratio", least=0, shape="list")]
Speeds = Annotated[list[float], Quantity("speed", above=0, shape="list")]
Torques = Annotated[list[float], Quantity("torque", least=0, shape="list")]
Pressures = Annotated[list[float], Quantity("mean_pressure", least=0, shape="list")]
Cylinders = Annotated[list[int], Field(max_length=16)]


class WiebeBlock(Making):
    """A Wiebe function: burnt fraction over crank angle from firing top dead centre."""

    makes: ClassVar = Wiebe

    start: Angle = Field(description="start of combustion, negative before top dead centre")
    duration: Angle
    shape: Number = Field(description="m, the exponent less one")
    efficiency: Number = Field(6.908, description="a, 6.908 burns 99.9 % within the duration")


class TableOverLoad(Making):
    """Values over the brake mean effective pressure of the firing cylinders."""

    mean_effective_pressure: Pressures
    value: Annotated[list[float], Field(min_length=1)]

    def made(self) -> LoadTable | float:
        """The table, or its value where it has one row."""
        loads, values = self.mean_effective_pressure, self.value
        if len(loads) != len(values):
            found = f"{len(loads)} loads, {len(values)} values"
            raise ModelError("a value for each load is wanted", found=found)
        return LoadTable(tuple(zip(loads, values, strict=True))) if len(values) > 1 else values[0]


class BoostOverLoad(TableOverLoad):
    """Boost pressure over load."""

    value: Annotated[list[float], Quantity("pressure", above=0, shape="list")]


class FractionOverLoad(TableOverLoad):
    """Premixed fraction over load."""

    value: Factors


def _as_table(value: object) -> object:
    """One value for all loads is a table with a single row."""
    return value if isinstance(value, dict) else {"mean_effective_pressure": [0.0], "value": [value]}


def _as_file(value: object) -> object:
    """A file name alone stands for a block with that file."""
    return {"file": value} if isinstance(value, str) else value


OneText = float | str
Boost = Annotated[BoostOverLoad, BeforeValidator(_as_table, json_schema_input_type=OneText | BoostOverLoad)]
Fraction = Annotated[FractionOverLoad, BeforeValidator(_as_table, json_schema_input_type=OneText | FractionOverLoad)]


class CombustionBlock(Making):
    """The built-in diesel cycle; what is left out has the defaults of `CombustionCycle`."""

    makes: ClassVar = CombustionCycle

    boost: Boost | None = Field(None, description="intake pressure, absolute: one value, or a table over load")
    compression_exponent: Number | None = None
    expansion_exponent: Number | None = None
    main: WiebeBlock | None = None
    premixed: WiebeBlock | None = None
    premixed_fraction: Fraction | None = Field(None, description="one value, or a table over load")
    intake_closing: Angle | None = Field(None, description="from firing top dead centre, negative")
    exhaust_opening: Angle | None = Field(None, description="from firing top dead centre")
    blowdown_angle: Angle | None = None
    valve_overlap: Angle | None = None
    exhaust_back_pressure: Pressure | None = Field(None, description="above the intake pressure")


class TableFile(Block):
    """A CSV file beside the model file."""

    file: str | None = Field(None, description="name of a CSV file in the model's folder")
    text: str | None = Field(None, description="the file's content, where a model carries it along")


class PressureTraceBlock(TableFile):
    """Measured cylinder pressure over crank angle or time, units in the header."""

    speed: Speed | None = Field(None, description="engine speed of a record over time")
    offset: Angle = Field(0.0, description="added to the angle so that 0 is firing top dead centre")
    own_angle: bool = Field(False, description="whether every column counts from the firing of its own cylinder")


class FullLoadBlock(TableFile):
    """Full-load torque over engine speed: a file with columns speed and torque, or two lists."""

    speed: Speeds | None = None
    torque: Torques | None = None

    @model_validator(mode="after")
    def _one_way_only(self) -> FullLoadBlock:
        listed = self.speed is not None, self.torque is not None
        if any(listed) == (self.file is not None or self.text is not None) or (any(listed) and not all(listed)):
            raise ModelError("a full-load curve is a file, or two lists: speed and torque")
        return self


class FrictionBlock(Making):
    """Friction mean effective pressure (Chen and Flynn)."""

    makes: ClassVar = ChenFlynn

    constant: Annotated[float, Quantity("mean_pressure", least=0)] | None = None
    peak_pressure_factor: Annotated[float, Quantity("ratio", least=0)] | None = None
    linear: Number | None = Field(None, description="times the mean piston speed [Pa s/m]")
    quadratic: Number | None = Field(None, description="times the mean piston speed squared [Pa s²/m²]")


class EngineBlock(Block):
    """A four-stroke engine of 1 to 16 cylinders."""

    layout: str = Field(description="inline-6, vee-8 …")
    bore: Length
    stroke: Length
    rod_length: Length = Field(description="connecting rod, between its centres")
    pin_offset: Annotated[float, Quantity("length")] = Field(0.0, description="piston pin or cylinder axis offset")
    reciprocating_mass: Annotated[float, Quantity("mass", least=0)] = Field(description="of one cylinder")
    compression_ratio: Annotated[float, Quantity("ratio", above=1)]
    firing_order: Cylinders = Field(description="cylinder numbers, beginning with 1")
    firing_intervals: Angles | None = Field(None, description="from each firing to the next; even if left out")
    bank_angle: Angle | None = Field(None, description="of a vee")
    throws: Cylinders | None = Field(None, description="throw of each cylinder of a vee")
    pin_split: Angle = Field(0.0, description="of the split crank pins of a vee")
    combustion: CombustionBlock | None = None
    pressure_trace: (
        Annotated[PressureTraceBlock, BeforeValidator(_as_file, json_schema_input_type=str | PressureTraceBlock)] | None
    ) = Field(None, description="measured pressure instead of the built-in cycle")
    friction: FrictionBlock | None = None
    full_load: (
        Annotated[FullLoadBlock, BeforeValidator(_as_file, json_schema_input_type=str | FullLoadBlock)] | None
    ) = Field(None, description="CSV file, or lists of speed and torque")
    crankcase_pressure: Pressure = 1.0e5
    leakage_time: Annotated[float, Quantity("time", above=0)] = Field(
        1.0, description="in which a cylinder at standstill loses its pressure past the rings"
    )
    deactivated: Cylinders = Field([], description="cylinders without fuel")
    deactivated_valves: Literal["closed", "working"] = "closed"
    trapped_pressure: Pressure = Field(1.0e5, description="at bottom dead centre of cylinders with closed valves")
    cylinder_spread: Factors | None = Field(None, description="factor on each cylinder's heat")

    @model_validator(mode="after")
    def _one_way_only(self) -> EngineBlock:
        if self.combustion is not None and self.pressure_trace is not None:
            remedy = "remove one of the two"
            raise ModelError(
                "a measured trace and a calculated cycle exclude each other", where="combustion", remedy=remedy
            )
        kind, _, count = self.layout.partition("-")
        if kind not in ("inline", "vee") or not count.isascii() or not count.isdigit():
            allowed = "inline-1 to inline-16, vee-2 to vee-16"
            raise ModelError("the layout is unknown", where="layout", found=units.quoted(self.layout), allowed=allowed)
        if int(count[:3]) != len(self.firing_order):
            found, allowed = f"{len(self.firing_order)} cylinders", f"{count[:3]}, as the layout says"
            raise ModelError(
                "the firing order does not fit the layout", where="firing_order", found=found, allowed=allowed
            )
        if kind == "vee" and self.bank_angle is None:
            raise ModelError("a vee needs its bank_angle", where="bank_angle")
        for key in ("bank_angle", "throws", "pin_split"):
            if kind == "inline" and key in self.model_fields_set:
                raise ModelError("an inline engine has none", where=key, remedy="remove it, or say layout: vee-…")
        return self
