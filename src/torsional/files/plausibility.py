"""Values that no powertrain is likely to have: often a unit that was meant and not written."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from torsional.errors import ModelError
from torsional.files.load import validated
from torsional.files.reader import Tree
from torsional.files.schema.fields import Quantity, quantity_of
from torsional.model import Model
from torsional.units import plausible


def warnings_of(model: Model) -> list[str]:
    """One sentence for every value of the model's file that looks like one in another unit, with its key path.

    Factors of 57.3 (degrees), 9.55 (rpm) and 1e9 (g·mm²) are named; a model that came from no file has none.
    """
    if not model.document:
        return []
    try:
        file = validated(Tree(dict(model.document)))
    except ModelError:
        return []
    return _of_block(file, "")


def _of_block(block: BaseModel, path: str) -> list[str]:
    told: list[str] = []
    for key, field in type(block).model_fields.items():
        told += _of_value(getattr(block, key), f"{path}.{key}" if path else key, quantity_of(field))
    return told


def _of_value(value: Any, path: str, quantity: Quantity | None) -> list[str]:
    if isinstance(value, BaseModel):
        return _of_block(value, path)
    if isinstance(value, dict):
        return [text for key, item in value.items() for text in _of_value(item, f"{path}.{key}", quantity)]
    if isinstance(value, list | tuple):
        return [text for i, item in enumerate(value) for text in _of_value(item, f"{path}.{i}", quantity)]
    if quantity is None or isinstance(value, bool) or not isinstance(value, int | float):
        return []
    return [f"{path}: {text}" for text in plausible(float(value), quantity.name)]
