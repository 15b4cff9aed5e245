"""What drives a time step as few tables: numba's time to compile grows with the square of the arrays that it is handed.

The rows of a table have names, below; columns are sources, cranks, governors or knots.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import Driven, Equations, Governed, Rows

MULTIPLE, PHASE, FEEDBACK, PERIOD = range(4)
"""Rows of ``sources``; the period is that of the profile."""
PROFILE_START, PROFILE_STOP, LEVEL_OF = range(3)
"""Rows of ``source_places``; without a profile it starts where it stops."""
TIME, VALUE = range(2)
"""Rows of ``knots``."""
CRANK_MULTIPLE, CRANK_PHASE, CRANK_MASS, CRANK_RADIUS, CRANK_ROD, CRANK_OFFSET, CRANK_INCLUDED = range(7)
"""Rows of ``cranks``."""
PROPORTIONAL, INTEGRAL, LOW, HIGH = range(4)
"""Rows of ``governors``."""
WANTED_OF, SOURCE_START, SOURCE_STOP = range(3)
"""Rows of ``governor_places``."""

LEAK_SOURCE, LEAK_RATE, OPENS, CLOSES, RATIO_START, RATIO_STOP, RATIO_PERIOD = range(7)
"""Rows of ``leaks``, a column a charge, the last of the governors."""


class Outside(NamedTuple):
    """What acts from outside, and what rotations count from: `Driven`, `Governed`, frame and reference of `Equations`.

    ``rows`` are those of the sources, then from ``crank_row`` on those of cranks and pendulums, of what governors
    ``sense`` and along which they ``act``, and at ``reference`` the last.  Level p has the ``knots`` from
    ``level_start[p]`` on, the frame's speed those from ``frame`` to the last.
    """

    rows: Rows
    sources: Array
    source_places: IntArray
    profile: Array
    level_start: IntArray
    knots: Array
    cranks: Array
    pendulums: Array
    governors: Array
    governor_places: IntArray
    governed: IntArray
    leaks: Array
    crank_row: int
    sense: int
    act: int
    reference: int
    frame: int
    reference_time: float


def outside_of(equations: Equations) -> Outside:
    """The tables of a system."""
    e = equations
    return tables_of(e.driven, e.governed, e.reference, e.reference_time, (e.frame_time, e.frame_value))


def tables_of(
    driven: Driven, governed: Governed, reference: Rows, reference_time: float, frame: tuple[Array, Array]
) -> Outside:
    """The tables of sources and governors; ``frame``: times [s] and speeds [rad/s]."""
    groups = (driven.rows, driven.crank_rows, governed.sense, governed.act, reference)
    crank_row, sense, act, last = np.cumsum([rows.start.size - 1 for rows in groups[:-1]]).tolist()
    levels = int(driven.level_time.size)
    return Outside(
        rows=_one_after_the_other(groups),
        sources=np.array([driven.multiple, driven.phase, driven.feedback, _periods(driven)]),
        source_places=_source_places(driven),
        profile=np.ascontiguousarray(driven.profile),
        level_start=driven.level_start,
        knots=np.array([np.append(driven.level_time, frame[0]), np.append(driven.level_value, frame[1])]),
        cranks=np.array([getattr(driven, f"crank_{name}") for name in _CRANK]),
        pendulums=np.ascontiguousarray(driven.pendulums),
        governors=np.array([governed.proportional, governed.integral, governed.low, governed.high]),
        governor_places=_integers([governed.wanted_of, governed.source_start[:-1], governed.source_start[1:]]),
        governed=governed.source,
        leaks=_leaks(driven, governed),
        crank_row=crank_row,
        sense=sense,
        act=act,
        reference=last,
        frame=levels,
        reference_time=float(reference_time),
    )


_CRANK = ("multiple", "phase", "mass", "radius", "rod", "offset", "included")


def _one_after_the_other(groups: tuple[Rows, ...]) -> Rows:
    """Groups of rows as one."""
    counts = np.concatenate([np.diff(rows.start) for rows in groups])
    column, weight = (np.concatenate([getattr(rows, name) for rows in groups]) for name in ("column", "weight"))
    return Rows(np.append(0, np.cumsum(counts)).astype(np.int64), column.astype(np.int64), weight.astype(float))


def _periods(driven: Driven) -> Array:
    """The period of each source's profile [turns], 1 without one."""
    return np.array([driven.period[p] if p >= 0 else 1.0 for p in driven.profile_of], dtype=float)


def _source_places(driven: Driven) -> IntArray:
    start, stop = (
        [int(driven.profile_start[p + beyond]) if p >= 0 else 0 for p in driven.profile_of] for beyond in (0, 1)
    )
    return _integers([start, stop, driven.level_of])


def _leaks(driven: Driven, governed: Governed) -> Array:
    """Leaks with where the profiles of their pressures are."""
    ratio = governed.leaks[:, -1].astype(np.int64)
    places = driven.profile_start[ratio], driven.profile_start[ratio + 1], driven.period[ratio]
    return np.ascontiguousarray(np.vstack([governed.leaks[:, :-1].T, *places]), dtype=float)


def _integers(rows: Sequence[ArrayLike]) -> IntArray:
    return np.array([np.asarray(row, dtype=np.int64) for row in rows], dtype=np.int64)
