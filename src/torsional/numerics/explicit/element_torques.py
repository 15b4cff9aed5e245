"""Torques and normal loads of all connections at recorded moments, from angles, rates and memories alone."""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import math

import numba
import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.callbacks import law_at
from torsional.numerics.explicit.rates import elastic_torque, normal_load
from torsional.numerics.motion.data import Connected
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
    count = c.stiffness.size
    angle, rate, elastic = np.empty(count), np.empty(count), np.empty(count)
    for s in range(time.size):
        frame = frame_at(outside.knots, outside.frame, time[s])[0]
        omega = row_product(outside.rows, outside.reference, v[s]) + frame
        ahead = turning[s] - frame if math.isfinite(outside.reference_time) else 0.0
        for e in range(count):
            angle[e] = row_product(c.rows, e, q[s])
            rate[e] = row_product(c.rows, e, v[s]) - c.follow[e] * ahead + c.mean_rate[e] * frame
            elastic[e] = elastic_torque(c, e, angle[e], rate[e], omega)
        for e in range(count):
            torque[s, e], load[s, e] = elastic[e], 0.0
            if c.address[e] != 0:
                values = c.law_values[c.law_start[e] : c.law_start[e + 1]].copy()
                if c.load_place[e] >= 0:
                    load[s, e] = normal_load(c, outside, e, time[s], omega, elastic)
                    values[c.load_place[e]] = load[s, e]
                law = law_at(c.address[e])
                torque[s, e] += law(values, angle[e], rate[e], memory[s, e], 0.0)[0]
