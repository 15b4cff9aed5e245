"""Values as they are typed: a plain number is in the unit that the help of its option names."""

from __future__ import annotations

from torsional import units
from torsional.units import QUANTITIES

_UNITS = {"angular_velocity": "deg/s"}
"""Units of options where it is not the one in which the quantity is shown."""


def unit_of(quantity: str) -> str:
    """The unit of a plain number: rpm, deg, deg/s, Nm, s.

    >>> unit_of("speed"), unit_of("relative_angle"), unit_of("angular_velocity"), unit_of("torque")
    ('rpm', 'deg', 'deg/s', 'Nm')
    """
    return _UNITS.get(quantity, QUANTITIES[quantity].shown)


def with_unit(text: str, quantity: str) -> str:
    """The text with its unit written out, where it ends with a bare number.

    >>> with_unit("600:2000", "speed"), with_unit("600:2000 1/min", "speed"), with_unit("3", "engine_order")
    ('600:2000 rpm', '600:2000 1/min', '3')
    >>> with_unit("900 rad/s²", "acceleration")
    '900 rad/s²'
    """
    unit = unit_of(quantity)
    bare = text.rstrip()
    written = unit == "-" or not (bare[-1:].isdecimal() or bare[-1:] == ".") or bare.endswith(("-1", "s2"))
    return text if written else f"{bare} {unit}"


def read(text: str, quantity: str, option: str) -> float:
    """A value [SI]; ModelError for anything but a number with a unit of the right kind or none."""
    return units.read(with_unit(text, quantity), quantity, where=option)


def read_range(text: str, quantity: str, option: str) -> tuple[float, ...]:
    """The ends of a range, and its step where it has one [SI]."""
    return units.read_range(with_unit(text, quantity), quantity, where=option)
