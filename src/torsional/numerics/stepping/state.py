"""Where a march in time stands between two calls, what it is told and what it gives back."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray


class Status(IntEnum):
    """How a march ended."""

    DONE = 0
    UNSETTLED = 1  # the torques of a step did not come to agree with its motion
    INDEFINITE = 2  # the step matrix is not positive definite: a stiffness, a damping or an inertia is negative
    NOT_FINITE = 3
    PRODUCES = 4  # done, but the time step made more energy of its own than it may


class Entry(IntEnum):
    """Columns of the ledger [J]: kinetic + strain − (those at the start) = worked − damped − struck − rubbed + made."""

    KINETIC = 0
    STRAIN = 1  # of springs, closed hinges, laws
    WORKED = 2  # by sources, and by rotations that dampers count from
    DAMPED = 3  # in dampers
    STRUCK = 4  # in contacts
    RUBBED = 5  # in other laws
    MADE = 6  # by the method itself; negative: lost in it
    PRODUCED = 7  # of it only the steps that made some
    THROUGHPUT = 8  # energy at the start, and what all sources gave and took


class Count(IntEnum):
    """Columns of the counters."""

    STEPS = 0
    SOLVES = 1
    FACTORS = 2
    FALLBACKS = 3
    REJECTED = 4
    BASE_STEPS = 5
    RUNG = 6
    PATIENCE = 7
    BUILT_RUNG = 8


Q, V, ACCELERATION, OWN, EXTERNAL, INERTIAL, DELTA, ORDERED = range(8)
"""Rows of ``coordinates``; the last two are those of a trial only."""
TWIST, RATE, TORQUE, OFFSET, MADE, THROUGH, GUARDED, LOST = range(8)
"""Rows of ``connection``."""
LAW_TORQUE, MEMORY, LOAD, STRAIN, REST = range(5)
"""Rows of ``law``."""
TURNING, SQUARED, FRAME = range(3)
"""Places in ``reference``."""


class Settings(NamedTuple):
    """What a march is told beside its step.

    ``guard``: stiff contacts get a contact time of at least h/2.  ``agreement``: share of the largest torque to which
    the torques of laws agree with the motion.  ``rungs`` > 0: steps h, h/2, … h/2^rungs as the error of the angles asks
    for, within ``angle_error`` [rad] + ``relative_error`` of the angle; else h alone.  ``production``: share of the
    throughput that the method may make of its own.
    """

    guard: bool = True
    agreement: float = 1e-10
    passes: int = 60
    rungs: int = 0
    angle_error: float = 1e-7
    relative_error: float = 0.0
    production: float = 0.01


class State(NamedTuple):
    """Where a march stands: copied by `march`, never changed in place.

    ``coordinates`` (6, n): q [rad], q̇, q̈, the method's own a, torques of all sources, and M q̈.  ``connection`` (8, E):
    twist, rate, torque of spring, hinges and damper, offset of the rate, energy that the method made at it, all that
    went through it, what contact times given by the guard took, and what its law lost.  ``sense`` (H,): 1 closed, −1
    open.  ``law`` (5, L): torque, memory, normal load, strain energy, and its elastic tangent or, without a memory, its
    torque at rest.  ``integral`` (G,) of the governors.  ``reference`` (3,): Ω_r [rad/s], Ω², the frame's speed.
    ``ledger`` by `Entry`, ``counts`` by `Count`; ``begin`` (1,) is the time of base step 0 [s].
    """

    coordinates: Array
    connection: Array
    sense: Array
    law: Array
    integral: Array
    reference: Array
    ledger: Array
    counts: IntArray
    begin: Array

    def copied(self) -> State:
        """The same in memory of its own."""
        return State._make(np.array(part) for part in self)

    @property
    def passed(self) -> Array:
        """(4, E) [J]: what the method made at each connection, all that went through, losses to guard and law."""
        return self.connection[MADE:]


class Records(NamedTuple):
    """What was recorded (R records): ``time`` (R,), q, q̇ and q̈ as ``motion`` (3, R, n), twist [rad] and torque [Nm] as
    ``connection`` (2, R, E), memory, load and loss [J] of the laws by address as
    ``law`` (3, R, L), ``ledger`` (R, entries)."""

    time: Array
    motion: Array
    connection: Array
    law: Array
    ledger: Array

    @property
    def q(self) -> Array:
        """Coordinates (R, n)."""
        return np.asarray(self.motion[0])

    @property
    def v(self) -> Array:
        """Their rates (R, n)."""
        return np.asarray(self.motion[1])

    @property
    def acceleration(self) -> Array:
        """Their accelerations (R, n)."""
        return np.asarray(self.motion[2])

    @property
    def twist(self) -> Array:
        """Angles of connections (R, E) [rad]."""
        return np.asarray(self.connection[0])

    @property
    def torque(self) -> Array:
        """Their torques (R, E) [Nm]."""
        return np.asarray(self.connection[1])

    @property
    def memory(self) -> Array:
        """Memories of laws (R, L)."""
        return np.asarray(self.law[0])

    @property
    def load(self) -> Array:
        """Their normal loads (R, L)."""
        return np.asarray(self.law[1])

    @property
    def lost(self) -> Array:
        """What they lost (R, L) [J]."""
        return np.asarray(self.law[2])


class March(NamedTuple):
    """A march: its records, the state at its end, how it ended."""

    records: Records
    state: State
    status: Status

    def count(self, which: Count) -> int:
        """One of the counters, since the first step."""
        return int(self.state.counts[which])
