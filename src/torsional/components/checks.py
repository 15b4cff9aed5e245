"""Checks of component values; the messages name the field."""

from __future__ import annotations

import math

from torsional.errors import ModelError
from torsional.units import QUANTITIES


def number(value: object, field: str, quantity: str) -> float:
    """The value as a finite float, or a ModelError that names the field."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ModelError("must be a finite number", where=field, found=repr(value), allowed=_unit(quantity))
    return float(value)


def positive(value: object, field: str, quantity: str) -> float:
    """A number above zero."""
    checked = number(value, field, quantity)
    if checked <= 0:
        raise ModelError("must be positive", where=field, found=f"{value}", allowed=f"> 0 {_unit(quantity)}")
    return checked


def not_negative(value: object, field: str, quantity: str) -> float:
    """A number of zero or above."""
    checked = number(value, field, quantity)
    if checked < 0:
        raise ModelError("must not be negative", where=field, found=f"{value}", allowed=f">= 0 {_unit(quantity)}")
    return checked


def nonzero(value: object, field: str, quantity: str) -> float:
    """A number other than zero."""
    checked = number(value, field, quantity)
    if checked == 0:
        raise ModelError("must not be zero", where=field, found=f"{value}", allowed="any other number")
    return checked


def distinct(a: str, b: str) -> None:
    """Refuse a connection of a node with itself."""
    if a == b:
        raise ModelError("connects a node with itself", where="a, b", found=repr(a), remedy="name two different nodes")


def _unit(quantity: str) -> str:
    return QUANTITIES[quantity].unit
