"""Checks of single values, in one wording; the messages name the field and its unit."""

from __future__ import annotations

import math
from numbers import Real

from torsional.errors import ModelError
from torsional.units import QUANTITIES, quoted


def number(value: object, field: str) -> float:
    """The value as a finite float, or a ModelError that names the field."""
    if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
        raise ModelError("a finite number is wanted", where=field, found=quoted(value))
    return float(value)


def positive(value: object, field: str, quantity: str) -> float:
    """A number above zero of a ``quantity`` of the nomenclature, or of a unit where that has none such."""
    checked = number(value, field)
    if checked <= 0:
        raise ModelError("must be positive", where=field, found=f"{checked:g}", allowed=_in(quantity, "> 0"))
    return checked


def not_negative(value: object, field: str, quantity: str) -> float:
    """A number of zero or above."""
    checked = number(value, field)
    if checked < 0:
        raise ModelError("must not be negative", where=field, found=f"{checked:g}", allowed=_in(quantity, ">= 0"))
    return checked


def nonzero(value: object, field: str, quantity: str) -> float:
    """A number other than zero."""
    checked = number(value, field)
    if checked == 0:
        raise ModelError("must not be zero", where=field, found=f"{checked:g}", allowed="any other number")
    return checked


def within(value: object, low: float, high: float, field: str, quantity: str) -> float:
    """A number from ``low`` to ``high``.

    >>> within(18.1, 2.0, 40.0, "compression_ratio", "ratio")
    18.1
    """
    checked = number(value, field)
    if not low <= checked <= high:
        allowed = _in(quantity, f"{low:g} to {high:g}")
        raise ModelError("is out of range", where=field, found=_in(quantity, f"{checked:g}"), allowed=allowed)
    return checked


def distinct(a: str, b: str) -> None:
    """Refuse a connection of a node with itself."""
    if a == b:
        raise ModelError("connects a node with itself", where="a, b", found=repr(a), remedy="name two different nodes")


def _in(quantity: str, text: str) -> str:
    """A text with the unit behind it."""
    unit = QUANTITIES[quantity].unit if quantity in QUANTITIES else quantity
    return f"{text} {unit}".removesuffix("-").rstrip()
