"""Torques and normal loads of all connections at recorded moments, from angles, rates and memories alone."""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.explicit.rates import connection_torques
from torsional.numerics.motion.data import Connected
from torsional.numerics.motion.sources import frame_at
from torsional.numerics.motion.tables import Outside


@numba.njit(cache=True, error_model="numpy")
def element_torques(
    c: Connected,
    outside: Outside,
    time: Array,
    q: Array,
    v: Array,
    memory: Array,
    turning: Array,
    torque: Array,
    load: Array,
) -> None:
    """Fill ``torque`` [Nm] and ``load`` (S, E) from times (S,), coordinates and their rates (S, N), memories (S, E) and
    the reference rotation Ω_r (S,) [rad/s]; the load of a law without a normal load that varies is zero.
    """
    values, told = c.laws.values.copy(), np.empty((4, c.constants.shape[1]))
    for s in range(time.size):
        moment = (time[s], frame_at(outside.knots, outside.frame, time[s])[0], turning[s])
        connection_torques(c, outside, moment, q[s], v[s], memory[s], values, told)
        torque[s], load[s] = told[2], told[3]
