"""The normal load of a law, in compiled code."""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import (
    LOAD_AT,
    LOAD_CONSTANT,
    LOAD_LEVEL,
    LOAD_SQUARED,
    SHARES_START,
    SHARES_STOP,
    Laws,
)
from torsional.numerics.motion.sources import level_at
from torsional.numerics.uncounted import merged, uncounted


@merged()
def normal_load(laws: Laws, l: int, level: float, squared: float, torque: Array) -> float:
    """N = max(0, constant level + c Ω² + Σ share |T|) of law l [N], from its level, Ω² = ``squared`` and the torques of
    springs, hinges and dampers (E,) [Nm]."""
    load = laws.loads[LOAD_CONSTANT, l] * level + laws.loads[LOAD_SQUARED, l] * squared
    for k in range(laws.places[SHARES_START, l], laws.places[SHARES_STOP, l]):
        load += laws.shares[k] * abs(torque[laws.load_of[k]])
    return max(0.0, load)


@uncounted()
def press(
    laws: Laws, level_start: IntArray, knots: Array, l: int, t: float, squared: float, torque: Array, values: Array
) -> float:
    """The load of law l at a time t [s], into the ``values`` of all laws too; 0 where none varies."""
    if laws.places[LOAD_AT, l] < 0:
        return 0.0
    load = normal_load(laws, l, level_at(level_start, knots, laws.places[LOAD_LEVEL, l], t), squared, torque)
    values[laws.places[LOAD_AT, l]] = load
    return load
