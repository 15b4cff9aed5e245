"""How deep a hinge is in: the one definition, for laws, steps and ledgers."""

from __future__ import annotations

from typing import TypeVar

from numba.extending import register_jitable

from torsional.numerics.arrays import Array

ROUNDING = 1e-15
"""Share of a hinge's angle by which it may be on the wrong side: all that rounding leaves to tell."""
Number = TypeVar("Number", float, Array)


@register_jitable
def depth(angle: Number, rate: Number, gap: Number, side: Number, time: Number) -> Number:
    """s (φ − g + τ φ̇) [rad] beyond the gap g on the side s = ±1, with a contact time τ [s]; closed where positive.

    >>> depth(-0.75, -2.0, gap=-0.25, side=-1.0, time=0.125)
    0.75
    """
    return side * (angle - gap + time * rate)


@register_jitable
def wrongly(facing: float, angle: float, rate: float, gap: float, time: float) -> bool:
    """Whether a hinge taken for one ``facing`` (its side where it is closed, the other where open) is the other way
    round, by more than rounding.

    >>> wrongly(1.0, 0.2, 0.0, gap=0.1, time=0.0), wrongly(-1.0, 0.2, 0.0, gap=0.1, time=0.0)
    (False, True)
    """
    return depth(angle, rate, gap, facing, time) < -ROUNDING * (abs(gap) + abs(angle))
