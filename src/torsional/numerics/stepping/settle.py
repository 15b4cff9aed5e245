"""The passes of one time step: until the hinges that are closed repeat and the torques of laws agree."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import Laws
from torsional.numerics.stepping.forces import (
    BUILT,
    SLOPE,
    Bent,
    bend,
    disagreeing,
    drags,
    gather,
    press,
    torques,
    turn,
)
from torsional.numerics.stepping.plan import Plan
from torsional.numerics.stepping.state import (
    ACCELERATION,
    DELTA,
    EXTERNAL,
    LAW_TORQUE,
    MEMORY,
    OFFSET,
    OWN,
    RATE,
    SQUARED,
    TORQUE,
    TWIST,
    Count,
    Q,
    Settings,
    State,
    Status,
    V,
)
from torsional.numerics.stepping.step import (
    BUILT_FOR,
    HEAVY,
    VALID,
    Method,
    Work,
    drive,
    predict,
    refactor,
    retangent,
    rotate,
    solve,
    swing,
)
from torsional.numerics.uncounted import inlined, inner, merged

STRIKES = 3
"""Passes in which no fewer hinges disagree before they are turned one by one, which always ends."""


@inlined()
def settle(plan: Plan, state: State, w: Work, m: Method, settings: Settings, t: float) -> int:
    """The motion at the end t of a step into the trial of ``w``; a `Status`, and what it took into the counters."""
    outside, constants, hinges, pairs, laws = plan.outside, plan.constants, plan.hinges, plan.pairs, plan.laws
    trial, now, driving, bent, moving, spinning = w.trial, w.now, w.driving, w.bent, plan.moving, plan.spinning
    q, before, memory, counts = state.coordinates, state.connection, state.law[MEMORY], state.counts
    integral, reference, rows, first = state.integral, state.reference, outside.rows, outside.crank_row
    speeds = driving.speeds
    predict(q, trial, m)
    drive(outside, q[V], integral, driving, trial, t, m.h)
    if moving or spinning:
        rotate(outside, constants, laws.places, q[V], trial[V], reference, speeds, now, bent.laws, t, m.h)
    gather(pairs, trial[Q], now[TWIST])
    gather(pairs, trial[V], now[RATE])
    if moving:
        for e in range(now.shape[1]):
            now[RATE, e] += now[OFFSET, e]
    if spinning and speeds[SQUARED] != speeds[BUILT_FOR]:
        retangent(constants, hinges, now, bent.hinges, speeds, m)
    torques(now)
    if bent.laws.shape[1]:
        drags(laws.places, bent, before, memory)
        _bend_all(laws, before, memory, now, bent, speeds, m, 0)
    if driving.cranks.shape[1]:
        speeds[VALID] = 0.0
    status = _passes(plan, state, w, m, settings)
    for i in range(trial.shape[1]):
        trial[Q, i] += m.by_angle * trial[DELTA, i]
        trial[V, i] += m.by_rate * trial[DELTA, i]
        trial[OWN, i] += trial[DELTA, i]
    if driving.cranks.shape[1]:
        swing(rows, first, driving.cranks[HEAVY], trial[ACCELERATION], trial[EXTERNAL])
    counts[Count.STEPS] += 1
    return status


@inlined()
def _passes(plan: Plan, state: State, w: Work, m: Method, settings: Settings) -> int:
    """Solve until nothing changes."""
    hinges, laws, tape, fill, constants = plan.hinges, plan.laws, plan.tape, plan.fill, plan.constants
    now, bent, speeds, inertia, solver = w.now, w.bent, w.driving.speeds, w.driving.cranks[HEAVY], w.solver
    before, memory, counts, agreement = state.connection, state.law[MEMORY], state.counts, settings.agreement
    fewest, strikes, most = hinges.of.size + 1, STRIKES, settings.passes + 1 + 4 * hinges.of.size
    for n in range(1, most):
        if speeds[VALID] == 0.0:
            counts[Count.FACTORS] += 1
            speeds[VALID] = 1.0
            if not refactor(tape, laws.places, fill, now, bent.laws, solver, inertia, m.mu):
                return Status.INDEFINITE
        solve(plan, w, m)
        counts[Count.SOLVES] += 1
        wrong = disagreeing(hinges, bent.hinges, now)
        off = 0.0
        if wrong:
            strikes = STRIKES if wrong < fewest else strikes - 1
            fewest = min(fewest, wrong)
            counts[Count.FALLBACKS] += strikes < 0
            turn(hinges, bent.hinges, now, strikes < 0)
            retangent(constants, hinges, now, bent.hinges, speeds, m)
            torques(now)
        if bent.laws.shape[1]:
            off = _bend_all(laws, before, memory, now, bent, speeds, m, n)
        if not wrong and off <= agreement * _largest(now, bent.laws):
            return Status.DONE
    return Status.UNSETTLED


@inner()
def _bend_all(
    laws: Laws, before: Array, memory: Array, now: Array, bent: Bent, speeds: Array, m: Method, n: int
) -> float:
    """Torques, tangents and normal loads of the laws at the motion of now; how far off they were [Nm]."""
    press(laws, now, bent, speeds[SQUARED])
    off, own = bend(laws, now, bent, before, memory, m.h, (m.by_angle, m.by_rate), n), bent.laws
    for l in range(own.shape[1]):
        if own[SLOPE, l] != own[BUILT, l]:
            speeds[VALID] = 0.0
    return off


@merged()
def _largest(now: Array, laws: Array) -> float:
    """The largest torque of a connection or law [Nm], where there are laws."""
    largest = 1e-300
    if laws.shape[1]:
        for e in range(now.shape[1]):
            largest = max(largest, abs(now[TORQUE, e]))
        for l in range(laws.shape[1]):
            largest = max(largest, abs(laws[LAW_TORQUE, l]))
    return largest
