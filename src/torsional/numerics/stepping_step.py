"""One implicit time step: the motion at its end at which all torques, hinges and laws agree.

    M q̈⁺ = P − Σ w_e T_e,   (μ M + γh C + βh² K) δ = what is left of it,   μ = (1 − α_m)/(1 − α_f)

from the accelerations of the step before, with q⁺ = q_p + βh² δ, v⁺ = v_p + γh δ, q̈⁺ = q̈ + μ δ.  For hinges it is the
iteration of the active set, Newton's method: exact once the set repeats.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from typing import NamedTuple

from torsional.numerics.arrays import Array
from torsional.numerics.sources import crank_terms, frame_at, govern, level_at, row_product, source_torques
from torsional.numerics.sparse_factor import Tape, factor, substitute
from torsional.numerics.stepping_data import Driven, Governed, Rows
from torsional.numerics.stepping_forces import (
    Bent,
    Connections,
    advance,
    gather,
    scatter,
    scatter_one,
    tangents,
)
from torsional.numerics.stepping_plan import Constants, Fill, HingeRows, Laws, Masses, Plan
from torsional.numerics.stepping_state import State
from torsional.numerics.uncounted import inlined, uncounted

LONGEST = 1e300
"""Time constant [s] from which one is none."""


class Method(NamedTuple):
    """α_m, β, γ, μ of the family, and βh², γh, h of the step."""

    alpha_m: float
    beta: float
    gamma: float
    mu: float
    by_angle: float
    by_rate: float
    h: float


class Trial(NamedTuple):
    """The motion while it is sought, by coordinate (n,): angles, rates, accelerations, the method's own, δ, sources,
    torques still out of balance and the same in the order of elimination."""

    q: Array
    v: Array
    acceleration: Array
    own: Array
    delta: Array
    external: Array
    left: Array
    ordered: Array


class Solver(NamedTuple):
    """The step matrix (slots,): that of steady connections, the one in use, its factor; what it was ``built`` for:
    (valid, Ω²)."""

    steady: Array
    matrix: Array
    lower: Array
    inverse: Array
    built: Array


class Driving(NamedTuple):
    """What drives a step: source torques (S,) and what governors add, governors' torques and integrals (G,), cranks'
    (c,) torque and inertia, levels of normal loads (L,); ``speeds``: frame's angle and speed, Ω_r, Ω²."""

    torque: Array
    extra: Array
    governor: Array
    integral: Array
    crank_torque: Array
    crank_inertia: Array
    levels: Array
    speeds: Array


class Work(NamedTuple):
    """All memory of a march."""

    trial: Trial
    solver: Solver
    driving: Driving
    now: Connections
    bent: Bent


@inlined()
def spread(rows: Rows, i: int, torque: float, x: Array) -> None:
    """x ← x + r_i T."""
    for k in range(rows.start[i], rows.start[i + 1]):
        x[rows.column[k]] += rows.weight[k] * torque


@inlined()
def predict(state: State, trial: Trial, m: Method) -> None:
    """The motion at the step's end if the accelerations stay."""
    q, v, acceleration, own = state.coordinates
    first, second = m.h * m.h * (0.5 - m.beta), m.h * (1.0 - m.gamma)
    for i in range(trial.q.size):
        ahead = (acceleration[i] - m.alpha_m * own[i]) / (1.0 - m.alpha_m)
        trial.own[i], trial.acceleration[i], trial.delta[i] = ahead, acceleration[i], 0.0
        trial.q[i] = q[i] + m.h * v[i] + first * own[i] + m.by_angle * ahead
        trial.v[i] = v[i] + second * own[i] + m.by_rate * ahead


@inlined()
def drive(plan: Plan, state: State, w: Work, t: float, h: float) -> None:
    """Sources, governors, cranks and the rotations at the end t of a step, at the motion that is predicted."""
    outside, d, trial = plan.outside, w.driving, w.trial
    before = d.speeds[1]
    d.speeds[1], d.speeds[0] = frame_at(outside.frame_time, outside.frame_value, t)
    for g in range(d.integral.size):
        d.integral[g] = state.integral[g]
    if d.governor.size:
        _govern(outside.governed, outside.driven, d, state.coordinates[1], trial.v, before, t, h)
    source_torques(outside.driven, t, d.speeds[0], trial.q, d.extra, d.torque)
    for i in range(trial.external.size):
        trial.external[i] = 0.0
    for s in range(d.torque.size):
        spread(outside.driven.rows, s, d.torque[s], trial.external)
    for g in range(d.governor.size):
        spread(outside.governed.act, g, d.governor[g], trial.external)
    if d.crank_torque.size:
        q, v = trial.q, trial.v
        crank_terms(outside.driven, d.speeds[0], d.speeds[1], q, v, d.crank_torque, d.crank_inertia)
        for k in range(d.crank_torque.size):
            spread(outside.driven.crank_rows, k, d.crank_torque[k], trial.external)
    if plan.moving or plan.spinning:
        _rotate(
            outside.reference, outside.reference_time, plan.constants, state, trial.v, w.now.offset, d.speeds, h, before
        )
        for l in range(d.levels.size):
            place, driven = plan.loads.level[plan.laws.of[l]], outside.driven
            d.levels[l] = level_at(driven.level_start, driven.level_time, driven.level_value, place, t)


@uncounted()
def _govern(
    governed: Governed, driven: Driven, d: Driving, v: Array, v_end: Array, before: float, t: float, h: float
) -> None:
    """Governors at the end t of a step, with the mean of their errors at both ends added up."""
    govern(governed, driven, t - h, 0.5 * h, before, v, d.integral, d.governor, d.extra)
    govern(governed, driven, t, 0.5 * h, d.speeds[1], v_end, d.integral, d.governor, d.extra)
    govern(governed, driven, t, 0.0, d.speeds[1], v_end, d.integral, d.governor, d.extra)


@uncounted()
def _rotate(
    reference: Rows,
    time: float,
    constants: Constants,
    state: State,
    v: Array,
    offset: Array,
    speeds: Array,
    h: float,
    before: float,
) -> None:
    """Ω², the reference rotation, which follows Ω with a constant of ``time``, and with it the offsets of rates."""
    speed = row_product(reference, 0, v) + speeds[1]
    mean = 0.5 * (speed + row_product(reference, 0, state.coordinates[1]) + before)
    speeds[2], speeds[3] = speeds[1], speed * speed
    if time < LONGEST:
        speeds[2] = mean + (state.reference[0] - mean) * math.exp(-h / time)
    for e in range(offset.size):
        offset[e] = constants.mean_rate[e] * speeds[1] - constants.follow[e] * (speeds[2] - speeds[1])


@inlined()
def _add(fill: Fill, value: Array, matrix: Array) -> None:
    for k in range(fill.row.size):
        matrix[fill.slot[k]] += fill.weight[k] * value[fill.row[k]]


@uncounted()
def begin_rung(
    masses: Masses,
    constants: Constants,
    hinges: HingeRows,
    steady: Fill,
    now: Connections,
    bent: Bent,
    solver: Solver,
    squared: float,
    m: Method,
    guard: bool,
) -> None:
    """The steady part of the step matrix, and contact times under the guard, for another step."""
    for i in range(hinges.of.size):
        stiff = guard and m.h * hinges.pace[i] > 0.5
        bent.contact_time[i] = max(hinges.contact_time[i], 0.5 * m.h) if stiff else hinges.contact_time[i]
    retangent(constants, hinges, now, bent, solver, squared, m)
    for k in range(solver.steady.size):
        solver.steady[k] = m.mu * masses.slots[k]
    _add(steady, now.step, solver.steady)


@uncounted()
def retangent(
    constants: Constants, hinges: HingeRows, now: Connections, bent: Bent, solver: Solver, squared: float, m: Method
) -> None:
    """Tangents of the hinges that are closed, at Ω² = ``squared``; the factor is out of date."""
    tangents(constants, hinges, now, bent, squared, m.by_angle, m.by_rate)
    solver.built[0], solver.built[1] = 0.0, squared


@uncounted()
def refactor(
    tape: Tape,
    laws: Laws,
    fill: Fill,
    cranks: Fill,
    now: Connections,
    bent: Bent,
    solver: Solver,
    inertia: Array,
    mu: float,
) -> bool:
    """The step matrix of now and its factor; False where it is not positive definite."""
    for e in range(now.step.size):
        now.share[e] = now.step[e]
    for l in range(bent.slope.size):
        now.share[laws.of[l]] += bent.slope[l]
        bent.built[l] = bent.slope[l]
    for k in range(solver.matrix.size):
        solver.matrix[k] = solver.steady[k]
    _add(fill, now.share, solver.matrix)
    for k in range(cranks.row.size):
        solver.matrix[cranks.slot[k]] += cranks.weight[k] * mu * inertia[cranks.row[k]]
    solver.built[0] = 1.0
    return factor(tape, solver.matrix, solver.lower, solver.inverse)


@inlined()
def inertial(masses: Masses, acceleration: Array, out: Array) -> None:
    """M q̈."""
    for i in range(out.size):
        out[i] = masses.diagonal[i] * acceleration[i]
    for k in range(masses.above.size):
        i, j = masses.above_row[k], masses.above_column[k]
        out[i] += masses.above[k] * acceleration[j]
        out[j] += masses.above[k] * acceleration[i]


@inlined()
def solve(plan: Plan, w: Work, m: Method) -> None:
    """One pass: what is out of balance, its δ, the motion and the torques that follow from it."""
    trial, now, bent, node = w.trial, w.now, w.bent, plan.tape.node
    inertial(plan.masses, trial.acceleration, trial.left)
    for i in range(trial.left.size):
        trial.left[i] = trial.external[i] - trial.left[i]
    scatter(plan.pairs, now.torque, trial.left)
    for l in range(bent.torque.size):
        scatter_one(plan.pairs, plan.laws.of[l], bent.torque[l], trial.left)
    rows = plan.outside.driven.crank_rows
    for k in range(w.driving.crank_inertia.size):
        spread(rows, k, -w.driving.crank_inertia[k] * row_product(rows, k, trial.acceleration), trial.left)
    for p in range(node.size):
        trial.ordered[p] = trial.left[node[p]]
    substitute(plan.tape, w.solver.lower, w.solver.inverse, trial.ordered)
    for p in range(node.size):
        trial.left[node[p]] = trial.ordered[p]
    for i in range(trial.left.size):
        trial.delta[i] += trial.left[i]
        trial.acceleration[i] += m.mu * trial.left[i]
    gather(plan.pairs, trial.left, now.moved)
    advance(now, m.by_angle, m.by_rate)
    for l in range(bent.torque.size):
        bent.torque[l] += bent.built[l] * now.moved[plan.laws.of[l]]
