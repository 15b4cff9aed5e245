"""Connections with a force law."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from torsional.components import checks
from torsional.errors import ModelError
from torsional.laws import Hinges, Law
from torsional.stamps import Connection


@dataclass(frozen=True)
class Coupling:
    """A force ``law`` between nodes ``a`` and ``b`` on φ = θ_b − θ_a, with viscous ``damping`` c [Nms/rad] beside it.

    Laws that act together are couplings side by side: a friction washer beside a spring is one more.

    >>> from torsional.laws import Hinges
    >>> next(Coupling("primary", "secondary", Hinges(13e3), damping=20).stamps("springs")).stiffness
    13000.0
    """

    a: str
    b: str
    law: Law
    damping: float = 0.0

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        if not isinstance(self.law, Law):
            remedy = "a plain spring is Hinges(stiffness); stages are Hinges.staged([(up to, stiffness), ...])"
            raise ModelError("a force law is wanted", where="law", found=repr(self.law), remedy=remedy)
        checks.not_negative(self.damping, "damping", "damping")

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_b − θ_a; a law without hinges is a plain spring."""
        weights = {self.a: -1.0, self.b: 1.0}
        if isinstance(self.law, Hinges) and not self.law.gaps:
            yield Connection(name, weights, self.law.stiffness, float(self.damping))
        else:
            yield Connection(name, weights, damping=float(self.damping), law=self.law)
