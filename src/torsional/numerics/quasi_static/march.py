"""Torques while one angle is moved slowly: no inertia, friction that remembers, springs that only push; compiled.

The last coordinate is moved, the others find their balance at the end of every step,

    Σ_e w_e [k_e φ_e + c_e φ̇_e + F_e(φ_e, φ̇_e, memory_e)] = 0,   φ̇ = Δφ/Δt,

by Newton's method in them (an active set for hinges), memories by the laws' own kernels: backward Euler.  Everything
reads the arrays of `torsional.numerics.motion.data`; levels over time count as one, the reference turns steadily.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from torsional.numerics.arrays import Array
from torsional.numerics.linear.small import backsolve, factor
from torsional.numerics.motion.data import LAW_OF, LOAD_AT, SHARES_START, SHARES_STOP, Connected
from torsional.numerics.quasi_static.torques import Work, evaluate
from torsional.numerics.uncounted import uncounted

ITERATIONS = 60
CUTS = 25  # of one Newton step
LEAST = 2.0**-20  # of a step: no shorter one is tried
QUICK = 1e-5
"""Time [s] below which no step is shortened for the sake of a jump."""
NEAR = 1e-10
"""What may be left of the balance, over the largest torque."""
ROUNDING = 2.0**-50
ENOUGH = 0.5
"""A whole Newton step is taken where the unbalanced torque along it falls to this."""


_factor = uncounted(fastmath={"contract"})(factor.py_func)
_backsolve = uncounted()(backsolve.py_func)


@uncounted()
def unbalanced(c: Connected, old: Array, place: Array, w: Work) -> bool:
    """What is left of the balance of every free coordinate; whether it is next to nothing."""
    free = w.rest.size
    for i in range(free):
        w.rest[i] = w.hold[0] * (place[i] - old[i])
    largest, rounding = 0.0, 0.0
    for e in range(w.torque.size):
        largest = max(largest, abs(w.torque[e]))
        rounding = max(rounding, w.slope[e] * max(abs(w.angle[e]), w.reach[0]))
        for k in range(c.rows.start[e], c.rows.start[e + 1]):
            if c.rows.column[k] < free:
                w.rest[c.rows.column[k]] += c.rows.weight[k] * w.torque[e]
    left = 0.0
    for i in range(free):
        left = max(left, abs(w.rest[i]))
    return bool(left <= NEAR * largest + ROUNDING * rounding)


@uncounted()
def _add(c: Connected, e: int, j: int, slope: float, w: Work) -> None:
    """Adds w_e w_jᵀ times a slope to the tangent."""
    free = w.rest.size
    for k in range(c.rows.start[e], c.rows.start[e + 1]):
        row = c.rows.column[k]
        if row < free:
            for m in range(c.rows.start[j], c.rows.start[j + 1]):
                column = c.rows.column[m]
                if column < free:
                    w.tangent[row, column] += slope * c.rows.weight[k] * c.rows.weight[m]


@uncounted()
def _newton_step(c: Connected, w: Work) -> bool:
    """The Newton step into ``move``; whether there is one."""
    laws = c.laws
    w.tangent[:] = 0.0
    for e in range(w.slope.size):
        _add(c, e, e, w.slope[e], w)
    for l in range(laws.places.shape[1]):
        e = laws.places[LAW_OF, l]
        if laws.places[LOAD_AT, l] >= 0 and w.load[e] > 0.0:
            for k in range(laws.places[SHARES_START, l], laws.places[SHARES_STOP, l]):
                j = laws.load_of[k]
                side = 1.0 if w.spring[j] > 0.0 else -1.0
                _add(c, e, j, w.load_slope[e] * laws.shares[k] * side * w.spring_slope[j], w)
    for i in range(w.rest.size):
        w.tangent[i, i] += w.hold[0]
        w.move[i] = -w.rest[i]
    if _factor(w.tangent, w.order) == 0.0:
        return False
    _backsolve(w.tangent, w.order, w.move)
    return True


@uncounted()
def _power(w: Work) -> float:
    """The unbalanced torque along the Newton step: negative before the balance."""
    total = 0.0
    for i in range(w.rest.size):
        total += w.rest[i] * w.move[i]
    return total


@uncounted()
def settle(c: Connected, square: float, old: Array, place: Array, memory: Array, step: float, w: Work) -> bool:
    """Moves the free coordinates of ``place`` to their balance at the end of a step; whether they found it.

    Springs and dry friction have a convex potential: the Newton step is cut where the unbalanced torque along it
    changes its sign, which is the lowest place along it.
    """
    evaluate(c, square, old, place, memory, step, w)
    free = w.rest.size
    for _ in range(ITERATIONS):
        if unbalanced(c, old, place, w):
            return True
        if not _newton_step(c, w):
            return False
        before = _power(w)
        low, high, gone, chosen = 0.0, 1.0, 0.0, 1.0
        for _ in range(CUTS):
            for i in range(free):
                place[i] += (chosen - gone) * w.move[i]
            gone = chosen
            evaluate(c, square, old, place, memory, step, w)
            unbalanced(c, old, place, w)
            now = _power(w)
            if not before < 0.0 or abs(now) <= ENOUGH * abs(before) or high - low < 1e-9:
                break
            if now > 0.0:
                high = chosen
            elif chosen == 1.0:
                break
            else:
                low = chosen
            chosen = 0.5 * (low + high)
    return False


@uncounted()
def _coarse(old: Array, place: Array, step: float, w: Work) -> bool:
    """Whether free coordinates went far from where their pace would have taken them, in a step that may be cut."""
    largest = 0.0
    for i in range(old.size - 1):
        largest = max(largest, abs(place[i] - old[i] - step * w.pace[i]))
    return step > QUICK and largest > w.reach[1]


@uncounted()
def _advance(
    c: Connected, square: float, old: Array, place: Array, memory: Array, drive: float, step: float, w: Work
) -> bool:
    """One step to ``drive`` from ``old``, begun at the pace of the one before, or else from rest."""
    free = w.rest.size
    found = False
    for guess in range(2):
        if not found:
            for i in range(free):
                place[i] = old[i] + (1 - guess) * step * w.pace[i]
            place[free] = drive
            found = settle(c, square, old, place, memory, step, w)
    return found


@uncounted()
def _copy(given: Array, to: Array) -> None:
    for i in range(given.size):
        to[i] = given[i]


@uncounted()
def moved(c: Connected, square: float, place: Array, memory: Array, drive: float, step: float, w: Work) -> int:
    """Moves the last coordinate to ``drive`` within ``step`` [s], in shorter steps where it must be; ``place`` and
    ``memory`` are brought along.  Returns how many of them found no balance.

    Where friction lets go the steps become so short that the speed in between is that which dampers allow: what a
    jump loses then depends on no step.
    """
    free = w.rest.size
    first, done, share, lost = place[free], 0.0, 1.0, 0
    old, rough = w.old, False
    _copy(place, old)
    while done < 1.0:
        ok = _advance(c, square, old, place, memory, first + (drive - first) * (done + share), share * step, w)
        if not ok and rough:  # a shorter step finds nothing, the longer one did
            share *= 2.0
            ok = _advance(c, square, old, place, memory, first + (drive - first) * (done + share), share * step, w)
        elif share > LEAST and (not ok or _coarse(old, place, share * step, w)):
            rough = ok
            share *= 0.5
            continue
        rough = False
        lost += 0 if ok else 1
        for i in range(free):
            w.pace[i] = (place[i] - old[i]) / (share * step)
        _copy(place, old)
        _copy(w.memory, memory)
        done += share
        share = min(2.0 * share, 1.0 - done)
    return lost


@uncounted()
def march(
    c: Connected,
    square: float,
    place: Array,
    memory: Array,
    drive: Array,
    step: float,
    w: Work,
    places: Array,
    told: Array,
) -> int:
    """Moves the last coordinate along ``drive`` (samples,), ``step`` [s] each; into ``places`` (samples, coordinates)
    and ``told`` (2, samples, E): torques, normal loads.  Returns how many steps found no balance."""
    lost = 0
    for s in range(drive.size):
        lost += moved(c, square, place, memory, drive[s], step, w)
        _copy(place, places[s])
        _copy(w.torque, told[0, s])
        _copy(w.load, told[1, s])
    return lost
