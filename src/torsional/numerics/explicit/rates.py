"""Right-hand side ẏ = f(t, y) of the arrays of time stepping, for integrators that only evaluate it.

y = (q, q̇, Ω_r, I_g of the governors, z of the connections that remember).
"""
# mypy: disable-error-code="untyped-decorator,no-any-return"

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numba
import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.callbacks import law_at
from torsional.numerics.hinge import depth
from torsional.numerics.linear.small import backsolve, factor
from torsional.numerics.motion.data import (
    ADDRESS,
    CENTRIFUGAL,
    CHANGE,
    CONTACT_TIME,
    DAMPER,
    FOLLOW,
    GAP,
    LAW_OF,
    MEAN_RATE,
    REMEMBERS,
    SIDE,
    SPRING,
    START,
    STOP,
    Connected,
    Equations,
    Rows,
)
from torsional.numerics.motion.leaking import leak_towards
from torsional.numerics.motion.normal_load import press
from torsional.numerics.motion.sources import (
    crank_terms,
    frame_at,
    governed_torque,
    governor_error,
    row_product,
    source_torques,
)
from torsional.numerics.motion.tables import SOURCE_START, SOURCE_STOP, Outside, outside_of

FILLING = 1e3
"""How fast cylinders fill through open valves [1/s]: at once, but so that a step can follow it."""


class Places(NamedTuple):
    """What a right-hand side needs beside the connections: M (N, N) without pistons, its inverse; where memories are.

    ``memory`` (E,): a connection's place among the memories, or −1; ``flow`` (E,): where its rate is told;
    ``governor``, ``memories``: where I_g and z begin in y, of ``size`` entries.
    """

    outside: Outside
    mass: Array
    inverse: Array
    memory: IntArray
    flow: IntArray
    governor: int
    memories: int
    size: int


def places(equations: Equations, flows: Mapping[int, int] | None = None) -> Places:
    """Work out masses and places once; ``flows``: where the rate of its memory is, by the address of a law's kernel.

    Raises ModelError for coordinates without mass and for laws with another memory, which has no rate.
    """
    connected, n = equations.connected, equations.coordinates
    laws = connected.laws
    remembers = laws.of[laws.places[REMEMBERS] != 0]
    flow, memory = np.zeros((2, connected.constants.shape[1]), dtype=np.int64)
    flow[laws.of] = [(flows or {}).get(address, 0) for address in laws.places[ADDRESS].tolist()]
    if not flow[remembers].all():
        remedy = "take the implicit steps, or LuGre friction"
        raise ModelError("this law's memory has no rate to be integrated explicitly", remedy=remedy)
    mass = np.zeros((n, n))
    _add_masses(equations.mass_rows, equations.inertia, mass, 0)
    if np.linalg.matrix_rank(mass, hermitian=True) < n:
        raise ModelError("explicit integration needs a mass at every coordinate", remedy="condense massless ones first")
    memory[:] = -1
    memory[remembers] = np.arange(remembers.size)
    governor = 2 * n + 1
    memories = governor + equations.governed.proportional.size
    inverse = np.asarray(np.linalg.inv(mass), dtype=float)
    return Places(outside_of(equations), mass, inverse, memory, flow, governor, memories, memories + remembers.size)


@numba.njit(cache=True, error_model="numpy")
def _add_masses(rows: Rows, inertia: Array, mass: Array, first: int) -> None:
    """Add Σ J_m v_m v_mᵀ to M (N, N), of the rows from the ``first`` on."""
    for m in range(inertia.size):
        begin, end = rows.start[first + m], rows.start[first + m + 1]
        for i in range(begin, end):
            for j in range(begin, end):
                mass[rows.column[i], rows.column[j]] += inertia[m] * rows.weight[i] * rows.weight[j]


@numba.njit(cache=True, error_model="numpy")
def add_row(rows: Rows, i: int, factor: float, out: Array) -> None:
    """Add ``factor`` times row i to ``out`` (N,)."""
    for k in range(rows.start[i], rows.start[i + 1]):
        out[rows.column[k]] += factor * rows.weight[k]


@numba.njit(cache=True, error_model="numpy")
def _elastic_torques(c: Connected, q: Array, v: Array, turning: tuple[float, float, float], told: Array) -> None:
    """Angles, rates and torques [Nm] of springs, dampers and hinges, with or without contact times, into rows of told.

    ``turning``: the frame's speed, what the reference rotation is ahead of it, Ω.
    """
    frame, ahead, omega = turning
    constants, hinges, angle, rate, torque = c.constants, c.hinges, told[0], told[1], told[2]
    for e in range(torque.size):
        angle[e] = row_product(c.rows, e, q)
        rate[e] = row_product(c.rows, e, v) - constants[FOLLOW, e] * ahead + constants[MEAN_RATE, e] * frame
        stiffness = constants[SPRING, e] + constants[CENTRIFUGAL, e] * omega * omega
        torque[e] = stiffness * angle[e] + constants[DAMPER, e] * rate[e]
    for h in range(hinges.of.size):
        e, side = hinges.of[h], hinges.values[SIDE, h]
        beyond = depth(angle[e], rate[e], hinges.values[GAP, h], side, hinges.values[CONTACT_TIME, h])
        if beyond > 0.0:
            torque[e] += side * hinges.values[CHANGE, h] * beyond


@numba.njit(cache=True, error_model="numpy")
def connection_torques(
    c: Connected,
    outside: Outside,
    moment: tuple[float, float, float],
    q: Array,
    v: Array,
    memory: Array,
    values: Array,
    told: Array,
) -> None:
    """Angles, rates, torques [Nm] and normal loads of all connections, (4, E), with the loads in the laws' ``values``.

    ``moment``: time, the frame's speed, Ω_r; ``memory`` (E,).  A load that does not vary is zero.
    """
    t, frame, turning = moment
    places, angle, rate, torque, load = c.laws.places, told[0], told[1], told[2], told[3]
    omega = row_product(outside.rows, outside.reference, v) + frame
    ahead = turning - frame if math.isfinite(outside.reference_time) else 0.0
    _elastic_torques(c, q, v, (frame, ahead, omega), told)
    load[:] = 0.0
    for l in range(places.shape[1]):  # all before a law adds its torque to those of springs
        level_start, knots = outside.level_start, outside.knots
        load[places[LAW_OF, l]] = press(c.laws, level_start, knots, l, t, omega * omega, torque, values)
    for l in range(places.shape[1]):
        e, law, own = places[LAW_OF, l], law_at(places[ADDRESS, l]), values[places[START, l] : places[STOP, l]]
        torque[e] += law(own, angle[e], rate[e], memory[e], 0.0)[0]


@numba.njit(cache=True, error_model="numpy")
def _connect(c: Connected, at: Places, t: float, y: Array, frame: float, torque: Array, out: Array) -> None:
    """Take the torques of all connections from ``torque`` (N,), and put the rates of memories into ``out``."""
    n, places, count = torque.size, c.laws.places, c.constants.shape[1]
    told, memory, values = np.empty((4, count)), np.zeros(count), c.laws.values.copy()
    for e in range(count):
        if at.memory[e] >= 0:
            memory[e] = y[at.memories + at.memory[e]]
    connection_torques(c, at.outside, (t, frame, y[2 * n]), y[:n], y[n : 2 * n], memory, values, told)
    for l in range(places.shape[1]):
        if places[REMEMBERS, l]:
            e, own = places[LAW_OF, l], values[places[START, l] : places[STOP, l]]
            flowing = law_at(at.flow[e])
            out[at.memories + at.memory[e]] = flowing(own, told[0, e], told[1, e], memory[e], 0.0)[0]
    for e in range(count):
        add_row(c.rows, e, -told[2, e], torque)


@numba.njit(cache=True, error_model="numpy")
def _drive(at: Places, t: float, y: Array, frame: tuple[float, float], torque: Array, out: Array) -> None:
    """Add the torques of sources and governors, whose integrals' rates go into ``out``."""
    outside, n = at.outside, torque.size
    extra, torques = np.zeros(outside.sources.shape[1]), np.empty(outside.sources.shape[1])
    for g in range(outside.governors.shape[1]):
        error = governor_error(outside, g, t, frame[0], y[n : 2 * n])
        given, out[at.governor + g] = governed_torque(outside.governors, g, error, y[at.governor + g])
        first, last = outside.governor_places[SOURCE_START, g], outside.governor_places[SOURCE_STOP, g]
        if first == last:
            add_row(outside.rows, outside.act + g, given, torque)
        for k in range(first, last):
            extra[outside.governed[k]] += given
    last = at.governor + outside.governors.shape[1] - outside.leaks.shape[1]
    for k in range(outside.leaks.shape[1]):
        end, fast = leak_towards(outside, k, (frame[1], frame[0]), y[:n], y[n : 2 * n])
        out[last + k] = min(fast, FILLING) * (end - y[last + k])
    source_torques(outside, t, frame[1], y[:n], extra, torques)
    for s in range(torques.size):
        add_row(outside.rows, s, torques[s], torque)


@numba.njit(cache=True, error_model="numpy")
def _accelerate(at: Places, y: Array, frame: tuple[float, float], torque: Array, out: Array) -> None:
    """M(q) q̈ = torque, with the moving pistons in M and in the torque."""
    outside, n = at.outside, torque.size
    first, pistons = outside.crank_row, outside.sense - outside.crank_row
    if pistons == 0:
        out[:] = at.inverse @ torque
        return
    constant, inertia, mass = np.empty(pistons), np.empty(pistons), at.mass.copy()
    crank_terms(outside, frame[1], frame[0], y[:n], y[n : 2 * n], constant, inertia)
    for m in range(pistons):
        add_row(outside.rows, first + m, constant[m], torque)
    _add_masses(outside.rows, inertia, mass, first)
    order = np.empty(n, dtype=np.int64)
    factor(mass, order)
    backsolve(mass, order, torque)
    out[:] = torque


@numba.njit(cache=True, error_model="numpy")
def fill_rates(connected: Connected, at: Places, t: float, y: Array, out: Array) -> None:
    """ẏ into ``out``."""
    outside, n = at.outside, at.mass.shape[0]
    torque, frame = np.zeros(n), frame_at(outside.knots, outside.frame, t)
    _connect(connected, at, t, y, frame[0], torque, out)
    _drive(at, t, y, frame, torque, out)
    out[:n] = y[n : 2 * n]
    _accelerate(at, y, frame, torque, out[n : 2 * n])
    out[2 * n] = 0.0
    if math.isfinite(outside.reference_time):
        omega = row_product(outside.rows, outside.reference, y[n : 2 * n]) + frame[0]
        out[2 * n] = (omega - y[2 * n]) / outside.reference_time
