"""Rigid gears: kinematic conditions between node angles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from torsional import checks
from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.stamps import Constraint, Mass, SpeedSwitch, Stamp


@dataclass(frozen=True)
@checked_fields
class GearPair:
    """Two meshing gears without play: θ_a = i θ_b with ``ratio`` i = speed of ``a`` over speed of ``b`` (≠ 0).

    A negative ratio reverses the sense of rotation.

    >>> next(GearPair("input", "output", ratio=14.94).stamps("first")).weights
    {'input': 1.0, 'output': -14.94}
    """

    a: str
    b: str
    ratio: float

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.nonzero(self.ratio, "ratio", "gear_ratio")

    def stamps(self, name: str) -> Iterator[Constraint]:
        """θ_a − i θ_b = 0."""
        yield Constraint(name, {self.a: 1.0, self.b: -float(self.ratio)})


@dataclass(frozen=True)
@checked_fields
class PlanetaryGear:
    """An epicyclic set by ``standing_ratio`` i0: θ_sun − i0 θ_ring − (1 − i0) θ_carrier = 0 (Willis, 1841).

    i0 = −z_ring/z_sun for the simple set.  ``planet_inertia`` [kgm²] is the spin inertia of all planets together,
    ``planet_ratio`` z_sun/z_planet; the planets' orbiting mass belongs to the carrier's inertia.

    >>> sorted(next(PlanetaryGear("s", "r", "c", standing_ratio=-2.5).stamps("set")).weights.items())
    [('c', -3.5), ('r', 2.5), ('s', 1.0)]
    """

    sun: str
    ring: str
    carrier: str
    standing_ratio: float
    planet_inertia: float = 0.0
    planet_ratio: float = 1.0

    def __post_init__(self) -> None:
        if len({self.sun, self.ring, self.carrier}) < 3:
            raise ModelError("sun, ring and carrier must be three different nodes", where="sun, ring, carrier")
        checks.nonzero(self.standing_ratio, "standing_ratio", "gear_ratio")
        if self.standing_ratio == 1:
            raise ModelError("a standing ratio of 1 leaves the carrier free", where="standing_ratio", found="1")
        checks.not_negative(self.planet_inertia, "planet_inertia", "inertia")
        checks.nonzero(self.planet_ratio, "planet_ratio", "gear_ratio")

    def stamps(self, name: str) -> Iterator[Stamp]:
        """Willis's equation, and the planets' spin θ_c − u (θ_s − θ_c)."""
        i0, u = float(self.standing_ratio), float(self.planet_ratio)
        yield Constraint(name, {self.sun: 1.0, self.ring: -i0, self.carrier: i0 - 1.0})
        if self.planet_inertia:
            yield Mass(f"{name}.planets", {self.carrier: 1.0 + u, self.sun: -u}, float(self.planet_inertia))


@dataclass(frozen=True)
@checked_fields
class Superposition:
    """A gear train by its ratio alone: θ_node = (1 − r) θ_a + r θ_b (the weights of every ideal planetary sum to 1).

    >>> sorted(next(Superposition("out", "a", "b", ratio=0.75).stamps("gear")).weights.items())
    [('a', -0.25), ('b', -0.75), ('out', 1.0)]
    """

    node: str
    a: str
    b: str
    ratio: float

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.distinct(self.node, self.a)
        checks.distinct(self.node, self.b)
        checks.number(self.ratio, "ratio")

    def stamps(self, name: str) -> Iterator[Constraint]:
        """θ_node − (1 − r) θ_a − r θ_b = 0."""
        r = float(self.ratio)
        weights = {self.node: 1.0, self.a: r - 1.0, self.b: -r}
        yield Constraint(name, {node: weight for node, weight in weights.items() if weight})


@dataclass(frozen=True)
@checked_fields
class PlanetSpin:
    """The spin inertia of planet wheels that turn with (1 − g) θ_a + g θ_b; ``inertia`` [kgm²] of all planets.

    ``switch``: another inertia above a speed (Meingaßner, Pflaum, Stahl, SAE 2014-01-2862).

    >>> next(PlanetSpin("primary", "secondary", ratio=2.0, inertia=0.01).stamps("planets")).weights
    {'primary': -1.0, 'secondary': 2.0}
    """

    a: str
    b: str
    ratio: float
    inertia: float
    switch: SpeedSwitch | None = None

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.number(self.ratio, "ratio")
        checks.not_negative(self.inertia, "inertia", "inertia")

    def stamps(self, name: str) -> Iterator[Mass]:
        """½ J ((1 − g) θ̇_a + g θ̇_b)²."""
        g = float(self.ratio)
        if self.inertia or self.switch:
            yield Mass(name, {self.a: 1.0 - g, self.b: g}, float(self.inertia), self.switch)
