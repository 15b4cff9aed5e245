"""A row of bodies that slide in a channel between the tabs of both flywheels, springs between them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from torsional.absorbers.spring_curves import Rising, against_stop, in_series, pressed
from torsional.absorbers.spring_parts import GuideFriction
from torsional.components import Component, Coupling, Damper, Inertia
from torsional.laws import Contacts, Hinges, Law
from torsional.stamps import NormalLoad

Pair = tuple[float, float]
"""One value while the engine drives and one while it is driven."""


@dataclass(frozen=True)
class Row:
    """One row, its first body at the tab with which the primary drives.

    ``body`` and ``link`` name its bodies and the springs between them; ``masses`` [kg] of the bodies at ``radius``
    [m]; ``gaps`` [rad] and ``stiffnesses`` [Nm/rad] of each spring, one-sided, the last of them its solid coils, or
    the first both ways where it ``pulls``; ``primary`` and ``secondary``: clearances [rad] to the tabs, (drive,
    coast); ``pitch`` [rad] from one spring to the next; ``guides``: what each body slides on.
    """

    body: str
    link: str
    masses: tuple[float, ...]
    radius: float
    gaps: tuple[float, ...]
    stiffnesses: tuple[float, ...]
    primary: Pair
    secondary: Pair
    pitch: float
    guides: tuple[str, ...]
    pulls: bool = False

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the bodies, which are nodes."""
        return tuple(f"{self.body}_{i}" for i in range(1, len(self.masses) + 1))

    @property
    def links(self) -> tuple[str, ...]:
        """Names of the springs, which are connections."""
        return tuple(f"{self.link}_{i}" for i in range(1, len(self.masses)))

    @property
    def inertias(self) -> tuple[float, ...]:
        """J = m R² [kgm²] of each body."""
        return tuple(mass * self.radius**2 for mass in self.masses)

    def spring(self) -> Rising:
        """Torque over compression of one spring."""
        return pressed(self.gaps, self.stiffnesses)

    def curve(self, coast: bool, tab: float) -> Rising:
        """Frictionless torque over the angle between the flywheels in one direction; ``tab`` [Nm/rad] of each tab."""
        ahead, behind = self.primary[coast], self.primary[not coast]
        row = in_series([pressed([ahead], [tab]), *[self.spring()] * len(self.links)])
        return in_series([against_stop(row, behind, tab), pressed([self.secondary[coast]], [tab])])

    def solid(self, coast: bool, tab: float) -> float:
        """The angle [rad] between the flywheels at which the coils touch."""
        at = self.spring().at_angle(pressed([self.gaps[-1]], [1.0]).angle)
        return float(self.curve(coast, tab).at_torque(at)[0])

    def stretched(self, damping: float) -> float:
        """The damper [Nms/rad] between the flywheels that loses what dampers on all bodies lose: Σ c (i/n)².

        They slide evenly, from nothing at one end to the whole travel at the other.
        """
        count = len(self.links)
        return sum(damping * (i / count) ** 2 for i in range(count + 1) if self.guides[i] == "primary")

    def shares(self) -> list[dict[str, float]]:
        """Newtons that each neighbouring spring presses a body with, per Nm: sin(ψ/2)/R, ψ the pitch."""
        share = math.sin(0.5 * self.pitch) / self.radius
        beside = ["", *self.links, ""]
        return [{link: share for link in both if link} for both in pairwise(beside)]


def sprung(row: Row, tab: float, contact_time: float) -> dict[str, Component]:
    """Bodies, springs and tabs (stiffness ``tab`` [Nm/rad], ``contact_time`` [s]) of a row; its friction apart."""
    parts: dict[str, Component] = dict(zip(row.bodies, map(Inertia, row.inertias), strict=True))
    for name, (before, after) in zip(row.links, pairwise(row.bodies), strict=True):
        parts[name] = Coupling(after, before, _spring(row, contact_time))
    first, last = row.bodies[0], row.bodies[-1]
    tabs = {
        "primary_drive": (first, "primary", row.primary[0]),
        "primary_coast": ("primary", last, row.primary[1]),
        "secondary_drive": ("secondary", last, row.secondary[0]),
        "secondary_coast": (first, "secondary", row.secondary[1]),
    }
    for name, (a, b, gap) in tabs.items():
        parts[f"{row.body}_{name}"] = Coupling(a, b, one_sided([gap], [tab], contact_time))
    return parts


def guided(
    row: Row, friction: GuideFriction | None, grease: float, loads: Sequence[tuple[float, Mapping[str, float]]]
) -> dict[str, Component]:
    """Friction and ``grease`` damping [Nms/rad] of each body on its guide.

    ``loads``: centrifugal m R [kg m] and the shares of springs, of each body and of what rides on it.
    """
    parts: dict[str, Component] = {}
    for body, guide, (centrifugal, shares) in zip(row.bodies, row.guides, loads, strict=True):
        if friction:
            load = NormalLoad(centrifugal=centrifugal, shares=shares, carrier="primary")
            parts[f"{body}_guide"] = Coupling(guide, body, friction.law(row.radius), grease, load)
        elif grease:
            parts[f"{body}_guide"] = Damper(guide, body, grease)
    return parts


def loads(row: Row) -> list[tuple[float, dict[str, float]]]:
    """Centrifugal m R [kg m] and shares of springs of each body, by itself."""
    return [(mass * row.radius, shares) for mass, shares in zip(row.masses, row.shares(), strict=True)]


def one_sided(gaps: Sequence[float], stiffnesses: Sequence[float], contact_time: float) -> Contacts:
    """Springs that push only, on the positive side."""
    count = len(gaps)
    return Contacts(tuple(gaps), (1.0,) * count, tuple(stiffnesses), (contact_time,) * count)


def _spring(row: Row, contact_time: float) -> Law:
    if not row.pulls:
        return one_sided(row.gaps, row.stiffnesses, contact_time)
    return Hinges(row.stiffnesses[0], row.gaps[1:], (1.0,) * (len(row.gaps) - 1), row.stiffnesses[1:])
