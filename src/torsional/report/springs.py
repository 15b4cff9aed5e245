"""The springs whose travel a report tells."""

from __future__ import annotations

from dataclasses import dataclass

from torsional.laws import Law
from torsional.report.analysis import Variant
from torsional.stamps import Connection


@dataclass(frozen=True)
class Spring:
    """A connection with its ``law`` or linear ``stiffness`` [Nm/rad], the law of the ``friction`` beside it."""

    name: str
    law: Law | None
    stiffness: float
    friction: Law | None = None

    @property
    def stop(self) -> float | None:
        """The angle of the first stop in drive; None without one."""
        stops = () if self.law is None else self.law.stops
        return min((angle for angle in stops if angle > 0), default=None)

    @property
    def transition(self) -> float | None:
        """The first angle in drive at which another stage begins; None for a spring of one stage."""
        edges = () if self.law is None else self.law.transitions
        return min((angle for angle in edges if angle > 0), default=None)


def springs_of(variant: Variant) -> list[Spring]:
    """The absorber's springs, and the clutch where it has stages or friction or is the only spring."""
    marks = variant.model.landmarks
    stamps = variant.model.powertrain(None).stamps
    found = {s.name: s for s in stamps if isinstance(s, Connection)}
    rubbing = {name: found[f"{name}_friction"].law for name in found if f"{name}_friction" in found}
    known = {name: Spring(name, s.law, s.stiffness, rubbing.get(name)) for name, s in found.items()}
    chosen = [known[name] for name in marks.springs if name in known]
    clutch = known.get(marks.clutch)
    if clutch is not None and clutch not in chosen and (clutch.law or clutch.friction or not chosen):
        chosen.append(clutch)
    return chosen
