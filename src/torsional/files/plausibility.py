"""Values that no powertrain is likely to have: often a unit that was meant and not written."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from torsional.errors import ModelError
from torsional.files.load import validated
from torsional.files.reader import Tree
from torsional.files.schema import ModelFile
from torsional.files.schema.fields import Quantity, quantity_of
from torsional.laws import Law
from torsional.model import Model
from torsional.units import plausible, show


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
    return _of_block(file, "") + _beyond_the_curve(model) + _below_full_load(file, model)


def _beyond_the_curve(model: Model) -> list[str]:
    """Speeds of the analyses that the full-load curve does not reach."""
    curve = model.full_load_curve
    low, high = model.operation.speed
    if curve is None or model.operation.torque is not None:
        return []
    first, last = curve.speeds[0], curve.speeds[-1]
    if first * (1 - 1e-9) <= low and high <= last * (1 + 1e-9):
        return []
    reach = f"{show(first, 'speed')} to {show(last, 'speed')}"
    return [f"operation.speed: {show(low, 'speed')} to {show(high, 'speed')} goes beyond the full-load curve ({reach})"]


def _below_full_load(file: ModelFile, model: Model) -> list[str]:
    """A stop that full load reaches: steady running on the stop is no one's intention."""
    if model.full_load_curve is None:
        return []
    stop = _stop_torque(model)
    if file.absorber is None or stop is None or stop > file.absorber.spring_share() * model.full_load_peak():
        return []
    peak = show(model.full_load_peak(), "torque")
    return [f"absorber: the springs meet their stop at {show(stop, 'torque')}, and full load is {peak}"]


def _stop_torque(model: Model) -> float | None:
    """The torque [Nm] at which an absorber of one row of springs meets its stop on drive; None without one."""
    laws = [getattr(model.components[name], "law", None) for name in model.landmarks.springs]
    law: Law | None = laws[0] if len(laws) == 1 else None
    return float(law.torque(max(law.stops))) if law is not None and law.stops else None


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
