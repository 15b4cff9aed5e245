"""From a system and its drives to the arrays that are stepped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import Equations, rows_of
from torsional.numerics.stepping.plan import Plan, prepare
from torsional.solvers.transient.acting import Acting, Drive, assembled, row_of
from torsional.solvers.transient.arrays import connected, masses, with_pendulums
from torsional.solvers.transient.drags import dragged
from torsional.solvers.transient.drives import all_acting, held
from torsional.solvers.transient.profiles import Level, level_of
from torsional.solvers.transient.speed_profile import SpeedProfile, as_speed
from torsional.solvers.transient.starts import grounded
from torsional.system import System

Drives = Drive | Excitation | Sequence[Drive | Excitation]
Levels = Mapping[str, tuple[ArrayLike, ArrayLike]]
COUNTS = 1e-9
"""Share of the largest harmonic from which one counts for the period."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A ``system`` under what acts on it, its frame turning at ``speed``; ``levels`` by name over time.

    The friction that drives bring along stands behind the connections of the ``line`` itself.
    """

    system: System
    acting: Acting
    speed: SpeedProfile
    hold: str = ""
    levels: Mapping[str, Level] | None = None
    reference: str = ""
    reference_time: float = np.inf
    line: System | None = None

    @classmethod
    def of(
        cls,
        system: System,
        drives: Drives,
        speed: float | SpeedProfile | None,
        *,
        hold: str = "",
        levels: Levels | None = None,
        reference: str = "",
        reference_time: float = np.inf,
    ) -> Problem:
        """What the arguments of `transient` mean."""
        if not reference_time > 0:
            found, allowed = f"{reference_time:g} s", "a time above zero, or infinite"
            raise ModelError("nothing follows so fast", where="reference_time", found=found, allowed=allowed)
        profile = as_speed(_only_speed(drives) if speed is None else speed)
        if hold and grounded(system):  # springs to the ground carry the mean, as in periodic motion
            system.node_index(hold)
            hold = ""
        acting = held(all_acting(drives, system, profile), system, hold)
        given = {name: level_of(*knots, f"levels.{name}") for name, knots in (levels or {}).items()}
        return cls(dragged(system, acting.drags), acting, profile, hold, given, reference, reference_time, system)

    @property
    def line_hash(self) -> str:
        """What tells the line from every other, whatever drives it."""
        return (self.line or self.system).hash

    @cached_property
    def start_speed(self) -> float:
        """Mean speed at the time zero [rad/s]."""
        return float(self.speed.at(0.0))

    @cached_property
    def reference_node(self) -> str:
        """The node whose speed counts for centrifugal forces: the one asked for, or the first at engine speed."""
        if self.reference:
            return self.system.nodes[self.system.node_index(self.reference)]
        return self.system.nodes[int(np.argmin(np.abs(self.system.speed_ratio - 1.0)))]

    @cached_property
    def equations(self) -> Equations:
        """The arrays of all that moves."""
        system, count = self.system, len(self.system.coordinates)
        driven, governed, places = assembled(self.acting, count, self.levels)
        mass_rows, inertia = masses(system, self.start_speed)
        row = row_of(system, self.reference_node)
        ratio = float(row.sum())
        frame = self.speed.level
        return Equations(
            coordinates=count,
            mass_rows=mass_rows,
            inertia=inertia,
            connected=connected(system, places),
            driven=with_pendulums(driven, system),
            governed=governed,
            reference=rows_of((row / ratio if ratio else row)[None]),
            reference_time=self.reference_time,
            frame_time=frame.time,
            frame_value=frame.value,
        )

    @cached_property
    def plan(self) -> Plan:
        """What all steps share, worked out once."""
        return prepare(self.equations)

    @cached_property
    def base_order(self) -> float:
        """The largest order of which all that the drives have is made; 0 without any."""
        found = 0
        for source in self.acting.sources:
            if source.profile is None:
                continue
            size = np.abs(np.fft.rfft(source.profile.coefficients[:, 0]))
            counts = np.flatnonzero(size[1:] > COUNTS * size[1:].max(initial=0.0)) + 1
            orders = np.round(2 * counts / source.profile.period).astype(int)
            found = int(np.gcd.reduce(np.append(orders, found)))
        return found / 2 if not self.acting.cranks else 0.5


def _only_speed(drives: Drives) -> float:
    """The one speed that the drives say; raises ModelError for none and for several."""
    listed = drives if isinstance(drives, Sequence) else (drives,)
    said = {float(v) for drive in listed for v in np.atleast_1d(_speed_of(drive))}
    if len(said) != 1:
        found = ", ".join(f"{v:g}" for v in sorted(said)[:6]) or "none"
        raise ModelError("the mean speed is missing", where="speed", found=found, remedy="say speed= in rad/s")
    return said.pop()


def _speed_of(drive: object) -> Array:
    told = getattr(getattr(drive, "excitation", drive), "speed", np.zeros(0))
    return np.asarray(told, dtype=float).ravel()
