"""Dual mass flywheel with straight springs: rows of coil springs with sliding shoes between them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from torsional import checks
from torsional.absorbers.base import Absorber
from torsional.absorbers.spring_design import SpringFlywheel, detailed, fitting, pair, whole
from torsional.absorbers.spring_parts import SAME, CoilSpring
from torsional.absorbers.spring_row import Pair, Row
from torsional.arguments import checked
from torsional.errors import ModelError


@dataclass(frozen=True, kw_only=True)
class StraightSprings(SpringFlywheel):
    """A dual mass flywheel with straight springs as it is designed.

    Inertias, channels, clearances, stop and friction are told by `torsional.absorbers.spring_design.SpringFlywheel`.

    In each channel ``springs_per_row`` N springs ``spring`` with N + 1 shoes of ``shoe_mass`` [kg] and
    ``shoe_width`` [m] (the two at the ends ``end_shoe_mass``, ``end_shoe_width``), half the mass of neighbouring
    springs added.  A shorter ``inner_spring`` in each seat engages later.  What the channel is longer than its row at
    rest is play, spread evenly over the seats and both primary tabs unless ``primary_clearance`` [rad] says theirs,
    (drive, coast).  ``play_factors``: how many times that play, and the other clearances, each channel has (default
    1), as tolerances make them differ.  Springs meet their shoes at the angle ψ of one pitch, so that a shoe is pressed
    outwards by sin(ψ/2) of both forces.
    Raises ModelError for what cannot be built or carries nothing.

    >>> row = {"springs_per_row": 6, "shoe_mass": 0.384, "end_shoe_mass": 0.3, "shoe_width": 0.01}
    >>> row |= {"end_shoe_width": 0.01, "spring": CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02)}
    >>> flywheels = {"primary_inertia": 1.8, "secondary_inertia": 1.0, "stop_angle": 0.75}
    >>> design = StraightSprings(channels=2, radius=0.1, channel_arc=2.516, **row, **flywheels)
    >>> round(design.travel(), 4)  # rad, until the springs are solid
    0.6161
    """

    springs_per_row: int
    spring: CoilSpring
    shoe_mass: float
    end_shoe_mass: float
    shoe_width: float
    end_shoe_width: float
    inner_spring: CoilSpring | None = None
    primary_clearance: Pair | None = None
    play_factors: tuple[float, ...] = ()

    kind: ClassVar[str] = "dual mass flywheel with straight springs"

    def __post_init__(self) -> None:
        super().__post_init__()
        whole(self.springs_per_row, "springs_per_row", 1)
        for name, quantity in (("shoe_mass", "mass"), ("shoe_width", "length")):
            checks.positive(getattr(self, name), name, quantity)
            checks.positive(getattr(self, f"end_{name}"), f"end_{name}", quantity)
        pair(self.primary_clearance or (0.0, 0.0), "primary_clearance")
        for value in self.play_factors:
            checks.positive(value, "play_factors", "ratio")
        if len(self.play_factors) not in (0, self.channels):
            found, allowed = f"{len(self.play_factors)} values", f"none, or {self.channels}, one a channel"
            raise ModelError("there is one factor a channel", where="play_factors", found=found, allowed=allowed)
        if self.inner_spring and self.inner_spring.free_length > self.spring.free_length * (1 + SAME):
            remedy = "the longer of the two is spring, the one that engages later inner_spring"
            raise ModelError("the inner spring is the longer one", where="inner_spring.free_length", remedy=remedy)
        self._check_row()
        self._check_springs()

    def _check_row(self) -> None:
        """The row must fit into its channel: shoes, then solid springs, then free ones unless preload is meant."""
        channel = self.radius * self.channel_arc
        if self._shoes >= channel:
            found, allowed = f"{self.springs_per_row + 1} shoes, {1e3 * self._shoes:.4g} mm", f"{1e3 * channel:.4g} mm"
            remedy = "fewer springs a row, or narrower shoes"
            told = {"found": found, "allowed": allowed, "remedy": remedy}
            raise ModelError("the shoes alone fill the channel", where="springs_per_row", **told)
        solid = self._shoes + self.springs_per_row * self._solid_length
        if solid >= channel:
            found, remedy = f"{1e3 * solid:.4g} mm in a channel of {1e3 * channel:.4g} mm", "fewer or shorter springs"
            problem = "the springs are solid before they carry torque"
            raise ModelError(problem, where="spring.solid_length", found=found, remedy=remedy)
        fitting(self._length, channel, self.preloaded, "spring.free_length")
        given = sum(self.primary_clearance or ())
        if given and self._play < given - SAME:
            found, allowed = f"{math.degrees(given):.4g}° in all", f"at most {math.degrees(self._play):.4g}°"
            raise ModelError("the channel has less play", where="primary_clearance", found=found, allowed=allowed)

    @property
    def _shoes(self) -> float:
        return (self.springs_per_row - 1) * self.shoe_width + 2 * self.end_shoe_width

    @property
    def _length(self) -> float:
        """Length [m] of a row at rest."""
        return self._shoes + self.springs_per_row * self.spring.free_length

    @property
    def _solid_length(self) -> float:
        return max([self.spring.solid_length, *([self.inner_spring.solid_length] if self.inner_spring else [])])

    @property
    def _play(self) -> float:
        """What the channel is longer than the row [rad]; negative with preload."""
        play = self.channel_arc - self._length / self.radius
        return 0.0 if abs(play) < SAME else play

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """One row a channel."""
        factors = self.play_factors or (1.0,) * self.channels
        return tuple(self._row(channel, factor) for channel, factor in enumerate(factors, 1))

    def _row(self, channel: int, factor: float) -> Row:
        tabs, seat = self._clearances()
        gaps, stiffnesses = self._seat(seat * factor)
        half = 0.5 * (self.spring.mass + (self.inner_spring.mass if self.inner_spring else 0.0))
        inner, end = self.shoe_mass + 2 * half, self.end_shoe_mass + half
        count = self.springs_per_row
        return Row(
            f"shoe_{channel}",
            f"spring_{channel}",
            (end, *[inner] * (count - 1), end),
            self.radius,
            gaps,
            stiffnesses,
            (tabs[0] * factor, tabs[1] * factor),
            (self.secondary_clearance[0] * factor, self.secondary_clearance[1] * factor),
            (self._solid_or_free + self.shoe_width) / self.radius,
            ("primary",) * (count + 1),
        )

    @property
    def _solid_or_free(self) -> float:
        """Length [m] of a spring as built in: free, or pressed together by the preload."""
        return self.spring.free_length + min(self._play, 0.0) * self.radius / self.springs_per_row

    def _clearances(self) -> tuple[Pair, float]:
        """Clearances [rad] of the primary's tabs and of each seat."""
        if self._play < 0:
            return (0.0, 0.0), self._play / self.springs_per_row
        even = self._play / (self.springs_per_row + 2)
        tabs = self.primary_clearance or (even, even)
        return tabs, (self._play - sum(tabs)) / self.springs_per_row

    def _seat(self, gap: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Gaps [rad] and stiffnesses k R² [Nm/rad] of the springs of one seat, and of their solid coils."""
        gaps, stiffnesses = [gap], [self.spring.rate * self.radius**2]
        if self.inner_spring:
            later = (self.spring.free_length - self.inner_spring.free_length) / self.radius
            gaps.append(gap + later)
            stiffnesses.append(self.inner_spring.rate * self.radius**2)
        solid = gap + round(self.spring.free_length - self._solid_length, 15) / self.radius
        return (*gaps, solid), (*stiffnesses, self.bind_stiffness)


@checked
def straight_spring_flywheel(design: StraightSprings) -> Absorber:
    """A dual mass flywheel with straight springs in full detail, for time-domain analyses.

    Nodes ``primary``, ``secondary`` and ``shoe_1_1`` … (channel, shoe); springs ``spring_1_1`` …, tabs
    ``shoe_1_primary_drive`` …, friction ``shoe_1_1_guide`` …, and ``dmf``, the end stop, whose angle is the travel.
    For linear and periodic analyses: `condensed_flywheel`.  After Wramner (Chalmers, 2020, §2.2.1 and Paper F).

    >>> row = {"springs_per_row": 6, "shoe_mass": 0.384, "end_shoe_mass": 0.3, "shoe_width": 0.01}
    >>> row |= {"end_shoe_width": 0.01, "spring": CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02)}
    >>> flywheels = {"primary_inertia": 1.8, "secondary_inertia": 1.0, "stop_angle": 0.75}
    >>> design = StraightSprings(channels=2, radius=0.1, channel_arc=2.516, **row, **flywheels)
    >>> round(straight_spring_flywheel(design).components["shoe_1_2"].inertia, 9)
    0.00384
    """
    return detailed(design)
