"""Friction linings that stick or slip between two plates, pressed by a force that may follow a level over time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from torsional import checks
from torsional.arguments import checked, checked_fields
from torsional.errors import ModelError
from torsional.laws import LuGre
from torsional.stamps import Connection, NormalLoad


@dataclass(frozen=True)
@checked_fields
class SlipClutch:
    """Linings between ``a`` and ``b`` that carry μ(v) N z R: force ``clamp_force`` N, ``surfaces`` z, ``radius`` R.

    ``friction`` μ of sliding, ``breakaway`` μ of sticking over it (1: no drop, so that no judder is made), between them
    the drop of ``stribeck_rate`` [rad/s]; ``stiffness`` [Nm/rad] of the linings at full force, while they stick.  N is
    multiplied by the ``level`` over time of that name: a clutch that engages.  With ``whole_speed`` it rubs against the
    whole speed, as a brake from the ground does.  The law is `LuGre`.
    R of a ring is 2/3 (r_o³ − r_i³)/(r_o² − r_i²) at even pressure, see `mean_radius`.  Raises ModelError for values
    that are not positive, and for a breakaway below one.

    >>> SlipClutch("disc", "cover", clamp_force=20e3, radius=0.18, level="clutch").capacity
    2520.0
    """

    a: str
    b: str
    clamp_force: float
    radius: float
    friction: float = 0.35
    surfaces: int = 2
    breakaway: float = 1.1
    stribeck_rate: float = 1.0
    stiffness: float = 1e6
    damping: float = 100.0
    level: str = ""
    whole_speed: bool = False

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.positive(self.clamp_force, "clamp_force", "force")
        checks.positive(self.radius, "radius", "length")
        checks.positive(self.friction, "friction", "friction_coefficient")
        checks.positive(self.surfaces, "surfaces", "number")
        checks.positive(self.stribeck_rate, "stribeck_rate", "speed")
        checks.positive(self.stiffness, "stiffness", "stiffness")
        checks.not_negative(self.damping, "damping", "damping")
        if not checks.number(self.breakaway, "breakaway") >= 1:
            raise ModelError("sticking carries no less than sliding", where="breakaway", found=f"{self.breakaway:g}")

    @classmethod
    @checked
    def of_capacity(cls, a: str, b: str, capacity: float, **values: float | str) -> SlipClutch:
        """Linings of a known ``capacity`` [Nm], sliding and fully pressed, however it is made.

        >>> SlipClutch.of_capacity("disc", "cover", 3500.0).capacity
        3500.0
        """
        checks.positive(capacity, "capacity", "torque")
        return cls(a, b, clamp_force=float(capacity), radius=1.0, friction=1.0, surfaces=1, **values)  # type: ignore[arg-type]

    @property
    def capacity(self) -> float:
        """Torque [Nm] while it slides, fully pressed."""
        return self.friction * self.clamp_force * self.surfaces * self.radius

    @property
    def law(self) -> LuGre:
        """The friction of one newton of clamp force."""
        sliding = self.friction * self.surfaces * self.radius
        own = {"sliding_torque": sliding, "breakaway_torque": self.breakaway * sliding}
        stiff = {
            "bristle_stiffness": self.stiffness / self.clamp_force,
            "bristle_damping": self.damping / self.clamp_force,
        }
        return LuGre(**stiff, **own, stribeck_rate=self.stribeck_rate)

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_b − θ_a."""
        load = NormalLoad(self.clamp_force, level=self.level)
        weights = {self.a: -1.0, self.b: 1.0}
        yield Connection(name, weights, law=self.law, load=load, whole_speed=self.whole_speed)


def mean_radius(outer: float, inner: float) -> float:
    """Radius R [m] at which the friction of a ring under even pressure acts, 2/3 (r_o³ − r_i³)/(r_o² − r_i²).

    >>> round(mean_radius(0.2, 0.1), 6)
    0.155556
    """
    if not 0 <= inner < outer or not math.isfinite(outer):
        raise ModelError("the outer radius must be the larger", where="outer", found=f"{outer:g} m over {inner:g} m")
    return 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2)
