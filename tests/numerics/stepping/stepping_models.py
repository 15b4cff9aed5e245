"""Small systems as the arrays of time stepping, told in a line each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from tests.numerics.motion.packed import packed_connections, packed_levels, packed_profiles

from torsional.laws import Law
from torsional.numerics.motion.data import Connected, Driven, Equations, Governed, Rows, rows_of

Hinge = tuple[float, float, float, float]  # gap, side, change, contact time


@dataclass(frozen=True)
class Link:
    """One connection along ``row``."""

    row: Sequence[float]
    stiffness: float = 0.0
    damping: float = 0.0
    hinges: Sequence[Hinge] = ()
    law: Law | None = None
    centrifugal: float = 0.0
    follow: float = 0.0
    mean_rate: float = 0.0
    load: tuple[float, float, Sequence[tuple[int, float]]] | None = None  # constant, of Ω², shares of torques
    level: int = -1


@dataclass(frozen=True)
class Push:
    """A torque along ``row``: level over time (knots) and samples over one turn of the angle multiple φ_f + phase."""

    row: Sequence[float]
    level: tuple[Sequence[float], Sequence[float]] = ((0.0,), (1.0,))
    samples: Sequence[float] | None = None
    multiple: float = 1.0
    phase: float = 0.0
    feedback: float = 0.0


@dataclass(frozen=True)
class Crank:
    """A reciprocating mass on ``row``."""

    row: Sequence[float]
    mass: float
    radius: float
    rod: float
    phase: float = 0.0
    included: float = 0.0


def sine(angle: float = 0.0, count: int = 512) -> list[float]:
    """Samples of sin(x + angle)."""
    return np.sin(2 * np.pi * np.arange(count) / count + angle).tolist()


def table(rows: Sequence[Sequence[float]], n: int) -> Rows:
    return rows_of(np.array(rows, dtype=float).reshape(-1, n))


def integers(values: Sequence[int]) -> Any:
    return np.array(values, dtype=np.int64)


def connected(links: Sequence[Link], n: int) -> Connected:
    columns = ("stiffness", "damping", "centrifugal", "follow", "mean_rate")
    loads = [None if link.load is None else (link.load[0], link.level, *link.load[1:]) for link in links]
    return packed_connections(
        table([link.row for link in links], n),
        [[getattr(link, name) for name in columns] for link in links],
        [link.hinges for link in links],
        [link.law for link in links],
        loads,
    )


def driven(pushes: Sequence[Push], cranks: Sequence[Crank], n: int, levels: Sequence[Any] = ()) -> Driven:
    profiles = [(push.samples, 1.0) for push in pushes if push.samples is not None]
    place = iter(range(len(profiles)))
    start, profile, period = packed_profiles(profiles)
    level_start, level_time, level_value = packed_levels([*(push.level for push in pushes), *levels])
    return Driven(
        rows=table([push.row for push in pushes], n),
        multiple=np.array([push.multiple for push in pushes], dtype=float),
        phase=np.array([push.phase for push in pushes], dtype=float),
        feedback=np.array([push.feedback for push in pushes], dtype=float),
        profile_of=integers([next(place) if push.samples is not None else -1 for push in pushes]),
        profile_start=start,
        profile=profile,
        period=period,
        level_of=integers(range(len(pushes))),
        level_start=level_start,
        level_time=level_time,
        level_value=level_value,
        crank_rows=table([crank.row for crank in cranks], n),
        crank_multiple=np.ones(len(cranks)),
        crank_phase=np.array([crank.phase for crank in cranks], dtype=float),
        crank_mass=np.array([crank.mass for crank in cranks], dtype=float),
        crank_radius=np.array([crank.radius for crank in cranks], dtype=float),
        crank_rod=np.array([crank.rod for crank in cranks], dtype=float),
        crank_offset=np.zeros(len(cranks)),
        crank_included=np.array([crank.included for crank in cranks], dtype=float),
    )


def ungoverned(n: int) -> Governed:
    none, nothing, places = table([], n), np.zeros(0), integers([])
    return Governed(none, none, places, nothing, nothing, nothing, nothing, integers([0]), places)


def equations(
    inertia: Sequence[float],
    links: Sequence[Link],
    pushes: Sequence[Push] = (),
    cranks: Sequence[Crank] = (),
    *,
    speed: float = 1.0,
    reference_time: float = np.inf,
    mass_rows: Sequence[Sequence[float]] | None = None,
    governed: Governed | None = None,
    levels: Sequence[Any] = (),
) -> Equations:
    """The arrays of a system whose frame turns at ``speed``; the first coordinate is the reference."""
    n = len(mass_rows[0]) if mass_rows is not None else len(inertia)
    return Equations(
        coordinates=n,
        mass_rows=table(np.eye(n) if mass_rows is None else mass_rows, n),
        inertia=np.array(inertia, dtype=float),
        connected=connected(links, n),
        driven=driven(pushes, cranks, n, levels),
        governed=ungoverned(n) if governed is None else governed,
        reference=table(np.eye(1, n), n),
        reference_time=reference_time,
        frame_time=np.zeros(1),
        frame_value=np.array([float(speed)]),
    )
