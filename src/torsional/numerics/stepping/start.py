"""The state that a march begins with: the accelerations follow from the equilibrium of all torques."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import depth
from torsional.numerics.motion.data import (
    ADDRESS,
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    DAMPER,
    FOLLOW,
    GAP,
    LAW_OF,
    MEAN_RATE,
    REMEMBERS,
    SIDE,
    SPRING,
    START,
    STOP,
    Laws,
)
from torsional.numerics.motion.normal_load import press
from torsional.numerics.motion.sources import crank_terms, frame_at, govern, row_product, source_torques
from torsional.numerics.stepping.ledger import stored
from torsional.numerics.stepping.plan import LEFT, RIGHT, Plan, dense, matrix_of
from torsional.numerics.stepping.state import (
    ACCELERATION,
    EXTERNAL,
    INERTIAL,
    LAW_TORQUE,
    LOAD,
    MEMORY,
    OFFSET,
    OWN,
    RATE,
    REST,
    SQUARED,
    STRAIN,
    TORQUE,
    TWIST,
    Count,
    Entry,
    Q,
    State,
    V,
)
from torsional.numerics.uncounted import uncounted

SHORT = 1e-6
"""Length [s] of the step that stands for the start where a coordinate has no mass, or a bristle relaxes at once."""


def begin(
    plan: Plan,
    q: ArrayLike,
    v: ArrayLike,
    *,
    time: float = 0.0,
    memory: ArrayLike | None = None,
    reference: float | None = None,
    integral: ArrayLike | None = None,
    step: float = SHORT,
) -> State:
    """The state at ``time`` [s] with coordinates q [rad] and rates v [rad/s] (n,).

    ``memory`` (L,) [rad] of the laws by address and ``integral`` (G,) [Nm] of the governors are zero unless given, the
    ``reference`` rotation Ω_r [rad/s] is the speed at the reference node.  M q̈ = g; where a coordinate has no mass, q̈
    is that after a short step.  A bristle whose start is forgotten within a ``step`` [s] begins as it is after one.
    Raises ModelError for shapes that do not fit.
    """
    n, edges, laws = plan.tape.node.size, plan.constants.shape[1], plan.laws.places.shape[1]
    state = State(
        coordinates=np.zeros((6, n)),
        connection=np.zeros((8, edges)),
        sense=np.full(plan.hinges.of.size, -1.0),
        law=np.zeros((5, laws)),
        integral=_fitting(0.0 if integral is None else integral, plan.outside.governors.shape[1], "integral"),
        reference=np.zeros(3),
        ledger=np.zeros(len(Entry)),
        counts=np.zeros(len(Count), dtype=np.int64),
        begin=np.array([float(time)]),
    )
    state.coordinates[Q], state.coordinates[V] = _fitting(q, n, "q"), _fitting(v, n, "v")
    state.law[MEMORY] = _fitting(0.0 if memory is None else memory, laws, "memory")
    weights = _weights(plan)
    _turn(plan, state, float(time), reference)
    tangent = _close(plan, state, weights)
    _bend(plan, state, float(time), max(step, SHORT))
    _accelerate(plan, state, weights, tangent, float(time))
    stored(plan.constants, plan.masses, plan.hinges, state)
    state.ledger[Entry.THROUGHPUT] = state.ledger[Entry.KINETIC] + abs(state.ledger[Entry.STRAIN])
    return state


def _fitting(values: ArrayLike, count: int, where: str) -> Array:
    found = np.asarray(values, dtype=float)
    if found.shape not in ((), (count,)) or not np.isfinite(found).all():
        allowed = f"({count},), finite"
        raise ModelError("does not fit the equations", where=where, found=str(found.shape), allowed=allowed)
    return np.array(np.broadcast_to(found, (count,)))


def _weights(plan: Plan) -> Array:
    """Rows w_e (E, n)."""
    pairs, count = plan.pairs, plan.constants.shape[1]
    table = np.zeros((count, plan.tape.node.size))
    for side in (LEFT, RIGHT):
        np.add.at(table, (np.arange(count), pairs.ends[side]), pairs.weights[side])
    np.add.at(table, (pairs.extra_at[LEFT], pairs.extra_at[RIGHT]), pairs.extra)
    return table


def _turn(plan: Plan, state: State, time: float, reference: float | None) -> None:
    """Ω_r, Ω², the frame's speed, and the offsets of rates that follow from them."""
    outside, constants = plan.outside, plan.constants
    frame = float(frame_at(outside.knots, outside.frame, time)[0])
    if not (plan.moving or plan.spinning):
        state.reference[2] = frame
        return
    speed = float(row_product(outside.rows, outside.reference, state.coordinates[V])) + frame
    turning = speed if reference is None else float(reference)
    turning = turning if np.isfinite(outside.reference_time) else frame
    state.reference[:] = turning, speed * speed, frame
    state.connection[OFFSET] = constants[MEAN_RATE] * frame - constants[FOLLOW] * (turning - frame)


def _close(plan: Plan, state: State, weights: Array) -> tuple[Array, Array]:
    """Twists, rates, which hinges are closed, torques; the tangents (E,) by angle and rate."""
    hinges, constants, of = plan.hinges.values, plan.constants, plan.hinges.of
    twist = weights @ state.coordinates[Q]
    rate = weights @ state.coordinates[V] + state.connection[OFFSET]
    closed = depth(twist[of], rate[of], hinges[GAP], hinges[SIDE], hinges[CONTACT_TIME]) > 0.0
    state.sense[closed] = 1.0
    change = np.where(closed, hinges[CHANGE], 0.0)
    stiffness = constants[SPRING] + state.reference[SQUARED] * constants[CENTRIFUGAL]
    damping, shift = constants[DAMPER].copy(), np.zeros(twist.size)
    for total, part in ((stiffness, change), (damping, change * hinges[CONTACT_TIME]), (shift, change * hinges[GAP])):
        np.add.at(total, of, part)
    state.connection[[TWIST, RATE, TORQUE]] = twist, rate, stiffness * twist + damping * rate - shift
    return stiffness, damping


def _bend(plan: Plan, state: State, time: float, step: float) -> None:
    """Normal loads, torques and memories of the laws."""
    outside, squared = plan.outside, float(state.reference[SQUARED])
    values, levels = plan.laws.values.copy(), (outside.level_start, outside.knots)
    at_rest(plan.laws, *levels, time, squared, values, state.connection, state.law, step)


@uncounted()
def at_rest(
    laws: Laws,
    level_start: IntArray,
    knots: Array,
    time: float,
    squared: float,
    values: Array,
    connection: Array,
    law: Array,
    step: float,
) -> None:
    """Loads, into ``values`` too, and torques of the laws at a ``time`` where none passes; the strain energy of those
    without memory counts from here."""
    places, springs = laws.places, connection[TORQUE]
    for l in range(places.shape[1]):
        e, torque, memory = places[LAW_OF, l], law_at(places[ADDRESS, l]), law[MEMORY, l]
        law[LOAD, l] = press(laws, level_start, knots, l, time, squared, springs, values)
        own = values[places[START, l] : places[STOP, l]]
        told = torque(own, connection[TWIST, e], connection[RATE, e], memory, 0.0)
        soon = torque(own, connection[TWIST, e], connection[RATE, e], memory, step)
        if places[REMEMBERS, l] and soon[7] < 0.5:  # forgets its start long before a step is over
            told = soon
        rest = torque(own, connection[TWIST, e], 0.0, memory, 0.0)
        law[LAW_TORQUE, l], law[MEMORY, l] = told[0], told[4]
        law[REST, l] = rest[1] if places[REMEMBERS, l] else rest[0]
        law[STRAIN, l] = 0.5 * rest[1] * told[4] * told[4] if places[REMEMBERS, l] else 0.0


def _accelerate(plan: Plan, state: State, weights: Array, tangent: tuple[Array, Array], time: float) -> None:
    """q̈ from M, or where M is singular from the matrix of a short step."""
    M = matrix_of(plan.masses)
    external, inertia, cranks = _external(plan, state, time)
    heavy = M + (cranks.T * inertia) @ cranks
    torque = state.connection[TORQUE].copy()
    np.add.at(torque, plan.laws.of, state.law[LAW_TORQUE])
    if np.linalg.eigvalsh(heavy)[0] <= 1e-14 * np.abs(heavy).max():
        by_step = 0.25 * SHORT * SHORT * tangent[0] + 0.5 * SHORT * tangent[1]
        heavy = heavy + (weights.T * by_step) @ weights
    acceleration = np.linalg.solve(heavy, external - torque @ weights)
    state.coordinates[ACCELERATION] = state.coordinates[OWN] = acceleration
    state.coordinates[EXTERNAL] = external - (inertia * (cranks @ acceleration)) @ cranks
    state.coordinates[INERTIAL] = M @ acceleration


def _external(plan: Plan, state: State, time: float) -> tuple[Array, Array, Array]:
    """Torques of sources, governors and cranks on the coordinates (n,); the cranks' inertias (c,) and rows (c, n)."""
    outside, q, v = plan.outside, state.coordinates[Q], state.coordinates[V]
    rows = dense(outside.rows, plan.tape.node.size)
    frame, angle = frame_at(outside.knots, outside.frame, time)
    torque, extra = np.zeros((2, outside.sources.shape[1]))
    governor, integral = np.zeros(state.integral.size), state.integral.copy()
    govern(outside, time, 0.0, frame, v, integral, governor, extra)
    source_torques(outside, time, angle, q, extra, torque)
    crank_rows = rows[outside.crank_row : outside.sense]
    crank, inertia = np.zeros((2, len(crank_rows)))
    crank_terms(outside, angle, frame, q, v, crank, inertia)
    total = torque @ rows[: torque.size] + crank @ crank_rows
    if governor.size:
        total += governor @ rows[outside.act : outside.reference]
    return total, inertia, crank_rows
