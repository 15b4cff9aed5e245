"""Friction cones between a gear that is to be engaged and its shaft."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from torsional import checks
from torsional.laws import LuGre
from torsional.stamps import Connection, NormalLoad


@dataclass(frozen=True)
class Synchroniser:
    """Friction of a ``torque`` [Nm], at ``a``, along θ_a − i θ_b: what a `GearPair` of ``ratio`` i holds, this rubs.

    The torque on ``b`` is i times as high.  It follows the ``level`` over time of that name; ``stiffness`` [Nm/rad]
    and ``damping`` [Nms/rad] of cones that stick; sticking they hold no more than sliding.  The law is `LuGre`.

    >>> next(Synchroniser("input", "output", 1.27, 40.0).stamps("cones")).weights
    {'input': 1.0, 'output': -1.27}
    """

    a: str
    b: str
    ratio: float
    torque: float
    stiffness: float = 1e4
    damping: float = 1.0
    level: str = ""

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.nonzero(self.ratio, "ratio", "gear_ratio")
        checks.positive(self.torque, "torque", "torque")
        checks.positive(self.stiffness, "stiffness", "stiffness")
        checks.not_negative(self.damping, "damping", "damping")

    @property
    def law(self) -> LuGre:
        """The friction of one newton metre of capacity."""
        return LuGre(
            bristle_stiffness=self.stiffness / self.torque,
            bristle_damping=self.damping / self.torque,
            sliding_torque=1.0,
            breakaway_torque=1.0,
            stribeck_rate=1.0,
        )

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_a − i θ_b."""
        weights = {self.a: 1.0, self.b: -float(self.ratio)}
        yield Connection(name, weights, law=self.law, load=NormalLoad(self.torque, level=self.level))
