"""What was typed, as values: gears, torques, speeds and orders."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from torsional import units
from torsional.cli import typed
from torsional.cli.failures import complain
from torsional.errors import ModelError, nearest
from torsional.units import QUANTITIES

if TYPE_CHECKING:
    from torsional.model import Model
    from torsional.numerics.arrays import Array


def one_gear(model: Model, text: str) -> str:
    """The gear named, the last one by default; ModelError with the nearest name."""
    found = gears(model, text)
    if len(found) > 1:
        raise ModelError("one gear is wanted here", where="--gear", found=units.quoted(text))
    return found[0]


def gears(model: Model, text: str) -> list[str]:
    """The gears named, separated by commas, or all of them."""
    known = model.gear_names
    if not text:
        return [model.top_gear]
    if text.strip() == "all" and "all" not in known:
        return list(known)
    named = [text] if text in known else [part.strip() for part in text.split(",")]
    for name in named:
        if name not in known:
            remedy = nearest(name, known, listed=False) if model.gears else "this model has no gears: leave --gear out"
            allowed = ", ".join(known) if model.gears else ""
            raise ModelError(f"there is no gear {units.quoted(name)}", where="--gear", allowed=allowed, remedy=remedy)
    return list(dict.fromkeys(named))


def torque(model: Model, text: str, over: Sequence[float] | Array = ()) -> float:
    """One mean engine torque [Nm]; by default the highest of the full-load curve.

    What lies above full load at all speeds ``over`` which it is asked for [rad/s] (none: at any speed) is told.
    """
    if not text:
        return model.typical_torque()
    value = _value(text, "torque", "--torque")
    warn_overload(model, value, over)
    return value


def speed(model: Model, text: str) -> float:
    """One mean engine speed [rad/s]; by default where full load is highest, else the middle of the operating range."""
    if text:
        value = _value(text, "speed", "--speed")
        warn_off_range(model, [value])
        return value
    curve = model.full_load_curve
    if curve is None:
        return float(np.mean(model.operation.speed))
    return float(curve.speeds[int(np.argmax(curve.torques))])


def speeds(model: Model, text: str, count: int) -> Array:
    """Mean engine speeds [rad/s], ``count`` of them where no step is given; by default over the operating range."""
    if not text:
        return model.speeds(count)
    found = _values(text, "speed", "--speed", count)
    warn_off_range(model, found)
    return found


def torques(model: Model, text: str, count: int) -> Array:
    """Mean engine torques [Nm] of a map."""
    if not text:
        return model.torques(count)
    found = _values(text, "torque", "--torque", count)
    warn_overload(model, float(found.max()))
    return found


def warn_off_range(model: Model, speeds: Sequence[float] | Array, where: str = "--speed") -> None:
    """Say that an engine does not run at some of these speeds [rad/s]: neither its curve nor its file knows them."""
    curve = model.full_load_curve
    if "operation" not in model.document and curve is None:
        return
    known = [*model.operation.speed, *(curve.speeds if curve else ())]
    low, high = min(known), max(known)
    beyond = [speed for speed in speeds if not (1 - 1e-9) * low <= speed <= (1 + 1e-9) * high]
    if beyond:
        asked = " and ".join(dict.fromkeys(units.show(end, "speed") for end in (min(beyond), max(beyond))))
        span = " to ".join(units.show(end, "speed") for end in (low, high))
        complain(f"{where}: {asked} is outside the engine's range, {span}", kind="warning")


def warn_overload(model: Model, torque: float, over: Sequence[float] | Array = (), where: str = "--torque") -> None:
    """Say that a mean torque [Nm] lies above full load at each of the speeds [rad/s], or at any where none is named."""
    curve = model.full_load_curve
    if curve is None:
        return
    speeds, torques = np.asarray(curve.speeds), np.asarray(curve.torques)
    low, high = (min(over), max(over)) if len(over) else (speeds[0], speeds[-1])
    inside = torques[(low <= speeds) & (speeds <= high)]
    most = float(np.max([*np.interp([low, high], speeds, torques), *inside]))
    if torque > (1 + 1e-9) * most:
        told = f"is above full load, which is {units.show(most, 'torque')}"
        at = f" at {units.show(over[0], 'speed')}" if len(over) == 1 else " at most"
        complain(f"{where}: {units.show(torque, 'torque')} {told}{at}", kind="warning")


def orders(single: Sequence[str] | None, text: str) -> Array | None:
    """The engine orders asked for, ascending; None for the usual ones."""
    found = [_value(value, "engine_order", "--order") for value in single or ()]
    if text:
        found += [float(n) for n in _values(text, "engine_order", "--orders", 0)]
    if found and min(found) <= 0:
        raise ModelError("an engine order is positive", where="--order", found=f"{min(found):g}")
    return np.unique(np.array(found)) if found else None


def whole(text: str, option: str, least: int, usual: int) -> int:
    """A number of things, at least so many; ``usual`` where none is asked for."""
    if text and not (text.isascii() and text.isdigit() and int(text[:9]) >= least):
        raise ModelError("a whole number is wanted", where=option, found=units.quoted(text), allowed=f">= {least}")
    return int(text[:9]) if text else usual


def checked_values(values: Sequence[float], quantity: str, option: str, text: str) -> None:
    """Refuse what cannot be and doubt what looks like a forgotten unit, as for every other option."""
    for value in values:
        _refuse_backward(value, quantity, option)
    _doubt(values, quantity, option, text)


def affordable(points: int, width: int) -> None:
    """MemoryError for more complex numbers than this machine can hold, rather than an end without a word."""
    try:
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, ValueError, OSError):  # not told by every system
        return
    if 16 * points * width > memory:
        raise MemoryError


def _value(text: str | float, quantity: str, option: str) -> float:
    value = typed.read(str(text), quantity, option)
    _refuse_backward(value, quantity, option)
    _doubt([value], quantity, option, text)
    return value


def _values(text: str, quantity: str, option: str, count: int) -> Array:
    """One value, or those of a range: with its step, else ``count`` evenly spaced (orders: half ones)."""
    if ":" not in text:
        return np.array([_value(text, quantity, option)])
    start, stop, *step = typed.read_range(text, quantity, option)
    _refuse_backward(start, quantity, option)
    _doubt([start, stop], quantity, option, text)
    if not step and count:
        return np.linspace(start, stop, count)
    width = step[0] if step else 0.5
    return np.asarray(start + width * np.arange(int((stop - start) / width * (1 + 1e-12) + 1e-9) + 1))


def _refuse_backward(value: float, quantity: str, option: str) -> None:
    if quantity == "speed" and value < 0:
        raise ModelError("an engine does not turn backwards", where=option, found=units.show(value, "speed"))


def _doubt(values: Sequence[float], quantity: str, option: str, text: str | float) -> None:
    """Say on stderr what looks like a forgotten unit; nothing where one is written."""
    if str(text).rstrip()[-1:].isalpha() or typed.unit_of(quantity) != QUANTITIES[quantity].unit:
        return
    for warning in dict.fromkeys(told for value in values for told in units.plausible(value, quantity)):
        complain(f"{option}: {warning}", kind="warning")
