"""Torques and normal loads of all connections at recorded moments, from angles, rates and memories alone."""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import math

import numba
import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.explicit.rates import elastic_torques
from torsional.numerics.motion.data import ADDRESS, LAW_OF, START, STOP, Connected
from torsional.numerics.motion.normal_load import press
from torsional.numerics.motion.sources import frame_at, row_product
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
    places, values, levels = c.laws.places, c.laws.values.copy(), (outside.level_start, outside.knots)
    angle, rate, elastic = np.empty((3, c.constants.shape[1]))
    for s in range(time.size):
        frame = frame_at(outside.knots, outside.frame, time[s])[0]
        omega = row_product(outside.rows, outside.reference, v[s]) + frame
        ahead = turning[s] - frame if math.isfinite(outside.reference_time) else 0.0
        elastic_torques(c, (q[s], v[s]), (frame, ahead, omega), angle, rate, elastic)
        torque[s], load[s] = elastic, 0.0
        for l in range(places.shape[1]):
            e, law = places[LAW_OF, l], law_at(places[ADDRESS, l])
            load[s, e] = press(c.laws, *levels, l, time[s], omega * omega, elastic, values)
            own = values[places[START, l] : places[STOP, l]]
            torque[s, e] += law(own, angle[e], rate[e], memory[s, e], 0.0)[0]
