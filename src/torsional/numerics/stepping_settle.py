"""The passes of one time step: until the hinges that are closed repeat and the torques of laws agree."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from torsional.numerics.sources import row_product
from torsional.numerics.stepping_forces import bend, disagreeing, drags, gather, press, torques, turn
from torsional.numerics.stepping_plan import Laws, Loads, Plan
from torsional.numerics.stepping_state import Count, Settings, State, Status
from torsional.numerics.stepping_step import Method, Work, drive, predict, refactor, retangent, solve, spread
from torsional.numerics.uncounted import inlined, uncounted

STRIKES = 3
"""Passes in which no fewer hinges disagree before they are turned one by one, which always ends."""


@inlined()
def settle(plan: Plan, state: State, w: Work, m: Method, settings: Settings, t: float) -> int:
    """The motion at the end t of a step into the trial of ``w``; a `Status`, and what it took into the counters."""
    trial, now, counts = w.trial, w.now, state.counts
    predict(state, trial, m)
    drive(plan, state, w, t, m.h)
    gather(plan.pairs, trial.q, now.twist)
    gather(plan.pairs, trial.v, now.rate)
    if plan.moving:
        for e in range(now.rate.size):
            now.rate[e] += now.offset[e]
    if plan.spinning and w.driving.speeds[3] != w.solver.built[1]:
        retangent(plan.constants, plan.hinges, now, w.bent, w.solver, w.driving.speeds[3], m)
    torques(now)
    if w.bent.torque.size:
        drags(plan.laws, w.bent, state.connection, state.law[1])
        _laws(plan.loads, plan.laws, state, w, m, 0)
    if w.driving.crank_inertia.size:
        w.solver.built[0] = 0.0
    status = _passes(plan, state, w, m, settings)
    for i in range(trial.q.size):
        trial.q[i] += m.by_angle * trial.delta[i]
        trial.v[i] += m.by_rate * trial.delta[i]
        trial.own[i] += trial.delta[i]
    rows = plan.outside.driven.crank_rows
    for k in range(w.driving.crank_inertia.size):
        spread(rows, k, -w.driving.crank_inertia[k] * row_product(rows, k, trial.acceleration), trial.external)
    counts[Count.STEPS] += 1
    return status


@inlined()
def _passes(plan: Plan, state: State, w: Work, m: Method, settings: Settings) -> int:
    """Solve until nothing changes."""
    fewest, strikes, counts = plan.hinges.of.size + 1, STRIKES, state.counts
    for n in range(1, settings.passes + 1 + 4 * plan.hinges.of.size):
        if w.solver.built[0] == 0.0:
            counts[Count.FACTORS] += 1
            inertia = w.driving.crank_inertia
            if not refactor(plan.tape, plan.laws, plan.bent, plan.cranks, w.now, w.bent, w.solver, inertia, m.mu):
                return Status.INDEFINITE
        solve(plan, w, m)
        counts[Count.SOLVES] += 1
        wrong = disagreeing(plan.hinges, w.bent, w.now)
        off = 0.0
        if wrong:
            strikes = STRIKES if wrong < fewest else strikes - 1
            fewest = min(fewest, wrong)
            counts[Count.FALLBACKS] += strikes < 0
            turn(plan.hinges, w.bent, w.now, strikes < 0)
            retangent(plan.constants, plan.hinges, w.now, w.bent, w.solver, w.driving.speeds[3], m)
            torques(w.now)
        if w.bent.torque.size:
            off = _laws(plan.loads, plan.laws, state, w, m, n)
        if not wrong and off <= settings.agreement * _largest(w):
            return Status.DONE
    return Status.UNSETTLED


@uncounted()
def _laws(loads: Loads, laws: Laws, state: State, w: Work, m: Method, n: int) -> float:
    """Torques, tangents and normal loads of the laws at the motion of now; how far off they were [Nm]."""
    press(loads, laws, w.now, w.bent, w.driving.speeds[3], w.driving.levels)
    steps = (m.by_angle, m.by_rate)
    off = bend(laws, w.now, w.bent, state.connection, state.law[1], m.h, steps, n)
    for l in range(w.bent.slope.size):
        if w.bent.slope[l] != w.bent.built[l]:
            w.solver.built[0] = 0.0
    return off


@inlined()
def _largest(w: Work) -> float:
    """The largest torque of a connection or law [Nm], where there are laws."""
    largest = 1e-300
    if w.bent.torque.size:
        for e in range(w.now.torque.size):
            largest = max(largest, abs(w.now.torque[e]))
        for l in range(w.bent.torque.size):
            largest = max(largest, abs(w.bent.torque[l]))
    return largest
