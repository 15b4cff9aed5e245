"""The state that a march begins with: the accelerations follow from the equilibrium of all torques."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.sources import crank_terms, frame_at, govern, level_at, row_product, source_torques
from torsional.numerics.stepping_ledger import stored
from torsional.numerics.stepping_plan import Laws, Plan, dense, matrix_of
from torsional.numerics.stepping_state import Count, Entry, State
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
    n, edges, laws = plan.tape.node.size, plan.pairs.left.size, plan.laws.of.size
    governors = plan.outside.governed.proportional.size
    state = State(
        coordinates=np.zeros((4, n)),
        external=np.zeros(n),
        inertial=np.zeros(n),
        connection=np.zeros((4, edges)),
        sense=np.full(plan.hinges.of.size, -1.0),
        law=np.zeros((5, laws)),
        passed=np.zeros((4, edges)),
        integral=_fitting(0.0 if integral is None else integral, governors, "integral"),
        reference=np.zeros(3),
        ledger=np.zeros(len(Entry)),
        counts=np.zeros(len(Count), dtype=np.int64),
        begin=np.array([float(time)]),
    )
    state.coordinates[0], state.coordinates[1] = _fitting(q, n, "q"), _fitting(v, n, "v")
    state.law[1] = _fitting(0.0 if memory is None else memory, laws, "memory")
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
    pairs, count = plan.pairs, plan.pairs.left.size
    table = np.zeros((count, plan.tape.node.size))
    np.add.at(table, (np.arange(count), pairs.left), pairs.first)
    np.add.at(table, (np.arange(count), pairs.right), pairs.second)
    np.add.at(table, (pairs.extra_row, pairs.extra_column), pairs.extra_weight)
    return table


def _turn(plan: Plan, state: State, time: float, reference: float | None) -> None:
    """Ω_r, Ω², the frame's speed, and the offsets of rates that follow from them."""
    outside, constants = plan.outside, plan.constants
    frame = float(frame_at(outside.frame_time, outside.frame_value, time)[0])
    if not (plan.moving or plan.spinning):
        state.reference[2] = frame
        return
    speed = float(row_product(outside.reference, 0, np.ascontiguousarray(state.coordinates[1]))) + frame
    turning = speed if reference is None else float(reference)
    turning = turning if np.isfinite(outside.reference_time) else frame
    state.reference[:] = turning, speed * speed, frame
    state.connection[3] = constants.mean_rate * frame - constants.follow * (turning - frame)


def _close(plan: Plan, state: State, weights: Array) -> tuple[Array, Array]:
    """Twists, rates, which hinges are closed, torques; the tangents (E,) by angle and rate."""
    hinges, constants = plan.hinges, plan.constants
    twist = weights @ state.coordinates[0]
    rate = weights @ state.coordinates[1] + state.connection[3]
    beyond = twist[hinges.of] - hinges.gap
    closed = hinges.side * (beyond + hinges.contact_time * rate[hinges.of]) > 0.0
    state.sense[closed] = 1.0
    change = np.where(closed, hinges.change, 0.0)
    stiffness, damping = constants.stiffness + state.reference[1] * constants.centrifugal, constants.damping.copy()
    shift = np.zeros(twist.size)
    for total, part in ((stiffness, change), (damping, change * hinges.contact_time), (shift, change * hinges.gap)):
        np.add.at(total, hinges.of, part)
    state.connection[:3] = twist, rate, stiffness * twist + damping * rate - shift
    return stiffness, damping


def _bend(plan: Plan, state: State, time: float, step: float) -> None:
    """Normal loads, torques and memories of the laws."""
    laws, loads, driven = plan.laws, plan.loads, plan.outside.driven
    values = laws.values.copy()
    for l, e in enumerate(laws.of.tolist()):
        if laws.load_at[l] >= 0:
            level = level_at(driven.level_start, driven.level_time, driven.level_value, loads.level[e], time)
            own = slice(loads.start[e], loads.start[e + 1])
            shared = loads.share[own] @ np.abs(state.connection[2, loads.of[own]])
            total = loads.constant[e] * level + loads.centrifugal[e] * state.reference[1] + shared
            state.law[2, l] = values[laws.load_at[l]] = max(0.0, total)
    _at_rest(laws, values, state.connection, state.law, step)


@uncounted()
def _at_rest(laws: Laws, values: Array, connection: Array, law: Array, step: float) -> None:
    """Torques of the laws where no time passes; the strain energy of those without memory counts from here."""
    for l in range(laws.of.size):
        e, torque = laws.of[l], law_at(laws.address[l])
        own = values[laws.start[l] : laws.stop[l]]
        told = torque(own, connection[0, e], connection[1, e], law[1, l], 0.0)
        soon = torque(own, connection[0, e], connection[1, e], law[1, l], step)
        if laws.remembers[l] and soon[7] < 0.5:  # forgets its start long before a step is over
            told = soon
        rest = torque(own, connection[0, e], 0.0, law[1, l], 0.0)
        law[0, l], law[1, l] = told[0], told[4]
        law[4, l] = rest[1] if laws.remembers[l] else rest[0]
        law[3, l] = 0.5 * rest[1] * told[4] * told[4] if laws.remembers[l] else 0.0


def _accelerate(plan: Plan, state: State, weights: Array, tangent: tuple[Array, Array], time: float) -> None:
    """q̈ from M, or where M is singular from the matrix of a short step."""
    masses, driven = plan.masses, plan.outside.driven
    M = matrix_of(masses)
    external, inertia = _external(plan, state, time)
    cranks = dense(driven.crank_rows, len(M))
    heavy = M + (cranks.T * inertia) @ cranks
    torque = state.connection[2].copy()
    np.add.at(torque, plan.laws.of, state.law[0])
    if np.linalg.eigvalsh(heavy)[0] <= 1e-14 * np.abs(heavy).max():
        by_step = 0.25 * SHORT * SHORT * tangent[0] + 0.5 * SHORT * tangent[1]
        heavy = heavy + (weights.T * by_step) @ weights
    acceleration = np.linalg.solve(heavy, external - torque @ weights)
    state.coordinates[2] = state.coordinates[3] = acceleration
    state.external[:] = external - (inertia * (cranks @ acceleration)) @ cranks
    state.inertial[:] = M @ acceleration


def _external(plan: Plan, state: State, time: float) -> tuple[Array, Array]:
    """Torques of sources, governors and cranks on the coordinates (n,), the cranks' inertias (c,) beside."""
    outside, driven, governed = plan.outside, plan.outside.driven, plan.outside.governed
    n, q, v = plan.tape.node.size, *(np.ascontiguousarray(state.coordinates[i]) for i in (0, 1))
    frame, angle = frame_at(outside.frame_time, outside.frame_value, time)
    torque, extra = np.zeros((2, driven.multiple.size))
    governor, integral = np.zeros(state.integral.size), state.integral.copy()
    govern(governed, driven, time, 0.0, frame, v, integral, governor, extra)
    source_torques(driven, time, angle, q, extra, torque)
    crank, inertia = np.zeros((2, driven.crank_rows.start.size - 1))
    crank_terms(driven, angle, frame, q, v, crank, inertia)
    total = torque @ dense(driven.rows, n) + crank @ dense(driven.crank_rows, n)
    if governor.size:
        total += governor @ dense(governed.act, n)
    return total, inertia
