"""The springs whose travel a report tells."""

from __future__ import annotations

from dataclasses import dataclass

from torsional.laws import Hinges, Law
from torsional.report.analysis import Variant
from torsional.stamps import Connection


@dataclass(frozen=True)
class Spring:
    """A connection with its ``law`` or linear ``stiffness`` [Nm/rad], and its ``stop`` in drive [rad]."""

    name: str
    law: Law | None
    stiffness: float

    @property
    def stop(self) -> float | None:
        """The angle of the first stop in drive; None without one."""
        stops = [angle for angle in self.law.stops if angle > 0] if isinstance(self.law, Hinges) else []
        return min(stops, default=None)

    @property
    def transition(self) -> float | None:
        """The first angle in drive at which another stage begins; None for a spring of one stage."""
        edges = (
            [gap for gap in self.law.gaps if gap > 0 and gap not in self.law.stops]
            if isinstance(self.law, Hinges)
            else []
        )
        return min(edges, default=None)


def springs_of(variant: Variant) -> list[Spring]:
    """The absorber's springs, and the clutch where it has stages or is the only spring."""
    marks = variant.model.landmarks
    stamps = variant.model.powertrain(None).stamps
    known = {s.name: Spring(s.name, s.law, s.stiffness) for s in stamps if isinstance(s, Connection)}
    chosen = [known[name] for name in marks.springs if name in known]
    clutch = known.get(marks.clutch)
    if clutch is not None and clutch not in chosen and (clutch.law is not None or not chosen):
        chosen.append(clutch)
    return chosen
