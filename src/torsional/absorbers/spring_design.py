"""The data that dual mass flywheels with straight and with arc springs share, and their frictionless characteristic."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from torsional import checks
from torsional.absorbers.base import Absorber
from torsional.absorbers.dual_mass import dual_mass_flywheel
from torsional.absorbers.spring_curves import Rising, both_ways, pressed, side_by_side
from torsional.absorbers.spring_parts import SAME, GuideFriction
from torsional.absorbers.spring_row import Pair, Row, guided, loads, sprung
from torsional.arguments import checked, checked_fields
from torsional.components import Component, Coupling, Inertia
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges


@dataclass(frozen=True, kw_only=True)
@checked_fields
class SpringFlywheel(ABC):
    """What dual mass flywheels with straight and with arc springs share; SI and radians.

    ``primary_inertia`` and ``secondary_inertia`` [kgm²] without what slides in the channels; ``channels`` of
    ``channel_arc`` [rad] between the primary's tabs, ``radius`` R [m] of the springs' force; ``secondary_clearance``
    [rad] from the flange's tabs to the row at rest, (drive, coast); ``stop_angle`` [rad] between the flywheels and
    ``stop_stiffness`` [Nm/rad]; ``tab_stiffness`` and ``bind_stiffness`` [Nm/rad] of tabs and of solid coils,
    ``contact_time`` [s] of all of these; ``friction`` on the primary's guide, ``grease_damping`` [Nms/rad] of each body
    there; ``preloaded``: springs longer than their channel are meant; ``rated_torque`` [Nm] that must be carried
    before a spring is solid; ``damping`` [Nms/rad] between the flywheels that stands for all friction and grease in
    linear and periodic analyses (default: that of the grease).
    """

    primary_inertia: float
    secondary_inertia: float
    channels: int
    radius: float
    channel_arc: float
    stop_angle: float
    secondary_clearance: Pair = (0.0, 0.0)
    stop_stiffness: float = 2e6
    tab_stiffness: float = 1e6
    bind_stiffness: float = 5e5
    contact_time: float = 2e-5
    friction: GuideFriction | None = None
    grease_damping: float = 0.0
    preloaded: bool = False
    rated_torque: float | None = None
    damping: float | None = None

    kind: ClassVar[str]

    def __post_init__(self) -> None:
        for name in ("primary_inertia", "secondary_inertia"):
            checks.positive(getattr(self, name), name, "inertia")
        checks.positive(self.radius, "radius", "length")
        for name in ("channel_arc", "stop_angle"):
            checks.positive(getattr(self, name), name, "relative_angle")
        for name in ("stop_stiffness", "tab_stiffness", "bind_stiffness"):
            checks.positive(getattr(self, name), name, "stiffness")
        checks.not_negative(self.contact_time, "contact_time", "time")
        checks.not_negative(self.grease_damping, "grease_damping", "damping")
        checks.not_negative(self.damping or 0.0, "damping", "damping")
        whole(self.channels, "channels", 1)
        pair(self.secondary_clearance, "secondary_clearance")
        if self.channels * self.channel_arc > 2 * math.pi * (1 + SAME):
            found = f"{self.channels} of {math.degrees(self.channel_arc):g}°"
            allowed = f"at most {360 / self.channels:g}° each"
            raise ModelError("the channels do not fit on the circle", where="channel_arc", found=found, allowed=allowed)

    @property
    @abstractmethod
    def rows(self) -> tuple[Row, ...]:
        """Every row of bodies and springs."""

    def rubbing(self) -> dict[str, Component]:
        """Friction and grease of every body."""
        parts: dict[str, Component] = {}
        for row in self.rows:
            parts |= guided(row, self.friction, self.grease_damping, loads(row))
        return parts

    def curve(self, coast: bool) -> Rising:
        """Frictionless torque over the angle between the flywheels in one direction, the end stop included."""
        rows = [row.curve(coast, self.tab_stiffness) for row in self.rows]
        return side_by_side([*rows, pressed([self.stop_angle], [self.stop_stiffness])])

    def travel(self, coast: bool = False) -> float:
        """The angle [rad] between the flywheels at which the first spring is solid or the end stop is met."""
        return min([self.stop_angle, *(row.solid(coast, self.tab_stiffness) for row in self.rows)])

    def _check_springs(self) -> None:
        """Refuse springs that carry nothing before a stop, or not what they are rated for."""
        for coast, way in ((False, "driving"), (True, "driven")):
            start, end = float(self.curve(coast).angle[0]), self.travel(coast)
            if start < -SAME:
                found = f"they begin {math.degrees(-start):.3g}° inside"
                remedy = "let the flange's tabs stand back by more: they would share the preload"
                raise ModelError(
                    "the flange presses on both ends at rest", where="secondary_clearance", found=found, remedy=remedy
                )
            if end <= start + SAME:
                found = f"free play of {math.degrees(start):.3g}° {way}, stop at {math.degrees(self.stop_angle):.3g}°"
                raise ModelError("the end stop is met before the springs", where="stop_angle", found=found)
        if self.rated_torque is not None:
            self._check_rating(checks.positive(self.rated_torque, "rated_torque", "torque"))

    def _check_rating(self, rated: float) -> None:
        end = self.travel()
        carried = float(spring_characteristic(self).torque(end))
        if rated > carried * (1 + SAME):
            what = "meet the end stop" if end == self.stop_angle else "are solid"
            raise ModelError(
                f"the springs {what} before the rated torque",
                where="rated_torque",
                found=f"{rated:g} Nm",
                allowed=f"at most {carried:.4g} Nm, at {math.degrees(end):.3g}°",
                remedy="stiffer or longer springs, more way to the stop, or a lower rated torque",
            )


@checked
def spring_characteristic(design: SpringFlywheel) -> Hinges:
    """The frictionless static law between the flywheels: rows side by side, in each tabs and springs in series.

    φ(T) = p + s + 2T/k_t + Σ u(T) with the clearances p, s and the springs' compression u.  Where the first spring is
    solid, or the end stop is met, counts as the stop.

    >>> from torsional.absorbers.spring_parts import CoilSpring
    >>> from torsional.absorbers.straight_spring import StraightSprings
    >>> row = {"springs_per_row": 6, "shoe_mass": 0.384, "end_shoe_mass": 0.3, "shoe_width": 0.01}
    >>> row |= {"end_shoe_width": 0.01, "spring": CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02)}
    >>> flywheels = {"primary_inertia": 1.8, "secondary_inertia": 1.0, "stop_angle": 0.75}
    >>> design = StraightSprings(channels=2, radius=0.1, channel_arc=2.516, **row, **flywheels)
    >>> round(float(spring_characteristic(design).tangent(0.2)), 1)  # Nm/rad: two rows of k r²/6, and their tabs
    3487.8
    """
    return both_ways(design.curve(False), design.curve(True), (-design.travel(True), design.travel()))


def detailed(design: SpringFlywheel) -> Absorber:
    """All its bodies: flywheels, shoes or segments, springs, tabs, friction; ``dmf`` is the end stop between flywheels.

    The angle of ``dmf`` is the travel; the torque on the secondary is that of the end stop and of the tabs
    ``…_secondary_drive``, less that of the tabs ``…_secondary_coast``.
    """
    end = design.stop_angle
    parts: dict[str, Component] = {
        "primary": Inertia(design.primary_inertia),
        "dmf": Coupling(
            "secondary", "primary", Contacts.between(-end, end, design.stop_stiffness, design.contact_time)
        ),
        "secondary": Inertia(design.secondary_inertia),
    }
    for row in design.rows:
        parts |= sprung(row, design.tab_stiffness, design.contact_time)
    return Absorber(design.kind, parts | design.rubbing(), "primary", "secondary", ("dmf",), ("primary", "secondary"))


@checked
def condensed_flywheel(design: SpringFlywheel) -> Absorber:
    """Two bodies [kgm²] with the frictionless characteristic between them, for linear and periodic analyses.

    What slides in the channels turns with the primary.  Its ``detail`` holds the parts that replace it in time.

    >>> from torsional.absorbers.spring_parts import CoilSpring
    >>> from torsional.absorbers.straight_spring import StraightSprings
    >>> row = {"springs_per_row": 6, "shoe_mass": 0.384, "end_shoe_mass": 0.3, "shoe_width": 0.01}
    >>> row |= {"end_shoe_width": 0.01, "spring": CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02)}
    >>> flywheels = {"primary_inertia": 1.8, "secondary_inertia": 1.0, "stop_angle": 0.75}
    >>> design = StraightSprings(channels=2, radius=0.1, channel_arc=2.516, **row, **flywheels)
    >>> round(condensed_flywheel(design).components["primary"].inertia, 6)  # shoes included
    1.8504
    """
    sliding = sum(sum(row.inertias) for row in design.rows)
    grease = sum(row.stretched(design.grease_damping) for row in design.rows)
    plain = dual_mass_flywheel(
        design.primary_inertia + sliding,
        design.secondary_inertia,
        spring_characteristic(design),
        grease if design.damping is None else design.damping,
    )
    return plain.with_detail(detailed(design).components, kind=design.kind)


def whole(value: object, field: str, least: int) -> int:
    """A whole number of at least ``least``, or a ModelError."""
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise ModelError("a whole number is wanted", where=field, found=repr(value), allowed=f"at least {least}")
    return value


def pair(values: Pair, field: str) -> None:
    """Refuse all but two clearances of zero and above."""
    if len(values) != 2:
        raise ModelError("two clearances are wanted", where=field, found=repr(values), allowed="(drive, coast)")
    for value in values:
        if checks.number(value, field) < 0:
            remedy = "springs that press on their tabs at rest are longer than their channel: preloaded"
            found = f"{math.degrees(value):g}°"
            raise ModelError("a clearance must not be negative", where=field, found=found, remedy=remedy)


def fitting(row: float, channel: float, preloaded: bool, where: str) -> None:
    """Refuse rows [m] longer than their channel [m] unless that is meant, and preload where there is none."""
    found = f"{1e3 * row:.4g} mm in a channel of {1e3 * channel:.4g} mm"
    if row > channel * (1 + SAME) and not preloaded:
        remedy = "shorten them, lengthen channel_arc, or say preloaded: true"
        raise ModelError("the springs are longer than their channel", where=where, found=found, remedy=remedy)
    if preloaded and row <= channel * (1 + SAME):
        remedy = "leave preloaded out, or lengthen the springs"
        raise ModelError("the springs are not preloaded: they fit", where="preloaded", found=found, remedy=remedy)
