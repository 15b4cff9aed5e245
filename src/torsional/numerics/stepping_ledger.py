"""Where the energy of a time step went.

The angle gained times the mean of the torques at both ends is work, for every torque; their sum is the kinetic energy
gained but for what the method makes of its own.  A hinge that opens or closes inside a step acts along a part of the
angle only: what the mean counts beyond that is the method's own too.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import functools

from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.stepping_forces import Bent, Connections
from torsional.numerics.stepping_plan import Constants, HingeRows, Laws, Masses, Plan
from torsional.numerics.stepping_state import Entry, State
from torsional.numerics.stepping_step import Trial, Work, inertial
from torsional.numerics.uncounted import inlined, uncounted

PLACES = (0.046910077030668, 0.2307653449471585, 0.5, 0.7692346550528415, 0.953089922969332)
SHARES = (0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454)
"""Gauss's five places between 0 and 1, and how much each counts."""

summed = functools.partial(inlined, fastmath={"reassoc", "contract"})


@summed()
def _nodal(masses: Masses, state: State, trial: Trial, ledger: Array) -> float:
    """Work of the sources; what the kinetic energy gained beyond the work of all torques, M q̈ in ``trial.left``."""
    q, v = state.coordinates[0], state.coordinates[1]
    worked, through, made = 0.0, 0.0, 0.0
    for i in range(trial.q.size):
        turned = trial.q[i] - q[i]
        work = 0.5 * (state.external[i] + trial.external[i]) * turned
        worked += work
        through += abs(work)
        made += (trial.v[i] + v[i]) * masses.diagonal[i] * (trial.v[i] - v[i])
        made -= (state.inertial[i] + trial.left[i]) * turned
    for k in range(masses.above.size):
        i, j, m = masses.above_row[k], masses.above_column[k], masses.above[k]
        made += m * ((trial.v[i] + v[i]) * (trial.v[j] - v[j]) + (trial.v[j] + v[j]) * (trial.v[i] - v[i]))
    ledger[Entry.WORKED] += worked
    ledger[Entry.THROUGHPUT] += through
    return 0.5 * made


@summed()
def _damped(
    plan_damping: Array, before: Array, now: Connections, h: float, moving: bool, ledger: Array, passed: Array
) -> float:
    """Loss in dampers, booked; that in hinges closed all along, given back; and the work of what rates count from."""
    damped, all_of_it = 0.0, 0.0
    for e in range(now.twist.size):
        slipped = (now.twist[e] - before[0, e]) * 0.5 * (now.rate[e] + before[1, e])
        damped += plan_damping[e] * slipped
        passed[1, e] += 0.5 * abs((now.torque[e] + before[2, e]) * (now.twist[e] - before[0, e]))
        all_of_it += now.damping[e] * slipped
    struck = all_of_it - damped
    if moving:
        for e in range(now.twist.size):
            rate = 0.5 * (now.rate[e] + before[1, e])
            dragged = plan_damping[e] * rate * 0.5 * h * (now.offset[e] + before[3, e])
            damped += dragged
            ledger[Entry.WORKED] += dragged
            ledger[Entry.THROUGHPUT] += abs(dragged)
    ledger[Entry.DAMPED] += damped
    return struck


@inlined()
def _turned(hinges: HingeRows, facing: Array, state: State) -> bool:
    """Whether some hinge opens or closes in the step, or one is closed by its rate alone, ahead of its spring."""
    turned = False
    for i in range(hinges.of.size):
        beyond = hinges.side[i] * (state.connection[0, hinges.of[i]] - hinges.gap[i])
        turned |= state.sense[i] * hinges.side[i] != facing[i]
        turned |= (state.sense[i] > 0.0) & (beyond < 0.0)
    return turned


@uncounted()
def _struck(hinges: HingeRows, bent: Bent, now: Connections, state: State, ledger: Array) -> float:
    """Loss in hinges of a step in which some open or close; what the method makes of its own there."""
    made = 0.0
    for i in range(hinges.of.size):
        e, side, change = hinges.of[i], hinges.side[i], hinges.change[i]
        was, closed = state.sense[i] > 0.0, bent.facing[i] * side > 0.0
        if not was and not closed:
            continue
        x0, x1 = side * (state.connection[0, e] - hinges.gap[i]), side * (now.twist[e] - hinges.gap[i])
        y0 = x0 + bent.contact_time[i] * side * state.connection[1, e]
        y1 = x1 + bent.contact_time[i] * side * now.rate[e]
        if was and closed:
            kept = 0.5 * (max(0.0, x1) ** 2 - max(0.0, x0) ** 2)
            ledger[Entry.STRUCK] += change * (0.5 * (y0 + y1) * (x1 - x0) - kept)
            continue
        at = x0 + (x1 - x0) * (y0 / (y0 - y1) if y0 != y1 else 0.5)
        if was:
            ledger[Entry.STRUCK] += 0.5 * change * (y0 * (at - x0) + max(0.0, x0) ** 2)
            own = 0.5 * change * y0 * (at - x1)
        else:
            ledger[Entry.STRUCK] += 0.5 * change * (y1 * (x1 - at) - max(0.0, x1) ** 2)
            own = 0.5 * change * y1 * (x0 - at)
        state.passed[0, e] += own
        made += own
    return made


@uncounted()
def _guarded(hinges: HingeRows, bent: Bent, now: Connections, state: State) -> None:
    """Loss in the contact times that the guard gave beyond the contacts' own, by connection."""
    for i in range(hinges.of.size):
        more = hinges.change[i] * (bent.contact_time[i] - hinges.contact_time[i])
        if more > 0.0:
            e, torque = hinges.of[i], 0.0
            if state.sense[i] > 0.0:
                torque += more * state.connection[1, e]
            if bent.facing[i] * hinges.side[i] > 0.0:
                torque += more * now.rate[e]
            state.passed[2, e] += 0.5 * torque * (now.twist[e] - state.connection[0, e])


@uncounted()
def _integral(address: int, values: Array, start: float, turned: float) -> float:
    """Integral of a law's torque at rest over an angle, after Gauss."""
    torque, total = law_at(address), 0.0
    for i in range(len(PLACES)):
        total += SHARES[i] * torque(values, start + PLACES[i] * turned, 0.0, 0.0, 0.0)[0]
    return total * turned


@uncounted()
def _rubbed(laws: Laws, bent: Bent, now: Connections, state: State, h: float, ledger: Array) -> float:
    """What laws kept and lost, and what the method made of its own where the mean of a torque is not its integral.

    A law with memory keeps k_el z²/2, one without the integral of its torque at rest.
    """
    made = 0.0
    for l in range(laws.of.size):
        e, torque = laws.of[l], law_at(laws.address[l])
        values = bent.values[laws.start[l] : laws.stop[l]]
        turned, mean = now.twist[e] - state.connection[0, e], 0.5 * (bent.torque[l] + state.law[0, l])
        beside = mean * 0.5 * h * (now.offset[e] + state.connection[3, e])
        told = torque(values, now.twist[e], 0.0, bent.memory[l], 0.0)
        felt = 0.5 * (told[0] + state.law[4, l]) * turned
        if not laws.remembers[l]:
            kept = _integral(laws.address[l], values, state.connection[0, e], turned)
            state.passed[0, e] += kept - felt
            made += kept - felt
        else:
            pressed = 0.5 * bent.memory[l] * state.law[1, l] * (told[1] - state.law[4, l])
            felt = kept = 0.5 * told[1] * bent.memory[l] ** 2 - state.law[3, l]
            beside += pressed
        ledger[Entry.WORKED] += beside
        ledger[Entry.THROUGHPUT] += abs(beside)
        lost = mean * turned + beside - felt
        ledger[Entry.RUBBED] += lost
        state.passed[3, e] += lost
        state.passed[1, e] += abs(mean * turned)
        state.law[0, l], state.law[1, l], state.law[2, l] = bent.torque[l], bent.memory[l], bent.load[l]
        state.law[3, l] += kept
        state.law[4, l] = told[1] if laws.remembers[l] else told[0]
    return made


@uncounted()
def _stiffened(centrifugal: Array, more: float, twist: Array, before: Array, ledger: Array) -> None:
    """Work of the rotation that stiffens connections by centrifugal forces, Ω² being ``more`` than before."""
    for e in range(twist.size):
        work = 0.5 * centrifugal[e] * more * twist[e] * before[0, e]
        ledger[Entry.WORKED] += work
        ledger[Entry.THROUGHPUT] += abs(work)


@inlined()
def book(plan: Plan, state: State, w: Work, h: float) -> None:
    """Enter a step into the ledger, before the state moves on; the laws' part of the state moves on with it."""
    trial, ledger = w.trial, state.ledger
    _guarded(plan.hinges, w.bent, w.now, state)
    inertial(plan.masses, trial.acceleration, trial.left)
    made = _nodal(plan.masses, state, trial, ledger)
    turned = _turned(plan.hinges, w.bent.facing, state)
    struck = _damped(plan.constants.damping, state.connection, w.now, h, plan.moving, ledger, state.passed)
    if turned:
        made += _struck(plan.hinges, w.bent, w.now, state, ledger)
    else:
        ledger[Entry.STRUCK] += struck
    if w.bent.torque.size:
        made += _rubbed(plan.laws, w.bent, w.now, state, h, ledger)
    if plan.spinning:
        more = w.driving.speeds[3] - state.reference[1]
        _stiffened(plan.constants.centrifugal, more, w.now.twist, state.connection, ledger)
    ledger[Entry.MADE] += made
    ledger[Entry.PRODUCED] += max(0.0, made)


@uncounted()
def stored(constants: Constants, masses: Masses, hinges: HingeRows, state: State) -> None:
    """Kinetic and strain energy of a state into its ledger."""
    v, kinetic, strain = state.coordinates[1], 0.0, 0.0
    for i in range(v.size):
        kinetic += 0.5 * masses.diagonal[i] * v[i] * v[i]
    for k in range(masses.above.size):
        kinetic += masses.above[k] * v[masses.above_row[k]] * v[masses.above_column[k]]
    for e in range(constants.stiffness.size):
        stiffness = constants.stiffness[e] + state.reference[1] * constants.centrifugal[e]
        strain += 0.5 * stiffness * state.connection[0, e] ** 2
    for i in range(hinges.of.size):
        if state.sense[i] > 0.0:
            beyond = max(0.0, hinges.side[i] * (state.connection[0, hinges.of[i]] - hinges.gap[i]))
            strain += 0.5 * hinges.change[i] * beyond * beyond
    for l in range(state.law.shape[1]):
        strain += state.law[3, l]
    state.ledger[Entry.KINETIC], state.ledger[Entry.STRAIN] = kinetic, strain
