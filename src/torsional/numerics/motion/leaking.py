"""Cylinders that stand still and leak past their rings, in compiled code."""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.motion.sources import TURN, profile_at, row_product
from torsional.numerics.motion.tables import (
    CLOSES,
    FEEDBACK,
    LEAK_RATE,
    LEAK_SOURCE,
    MULTIPLE,
    OPENS,
    PHASE,
    RATIO_PERIOD,
    RATIO_START,
    RATIO_STOP,
    Outside,
)
from torsional.numerics.uncounted import uncounted

STANDING = 20.0
"""Crank speed [rad/s] from which nothing leaks that is not in the pressure of a running engine already."""


@uncounted()
def leak_towards(outside: Outside, k: int, frame: tuple[float, float], q: Array, v: Array) -> tuple[float, float]:
    """What charge k less one tends to, p_c/p − 1, and how fast [1/s], at the frame's angle and speed; 0 and infinitely
    fast where its valves are open.

        ċ = −(c − p_c/p(θ)) (1 − |θ̇|/ω_s)/τ while |θ̇| < ω_s = `STANDING`, so that c p falls to the crankcase's p_c
    """
    leaks, s = outside.leaks, int(outside.leaks[LEAK_SOURCE, k])
    multiple, feedback = outside.sources[MULTIPLE, s], outside.sources[FEEDBACK, s]
    angle = multiple * (frame[0] + feedback * row_product(outside.rows, s, q)) + outside.sources[PHASE, s]
    cycle = TURN * leaks[RATIO_PERIOD, k]
    angle -= cycle * np.floor(angle / cycle)
    if leaks[OPENS, k] < angle < leaks[CLOSES, k]:
        return 0.0, np.inf
    turning = abs(multiple * (frame[1] + feedback * row_product(outside.rows, s, v)))
    if not turning < STANDING:
        return 0.0, 0.0
    first, last = int(leaks[RATIO_START, k]), int(leaks[RATIO_STOP, k])
    ratio = profile_at(outside.profile, first, last, leaks[RATIO_PERIOD, k], angle)
    return ratio - 1.0, leaks[LEAK_RATE, k] * (1.0 - turning / STANDING)


@uncounted()
def leak(outside: Outside, step: float, frame: tuple[float, float], q: Array, v: Array, integral: Array) -> None:
    """Charges less one, the last of ``integral`` [-], after a ``step`` [s] that ends at q, v, in place."""
    first = integral.size - outside.leaks.shape[1]
    for k in range(outside.leaks.shape[1]):
        s = int(outside.leaks[LEAK_SOURCE, k])
        speed = outside.sources[FEEDBACK, s] * row_product(outside.rows, s, v) + frame[1]
        if integral[first + k] == 0.0 and not abs(outside.sources[MULTIPLE, s] * speed) < STANDING:
            continue  # full and running, as nearly always
        end, rate = leak_towards(outside, k, frame, q, v)
        if rate > 0.0:
            integral[first + k] = end + (integral[first + k] - end) * np.exp(-rate * step)
