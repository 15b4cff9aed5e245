"""Checks of single numbers that name what the user called them."""

from __future__ import annotations

import math

from torsional.errors import ModelError
from torsional.units import show


def finite(value: float, where: str, unit: str = "") -> float:
    """The number itself, refused if it is no finite real number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ModelError("a number is needed", where=where, found=repr(value)) from None
    if not math.isfinite(number):
        raise ModelError("the number must be finite", where=where, found=f"{number:g} {unit}".strip())
    return number


def positive(value: float, where: str, unit: str = "") -> float:
    """The number itself, refused unless it is finite and above zero."""
    if finite(value, where, unit) <= 0:
        raise ModelError("the value must be positive", where=where, found=f"{value:g} {unit}".strip())
    return float(value)


def both(speed: float) -> str:
    """A speed [rad/s] in a message, in rpm too, as which most are written."""
    return f"{speed:g} rad/s ({show(speed, 'speed')})"


def within(value: float, low: float, high: float, where: str, unit: str = "") -> float:
    """The number itself, refused unless low <= number <= high."""
    if not low <= finite(value, where, unit) <= high:
        found, allowed = f"{value:g} {unit}".strip(), f"{low:g} to {high:g} {unit}".strip()
        raise ModelError("the value is out of range", where=where, found=found, allowed=allowed)
    return float(value)
