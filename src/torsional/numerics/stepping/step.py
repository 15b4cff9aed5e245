"""One implicit time step: the motion at its end at which all torques, hinges and laws agree.

    M q̈⁺ = P − Σ w_e T_e,   (μ M + γh C + βh² K) δ = what is left of it,   μ = (1 − α_m)/(1 − α_f)

from the accelerations of the step before, with q⁺ = q_p + βh² δ, v⁺ = v_p + γh δ, q̈⁺ = q̈ + μ δ.  For hinges it is the
iteration of the active set, Newton's method: exact once the set repeats.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import math
from typing import NamedTuple

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.sparse_factor import Tape, factor, substitute
from torsional.numerics.motion.data import CONTACT_TIME, FOLLOW, LAW_OF, LOAD_LEVEL, MEAN_RATE, HingeRows, Rows
from torsional.numerics.motion.leaking import leak
from torsional.numerics.motion.sources import crank_terms, frame_at, govern, level_at, row_product, source_torques
from torsional.numerics.motion.tables import Outside
from torsional.numerics.stepping.forces import (
    BUILT,
    DELAY,
    LEVEL,
    MOVED,
    SHARE,
    SLOPE,
    STEP,
    Bent,
    advance,
    gather,
    scatter,
    scatter_one,
    tangents,
)
from torsional.numerics.stepping.plan import PACE, ROW, SLOT, Fill, Masses, Plan
from torsional.numerics.stepping.state import (
    ACCELERATION,
    DELTA,
    EXTERNAL,
    FRAME,
    INERTIAL,
    LAW_TORQUE,
    OFFSET,
    ORDERED,
    OWN,
    SQUARED,
    TORQUE,
    TURNING,
    Q,
    V,
)
from torsional.numerics.uncounted import inlined, inner, merged

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


STEADY, MATRIX = range(2)
"""Rows of the step matrix (2, slots): that of steady connections, the one in use."""
GIVEN, EXTRA = range(2)
"""Rows of ``sources``: torques, and what governors add to their levels."""
HELD, GATHERED = range(2)
"""Rows of ``governors``: torques and integrals."""
PUSHED, HEAVY = range(2)
"""Rows of ``cranks``: torque and inertia."""
ANGLE, VALID, BUILT_FOR = range(3, 6)
"""Places in ``speeds``, after those of `State.reference`: the frame's angle, whether there is a factor, and its Ω²."""


class Solver(NamedTuple):
    """The step ``matrix`` (2, slots) and its factor."""

    matrix: Array
    lower: Array
    inverse: Array


class Driving(NamedTuple):
    """What drives a step: ``sources`` (2, S), ``governors`` (2, G), ``cranks`` (2, c), ``speeds`` (6,)."""

    sources: Array
    governors: Array
    cranks: Array
    speeds: Array


class Work(NamedTuple):
    """All memory of a march: the motion while it is sought, ``trial`` (8, n), where INERTIAL is also what is still out
    of balance and ORDERED the same in the order of elimination; ``now`` (10, E) and ``bent`` the connections."""

    trial: Array
    solver: Solver
    driving: Driving
    now: Array
    bent: Bent


@merged()
def spread(rows: Rows, i: int, torque: float, x: Array) -> None:
    """x ← x + r_i T."""
    for k in range(rows.start[i], rows.start[i + 1]):
        x[rows.column[k]] += rows.weight[k] * torque


@merged()
def predict(now: Array, trial: Array, m: Method) -> None:
    """The motion at the step's end if the accelerations stay."""
    first, second = m.h * m.h * (0.5 - m.beta), m.h * (1.0 - m.gamma)
    for i in range(trial.shape[1]):
        own = now[OWN, i]
        ahead = (now[ACCELERATION, i] - m.alpha_m * own) / (1.0 - m.alpha_m)
        trial[OWN, i], trial[ACCELERATION, i], trial[DELTA, i] = ahead, now[ACCELERATION, i], 0.0
        trial[Q, i] = now[Q, i] + m.h * now[V, i] + first * own + m.by_angle * ahead
        trial[V, i] = now[V, i] + second * own + m.by_rate * ahead


@merged()
def drive(outside: Outside, v: Array, integral: Array, d: Driving, trial: Array, t: float, h: float) -> None:
    """Torques of sources, governors and cranks at the end t of a step, at the motion that is predicted."""
    rows, external, sources, before = outside.rows, trial[EXTERNAL], d.sources, d.speeds[FRAME]
    d.speeds[FRAME], d.speeds[ANGLE] = frame_at(outside.knots, outside.frame, t)
    for i in range(external.size):
        external[i] = 0.0
    for g in range(d.governors.shape[1]):
        d.governors[GATHERED, g] = integral[g]
    if d.governors.shape[1]:
        leak(outside, h, (d.speeds[ANGLE], d.speeds[FRAME]), trial[Q], trial[V], d.governors[GATHERED])
        _govern(outside, d, v, trial[V], before, t, h)
    source_torques(outside, t, d.speeds[ANGLE], trial[Q], sources[EXTRA], sources[GIVEN])
    for s in range(sources.shape[1]):
        spread(rows, s, sources[GIVEN, s], external)
    for g in range(d.governors.shape[1]):
        spread(rows, outside.act + g, d.governors[HELD, g], external)
    if d.cranks.shape[1]:
        crank_terms(outside, d.speeds[ANGLE], d.speeds[FRAME], trial[Q], trial[V], d.cranks[PUSHED], d.cranks[HEAVY])
        for k in range(d.cranks.shape[1]):
            spread(rows, outside.crank_row + k, d.cranks[PUSHED, k], external)


@inner()
def rotate(
    outside: Outside,
    constants: Array,
    law_places: IntArray,
    v: Array,
    v_end: Array,
    reference: Array,
    speeds: Array,
    now: Array,
    laws: Array,
    t: float,
    h: float,
) -> None:
    """Ω², the reference rotation, which follows Ω from ``reference`` on, offsets of rates and levels of loads at t."""
    speed = row_product(outside.rows, outside.reference, v_end) + speeds[FRAME]
    mean = 0.5 * (speed + row_product(outside.rows, outside.reference, v) + reference[FRAME])
    speeds[TURNING], speeds[SQUARED] = speeds[FRAME], speed * speed
    if outside.reference_time < LONGEST:
        speeds[TURNING] = mean + (reference[TURNING] - mean) * math.exp(-h / outside.reference_time)
    for e in range(now.shape[1]):
        turned = constants[FOLLOW, e] * (speeds[TURNING] - speeds[FRAME])
        now[OFFSET, e] = constants[MEAN_RATE, e] * speeds[FRAME] - turned
    for l in range(laws.shape[1]):
        laws[LEVEL, l] = level_at(outside.level_start, outside.knots, law_places[LOAD_LEVEL, l], t)


@inner()
def _govern(outside: Outside, d: Driving, v: Array, v_end: Array, before: float, t: float, h: float) -> None:
    """Governors at the end t of a step, with the mean of their errors at both ends added up."""
    held, integral, extra, frame = d.governors[HELD], d.governors[GATHERED], d.sources[EXTRA], d.speeds[FRAME]
    govern(outside, t - h, 0.5 * h, before, v, integral, held, extra)
    govern(outside, t, 0.5 * h, frame, v_end, integral, held, extra)
    govern(outside, t, 0.0, frame, v_end, integral, held, extra)


@inner()
def begin_rung(
    masses: Masses,
    constants: Array,
    hinges: HingeRows,
    fill: Fill,
    now: Array,
    bent: Array,
    steady: Array,
    speeds: Array,
    m: Method,
    guard: bool,
) -> None:
    """The ``steady`` part of the step matrix, and contact times under the guard, for another step."""
    for i in range(hinges.of.size):
        own = hinges.values[CONTACT_TIME, i]
        stiff = guard and m.h * hinges.values[PACE, i] > 0.5
        bent[DELAY, i] = max(own, 0.5 * m.h) if stiff else own
    retangent(constants, hinges, now, bent, speeds, m)
    for k in range(steady.size):
        steady[k] = m.mu * masses.slots[k]
    for k in range(fill.steady):
        steady[fill.at[SLOT, k]] += fill.weight[k] * now[STEP, fill.at[ROW, k]]


@inner()
def retangent(constants: Array, hinges: HingeRows, now: Array, bent: Array, speeds: Array, m: Method) -> None:
    """Tangents of the hinges that are closed, at the Ω² of now; the factor is out of date."""
    tangents(constants, hinges, now, bent, speeds[SQUARED], m.by_angle, m.by_rate)
    speeds[VALID], speeds[BUILT_FOR] = 0.0, speeds[SQUARED]


@inner()
def refactor(
    tape: Tape, law_places: IntArray, fill: Fill, now: Array, laws: Array, solver: Solver, inertia: Array, mu: float
) -> bool:
    """The step matrix of now and its factor; False where it is not positive definite."""
    matrix = solver.matrix[MATRIX]
    for e in range(now.shape[1]):
        now[SHARE, e] = now[STEP, e]
    for l in range(laws.shape[1]):
        now[SHARE, law_places[LAW_OF, l]] += laws[SLOPE, l]
        laws[BUILT, l] = laws[SLOPE, l]
    for k in range(matrix.size):
        matrix[k] = solver.matrix[STEADY, k]
    for k in range(fill.steady, fill.bent):
        matrix[fill.at[SLOT, k]] += fill.weight[k] * now[SHARE, fill.at[ROW, k]]
    for k in range(fill.bent, fill.weight.size):
        matrix[fill.at[SLOT, k]] += fill.weight[k] * mu * inertia[fill.at[ROW, k]]
    return factor(tape, matrix, solver.lower, solver.inverse)


@merged()
def inertial(masses: Masses, acceleration: Array, out: Array) -> None:
    """M q̈."""
    for i in range(out.size):
        out[i] = masses.diagonal[i] * acceleration[i]
    for k in range(masses.above.size):
        i, j = masses.above_at[0, k], masses.above_at[1, k]
        out[i] += masses.above[k] * acceleration[j]
        out[j] += masses.above[k] * acceleration[i]


@inner()
def swing(rows: Rows, first: int, inertia: Array, acceleration: Array, x: Array) -> None:
    """x ← x − what the cranks' inertias hold against q̈, their rows beginning with the ``first``."""
    for k in range(inertia.size):
        spread(rows, first + k, -inertia[k] * row_product(rows, first + k, acceleration), x)


@inlined()
def solve(plan: Plan, w: Work, m: Method) -> None:
    """One pass: what is out of balance, its δ, the motion and the torques that follow from it."""
    tape, masses, pairs, rows, first = plan.tape, plan.masses, plan.pairs, plan.outside.rows, plan.outside.crank_row
    trial, now, laws, of, cranks, solver = w.trial, w.now, w.bent.laws, plan.laws.places, w.driving.cranks, w.solver
    node, left, ordered = tape.node, trial[INERTIAL], trial[ORDERED]
    inertial(masses, trial[ACCELERATION], left)
    for i in range(left.size):
        left[i] = trial[EXTERNAL, i] - left[i]
    scatter(pairs, now[TORQUE], left)
    for l in range(laws.shape[1]):
        scatter_one(pairs, of[LAW_OF, l], laws[LAW_TORQUE, l], left)
    if cranks.shape[1]:
        swing(rows, first, cranks[HEAVY], trial[ACCELERATION], left)
    for p in range(node.size):
        ordered[p] = left[node[p]]
    substitute(tape.couplings, solver.lower, solver.inverse, ordered)
    for p in range(node.size):
        left[node[p]] = ordered[p]
    for i in range(left.size):
        trial[DELTA, i] += left[i]
        trial[ACCELERATION, i] += m.mu * left[i]
    gather(pairs, left, now[MOVED])
    advance(now, m.by_angle, m.by_rate)
    for l in range(laws.shape[1]):
        laws[LAW_TORQUE, l] += laws[BUILT, l] * now[MOVED, of[LAW_OF, l]]
