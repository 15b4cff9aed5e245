"""Arrays of time stepping from a few dense numbers, for tests."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from tests.numerics.motion.packed import packed_connections, packed_levels, packed_profiles

from torsional.numerics.motion.data import Connected, Driven, Equations, Governed, rows_of


@dataclass
class Connection:
    """One connection: its row, spring, damper, hinges (gap, side, Δk, τ), a law and the law's normal load."""

    row: list[float]
    stiffness: float = 0.0
    damping: float = 0.0
    hinges: list[tuple[float, float, float, float]] = field(default_factory=list)
    law: Any = None
    centrifugal: float = 0.0
    follow: float = 0.0
    mean_rate: float = 0.0
    load: tuple[float, int, float] | None = None  # constant, level, centrifugal
    load_of: list[tuple[int, float]] = field(default_factory=list)


@dataclass
class Source:
    """One source: its row, level and profile by number, and how its angle follows the frame."""

    row: list[float]
    level: int = -1
    profile: int = -1
    multiple: float = 1.0
    phase: float = 0.0
    feedback: float = 0.0


@dataclass
class Governor:
    """One governor: what it senses, along what it acts or the sources it adds to, its level, gains and limits."""

    sense: list[float]
    act: list[float]
    wanted: int
    proportional: float
    integral: float
    limit: float = np.inf
    sources: list[int] = field(default_factory=list)


def _floats(values: list[float]) -> np.ndarray:
    return np.array(values, dtype=float)


def _ints(values: list[int]) -> np.ndarray:
    return np.array(values, dtype=np.int64)


def _starts(lists: list[list[Any]]) -> np.ndarray:
    return np.cumsum([0, *map(len, lists)]).astype(np.int64)


def _rows(rows: list[list[float]], size: int) -> Any:
    return rows_of(np.reshape(_floats([x for row in rows for x in row]), (len(rows), size)))


def connected(parts: list[Connection], size: int) -> Connected:
    """Connections as arrays over ``size`` coordinates."""
    columns = ("stiffness", "damping", "centrifugal", "follow", "mean_rate")
    return packed_connections(
        _rows([part.row for part in parts], size),
        [[getattr(part, name) for name in columns] for part in parts],
        [part.hinges for part in parts],
        [part.law for part in parts],
        [(*(part.load or (0.0, -1, 0.0)), part.load_of) if part.load or part.load_of else None for part in parts],
    )


def driven(sources: list[Source], levels: Any, profiles: Any, cranks: Any, size: int) -> Driven:
    """Sources as arrays; a crank is its row, multiple, phase, mass, radius, rod, offset, included."""
    profile_start, profile, period = packed_profiles(profiles)
    level_start, time, value = packed_levels(levels)
    pistons = _floats([crank[1:] for crank in cranks]).reshape(-1, 7).T.copy()
    return Driven(
        _rows([source.row for source in sources], size),
        *(_floats([getattr(source, name) for source in sources]) for name in ("multiple", "phase", "feedback")),
        _ints([source.profile for source in sources]), profile_start, profile, period,
        _ints([source.level for source in sources]), level_start, time, value,
        _rows([crank[0] for crank in cranks], size), *pistons,
    )  # fmt: skip


def governed(governors: list[Governor], size: int) -> Governed:
    """Governors as arrays."""
    return Governed(
        _rows([g.sense for g in governors], size),
        _rows([g.act for g in governors], size),
        _ints([g.wanted for g in governors]),
        _floats([g.proportional for g in governors]),
        _floats([g.integral for g in governors]),
        _floats([-g.limit for g in governors]),
        _floats([g.limit for g in governors]),
        _starts([g.sources for g in governors]),
        _ints([s for g in governors for s in g.sources]),
    )


def equations(
    inertia: list[float],
    connections: list[Connection],
    *,
    sources: list[Source] | None = None,
    levels: Any = (),
    profiles: Any = (),
    cranks: Any = (),
    governors: list[Governor] | None = None,
    reference_time: float = np.inf,
    frame: tuple[list[float], list[float]] = ([0.0], [0.0]),
) -> Equations:
    """One inertia a coordinate; the first coordinate is the reference."""
    size = len(inertia)
    return Equations(
        coordinates=size,
        mass_rows=rows_of(np.eye(size)),
        inertia=_floats(inertia),
        connected=connected(connections, size),
        driven=driven(sources or [], levels, profiles, cranks, size),
        governed=governed(governors or [], size),
        reference=rows_of(np.eye(1, size)),
        reference_time=reference_time,
        frame_time=_floats(frame[0]),
        frame_value=_floats(frame[1]),
    )
