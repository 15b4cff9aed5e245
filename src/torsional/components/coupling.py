"""Connections with a force law."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from torsional import checks
from torsional.arguments import checked_fields
from torsional.laws import Law
from torsional.stamps import Connection, NormalLoad


@dataclass(frozen=True)
@checked_fields
class Coupling:
    """A force ``law`` between nodes ``a`` and ``b`` on φ = θ_b − θ_a, with viscous ``damping`` c [Nms/rad] beside it.

    Laws that act together are couplings side by side: a friction washer beside a spring is one more.  ``load``: the
    normal load of a friction law that has one.  With ``whole_speed`` law and damper see the whole speed of b over a, as
    a brake to the ground does, instead of the deviation from the mean rotation.

    >>> from torsional.laws import Hinges
    >>> next(Coupling("primary", "secondary", Hinges(13e3), damping=20).stamps("springs")).stiffness
    13000.0
    """

    a: str
    b: str
    law: Law
    damping: float = 0.0
    load: NormalLoad | None = None
    whole_speed: bool = False

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.not_negative(self.damping, "damping", "damping")
        self.law.refuse_unfinished()
        for _ in self.stamps("load"):  # a load that the law cannot take is refused now
            pass

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_b − θ_a; a law without hinges is a plain spring."""
        weights = {self.a: -1.0, self.b: 1.0}
        more: dict[str, Any] = {"load": self.load, "whole_speed": bool(self.whole_speed)}
        rows = self.law.hinges()
        if rows is not None and not rows.gap.size:
            yield Connection(name, weights, rows.stiffness, float(self.damping), **more)
        else:
            yield Connection(name, weights, damping=float(self.damping), law=self.law, **more)
