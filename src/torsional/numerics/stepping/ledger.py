"""Where the energy of a time step went.

The angle gained times the mean of the torques at both ends is work, for every torque; their sum is the kinetic energy
gained but for what the method makes of its own.  A hinge that opens or closes inside a step acts along a part of the
angle only: what the mean counts beyond that is the method's own too.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import depth
from torsional.numerics.motion.data import (
    ADDRESS,
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    DAMPER,
    GAP,
    LAW_OF,
    REMEMBERS,
    SIDE,
    SPRING,
    START,
    STOP,
    HingeRows,
    Laws,
)
from torsional.numerics.stepping.forces import DAMPING, DELAY, FACING, Bent
from torsional.numerics.stepping.plan import Masses, Plan
from torsional.numerics.stepping.state import (
    ACCELERATION,
    EXTERNAL,
    GUARDED,
    INERTIAL,
    LAW_TORQUE,
    LOAD,
    LOST,
    MADE,
    MEMORY,
    OFFSET,
    RATE,
    REST,
    SQUARED,
    STRAIN,
    THROUGH,
    TORQUE,
    TWIST,
    Entry,
    Q,
    State,
    V,
)
from torsional.numerics.stepping.step import Work, inertial
from torsional.numerics.uncounted import inlined, inner, merged, uncounted

PLACES = (0.046910077030668, 0.2307653449471585, 0.5, 0.7692346550528415, 0.953089922969332)
SHARES = (0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454)
"""Gauss's five places between 0 and 1, and how much each counts."""


@merged()
def _nodal(masses: Masses, now: Array, trial: Array, ledger: Array) -> float:
    """Work of the sources; what the kinetic energy gained beyond the work of all torques."""
    worked, through, made = 0.0, 0.0, 0.0
    for i in range(trial.shape[1]):
        turned = trial[Q, i] - now[Q, i]
        work = 0.5 * (now[EXTERNAL, i] + trial[EXTERNAL, i]) * turned
        worked += work
        through += abs(work)
        made += (trial[V, i] + now[V, i]) * masses.diagonal[i] * (trial[V, i] - now[V, i])
        made -= (now[INERTIAL, i] + trial[INERTIAL, i]) * turned
    for k in range(masses.above.size):
        i, j, m = masses.above_at[0, k], masses.above_at[1, k], masses.above[k]
        first = (trial[V, i] + now[V, i]) * (trial[V, j] - now[V, j])
        made += m * (first + (trial[V, j] + now[V, j]) * (trial[V, i] - now[V, i]))
    ledger[Entry.WORKED] += worked
    ledger[Entry.THROUGHPUT] += through
    return 0.5 * made


@merged()
def _damped(constants: Array, before: Array, now: Array, h: float, moving: bool, ledger: Array) -> float:
    """Loss in dampers, booked; that in hinges closed all along, given back; and the work of what rates count from."""
    damped, all_of_it = 0.0, 0.0
    for e in range(now.shape[1]):
        turned = now[TWIST, e] - before[TWIST, e]
        slipped = turned * 0.5 * (now[RATE, e] + before[RATE, e])
        damped += constants[DAMPER, e] * slipped
        before[THROUGH, e] += 0.5 * abs((now[TORQUE, e] + before[TORQUE, e]) * turned)
        all_of_it += now[DAMPING, e] * slipped
    struck = all_of_it - damped
    if moving:
        for e in range(now.shape[1]):
            rate = 0.5 * (now[RATE, e] + before[RATE, e])
            dragged = constants[DAMPER, e] * rate * 0.5 * h * (now[OFFSET, e] + before[OFFSET, e])
            damped += dragged
            ledger[Entry.WORKED] += dragged
            ledger[Entry.THROUGHPUT] += abs(dragged)
    ledger[Entry.DAMPED] += damped
    return struck


@merged()
def _turned(hinges: HingeRows, bent: Array, twist: Array, sense: Array) -> bool:
    """Whether some hinge opens or closes in the step, or one is closed by its rate alone, ahead of its spring."""
    turned = False
    for i in range(hinges.of.size):
        side = hinges.values[SIDE, i]
        beyond = depth(twist[hinges.of[i]], 0.0, hinges.values[GAP, i], side, 0.0)
        turned |= sense[i] * side != bent[FACING, i]
        turned |= (sense[i] > 0.0) & (beyond < 0.0)
    return turned


@inner()
def _struck(hinges: HingeRows, bent: Array, now: Array, before: Array, sense: Array, ledger: Array) -> float:
    """Loss in hinges of a step in which some open or close; what the method makes of its own there."""
    made = 0.0
    for i in range(hinges.of.size):
        e, side, change, gap = hinges.of[i], hinges.values[SIDE, i], hinges.values[CHANGE, i], hinges.values[GAP, i]
        was, closed = sense[i] > 0.0, bent[FACING, i] * side > 0.0
        if not was and not closed:
            continue
        x0, x1 = depth(before[TWIST, e], 0.0, gap, side, 0.0), depth(now[TWIST, e], 0.0, gap, side, 0.0)
        y0 = depth(before[TWIST, e], before[RATE, e], gap, side, bent[DELAY, i])
        y1 = depth(now[TWIST, e], now[RATE, e], gap, side, bent[DELAY, i])
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
        before[MADE, e] += own
        made += own
    return made


@merged()
def _guarded(hinges: HingeRows, bent: Array, now: Array, before: Array, sense: Array) -> None:
    """Loss in the contact times that the guard gave beyond the contacts' own, by connection."""
    for i in range(hinges.of.size):
        more = hinges.values[CHANGE, i] * (bent[DELAY, i] - hinges.values[CONTACT_TIME, i])
        if more > 0.0:
            e, torque = hinges.of[i], 0.0
            if sense[i] > 0.0:
                torque += more * before[RATE, e]
            if bent[FACING, i] * hinges.values[SIDE, i] > 0.0:
                torque += more * now[RATE, e]
            before[GUARDED, e] += 0.5 * torque * (now[TWIST, e] - before[TWIST, e])


@inner()
def _integral(address: int, values: Array, start: float, turned: float) -> float:
    """Integral of a law's torque at rest over an angle, after Gauss."""
    torque, total = law_at(address), 0.0
    for i in range(len(PLACES)):
        total += SHARES[i] * torque(values, start + PLACES[i] * turned, 0.0, 0.0, 0.0)[0]
    return total * turned


@inner()
def _rubbed(laws: Laws, bent: Bent, now: Array, before: Array, law: Array, h: float, ledger: Array) -> float:
    """What laws kept and lost, and what the method made of its own where the mean of a torque is not its integral.

    A law with memory keeps k_el z²/2, one without the integral of its torque at rest.
    """
    made, places = 0.0, laws.places
    for l in range(places.shape[1]):
        e, torque, address = places[LAW_OF, l], law_at(places[ADDRESS, l]), places[ADDRESS, l]
        values, memory = bent.values[places[START, l] : places[STOP, l]], bent.laws[MEMORY, l]
        turned, mean = now[TWIST, e] - before[TWIST, e], 0.5 * (bent.laws[LAW_TORQUE, l] + law[LAW_TORQUE, l])
        beside = mean * 0.5 * h * (now[OFFSET, e] + before[OFFSET, e])
        told = torque(values, now[TWIST, e], 0.0, memory, 0.0)
        felt = 0.5 * (told[0] + law[REST, l]) * turned
        if not places[REMEMBERS, l]:
            kept = _integral(address, values, before[TWIST, e], turned)
            before[MADE, e] += kept - felt
            made += kept - felt
        else:
            pressed = 0.5 * memory * law[MEMORY, l] * (told[1] - law[REST, l])
            felt = kept = 0.5 * told[1] * memory**2 - law[STRAIN, l]
            beside += pressed
        ledger[Entry.WORKED] += beside
        ledger[Entry.THROUGHPUT] += abs(beside)
        lost = mean * turned + beside - felt
        ledger[Entry.RUBBED] += lost
        before[LOST, e] += lost
        before[THROUGH, e] += abs(mean * turned)
        for row in range(LOAD + 1):
            law[row, l] = bent.laws[row, l]
        law[STRAIN, l] += kept
        law[REST, l] = told[1] if places[REMEMBERS, l] else told[0]
    return made


@inner()
def _stiffened(constants: Array, more: float, now: Array, before: Array, ledger: Array) -> None:
    """Work of the rotation that stiffens connections by centrifugal forces, Ω² being ``more`` than before."""
    for e in range(now.shape[1]):
        work = 0.5 * constants[CENTRIFUGAL, e] * more * now[TWIST, e] * before[TWIST, e]
        ledger[Entry.WORKED] += work
        ledger[Entry.THROUGHPUT] += abs(work)


@inlined()
def book(plan: Plan, state: State, w: Work, h: float) -> None:
    """Enter a step into the ledger, before the state moves on; the laws' part of the state moves on with it."""
    masses, constants, hinges, laws, moving = plan.masses, plan.constants, plan.hinges, plan.laws, plan.moving
    trial, now, bent, spinning, squared = w.trial, w.now, w.bent, plan.spinning, w.driving.speeds[SQUARED]
    ledger, before, q, sense, law = state.ledger, state.connection, state.coordinates, state.sense, state.law
    more = squared - state.reference[SQUARED]
    _guarded(hinges, bent.hinges, now, before, sense)
    inertial(masses, trial[ACCELERATION], trial[INERTIAL])
    made = _nodal(masses, q, trial, ledger)
    turned = _turned(hinges, bent.hinges, before[TWIST], sense)
    struck = _damped(constants, before, now, h, moving, ledger)
    if turned:
        made += _struck(hinges, bent.hinges, now, before, sense, ledger)
    else:
        ledger[Entry.STRUCK] += struck
    if bent.laws.shape[1]:
        made += _rubbed(laws, bent, now, before, law, h, ledger)
    if spinning:
        _stiffened(constants, more, now, before, ledger)
    ledger[Entry.MADE] += made
    ledger[Entry.PRODUCED] += max(0.0, made)


@uncounted()
def stored(constants: Array, masses: Masses, hinges: HingeRows, state: State) -> None:
    """Kinetic and strain energy of a state into its ledger."""
    kinetic, strain, q, at = 0.0, 0.0, state.coordinates, state.connection
    for i in range(q.shape[1]):
        kinetic += 0.5 * masses.diagonal[i] * q[V, i] * q[V, i]
    for k in range(masses.above.size):
        kinetic += masses.above[k] * q[V, masses.above_at[0, k]] * q[V, masses.above_at[1, k]]
    for e in range(at.shape[1]):
        stiffness = constants[SPRING, e] + state.reference[SQUARED] * constants[CENTRIFUGAL, e]
        strain += 0.5 * stiffness * at[TWIST, e] ** 2
    for i in range(hinges.of.size):
        if state.sense[i] > 0.0:
            beyond = max(0.0, depth(at[TWIST, hinges.of[i]], 0.0, hinges.values[GAP, i], hinges.values[SIDE, i], 0.0))
            strain += 0.5 * hinges.values[CHANGE, i] * beyond * beyond
    for l in range(state.law.shape[1]):
        strain += state.law[STRAIN, l]
    state.ledger[Entry.KINETIC], state.ledger[Entry.STRAIN] = kinetic, strain
