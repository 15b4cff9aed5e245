"""Dual mass flywheel with arc springs: long curved springs that slide in their channels."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from torsional import checks
from torsional.absorbers.base import Absorber
from torsional.absorbers.spring_design import SpringFlywheel, detailed, fitting, whole
from torsional.absorbers.spring_parts import SAME, CoilSpring, GuideFriction
from torsional.absorbers.spring_row import Row, guided, loads
from torsional.arguments import checked
from torsional.components import Component
from torsional.errors import ModelError

LEAST_SEGMENTS = 6
"""Sections that an arc spring needs at least (Wramner, Chalmers, 2020, §3.2)."""


@dataclass(frozen=True, kw_only=True)
class ArcSprings(SpringFlywheel):
    """A dual mass flywheel with arc springs as it is designed.

    Inertias, channels, clearances, stop and friction are told by `torsional.absorbers.spring_design.SpringFlywheel`.

    In each channel one arc spring ``spring`` of ``segments`` n sections, each with the rate n·k, between n + 1 masses
    that slide on the primary's guide: an n-th of the spring's mass each, half of it at the ends together with an
    ``end_mass`` [kg] (a cap).  A shorter ``inner_spring`` inside it engages later; its masses slide on those of the
    outer spring beside which they lie at rest, with ``inner_friction`` (default: as on the guide), and press them
    outwards too.  What the channel is longer than the spring is play, half at each of the primary's tabs.
    Raises ModelError for what cannot be built or carries nothing.

    >>> spring = CoilSpring(rate=89e3, free_length=0.19, solid_length=0.1, mass=0.49)
    >>> flywheels = {"primary_inertia": 1.1, "secondary_inertia": 1.0, "stop_angle": 0.3}
    >>> ArcSprings(channels=4, radius=0.15, channel_arc=1.3, spring=spring, segments=8, **flywheels).travel()
    0.3
    """

    spring: CoilSpring
    segments: int = 8
    inner_spring: CoilSpring | None = None
    inner_friction: GuideFriction | None = None
    end_mass: float = 0.0

    kind: ClassVar[str] = "dual mass flywheel with arc springs"

    def __post_init__(self) -> None:
        super().__post_init__()
        whole(self.segments, "segments", LEAST_SEGMENTS)
        checks.not_negative(self.end_mass, "end_mass", "mass")
        checks.positive(self.spring.mass, "spring.mass", "mass")
        channel = self.radius * self.channel_arc
        if self.spring.solid_length >= channel:
            found = f"{1e3 * self.spring.solid_length:.4g} mm in a channel of {1e3 * channel:.4g} mm"
            raise ModelError("the springs are solid before they carry torque", where="spring.solid_length", found=found)
        fitting(self.spring.free_length, channel, self.preloaded, "spring.free_length")
        if self.inner_spring:
            checks.positive(self.inner_spring.mass, "inner_spring.mass", "mass")
            if self.inner_spring.free_length > self.spring.free_length * (1 + SAME):
                remedy = "the longer of the two is spring, the one that engages later inner_spring"
                raise ModelError("the inner spring is the longer one", where="inner_spring.free_length", remedy=remedy)
        elif self.inner_friction:
            raise ModelError("inner_friction goes with inner_spring", where="inner_friction")
        self._check_springs()

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """The outer spring of every channel, each followed by the one inside it."""
        springs = {"arc": self.spring} | ({"inner": self.inner_spring} if self.inner_spring else {})
        return tuple(self._row(f"{name}_{c}", s) for c in range(1, self.channels + 1) for name, s in springs.items())

    def _row(self, name: str, spring: CoilSpring) -> Row:
        count = self.segments
        clearance = 0.5 * (self.channel_arc - spring.free_length / self.radius)
        shorter = 0.5 * (self.spring.free_length - spring.free_length) / self.radius
        each = spring.mass / count
        end = 0.5 * each + (self.end_mass if name.startswith("arc") else 0.0)
        return Row(
            name,
            f"{name}_coil",
            (end, *[each] * (count - 1), end),
            self.radius,
            (0.0, spring.travel / count / self.radius),
            (spring.rate * count * self.radius**2, self.bind_stiffness),
            (clearance, clearance),
            (self.secondary_clearance[0] + shorter, self.secondary_clearance[1] + shorter),
            min(spring.free_length / self.radius, self.channel_arc) / count,
            self._guides(name, spring),
            pulls=True,
        )

    def _guides(self, name: str, spring: CoilSpring) -> tuple[str, ...]:
        """What each mass slides on: the primary, or of an inner spring the outer mass beside it at rest."""
        count = self.segments
        if name.startswith("arc"):
            return ("primary",) * (count + 1)
        share = spring.free_length / self.spring.free_length
        beside = [round(count * (0.5 * (1 - share)) + i * share) + 1 for i in range(count + 1)]
        return tuple(f"{name.replace('inner', 'arc')}_{number}" for number in beside)

    def rubbing(self) -> dict[str, Component]:
        """Friction of the outer springs on the guide, of the inner ones on the outer, whose load they add to."""
        parts: dict[str, Component] = {}
        each = 2 if self.inner_spring else 1
        for rows in zip(*(self.rows[i::each] for i in range(each)), strict=True):
            outer, pressed = rows[0], dict(zip(rows[0].bodies, loads(rows[0]), strict=True))
            for inner in rows[1:]:
                for guide, (centrifugal, shares) in zip(inner.guides, loads(inner), strict=True):
                    pressed[guide] = _added(pressed[guide], centrifugal, shares)
                parts |= guided(inner, self.inner_friction or self.friction, 0.0, loads(inner))
            parts |= guided(outer, self.friction, self.grease_damping, list(pressed.values()))
        return parts


def _added(
    load: tuple[float, dict[str, float]], centrifugal: float, shares: dict[str, float]
) -> tuple[float, dict[str, float]]:
    """A load with that of what rides on it."""
    names = {**load[1], **shares}
    return load[0] + centrifugal, {name: load[1].get(name, 0.0) + shares.get(name, 0.0) for name in names}


@checked
def arc_spring_flywheel(design: ArcSprings) -> Absorber:
    """A dual mass flywheel with arc springs in full detail, for time-domain analyses.

    Nodes ``primary``, ``secondary``, ``arc_1_1`` … and ``inner_1_1`` … (channel, mass); sections ``arc_1_coil_1`` …,
    tabs ``arc_1_primary_drive`` …, friction ``arc_1_1_guide`` …, and ``dmf``, the end stop, whose angle is the travel.
    Each mass is pressed by m R Ω² + (F_left + F_right) sin(Δα/2), Δα the angle of one section.  For linear and
    periodic analyses: `condensed_flywheel`.  After Kim, Song, Hwang, Kim (Key Eng. Mat. 326–328 (2006) 1607); Wramner
    (Chalmers, 2020, §3.2).

    >>> spring = CoilSpring(rate=89e3, free_length=0.19, solid_length=0.1, mass=0.49)
    >>> flywheels = {"primary_inertia": 1.1, "secondary_inertia": 1.0, "stop_angle": 0.3}
    >>> design = ArcSprings(channels=4, radius=0.15, channel_arc=1.3, spring=spring, segments=8, **flywheels)
    >>> round(arc_spring_flywheel(design).components["arc_4_2"].inertia, 9)
    0.001378125
    """
    return detailed(design)
