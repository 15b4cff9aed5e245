"""Checks of what makes cylinders unequal: deactivation and spread."""

from __future__ import annotations

from torsional.checks import within
from torsional.errors import ModelError


def check_deactivated(deactivated: tuple[int, ...], valves: str, cylinders: int) -> None:
    """Raise ModelError unless the numbers are cylinders, one at least is left, and the valve state is known."""
    if len(set(deactivated)) < len(deactivated) or not set(deactivated) < set(range(1, cylinders + 1)):
        found = ", ".join(str(number) for number in deactivated)
        allowed = f"numbers from 1 to {cylinders}, each once, at least one cylinder left firing"
        raise ModelError("these cylinders cannot be deactivated", where="deactivated", found=found, allowed=allowed)
    if valves not in ("closed", "working"):
        allowed = "'closed' or 'working'"
        raise ModelError("no such valve state", where="deactivated_valves", found=repr(valves), allowed=allowed)


def check_heat_spread(factors: tuple[float, ...], deactivated: tuple[int, ...], cylinders: int) -> None:
    """Raise ModelError unless there is no spread, or a factor a cylinder that leaves one that burns."""
    if factors and len(factors) != cylinders:
        found, allowed = f"{len(factors)} factors", f"{cylinders}, one a cylinder"
        raise ModelError("one factor a cylinder is needed", where="heat_spread", found=found, allowed=allowed)
    for number, factor in enumerate(factors, 1):
        within(factor, 0.0, 3.0, f"heat_spread.{number}", "number")
    if factors and not any(factor for number, factor in enumerate(factors, 1) if number not in deactivated):
        raise ModelError("no cylinder is left that burns", where="heat_spread")
