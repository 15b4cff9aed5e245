"""Units as engineers type them: a value becomes SI and radians here, or a sentence says why it cannot.

The table is our own, since a general unit library reads "Nm" as nanometres and loses the 2π of "1500 1/min".
"""

from __future__ import annotations

import difflib
import math
import numbers
import re

from torsional.errors import ModelError, nearest
from torsional.nomenclature import CANONICAL, QUANTITIES, UNITS, Quantity, pretty

__all__ = [
    "GRAVITY",
    "QUANTITIES",
    "RPM",
    "UNITS",
    "Quantity",
    "convert",
    "plausible",
    "quoted",
    "read",
    "read_range",
    "show",
    "show_speed",
    "unit_factor",
]

RPM = math.pi / 30
"""One revolution per minute in rad/s: ``1500 * RPM`` is a speed, and ``speed / RPM`` a number of rpm."""

GRAVITY = 9.80665
"""Standard acceleration of free fall [m/s²]."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_LONGEST = 120
_RANGE_POINTS = 1_000_000
_TIDIED = str.maketrans({"−": "-", "–": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " ", "μ": "µ", "º": "°"})
_DOTS = str.maketrans({"⋅": "·", "∙": "·", "•": "·", "*": "·", " ": "·", "²": "2", "³": "3"})


def _unit_key(text: str) -> str:
    """A typed unit in the spelling of the table: dots, blanks, stars and powers brought to one form."""
    key = text.strip().replace("**", "").replace("^", "").replace("⁻¹", "-1").translate(_TIDIED).translate(_DOTS)
    return re.sub(r"·*/·*", "/", re.sub(r"·+", "·", key))


def quoted(value: object) -> str:
    """What was found, safe to print: quoted, escaped and cut to 60 characters.

    >>> quoted("25 kNm/furlong")
    "'25 kNm/furlong'"
    """
    text = repr(value[:80] if isinstance(value, str) else value)
    return text if len(text) <= 60 else text[:57] + "..."


def _quantity(name: str) -> Quantity:
    if name not in QUANTITIES:
        raise ModelError(f"{quoted(name)} is no quantity of the nomenclature", remedy=nearest(name, QUANTITIES))
    return QUANTITIES[name]


def _article(noun: str) -> str:
    return ("an " if noun[0] in "aeio" else "a ") + noun


def _allowed(kind: str) -> str:
    """The units of a kind, one spelling of each, and never more than twelve."""
    one = {factor: unit for unit, factor in reversed(CANONICAL[kind].items())}
    return ", ".join([pretty(unit) for unit, factor in CANONICAL[kind].items() if one[factor] == unit][:12])


def _factor(unit: str, kind: str, where: str, found: object) -> float:
    """The factor to SI of a typed unit, or the error that says what kind of unit it is instead."""
    key = _unit_key(unit)
    if key in UNITS[kind]:
        return UNITS[kind][key]
    owners = [_article(owner) for owner, table in UNITS.items() if key in table]
    if owners:
        problem, remedy = f"{unit.strip()} is {' or '.join(owners)}, and {_article(kind)} is wanted", ""
    else:
        problem, remedy = f"the unit {quoted(unit.strip())} is unknown", _nearest_unit(key, kind)
    raise ModelError(problem, where=where, found=quoted(found), allowed=_allowed(kind), remedy=remedy)


def _nearest_unit(key: str, kind: str) -> str:
    """The nearest unit whatever its case, looked for among the wanted kind first."""
    for table in (CANONICAL[kind], {unit: 1.0 for units in CANONICAL.values() for unit in units}):
        folded = {unit.replace("·", "").casefold(): unit for unit in table}
        close = difflib.get_close_matches(key[:40].replace("·", "").casefold(), folded, n=1, cutoff=0.6)
        if close:
            return f"did you mean '{pretty(folded[close[0]])}'?"
    return ""


def _no_number(text: str) -> str:
    """The sentence for a text that does not begin with a number or goes on as no number may."""
    if re.match(r"[+-]?[0-9.]*,[0-9]", text):
        return "a comma is neither a decimal point nor a thousands separator here; write 1.5 or 1500"
    if re.match(r"[+-]?[0-9]+_", text):
        return "digits are not grouped by underscores; write 1500"
    if re.match(r"[+-]?[0-9.]+\s+[0-9]", text):
        return "digits are not grouped by blanks; write 1500"
    if re.match(r"[+-]?0[xob]", text, re.IGNORECASE):
        return "numbers are decimal; hexadecimal, octal and binary ones are not read"
    if re.match(r"[+-]?[0-9.]+\s*(-|\.\.)\s*[0-9]", text):
        return "one number is wanted; a range, where one may stand, is written 600:2000"
    if re.match(r"[+-]?[0-9.]+[ ]*:", text):
        return "one number is wanted, not a clock time or a range"
    if re.match(r"[+-]?\.?(nan|inf)", text, re.IGNORECASE):
        return "a finite number is wanted"
    return "a number is wanted, with or without a unit after it"


def _split(text: str, where: str) -> tuple[float, str]:
    """The number and the unit of a text such as ``25 kNm/rad``; [ModelError] if the number's grammar is broken."""
    tidy = text.translate(_TIDIED).strip()
    matched = _NUMBER.match(tidy) if len(tidy) <= _LONGEST else None
    rest = tidy[matched.end() :] if matched else ""
    glued = re.match(r"[0-9_.,:]|x[0-9a-f]|o[0-7]|b[01]|\s+[0-9](?!/)|\s*-\s*[0-9]", rest, re.IGNORECASE)
    if matched is None or glued:
        raise ModelError(_no_number(tidy), where=where, found=quoted(text))
    return float(matched[0]), rest


def _finite(value: float, where: str, found: object) -> float:
    if not math.isfinite(value):
        raise ModelError("a finite number is wanted", where=where, found=quoted(found))
    return value


def read(value: object, quantity: str, where: str = "") -> float:
    """A value of a file or a call in SI: a plain number is SI already, a text may carry a unit.

    ``quantity`` is a name of the nomenclature; ``where`` is put into the ModelError raised for anything but a finite
    number with a unit of the right kind.

    >>> read("25 kNm/rad", "stiffness"), read(0.3, "inertia")
    (25000.0, 0.3)
    >>> f"{read('1500 1/min', 'speed'):.8f}"
    '157.07963268'
    """
    kind = _quantity(quantity).kind
    if isinstance(value, str):
        number, unit = _split(value, where)
        factor = _factor(unit, kind, where, value) if unit.strip() else 1.0
        return _finite(number * factor, where, value)
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        wanted = f"{_article(kind)} is wanted: a number, or a text such as '1.5 {_quantity(quantity).shown}'"
        raise ModelError(wanted.replace(" -'", "'"), where=where, found=f"{quoted(value)} ({type(value).__name__})")
    try:
        return _finite(float(value), where, value)
    except OverflowError:
        raise ModelError("a number this large is not read", where=where) from None


def unit_factor(unit: str, kind: str) -> float | None:
    """The factor to SI of a unit of that kind, in capitals or not, as headers of measurements have it; None: no unit.

    >>> unit_factor("BAR", "pressure"), unit_factor("s", "pressure")
    (100000.0, None)
    """
    key = _unit_key(unit)
    if key in UNITS[kind]:
        return UNITS[kind][key]
    return next((factor for known, factor in UNITS[kind].items() if known.casefold() == key.casefold()), None)


def convert(value: float, from_unit: str, to_unit: str) -> float:
    """The same value in another unit of the same kind.

    >>> convert(50.0, "Hz", "rpm")
    3000.0
    """
    old, new = _unit_key(from_unit), _unit_key(to_unit)
    for table in UNITS.values():
        if old in table and new in table:
            return value * (table[old] / table[new])
    raise ModelError(f"{quoted(from_unit)} cannot be converted to {quoted(to_unit)}")


def show(value: float, quantity: str, unit: str | None = None) -> str:
    """An SI value as a face writes it: five significant digits in the unit engineers expect, or in ``unit``.

    >>> show(25e3, "stiffness"), show(157.07963, "speed"), show(0.02, "relative_angle", "mrad")
    ('25 kNm/rad', '1500 rpm', '20 mrad')
    """
    described = _quantity(quantity)
    chosen = described.shown if unit is None else unit
    number = value / _factor(chosen, described.kind, "", chosen)
    text = f"{number + 0.0:.5g}" if not 1e5 <= abs(number) < 1e9 else f"{number:.0f}"
    return text if chosen == "-" else f"{text} {chosen}"


def show_speed(speed: float) -> str:
    """A speed [rad/s] in a message, in rpm too, as which most are written.

    >>> show_speed(62.8)
    '62.8 rad/s (599.7 rpm)'
    """
    return f"{speed:g} rad/s ({show(speed, 'speed')})"


def read_range(value: object, quantity: str, where: str = "") -> tuple[float, ...]:
    """A range (start, stop) or (start, stop, step) in SI from ``600:2000:20 rpm`` or from a list of two or three.

    The unit after the last number holds for those that have none.  ModelError if the range is empty, runs backwards or
    has more than a million points.

    >>> [round(speed, 3) for speed in read_range("600:2000 rpm", "speed")]
    [62.832, 209.44]
    """
    if isinstance(value, str):
        parts: list[object] = [*_parts(value, where)]
    else:
        parts = list(value) if isinstance(value, list | tuple) else [value]
    if len(parts) not in (2, 3):
        shape = "'600:2000 rpm', '600:2000:20 rpm' or a list of two or three values"
        raise ModelError("a range is wanted", where=where, found=quoted(value), allowed=shape)
    return _checked_range(tuple(read(part, quantity, where) for part in parts), where, value)


def _parts(text: str, where: str) -> list[str]:
    """The parts of a typed range, each with its unit."""
    parts = text[: 3 * _LONGEST].split(":")
    unit = _split(parts[-1], where)[1] if len(parts) > 1 else ""
    return [part if _split(part, where)[1].strip() else part + " " + unit for part in parts]


def _checked_range(bounds: tuple[float, ...], where: str, found: object) -> tuple[float, ...]:
    start, stop, *step = bounds
    if not start < stop:
        raise ModelError("a range must end above its start", where=where, found=quoted(found))
    if step and not 0 < step[0] <= stop - start:
        raise ModelError("the step of a range must be positive and no longer than it", where=where, found=quoted(found))
    if step and (stop - start) / step[0] > _RANGE_POINTS:
        raise ModelError(f"a range may have {_RANGE_POINTS} points at most", where=where, found=quoted(found))
    return bounds


def plausible(value: float, quantity: str) -> tuple[str, ...]:
    """Warnings, as sentences, for a value [SI] no powertrain is likely to have; none if it looks right.

    Units in which the bare number would look right are named: degrees (57.3), rpm (9.55), g·mm² (1e9).

    >>> plausible(2100.0, "speed")[0]
    "2100 rad/s is unusual for a mean engine speed (5 to 800 rad/s); if rpm or deg/s was meant, write '2100 rpm'"
    """
    described, size = _quantity(quantity), abs(value)
    low, high = described.low, described.high
    if size == 0.0 or low <= size <= high:
        return ()
    table = CANONICAL[described.kind]
    first = {factor: pretty(unit) for unit, factor in reversed(table.items())}
    factors = dict.fromkeys([UNITS[described.kind][_unit_key(described.shown)], *table.values()])
    meant = [first[factor] for factor in factors if low <= size * factor <= high]
    number, unit = f"{value:.6g}", described.unit.replace("-", "").strip()
    span = f"{low:g} to {high:g} {unit}".strip()
    told = f"{number} {unit}".strip() + f" is unusual for {_article(described.long_name)} ({span})"
    hint = f"; if {' or '.join(meant[:3])} was meant, write '{number} {meant[0]}'" if meant else ""
    return (told + hint,)
