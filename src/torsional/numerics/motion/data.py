"""The arrays that time stepping works on: what is the same at every step, as plain numbers.

    Σ_m J_m v_m (v_m·q̈) + Σ_e w_e [k_e φ_e + c_e φ̇_e + F_e(φ_e, φ̇_e, memory_e)] = Σ_s r_s T_s(t, angle) + Σ_g n_g T_g

with φ_e = w_e·q.  Coordinates q are angles relative to a frame that turns with ``frame_speed``; a rigid rotation is the
vector of ones.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.linear.sparse_factor import PlaceArray

SPRING, DAMPER, CENTRIFUGAL, FOLLOW, MEAN_RATE = range(5)
"""Rows of the ``constants`` of connections."""
GAP, SIDE, CHANGE, CONTACT_TIME = range(4)
"""Rows of the hinges' ``values``."""
LAW_OF, ADDRESS, REMEMBERS, START, STOP, LOAD_AT, LOAD_LEVEL, SHARES_START, SHARES_STOP = range(9)
"""Rows of the laws' ``places``: connection, kernel, memory, ``values``, place of the load there or −1, level and
``shares`` of the load."""
LOAD_CONSTANT, LOAD_SQUARED = range(2)
"""Rows of the laws' ``loads``: that part of the load which follows a level, and that which follows Ω²."""
PENDULUM = 7
"""Numbers that describe a pendulum."""
LEAK = 5
"""Numbers that describe a leak."""


class Rows(NamedTuple):
    """Sparse rows over the coordinates: row i has ``weight[start[i]:start[i + 1]]`` at ``column[…]``."""

    start: IntArray
    column: IntArray
    weight: Array


class HingeRows(NamedTuple):
    """Hinges (H,) of connections ``of``, those of one in a row, with their ``values`` (4, H).

    Each is s max(0, Δk (s(φ − g) + τ s φ̇)) for Δk > 0; a negative Δk (a stage that ends) has τ = 0 and
    max(0, s(φ − g)).
    """

    of: PlaceArray
    values: Array


class Laws(NamedTuple):
    """Laws (L,) that are no sums of hinges: ``places`` (9, L), their ``values`` end to end, ``loads`` (2, L).

    Where LOAD_AT ≥ 0 the value there is the normal load N of the law and follows

        N_l = max(0, load_constant_l level(t) + load_squared_l Ω² + Σ_k share_k |torque of load_of_k|)

    with the level LOAD_LEVEL of `Driven` (−1: one): a clutch that engages.  ``load_of`` are connections, their
    torques those of springs, hinges and dampers; those of a law are from SHARES_START to SHARES_STOP.
    """

    places: IntArray
    values: Array
    loads: Array
    load_of: PlaceArray
    shares: Array

    @property
    def of(self) -> IntArray:
        """Their connections."""
        return np.asarray(self.places[LAW_OF])


class Connected(NamedTuple):
    """Connections e: a spring and a damper along w_e, its ``constants`` (5, E), and what bends beside them.

    FOLLOW: w_e·1 where a damper or a law to ground acts on the deviation from the reference rotation, else 0; the rate
    is w_e·q̇ − follow_e (Ω_r − frame_speed).  MEAN_RATE: share of the frame's speed that is added to the rate where the
    whole speed counts (road load, brakes), else 0.  CENTRIFUGAL [Nms²/rad]: more stiffness times Ω².
    """

    rows: Rows
    constants: Array
    hinges: HingeRows
    laws: Laws


class Driven(NamedTuple):
    """Sources s along the rows r_s, T_s = level_s(t) P_s(angle_s), angle_s = multiple_s (φ_f(t) + feedback_s r_s·q) +
    phase_s.

    φ_f(t) = ∫ frame speed dt is the angle of the frame, ``multiple`` the source's speed over that of the reference
    node, ``feedback`` 1/(r_s·1) where the part's own motion moves the events (r_s·1 is ``multiple`` for a row of the
    part's own angle) and 0 where they keep to the mean rotation.
    Profile p is periodic in 2π ``period[p]``: cubic pieces, evenly spaced, ``profile[profile_start[p] + i]`` =
    coefficients (4,), lowest power first, of the share of the interval.  ``profile_of`` −1 is a profile of one.
    Level p is linear between knots ``level_time``, ``level_value`` from ``level_start[p]`` on and constant beyond;
    ``level_of`` −1 is a level of one.

    Cranks m with a reciprocating mass, exactly: along ``crank_rows`` the torque −m x'(x'' θ̇² + x' θ̈) with the
    crank's angle θ = crank_multiple φ_f + r_m·q + ``crank_phase`` (r_m·1 is the multiple), ``crank_mass``,
    ``crank_radius``, ``crank_rod``, ``crank_offset``, less what of it is an inertia already (``crank_included``
    [kgm²]).

    Behind the cranks stand three more of their rows for each of the ``pendulums`` (P, 7): that of its carrier's
    angle, that of its way s along the path, and their sum.  The table has mass, distance, radius of curvature,
    flattening (`pendulum_path`), place on the carrier from the top, the sum of the carrier's row,
    gravity; m c² (θ̇ + ṡ/c)² is among the masses.
    """

    rows: Rows
    multiple: Array
    phase: Array
    feedback: Array
    profile_of: IntArray
    profile_start: IntArray
    profile: Array
    period: Array
    level_of: IntArray
    level_start: IntArray
    level_time: Array
    level_value: Array
    crank_rows: Rows
    crank_multiple: Array
    crank_phase: Array
    crank_mass: Array
    crank_radius: Array
    crank_rod: Array
    crank_offset: Array
    crank_included: Array
    pendulums: Array = np.zeros((0, PENDULUM))


class Governed(NamedTuple):
    """Governors g: T_g = clip(k_p e + ∫ k_i e dt, low, high), e = wanted(t) − speed, sampled once a step.

    The speed is that of ``sense`` (whole speed, with the frame), wanted(t) the level ``wanted_of``.  A governor
    acts as a torque along ``act`` rows, or where ``source_start`` lists sources, as a factor on top of their
    level: T_s = (level + T_g) P_s.

    The last of them are the charges of cylinders that leak while they stand, ``leaks`` (C, 5): the source of each,
    whose level the charge less one is, the rate 1/τ [1/s], the angles between which its valves are open [rad] and the
    profile of the crankcase's pressure over its own (`torsional.numerics.motion.leaking`); their gains are nought.
    """

    sense: Rows
    act: Rows
    wanted_of: IntArray
    proportional: Array
    integral: Array
    low: Array
    high: Array
    source_start: IntArray
    source: IntArray
    leaks: Array = np.zeros((0, LEAK))


class Equations(NamedTuple):
    """All of one system: masses J_m along the rows v_m, connections, sources, governors, the frame, the reference.

    ``reference`` is one row whose w·q̇ + frame speed is the speed Ω of centrifugal forces and normal loads.  The
    reference rotation Ω_r follows Ω with the time constant ``reference_time`` [s]; infinite: Ω_r stays the frame's
    speed.  The frame's speed is linear between knots ``frame_time``, ``frame_value`` and constant beyond; its
    acceleration exerts no torque (an ideal drive).
    """

    coordinates: int
    mass_rows: Rows
    inertia: Array
    connected: Connected
    driven: Driven
    governed: Governed
    reference: Rows
    reference_time: float
    frame_time: Array
    frame_value: Array


def rows_of(dense: Array) -> Rows:
    """Dense rows (rows, coordinates) as sparse ones; zeros are left out.

    >>> rows_of(np.array([[0.0, -1.0, 1.0]]))
    Rows(start=array([0, 2]), column=array([1, 2]), weight=array([-1.,  1.]))
    """
    table = np.asarray(dense, dtype=float)
    row, column = np.nonzero(table)
    counts = np.bincount(row, minlength=len(table))
    return Rows(np.append(0, np.cumsum(counts)).astype(np.int64), column.astype(np.int64), table[row, column])
