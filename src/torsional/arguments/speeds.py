"""Speeds and sweeps that would be ordinary ones in rpm or degrees."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from torsional.arguments.annotations import numbers
from torsional.errors import ModelError
from torsional.units import QUANTITIES, convert

FAR_ABOVE = 2.5
"""Beyond this many times a model's highest speed, one that would be ordinary in rpm was meant in rpm."""


def refuse_strange(name: str, given: Mapping[str, Any]) -> None:
    """Refuse speeds and sweeps that a model does not have, but would if they were in rpm or degrees."""
    for parameter in ("speed", "speeds", "sweep") if "model" in given else ():
        values = given.get(parameter)
        if values is None or not numbers(values, empty=False):
            continue
        quantity = QUANTITIES["relative_angle" if parameter == "sweep" else "speed"]
        least, most, where = float(np.min(values)), float(np.max(values)), f"{name}({parameter})"
        if quantity.name == "speed" and least < 0:
            raise ModelError("an engine does not turn backwards", where=where, found=f"{least:g} rad/s")
        limit = FAR_ABOVE * (_highest_speed(given["model"]) if quantity.name == "speed" else quantity.high)
        shown = convert(1.0, quantity.shown, quantity.unit)
        ordinary = shown * least > _lowest_speed(given["model"]) / FAR_ABOVE or quantity.name != "speed"
        if ordinary and shown * most <= limit < most:
            meant = f"{most:g} {quantity.shown}"
            remedy = f"if {quantity.shown} was meant, write torsional.units.read('{meant}', '{quantity.name}')"
            told = f"this is far above {limit:.4g} {quantity.unit}, beyond which no such model goes"
            raise ModelError(told, where=where, found=f"{most:g} {quantity.unit}", remedy=remedy)


def _highest_speed(model: Any) -> float:
    """The highest speed [rad/s] that a model says of itself; infinite where it says nothing."""
    engine = getattr(model, "engine", None)
    told = [float(np.max(engine.full_load.speeds))] if engine is not None and engine.full_load is not None else []
    if "operation" in getattr(model, "document", ()):
        told.append(float(model.operation.speed[1]))
    return max(told, default=np.inf)


def _lowest_speed(model: Any) -> float:
    """The lowest speed [rad/s] at which a model runs."""
    return float(model.operation.speed[0])
