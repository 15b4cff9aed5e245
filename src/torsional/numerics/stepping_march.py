"""The compiled loop over time steps: fixed ones, or halved and doubled as the error of the angles asks for."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.sparse_factor import PlaceArray
from torsional.numerics.stepping_forces import Bent, Connections
from torsional.numerics.stepping_ledger import book, stored
from torsional.numerics.stepping_plan import Constants, HingeRows, Masses, Plan
from torsional.numerics.stepping_settle import settle
from torsional.numerics.stepping_state import Count, Records, Settings, State, Status
from torsional.numerics.stepping_step import Driving, Method, Solver, Trial, Work, begin_rung
from torsional.numerics.uncounted import inlined, uncounted

ROOM = 0.1
"""Share of the error allowed below which twice the step is tried."""
PATIENCE = 4
"""Steps in a row with that much room before it is."""


def new_work(plan: Plan, state: State) -> Work:
    """Memory for a march from a state."""
    n, edges = plan.tape.node.size, plan.tape.column.size
    connections, hinges, laws = plan.pairs.left.size, plan.hinges.of.size, plan.laws.of.size
    sources, governors = plan.outside.driven.multiple.size, state.integral.size
    cranks = plan.outside.driven.crank_rows.start.size - 1
    values, pressed = plan.laws.values.copy(), plan.laws.load_at >= 0
    values[plan.laws.load_at[pressed]] = state.law[2, pressed]
    bent = Bent(
        facing=state.sense * plan.hinges.side,
        contact_time=np.zeros(hinges),
        torque=state.law[0].copy(),
        memory=state.law[1].copy(),
        load=state.law[2].copy(),
        slope=np.zeros(laws),
        built=np.zeros(laws),
        drag=np.zeros(laws),
        values=values,
    )
    counts = (sources, sources, governors, governors, cranks, cranks)
    driving = Driving._make([*(np.zeros(count) for count in counts), np.ones(laws), np.zeros(4)])
    driving.speeds[1:] = state.reference[[2, 0, 1]]
    now = Connections._make(np.zeros((10, connections)))
    solver = Solver._make(np.zeros(count) for count in (n + edges, n + edges, edges, n, 2))
    return Work(Trial._make(np.zeros((8, n))), solver, driving, now._replace(offset=state.connection[3].copy()), bent)


@inlined()
def rung_of(method: tuple[float, float, float, float], h: float) -> Method:
    """The numbers of a step of h from α_m, α_f, β, γ."""
    alpha_m, alpha_f, beta, gamma = method
    return Method(alpha_m, beta, gamma, (1.0 - alpha_m) / (1.0 - alpha_f), beta * h * h, gamma * h, h)


@inlined()
def _accept(plan: Plan, state: State, w: Work, h: float) -> None:
    """Make the trial the state."""
    book(plan, state, w, h)
    trial, now = w.trial, w.now
    q, v, acceleration, own = state.coordinates
    for i in range(trial.q.size):
        q[i], v[i], acceleration[i], own[i] = trial.q[i], trial.v[i], trial.acceleration[i], trial.own[i]
        state.external[i], state.inertial[i] = trial.external[i], trial.left[i]
    twist, rate, torque, offset = state.connection
    for e in range(now.twist.size):
        twist[e], rate[e], torque[e], offset[e] = now.twist[e], now.rate[e], now.torque[e], now.offset[e]
    for i in range(state.sense.size):
        state.sense[i] = w.bent.facing[i] * plan.hinges.side[i]
    for g in range(state.integral.size):
        state.integral[g] = w.driving.integral[g]
    speeds = w.driving.speeds
    state.reference[0], state.reference[1], state.reference[2] = speeds[2], speeds[3], speeds[1]


@uncounted()
def _error(own: Array, q: Array, before: Array, m: Method, settings: Settings) -> float:
    """Local error of the angles over what is allowed, h² |β − 1/6| |a⁺ − a|: Zienkiewicz and Xie, Earthq. Eng. Struct.
    Dyn. 20 (1991) 871."""
    worst, share = 0.0, m.h * m.h * abs(m.beta - 1.0 / 6.0)
    for i in range(q.size):
        allowed = settings.angle_error + settings.relative_error * abs(q[i])
        worst = max(worst, share * abs(own[i] - before[i]) / allowed)
    return worst


@uncounted()
def _move(coordinates: Array, counts: IntArray, rung: int) -> None:
    """Count steps of h/2^rung from here on; a stays ahead of q̈ by the same share of a step."""
    share = 0.5 ** (rung - counts[Count.RUNG])
    for i in range(coordinates.shape[1]):
        coordinates[3, i] = coordinates[2, i] + share * (coordinates[3, i] - coordinates[2, i])
    counts[Count.RUNG], counts[Count.PATIENCE] = rung, 0


@uncounted()
def _withdraw(side: Array, state: State, bent: Bent, speeds: Array) -> None:
    """Put back what a step that is not taken has changed."""
    for i in range(state.sense.size):
        bent.facing[i] = state.sense[i] * side[i]
    for l in range(bent.torque.size):
        bent.torque[l], bent.memory[l], bent.load[l] = state.law[0, l], state.law[1, l], state.law[2, l]
    speeds[1], speeds[2], speeds[3] = state.reference[2], state.reference[0], state.reference[1]
    state.counts[Count.REJECTED] += 1


@uncounted()
def run(
    plan: Plan,
    state: State,
    w: Work,
    settings: Settings,
    method: tuple[float, float, float, float],
    h: float,
    steps: int,
    at: IntArray,
    records: Records,
) -> int:
    """``steps`` base steps of h [s], recording after those listed in ``at``; a `Status`.

    A base step is as many smaller ones as the error asks for, counted in ticks of the smallest.
    """
    n, tick, ticks, counts, built = 0, 0, 1 << settings.rungs, state.counts, -1
    m = rung_of(method, h)
    k = record(plan.constants, plan.masses, plan.hinges, plan.laws.of, state, h, records, at, 0, n)
    while n < steps:
        rung = counts[Count.RUNG]
        if rung != built:
            m, built = rung_of(method, h * 0.5**rung), rung
            squared, now, solver = w.driving.speeds[3], w.now, w.solver
            guard, hinges = settings.guard, plan.hinges
            begin_rung(plan.masses, plan.constants, hinges, plan.steady, now, w.bent, solver, squared, m, guard)
        wide = ticks >> rung
        status = settle(
            plan, state, w, m, settings, state.begin[0] + (counts[Count.BASE_STEPS] + (tick + wide) / ticks) * h
        )
        error = 0.0
        if settings.rungs > 0:
            error = _error(w.trial.own, w.trial.q, state.coordinates[3], m, settings)
            if (status != Status.DONE or not error <= 1.0) and rung < settings.rungs:
                _withdraw(plan.hinges.side, state, w.bent, w.driving.speeds)
                _move(state.coordinates, counts, rung + 1)
                continue
        if status != Status.DONE:
            return status
        _accept(plan, state, w, m.h)
        tick += wide
        counts[Count.PATIENCE] = counts[Count.PATIENCE] + 1 if rung > 0 and error < ROOM else 0
        if rung > 0 and counts[Count.PATIENCE] >= PATIENCE and tick % (2 * wide) == 0:
            _move(state.coordinates, counts, rung - 1)
        if tick == ticks:
            tick, n = 0, n + 1
            counts[Count.BASE_STEPS] += 1
            k = record(plan.constants, plan.masses, plan.hinges, plan.laws.of, state, h, records, at, k, n)
    return Status.DONE


@uncounted()
def _put(values: Array, out: Array) -> None:
    for i in range(values.size):
        out[i] = values[i]


@uncounted()
def record(
    constants: Constants,
    masses: Masses,
    hinges: HingeRows,
    law_of: PlaceArray,
    state: State,
    h: float,
    records: Records,
    at: IntArray,
    k: int,
    n: int,
) -> int:
    """The state into the places from k on that are meant for step n; the place that is next."""
    while k < at.size and at[k] == n:
        stored(constants, masses, hinges, state)
        records.time[k] = state.begin[0] + state.counts[Count.BASE_STEPS] * h
        _put(state.coordinates[0], records.q[k])
        _put(state.coordinates[1], records.v[k])
        _put(state.coordinates[2], records.acceleration[k])
        _put(state.connection[0], records.twist[k])
        _put(state.connection[2], records.torque[k])
        _put(state.ledger, records.ledger[k])
        for l in range(law_of.size):
            records.torque[k, law_of[l]] += state.law[0, l]
            records.memory[k, l], records.load[k, l] = state.law[1, l], state.law[2, l]
            records.lost[k, l] = state.passed[3, law_of[l]]
        k += 1
    return k
