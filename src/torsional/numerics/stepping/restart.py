"""A march begun afresh in compiled code, from coordinates, rates, memories: what `begin` does, where M is regular."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import (
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    DAMPER,
    GAP,
    LAW_OF,
    MEAN_RATE,
    SIDE,
    SPRING,
    HingeRows,
)
from torsional.numerics.motion.sources import frame_at, row_product, source_torques
from torsional.numerics.motion.tables import Outside
from torsional.numerics.stepping.forces import FACING, LEVEL, Bent, gather, scatter, scatter_one
from torsional.numerics.stepping.ledger import stored
from torsional.numerics.stepping.plan import Plan
from torsional.numerics.stepping.start import SHORT, at_rest
from torsional.numerics.stepping.state import (
    ACCELERATION,
    EXTERNAL,
    FRAME,
    INERTIAL,
    LAW_TORQUE,
    LOAD,
    OFFSET,
    OWN,
    RATE,
    SQUARED,
    TORQUE,
    TURNING,
    TWIST,
    Entry,
    Q,
    State,
    V,
)
from torsional.numerics.stepping.step import EXTRA, GIVEN, Work, inertial, spread
from torsional.numerics.uncounted import inner


@inner()
def _zero(values: Array) -> None:
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            values[i, j] = 0.0


@inner()
def _forget(state: State) -> None:
    """All but coordinates, rates and memories."""
    _zero(state.connection)
    for i in range(state.ledger.size):
        state.ledger[i] = 0.0
    for i in range(state.counts.size):
        state.counts[i] = 0
    state.begin[0] = 0.0


@inner()
def _turn(outside: Outside, constants: Array, turns: bool, state: State) -> None:
    """Ω_r, Ω², the frame's speed, and the offsets of rates that follow from them."""
    frame = frame_at(outside.knots, outside.frame, 0.0)[0]
    state.reference[TURNING], state.reference[SQUARED], state.reference[FRAME] = 0.0, 0.0, frame
    if turns:
        speed = row_product(outside.rows, outside.reference, state.coordinates[V]) + frame
        state.reference[TURNING], state.reference[SQUARED] = frame, speed * speed
        for e in range(constants.shape[1]):
            state.connection[OFFSET, e] = constants[MEAN_RATE, e] * frame


@inner()
def _close(constants: Array, hinges: HingeRows, squared: float, at: Array, sense: Array) -> None:
    """Torques of springs, dampers and hinges, and which of these are closed."""
    for e in range(at.shape[1]):
        at[RATE, e] += at[OFFSET, e]
        stiffness = constants[SPRING, e] + squared * constants[CENTRIFUGAL, e]
        at[TORQUE, e] = stiffness * at[TWIST, e] + constants[DAMPER, e] * at[RATE, e]
    for i in range(sense.size):
        e, values = hinges.of[i], hinges.values
        beyond = at[TWIST, e] - values[GAP, i] + values[CONTACT_TIME, i] * at[RATE, e]
        sense[i] = 1.0 if values[SIDE, i] * beyond > 0.0 else -1.0
        if sense[i] > 0.0:
            at[TORQUE, e] += values[CHANGE, i] * beyond


@inner()
def _bend(plan: Plan, state: State, values: Array, h: float) -> None:
    """Normal loads, torques and memories of the laws."""
    outside = plan.outside
    for i in range(values.size):
        values[i] = plan.laws.values[i]
    squared, levels = state.reference[SQUARED], (outside.level_start, outside.knots)
    at_rest(plan.laws, *levels, 0.0, squared, values, state.connection, state.law, max(h, SHORT))


@inner()
def _accelerate(plan: Plan, state: State, sources: Array, mobility: Array) -> None:
    """q̈ = M⁻¹ (torques of all sources less those of all connections)."""
    outside, q = plan.outside, state.coordinates
    _zero(sources)
    source_torques(outside, 0.0, 0.0, q[Q], sources[EXTRA], sources[GIVEN])
    for i in range(q.shape[1]):
        q[EXTERNAL, i] = 0.0
    for s in range(sources.shape[1]):
        spread(outside.rows, s, sources[GIVEN, s], q[EXTERNAL])
    for i in range(q.shape[1]):
        q[INERTIAL, i] = q[EXTERNAL, i]
    scatter(plan.pairs, state.connection[TORQUE], q[INERTIAL])
    for l in range(state.law.shape[1]):
        scatter_one(plan.pairs, plan.laws.places[LAW_OF, l], state.law[LAW_TORQUE, l], q[INERTIAL])
    for i in range(q.shape[1]):
        total = 0.0
        for j in range(q.shape[1]):
            total += mobility[i, j] * q[INERTIAL, j]
        q[ACCELERATION, i] = q[OWN, i] = total
    inertial(plan.masses, q[ACCELERATION], q[INERTIAL])


@inner()
def _renew(plan: Plan, state: State, w: Work) -> None:
    """The memory of a march as `new_work` makes it."""
    bent: Bent = w.bent
    _zero(w.trial)
    _zero(w.now)
    _zero(bent.hinges)
    _zero(bent.laws)
    for i in range(state.sense.size):
        bent.hinges[FACING, i] = state.sense[i] * plan.hinges.values[SIDE, i]
    for l in range(state.law.shape[1]):
        for row in range(LOAD + 1):
            bent.laws[row, l] = state.law[row, l]
        bent.laws[LEVEL, l] = 1.0
    for place in range(w.driving.speeds.size):
        w.driving.speeds[place] = state.reference[place] if place <= FRAME else 0.0
    for e in range(w.now.shape[1]):
        w.now[OFFSET, e] = state.connection[OFFSET, e]


@inner()
def restart(plan: Plan, state: State, w: Work, mobility: Array, h: float) -> None:
    """The time zero again, with the coordinates, rates and memories that the state has; ``mobility`` is M⁻¹, h [s] the
    step to come.  For plans without governors, cranks and pendulums, whose reference does not lag."""
    _forget(state)
    _turn(plan.outside, plan.constants, plan.moving or plan.spinning, state)
    gather(plan.pairs, state.coordinates[Q], state.connection[TWIST])
    gather(plan.pairs, state.coordinates[V], state.connection[RATE])
    _close(plan.constants, plan.hinges, state.reference[SQUARED], state.connection, state.sense)
    _bend(plan, state, w.bent.values, h)
    _accelerate(plan, state, w.driving.sources, mobility)
    stored(plan.constants, plan.masses, plan.hinges, state)
    state.ledger[Entry.THROUGHPUT] = state.ledger[Entry.KINETIC] + abs(state.ledger[Entry.STRAIN])
    _renew(plan, state, w)
