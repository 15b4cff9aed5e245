"""What every block of the schema is made of: quantities with units, names, blocks that know their keys."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from torsional import units
from torsional.errors import ModelError, nearest
from torsional.stamps import GROUND

Shape = Literal["one", "one or list", "list", "list or names", "range"]
_LONGEST_LIST = 2000
_REFUSED = re.compile(r"[:=,;*?\[\]{}<>\"'`\\/|&]|^\s|\s$|[^\S ]|^ground$")


@dataclass(frozen=True)
class Quantity:
    """The annotation of a field that holds a quantity of the nomenclature, read by `units.read` into SI.

    ``above`` and ``least`` bound the value (exclusive, inclusive); ``nonzero`` refuses zero; ``shape`` says whether one
    value, a list, either, a list or values by name, or a range from:to is wanted.
    """

    name: str
    above: float | None = None
    least: float | None = None
    nonzero: bool = False
    shape: Shape = "one"

    def read(self, value: object) -> float | list[float] | dict[str, float] | tuple[float, ...]:
        """The value in SI; ModelError, its ``where`` counting from the field, for anything else."""
        if self.shape == "range":
            return tuple(self._checked(bound, value, "") for bound in units.read_range(value, self.name))
        if isinstance(value, list) and self.shape != "one":
            if not 0 < len(value) <= _LONGEST_LIST:
                raise ModelError(
                    "the list has the wrong length", found=str(len(value)), allowed=f"1 to {_LONGEST_LIST}"
                )
            return [self._one(item, str(number)) for number, item in enumerate(value)]
        if isinstance(value, dict) and self.shape == "list or names":
            return {_named(key, value): self._one(item, key) for key, item in value.items()}
        if self.shape.startswith("list"):
            raise ModelError("a list is wanted", found=units.quoted(value))
        return self._one(value, "")

    def _one(self, value: object, where: str) -> float:
        return self._checked(units.read(value, self.name, where), value, where)

    def _checked(self, number: float, value: object, where: str) -> float:
        unit = units.QUANTITIES[self.name].unit.strip("-")
        found = units.quoted(value) if isinstance(value, str) else f"{number:g}"
        if self.above is not None and not number > self.above:
            problem = "must be positive" if self.above == 0 else "is too small"
            raise ModelError(problem, where=where, found=found, allowed=f"> {self.above:g} {unit}".strip())
        if self.least is not None and not number >= self.least:
            problem = "must not be negative" if self.least == 0 else "is too small"
            raise ModelError(problem, where=where, found=found, allowed=f">= {self.least:g} {unit}".strip())
        if self.nonzero and number == 0:
            raise ModelError("must not be zero", where=where, found=found, allowed="any other number")
        return number

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        entry = units.QUANTITIES[self.name]
        bounds = {"exclusiveMinimum": self.above, "minimum": self.least}
        number = {"type": "number", **{key: bound for key, bound in bounds.items() if bound is not None}}
        text = {"type": "string", "pattern": r"^\s*[-+−–.0-9]"}
        one = {"anyOf": [number, text]}
        several = {"type": "array", "items": one, "minItems": 1}
        told: dict[Shape, Any] = {
            "one": one,
            "list": several,
            "one or list": {"anyOf": [number, text, several]},
            "list or names": {"anyOf": [several, {"type": "object", "additionalProperties": one, "minProperties": 1}]},
            "range": {"anyOf": [text, {"type": "array", "items": one, "minItems": 2, "maxItems": 3}]},
        }
        unit = "" if entry.unit == "-" else f" [{entry.unit}]"
        return {**told[self.shape], "description": f"{entry.long_name}{unit}", "x-quantity": self.name}


Angle = Annotated[float, Quantity("angle")]
Damping = Annotated[float, Quantity("damping", least=0)]
Inertia = Annotated[float, Quantity("inertia", above=0)]
InertiaOrNone = Annotated[float, Quantity("inertia", least=0)]
Length = Annotated[float, Quantity("length", above=0)]
LossFactor = Annotated[float, Quantity("loss_factor", least=0)]
Mass = Annotated[float, Quantity("mass", above=0)]
Pressure = Annotated[float, Quantity("pressure")]
Ratio = Annotated[float, Quantity("gear_ratio", nonzero=True)]
Speed = Annotated[float, Quantity("speed", above=0)]
Stiffness = Annotated[float, Quantity("stiffness", above=0)]
Torque = Annotated[float, Quantity("torque", above=0)]
Number = Annotated[float, Quantity("number")]
Order = Annotated[float, Quantity("engine_order", above=0)]
SpringRate = Annotated[float, Quantity("spring_rate", above=0)]
Time = Annotated[float, Quantity("time", least=0)]
Whole = Annotated[int, Field(ge=1, le=100)]
Dampings = Annotated[float | list[float], Quantity("damping", least=0, shape="one or list")]
Inertias = Annotated[float | list[float], Quantity("inertia", above=0, shape="one or list")]
Stiffnesses = Annotated[float | list[float], Quantity("stiffness", above=0, shape="one or list")]


def plain_name(value: str) -> str:
    """A name without marks that key paths, tables or pages would read as their own."""
    if not 0 < len(value) <= 64 or _REFUSED.search(value) or not value.isprintable():
        found = "'ground', the node that never moves" if value == GROUND else units.quoted(value)
        allowed = "1 to 64 letters, digits and marks, but none of : = , ; * ? [ ] { } < > / | & nor quotes"
        raise ModelError("this cannot be a name", found=found, allowed=allowed)
    return value


def _named(key: str, values: dict[str, object]) -> str:
    if not 0 < len(values) <= _LONGEST_LIST:
        raise ModelError("at least one value is wanted")
    try:
        return plain_name(key)
    except ModelError as error:
        raise error.located(prefix=key) from None


def _node(value: str) -> str:
    return value if value == GROUND else plain_name(value)


Name = Annotated[str, AfterValidator(plain_name)]
Node = Annotated[str, AfterValidator(_node)]


def only_version(value: object, version: int, key: str) -> int:
    """The one version that is read; ModelError for any other, which says of a later one that it is."""
    if isinstance(value, bool) or value != version:
        problem, remedy = "this version of the file format is unknown", f"write '{key}: {version}'"
        if isinstance(value, int | float) and value >= version + 1:
            problem, remedy = "the file is written for a later torsional than this one", "install the later one"
        raise ModelError(problem, found=units.quoted(value), allowed=str(version), remedy=remedy)
    return version


class Block(BaseModel):
    """A block of keys: every key known, every value of its type, none changed afterwards."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, hide_input_in_errors=True)

    @model_validator(mode="before")
    @classmethod
    def _keys(cls, data: Any) -> Any:
        """Misspelt and missing keys, told before anything else of the block."""
        if isinstance(data, dict):
            for key in data:
                if key not in cls.model_fields:
                    raise ModelError("the key is unknown", where=str(key), remedy=nearest(str(key), cls.model_fields))
            for key, field in cls.model_fields.items():
                if key not in data and field.is_required():
                    raise ModelError(f"the key '{key}' is missing", allowed=told(field))
        return data


def quantity_of(field: FieldInfo) -> Quantity | None:
    """The quantity a field holds; of one that may be left out it stands inside the union with None."""
    choices = [metadata for choice in get_args(field.annotation) for metadata in getattr(choice, "__metadata__", ())]
    return next((part for part in [*field.metadata, *choices] if isinstance(part, Quantity)), None)


def told(field: FieldInfo) -> str:
    """A field in words: its quantity and unit, and what its description adds."""
    quantity = quantity_of(field)
    entry = units.QUANTITIES[quantity.name] if quantity else None
    measured = f"{entry.long_name} [{entry.unit}]".replace(" [-]", "") if entry else ""
    return ", ".join(part for part in (measured, field.description or "") if part)


def fitting(values: float | Sequence[float], count: int, where: str, per: str) -> float | list[float]:
    """One value for all of ``count`` places, or a list of that length; ModelError that names the key."""
    if isinstance(values, (int, float)):
        return float(values)
    if len(values) != count:
        allowed = f"one value, or {count}, one a {per}"
        raise ModelError("the list has the wrong length", where=where, found=f"{len(values)} values", allowed=allowed)
    return list(values)
