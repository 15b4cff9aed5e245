"""The arrays that a harmonic balance is made of, and what it needs of the linear part at one value of the parameter."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.small_linear import complex_solve


class Balance(NamedTuple):
    """x_h + G_h F̃_h(x) = b_h over H harmonics of ``base_order`` ν and m connections; n = m (2H + 1) unknowns.

    Unknowns: the m means, then for each harmonic the m real and the m imaginary parts, X_h being complex 0-peak.  The
    continued parameter p is the speed Ω [rad/s] where ``by_speed`` is 1; else Ω is ``fixed_speed``.  The load is a cubic
    in p between ``breaks``, with coefficients (intervals, 4, …), lowest power first, of p less the break.

    ``poles`` λ (K,) and ``left`` ψ (K, m) give G_h = Σ_k ψ_k ψ_kᵀ / (ihνΩ − λ_k), with ``modal_load`` (intervals, 4,
    H + 1, K); without poles ``matrices`` (M, C, K, H, S; each N × N), ``weights`` (m, N) and ``node_load`` (intervals,
    4, H + 1, N) do, a solve per harmonic.  ``static`` (m, m) and ``static_load`` (intervals, 4, m): harmonic 0.
    ``reference_stiffness``, ``reference_damping`` (m,) are in the linear part and taken off the laws.
    ``law_values`` from ``law_start`` on are a law's parameters; ``address`` 0 means hinges; ``remembers`` a memory.
    ``half_orders``: how many odd multiples of ν/2 the test for period doublings takes, H + 1 at most.
    ``table``: `scan_table` of the motion.  ``scale`` (n + 1,) divides the unknowns and p.
    """

    base_order: float
    fixed_speed: float
    by_speed: int
    breaks: Array
    poles: ComplexArray
    left: ComplexArray
    modal_load: ComplexArray
    matrices: Array
    weights: Array
    node_load: ComplexArray
    loaded: IntArray
    static: Array
    static_load: Array
    reference_stiffness: Array
    reference_damping: Array
    law_values: Array
    law_start: IntArray
    address: IntArray
    remembers: IntArray
    half_orders: int
    table: Array
    scale: Array


@numba.njit(cache=True, error_model="numpy")
def interval(breaks: Array, p: float) -> int:
    """Number of the piece of the load that p lies in; the end pieces go on beyond their ends."""
    low, high = 0, breaks.size - 2
    while low < high:
        middle = (low + high + 1) // 2
        if p >= breaks[middle]:
            low = middle
        else:
            high = middle - 1
    return low


@numba.njit(cache=True, error_model="numpy")
def static_part(balance: Balance, p: float, b: ComplexArray, db: ComplexArray) -> None:
    """Harmonic 0 of b and its derivative by p."""
    at = interval(balance.breaks, p)
    d, c = p - balance.breaks[at], balance.static_load[at]
    for e in range(c.shape[1]):
        b[0, e] = c[0, e] + d * (c[1, e] + d * (c[2, e] + d * c[3, e]))
        db[0, e] = c[1, e] + d * (2.0 * c[2, e] + 3.0 * d * c[3, e])


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def receptance_at(balance: Balance, order: float, speed: float, g: ComplexArray, dg: ComplexArray) -> None:
    """G (m, m) at the order and the speed, and its derivative by the speed."""
    g[:] = 0.0
    dg[:] = 0.0
    if balance.poles.size == 0:
        rest = np.zeros((0, balance.weights.shape[1]), dtype=np.complex128)
        _solved(balance, order, speed, rest, g, dg, np.zeros((2, 0), dtype=np.complex128))
        return
    m = g.shape[0]
    for k in range(balance.poles.size):
        distance = complex(0.0, order * speed) - balance.poles[k]
        size = 1.0 / (distance.real * distance.real + distance.imag * distance.imag)
        inverse = complex(distance.real * size, -distance.imag * size)
        slope = complex(0.0, -order) * inverse
        for e in range(m):
            scaled = balance.left[k, e] * inverse
            for f in range(m):
                term = scaled * balance.left[k, f]
                g[e, f] += term
                dg[e, f] += term * slope


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def harmonic_part(
    balance: Balance, h: int, p: float, speed: float, g: ComplexArray, dg: ComplexArray, b: ComplexArray, db: ComplexArray
) -> None:
    """G_h, b_h and their derivatives by the parameter."""
    order = h * balance.base_order
    at = interval(balance.breaks, p)
    d = p - balance.breaks[at]
    by_speed = balance.by_speed == 1
    if balance.poles.size == 0:
        _solved_loaded(balance, order, speed, h, at, d, g, dg, b, db)
    elif balance.loaded[h] == 0:
        receptance_at(balance, order, speed, g[h], dg[h])
        b[h] = 0.0
        db[h] = 0.0
    else:
        g[h], dg[h], b[h], db[h] = 0.0, 0.0, 0.0, 0.0
        c, m = balance.modal_load[at, :, h], g.shape[1]
        for k in range(balance.poles.size):
            distance = complex(0.0, order * speed) - balance.poles[k]
            size = 1.0 / (distance.real * distance.real + distance.imag * distance.imag)
            inverse = complex(distance.real * size, -distance.imag * size)
            slope = complex(0.0, -order) * inverse
            load = c[0, k] + d * (c[1, k] + d * (c[2, k] + d * c[3, k]))
            rise = c[1, k] + d * (2.0 * c[2, k] + 3.0 * d * c[3, k])
            if by_speed:
                rise = rise + load * slope
            for e in range(m):
                scaled = balance.left[k, e] * inverse
                b[h, e] += scaled * load
                db[h, e] += scaled * rise
                for f in range(m):
                    term = scaled * balance.left[k, f]
                    g[h, e, f] += term
                    dg[h, e, f] += term * slope
    if not by_speed:
        dg[h] = 0.0


@numba.njit(cache=True, error_model="numpy")
def _solved_loaded(
    balance: Balance,
    order: float,
    speed: float,
    h: int,
    at: int,
    d: float,
    g: ComplexArray,
    dg: ComplexArray,
    b: ComplexArray,
    db: ComplexArray,
) -> None:
    """`harmonic_part` by a solve with the load and its derivative as further columns."""
    c = balance.node_load[at, :, h]
    columns = np.empty((2, c.shape[1]), dtype=np.complex128)
    columns[0] = c[0] + d * (c[1] + d * (c[2] + d * c[3]))
    columns[1] = c[1] + d * (2.0 * c[2] + 3.0 * d * c[3])
    answer = np.zeros((2 * g.shape[1], 2), dtype=np.complex128)
    _solved(balance, order, speed, columns, g[h], dg[h], answer)
    m = g.shape[1]
    b[h] = answer[:m, 0]
    db[h] = answer[:m, 1]
    if balance.by_speed == 1:
        db[h] += answer[m:, 0]


@numba.njit(cache=True, error_model="numpy")
def _solved(
    balance: Balance,
    order: float,
    speed: float,
    columns: ComplexArray,
    g: ComplexArray,
    dg: ComplexArray,
    answer: ComplexArray,
) -> None:
    """G = W Z⁻¹ Wᵀ and −W Z⁻¹ Z' Z⁻¹ Wᵀ; the same of further ``columns`` into (value; slope) of ``answer``."""
    mass, damping, stiffness = balance.matrices[0], balance.matrices[1], balance.matrices[2]
    hysteresis, lift = balance.matrices[3], balance.matrices[4]
    omega, n, m = order * speed, mass.shape[0], g.shape[0]
    z = stiffness + speed * speed * lift - omega * omega * mass + 1j * (omega * damping + hysteresis)
    dz = 2.0 * speed * lift - 2.0 * omega * order * mass + 1j * order * damping
    extra = columns.shape[0]
    x = np.zeros((n, m + extra), dtype=np.complex128)
    x[:, :m] = balance.weights.T
    x[:, m:] = columns.T
    if not complex_solve(z.copy(), x):
        x[:] = np.nan
    slope = -(dz @ x)
    if not complex_solve(z.copy(), slope):
        slope[:] = np.nan
    w = balance.weights.astype(np.complex128)
    value, rise = w @ x, w @ slope
    g[:] = value[:, :m]
    dg[:] = rise[:, :m]
    if extra:
        answer[:m] = value[:, m:]
        answer[m:] = rise[:, m:]
