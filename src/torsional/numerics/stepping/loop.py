"""The compiled loop over time steps: fixed ones, or halved and doubled as the error of the angles asks for."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import LAW_OF, LOAD_AT, SIDE, HingeRows
from torsional.numerics.stepping.forces import CONNECTION_ROWS, FACING, LAW_ROWS, LEVEL, Bent
from torsional.numerics.stepping.ledger import book, stored
from torsional.numerics.stepping.plan import Masses, Plan
from torsional.numerics.stepping.settle import settle
from torsional.numerics.stepping.state import (
    ACCELERATION,
    DELTA,
    FRAME,
    LAW_TORQUE,
    LOAD,
    LOST,
    MEMORY,
    OFFSET,
    OWN,
    TORQUE,
    TWIST,
    Count,
    Q,
    Records,
    Settings,
    State,
    Status,
    V,
)
from torsional.numerics.stepping.step import GATHERED, STEADY, Driving, Method, Solver, Work, begin_rung
from torsional.numerics.uncounted import inlined, inner, uncounted

ROOM = 0.1
"""Share of the error allowed below which twice the step is tried."""
PATIENCE = 4
"""Steps in a row with that much room before it is."""


def new_work(plan: Plan, state: State) -> Work:
    """Memory for a march from a state."""
    n, edges, outside = plan.tape.node.size, plan.tape.couplings.shape[1], plan.outside
    hinges, laws = plan.hinges.of.size, plan.laws.places.shape[1]
    cranks = outside.cranks.shape[1] + 3 * len(outside.pendulums)
    bent = Bent(np.zeros((2, hinges)), np.zeros((LAW_ROWS, laws)), plan.laws.values.copy())
    pressed = plan.laws.places[LOAD_AT] >= 0
    bent.values[plan.laws.places[LOAD_AT, pressed]] = state.law[LOAD, pressed]
    bent.hinges[FACING] = state.sense * plan.hinges.values[SIDE]
    bent.laws[: LOAD + 1], bent.laws[LEVEL] = state.law[: LOAD + 1], 1.0
    shapes = (outside.sources.shape[1], outside.governors.shape[1], cranks)
    sources, governors, moving = (np.zeros((2, count)) for count in shapes)
    driving = Driving(sources, governors, moving, np.append(state.reference, np.zeros(3)))
    now = np.zeros((CONNECTION_ROWS, plan.constants.shape[1]))
    now[OFFSET] = state.connection[OFFSET]
    solver = Solver(np.zeros((2, n + edges)), np.zeros(edges), np.zeros(n))
    return Work(np.zeros((8, n)), solver, driving, now, bent)


@inlined()
def _rung_of(method: tuple[float, float, float, float], h: float) -> Method:
    """The numbers of a step of h from α_m, α_f, β, γ."""
    alpha_m, alpha_f, beta, gamma = method
    return Method(alpha_m, beta, gamma, (1.0 - alpha_m) / (1.0 - alpha_f), beta * h * h, gamma * h, h)


@inlined()
def _accept(plan: Plan, state: State, w: Work, h: float) -> None:
    """Make the trial the state."""
    book(plan, state, w, h)
    trial, now, facing, held, speeds = w.trial, w.now, w.bent.hinges[FACING], w.driving.governors, w.driving.speeds
    q, at, sense, sides = state.coordinates, state.connection, state.sense, plan.hinges.values[SIDE]
    integral, reference = state.integral, state.reference
    for row in range(DELTA):
        for i in range(trial.shape[1]):
            q[row, i] = trial[row, i]
    for row in range(OFFSET + 1):
        for e in range(now.shape[1]):
            at[row, e] = now[row, e]
    for i in range(sense.size):
        sense[i] = facing[i] * sides[i]
    for g in range(integral.size):
        integral[g] = held[GATHERED, g]
    for place in range(FRAME + 1):
        reference[place] = speeds[place]


@inner()
def _error(trial: Array, before: Array, m: Method, settings: Settings) -> float:
    """Local error of the angles over what is allowed, h² |β − 1/6| |a⁺ − a|: Zienkiewicz and Xie, Earthq. Eng. Struct.
    Dyn. 20 (1991) 871."""
    worst, share = 0.0, m.h * m.h * abs(m.beta - 1.0 / 6.0)
    for i in range(trial.shape[1]):
        allowed = settings.angle_error + settings.relative_error * abs(trial[Q, i])
        worst = max(worst, share * abs(trial[OWN, i] - before[OWN, i]) / allowed)
    return worst


@inner()
def _move(coordinates: Array, counts: IntArray, rung: int) -> None:
    """Count steps of h/2^rung from here on; a stays ahead of q̈ by the same share of a step."""
    share = 0.5 ** (rung - counts[Count.RUNG])
    for i in range(coordinates.shape[1]):
        ahead = coordinates[OWN, i] - coordinates[ACCELERATION, i]
        coordinates[OWN, i] = coordinates[ACCELERATION, i] + share * ahead
    counts[Count.RUNG], counts[Count.PATIENCE] = rung, 0


@inner()
def _withdraw(sides: Array, state: State, bent: Bent, speeds: Array) -> None:
    """Put back what a step that is not taken has changed."""
    for i in range(state.sense.size):
        bent.hinges[FACING, i] = state.sense[i] * sides[i]
    for row in range(LOAD + 1):
        for l in range(bent.laws.shape[1]):
            bent.laws[row, l] = state.law[row, l]
    for place in range(FRAME + 1):
        speeds[place] = state.reference[place]
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
    masses, constants, hinges, fill, law_places = plan.masses, plan.constants, plan.hinges, plan.fill, plan.laws.places
    begin, q, counts, trial = state.begin[0], state.coordinates, state.counts, w.trial
    now, bent, speeds = w.now, w.bent, w.driving.speeds
    n, tick, ticks, built, m, steady = 0, 0, 1 << settings.rungs, -1, _rung_of(method, h), w.solver.matrix[STEADY]
    k = record(constants, masses, hinges, law_places, state, h, records, at, 0, n)
    while n < steps:
        rung = counts[Count.RUNG]
        if rung != built:
            m, built = _rung_of(method, h * 0.5**rung), rung
            begin_rung(masses, constants, hinges, fill, now, bent.hinges, steady, speeds, m, settings.guard)
        wide = ticks >> rung
        status = settle(plan, state, w, m, settings, begin + (counts[Count.BASE_STEPS] + (tick + wide) / ticks) * h)
        error = 0.0
        if settings.rungs > 0:
            error = _error(trial, q, m, settings)
            if (status != Status.DONE or not error <= 1.0) and rung < settings.rungs:
                _withdraw(hinges.values[SIDE], state, bent, speeds)
                _move(q, counts, rung + 1)
                continue
        if status != Status.DONE:
            return status
        _accept(plan, state, w, m.h)
        tick += wide
        counts[Count.PATIENCE] = counts[Count.PATIENCE] + 1 if rung > 0 and error < ROOM else 0
        if rung > 0 and counts[Count.PATIENCE] >= PATIENCE and tick % (2 * wide) == 0:
            _move(q, counts, rung - 1)
        if tick == ticks:
            tick, n = 0, n + 1
            counts[Count.BASE_STEPS] += 1
            k = record(constants, masses, hinges, law_places, state, h, records, at, k, n)
    return Status.DONE


@inner()
def _put(values: Array, out: Array) -> None:
    for i in range(values.size):
        out[i] = values[i]


@inner()
def record(
    constants: Array,
    masses: Masses,
    hinges: HingeRows,
    law_places: IntArray,
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
        _put(state.coordinates[Q], records.motion[0, k])
        _put(state.coordinates[V], records.motion[1, k])
        _put(state.coordinates[ACCELERATION], records.motion[2, k])
        _put(state.connection[TWIST], records.connection[0, k])
        _put(state.connection[TORQUE], records.connection[1, k])
        _put(state.ledger, records.ledger[k])
        for l in range(law_places.shape[1]):
            records.connection[1, k, law_places[LAW_OF, l]] += state.law[LAW_TORQUE, l]
            records.law[0, k, l], records.law[1, k, l] = state.law[MEMORY, l], state.law[LOAD, l]
            records.law[2, k, l] = state.connection[LOST, law_places[LAW_OF, l]]
        k += 1
    return k
