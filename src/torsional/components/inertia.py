"""Rotating masses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from torsional import checks
from torsional.arguments import checked_fields
from torsional.stamps import Mass


@dataclass(frozen=True)
@checked_fields
class Inertia:
    """A rigid disc of ``inertia`` J [kgm²] on a ``node`` (default: a node of the component's own name).

    Raises ModelError unless J > 0.

    >>> next(Inertia(1.9).stamps("flywheel")).weights
    {'flywheel': 1.0}
    """

    inertia: float
    node: str = ""

    def __post_init__(self) -> None:
        checks.positive(self.inertia, "inertia", "inertia")

    def stamps(self, name: str) -> Iterator[Mass]:
        """½ J θ̇²."""
        yield Mass(name, {self.node or name: 1.0}, float(self.inertia))


@dataclass(frozen=True)
@checked_fields
class Vehicle:
    """The translating ``mass`` [kg] seen at the wheel: J = m r² with ``rolling_radius`` r [m].

    >>> next(Vehicle(mass=40e3, rolling_radius=0.5).stamps("vehicle")).inertia
    10000.0
    """

    mass: float
    rolling_radius: float
    node: str = ""

    def __post_init__(self) -> None:
        checks.positive(self.mass, "mass", "mass")
        checks.positive(self.rolling_radius, "rolling_radius", "length")

    def stamps(self, name: str) -> Iterator[Mass]:
        """½ m r² θ̇²."""
        yield Mass(name, {self.node or name: 1.0}, self.mass * self.rolling_radius**2)
