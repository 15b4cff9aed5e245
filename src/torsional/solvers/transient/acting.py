"""What drives amount to: sources, cranks and governors along rows of the coordinates, put together as arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import LEAK, Driven, Governed, rows_of
from torsional.solvers.transient.drags import Drag
from torsional.solvers.transient.profiles import Level, Profile
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.system import System

_Table = TypeVar("_Table", Profile, Level)


class Source(NamedTuple):
    """A torque along a ``row``: level(t) times profile(angle), the angle being ``multiple`` times that of the frame
    and ``feedback`` times the row's own deviation, plus ``phase``.  ``governed``: a governor may act on its level."""

    row: Array
    profile: Profile | None = None
    level: Level | None = None
    feedback: float = 0.0
    phase: float = 0.0
    multiple: float = 1.0
    governed: bool = False


class Crank(NamedTuple):
    """A reciprocating ``mass`` [kg] on a crank of ``radius``, ``rod``, ``offset`` [m] at a row, as exact kinematics;
    ``included`` [kgm²] of it is in the throw's inertia already."""

    row: Array
    phase: float
    mass: float
    radius: float
    rod: float
    offset: float
    included: float


class Governing(NamedTuple):
    """A governor of the speed along ``sense``: it acts along ``act``, or on the governed sources where that is None."""

    sense: Array
    act: Array | None
    wanted: Level
    proportional: float
    integral: float
    low: float
    high: float


class Leak(NamedTuple):
    """The charge of a cylinder that leaks while it stands, at a ``rate`` [1/s]: the level of its ``source`` is the
    charge less one; ``ratio``: the crankcase's pressure over its own; open from ``opens`` to ``closes`` [rad]."""

    source: Source
    ratio: Profile
    rate: float
    opens: float
    closes: float


class Acting(NamedTuple):
    """All that drives do; ``taken_up``: torques over time (row, level) that belong to the mean load of the line;
    ``drags``: friction that they bring along; ``leaks``: charges of cylinders."""

    sources: tuple[Source, ...] = ()
    cranks: tuple[Crank, ...] = ()
    governors: tuple[Governing, ...] = ()
    taken_up: tuple[tuple[Array, Level], ...] = ()
    drags: tuple[Drag, ...] = ()
    leaks: tuple[Leak, ...] = ()

    def joined(self, other: Acting) -> Acting:
        """Both together."""
        return Acting(
            self.sources + other.sources,
            self.cranks + other.cranks,
            self.governors + other.governors,
            self.taken_up + other.taken_up,
            self.drags + other.drags,
            self.leaks + other.leaks,
        )


class Drive(Protocol):
    """Anything that drives a line in time."""

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """What it does to a system whose frame turns at ``speed``."""
        ...


@dataclass
class _Tables:
    """Profiles and levels laid end to end, each once."""

    profiles: list[Profile]
    levels: list[Level]

    def profile(self, given: Profile | None) -> int:
        return -1 if given is None else _place(self.profiles, given)

    def level(self, given: Level | None) -> int:
        return -1 if given is None else _place(self.levels, given)


def _place(known: list[_Table], given: _Table) -> int:
    for i, other in enumerate(known):
        if other is given:
            return i
    known.append(given)
    return len(known) - 1


def row_of(system: System, node: str) -> Array:
    """The row along which a torque at a node acts on the coordinates."""
    return np.asarray(system.T[system.node_index(node)], dtype=float)


def assembled(
    acting: Acting, coordinates: int, named: Mapping[str, Level] | None = None
) -> tuple[Driven, Governed, dict[str, int]]:
    """The arrays of sources, cranks and governors, and where among the levels the ``named`` ones are."""
    tables = _Tables([], [])
    places = {name: tables.level(level) for name, level in (named or {}).items()}
    driven = _driven(acting, coordinates, tables)
    governed = _governed(acting, coordinates, tables)
    starts = np.cumsum([0, *(len(level.time) for level in tables.levels)])
    driven = driven._replace(
        profile_start=np.cumsum([0, *(len(p.coefficients) for p in tables.profiles)]).astype(np.int64),
        profile=np.concatenate([np.zeros((0, 4)), *(p.coefficients for p in tables.profiles)]),
        period=np.array([p.period for p in tables.profiles], dtype=float),
        level_start=starts.astype(np.int64),
        level_time=_joined([level.time for level in tables.levels]),
        level_value=_joined([level.value for level in tables.levels]),
    )
    return driven, governed, places


def _driven(acting: Acting, coordinates: int, tables: _Tables) -> Driven:
    sources, cranks = acting.sources + tuple(leak.source for leak in acting.leaks), acting.cranks
    none, nothing = np.zeros(0), np.zeros(0, dtype=np.int64)
    return Driven(
        rows_of(_stacked([s.row for s in sources], coordinates)),
        _floats([s.multiple for s in sources]),
        _floats([s.phase for s in sources]),
        _floats([s.feedback for s in sources]),
        _whole([tables.profile(s.profile) for s in sources]),
        nothing,
        np.zeros((0, 4)),
        none,
        _whole([tables.level(s.level) for s in sources]),
        nothing,
        none,
        none,
        rows_of(_stacked([c.row for c in cranks], coordinates)),
        _floats([float(c.row.sum()) for c in cranks]),
        _floats([c.phase for c in cranks]),
        _floats([c.mass for c in cranks]),
        _floats([c.radius for c in cranks]),
        _floats([c.rod for c in cranks]),
        _floats([c.offset for c in cranks]),
        _floats([c.included for c in cranks]),
    )


def _governed(acting: Acting, coordinates: int, tables: _Tables) -> Governed:
    governors, leaks, ahead = acting.governors, acting.leaks, len(acting.sources)
    still, none = np.zeros(coordinates), [0.0] * len(leaks)
    governed = [i for i, source in enumerate(acting.sources) if source.governed]
    own = [governed if g.act is None else [] for g in governors] + [[ahead + k] for k in range(len(leaks))]
    ratios = [tables.profile(leak.ratio) for leak in leaks]
    told = [
        (ahead + k, c.rate, c.opens, c.closes, ratio) for k, (c, ratio) in enumerate(zip(leaks, ratios, strict=True))
    ]
    return Governed(
        rows_of(_stacked([*(g.sense for g in governors), *([still] * len(leaks))], coordinates)),
        rows_of(
            _stacked([*(still if g.act is None else g.act for g in governors), *([still] * len(leaks))], coordinates)
        ),
        _whole([*(tables.level(g.wanted) for g in governors), *([-1] * len(leaks))]),
        _floats([*(g.proportional for g in governors), *none]),
        _floats([*(g.integral for g in governors), *none]),
        _floats([*(g.low for g in governors), *([-1.0] * len(leaks))]),
        _floats([*(g.high for g in governors), *([np.inf] * len(leaks))]),
        np.cumsum([0, *(len(o) for o in own)]).astype(np.int64),
        _whole([i for o in own for i in o]),
        np.array(told, dtype=float).reshape(len(leaks), LEAK),
    )


def _stacked(rows: Sequence[Array], coordinates: int) -> Array:
    return np.array(rows, dtype=float).reshape(len(rows), coordinates)


def _joined(parts: Sequence[Array]) -> Array:
    return np.concatenate([np.zeros(0), *parts])


def _floats(values: Sequence[float]) -> Array:
    return np.array(values, dtype=float)


def _whole(values: Sequence[int]) -> IntArray:
    return np.array(values, dtype=np.int64)
