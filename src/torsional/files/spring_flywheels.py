"""Dual mass flywheels given by their springs: blocks of a model file into designs."""

from __future__ import annotations

from typing import Any

from torsional.absorbers import ArcSprings, CoilSpring, GuideFriction, StraightSprings
from torsional.errors import ModelError
from torsional.files.schema import absorber as schema
from torsional.files.schema.fields import Block


def straight_springs(block: schema.StraightSpringFlywheel) -> StraightSprings:
    """The design of a block; ModelError, its key path counting from the block, for what cannot be built."""
    return StraightSprings(**_fields(block))


def arc_springs(block: schema.ArcSpringFlywheel) -> ArcSprings:
    """The design of a block; ModelError, its key path counting from the block, for what cannot be built."""
    return ArcSprings(**_fields(block))


def _fields(block: schema.SpringFlywheelFields) -> dict[str, Any]:
    """The keys of a block that are there, as a design takes them."""
    own = [key for key in type(block).model_fields if key not in ("type", "pendulum")]
    given = {key: getattr(block, key) for key in own if getattr(block, key) is not None}
    return {key: _value(key, value) for key, value in given.items()}


def _value(key: str, value: Any) -> Any:
    if key.endswith("_clearance"):
        return _pair(key, value)
    if isinstance(value, Block):
        return _part(key, value)
    return tuple(value) if isinstance(value, list) else value


def _part(key: str, block: Block) -> CoilSpring | GuideFriction:
    make = CoilSpring if isinstance(block, schema.CoilSpringBlock) else GuideFriction
    try:
        return make(**{name: getattr(block, name) for name in type(block).model_fields})
    except ModelError as error:
        raise error.located(prefix=key) from None


def _pair(key: str, value: float | list[float]) -> tuple[float, float]:
    if not isinstance(value, list):
        return value, value
    if len(value) != 2:
        allowed = "one value, or two, [drive, coast]"
        raise ModelError("the list has the wrong length", where=key, found=f"{len(value)} values", allowed=allowed)
    return value[0], value[1]
